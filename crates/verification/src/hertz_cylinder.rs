//! x
use carom_bodies::Kinematics;
use carom_contact::Integration;
use carom_dynamics::{Model, ModelTarget};
use carom_exact::hertz::{Pair, Solid};
use carom_mesh::Mesh;

use crate::Error;
use crate::build::{DISPLACEMENT, body, contact, plane, support, surface, theta};
use crate::check::{Check, Row, Size};
use crate::hertz::{BODY, DUAL, MATERIAL, MORTAR, Pressed, lowered, mesh, pair};

const COARSE: &[u8] = include_bytes!("../../../cases/hertz-cylinder/cylinder-coarse.msh");
const MIDDLE: &[u8] = include_bytes!("../../../cases/hertz-cylinder/cylinder.msh");
const FINE: &[u8] = include_bytes!("../../../cases/hertz-cylinder/cylinder-fine.msh");
const TWO: &[u8] = include_bytes!("../../../cases/hertz-cylinder/two-cylinders.msh");

fn pressed(mesh: Mesh, two: bool, way: f64, integration: Integration) -> Result<Pressed, Error> {
    let kinematics = Kinematics::PlaneStrain { thickness: 1.0 };
    let mut bodies = vec![body(&mesh, "upper", kinematics, MATERIAL)?];
    let mut supports = Vec::new();
    let secondary = surface(&mesh, "upper.contact", &bodies[0])?;
    let primary = match two {
        true => {
            bodies.push(body(&mesh, "lower", kinematics, MATERIAL)?);
            supports.push(support(&mesh, "lower.equator", [true, true, false])?);
            ModelTarget::Surface(surface(&mesh, "lower.contact", &bodies[1])?)
        }
        false => plane(1, 1.0),
    };
    let mut touch = contact(secondary, primary, DISPLACEMENT);
    touch.integration = integration;
    supports.push(support(&mesh, "upper.equator", [true, false, false])?);
    let motion = lowered(&mesh, "upper.equator", way)?;
    let model = Model {
        contacts: vec![touch],
        bodies,
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
    name: "hertz-cylinder",
    fact: "x",
    run: |size| {
        let mut rows = Vec::new();
        let runs: &[(&str, &[u8], bool)] = match size {
            Size::Quick => &[("coarse", COARSE, false)],
            Size::Full => &[("coarse", COARSE, false), ("middle", MIDDLE, false), ("fine", FINE, false), ("two", TWO, true)],
        };
        for (name, content, two) in runs {
            for (kind, integration) in [("dual", DUAL), ("mortar", MORTAR), ("node", Integration::Node)] {
                let begin = std::time::Instant::now();
                let way = if *two { 4.4e-5 } else { 4.4e-5 };
                let run = pressed(mesh(name, content)?, *two, way, integration)?;
                let time = begin.elapsed().as_secs_f64();
                let costs = run.newton.costs();
                println!("{name} {kind} {time} {:?} {:?} {:?}", costs.phases, costs.work, run.newton.residuals());
                let pair = if *two { pair() } else { Pair::new(BODY, Solid::RIGID_PLANE) };
                let strip = pair.strip(run.force());
                let profile = run.profile(strip.half_width, |r| strip.pressure(r));
                rows.push(Row::at_most(format!("{name} {kind} force"), run.force(), 1e9));
                rows.push(Row::at_most(format!("{name} {kind} half"), strip.half_width, 1e-3));
                rows.push(Row::relative(format!("{name} {kind} peak"), profile.peak, strip.peak, 0.03));
                rows.push(Row::at_most(format!("{name} {kind} l2"), profile.l2, 0.03));
                rows.push(Row::at_most(format!("{name} {kind} inside"), profile.inside, 0.03));
            }
        }
        Ok(rows)
    },
};
