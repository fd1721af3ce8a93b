//! What can be wrong with an impact problem.

use std::fmt;

/// Why an impact could not be solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Error {
    /// A quantity that must be positive and finite is not.
    NotPositive {
        /// Name of the quantity.
        quantity: &'static str,
        /// Value found, SI.
        value: f64,
    },
    /// A quantity that may have any finite value is infinite or not a number.
    NotFinite {
        /// Name of the quantity.
        quantity: &'static str,
        /// Value found, SI.
        value: f64,
    },
    /// The gap is negative or not finite: the bars would start in each other.
    Penetration {
        /// Gap found, m, positive when open.
        gap: f64,
    },
    /// The motion has more pieces than are kept: too many delays of unequal bars before the end time.
    TooManyPieces {
        /// Largest number of pieces.
        limit: usize,
        /// Time reached, s.
        time: f64,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::NotPositive { quantity, value } => {
                write!(f, "{quantity} is {value}, it must be positive and finite")
            }
            Error::NotFinite { quantity, value } => {
                write!(f, "{quantity} is {value}, it must be finite")
            }
            Error::Penetration { gap } => write!(
                f,
                "the gap is {gap} m at the start, it must be finite and not negative"
            ),
            Error::TooManyPieces { limit, time } => write!(
                f,
                "the motion has more than {limit} pieces before t = {time} s"
            ),
        }
    }
}

impl std::error::Error for Error {}
