//! Warnings of the check that concern the result.

use crate::results::lines::Evidence;
use crate::verdict::{Grade, Line};

/// A line for each of them.
pub(super) fn lines(evidence: &Evidence) -> impl Iterator<Item = Line> {
    evidence.doubts.iter().map(|doubt| Line {
        name: "warning".to_owned(),
        grade: Grade::Look,
        value: 1.0,
        look: Some(0.0),
        bad: None,
        sentence: doubt.clone(),
        // the warning says it
        remedy: String::new(),
    })
}
