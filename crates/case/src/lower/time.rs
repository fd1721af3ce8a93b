//! Step and scheme, and what the scheme refuses.

use std::sync::Arc;

use carom_contact::law::{Defaults, Level};
use carom_dynamics::{Adaptive, Closing, ModelBody, Scheme, System, step_count};
use carom_mesh::Mesh;
use carom_zones::Error;

use super::context::Context;
use super::problems::Problems;
use super::refused;
use crate::error::Problem;
use crate::schema::{self, LargestStep, Mass, MeshStep, Step, StepRule};

/// Most steps of a run: beyond it a case is a slip of the pen.
const MOST_STEPS: u64 = 1_000_000_000;

/// A step as the case says it.
#[derive(Clone, Copy)]
pub(super) enum Size {
    /// In s.
    Fixed(f64),
    /// Fraction of the time in which a wave crosses an element.
    Courant(f64),
    /// Fraction of the critical step.
    Critical(f64),
}

/// The scheme of the bodies that take the outer step; of the first such zone, if there are several.
pub(super) fn outer_scheme(context: &Context) -> Scheme {
    let outer = context.plan.zones.iter().find(|zone| zone.substeps == 1);
    outer.map_or(context.case.time.scheme(), |zone| zone.scheme)
}

/// Refuses a critical step of implicit schemes, and masses that a scheme cannot take.
pub(super) fn schemes(context: &Context, problems: &mut Problems) {
    let zones = context.plan.zones.iter().filter(|zone| zone.substeps == 1);
    let mut outer: Vec<Scheme> = zones.map(|zone| zone.scheme).collect();
    if context.plan.zones.is_empty() {
        outer.push(context.case.time.scheme());
    }
    if let (path, Size::Critical(_)) = size(context)
        && let Some(scheme) = outer.first().map(Scheme::get)
        && outer.iter().all(|scheme| !scheme.get().is_explicit())
    {
        let problem = Problem::new(path, "only an explicit scheme has a critical step");
        let problem = problem.found(scheme.name());
        problems.push(problem.accepted(["step = { courant = ... }", "a fixed step"]));
    }
    for (number, (name, body)) in context.case.body.iter().enumerate() {
        let scheme = context.scheme_of(number);
        if scheme.get().needs_lumped_mass() && body.mass == Some(Mass::Consistent) {
            let message = "the scheme divides by the mass: it must be diagonal";
            let problem = Problem::new(format!("body.{name}.mass"), message);
            let problem = problem.found(format!("consistent with {}", scheme.get().name()));
            problems.push(problem.accepted(["lumped"]));
        }
    }
}

/// Why a scheme cannot take a law.
struct NotTaken {
    key: &'static str,
    message: &'static str,
    found: &'static str,
    accepted: &'static [&'static str],
}

const NEEDS_RATE: NotTaken = NotTaken {
    key: "law",
    message: "the contact impulses of this scheme act on the velocity at the end of the step: the scheme needs a law in the rate",
    found: "a law in the gap",
    accepted: &["velocity", "compliance", "restitution"],
};
const IMPOSSIBLE: NotTaken = NotTaken {
    key: "law.displacement",
    message: "in an explicit scheme the displacement at the end of the step does not depend on the contact force: this law is impossible",
    found: "displacement",
    accepted: &["velocity", "damped"],
};
const NEEDS_DISPLACEMENT: NotTaken = NotTaken {
    key: "law",
    message: "the contact forces of this scheme act on the displacement at the end of the step: the scheme needs the displacement law",
    found: "another law",
    accepted: &["displacement"],
};

/// Refuses laws that the scheme of their contact cannot take, one problem a reason.
pub(super) fn laws(context: &Context, scheme_of: impl Fn(&str) -> Scheme, problems: &mut Problems) {
    for (name, contact) in context.case.contact.iter() {
        let scheme = scheme_of(name);
        let scheme = scheme.get();
        // what is wrong with a curve is told where the law is built
        let Ok(law) = contact.law.law(&Defaults::default()) else {
            continue;
        };
        let level = law.get().level();
        if scheme.takes(level) {
            continue;
        }
        let in_rate = level != Level::Rate && scheme.takes(Level::Rate) && !scheme.is_explicit();
        let row = match (in_rate, level) {
            (true, _) => &NEEDS_RATE,
            (false, Level::Gap) => &IMPOSSIBLE,
            (false, _) => &NEEDS_DISPLACEMENT,
        };
        let problem = Problem::new(format!("contact.{name}.{}", row.key), row.message);
        let problem = problem.found(format!("{} with {}", row.found, scheme.name()));
        problems.push(problem.accepted(row.accepted.to_vec()));
    }
}

/// The step in seconds, with zones the outer one. `systems`: that of each zone, or of all.
pub(super) fn step(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    systems: impl FnOnce() -> Result<Vec<Arc<System>>, Error>,
    problems: &mut Problems,
) -> Option<f64> {
    let time = &context.case.time;
    // the steps of a static stage are counted by themselves; a case that is all static has no others
    let begin = time.stage.filter(|_| !time.is_static());
    let duration = time.end.0 - begin.map_or(0.0, |stage| stage.end.0);
    let (path, size) = size(context);
    let dt = match size {
        Size::Fixed(dt) => dt,
        Size::Courant(courant) => {
            let outer = bodies.iter().enumerate();
            let outer = outer.filter(|(body, _)| context.plan.is_outer(*body));
            courant * crossing(mesh, outer.map(|(_, body)| body))
        }
        Size::Critical(fraction) => fraction * critical(context, systems, problems)?,
    };
    let steps = step_count(duration, dt);
    if !(dt > 0.0 && dt.is_finite()) || steps > MOST_STEPS {
        let problem = Problem::new(path, "the run would never end")
            .found(format!("{:.3e} steps of {dt:.3e} s", duration / dt));
        return problems.refuse(problem.accepted([format!("at most {MOST_STEPS:e} steps")]));
    }
    if steps == 0 {
        let problem = Problem::new("time.end", "the run ends before its first step")
            .found(format!("{duration:e} s"));
        return problems.refuse(problem.accepted([format!("at least one step of {dt:e} s")]));
    }
    Some(dt)
}

/// The step, or the largest, as the case says it, and its key.
pub(super) fn size(context: &Context) -> (&'static str, Size) {
    match context.case.time.step() {
        Step::Fixed(step) => ("time.step", Size::Fixed(step.0)),
        Step::Rule(StepRule::Courant(courant)) => ("time.step.courant", Size::Courant(courant)),
        Step::Rule(StepRule::Critical(part)) => ("time.step.critical", Size::Critical(part)),
        Step::Rule(StepRule::Adaptive(rules)) => match rules.largest {
            LargestStep::Fixed(step) => ("time.step.adaptive.largest", Size::Fixed(step.0)),
            LargestStep::FromMesh(MeshStep::Courant(courant)) => {
                ("time.step.adaptive.largest.courant", Size::Courant(courant))
            }
            LargestStep::FromMesh(MeshStep::Critical(part)) => {
                ("time.step.adaptive.largest.critical", Size::Critical(part))
            }
        },
    }
}

/// The rules of an adaptive step, whose largest is `largest` (s).
pub(super) fn adaptive(
    context: &Context,
    largest: f64,
    problems: &mut Problems,
) -> Option<Adaptive> {
    let Step::Rule(StepRule::Adaptive(rules)) = context.case.time.step() else {
        return None;
    };
    let smallest = rules.smallest.map_or(1e-3 * largest, |step| step.0);
    if !(smallest > 0.0 && smallest <= largest) {
        let problem = Problem::new(
            "time.step.adaptive.smallest",
            "the smallest step must be positive and at most the largest",
        );
        let problem = problem.found(format!("{smallest:e} s"));
        problems.push(problem.accepted([format!("at most {largest:e} s")]));
    }
    Some(Adaptive {
        smallest,
        closing: match rules.closing {
            schema::Closing::Cut => Closing::Cut,
            schema::Closing::Pass => Closing::Pass,
        },
        growth: Some(rules.energy_growth),
        patience: rules.patience,
    })
}

/// Critical step of the explicit schemes among those that take the outer step, in s.
fn critical(
    context: &Context,
    systems: impl FnOnce() -> Result<Vec<Arc<System>>, Error>,
    problems: &mut Problems,
) -> Option<f64> {
    let zones = &context.plan.zones;
    match systems() {
        Ok(systems) => {
            let outer = systems.iter().enumerate().filter(|(k, system)| {
                system.scheme.get().is_explicit()
                    && zones.get(*k).is_none_or(|zone| zone.substeps == 1)
            });
            let steps = outer.map(|(_, system)| system.critical_step());
            Some(steps.fold(f64::INFINITY, f64::min))
        }
        Err(error) => problems.refuse(refused::by_zones(context, &error)),
    }
}

/// Least time in which a wave crosses an element, h_e / c, in s.
fn crossing<'m>(mesh: &Mesh, bodies: impl Iterator<Item = &'m ModelBody>) -> f64 {
    let time = |body: &ModelBody| {
        let speed = body.spec.material.wave_speed(body.spec.kinematics.plane());
        body.spec
            .cells
            .iter()
            .map(|&cell| carom_bodies::smallest_size(mesh, cell) / speed)
            .fold(f64::INFINITY, f64::min)
    };
    let deform = bodies.filter(|body| body.rigid.is_none());
    deform.map(time).fold(f64::INFINITY, f64::min)
}
