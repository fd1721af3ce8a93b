//! The lines of the verdict of a run, one function each. To add one: a function from the evidence to what it finds, in the
//! file of its topic, and its name in [`ALL`].

mod chatter;
mod convergence;
mod energy;
mod exact;
mod finite;
mod momentum;
mod penetration;
mod small;

use carom_dynamics::System;

use crate::results::{Last, Totals};
use crate::summary::{Energy, Exact, Momentum, Zones};
use crate::verdict::{Line, Verdict};

/// What a line looks at.
pub(crate) struct Evidence<'a> {
    pub(crate) system: &'a System,
    pub(crate) last: &'a Last,
    pub(crate) totals: &'a Totals,
    pub(crate) zones: Option<&'a Zones>,
    pub(crate) energy: &'a Energy,
    pub(crate) momentum: &'a Momentum,
    pub(crate) exact: Option<&'a Exact>,
}

/// What a line finds.
pub(crate) enum Finding {
    /// A number with its grade.
    Line(Line),
    /// What cannot be checked in this run, and why.
    Unchecked(String),
    /// Nothing: the run has none of what the line is about.
    Absent,
}

/// All lines, in the order in which they are shown.
const ALL: &[fn(&Evidence) -> Finding] = &[
    energy::residual,
    momentum::residual,
    momentum::exchange,
    momentum::resizing,
    energy::gain,
    energy::of_contact,
    energy::of_scheme,
    finite::states,
    chatter::of_contacts,
    penetration::of_contacts,
    exact::force,
    small::rotation,
    small::strain,
    small::slide,
    small::turn,
    small::invented,
    small::lost,
    convergence::of_mesh_and_step,
];

/// The largest of named numbers, one that is no number first.
fn worst<'a>(all: impl Iterator<Item = (&'a str, f64)>) -> Option<(&'a str, f64)> {
    all.reduce(
        |worst, other| match worst.1.is_nan() || worst.1 >= other.1 {
            true => worst,
            false => other,
        },
    )
}

/// The verdict on a run that came to its end (`unfinished` is `None`) or did not (`unfinished` says why).
pub(crate) fn judge(evidence: &Evidence, unfinished: Option<String>) -> Verdict {
    let (mut lines, mut unchecked) = (Vec::new(), Vec::new());
    for line in ALL {
        match line(evidence) {
            Finding::Line(line) => lines.push(line),
            Finding::Unchecked(why) => unchecked.push(why),
            Finding::Absent => {}
        }
    }
    Verdict::new(unfinished, lines, unchecked)
}
