//! What a line looks at, and what it finds.

use std::collections::BTreeMap;

use carom_dynamics::System;

use crate::results::totals::{Last, Totals};
use crate::summary::{Energy, Exact, Momentum, Pretension, Zones};
use crate::verdict::Line;

/// What a line looks at.
pub(crate) struct Evidence<'a> {
    pub(crate) system: &'a System,
    pub(crate) last: &'a Last,
    pub(crate) totals: &'a Totals,
    pub(crate) zones: Option<&'a Zones>,
    pub(crate) energy: &'a Energy,
    pub(crate) momentum: &'a Momentum,
    pub(crate) exact: Option<&'a Exact>,
    pub(crate) bolts: &'a BTreeMap<String, Pretension>,
    /// Warnings of the check that concern the result.
    pub(crate) doubts: &'a [String],
    /// Whether linear equations were solved by iterations.
    pub(crate) iterated: bool,
    /// The command that varies mesh and step.
    pub(crate) study: Option<&'a str>,
}

impl Evidence<'_> {
    /// The names of the reduced bodies in one text, and the first; `None` without any.
    pub(super) fn reduced(&self) -> Option<(String, &str)> {
        let bodies = self.system.bodies.iter();
        let reduced = bodies.filter(|body| body.as_reduced().is_some());
        let names: Vec<&str> = reduced.map(|body| body.name()).collect();
        let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        Some((quoted.join(", "), *names.first()?))
    }
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

/// The largest of named numbers, one that is no number first.
pub(super) fn worst<'a>(all: impl Iterator<Item = (&'a str, f64)>) -> Option<(&'a str, f64)> {
    all.reduce(
        |worst, other| match worst.1.is_nan() || worst.1 >= other.1 {
            true => worst,
            false => other,
        },
    )
}
