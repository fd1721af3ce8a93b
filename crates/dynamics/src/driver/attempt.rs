//! A step as the caller sees it: attempts, judged, until one is taken or none is left.

use std::time::Instant;

use carom_contact::law::Status;

use super::weak::WithWeak;
use super::{Driver, Work};
use crate::compliance::Compliance;
use crate::control::{Adaptive, Closing, Control, Event};
use crate::error::Error;
use crate::interface::Interface;
use crate::operator::Operators;
use crate::scheme::EnergyIdentity;
use crate::step_map::StepMap;

/// Factors and columns of other step sizes that are kept.
const KEPT: usize = 3;

/// Attempts at one step after which a closing cuts it no more.
const CUTS: u32 = 10;

/// Part of a step that a closing must leave before it for a cut: points that chatter would cut every step.
const WORTH: f64 = 0.05;

/// Penetration at which a cut step aims, in tolerances of a closed gap: rounding then leaves no gap that is open.
const AIM: f64 = 10.0;

/// What depends on the size of the step.
pub(super) struct Sized {
    dt: f64,
    map: StepMap,
    identity: Option<EnergyIdentity>,
    operators: Operators,
    compliance: Compliance,
    with_weak: WithWeak,
    interface: Interface,
}

impl Driver {
    /// Takes one step. With an adaptive step, attempts in which a contact closes, energy grows, or no solution is found are
    /// dropped, and a smaller one is tried.
    ///
    /// # Errors
    /// A contact problem without solution, a motion that is not finite, or energy that grows, with steps that are fixed or
    /// the smallest. The state is then the one before the step.
    pub fn step(&mut self) -> Result<(), Error> {
        let mut control = self.state.control;
        let mut dt = control.dt;
        let mut forced = self
            .forced
            .filter(|every| (self.state.step + 1).is_multiple_of(*every));
        self.report.attempts = 0;
        loop {
            self.size(dt)?;
            self.report.attempts += 1;
            let outcome = self.attempt();
            match self.judge(outcome) {
                Ok(None) if forced.take().is_some() => self.forget_predictor(),
                Ok(None) => {
                    self.accept(control);
                    return Ok(());
                }
                Ok(Some((event, size))) => {
                    self.forget_predictor();
                    tracing::debug!(
                        "step {}: dropped with {dt:e} s ({event:?})",
                        self.state.step + 1
                    );
                    let Some(rules) = &self.system.adaptive else {
                        continue;
                    };
                    let smaller = control.drop(rules, event, size);
                    dt = smaller.ok_or_else(|| self.exhausted(event))?;
                }
                Err((event, error)) => {
                    self.forget_predictor();
                    let Some(rules) = &self.system.adaptive else {
                        return Err(error);
                    };
                    dt = control.drop(rules, event, dt).ok_or(error)?;
                }
            }
        }
    }

    /// Tries every `every`-th step once more after dropping its first attempt, which must change no bit of the results: for
    /// tests.
    pub fn force_rejections(&mut self, every: u64) {
        self.forced = Some(every);
    }

    /// What speaks against an attempt, and the size to go on from.
    fn judge(&self, outcome: Result<(), Error>) -> Result<Option<(Event, f64)>, (Event, Error)> {
        outcome.map_err(|error| (Event::Failure, error))?;
        let Some(rules) = &self.system.adaptive else {
            return Ok(None);
        };
        if rules.closing == Closing::Cut
            && self.report.attempts <= CUTS
            && let Some(dt) = self.closing(rules)
        {
            return Ok(Some((Event::Closing, dt)));
        }
        let grows = rules.growth.is_some_and(|growth| self.grows(growth));
        Ok(grows.then_some((Event::Growth, self.dt)))
    }

    /// Whether kinetic and strain energy less the work of the loads exceed their value at the start of the run by more than
    /// this fraction of the largest energy.
    fn grows(&self, growth: f64) -> bool {
        let ledger = &self.next.ledger;
        let free = ledger.balance.energy() - ledger.balance.work_loads;
        free > ledger.initial.energy() + growth * ledger.largest_energy
    }

    /// The first instant within the step at which an open gap closes without the forces of the step, counted from its
    /// start, if there is time for a step before it.
    ///
    /// The gap is the parabola through its value and rate at the start and its value at the end.
    fn closing(&self, rules: &Adaptive) -> Option<f64> {
        let aim = AIM * self.system.tolerance;
        let mut first = f64::INFINITY;
        for point in 0..self.system.points() {
            let start = self.state.interface.gap[point];
            let open = self.state.interface.status[point] == Status::Open;
            let end = self.free_gap(point);
            if !open || start <= self.system.tolerance || !start.is_finite() || end >= -2.0 * aim {
                continue;
            }
            let slope = self.rows.product(point, &self.state.motion.v) * self.dt;
            let bend = end - start - slope;
            let root = root(start + aim, slope, bend);
            first = first.min(root * self.dt);
        }
        let least = rules.smallest.max(WORTH * self.dt);
        (first >= least && first < self.dt).then_some(first)
    }

    /// Gap of a point at the end of the step without its forces, m.
    fn free_gap(&self, point: usize) -> f64 {
        if let Some(gap) = self.predictor.gap(point) {
            return gap;
        }
        match self.candidates.binary_search(&(point as u32)) {
            Ok(k) => self.free_gaps[k],
            Err(_) => self.next.interface.gap[point],
        }
    }

    /// The error of a step that was dropped at the smallest size.
    fn exhausted(&self, event: Event) -> Error {
        debug_assert_eq!(event, Event::Growth);
        Error::EnergyGrowth {
            step: self.state.step + 1,
            time: self.state.time,
            dt: self.dt,
        }
    }

    /// Makes the attempt the state.
    pub(super) fn accept(&mut self, mut control: Control) {
        control.take(
            self.system.adaptive.as_ref(),
            (self.state.step, self.state.time, self.dt),
            self.system.dt,
        );
        self.next.control = control;
        self.failed = None;
        std::mem::swap(&mut self.state, &mut self.next);
        self.tell();
    }

    /// Makes `dt` the size of the next attempt: operators and columns kept from before, or new ones.
    pub(crate) fn size(&mut self, dt: f64) -> Result<(), Error> {
        if dt == self.dt {
            return Ok(());
        }
        let mut other = match self.kept.iter().position(|kept| kept.dt == dt) {
            Some(place) => self.kept.remove(place),
            None => self.sized(dt)?,
        };
        std::mem::swap(&mut self.dt, &mut other.dt);
        std::mem::swap(&mut self.map, &mut other.map);
        std::mem::swap(&mut self.identity, &mut other.identity);
        std::mem::swap(&mut self.operators, &mut other.operators);
        std::mem::swap(&mut self.compliance, &mut other.compliance);
        std::mem::swap(&mut self.with_weak, &mut other.with_weak);
        std::mem::swap(&mut self.interface, &mut other.interface);
        if self.kept.len() == KEPT {
            let forgotten = self.kept.remove(0);
            self.retired
                .add(&forgotten.operators, &forgotten.compliance);
        }
        self.kept.push(other);
        Ok(())
    }

    /// Work over all sizes so far.
    pub(super) fn work(&self) -> Work {
        let mut work = self.retired;
        work.add(&self.operators, &self.compliance);
        for kept in &self.kept {
            work.add(&kept.operators, &kept.compliance);
        }
        work
    }

    fn sized(&mut self, dt: f64) -> Result<Sized, Error> {
        let begin = Instant::now();
        let scheme = self.system.scheme.get();
        let map = scheme.step_map(dt);
        let operators =
            Operators::new(&self.system, map.inertia.x, map.force.x, "effective matrix")?;
        self.phases.factorisation += begin.elapsed();
        Ok(Sized {
            dt,
            map,
            identity: scheme.energy_identity(dt),
            operators,
            compliance: Compliance::new(self.system.points()),
            with_weak: WithWeak::default(),
            interface: Interface::default(),
        })
    }
}

impl Work {
    fn add(&mut self, operators: &Operators, compliance: &Compliance) {
        let factors = operators.operators.iter();
        for stats in factors.filter_map(|operator| operator.stats()) {
            self.factorisations += stats.factorisations;
            self.sweeps += stats.sweeps;
        }
        self.columns += compliance.columns_computed;
    }
}

/// The least root in (0, 1] of `value + slope s + bend s²`, which is positive at 0 and not positive at 1.
fn root(value: f64, slope: f64, bend: f64) -> f64 {
    let discriminant = slope * slope - 4.0 * bend * value;
    if discriminant < 0.0 {
        return 1.0;
    }
    // of the two forms of the roots, the one without cancellation
    let sum = slope + slope.signum() * discriminant.sqrt();
    let roots = [-2.0 * value / sum, -sum / (2.0 * bend)];
    let inside = roots.into_iter().filter(|root| *root > 0.0 && *root <= 1.0);
    inside.fold(1.0, f64::min)
}

#[cfg(test)]
mod tests {
    use super::root;

    #[test]
    fn the_first_root_of_a_parabola_is_found() {
        assert_eq!(root(1.0, -2.0, 0.0), 0.5);
        assert!((root(0.02, -0.3, 0.1) - (0.3 - 0.082f64.sqrt()) / 0.2).abs() < 1e-15);
        assert!((root(1.0, 1.0, -6.0) - 0.5).abs() < 1e-15);
    }
}
