//! The loop over the steps.

use carom_algebra::Interrupt;
use carom_ranks::Ranks;
use serde::Serialize;

use crate::certificate::Certificate;
use crate::costs::Costs;
use crate::coulomb::FrictionProblem;
use crate::error::Error;
use crate::interface::InterfaceProblem;
use crate::report::StepReport;
use crate::state::State;
use crate::system::System;

/// What a run is made with: one driver, or the drivers of all zones as one.
pub trait Stepper {
    /// Takes one step.
    ///
    /// # Errors
    /// A step that fails; the state is then the one before it.
    fn step(&mut self) -> Result<(), Error>;
    /// The system that state and report belong to.
    fn system(&self) -> &System;
    /// The state after the last step.
    fn state(&self) -> &State;
    /// The report of the last step.
    fn report(&self) -> &StepReport;
    /// Bytes of everything that the run goes on from.
    ///
    /// # Errors
    /// None is known; the encoder's own error is passed on.
    fn saved(&self) -> Result<Vec<u8>, Error>;
    /// What the run cost so far.
    fn costs(&self) -> Costs;
    /// Who looks at whether bodies pass through each other; none before the first step, and where no process has whole states.
    fn certificate(&self) -> Option<&Certificate>;
    /// The contact problem that made the last step fail.
    fn failed_problem(&self) -> Option<FailedProblem<'_>>;
    /// Whether the run goes on: where several processes take the steps as the first of them says, unless it has failed on any; else `own`. All
    /// ask together, before each step and at the end.
    fn agree(&mut self, own: Going) -> Going {
        own
    }
    /// Ends a step early where this is set: it then fails with [`Error::Interrupted`]. Not asked of ranks, which all take the same steps.
    fn heed(&mut self, _interrupt: &Interrupt) {}
    /// Where several processes take the steps, brings to the first of them what it has to have of the state after a step. All ask together.
    fn bring(&mut self, _scope: Scope) {}
}

/// What somebody looks at of a state; each is in those after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Scope {
    /// The motion of the [watched](Watched) nodes; forces, gaps and statuses of contact points there.
    Watched,
    /// Those of the watched points too.
    Points,
    /// All of it.
    All,
}

/// What the first of several ranks is to have of a state that it does not compute itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Watched {
    /// Nodes (system numbers) whose motion it has after each step, with the contact points there.
    pub nodes: Vec<u32>,
    /// Contact points that it has where somebody looks at points ([`Scope::Points`]).
    pub points: Vec<u32>,
}

impl Watched {
    /// Tells the other ranks what the first one, this, follows.
    pub(crate) fn give(&self, system: &System, ranks: &Ranks) {
        let mesh_node = |node: &u32| f64::from(system.mesh_node[*node as usize]);
        let mut told = vec![self.nodes.len() as f64];
        told.extend(self.nodes.iter().map(mesh_node));
        told.extend(self.points.iter().map(|point| f64::from(*point)));
        ranks.broadcast(&mut told);
    }

    /// What of it is in the part of the system that another rank has.
    pub(crate) fn receive(system: &System, ranks: &Ranks) -> Watched {
        let mut told = Vec::new();
        ranks.broadcast(&mut told);
        let (nodes, points) = told[1..].split_at(told[0] as usize);
        let nodes = nodes.iter().map(|node| system.number[*node as usize]);
        Watched {
            nodes: nodes.filter(|node| *node != u32::MAX).collect(),
            points: points.iter().map(|point| *point as u32).collect(),
        }
    }
}

impl Scope {
    /// From its number.
    pub(crate) fn of(number: f64) -> Scope {
        match number {
            0.0 => Scope::Watched,
            1.0 => Scope::Points,
            _ => Scope::All,
        }
    }
}

/// How a run on several ranks goes on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Going {
    /// It takes another step, or is at its end.
    On,
    /// Somebody asked the first rank to stop it.
    Stopped,
    /// A rank could not write what it has to: why.
    Failed {
        /// The first such rank.
        rank: usize,
        /// Why.
        cause: String,
    },
}

impl Going {
    /// What all ranks do, of what each says of itself. All ask together.
    pub(crate) fn of_all(self, ranks: &Ranks) -> Going {
        let mut said = [
            f64::from(self == Going::Stopped && ranks.is_first()),
            f64::from(matches!(self, Going::Failed { .. })),
        ];
        ranks.reduce(&mut [], &mut said);
        if said[1] != 0.0 {
            let own = match &self {
                Going::Failed { cause, .. } => Some(cause.as_str()),
                _ => None,
            };
            let (rank, cause) = ranks.first_text(own).unwrap_or_default();
            return Going::Failed { rank, cause };
        }
        match said[0] != 0.0 {
            true => Going::Stopped,
            false => Going::On,
        }
    }
}

/// The contact problem of a step that failed.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(untagged)]
pub enum FailedProblem<'a> {
    /// Normal forces alone.
    Normal(&'a InterfaceProblem),
    /// With friction.
    Friction(&'a FrictionProblem),
}

impl FailedProblem<'_> {
    /// Number of the step.
    pub fn step(&self) -> u64 {
        match self {
            FailedProblem::Normal(problem) => problem.step,
            FailedProblem::Friction(problem) => problem.step,
        }
    }
}

/// Something that looks at accepted states: histories, fields, progress.
pub trait Observer {
    /// Called with the initial state (report of step 0) and after every accepted step.
    ///
    /// # Errors
    /// Whatever keeps it from its work; the run ends.
    fn accepted(&mut self, run: &dyn Stepper) -> Result<(), Error>;
    /// Called once at the end, after a failed run too. The state of `run` is the last good one.
    ///
    /// # Errors
    /// Whatever keeps it from its work.
    fn finish(&mut self, run: &dyn Stepper) -> Result<(), Error>;
    /// What it is going to look at beside the report. Asked before [`Observer::accepted`] where several processes take the steps; the
    /// rest of the state may be that of an earlier step then ([`StepReport::partial`]).
    fn looks(&self, _run: &dyn Stepper) -> Scope {
        Scope::All
    }
    /// What ends the step under way early, of an observer that lets somebody do so: it is asked before the first step of a run in one process.
    fn interrupt(&self) -> Option<&Interrupt> {
        None
    }
}

/// An observer that looks at nothing.
pub struct Silent;

impl Observer for Silent {
    fn accepted(&mut self, _: &dyn Stepper) -> Result<(), Error> {
        Ok(())
    }

    fn finish(&mut self, _: &dyn Stepper) -> Result<(), Error> {
        Ok(())
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// At the end time.
    Done,
    /// Somebody asked it to stop.
    Interrupted,
}

/// Steps from the state of `run` to the end time: to the first instant not before it, to within a millionth of the largest
/// step. `stop` is asked before each step; an [`Interrupt`] that the run heeds ends the step under way, which leaves nothing behind.
///
/// # Errors
/// A failed step or observer; observers have finished with the last good state.
pub fn march(
    run: &mut dyn Stepper,
    end: f64,
    observers: &mut [&mut dyn Observer],
    stop: &dyn Fn() -> bool,
) -> Result<Outcome, Error> {
    let told = match run.state().step {
        0 => tell(run, observers),
        _ => Ok(()),
    };
    let result = told.and_then(|()| steps(run, end, observers, stop));
    finish(run, observers, result)
}

/// As [`march`], of a run that goes on: its observers know the present state.
///
/// # Errors
/// As [`march`].
pub fn go_on(
    run: &mut dyn Stepper,
    end: f64,
    observers: &mut [&mut dyn Observer],
    stop: &dyn Fn() -> bool,
) -> Result<Outcome, Error> {
    let result = steps(run, end, observers, stop);
    finish(run, observers, result)
}

/// Tells the observers of the end; the first error is returned.
fn finish(
    run: &mut dyn Stepper,
    observers: &mut [&mut dyn Observer],
    result: Result<Outcome, Error>,
) -> Result<Outcome, Error> {
    run.bring(Scope::All);
    let mut finished = Ok(());
    for observer in observers {
        finished = finished.and(observer.finish(run));
    }
    let outcome = result?;
    finished?;
    Ok(outcome)
}

fn steps(
    run: &mut dyn Stepper,
    end: f64,
    observers: &mut [&mut dyn Observer],
    stop: &dyn Fn() -> bool,
) -> Result<Outcome, Error> {
    loop {
        let at_end = is_at_end(run, end);
        let own = match !at_end && stop() {
            true => Going::Stopped,
            false => Going::On,
        };
        match run.agree(own) {
            Going::Stopped => return Ok(Outcome::Interrupted),
            Going::Failed { rank, cause } => return Err(Error::OnRank { rank, cause }),
            Going::On if at_end => return Ok(Outcome::Done),
            Going::On => {}
        }
        match run.step() {
            Err(Error::Interrupted) => return Ok(Outcome::Interrupted),
            taken => taken?,
        }
        tell(run, observers)?;
    }
}

/// Whether a run has come to its end time (s), up to rounding of the sum of its steps.
pub fn is_at_end(run: &dyn Stepper, end: f64) -> bool {
    run.state().time >= end - 1e-6 * run.system().dt
}

/// Number of equal steps of length `dt` to the end time.
pub fn step_count(end: f64, dt: f64) -> u64 {
    (end / dt - 1e-6).ceil().max(0.0) as u64
}

fn tell(run: &mut dyn Stepper, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
    let scopes = observers.iter().map(|observer| observer.looks(run));
    let scope = scopes.max().unwrap_or(Scope::Watched);
    run.bring(scope);
    let told = observers
        .iter_mut()
        .try_for_each(|observer| observer.accepted(run));
    if let Err(error) = &told {
        // other ranks wait before their next step
        let cause = error.to_string();
        run.agree(Going::Failed { rank: 0, cause });
    }
    told
}
