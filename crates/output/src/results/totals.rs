//! What a run keeps for its summary.

use std::time::Duration;

use carom_dynamics::{AssemblyEnergies, AssemblyEnergy, Control, Ledger, Records};
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
    /// Time spent in here by the run itself.
    pub(crate) spent: Duration,
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
    /// Pairs of bodies that met with no contact between them.
    pub(crate) unjoined: Vec<[usize; 2]>,
    /// Mean velocity of the bodies, m/s.
    pub(crate) velocities: Vec<[f64; 3]>,
    /// Whether each contact has a force.
    pub(crate) closed: Vec<bool>,
    /// Largest crush of a point of each contact that stays, m.
    pub(crate) crushes: Vec<f64>,
}

/// Part of the largest energy in the frame of the model below which rounding hides an energy: the balance is kept to 1e-9 of
/// what is compared with it, and its terms, of the size of the energy in the frame of the model, to some 1e-13 over a run.
const ROUNDING: f64 = 1e-4;

impl Last {
    /// Largest energy of the run, J, in the frames of the assemblies; of static stages, and of zones that step by themselves, that of
    /// the ledger.
    pub(crate) fn largest_energy(&self) -> f64 {
        match self.assemblies.largest {
            own if own > 0.0 => own.max(ROUNDING * self.ledger.largest_energy),
            _ => self.ledger.largest_energy,
        }
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
