//! A ring whose impact sector is a finer zone, against the ring in one mesh.
//!
//! Problem: a neo-Hookean ring (E = 1 MPa, ν = 0.3, ρ = 1000, outer radius 1 m, wall 0.1 m) flies at 0.2 m/s against a rigid wall
//! that it touches. In one mesh it has 4 x 144 elements, theta 0.55 and the velocity law. In two, the sector within 30 degrees
//! of the point of impact is that mesh, with four inner steps, and the rest has 2 x 120 elements with steps four times as
//! long; the ends are tied by mortar rows, since nodes do not match across the wall, with the link of Prakash and
//! Hjelmstad. The run ends before the contact parts in two places (0.3 s), after which nothing can be compared point by point: the
//! ring bounces between them.
//!
//! Reference: the single mesh, a second formulation. Forces are means over the outer steps. 3 % are the figure of the requirement, for the L2 norm
//! of the difference, the impulse and the peak; found were 1.4, 0.5 and 0.001 % with the trapezoid in the rest, 0.8, 0.5 and
//! 0.001 % with central differences. Elements round the rest are as long as those of the single mesh: quadrilaterals with all integration
//! points bend too stiffly by the square of their length over the wall's thickness, and with 60 of them (24 % too
//! stiff against 6 %) the L2 norm is 4.7 % and the impulse 2.6 % too large.

use std::f64::consts::PI;

use carom_bodies::Kinematics;
use carom_contact::Plane;
use carom_dynamics::{Driver, Model, ModelBody, ModelLink, ModelTarget, Scheme};
use carom_materials::Elastic;
use carom_mesh::{Mesh, generate};
use carom_zones::{LinkKind, ModelZone, Zoned, mortar_rows};

use crate::Error;
use crate::build::{CENTRAL, NOW, contact, neo_hooke, newmark, surface, theta, welded};
use crate::check::{Check, Row, Size};

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.3,
};
const THICKNESS: f64 = 0.1;
/// Half the angle of the sector.
const SECTOR: f64 = PI / 6.0;
/// Elements across and round of the sector and of the rest.
const FINE: [usize; 2] = [4, 24];
const REST: [usize; 2] = [2, 120];
const SUBSTEPS: u32 = 4;
const THETA: f64 = 0.55;

pub(crate) const CHECK: Check = Check {
    name: "ring-sector",
    fact: "a finer zone at the impact gives the contact force of the single mesh",
    run: |size| {
        let end = match size {
            Size::Quick => 0.06,
            Size::Full => 0.28,
        };
        let mut rows = Vec::new();
        for (name, outer, dt) in [
            ("trapezoid", newmark(0.25, 0.5), 4e-3),
            ("central differences", CENTRAL, 0.8e-3),
        ] {
            if outer == CENTRAL && size == Size::Quick {
                continue;
            }
            let ring = Ring { outer, dt, end };
            let (one, two) = (ring.single()?, ring.glued()?);
            let square = |f: &[f64]| f.iter().map(|f| f * f).sum::<f64>();
            let gap: Vec<f64> = one.iter().zip(&two).map(|(a, b)| a - b).collect();
            let error = (square(&gap) / square(&one)).sqrt();
            rows.push(Row::at_most(format!("{name}: L2 norm"), error, 0.03).second_formulation());
            let sum = |f: &[f64]| f.iter().sum::<f64>();
            let peak = |f: &[f64]| f.iter().fold(0.0, |m: f64, f| m.max(*f));
            for (what, of) in [("impulse", sum as fn(&[f64]) -> f64), ("peak", peak)] {
                let name = format!("{name}: {what}");
                rows.push(Row::near(name, of(&two) / of(&one), 1.0, 0.03).second_formulation());
            }
        }
        Ok(rows)
    },
};

/// A ring about the origin that flies against the wall x = 1.
struct Ring {
    /// Scheme of the rest.
    outer: Scheme,
    /// Outer step, s.
    dt: f64,
    /// End of the run, s.
    end: f64,
}

impl Ring {
    fn model(&self, mesh: Mesh, bodies: Vec<ModelBody>, dt: f64) -> Result<Model, Error> {
        let wall = ModelTarget::rigid(Plane {
            point: [1.0, 0.0, 0.0],
            normal: [-1.0, 0.0, 0.0],
        });
        let touch = contact(surface(&mesh, "sector.right", &bodies[0])?, wall, NOW);
        Ok(Model {
            contacts: vec![touch],
            ..Model::new(bodies, mesh, theta(THETA), dt)
        })
    }

    /// Mean contact force of each outer step in one mesh as fine as the sector.
    fn single(&self) -> Result<Vec<f64>, Error> {
        let n = [FINE[0], 5 * FINE[1]];
        let mut mesh = part("sector", [-SECTOR, SECTOR], FINE);
        mesh.merge("ring", part("rest", [SECTOR, 2.0 * PI - SECTOR], n))?;
        let mesh = welded(mesh);
        let mut body = ring_body(&mesh, "sector")?;
        body.spec.cells.extend(&mesh.groups["rest"].elements);
        let dt = self.dt / f64::from(SUBSTEPS);
        let mut newton = Driver::new(crate::witness::system(self.model(mesh, vec![body], dt)?)?)?;
        let mut forces = Vec::new();
        while forces.len() < (self.end / self.dt).round() as usize {
            let mut sum = 0.0;
            for _ in 0..SUBSTEPS {
                newton.step()?;
                sum += newton.report().contacts[0].force;
            }
            forces.push(sum / f64::from(SUBSTEPS));
        }
        Ok(forces)
    }

    /// The same in two zones.
    fn glued(&self) -> Result<Vec<f64>, Error> {
        let mut mesh = part("sector", [-SECTOR, SECTOR], FINE);
        mesh.merge("ring", part("rest", [SECTOR, 2.0 * PI - SECTOR], REST))?;
        let bodies = vec![ring_body(&mesh, "sector")?, ring_body(&mesh, "rest")?];
        let link = |name: &str, sides: [&str; 2]| {
            let inner = surface(&mesh, sides[0], &bodies[0])?;
            let outer = surface(&mesh, sides[1], &bodies[1])?;
            Ok::<_, Error>(ModelLink {
                name: name.to_string(),
                zones: [0, 1],
                rows: mortar_rows(&mesh, &inner, &outer, |_| 1.0).rows,
            })
        };
        let links = vec![
            link("first", ["sector.bottom", "rest.top"])?,
            link("last", ["sector.top", "rest.bottom"])?,
        ];
        let zone = |body: usize, scheme, substeps| {
            ModelZone::new(["sector", "rest"][body], vec![body], (scheme, substeps))
        };
        let mut zones = crate::witness::zones(&Zoned {
            zones: vec![zone(0, theta(THETA), SUBSTEPS), zone(1, self.outer, 1)],
            links,
            kind: LinkKind::PrakashHjelmstad,
            model: self.model(mesh, bodies, self.dt)?,
        })?;
        let mut forces = Vec::new();
        while forces.len() < (self.end / self.dt).round() as usize {
            zones.step()?;
            let samples = zones.samples().iter().filter(|s| !s.contacts.is_empty());
            let sum: f64 = samples.map(|s| s.contacts[0].force).sum();
            forces.push(sum / f64::from(SUBSTEPS));
        }
        Ok(forces)
    }
}

/// A part of the ring from one angle to another.
fn part(name: &str, [from, to]: [f64; 2], n: [usize; 2]) -> Mesh {
    let mut mesh = generate::rectangle(
        name,
        [1.0 - THICKNESS, from],
        [THICKNESS, to - from],
        n,
        false,
    );
    for x in &mut mesh.nodes {
        let [r, angle, _] = *x;
        *x = [r * angle.cos(), r * angle.sin(), 0.0];
    }
    mesh
}

fn ring_body(mesh: &Mesh, name: &str) -> Result<ModelBody, Error> {
    let kinematics = Kinematics::PlaneStrain { thickness: 1.0 };
    let mut body = neo_hooke(mesh, name, kinematics, RUBBER)?;
    body.velocity = [0.2, 0.0, 0.0];
    Ok(body)
}
