//! Impact of two beams in three dimensions (public test "sdnl111").
//!
//! Problem: cases/sdnl111, two beams of 1 m and 0.02 m x 0.02 m, hexahedra from a Gmsh file, E = 2e11 Pa, ν = 0.3,
//! ρ = 7800 kg/m³, lateral motion blocked everywhere; the striker at 1 m/s, 1e-5 m from the target, which is clamped at
//! its far end. Theta ½, velocity law, CFL 0.5 with the confined wave speed, lumped mass. Closed solution: a bar with the
//! confined modulus: F0 = Z v0 / 2 = 9165.2 N for 4 L / c; displacement of the striker's contact end at t = 2e-4, 4e-4,
//! 6e-4, 8e-4 and 1e-3 s: 1.05000e-4, 1.55420e-4, 5.54199e-5, -9.91602e-5, -2.99160e-4 m. Reference: carom_exact, and the
//! numbers just given. Tolerance: 1 % with 400 elements along each beam, as the public test has it. The quick size has 40
//! elements, where an error of n^-0.69 gives 5 times more: 4 % of the largest of the five displacements (at 6e-4 s the
//! front has just come back, and the small displacement is mostly error), 2 % of the force.

use std::path::Path;

use carom_bodies::Kinematics;
use carom_dynamics::{Driver, Model, ModelTarget};
use carom_exact::{Bar, Contact, Impact, Solution};
use carom_materials::{Elastic, Plane};
use carom_mesh::Mesh;
use carom_mesh::read::gmsh;

use crate::Error;
use crate::build::{HALF, body, contact, group, support, surface, theta};
use crate::check::{Check, Row, Size};
use crate::kind::Kind;

const STEEL: Elastic = Elastic {
    density: 7800.0,
    young: 2e11,
    poisson: 0.3,
};
const SIDE: f64 = 0.02;
const GAP: f64 = 1e-5;
const SPEED: f64 = 1.0;
const INSTANTS: [f64; 5] = [2e-4, 4e-4, 6e-4, 8e-4, 1e-3];
const PUBLISHED: [f64; 5] = [1.05000e-4, 1.55420e-4, 5.54199e-5, -9.91602e-5, -2.99160e-4];

fn mesh(size: Size) -> Result<(Mesh, usize), Error> {
    let (path, bytes, elements): (_, &[u8], _) = match size {
        Size::Quick => (
            "two-beams-coarse.msh",
            include_bytes!("../../../cases/sdnl111/two-beams-coarse.msh"),
            40,
        ),
        Size::Full => (
            "two-beams.msh",
            include_bytes!("../../../cases/sdnl111/two-beams.msh"),
            400,
        ),
    };
    Ok((gmsh::parse(Path::new(path), bytes)?, elements))
}

fn model(mesh: Mesh, elements: usize) -> Result<Model, Error> {
    let mut striker = body(&mesh, "striker", Kinematics::Solid, STEEL)?;
    striker.velocity = [SPEED, 0.0, 0.0];
    let target = body(&mesh, "target", Kinematics::Solid, STEEL)?;
    let supports = vec![
        support(&mesh, "striker", [false, true, true])?,
        support(&mesh, "target", [false, true, true])?,
        support(&mesh, "target.clamped", [true, true, true])?,
    ];
    let secondary = surface(&mesh, "striker.contact", &striker)?;
    let primary = surface(&mesh, "target.contact", &target)?;
    Ok(Model {
        contacts: vec![contact(secondary, ModelTarget::Surface(primary), HALF)],
        supports,
        ..Model::new(
            vec![striker, target],
            mesh,
            theta(0.5),
            0.5 / elements as f64 / STEEL.wave_speed(Plane::Full),
        )
    })
}

fn exact() -> Result<Solution, Error> {
    let modulus = STEEL.wave_modulus(Plane::Full);
    let bar = Bar::new(1.0, SIDE * SIDE, modulus, STEEL.density);
    let impact = Impact::TwoBars {
        secondary: bar.with_velocity(-SPEED),
        primary: bar.clamped(),
        gap: GAP,
    };
    Ok(carom_exact::solve(&impact, 1.1 * INSTANTS[4])?)
}

/// Displacements of the striker's contact end at the instants, m, and the impulse at the end of the last step that
/// ends within `contact`, over the time since its start, N.
fn run(model: Model, contact: &Contact) -> Result<(Vec<f64>, f64), Error> {
    let end = model
        .mesh
        .group_nodes(group(&model.mesh, "striker.contact")?)[0];
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let dof = 3 * driver.system().number[end as usize] as usize;
    let (mut displacements, mut mean) = (Vec::new(), f64::NAN);
    let (mut time, mut u) = (0.0, 0.0);
    while displacements.len() < INSTANTS.len() {
        driver.step()?;
        let state = driver.state();
        let (next, now) = (state.motion.u[dof], state.time);
        // linear within the step: its curvature is far below the tolerance
        let instant = INSTANTS[displacements.len()];
        if now >= instant {
            displacements.push(u + (next - u) * (instant - time) / (now - time));
        }
        if now <= contact.end {
            mean = state.records.contacts[0].impulse() / (now - contact.start);
        }
        (time, u) = (now, next);
    }
    Ok((displacements, mean))
}

pub(crate) const CHECK: Check = Check {
    name: "sdnl111",
    fact: "two beams in three dimensions move and press as the exact solution",
    run: |size| {
        let (mesh, elements) = mesh(size)?;
        let exact = exact()?;
        let striker = &exact.motions()[0];
        let contact = exact.contacts()[0];
        let (displacements, mean) = run(model(mesh, elements)?, &contact)?;
        let mut rows = vec![Row::printed(
            Kind::OtherCode,
            "exact force, N",
            contact.peak_force,
            "9165.2",
        )];
        for (k, instant) in INSTANTS.into_iter().enumerate() {
            // the striker's own axis points away from the contact
            let expected = -striker.displacement(0.0, instant);
            let name = format!("displacement at {instant:.0e} s, m");
            rows.push(
                Row::relative(format!("exact {name}"), expected, PUBLISHED[k], 1e-5).other_code(),
            );
            rows.push(match size {
                Size::Quick => {
                    Row::near(name, displacements[k], expected, 0.04 * PUBLISHED[4].abs())
                }
                Size::Full => Row::relative(name, displacements[k], expected, 0.01),
            });
        }
        let part = match size {
            Size::Quick => 0.02,
            Size::Full => 0.01,
        };
        rows.push(Row::relative(
            "mean force over the contact, N",
            mean,
            contact.peak_force,
            part,
        ));
        Ok(rows)
    },
};
