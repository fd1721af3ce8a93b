//! Ranges of the parameters of laws.

use thiserror::Error as ThisError;

/// A parameter of a law that is out of its range.
#[derive(Clone, Debug, PartialEq, ThisError)]
#[error("{parameter} = {value} is out of range: it must be {accepted}")]
pub struct OutOfRange {
    /// Its name in a case file.
    pub parameter: &'static str,
    /// Its value, in SI units.
    pub value: f64,
    /// What is accepted.
    pub accepted: &'static str,
}

/// Refuses a value that is not `inside` its range, or not finite.
pub(crate) fn require(
    parameter: &'static str,
    value: f64,
    inside: bool,
    accepted: &'static str,
) -> Result<(), OutOfRange> {
    if inside && value.is_finite() {
        Ok(())
    } else {
        Err(OutOfRange {
            parameter,
            value,
            accepted,
        })
    }
}
