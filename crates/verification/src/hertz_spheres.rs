//! x
use carom_bodies::Kinematics;
use carom_contact::Integration;
use carom_dynamics::{Model, ModelTarget};
use carom_mesh::Mesh;

use crate::Error;
use crate::build::{DISPLACEMENT, body, contact, support, surface, theta};
use crate::check::{Check, Row, Size};
use crate::hertz::{DUAL, MATERIAL, MORTAR, Pressed, lowered, mesh, pair};

const COARSE: &[u8] = include_bytes!("../../../cases/hertz/spheres-coarse.msh");
const MIDDLE: &[u8] = include_bytes!("../../../cases/hertz/spheres.msh");
const FINE: &[u8] = include_bytes!("../../../cases/hertz/spheres-fine.msh");
const WIDE: &[u8] = include_bytes!("../../../cases/hertz/spheres-wide.msh");

fn pressed(mesh: Mesh, way: f64, integration: Integration) -> Result<Pressed, Error> {
    let upper = body(&mesh, "upper", Kinematics::Axisymmetric, MATERIAL)?;
    let lower = body(&mesh, "lower", Kinematics::Axisymmetric, MATERIAL)?;
    let supports = vec![
        support(&mesh, "upper.axis", [true, false, false])?,
        support(&mesh, "lower.axis", [true, false, false])?,
        support(&mesh, "lower.equator", [false, true, false])?,
    ];
    let secondary = surface(&mesh, "upper.contact", &upper)?;
    let primary = surface(&mesh, "lower.contact", &lower)?;
    let mut touch = contact(secondary, ModelTarget::Surface(primary), DISPLACEMENT);
    touch.integration = integration;
    let motion = lowered(&mesh, "upper.equator", way)?;
    let model = Model {
        contacts: vec![touch],
        bodies: vec![upper, lower],
        supports,
        gravity: [0.0; 3],
        scheme: theta(0.5),
        dt: 1.0,
        adaptive: None,
        nonlinear: carom_dynamics::Nonlinear::default(),
        mesh,
    };
    Pressed::new(model, motion, 1)
}

pub(crate) const CHECK: Check = Check {
    name: "hertz-spheres",
    fact: "x",
    run: |size| {
        let mut rows = Vec::new();
        let runs: &[(&str, &[u8], f64)] = match size {
            Size::Quick => &[("coarse", COARSE, 4e-5), ("wide", WIDE, 4e-3)],
            Size::Full => &[("coarse", COARSE, 4e-5), ("middle", MIDDLE, 4e-5), ("fine", FINE, 4e-5), ("wide", WIDE, 4e-3)],
        };
        for (name, content, way) in runs {
            for (kind, integration) in [("dual", DUAL), ("mortar", MORTAR), ("node", Integration::Node)] {
                let begin = std::time::Instant::now();
                let run = pressed(mesh(name, content)?, *way, integration)?;
                let time = begin.elapsed().as_secs_f64();
                let costs = run.newton.costs();
                println!("{name} {kind} {time} {:?} {:?} {:?}", costs.phases, costs.work, run.newton.residuals());
                let spot = pair().spot(*way);
                let same = pair().spot_under(run.force());
                let profile = run.profile(same.radius, |r| same.pressure(r));
                for (what, value, reference) in [("force", run.force(), spot.force), ("peak", profile.peak, spot.peak), ("peak same", profile.peak, same.peak)] {
                    rows.push(Row::relative(format!("{name} {kind} {what}"), value, reference, 0.03));
                }
                rows.push(Row::at_most(format!("{name} {kind} l2"), profile.l2, 0.03));
                rows.push(Row::at_most(format!("{name} {kind} inside"), profile.inside, 0.03));
            }
        }
        Ok(rows)
    },
};
