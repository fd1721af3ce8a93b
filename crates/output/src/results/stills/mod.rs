//! The instants that a run keeps for its pictures: at equal times, where a contact first closes, at the largest force, at the last
//! release, and the end.
//!
//! The stress of all cells costs as much as some twenty explicit steps. Instants at equal times are therefore chosen beforehand. The
//! largest force and the last release are not known before the end: their states are copied, seldom enough
//! to cost little, and turned into pictures when the run ends or a checkpoint is written. Memory is bounded by the number of instants.

mod seen;
mod still;

use carom_dynamics::{InterfaceState, Motion, State, StepReport, System};
use serde::{Deserialize, Serialize};

pub(crate) use seen::Seen;
pub(crate) use still::{Largest, Still, slips};

/// Equal parts of the run at whose ends states are kept: this many times the pictures of the film less one.
const PARTS: [usize; 2] = [3, 6];

/// Pictures of the film less one.
pub(crate) const FILM: usize = 5;

/// Most bytes of the instants at equal times, of a model so large that [`PARTS`] allows fewer.
const BYTES: usize = 64 << 20;

/// Explicit and implicit steps to an instant at least: an instant costs twenty of the former and a quarter of the latter, so that all cost
/// less than a tenth of the run.
const STEPS: [f64; 2] = [250.0, 2.5];

/// Growth of the force from one copy to the next: the state of the largest force is that of one 2 % below it at the least.
pub(crate) const GROWTH: f64 = 1.02;

/// Releases that follow each other faster than this part of the run are one: the first.
const RELEASES: f64 = 1.0 / 400.0;

/// The instants kept, and what decides of further ones.
#[derive(Debug)]
pub(crate) struct Stills {
    pub(crate) seen: Seen,
    pub(crate) kept: Kept,
    /// Where the instants at equal times begin, and where the run ends, s.
    begin: f64,
    end: f64,
    /// Time from one to the next of those at equal times, s.
    every: f64,
}

/// What was kept so far.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Kept {
    /// At equal times, and the last state.
    pub(crate) equal: Vec<Still>,
    /// The first state with a contact force.
    pub(crate) closing: Option<Still>,
    largest: Candidate,
    release: Candidate,
    /// Whether the last state had a contact force.
    closed: bool,
}

/// A state that a later one may replace.
#[derive(Debug, Default, Serialize, Deserialize)]
struct Candidate {
    /// Force (N) or time (s) that decides whether another one replaces it.
    measure: f64,
    still: Option<Still>,
    #[serde(skip)]
    copy: Option<Copy>,
}

/// What a picture needs of a state.
#[derive(Debug, Default)]
struct Copy {
    step: u64,
    time: f64,
    motion: Motion,
    interface: InterfaceState,
}

/// The end of a static stage before the dynamics, s; 0 without one, and where the run ends with it.
pub(crate) fn dynamics_begin(system: &System, end: f64) -> f64 {
    let stage = system.nonlinear.preload.map_or(0.0, |stage| stage.end);
    if stage < end { stage } else { 0.0 }
}

impl Stills {
    /// Of a run up to the time `end`, s.
    pub(crate) fn new(system: &System, end: f64) -> Stills {
        let seen = Seen::new(system);
        let bytes = 24 * seen.nodes.len() + 16 * seen.cells.len() + seen.body_of_cell.len() / 4;
        let by_memory = BYTES / bytes.max(1) / FILM;
        let begin = dynamics_begin(system, end);
        let is_explicit = system.schemes.iter().all(|s| s.get().is_explicit());
        let steps = if is_explicit { STEPS[0] } else { STEPS[1] };
        let by_steps = ((end - begin) / system.dt / steps) as usize / FILM;
        let parts = by_memory.min(by_steps).clamp(PARTS[0], PARTS[1]);
        Stills {
            seen,
            kept: Kept::default(),
            begin,
            end,
            every: (end - begin) / (FILM * parts) as f64,
        }
    }

    /// Where the instants at equal times begin, s.
    pub(crate) fn begin(&self) -> f64 {
        self.begin
    }

    /// Whether this can be gone on with.
    pub(crate) fn takes(&self, system: &System, kept: &Kept) -> bool {
        let single = [&kept.closing, &kept.largest.still, &kept.release.still];
        let mut all = kept.equal.iter().chain(single.into_iter().flatten());
        all.all(|still| still.is_of(system, &self.seen))
    }

    /// Goes on from what was kept.
    pub(crate) fn go_on(&mut self, kept: Kept) {
        self.kept = kept;
    }

    /// Keeps the state if it is one of those to be kept.
    pub(crate) fn push(&mut self, system: &System, state: &State, report: &StepReport) {
        let [equal, closing, largest, release] = self.wants(state.time, report);
        if equal {
            self.keep(system, state);
        }
        let (force, kept) = (largest_force(report), &mut self.kept);
        if closing {
            kept.closing = Some(of(system, &self.seen, state));
        }
        if largest {
            kept.largest.take(force, state);
        }
        if release {
            kept.release.take(state.time, state);
        }
        kept.closed = force > 0.0;
    }

    /// Whether the state of this time (s) is one of those to be kept: at equal times, as the first with a contact force, that of the largest,
    /// that of the last release.
    pub(crate) fn wants(&self, time: f64, report: &StepReport) -> [bool; 4] {
        // a step that ends there to within rounding is there
        // the time of a static stage before the dynamics is none: its start and its end are kept
        let since = |time: f64| (time - self.begin) / self.every;
        let number = |time: f64| (since(time) + 1e-6).floor().max(-1.0);
        let (force, kept) = (largest_force(report), &self.kept);
        let closed = force > 0.0;
        let pause = RELEASES * (self.end - self.begin);
        let again = kept.release.is_none() || time > kept.release.measure + pause;
        let last = kept.equal.last();
        [
            last.is_none_or(|still| number(time) > number(still.time)),
            closed && kept.closing.is_none(),
            closed && force > kept.largest.measure * GROWTH,
            kept.closed && !closed && again,
        ]
    }

    /// Keeps the last state, whatever its turn, and turns what was copied into pictures.
    pub(crate) fn finish(&mut self, system: &System, state: &State) {
        let last = self.kept.equal.last().map(|still| still.step);
        if last != Some(state.step) {
            self.keep(system, state);
        }
        self.settled(system);
    }

    /// What was kept so far, all of it as pictures.
    pub(crate) fn settled(&mut self, system: &System) -> &Kept {
        for candidate in [&mut self.kept.largest, &mut self.kept.release] {
            candidate.settle(system, &self.seen);
        }
        &self.kept
    }

    fn keep(&mut self, system: &System, state: &State) {
        let still = of(system, &self.seen, state);
        self.kept.equal.push(still);
    }
}

/// The largest force of a contact, N.
fn largest_force(report: &StepReport) -> f64 {
    let forces = report.contacts.iter().map(|contact| contact.force);
    forces.fold(0.0, f64::max)
}

impl Kept {
    /// The state nearest below the largest force, and that of the last release; once settled.
    pub(crate) fn extremes(&self) -> [Option<&Still>; 2] {
        [self.largest.still.as_ref(), self.release.still.as_ref()]
    }
}

impl Candidate {
    fn is_none(&self) -> bool {
        self.still.is_none() && self.copy.is_none()
    }

    fn take(&mut self, measure: f64, state: &State) {
        self.measure = measure;
        self.still = None;
        let copy = self.copy.get_or_insert_default();
        (copy.step, copy.time) = (state.step, state.time);
        copy.motion.u.clone_from(&state.motion.u);
        copy.motion.v.clone_from(&state.motion.v);
        copy.motion.frames.clone_from(&state.motion.frames);
        copy.motion.history.clone_from(&state.motion.history);
        copy.interface.force.clone_from(&state.interface.force);
        copy.interface
            .friction
            .clone_from(&state.interface.friction);
        copy.interface.status.clone_from(&state.interface.status);
    }

    fn settle(&mut self, system: &System, seen: &Seen) {
        if let Some(copy) = self.copy.take() {
            let instant = (copy.step, copy.time);
            let of = (&copy.motion, &copy.interface);
            self.still = Some(Still::of(system, seen, instant, of));
        }
    }
}

fn of(system: &System, seen: &Seen, state: &State) -> Still {
    let instant = (state.step, state.time);
    Still::of(system, seen, instant, (&state.motion, &state.interface))
}
