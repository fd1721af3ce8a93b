//! The forces of a step as its balance takes them: their means over the step, works on its way and resultants.

use std::ops::Range;

use crate::resultant::Resultant;
use crate::system::{Motion, System};

/// What the means of the forces of a step are made with.
pub(crate) struct MeanForces<'a> {
    pub(crate) system: &'a System,
    pub(crate) old: &'a Motion,
    pub(crate) new: &'a Motion,
    /// Room for a mean.
    pub(crate) mean: &'a mut Vec<f64>,
}

/// A force at the start of a step and of the step, N, with its weights there in each zone.
#[derive(Clone, Copy)]
pub(crate) struct Weighted<'a> {
    /// Empty where it is not known.
    pub(crate) before: &'a [f64],
    pub(crate) now: &'a [f64],
    pub(crate) weights: &'a [[f64; 2]],
}

impl MeanForces<'_> {
    /// Work on the way of the step, J.
    pub(crate) fn work(&mut self, force: Weighted) -> f64 {
        let force = mean_force(force, &self.system.spans, self.mean);
        work(force, 0..force.len(), [self.old, self.new])
    }

    /// The same, and the resultant at the places of the step.
    pub(super) fn work_and_resultant(&mut self, force: Weighted) -> (f64, Resultant) {
        let force = mean_force(force, &self.system.spans, self.mean);
        of_mean(self.system, force, [self.old, self.new])
    }

    /// The same, with the work on each connected part added to what it is `given` from outside.
    pub(crate) fn given(&mut self, force: Weighted, given: &mut [f64]) -> (f64, Resultant) {
        let force = mean_force(force, &self.system.spans, self.mean);
        let both = of_mean(self.system, force, [self.old, self.new]);
        if !force.is_empty() {
            for (given, part) in given.iter_mut().zip(&self.system.parts) {
                *given += work(force, part.clone(), [self.old, self.new]);
            }
        }
        both
    }
}

/// Work of a mean force on the way of the step, J, and its resultant at the places of the step.
fn of_mean(system: &System, force: &[f64], [old, new]: [&Motion; 2]) -> (f64, Resultant) {
    let places = (&old.frames[..], &[&old.u[..], &new.u[..]][..]);
    let work = work(force, 0..force.len(), [old, new]);
    (work, Resultant::at(system, places, force))
}

/// Work of the forces of some unknowns on the way from one motion to another, J.
fn work(force: &[f64], unknowns: Range<usize>, [old, new]: [&Motion; 2]) -> f64 {
    unknowns.map(|i| force[i] * (new.u[i] - old.u[i])).sum()
}

/// Mean of a force over the step with the weights of each zone, N: the force of the step where that at the start has no weight or is not known.
fn mean_force<'a>(
    force: Weighted<'a>,
    zones: &[(Range<usize>, usize)],
    mean: &'a mut Vec<f64>,
) -> &'a [f64] {
    let Weighted {
        before,
        now,
        weights,
    } = force;
    let from_start = weights.iter().any(|of| of[0] != 0.0);
    if !from_start || before.len() != now.len() {
        return now;
    }
    mean.clear();
    for (span, zone) in zones.iter().filter(|_| !now.is_empty()) {
        let [old, new] = weights[*zone];
        let forces = before[span.clone()].iter().zip(&now[span.clone()]);
        mean.extend(forces.map(|(before, now)| old * before + new * now));
    }
    mean
}
