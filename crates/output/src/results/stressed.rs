//! The largest equivalent stress of each body over the steps of a run.
//!
//! A look costs a part of the internal forces where stresses are linear in the displacement, and more than these elsewhere. It is therefore taken after every
//! step where steps solve equations and stresses are linear, and less often elsewhere, so that looks cost some 5 % of a run: measured in
//! `sdnl111`, `frames` of beams, `flexible-pendulum`, `dropped-box` and `bird-on-plate`. Static steps are all looked at. What was found at the instants that are kept for
//! pictures is put beside it when the run ends.

use carom_bodies::{LookCost, PeakStress, StressedState};
use carom_dynamics::{State, System};
use serde::{Deserialize, Serialize};

/// Steps from one look to the next: of implicit and of explicit runs.
fn every(is_explicit: bool, cost: LookCost) -> u64 {
    match (cost, is_explicit) {
        (LookCost::Linear, false) => 1,
        (LookCost::Linear, true) => 4,
        (LookCost::General, false) => 2,
        (LookCost::General, true) => 20,
        // measured in `reduced-bracket`: sixty of its steps
        (LookCost::Recovered, _) => 1000,
    }
}

/// What was found so far, and how often it is looked.
#[derive(Debug)]
pub(crate) struct Stressed {
    /// Steps from one look to the next.
    pub(crate) every: u64,
    /// Static steps, of which each is looked at.
    stage: u64,
    /// By body; made at the first look.
    looks: Vec<PeakStress>,
    pub(crate) kept: Kept,
}

/// The largest stress of each body; nothing before the first look.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Kept(Vec<Option<Peak>>);

/// A largest equivalent stress.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct Peak {
    /// Pa.
    pub(crate) value: f64,
    /// The cell among those of all bodies.
    pub(crate) cell: u32,
    /// When, s.
    pub(crate) time: f64,
}

impl Stressed {
    /// Nothing yet.
    pub(crate) fn new(system: &System) -> Stressed {
        let is_explicit = system.schemes.iter().all(|s| s.get().is_explicit());
        let costs = system.bodies.iter().map(PeakStress::cost);
        Stressed {
            every: every(is_explicit, costs.max().unwrap_or(LookCost::Linear)),
            stage: system.static_steps(),
            looks: Vec::new(),
            kept: Kept::default(),
        }
    }

    /// Whether this can be gone on with.
    pub(crate) fn takes(&self, system: &System, Kept(kept): &Kept) -> bool {
        let cells: usize = system.bodies.iter().map(|body| body.cells().len()).sum();
        [0, system.bodies.len()].contains(&kept.len())
            && kept.iter().flatten().all(|peak| peak.is_of(cells))
    }

    /// Whether the state after this step is looked at.
    pub(crate) fn wants(&self, step: u64) -> bool {
        step <= self.stage || step.is_multiple_of(self.every)
    }

    /// Looks at a state if it is one of those to be looked at.
    pub(crate) fn push(&mut self, system: &System, state: &State) {
        if !self.wants(state.step) {
            return;
        }
        let bodies = &system.bodies;
        if self.looks.len() != bodies.len() {
            self.looks = bodies.iter().map(PeakStress::new).collect();
        }
        let Kept(kept) = &mut self.kept;
        kept.resize(bodies.len(), None);
        let (mut first, peaks) = (0, kept.iter_mut().zip(&self.looks));
        for (k, (body, (peak, look))) in bodies.iter().zip(peaks).enumerate() {
            let at = StressedState {
                u: &state.motion.u,
                frames: &state.motion.frames,
                history: system.history(k, &state.motion.history),
            };
            let floor = peak.map_or(0.0, |peak| peak.value);
            if let Some((value, cell)) = look.above(floor, body, &at) {
                *peak = Some(Peak {
                    value,
                    cell: first + cell,
                    time: state.time,
                });
            }
            first += body.cells().len() as u32;
        }
    }

    /// The largest stress of a body; none of a body without stress.
    pub(crate) fn of(&self, body: usize) -> Option<Peak> {
        *self.kept.0.get(body)?
    }

    /// After which steps it was looked, in words.
    pub(crate) fn schedule(&self) -> String {
        match (self.every, self.stage) {
            (1, _) => "largest of all steps".to_owned(),
            (every, 0) => format!("largest of one step in {every} and of the kept instants"),
            (every, _) => format!(
                "largest of each static step, one in {every} after them, and of the kept instants"
            ),
        }
    }
}

impl Peak {
    fn is_of(&self, cells: usize) -> bool {
        self.value.is_finite() && self.time.is_finite() && (self.cell as usize) < cells
    }
}
