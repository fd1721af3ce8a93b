//! Springs, dashpots and fluid gaps whose ends move across the axis that is fixed in space.

use carom_bodies::{Discrete, DiscreteKind};
use carom_dynamics::System;
use carom_pages::form::Form;
use carom_pages::plot::quantity;

use crate::results::lines::{Evidence, Finding, worst};
use crate::verdict::{Bounds, Line};

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// The part of the force that points in a wrong direction: the sine, 0.09 at 5°, 0.26 at 15°.
const TURN: Bounds = Bounds::Both(5.0 * DEGREE, 15.0 * DEGREE);

/// Eccentricity ε of a cylinder in its gap. The added mass is that of the middle: in a narrow gap it grows by the factor 2/(1 + √(1 - ε²)), 1.07 at a
/// half, and terms of the square of the velocity, as large, are left out. At one the walls touch, which nothing stops.
const GAP: Bounds = Bounds::Both(0.5, 1.0);

/// The spring or dashpot with an axis whose ends turn most about each other.
pub(super) fn axis_rotation(evidence: &Evidence) -> Finding {
    let system = evidence.system;
    let found = &evidence.last.records.small.bodies;
    let angles = found.iter().enumerate().filter_map(|(body, found)| {
        let discrete = system.bodies[body].as_discrete()?;
        if matches!(discrete.kind(), DiscreteKind::Fluid(_)) || discrete.directions() != 1 {
            return None;
        }
        let length = discrete.length(found.across.place);
        // of a single point nothing tells a length: the way along the axis says whether it has to do with the motion
        if length == 0.0 && is_beside_another(system, body) {
            return None;
        }
        let angle = found.across.value.atan2(length + found.along);
        Some((discrete.name(), angle))
    });
    let Some((name, value)) = worst(angles) else {
        return Finding::Absent;
    };
    let body = named(system, name);
    let across = found[body].across;
    let remedy = format!(
        "leave out `axis` where the ends move in all directions, or model `{name}` as a bar, which turns with its ends"
    );
    Finding::Line(Line::new(
        "axis-rotation",
        (
            &format!(
                "angle by which the ends of `{name}` have turned from its axis, which is fixed in space ({} across it at {}; over their distance, or on the ground over the size of the model)",
                quantity(across.value, "m"),
                quantity(across.time, "s")
            ),
            value,
            Form::Degrees,
        ),
        TURN,
        &remedy,
    ))
}

/// Whether another spring or dashpot holds the same node.
fn is_beside_another(system: &System, body: usize) -> bool {
    let nodes = |body: usize| {
        let mut all: Vec<u32> = Vec::new();
        system.bodies[body].each_element(&mut |nodes| all.extend(nodes));
        all
    };
    let own = nodes(body);
    let others = (0..system.bodies.len()).filter(|&other| other != body);
    let is_link = |discrete: &Discrete| discrete.directions() > 0;
    let mut links = others.filter(|&other| system.bodies[other].as_discrete().is_some_and(is_link));
    links.any(|other| nodes(other).iter().any(|node| own.contains(node)))
}

/// The fluid gap of which the ends come closest to its walls.
pub(super) fn fluid_gap(evidence: &Evidence) -> Finding {
    let system = evidence.system;
    let found = &evidence.last.records.small.bodies;
    let ways = found.iter().enumerate().filter_map(|(body, found)| {
        let discrete = system.bodies[body].as_discrete()?;
        match discrete.kind() {
            DiscreteKind::Fluid(gap) => Some((discrete.name(), found.across.value / gap.width?)),
            _ => None,
        }
    });
    let Some((name, value)) = worst(ways) else {
        return Finding::Absent;
    };
    let across = found[named(system, name)].across;
    Finding::Line(Line::new(
        "fluid-gap",
        (
            &format!(
                "relative motion of the two sides of the fluid `{name}` over the width of its gap ({} at {}), whose mass is that of concentric cylinders",
                quantity(across.value, "m"),
                quantity(across.time, "s")
            ),
            value,
            Form::Percent,
        ),
        GAP,
        &format!(
            "give `{name}` a stop with the width of its gap, or a fluid that is modelled by other means"
        ),
    ))
}

fn named(system: &System, name: &str) -> usize {
    let body = system.bodies.iter().position(|body| body.name() == name);
    body.unwrap_or_default()
}
