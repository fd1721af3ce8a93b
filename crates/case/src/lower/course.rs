//! What a signal is a function of time of.

use std::collections::BTreeMap;

use carom_dynamics::Amplitude;
use carom_signals::Record;

use super::problems::Problems;
use crate::error::Problem;

/// A signal, by what it is a function of time of.
#[derive(Debug)]
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

/// The signals of a case.
#[derive(Default)]
pub(super) struct Signals {
    /// By name; `None` of those with a problem.
    pub(super) courses: BTreeMap<String, Option<Course>>,
    /// What they have in words, by name.
    pub(super) words: Vec<(String, String)>,
}

/// A function of time, or a problem at the first time that does not ascend.
pub(super) fn amplitude(
    path: &str,
    points: Vec<[f64; 2]>,
    problems: &mut Problems,
) -> Option<Amplitude> {
    let times: Vec<f64> = points.iter().map(|point| point[0]).collect();
    ascending(path, &times, problems);
    Amplitude::new(points).ok()
}

/// Refuses times that do not ascend.
pub(super) fn ascending(path: &str, times: &[f64], problems: &mut Problems) {
    let late = |k: &usize| times[*k] <= times[k - 1];
    if let Some(k) = (1..times.len()).find(late) {
        let problem = Problem::new(format!("{path}[{k}].time"), "the times must ascend");
        let problem = problem.found(format!("{} s", times[k]));
        problems.push(problem.accepted([format!("more than {} s", times[k - 1])]));
    }
}
