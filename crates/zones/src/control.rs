//! Outer steps of equal or of adaptive size: attempts, which sizes the zones take, and what they keep for them.

use std::mem::take;

use crate::error::Error;
use crate::link_solver::OuterResponse;
use crate::step::changes_state;
use crate::zones::{Kept, Zones};
use carom_dynamics::{Attempts, Driver, adapt};
use carom_system::Adaptive;

/// Sizes of the outer step whose H is kept beside that of the present one.
const KEPT: usize = 3;

impl Zones {
    /// Takes one outer step. With an adaptive step, attempts in which a contact closes, energy grows, or no solution is found are
    /// dropped in all zones, and a smaller one is tried.
    ///
    /// # Errors
    /// A step of a zone that fails, multipliers that are not found, or energy that grows, with steps that are fixed or the
    /// smallest. The state is then the one before the step.
    pub fn step(&mut self) -> Result<(), Error> {
        let forced = self
            .clock
            .forced
            .is_some_and(|every| (self.clock.step + 1).is_multiple_of(every));
        let largest = self.clock.largest;
        let Some(rules) = self.clock.rules else {
            let outcome = self.attempt_once(forced);
            if outcome.is_err() {
                self.go_back();
            }
            self.clock.attempts = 1;
            outcome?;
            let (step, time) = (self.clock.step, self.clock.time);
            self.accept();
            self.clock
                .control
                .take(None, (step, time, self.clock.dt), largest);
            return Ok(());
        };
        let first = (self.clock.control, self.clock.control.dt);
        let (mut control, attempts) = adapt(self, first, (&rules, largest), forced)?;
        self.clock.attempts = attempts;
        let (step, time) = (self.clock.step, self.clock.time);
        self.accept();
        control.take(Some(&rules), (step, time, self.clock.dt), largest);
        self.clock.control = control;
        Ok(())
    }

    fn attempt_once(&mut self, forced: bool) -> Result<(), Error> {
        let dt = self.clock.dt;
        self.try_size(dt, dt)?;
        if forced {
            self.go_back();
            self.try_size(dt, dt)?;
        }
        Ok(())
    }

    /// Computes an outer step of size `dt` before one of size `next` (both s), which is not accepted.
    fn try_size(&mut self, dt: f64, next: f64) -> Result<(), Error> {
        self.take_size(dt, next)?;
        self.clock.first_cut = f64::INFINITY;
        self.response.products[1] = 0;
        for (k, driver) in self.drivers.iter().enumerate() {
            if changes_state((&self.clock.substeps, &self.between), k)
                && let Some(saved) = &mut self.saved[k]
            {
                saved.clone_from(driver.state());
            }
        }
        self.attempt()
    }

    /// Makes these the sizes of the outer step and of the one after it (both s), with the inner steps of a shock if a contact may close in it,
    /// else those far from it; takes the H of these sizes, or makes it.
    fn take_size(&mut self, dt: f64, next: f64) -> Result<(), Error> {
        let near = || {
            let between = self.between.as_ref();
            self.drivers.iter().any(|driver| driver.may_touch(dt))
                || between.is_some_and(|between| between.may_touch(dt))
        };
        let [of_shock, far] = &self.clock.choices;
        let choice = match of_shock == far || near() {
            true => of_shock,
            false => far,
        };
        let same = *choice == self.clock.substeps && dt == self.clock.dt;
        if same && next == self.clock.next && !self.response.stale {
            return Ok(());
        }
        let now = Kept {
            substeps: std::mem::replace(&mut self.clock.substeps, choice.clone()),
            dt: std::mem::replace(&mut self.clock.dt, dt),
            solver: None,
            outer: OuterResponse::None,
        };
        self.clock.next = next;
        for (driver, m) in self.drivers.iter_mut().zip(&self.clock.substeps) {
            let m = f64::from(*m);
            let next = if m > 1.0 { dt } else { next };
            driver.resize(dt / m, next / m);
        }
        if take(&mut self.response.stale) {
            self.response.kept.clear();
            return self.factorise();
        }
        if same {
            return Ok(());
        }
        if self.response.solver.is_some() {
            if self.response.kept.len() == KEPT {
                self.response.kept.remove(0);
            }
            self.response.kept.push(Kept {
                solver: self.response.solver.take(),
                outer: take(&mut self.response.outer),
                ..now
            });
        }
        let of_size = |kept: &Kept| kept.substeps == self.clock.substeps && kept.dt == dt;
        match self.response.kept.iter().position(of_size) {
            Some(place) => {
                let kept = self.response.kept.remove(place);
                (self.response.solver, self.response.outer) = (kept.solver, kept.outer);
                Ok(())
            }
            None => self.factorise(),
        }
    }

    /// Before the last inner step of a zone in an outer one: the next has another size.
    pub(crate) fn size_inner(&mut self, zone: usize, is_last: bool) {
        if self.clock.next == self.clock.dt {
            return;
        }
        let m = f64::from(self.clock.substeps[zone]);
        let next = if is_last {
            self.clock.next
        } else {
            self.clock.dt
        };
        self.drivers[zone].resize(self.clock.dt / m, next / m);
    }

    /// Looks at the points of a zone with inner steps in the first of them, which is complete and not accepted.
    pub(crate) fn look_ahead(&mut self, zone: usize) {
        if let Some(rules) = &self.clock.rules {
            let planned = self.clock.control.dt / f64::from(self.clock.substeps[zone]);
            let cut = self.drivers[zone].first_cut((rules, self.clock.largest), planned);
            self.clock.first_cut = self.clock.first_cut.min(cut);
        }
    }
}

impl Attempts for Zones {
    fn stable(&mut self, dt: f64) -> Result<f64, carom_dynamics::Error> {
        Ok(dt)
    }

    fn attempt(&mut self, dt: f64, next: f64) -> Result<(), carom_dynamics::Error> {
        Ok(self.try_size(dt, next)?)
    }

    /// Points alone: whether surfaces cross is known once the step of all zones is taken.
    fn passes(&mut self) -> bool {
        self.drivers.iter_mut().any(Attempts::passes)
    }

    fn first_cut(&self, rules: &Adaptive, planned: f64) -> f64 {
        let largest = (rules, self.clock.largest);
        let whole = self.drivers.iter().zip(&self.clock.substeps);
        let whole = whole.filter(|(_, m)| **m == 1);
        let cuts = whole.map(|(driver, _)| driver.first_cut(largest, planned));
        let first = cuts.fold(self.clock.first_cut, f64::min);
        match &self.between {
            Some(between) => {
                first.min(between.first_cut(&self.drivers, largest, [self.clock.dt, planned]))
            }
            None => first,
        }
    }

    fn grows(&self, fraction: f64) -> bool {
        let ended = |(driver, m): (&Driver, &u32)| match *m {
            1 => [
                driver.ended().ledger.free_energy(),
                driver.ended().ledger.largest_energy,
            ],
            _ => [
                driver.state().ledger.free_energy(),
                driver.state().ledger.largest_energy,
            ],
        };
        let ledgers = self.drivers.iter().zip(&self.clock.substeps).map(ended);
        let [free, largest] = ledgers.fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]]);
        free > fraction * largest
    }

    fn withdraw(&mut self) {
        self.go_back();
    }

    fn instant(&self) -> (u64, f64) {
        (self.clock.step, self.clock.time)
    }
}
