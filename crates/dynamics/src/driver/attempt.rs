//! A step as the caller sees it: attempts, judged, until one is taken or none is left.

use std::time::Instant;

use super::weak::WithWeak;
use super::{Driver, Work};
use crate::compliance::Compliance;
use crate::control::{Closing, Control, Event};
use crate::error::Error;
use crate::interface::Interface;
use crate::operator::Operators;
use crate::scheme::EnergyIdentity;
use crate::step_map::StepMap;

/// Factors and columns of other step sizes that are kept.
const KEPT: usize = 3;

/// Attempts at one step after which a closing cuts it no more.
const CUTS: u32 = 10;

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
        let mut dt = self.unplanned.take().unwrap_or(control.dt);
        let mut forced = self
            .forced
            .filter(|every| (self.state.step + 1).is_multiple_of(*every));
        self.report.attempts = 0;
        loop {
            self.size(dt)?;
            self.look_beyond(&control);
            self.report.attempts += 1;
            let outcome = self.attempt();
            match self.judge(outcome, control.dt) {
                Ok(None) if forced.take().is_some() => self.forget_predictor(),
                Ok(None) => {
                    self.accept(control);
                    return Ok(());
                }
                Ok(Some((event, size))) => {
                    self.forget_predictor();
                    tracing::debug!(
                        "step {}: attempt with {dt:e} s rejected ({event:?})",
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

    /// Makes the map that of a step before one of the size planned.
    fn look_beyond(&mut self, control: &Control) {
        if let Some(rules) = &self.system.adaptive {
            let next = control.next(rules, self.system.dt);
            self.map = self.system.scheme.get().step_map_before(self.dt, next);
        }
    }

    /// Sets the size that the next step is tried with, s, for tests: what an event after the last step would do.
    pub fn force_size(&mut self, dt: f64) {
        self.unplanned = Some(dt);
    }

    /// Tries every `every`-th step once more after dropping its first attempt, which must change no bit of the results: for
    /// tests.
    pub fn force_rejections(&mut self, every: u64) {
        self.forced = Some(every);
    }

    /// What speaks against an attempt, and the size to go on from. `planned`: the size of the steps after it, s.
    fn judge(
        &self,
        outcome: Result<(), Error>,
        planned: f64,
    ) -> Result<Option<(Event, f64)>, (Event, Error)> {
        outcome.map_err(|error| (Event::Failure, error))?;
        let Some(rules) = &self.system.adaptive else {
            return Ok(None);
        };
        if rules.closing == Closing::Cut
            && self.report.attempts <= CUTS
            && let Some(dt) = self.landing(rules, planned)
        {
            return Ok(Some((Event::Closing, dt)));
        }
        let grows = rules.growth.is_some_and(|growth| self.grows(growth));
        Ok(grows.then_some((Event::Growth, self.dt)))
    }

    /// Whether the energy that the scheme balances, less the work of the loads, exceeds its value at the start of the run by more
    /// than this fraction of the largest energy.
    fn grows(&self, growth: f64) -> bool {
        let ledger = &self.next.ledger;
        ledger.free_energy() > growth * ledger.largest_energy
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
