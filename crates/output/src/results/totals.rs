//! What a run keeps for its summary.

use std::time::Duration;

use carom_dynamics::{
    AssemblyEnergies, AssemblyEnergy, Control, Findings, Ledger, Records, StepReport,
};
use carom_pages::plot::quantity;
use serde::{Deserialize, Serialize};

/// What is counted over the steps.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Totals {
    /// Passes of the status loop.
    pub(crate) passes: u64,
    /// Most passes in a step.
    pub(crate) most_passes: u64,
    /// Accepted states with an energy or a force that is not finite.
    pub(crate) not_finite: u64,
    /// What steps went on after, in the order of [`carom_dynamics::Notices::all`].
    pub(crate) noticed: [Noticed; 3],
    /// Time spent in here by the run itself.
    pub(crate) spent: Duration,
}

/// What was noticed over the run.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Noticed {
    pub(crate) count: u64,
    /// The first step, its end in s, and where or why.
    pub(crate) step: u64,
    pub(crate) time: f64,
    pub(crate) place: String,
}

impl Totals {
    /// Takes what a step has gone on after.
    pub(crate) fn notice(&mut self, report: &StepReport) {
        for (total, notice) in self.noticed.iter_mut().zip(report.notices.all()) {
            if notice.count > 0 && total.count == 0 {
                (total.step, total.time) = (report.step, report.time);
                total.place.clone_from(&notice.place);
            }
            total.count += u64::from(notice.count);
        }
    }

    /// What the steps went on after without harm to their tolerance, in words.
    pub(crate) fn notices(&self) -> Vec<String> {
        let [worse, factored, _] = &self.noticed;
        let first = |noticed: &Noticed| {
            let time = quantity(noticed.time, "s");
            format!("the first in step {} at {time}", noticed.step)
        };
        let mut told = Vec::new();
        if worse.count > 0 {
            told.push(format!(
                "{} iterations were taken although five halvings of their motion left the forces less in balance than before, {}; the imbalance was largest at {}. Their steps came to the tolerance nevertheless",
                worse.count,
                first(worse),
                worse.place
            ));
        }
        if factored.count > 0 {
            told.push(format!(
                "{} steps went over from iterations of their linear equations to factors, {}: {}",
                factored.count,
                first(factored),
                factored.place
            ));
        }
        told
    }
}

/// The last accepted state, as far as the summary needs it.
#[derive(Debug, Default)]
pub(crate) struct Last {
    pub(crate) step: u64,
    pub(crate) time: f64,
    pub(crate) control: Control,
    pub(crate) ledger: Ledger,
    pub(crate) assemblies: AssemblyEnergies,
    pub(crate) records: Records,
    /// Largest residual of the momentum that contacts give to a body, and largest momentum of one, N s; `None` where nothing moves.
    pub(crate) exchange: Option<[f64; 2]>,
    /// Mean velocity of the bodies, m/s.
    pub(crate) velocities: Vec<[f64; 3]>,
    /// What passed through each other, where somebody has looked.
    pub(crate) crossings: Option<Findings>,
    /// Whether each contact has a force.
    pub(crate) closed: Vec<bool>,
    /// Largest crush of a point of each contact that stays, m.
    pub(crate) crushes: Vec<f64>,
}

/// Part of the largest energy in the frame of the model below which rounding hides an energy: the balance is kept to 1e-9 of
/// what is compared with it, and its terms, of the size of the energy in the frame of the model, to some 1e-13 over a run.
const ROUNDING: f64 = 1e-4;

impl Last {
    /// Largest energy of the run, J, in the frames of the assemblies; of static stages that of the ledger.
    pub(crate) fn largest_energy(&self) -> f64 {
        match self.assemblies.largest {
            own if own > 0.0 => own,
            _ => self.ledger.largest_energy,
        }
    }

    /// What the residual of the energy is relative to, J: the largest energy, or what rounding leaves of that in the frame of the model.
    pub(crate) fn balanced_energy(&self) -> f64 {
        let own = self.largest_energy();
        own.max(ROUNDING * self.ledger.largest_energy)
    }

    /// Energy at the start and the largest work of loads, supports and obstacles, J, in the same frames.
    pub(crate) fn put_in(&self) -> f64 {
        let (ledger, own) = (&self.ledger, &self.assemblies);
        match (ledger.is_static, own.largest > 0.0) {
            (true, _) => ledger.largest_energy,
            (false, true) => own.all.iter().map(AssemblyEnergy::put_in).sum::<f64>(),
            (false, false) => ledger.initial.energy() + ledger.largest_given,
        }
    }
}

#[cfg(test)]
mod tests {
    use carom_dynamics::{Notice, Notices};

    use super::*;

    #[test]
    fn what_steps_went_on_after_is_told_with_its_number_and_the_first_place() {
        let notice = |count, place: &str| Notice {
            count,
            place: place.to_owned(),
        };
        let step = |step, notices| StepReport {
            step,
            time: 1e-3 * step as f64,
            notices,
            ..StepReport::default()
        };
        let mut totals = Totals::default();
        assert!(totals.notices().is_empty());
        totals.notice(&step(1, Notices::default()));
        for (number, place) in [(7, "here"), (9, "there")] {
            let notices = Notices {
                worse: notice(2, place),
                clipped: notice(1, place),
                ..Notices::default()
            };
            totals.notice(&step(number, notices));
        }
        let told = totals.notices();
        assert_eq!(told.len(), 1);
        for words in [
            "4 iterations",
            "the first in step 7 at 7.00 ms",
            "largest at here",
        ] {
            assert!(told[0].contains(words), "{words}: {told:?}");
        }
        assert_eq!((totals.noticed[2].count, totals.noticed[2].step), (2, 7));
    }
}
