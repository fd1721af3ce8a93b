//! Steps that several processes take alike.

use carom_algebra::fingerprint::Fingerprint;
use carom_ranks::Ranks;

use crate::certificate::Certificate;
use crate::costs::Costs;
use crate::error::Error;
use crate::march::{FailedProblem, Going, Stepper};
use crate::report::StepReport;
use crate::state::State;
use crate::system::System;

/// A run that each rank takes whole, with the same bits on all of them: every step ends with a look at whether they are the same. What ranks
/// share of it is inside the step.
pub struct Alike<'a> {
    run: &'a mut dyn Stepper,
    ranks: &'a Ranks,
}

impl<'a> Alike<'a> {
    /// A run that all these ranks have.
    pub fn new(run: &'a mut dyn Stepper, ranks: &'a Ranks) -> Alike<'a> {
        Alike { run, ranks }
    }

    /// That all ranks have the same displacement.
    fn check(&self) -> Result<(), Error> {
        let [high, low] = Fingerprint::default()
            .numbers(&self.run.state().motion.u)
            .halves()
            .map(f64::from);
        let mut largest = [high, low, -high, -low];
        self.ranks.reduce(&mut [], &mut largest);
        match largest[0] == -largest[2] && largest[1] == -largest[3] {
            true => Ok(()),
            false => Err(Error::RanksDiffer {
                time: self.run.state().time,
            }),
        }
    }
}

impl Stepper for Alike<'_> {
    fn step(&mut self) -> Result<(), Error> {
        let taken = self.run.step();
        let text = taken.as_ref().err().map(Error::to_string);
        match (self.ranks.first_text(text.as_deref()), taken) {
            (_, Err(error)) => Err(error),
            (Some((rank, cause)), Ok(())) => Err(Error::OnRank { rank, cause }),
            (None, Ok(())) => self.check(),
        }
    }

    fn system(&self) -> &System {
        self.run.system()
    }

    fn state(&self) -> &State {
        self.run.state()
    }

    fn report(&self) -> &StepReport {
        self.run.report()
    }

    fn saved(&self) -> Result<Vec<u8>, Error> {
        self.run.saved()
    }

    fn costs(&self) -> Costs {
        self.run.costs()
    }

    fn certificate(&self) -> Option<&Certificate> {
        self.run.certificate()
    }

    fn failed_problem(&self) -> Option<FailedProblem<'_>> {
        self.run.failed_problem()
    }

    fn agree(&mut self, own: Going) -> Going {
        own.of_all(self.ranks)
    }
}
