//! Linear elements that lock in bending.

use carom_dynamics::System;
use carom_pages::form::Form;
use carom_pages::plot::quantity;

use crate::results::lines::{Evidence, Finding, worst};
use crate::verdict::{Bounds, Line};

/// Energy by which elements lock, over the strain energy: where it is s, the body is too stiff in bending by 1/(1 - s) at least. One
/// layer of squares has 0.26 to 0.38, two have 0.08 to 0.13, four have 0.02 to 0.04. What is above 0.15 is a sixth too stiff and more, which two
/// layers of squares are not; above a half most of the stiffness is that of the elements.
const BOUNDS: Bounds = Bounds::Both(0.15, 0.5);

/// Strain energy over the largest energy of the bodies around, below which a body is not judged: what rounding and a solver leave in
/// a body that flies.
const NOTHING: f64 = 1e-6;

/// The body that locks most.
pub(super) fn in_bending(evidence: &Evidence) -> Finding {
    let system = evidence.system;
    let found = &evidence.last.records.small.bodies;
    let shares = found.iter().enumerate().filter_map(|(body, found)| {
        let locking = found.locking;
        let least = NOTHING * largest_energy(evidence, body);
        let judged = locking.energy > least && locking.energy > 0.0;
        judged.then(|| (system.bodies[body].name(), locking.locked / locking.energy))
    });
    let Some((name, value)) = worst(shares) else {
        return Finding::Absent;
    };
    let body = system.bodies.iter().position(|body| body.name() == name);
    let body = body.unwrap_or_default();
    let time = quantity(found[body].locking.time, "s");
    Finding::Line(Line::new(
        "bending-locked",
        (
            &format!(
                "energy that the linear elements of body `{name}` take to bend beyond that of bending, relative to their strain energy where that was largest, at {time}"
            ),
            value,
            Form::Percent,
        ),
        BOUNDS,
        &instead(system, body),
    ))
}

/// The largest energy around a body, J.
fn largest_energy(evidence: &Evidence, body: usize) -> f64 {
    let system = evidence.system;
    let number = system.assemblies.of_part[system.part_of_body[body]];
    let own = evidence.last.assemblies.all.get(number);
    own.map_or(evidence.last.largest_energy(), |own| own.largest)
}

/// What does not lock.
fn instead(system: &System, body: usize) -> String {
    let body = &system.bodies[body];
    let (name, solid) = (body.name(), body.as_solid());
    let one_point = match solid.is_some_and(|solid| solid.has_finite_strain()) {
        true => {
            format!(", or body.{name}.formulation = {{ reduced = {{}} }} on four layers and more")
        }
        false => String::new(),
    };
    let thin = match system.dim {
        3 => "a beam or a shell",
        _ => "a beam",
    };
    format!(
        "give `{name}` at least four layers of elements across what bends, no longer than high (mesh.refine), or quadratic elements (order 2 in the mesh file), or model it as {thin}{one_point}"
    )
}
