//! Masses on springs, and the steps that follow them.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use carom_bodies::{DiscreteKind, Tightened};
use carom_dynamics::System;
use carom_pages::plot::quantity;

use super::context::Context;
use super::problems::Problems;

/// Steps to a period below which a run does not follow a vibration: two are the bound of what samples can tell, and a scheme shortens or lengthens the
/// periods of a few steps by tens of per cent.
const FOLLOWED: f64 = 4.0;

/// A node with nothing but point masses and springs.
#[derive(Clone, Default)]
struct Oscillator<'a> {
    name: &'a str,
    /// kg.
    mass: f64,
    /// Sum of the largest stiffnesses of its springs, N/m.
    stiffness: f64,
}

/// Warns of the stiffest mass on springs that the steps do not follow. Its period is that beside ends that stand: the true one is shorter.
/// Links and zones have masses and steps of their own.
pub(super) fn check(context: &Context, system: &System, problems: &mut Problems) {
    let case = context.case;
    let linked = !case.rigid_link.is_empty() || !case.constraint.is_empty();
    if linked || !context.plan.zones.is_empty() || case.time.is_static() {
        return;
    }
    let alone = oscillators(system);
    let squared = |one: &Oscillator| one.stiffness / one.mass;
    let stiffest = alone.max_by(|a, b| squared(a).total_cmp(&squared(b)));
    let Some(one) = stiffest.filter(|one| one.stiffness > 0.0) else {
        return;
    };
    let (period, dt) = (2.0 * PI / squared(&one).sqrt(), system.dt);
    if dt * FOLLOWED > period {
        let [told, step, needed] = [period, dt, period / 20.0].map(|time| quantity(time, "s"));
        problems.warn(format!(
            "mass.{}: on its springs it vibrates with a period of {told}, and a step is {step}: the run does not follow it; take a step of at most {needed}",
            one.name
        ));
    }
}

/// Warns of moments of inertia that no body has: each is at most the sum of the other two.
pub(super) fn warn_of_moments(path: &str, moments: [f64; 3], problems: &mut Problems) {
    let sum: f64 = moments.iter().sum();
    let most = moments.iter().copied().fold(0.0, f64::max);
    // what people round
    if most > 0.5 * sum * (1.0 + 1e-3) {
        problems.warn(format!(
            "{path}: no body has moments of inertia of {moments:?} kg m²: each is at most the sum of the other two"
        ));
    }
}

/// Nodes that have a mass and no body with cells of its own.
fn oscillators(system: &System) -> impl Iterator<Item = Oscillator<'_>> {
    let mut nodes: BTreeMap<u32, Oscillator> = BTreeMap::new();
    for body in &system.bodies {
        let Some(discrete) = body.as_discrete() else {
            continue;
        };
        for cell in discrete.cells() {
            for node in system.mesh.element_nodes(*cell) {
                let one = nodes.entry(*node).or_default();
                match discrete.kind() {
                    DiscreteKind::Mass(point) => {
                        (one.name, one.mass) = (discrete.name(), one.mass + point.mass);
                    }
                    DiscreteKind::Spring(link) | DiscreteKind::Bolt(Tightened { link, .. }) => {
                        one.stiffness += link.curve.steepest();
                    }
                    DiscreteKind::Dashpot(_) | DiscreteKind::Fluid(_) => {}
                }
            }
        }
    }
    let solid = system
        .bodies
        .iter()
        .filter(|body| body.as_discrete().is_none());
    for cell in solid.flat_map(|body| body.cells()) {
        for node in system.mesh.element_nodes(*cell) {
            nodes.remove(node);
        }
    }
    nodes.into_values().filter(|one| one.mass > 0.0)
}
