//! A bar in two zones that are glued at every node, the one in contact included.
//!
//! Problem: a bar of the set "classic" flies against a rigid plane; two bars of half its section lie in each other, each a zone, tied at
//! all nodes, and the first is in contact. Their motions are one motion, with the mass, the stiffness and the contact of the
//! single bar. Reference: the single bar, a second formulation of the same equations. Tolerance: 1e-10 of Z v0, which leaves the rounding of
//! some hundred steps room; with adaptive steps the same sizes are taken, since they depend on gaps and rates alone. Newmark's scheme
//! has gamma = 0.9: the trapezoidal rule is chaotic with this law and step (bars in impact, its table), rounding grows in it.

use carom_arlequin::trace;
use carom_bodies::{BodySpec, Kinematics};
use carom_dynamics::{Adaptive, Closing, Driver, Model, ModelBody, ModelLink, Scheme, System};
use carom_mesh::generate;
use carom_zones::{LinkKind, ModelZone, Zoned};

use crate::Error;
use crate::bars::CLASSIC;
use crate::build::{CENTRAL, DISPLACEMENT, HALF, NOW, contact, newmark, plane, surface, theta};
use crate::check::{Check, Row};
use carom_contact::Law;

pub(crate) const CHECK: Check = Check {
    name: "zones-glued-at-contact",
    fact: "a link that ends on the node in contact leaves the force of the single bar, with fixed and with adaptive steps",
    run: |_| {
        let cases = [
            ("theta 0.5, velocity", theta(0.5), HALF, false),
            ("theta 0.75, velocity", theta(0.75), NOW, false),
            (
                "newmark, displacement",
                newmark(0.49, 0.9),
                DISPLACEMENT,
                false,
            ),
            ("central difference, velocity", CENTRAL, NOW, false),
            ("theta 0.5, velocity, adaptive", theta(0.5), HALF, true),
            (
                "newmark, displacement, adaptive",
                newmark(0.49, 0.9),
                DISPLACEMENT,
                true,
            ),
        ];
        let mut rows = Vec::new();
        for (name, scheme, law, adaptive) in cases {
            let [single, glued] = [false, true].map(|glued| {
                let system = match zoned(scheme, law, adaptive)? {
                    zoned if glued => zoned.together()?.ok_or(Error::Apart)?,
                    zoned => System::new(single(zoned.model))?,
                };
                history(Driver::new(system)?)
            });
            let (single, glued) = (single?, glued?);
            let full = CLASSIC.impedance() * CLASSIC.speed;
            let pairs = single.iter().zip(&glued);
            let worst = pairs.clone().map(|([_, a], [_, b])| (a - b).abs());
            let worst = worst.fold(0.0, f64::max) / full;
            let times = pairs.map(|([a, _], [b, _])| (a - b).abs());
            let times = times.fold(0.0, f64::max) / CLASSIC.duration();
            let touched = single.iter().filter(|[_, force]| *force > 0.0).count();
            let name = |what: &str| format!("{name}: {what}");
            rows.push(Row::at_most(name("force / (Z v0)"), worst, 1e-10).second_formulation());
            rows.push(Row::at_most(name("times / duration"), times, 1e-10).second_formulation());
            rows.push(Row::at_least(
                name("steps in contact"),
                touched as f64,
                20.0,
            ));
        }
        Ok(rows)
    },
};

/// Two bars of half the section in each other.
fn zoned(scheme: Scheme, law: Law, adaptive: bool) -> Result<Zoned, Error> {
    let (from, gap) = (-CLASSIC.length, 1e-5);
    let line = |name: &str| generate::line(name, [from - gap, 0.0, 0.0], [-gap, 0.0, 0.0], 40, 1);
    let mut mesh = line("tip");
    mesh.merge("rest", line("rest"))?;
    let body = |name: &str| -> ModelBody {
        let cells = mesh.groups[name].elements.clone();
        let area = 0.5 * CLASSIC.area;
        ModelBody {
            velocity: [CLASSIC.speed, 0.0, 0.0],
            ..ModelBody::new(BodySpec::new(
                name,
                cells,
                Kinematics::Bar { area },
                CLASSIC.material(),
            ))
        }
    };
    let bodies = vec![body("tip"), body("rest")];
    let nodes = |name: &str| mesh.group_nodes(&mesh.groups[name]);
    let rows = trace(&mesh, &nodes("tip"), &nodes("rest"), 1e-9)?.rows;
    let courant = if scheme == CENTRAL { 0.9 } else { 0.5 };
    let dt = courant * CLASSIC.length / 40.0 / CLASSIC.wave_speed();
    let secondary = surface(&mesh, "tip.right", &bodies[0])?;
    let zone = |body: usize| ModelZone {
        name: bodies[body].spec.name.clone(),
        bodies: vec![body],
        scheme,
        substeps: 1,
        far: None,
    };
    Ok(Zoned {
        zones: vec![zone(0), zone(1)],
        links: vec![ModelLink {
            name: "glue".to_string(),
            zones: [0, 1],
            rows,
        }],
        kind: LinkKind::GravouilCombescure,
        model: Model {
            contacts: vec![contact(secondary, plane(0, -1.0), law)],
            adaptive: adaptive.then_some(Adaptive {
                smallest: dt / 64.0,
                closing: Closing::Cut,
                growth: None,
                patience: 10,
            }),
            ..Model::new(bodies.clone(), mesh.clone(), scheme, dt)
        },
    })
}

/// The first of the two bars, with the whole section.
fn single(mut model: Model) -> Model {
    model.bodies.truncate(1);
    model.bodies[0].spec.kinematics = Kinematics::Bar { area: CLASSIC.area };
    model
}

/// Times and forces of the steps to 1.2 durations of the contact.
fn history(mut driver: Driver) -> Result<Vec<[f64; 2]>, Error> {
    let mut history = Vec::new();
    while driver.state().time < 1.2 * CLASSIC.duration() {
        driver.step()?;
        history.push([driver.state().time, driver.report().contacts[0].force]);
    }
    Ok(history)
}
