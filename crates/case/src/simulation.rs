//! A run whose steps are taken one by one by a program.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use carom_dynamics::{Observer, Outcome, Stepper, is_at_end};
use carom_output::Results;

use crate::input::Input;
use crate::lower::{AddedForce, Built};
use crate::origin::Origin;
use crate::run::{Failed, Finished, conclude, settings};
use crate::schema::Case;
use crate::stepping::Stepping;

/// A run that is driven from outside: the same steps as those of [`run`](crate::run()), with the same bits.
pub struct Simulation {
    built: Built,
    run: Stepping,
    results: Option<Results>,
    begin: Instant,
}

impl Simulation {
    /// At the initial state; `folder`: where results are written, if anywhere. `added`: the forces that the case was built with beside
    /// its own. A checkpoint names them, so that `carom resume`, which has no program to set them, refuses it.
    ///
    /// # Errors
    /// The run cannot begin, or the folder cannot be made.
    pub fn new(
        (input, case, built): (&Input, &Case, Built),
        added: &[AddedForce],
        folder: Option<PathBuf>,
    ) -> Result<Simulation, Failed> {
        let begin = Instant::now();
        let run = Stepping::new(&built, None).map_err(Failed::Start)?;
        let results = match folder {
            None => None,
            Some(folder) => {
                let names: Vec<&str> = added.iter().map(|force| &*force.name).collect();
                let origin = Origin::of(input, case, &folder).with_forces(&names);
                let mut settings = settings((input, case, &built), folder, &origin);
                if !names.is_empty() {
                    let why = "they are stated for the file alone, without forces set by a program";
                    settings.expected.unjudged = Some(why.to_owned());
                }
                let mut results = Results::create(settings, Arc::clone(&built.system))?;
                results.accepted(run.get()).map_err(Failed::Step)?;
                Some(results)
            }
        };
        Ok(Simulation {
            built,
            run,
            results,
            begin,
        })
    }

    /// The case as built.
    pub fn built(&self) -> &Built {
        &self.built
    }

    /// The run: its last accepted state, and the report of its last step.
    pub fn run(&self) -> &dyn Stepper {
        self.run.get()
    }

    /// Whether the end of the case is reached, to within a millionth of the largest step.
    pub fn is_done(&self) -> bool {
        is_at_end(self.run.get(), self.built.end)
    }

    /// Takes one step, also beyond the end of the case.
    ///
    /// # Errors
    /// The step fails: the state is then the one before it. Its results cannot be written.
    pub fn step(&mut self) -> Result<(), Failed> {
        self.run.get_mut().step().map_err(Failed::Step)?;
        match &mut self.results {
            Some(results) => results.accepted(self.run.get()).map_err(Failed::Step),
            None => Ok(()),
        }
    }

    /// Bytes of everything that the run goes on from.
    ///
    /// # Errors
    /// None is known; the encoder's own error is passed on.
    pub fn saved(&self) -> Result<Vec<u8>, Failed> {
        self.run.get().saved().map_err(Failed::Step)
    }

    /// Goes on from the bytes of [`Simulation::saved`] of the same case. Only without a results folder, whose rows would not be those of
    /// the state.
    ///
    /// # Errors
    /// There is a results folder; bytes that are no state, or one of another model. The state is then the one before.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), Failed> {
        if self.results.is_some() {
            let cause = "a run with a results folder cannot go back to a saved state".to_owned();
            return Err(Failed::Start(carom_dynamics::Error::State { cause }));
        }
        self.run = Stepping::new(&self.built, Some(bytes)).map_err(Failed::Start)?;
        Ok(())
    }

    /// Ends the run: a checkpoint, the figures, the report and the summary, if there is a results folder. `failed`: the error of the last
    /// step, which is given back once all that was computed before stands in the folder.
    ///
    /// # Errors
    /// `failed`; results cannot be written.
    pub fn finish(&mut self, failed: Option<Failed>) -> Result<Option<Finished>, Failed> {
        let Some(mut results) = self.results.take() else {
            return failed.map_or(Ok(None), Err);
        };
        let run = self.run.get();
        let finished = results.finish(run).map_err(Failed::Step);
        let outcome = match (failed, finished) {
            (Some(Failed::Step(error)), _) => Err(error),
            (Some(other), _) => return Err(other),
            (None, Err(Failed::Step(error))) => Err(error),
            (None, Err(other)) => return Err(other),
            (None, Ok(())) => Ok(match self.is_done() {
                true => Outcome::Done,
                false => Outcome::Interrupted,
            }),
        };
        let times = (self.begin, self.built.end);
        let zones = self.run.zones(&self.built);
        let concluded = conclude((results, outcome), (self.run.get(), zones), times);
        concluded.map(Some)
    }
}
