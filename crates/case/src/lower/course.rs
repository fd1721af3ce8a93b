//! What a signal is a function of time of.

use std::collections::BTreeMap;

use carom_dynamics::Amplitude;
use carom_signals::Record;

/// A signal, by what it is a function of time of.
#[derive(Clone, Debug)]
pub(super) enum Course {
    Acceleration(Record),
    Displacement(Amplitude),
    Factor(Amplitude),
}

impl Course {
    /// What it is, for messages.
    pub(super) fn quantity(&self) -> &'static str {
        match self {
            Course::Acceleration(_) => "an acceleration",
            Course::Displacement(_) => "a displacement",
            Course::Factor(_) => "a factor",
        }
    }
}

/// Signals by name; `None` of those with a problem.
pub(super) type Signals = BTreeMap<String, Option<Course>>;
