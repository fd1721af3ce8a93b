//! A rigid hammer strikes an elastic bar.
//!
//! Problem: a hammer of 2 kg at 5 m/s, a rigid body, strikes the end of a bar of L = 0.25 m, 20 mm by 20 mm, E = 2e11 Pa,
//! ρ = 8000 kg/m³, c = 5000 m/s, held at its far end; plane cells and hexahedra with ν = 0, one element across, so that the bar
//! is one of wave theory. The faces meet along a line (the hammer carries the primary surface) or at its own corners (the hammer
//! carries the secondary one), at nodes, and by mortar, which has the same resultant on faces that fit; with hammer and bar in zones
//! of their own too, one step of the hammer to four of the bar and four to one. Theta ½, velocity law, lumped mass, CFL ½. Closed solution: Saint-Venant,
//! `carom_exact::mass_on_bar`: Z V = 80 kN, decay Z/M, a step of 2 Z V as the wave comes back, release after 2.49 transits.
//!
//! Tolerances: 1 % of the mean force in each transit without its first and last tenth (and a tenth of a transit before the release),
//! and of the time in contact, with 200 elements; 2 % with 50 (quick), where the front is spread
//! over as many elements, and so over more of the bar. The
//! momentum balance holds to the tolerance of the iterations, 1e-9; contact makes no energy.

use carom_bodies::{Inertia, Kinematics};
use carom_contact::{Basis, Integration};
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelRigid, ModelTarget, Stepper};
use carom_exact::mass_on_bar::MassOnBar;
use carom_materials::Elastic;
use carom_mesh::{Mesh, generate};
use carom_zones::{LinkKind, ModelZone, Whole, Zoned};

use crate::Error;
use crate::build::{HALF, NOW, body, contact, support, surface, theta};
use crate::check::{Check, Row, Size};
use crate::witness::{Compared, compare};

const STEEL: Elastic = Elastic {
    density: 8000.0,
    young: 2e11,
    poisson: 0.0,
};
const SPEED_OF_SOUND: f64 = 5000.0;
const LENGTH: f64 = 0.25;
const SIDE: f64 = 0.02;
const MASS: f64 = 2.0;
const SPEED: f64 = 5.0;

#[derive(Clone, Copy)]
struct Hammer {
    name: &'static str,
    dim: usize,
    elements: usize,
    /// Of mean forces and of the time in contact, relative.
    tolerance: f64,
    /// Whether the hammer carries the secondary surface.
    secondary: bool,
    integration: Integration,
    /// Inner steps of bar and hammer, if each is a zone.
    substeps: Option<[u32; 2]>,
}

impl Hammer {
    fn exact(&self) -> MassOnBar {
        let impedance = STEEL.density * SPEED_OF_SOUND * SIDE * SIDE;
        MassOnBar::new(
            [MASS, impedance, SPEED, 2.0 * LENGTH / SPEED_OF_SOUND],
            true,
            6,
        )
    }

    /// The bar from x = 0 to the right, and the hammer left of it.
    fn mesh(&self) -> Result<Mesh, Error> {
        let n = self.elements;
        let (mut mesh, hammer) = match self.dim {
            2 => (
                generate::rectangle("bar", [0.0; 2], [LENGTH, SIDE], [n, 1], false),
                generate::rectangle("hammer", [-0.05, -SIDE], [0.05, 3.0 * SIDE], [1, 1], false),
            ),
            _ => (
                generate::box_("bar", [0.0; 3], [LENGTH, SIDE, SIDE], [n, 1, 1], false),
                generate::box_(
                    "hammer",
                    [-0.05, -SIDE, -SIDE],
                    [0.05, 3.0 * SIDE, 3.0 * SIDE],
                    [1, 1, 1],
                    false,
                ),
            ),
        };
        mesh.merge("both", hammer)?;
        if self.secondary {
            // its corners on those of the bar: a node to face contact needs them over it
            let own = mesh.group_nodes(&mesh.groups["hammer"]);
            for node in own {
                for x in &mut mesh.nodes[node as usize][1..self.dim] {
                    *x = (*x / SIDE).clamp(0.0, 1.0) * SIDE;
                }
            }
        }
        Ok(mesh)
    }

    fn bodies(&self, mesh: &Mesh) -> Result<[ModelBody; 2], Error> {
        let kinematics = match self.dim {
            2 => Kinematics::PlaneStrain { thickness: SIDE },
            _ => Kinematics::Solid,
        };
        let bar = body(mesh, "bar", kinematics, STEEL)?;
        let mut hammer = body(mesh, "hammer", kinematics, STEEL)?;
        let of_cells = Inertia::of_cells(mesh, &hammer.spec)?;
        hammer.velocity = [SPEED, 0.0, 0.0];
        hammer.rigid = Some(ModelRigid {
            inertia: Inertia {
                mass: MASS,
                ..of_cells
            },
            spin: [0.0; 3],
        });
        Ok([bar, hammer])
    }

    fn rows(&self) -> Result<Vec<Row>, Error> {
        let exact = self.exact();
        let mesh = self.mesh()?;
        let [bar, hammer] = self.bodies(&mesh)?;
        let (struck, striking) = (
            surface(&mesh, "bar.left", &bar)?,
            surface(&mesh, "hammer.right", &hammer)?,
        );
        let (secondary, primary) = match self.secondary {
            true => (striking, struck),
            false => (struck, striking),
        };
        // a contact between zones of unequal steps has one force for the outer step
        let law = self.substeps.map_or(NOW, |_| HALF);
        let touch = ModelContact {
            integration: self.integration,
            ..contact(secondary, ModelTarget::Surface(primary), law)
        };
        let courant = 0.5 * LENGTH / self.elements as f64 / SPEED_OF_SOUND;
        let of_bar = self.substeps.map_or(1, |[bar, _]| bar);
        let dt = courant * f64::from(of_bar);
        let supports = vec![support(&mesh, "bar.right", [true; 3])?];
        let model = Model {
            contacts: vec![touch],
            supports,
            ..Model::new(vec![bar, hammer], mesh, theta(0.5), dt)
        };
        let mut driver: Box<dyn Stepper> = match self.substeps {
            None => Box::new(Driver::new(crate::witness::system(model)?)?),
            Some(substeps) => Box::new(whole(model, substeps)?),
        };
        let mut history = Vec::new();
        while driver.state().time < 1.05 * exact.duration() {
            driver.step()?;
            history.push((driver.state().time, driver.report().contacts[0].force));
        }
        compare(|| Compared {
            title: format!("Contact force: {}", self.name),
            abscissa: ["time", "s"],
            ordinate: ["contact force", "N"],
            x: history.iter().map(|(time, _)| *time).collect(),
            computed: history.iter().map(|(_, force)| *force).collect(),
            reference: {
                let means = history.iter();
                means
                    .map(|(time, _)| exact.mean([time - dt, *time]))
                    .collect()
            },
        });
        let record = &driver.state().records.contacts[0];
        let ledger = &driver.state().ledger;
        let start = record.first_closing.unwrap_or(f64::NAN);
        let row = |what: &str| format!("{}: {what}", self.name);
        let transit = 2.0 * LENGTH / SPEED_OF_SOUND;
        let duration = exact.duration() / transit;
        let mut rows = Vec::new();
        for number in 0..duration as usize + 1 {
            let first = number as f64;
            let span = [first + 0.1, (first + 0.9).min(duration - 0.1)].map(|part| part * transit);
            // steps whose middle lies in the window, and the window that they make
            let inside = |time: &f64| span[0] <= time - 0.5 * dt && time - 0.5 * dt < span[1];
            let steps: Vec<(f64, f64)> =
                history.iter().filter(|(t, _)| inside(t)).copied().collect();
            let Some((from, to)) = steps.first().zip(steps.last()) else {
                continue;
            };
            let mean = steps.iter().map(|(_, force)| force).sum::<f64>() / steps.len() as f64;
            let name = row(&format!("mean force in transit {}, N", number + 1));
            let of_exact = exact.mean([from.0 - dt, to.0]);
            rows.push(Row::relative(name, mean, of_exact, self.tolerance));
        }
        // the hammer may strike again as later waves come back
        let left = history
            .iter()
            .find(|(time, force)| *time > start && *force == 0.0);
        let left = left.map_or(f64::NAN, |(time, _)| time - dt);
        rows.push(Row::relative(
            row("time in contact, s"),
            left - start,
            exact.duration(),
            self.tolerance,
        ));
        let energy = ledger.initial.energy();
        rows.push(Row::at_most(
            row("momentum residual / (M V)"),
            ledger.largest_momentum_residual / (MASS * SPEED),
            1e-9,
        ));
        rows.push(Row::at_most(
            row("energy residual / E0"),
            ledger.largest_energy_residual / energy,
            1e-9,
        ));
        let gained = ledger.balance.energy() / energy - 1.0;
        rows.push(Row::at_most(row("energy gained / E0"), gained, 1e-9));
        Ok(rows)
    }
}

/// Bar and hammer in zones of their own.
fn whole(model: Model, substeps: [u32; 2]) -> Result<Whole, Error> {
    let zone = |body: usize| {
        ModelZone::new(
            model.bodies[body].spec.name.clone(),
            vec![body],
            (model.scheme, substeps[body]),
        )
    };
    let zoned = Zoned {
        zones: vec![zone(0), zone(1)],
        links: Vec::new(),
        kind: LinkKind::PrakashHjelmstad,
        model,
    };
    Ok(Whole::new(&zoned, zoned.whole()?)?)
}

pub(crate) const CHECK: Check = Check {
    name: "rigid-hammer",
    fact: "a rigid hammer on a bar has the force and the time in contact of Saint-Venant's solution",
    run: |size| {
        let (elements, tolerance) = match size {
            Size::Quick => (50, 0.02),
            Size::Full => (200, 0.01),
        };
        let plane = Hammer {
            name: "plane, hammer primary",
            dim: 2,
            elements,
            tolerance,
            secondary: false,
            integration: Integration::Node,
            substeps: None,
        };
        let other = Hammer {
            name: "plane, hammer secondary",
            secondary: true,
            ..plane
        };
        let space = Hammer {
            name: "space, hammer primary",
            dim: 3,
            ..plane
        };
        let mortar = Hammer {
            name: "plane, hammer primary, mortar",
            integration: Integration::Mortar {
                basis: Basis::Standard,
            },
            ..plane
        };
        let fine_bar = Hammer {
            name: "zones, four steps of the bar to one",
            substeps: Some([4, 1]),
            ..plane
        };
        let fine_hammer = Hammer {
            name: "zones, four steps of the hammer to one",
            substeps: Some([1, 4]),
            ..plane
        };
        let all = [plane, other, space, mortar, fine_bar, fine_hammer];
        let rows = all.map(|hammer| hammer.rows());
        Ok(rows.into_iter().collect::<Result<Vec<_>, _>>()?.concat())
    },
};
