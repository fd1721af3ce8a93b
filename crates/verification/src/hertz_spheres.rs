//! Two elastic spheres pressed together.
//!
//! Problem: two spheres of R = 50 mm, E = 2e4 MPa, ν = 0.3, small strain, cut at their equators, which are brought together
//! by 0.04 mm; axisymmetric meshes of quadrilaterals (cases/hertz) with 5, 11 and 21 elements over the contact radius,
//! nodes of both bodies opposite to each other. Static stage, ten steps, displacement law; mortar contact with dual and
//! standard multipliers, and node-to-face. Closed solution: Hertz, F = 586.08 N, p0 = 279.83 MPa, a = 1 mm. Public test
//! SSNV104: 4 mm, where Hertz gives 586.08 kN, 2798.33 MPa, 10 mm.
//!
//! Pressures are nodal forces over areas ∫ N_a dΓ, which are the multipliers of the dual basis; the standard ones are the
//! profile's inverse of these means and swing about it at the edge. Compared with Hertz's profile of the same force, in two
//! norms: relative L2 over the surface, and largest difference over p0 at nodes within 0.9 a (at the edge the exact slope
//! is infinite). Tolerance: 3 % on the finest mesh, as the issue has it; how errors fall with the mesh, in the mean over the
//! second half of the steps, is explained at `hertz::falling`. Force: whole spheres are stiffer than Hertz's half-spaces; a
//! fine mesh gives 1.0 % more, at 4 mm 12 to 13 %, both regressions, so that there pressure and radius are compared at equal force, the way
//! being chosen for it. Contact radius: half an element.

use carom_bodies::Kinematics;
use carom_contact::Integration;
use carom_dynamics::{Model, ModelTarget, Nonlinear};
use carom_mesh::Mesh;

use crate::Error;
use crate::build::{DISPLACEMENT, body, contact, support, surface, theta};
use crate::check::{Check, Row, Size};
use crate::hertz::{
    DUAL, Exact, MATERIAL, Pressed, STANDARD, falling, lowered, mesh, pair, profile_rows, reach,
};

const COARSE: &[u8] = include_bytes!("../../../cases/hertz/spheres-coarse.msh");
const MIDDLE: &[u8] = include_bytes!("../../../cases/hertz/spheres.msh");
const FINE: &[u8] = include_bytes!("../../../cases/hertz/spheres-fine.msh");
const WIDE: &[u8] = include_bytes!("../../../cases/hertz/spheres-wide.msh");

const WAY: f64 = 4e-5;

/// Two half spheres, half-way to the end of a motion of `way` (m).
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
        supports,
        nonlinear: Nonlinear {
            motions: vec![motion],
            ..Nonlinear::default()
        },
        ..Model::new(vec![upper, lower], mesh, theta(0.5), 1.0)
    };
    Pressed::half(model)
}

fn hertz(force: f64) -> Exact<impl Fn(f64) -> f64> {
    let spot = pair().spot_under(force);
    Exact {
        edge: spot.radius,
        pressure: move |r| spot.pressure(r),
    }
}

/// Rows of one kind of contact over the meshes, the coarsest first; `elements`: over the contact radius, of the finest.
fn rows(
    name: &str,
    integration: Integration,
    meshes: &[&[u8]],
    elements: f64,
) -> Result<Vec<Row>, Error> {
    let spot = pair().spot(WAY);
    let (mut means, mut rows) = (Vec::new(), Vec::new());
    let row = |what: &str| format!("{name}: {what}");
    for (k, content) in meshes.iter().enumerate() {
        let mut run = pressed(mesh("spheres.msh", content)?, WAY, integration)?;
        means.push(run.on(hertz)?);
        if k + 1 == meshes.len() {
            let errors = run.errors(&hertz(run.force()));
            let radius = (run.area() / std::f64::consts::PI).sqrt();
            rows.extend([
                Row::near(row("force / Hertz"), run.force() / spot.force, 1.01, 0.005).regression(),
                Row::relative(row("peak pressure, Pa"), run.peak(), spot.peak, 0.03),
                Row::relative(
                    row("contact radius, m"),
                    radius,
                    spot.radius,
                    reach(integration) / elements,
                ),
            ]);
            rows.extend(profile_rows(name, &errors, 3 - meshes.len()));
        }
    }
    rows.extend(falling(name, &means));
    Ok(rows)
}

/// The public test: the way of 4 mm, and the way that gives Hertz's force.
fn wide() -> Result<Vec<Row>, Error> {
    const WAY: f64 = 4e-3;
    let spot = pair().spot(WAY);
    let run = |way: f64| -> Result<Pressed, Error> {
        let mut run = pressed(mesh("spheres-wide.msh", WIDE)?, way, DUAL)?;
        run.on(hertz)?;
        Ok(run)
    };
    let stiffer = run(WAY)?.force() / spot.force;
    let equal = run(WAY / stiffer.powf(2.0 / 3.0))?;
    let errors = equal.errors(&hertz(equal.force()));
    let radius = (equal.area() / std::f64::consts::PI).sqrt();
    let row = |what: &str| format!("4 mm: {what}");
    let mut rows = vec![
        Row::near(
            row("force at equal approach / Hertz"),
            stiffer,
            1.125,
            0.0075,
        )
        .regression(),
        Row::relative(row("force made equal, N"), equal.force(), 586.08e3, 0.01).published(),
        Row::relative(
            row("peak pressure at equal force, Pa"),
            equal.peak(),
            2798.33e6,
            0.03,
        )
        .published(),
        Row::relative(
            row("contact radius at equal force, m"),
            radius,
            0.01,
            0.5 / 11.0,
        )
        .published(),
    ];
    rows.extend(profile_rows("4 mm", &errors, 0));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "hertz-spheres",
    fact: "two spheres pressed together have Hertz's force, contact radius and pressures",
    run: |size| {
        let (meshes, elements): (&[&[u8]], _) = match size {
            Size::Quick => (&[COARSE, MIDDLE], 11.0),
            Size::Full => (&[COARSE, MIDDLE, FINE], 21.0),
        };
        let mut all = vec![
            Row::relative("Hertz: force, N", pair().spot(WAY).force, 586.08, 1e-5).published(),
            Row::relative("Hertz: peak, Pa", pair().spot(WAY).peak, 279.83e6, 2e-5).published(),
        ];
        for (name, integration) in [
            ("mortar, dual", DUAL),
            ("mortar, standard", STANDARD),
            ("node-to-face", Integration::Node),
        ] {
            all.extend(rows(name, integration, meshes, elements)?);
        }
        all.extend(wide()?);
        Ok(all)
    },
};
