//! Two deformable blocks with meshes that do not match.
//!
//! Problem: a block of 0.6 m x 0.6 m x 0.4 m, E = 1e9 Pa, ν = 0.3, ρ = 1000 kg/m³, comes down at 5 m/s and 1 m/s sideways,
//! off the centre, on a free block of 1 m x 1 m x 0.5 m at rest; 3 x 3 x 2 elements above, 2 x 2 x 2 below, hexahedra or
//! tetrahedra; in the plane the same without the second direction. Its nodes are paired with the faces below, once, closure
//! being looked at half a step ahead, or at the start of every step. Closed solution: none for the motion; facts of the method: forces on the two sides are opposite and act
//! on one line, so that linear momentum never changes and neither does angular momentum (about the reference places with
//! pairing once; about the places at the start of the step with pairing at every step); the energy identity;
//! the law's bound on the penetration with the fastest approach of a point in the run: parts of a block that bends come
//! down faster than the block. Reference: zero, and carom_exact::closed_forms. Tolerance: 1e-12 of the largest momentum or force, and of
//! its moment over 1 m; 1e-11 of the energy: round-off. Sizes: quick as above, full three times finer.

use carom_bodies::Kinematics;
use carom_contact::{Law, Sliding};
use carom_dynamics::{Driver, Model, ModelTarget, Scheme, State, System};
use carom_exact::closed_forms::{penetration_bound_half, penetration_bound_now};
use carom_materials::{Elastic, Plane};
use carom_mesh::{Mesh, generate};

use crate::Error;
use crate::build::{HALF, NOW, body, contact, surface, theta};
use crate::check::{Check, Row, Size};

pub(crate) const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e9,
    poisson: 0.3,
};
pub(crate) const SPEED: f64 = 5.0;
/// Lower face of the upper block, m².
pub(crate) const FACE: f64 = SIZES[0][0] * SIZES[0][1];
const SIZES: [[f64; 3]; 2] = [[0.6, 0.6, 0.4], [1.0, 1.0, 0.5]];
const ORIGINS: [[f64; 3]; 2] = [[0.1, 0.25, 0.0], [0.0, 0.0, -0.5]];

/// The upper and the lower block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Blocks {
    /// 3, or 2 for plane strain in the first and the last direction.
    pub(crate) dim: usize,
    /// Elements along the edges of each.
    pub(crate) elements: [[usize; 3]; 2],
    /// Whether each is cut into triangles or tetrahedra.
    pub(crate) simplices: [bool; 2],
}

/// The smallest meshes that do not match.
pub(crate) const SMALLEST: Blocks = Blocks {
    dim: 3,
    elements: [[3, 3, 2], [2, 2, 2]],
    simplices: [false; 2],
};

/// Meshes of enough layers to take the mass of those in contact.
pub(crate) const FINER: Blocks = Blocks {
    elements: [[4, 4, 4], [4, 4, 3]],
    ..SMALLEST
};

impl Blocks {
    fn part(&self, name: &str, k: usize) -> Mesh {
        let (origin, size, n) = (ORIGINS[k], SIZES[k], self.elements[k]);
        match self.dim {
            2 => generate::rectangle(
                name,
                [origin[0], origin[2]],
                [size[0], size[2]],
                [n[0], n[2]],
                self.simplices[k],
            ),
            _ => generate::box_(name, origin, size, n, self.simplices[k]),
        }
    }

    /// The model, with CFL 0.5 on the shortest edge, or 0.2 with simplices, whose heights are less than their edges.
    pub(crate) fn model(&self, scheme: Scheme, law: Law, sliding: Sliding) -> Result<Model, Error> {
        let mut mesh = self.part("upper", 0);
        mesh.merge("lower", self.part("lower", 1))?;
        let kinematics = match self.dim {
            2 => Kinematics::PlaneStrain { thickness: 1.0 },
            _ => Kinematics::Solid,
        };
        let mut upper = body(&mesh, "upper", kinematics, RUBBER)?;
        upper.velocity[0] = 1.0;
        upper.velocity[self.dim - 1] = -SPEED;
        let lower = body(&mesh, "lower", kinematics, RUBBER)?;
        let secondary = surface(&mesh, "upper.bottom", &upper)?;
        let primary = surface(&mesh, "lower.top", &lower)?;
        let mut shock = contact(secondary, ModelTarget::Surface(primary), law);
        shock.sliding = sliding;
        let edges = SIZES.iter().zip(self.elements);
        let edges = edges.flat_map(|(size, n)| [0, 1, 2].map(|i| size[i] / n[i] as f64));
        let shortest = edges.fold(f64::INFINITY, f64::min);
        let courant = if self.simplices == [false; 2] {
            0.5
        } else {
            0.2
        };
        Ok(Model {
            contacts: vec![shock],
            ..Model::new(
                vec![upper, lower],
                mesh,
                scheme,
                courant * shortest / RUBBER.wave_speed(Plane::Full),
            )
        })
    }
}

/// Largest sums over all nodes that the contact forces of a step left.
#[derive(Default)]
struct Sums {
    /// Largest component of their resultant, N.
    force: f64,
    /// Largest component of their moment, N m.
    moment: f64,
    /// Largest component of a nodal force, N.
    largest: f64,
}

impl Sums {
    /// Adds a step; moments about the places of pairing: those at its start with finite sliding, the reference places
    /// otherwise.
    fn add(&mut self, system: &System, old: &State, new: &State, sliding: Sliding) {
        let (dim, motion) = (system.dim, &old.motion);
        let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
        for (node, place) in system.x.iter().enumerate() {
            let (mut x, mut f) = (*place, [0.0; 3]);
            for i in 0..dim {
                let dof = system.unknowns.first(node as u32) + i;
                if sliding == Sliding::Finite {
                    x[i] += motion.u[dof];
                }
                f[i] = new.motion.contact_force[dof];
            }
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                force[i] += f[i];
                moment[i] += x[j] * f[k] - x[k] * f[j];
            }
            self.largest = self.largest.max(largest(f));
        }
        self.force = self.force.max(largest(force));
        self.moment = self.moment.max(largest(moment));
    }
}

fn largest(components: [f64; 3]) -> f64 {
    components.iter().fold(0.0, |m, x| m.max(x.abs()))
}

fn rows(name: &str, blocks: Blocks, sliding: Sliding) -> Result<Vec<Row>, Error> {
    let (law, bound): (_, fn(f64, f64, f64) -> f64) = match sliding {
        Sliding::Small => (HALF, penetration_bound_half),
        Sliding::Finite => (NOW, penetration_bound_now),
    };
    let system = crate::witness::system(blocks.model(theta(0.5), law, sliding)?)?;
    let mut driver = Driver::new(system.clone())?;
    let mut sums = Sums::default();
    let mut fastest = SPEED;
    // a wave goes to and fro in the upper block three times
    let end = 6.0 * SIZES[0][2] / RUBBER.wave_speed(Plane::Full);
    while driver.state().time < end {
        let old = driver.state().clone();
        fastest = old
            .interface
            .rate
            .iter()
            .fold(fastest, |m, rate| m.max(-rate));
        driver.step()?;
        sums.add(&system, &old, driver.state(), sliding);
    }
    let state = driver.state();
    let (ledger, record) = (&state.ledger, &state.records.contacts[0]);
    let (start, now) = (&ledger.initial, &ledger.balance);
    let momentum = ledger.largest_momentum;
    let change = [0, 1, 2].map(|i| now.momentum.linear[i] - start.momentum.linear[i]);
    let turn = largest(now.impulse_contact.angular) / momentum;
    let energy = ledger.largest_energy_residual / start.energy();
    let gained = ledger.largest_energy / start.energy() - 1.0;
    let bound = bound(0.5, fastest, system.dt);
    let row = |what: &str| format!("{name}: {what}");
    let at_most = |what: &str, value, bound| Row::at_most(row(what), value, bound);
    let mut rows = vec![
        Row::at_least(row("impulse / momentum"), record.impulse() / momentum, 0.5),
        at_most(
            "change of momentum / largest",
            largest(change) / momentum,
            1e-12,
        ),
        at_most(
            "sum of contact forces / largest",
            sums.force / sums.largest,
            1e-12,
        ),
        at_most(
            "moment of contact forces / largest x 1 m",
            sums.moment / sums.largest,
            1e-12,
        ),
        at_most("energy residual / E0", energy, 1e-11),
        at_most("largest energy / E0 - 1", gained, 1e-11),
        at_most("penetration, m", record.penetration, bound),
    ];
    if sliding == Sliding::Small {
        rows.push(at_most("angular impulse / momentum x 1 m", turn, 1e-12));
    }
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "blocks",
    fact: "two deformable blocks with other meshes exchange momentum along common lines",
    run: |size| {
        let refinement = match size {
            Size::Quick => 1,
            Size::Full => 3,
        };
        let base = Blocks {
            elements: SMALLEST.elements.map(|n| n.map(|n| n * refinement)),
            ..SMALLEST
        };
        let mut all = Vec::new();
        for (elements, simplices) in [
            ("hexahedra", [false, false]),
            ("tetrahedra above", [true, false]),
            ("tetrahedra below", [false, true]),
        ] {
            for (pairing, sliding) in [("once", Sliding::Small), ("anew", Sliding::Finite)] {
                let solid = Blocks { simplices, ..base };
                let name = format!("{elements}, paired {pairing}");
                all.extend(rows(&name, solid, sliding)?);
                let plane = Blocks { dim: 2, ..solid };
                all.extend(rows(&format!("{name}, in the plane"), plane, sliding)?);
            }
        }
        Ok(all)
    },
};
