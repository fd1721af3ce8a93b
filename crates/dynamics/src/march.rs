//! The loop over the steps.

use crate::driver::Driver;
use crate::error::Error;
use crate::state::{State, StepReport};
use crate::system::System;

/// Something that looks at accepted states: histories, fields, progress.
pub trait Observer {
    /// Called with the initial state (report of step 0) and after every accepted step.
    ///
    /// # Errors
    /// Whatever keeps it from its work; the run ends.
    fn accepted(
        &mut self,
        system: &System,
        state: &State,
        report: &StepReport,
    ) -> Result<(), Error>;
    /// Called once at the end, after a failed run too. `state` is the last good one.
    ///
    /// # Errors
    /// Whatever keeps it from its work.
    fn finish(&mut self, system: &System, state: &State) -> Result<(), Error>;
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// At the end time.
    Done,
    /// Somebody asked it to stop.
    Interrupted,
}

/// Steps from the driver's state to the end time: to the first instant not before it, to within a millionth of the largest
/// step. `stop` is asked before each step.
///
/// # Errors
/// A failed step or observer; observers have finished with the last good state.
pub fn march(
    driver: &mut Driver,
    end: f64,
    observers: &mut [&mut dyn Observer],
    stop: &dyn Fn() -> bool,
) -> Result<Outcome, Error> {
    let result = steps(driver, end, observers, stop);
    let mut finished = Ok(());
    for observer in observers {
        finished = finished.and(observer.finish(driver.system(), driver.state()));
    }
    let outcome = result?;
    finished?;
    Ok(outcome)
}

fn steps(
    driver: &mut Driver,
    end: f64,
    observers: &mut [&mut dyn Observer],
    stop: &dyn Fn() -> bool,
) -> Result<Outcome, Error> {
    let end = end - 1e-6 * driver.system().dt;
    if driver.state().step == 0 {
        tell(driver, observers)?;
    }
    while driver.state().time < end {
        if stop() {
            return Ok(Outcome::Interrupted);
        }
        driver.step()?;
        tell(driver, observers)?;
    }
    Ok(Outcome::Done)
}

/// Number of equal steps of length `dt` to the end time.
pub fn step_count(end: f64, dt: f64) -> u64 {
    (end / dt - 1e-6).ceil().max(0.0) as u64
}

fn tell(driver: &Driver, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
    observers.iter_mut().try_for_each(|observer| {
        observer.accepted(driver.system(), driver.state(), driver.report())
    })
}
