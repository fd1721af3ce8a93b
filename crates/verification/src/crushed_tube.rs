//! A rubber tube thrown at a wall so hard that it closes.
//!
//! Problem: `cases/crushed-tube`: the section of a tube, outer radius 1 m, thickness 0.1 m, plane strain, neo-Hooke, E = 1 MPa,
//! ν = 0.3, ρ = 1000 kg/m³, meets a rigid wall with 8 m/s. Its lower half is thrown back against the upper one; inside and outside
//! are one surface that faces itself. Velocity law at the nodes, energy-momentum, dt = 1 ms.
//!
//! Closed facts: before the inside meets itself, the run is the run without self-contact, for a thin wall does not see its own far
//! side (a second formulation): bit for bit, no row having entered a sum. The wall has no friction and takes no momentum along it; the
//! ledgers of energy, momentum and angular momentum close. No part goes through another: in each state the nodes of the surface that
//! lie in cells of which they are no corner are looked for among all cells, with nothing of the search of the contact, and
//! their depth is the distance from the nearest side of the surface.
//! Tolerances: ledgers 1e-9 (iterations end at 1e-10 of the forces, and 5e-11 is found). Depth: the velocity law with closure as it stands lets a
//! point in by (2 - θ) v dt, θ = ½ (docs/src/theory/laws.md): its way v dt in the step in which it closes, and the part 1 - θ of
//! it in the next, which the scheme moves with the old rate. The way is that of the run, the largest from a gap before to
//! a penetration after: parts of the wall that snap are faster than the tube.
//! Sizes: quick 2 x 48 elements, the first 200 steps; full 2 x 96, 320 steps.

use std::sync::Arc;

use carom_bodies::Kinematics;
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Driver, Model, ModelTarget, Nonlinear, Scheme, System};
use carom_materials::Elastic;

use crate::Error;
use crate::build::{NOW, contact, neo_hooke, plane, surface};
use crate::check::{Check, Row, Size};
use crate::meshes;

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.3,
};
const SPEED: f64 = 8.0;
const STEP: f64 = 1e-3;
/// Half the thickness of the wall, m: deeper points would be lost.
const HALF: f64 = 0.05;
const BALANCE: f64 = 1e-9;
/// 2 - θ of the mid-point rule.
const REACH: f64 = 1.5;

fn newton(mesh: &str, facing_itself: bool) -> Result<Driver, Error> {
    let mesh = meshes::mesh(mesh)?;
    let mut tube = neo_hooke(
        &mesh,
        "tube",
        Kinematics::PlaneStrain { thickness: 1.0 },
        RUBBER,
    )?;
    tube.velocity = [0.0, -SPEED, 0.0];
    let mut contacts = vec![contact(
        surface(&mesh, "tube.outer", &tube)?,
        plane(1, 1.0),
        NOW,
    )];
    if facing_itself {
        let skin = surface(&mesh, "tube.surface", &tube)?;
        contacts.push(contact(skin.clone(), ModelTarget::Surface(skin), NOW));
    }
    let system: Arc<System> = crate::witness::system(Model {
        contacts,
        bodies: vec![tube],
        discrete: Vec::new(),
        supports: Vec::new(),
        named_supports: Vec::new(),
        gravity: [0.0; 3],
        scheme: Scheme::EnergyMomentum(EnergyMomentum {}),
        dt: STEP,
        zones: Vec::new(),
        links: Vec::new(),
        constraints: Vec::new(),
        adaptive: None,
        critical_fraction: None,
        nonlinear: Nonlinear::default(),
        mesh,
    })?;
    Ok(Driver::new(system)?)
}

type Place = [f64; 2];

/// Twice the area of a triangle, positive where c is on the left of the way from a to b.
fn side(a: Place, b: Place, c: Place) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Distance of a place from a segment.
fn distance(a: Place, b: Place, x: Place) -> f64 {
    let (along, to) = ([b[0] - a[0], b[1] - a[1]], [x[0] - a[0], x[1] - a[1]]);
    let part = (along[0] * to[0] + along[1] * to[1]) / (along[0].powi(2) + along[1].powi(2));
    let part = part.clamp(0.0, 1.0);
    (to[0] - part * along[0]).hypot(to[1] - part * along[1])
}

/// Depth of the surface node that lies deepest in a cell of which it is no corner, m.
fn depth(newton: &Driver) -> f64 {
    let (system, u) = (newton.system(), &newton.state().motion.u);
    let place = |node: u32| -> Place {
        let k = node as usize;
        [0, 1].map(|i| system.x[k][i] + u[2 * k + i])
    };
    let faces = &system.contacts[1].secondary_faces;
    let mut nodes: Vec<u32> = faces
        .iter()
        .flat_map(|face| face.corners().to_vec())
        .collect();
    nodes.sort_unstable();
    nodes.dedup();
    let mut deepest = 0.0_f64;
    system.bodies[0].each_element(&mut |cell| {
        for &node in nodes.iter().filter(|node| !cell.contains(node)) {
            let x = place(node);
            let inside = |k: usize| side(place(cell[k]), place(cell[(k + 1) % 4]), x) > 0.0;
            if (0..4).all(inside) {
                let others = faces.iter().filter(|face| !face.corners().contains(&node));
                let ends = others.map(|face| [0, 1].map(|k| place(face.corners()[k])));
                let nearest = ends.map(|[a, b]| distance(a, b, x));
                deepest = deepest.max(nearest.fold(f64::INFINITY, f64::min));
            }
        }
    });
    deepest
}

/// Largest way towards the surface, m, of the points inside that have closed in the last step; `before`: their gaps then.
fn way_in(newton: &Driver, before: &[f64]) -> f64 {
    let inside = newton.system().contacts[1].range.start..;
    let pairs = before.iter().zip(&newton.state().interface.gap[inside]);
    let entered = pairs.filter(|(before, now)| before.is_finite() && **before > 0.0 && **now < 0.0);
    entered.fold(0.0, |most, (before, now)| most.max(before - now))
}

pub(crate) const CHECK: Check = Check {
    name: "crushed-tube",
    fact: "a tube that a wall closes meets itself inside and nowhere else, and no part of it goes through another",
    run: |size| {
        let (mesh, steps) = match size {
            Size::Quick => ("crushed-tube/tube-coarse.msh", 200),
            Size::Full => ("crushed-tube/tube.msh", 320),
        };
        let (mut tube, mut alone) = (newton(mesh, true)?, newton(mesh, false)?);
        let (mut met, mut difference, mut closed) = (0, 0.0_f64, 0);
        let (mut deepest, mut way) = (0.0_f64, 0.0_f64);
        for step in 1..=steps {
            let inside = tube.system().contacts[1].range.start..;
            let before = tube.state().interface.gap[inside].to_vec();
            tube.step()?;
            way = way.max(way_in(&tube, &before));
            let touches = tube.report().contacts[1].closed;
            closed = closed.max(touches);
            if met == 0 && touches > 0 {
                met = step;
            }
            if met == 0 {
                alone.step()?;
                let [u, v] = [&tube, &alone].map(|run| &run.state().motion.u);
                let pairs = u.iter().zip(v);
                difference = pairs.fold(difference, |most, (u, v)| most.max((u - v).abs()));
            } else {
                deepest = deepest.max(depth(&tube));
            }
        }
        let ledger = &tube.state().ledger;
        let (balance, start) = (&ledger.balance, -ledger.initial.momentum.linear[1]);
        let turned = balance.momentum_residual.angular[2].abs();
        let records = &tube.state().records.contacts;
        Ok(vec![
            Row::at_least("steps before the inside meets itself", met as f64, 50.0),
            Row::near(
                "motion until then, less that without self-contact, m",
                difference,
                0.0,
                0.0,
            )
            .second_formulation(),
            Row::at_least("most points with a force inside", closed as f64, 4.0),
            Row::at_least(
                "impulse inside / momentum",
                records[1].impulse() / start,
                0.1,
            ),
            Row::at_most(
                "depth of a node in the body / largest way of a point that closes",
                deepest / way,
                REACH,
            ),
            Row::at_most(
                "penetration of the contact / largest way of a point that closes",
                records[1].penetration / way,
                REACH,
            ),
            Row::at_most("that way / half the thickness", way / HALF, 1.0),
            Row::at_most(
                "momentum along the wall / initial",
                balance.momentum.linear[0].abs() / start,
                1e-10,
            ),
            Row::at_most(
                "energy residual / largest",
                ledger.largest_energy_residual / ledger.largest_energy,
                BALANCE,
            ),
            Row::at_most(
                "momentum residual / largest",
                ledger.largest_momentum_residual / ledger.largest_momentum,
                BALANCE,
            ),
            Row::at_most(
                "angular momentum residual / momentum times radius",
                turned / start,
                BALANCE,
            ),
        ])
    },
};
