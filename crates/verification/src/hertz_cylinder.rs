//! An elastic cylinder pressed on a rigid plane, and on another cylinder.
//!
//! Problem: the lower half of a cylinder of R = 50 mm, E = 2e4 MPa, ν = 0.3, small and plane strain, its equator brought
//! down by 0.044 mm on a rigid plane; quadrilaterals (cases/hertz-cylinder) with 5, 11 and 21 elements over the half-width
//! of about 1 mm. The same on a second half cylinder whose nodes are not opposite to those of the first. There facets of the
//! lower one make a valley under load, in which a node pressed on one face slides over to the other: node-to-face finds an
//! equilibrium because such a node stays with a face (its gap is then off by 1e-7 of the face). Static stage, ten steps,
//! displacement law. And pressed by a given force of 340 kN/m, spread over an equator that nothing holds but sideways.
//! Closed solution: Hertz, p = p0 √(1 - x²/b²) of the force found; the approach is no local property.
//!
//! Pressures, norms and tolerances as for spheres (`hertz_spheres`): 3 % on the finest mesh, half-width within half an
//! element. Two cylinders are as fine as the middle mesh; node-to-face has no bound there point by point (7 % of p0). The
//! force that the plane takes is the one given, to 1e-9: iterations end at 1e-10 of it.

use carom_bodies::Kinematics;
use carom_contact::Integration;
use carom_dynamics::{Amplitude, Load, LoadKind, Model, ModelTarget, Nonlinear};
use carom_exact::hertz::{Pair, Solid};
use carom_mesh::Mesh;

use crate::Error;
use crate::build::{DISPLACEMENT, body, contact, plane, support, surface, theta};
use crate::check::{Check, Row, Size};
use crate::hertz::{
    BODY, DUAL, Exact, MATERIAL, Pressed, RADIUS, STANDARD, falling, lowered, mesh, pair,
    profile_rows, reach,
};

const COARSE: &[u8] = include_bytes!("../../../cases/hertz-cylinder/cylinder-coarse.msh");
const MIDDLE: &[u8] = include_bytes!("../../../cases/hertz-cylinder/cylinder.msh");
const FINE: &[u8] = include_bytes!("../../../cases/hertz-cylinder/cylinder-fine.msh");
const TWO: &[u8] = include_bytes!("../../../cases/hertz-cylinder/two-cylinders.msh");

const WAY: f64 = 4.4e-5;

/// Elements of the finest mesh at the contact, m.
const FINEST: f64 = 1.5e-3 / 32.0;

/// A half cylinder half-way to the end of its motion, on another one if the mesh has one; with a force in N/m half-way to
/// that, and free to move up and down.
fn pressed(mesh: Mesh, integration: Integration, force: Option<f64>) -> Result<Pressed, Error> {
    let kinematics = Kinematics::PlaneStrain { thickness: 1.0 };
    let mut bodies = vec![body(&mesh, "upper", kinematics, MATERIAL)?];
    let mut supports = vec![support(&mesh, "upper.equator", [true, false, false])?];
    let secondary = surface(&mesh, "upper.contact", &bodies[0])?;
    let mut primary = plane(1, 1.0);
    if mesh.groups.contains_key("lower") {
        let lower = body(&mesh, "lower", kinematics, MATERIAL)?;
        supports.push(support(&mesh, "lower.equator", [true, true, false])?);
        primary = ModelTarget::Surface(surface(&mesh, "lower.contact", &lower)?);
        bodies.push(lower);
    }
    let mut touch = contact(secondary, primary, DISPLACEMENT);
    touch.integration = integration;
    let mut nonlinear = Nonlinear::default();
    match force {
        None => nonlinear.motions = vec![lowered(&mesh, "upper.equator", WAY)?],
        Some(force) => {
            nonlinear.loads = vec![Load {
                name: "force".into(),
                surface: surface(&mesh, "upper.equator", &bodies[0])?,
                kind: LoadKind::Traction([0.0, -force / (2.0 * RADIUS), 0.0]),
                amplitude: Amplitude::constant(1.0),
            }];
        }
    }
    let model = Model {
        contacts: vec![touch],
        supports,
        nonlinear,
        ..Model::new(bodies, mesh, theta(0.5), 1.0)
    };
    Pressed::half(model)
}

/// Rows of one kind of contact over the meshes, the coarsest first, and the last with elements of a 2^`doublings` of those
/// of the finest mesh.
fn rows(
    name: &str,
    (pair, integration): (Pair, Integration),
    meshes: &[&[u8]],
    doublings: usize,
) -> Result<Vec<Row>, Error> {
    let hertz = |force: f64| {
        let strip = pair.strip(force);
        Exact {
            edge: strip.half_width,
            pressure: move |x| strip.pressure(x),
        }
    };
    let (mut means, mut rows) = (Vec::new(), Vec::new());
    let row = |what: &str| format!("{name}: {what}");
    for (k, content) in meshes.iter().enumerate() {
        let mut run = pressed(mesh("cylinder.msh", content)?, integration, None)?;
        means.push(run.on(hertz)?);
        if k + 1 == meshes.len() {
            let strip = pair.strip(run.force());
            let errors = run.errors(&hertz(run.force()));
            rows.extend([
                Row::relative(row("peak pressure, Pa"), run.peak(), strip.peak, 0.03),
                Row::near(
                    row("half-width, m"),
                    0.5 * run.area(),
                    strip.half_width,
                    reach(integration) * FINEST * (1 << doublings) as f64,
                ),
            ]);
            rows.extend(profile_rows(name, &errors, doublings));
        }
    }
    rows.extend(falling(name, &means));
    Ok(rows)
}

/// Rows of a cylinder on a plane under a given force, on the middle mesh.
fn under_force(name: &str, pair: Pair, integration: Integration) -> Result<Vec<Row>, Error> {
    const FORCE: f64 = 3.4e5;
    let strip = pair.strip(FORCE);
    let exact = Exact {
        edge: strip.half_width,
        pressure: |x| strip.pressure(x),
    };
    let mut run = pressed(mesh("cylinder.msh", MIDDLE)?, integration, Some(FORCE))?;
    run.finish()?;
    let name = format!("by a force, {name}");
    let row = |what: &str| format!("{name}: {what}");
    let mut rows = vec![
        Row::relative(row("force on the plane, N/m"), run.force(), FORCE, 1e-9),
        Row::relative(row("peak pressure, Pa"), run.peak(), strip.peak, 0.03),
        Row::near(
            row("half-width, m"),
            0.5 * run.area(),
            strip.half_width,
            2.0 * reach(integration) * FINEST,
        ),
    ];
    rows.extend(profile_rows(&name, &run.errors(&exact), 1));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "hertz-cylinder",
    fact: "a cylinder pressed on a rigid plane, or on another one, has Hertz's pressures",
    run: |size| {
        let (meshes, doublings): (&[&[u8]], _) = match size {
            Size::Quick => (&[COARSE, MIDDLE], 1),
            Size::Full => (&[COARSE, MIDDLE, FINE], 0),
        };
        let alone = Pair::new(BODY, Solid::RIGID_PLANE);
        let mut all = Vec::new();
        for (name, integration) in [
            ("mortar, dual", DUAL),
            ("mortar, standard", STANDARD),
            ("node-to-face", Integration::Node),
        ] {
            all.extend(rows(name, (alone, integration), meshes, doublings)?);
            all.extend(under_force(name, alone, integration)?);
        }
        for (name, integration) in [("dual", DUAL), ("standard", STANDARD)] {
            let name = format!("two cylinders, mortar, {name}");
            all.extend(rows(&name, (pair(), integration), &[TWO], 1)?);
        }
        // no bound point by point: on nodes that are not opposite to each other collocation fails the patch test
        let node = rows(
            "two cylinders, node-to-face",
            (pair(), Integration::Node),
            &[TWO],
            1,
        )?;
        all.extend(node.into_iter().take(3));
        Ok(all)
    },
};
