//! What takes the steps of a zone: the linear driver, or the nonlinear solver where the zone needs it.

use std::sync::Arc;

use super::origin::Origin;
use crate::driver::linked::LinkRow;
use crate::driver::{Costs, Driver};
use crate::error::Error;
use crate::march::{FailedProblem, Stepper};
use crate::newton::Newton;
use crate::state::{State, StepReport};
use crate::system::System;

/// The solver of a zone.
pub enum ZoneDriver {
    /// Of a zone whose steps are linear but for the signs of its contacts.
    Linear(Box<Driver>),
    /// Of another zone.
    Nonlinear(Box<Newton>),
}

/// Calls the method of the same name of whichever solver it is.
macro_rules! either {
    ($self:expr, $driver:ident => $call:expr) => {
        match $self {
            ZoneDriver::Linear($driver) => $call,
            ZoneDriver::Nonlinear($driver) => $call,
        }
    };
}

impl ZoneDriver {
    pub(super) fn new(system: &Arc<System>) -> Result<ZoneDriver, Error> {
        let system = Arc::clone(system);
        Ok(match system.is_nonlinear() {
            true => ZoneDriver::Nonlinear(Box::new(Newton::new(system)?)),
            false => ZoneDriver::Linear(Box::new(Driver::new(system)?)),
        })
    }

    /// The system of the zone.
    pub fn system(&self) -> &System {
        either!(self, driver => driver.system())
    }

    /// The last accepted state.
    pub fn state(&self) -> &State {
        either!(self, driver => driver.state())
    }

    /// What the last step did.
    pub fn report(&self) -> &StepReport {
        either!(self, driver => driver.report())
    }

    /// What the run of the zone cost so far.
    pub fn costs(&self) -> Costs {
        either!(self, driver => driver.costs())
    }

    pub(super) fn failed_problem(&self) -> Option<FailedProblem<'_>> {
        either!(self, driver => Stepper::failed_problem(&**driver))
    }

    pub(super) fn restart(&mut self, u: &[f64], v: &[f64]) -> Result<(), Error> {
        either!(self, driver => driver.restart(u, v))
    }

    pub(super) fn size(&mut self, dt: f64) -> Result<(), Error> {
        match self {
            ZoneDriver::Linear(driver) => driver.size(dt),
            ZoneDriver::Nonlinear(driver) => {
                driver.size(dt);
                Ok(())
            }
        }
    }

    /// Loads at the present instant, N.
    pub(super) fn load(&self) -> &[f64] {
        match self {
            ZoneDriver::Linear(driver) => &driver.system().load,
            ZoneDriver::Nonlinear(driver) => driver.load(),
        }
    }

    pub(super) fn may_touch(&self, dt: f64) -> bool {
        either!(self, driver => driver.state().may_touch(dt, driver.system().tolerance))
    }

    pub(super) fn link(&mut self, force: &[f64]) {
        either!(self, driver => driver.link(force))
    }

    pub(super) fn unlink(&mut self) {
        either!(self, driver => driver.unlink())
    }

    pub(super) fn set_link_force(&mut self, rows: &[(u32, LinkRow)], multipliers: &[f64]) {
        either!(self, driver => driver.set_link_force(rows, multipliers))
    }

    pub(super) fn prepare(&mut self) -> Result<(), Error> {
        match self {
            ZoneDriver::Linear(driver) => driver.prepare(),
            // all of a nonlinear step depends on its forces
            ZoneDriver::Nonlinear(_) => Ok(()),
        }
    }

    pub(super) fn complete(&mut self) -> Result<(), Error> {
        either!(self, driver => driver.complete())
    }

    pub(super) fn take(&mut self) {
        either!(self, driver => driver.take())
    }

    pub(super) fn go_back(&mut self, state: &State) {
        either!(self, driver => driver.go_back(state))
    }

    pub(super) fn next_velocity(&self) -> &[f64] {
        either!(self, driver => driver.next_velocity())
    }

    pub(super) fn row_work(&self, terms: &LinkRow, before: f64, now: f64) -> f64 {
        either!(self, driver => driver.row_work(terms, before, now))
    }

    /// Weights of L at the start and the end of a step in Λ.
    pub(super) fn link_weights(&self) -> [f64; 2] {
        self.system().scheme.link_weights().unwrap_or([0.0, 1.0])
    }

    /// Factors of M and K in the effective matrix, and of its solution in the velocity at the end of a step.
    pub(super) fn effective(&self) -> (f64, f64, f64) {
        either!(self, driver => driver.effective())
    }

    pub(super) fn ramp(
        &mut self,
        (rows, steps): (&[(u32, LinkRow)], u32),
        origin: &Origin,
    ) -> Result<Vec<f64>, Error> {
        match self {
            ZoneDriver::Linear(driver) => Ok(driver.ramp(rows, steps)),
            ZoneDriver::Nonlinear(driver) => driver.ramp((rows, steps), origin),
        }
    }
}
