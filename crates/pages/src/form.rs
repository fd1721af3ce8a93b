//! How a number is shown to people.

use crate::plot::{quantity, scientific};

/// How a number is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A part, as per cent.
    Percent,
    /// A count.
    Count,
    /// A pure number, as a power of ten.
    Power,
    /// A pure number of order one.
    Number,
    /// An angle, given in rad, in degrees.
    Degrees,
    /// A quantity of this unit.
    Quantity(&'static str),
}

impl Form {
    /// The number as text.
    pub fn show(self, value: f64) -> String {
        match self {
            _ if !value.is_finite() => value.to_string(),
            Form::Percent => percent(value),
            Form::Count => format!("{value}"),
            Form::Power if value == 0.0 => "0".to_owned(),
            Form::Power => scientific(value, 1),
            Form::Number => format!("{value:.3}"),
            Form::Degrees => format!("{:.2}°", value.to_degrees()),
            Form::Quantity(unit) => quantity(value, unit),
        }
    }
}

/// Part of the largest number of its kind that the sums of a run leave of a zero.
const ROUNDING: f64 = 1e-12;

/// A number, or zero where it is rounding beside numbers of this size.
pub fn near(value: f64, size: f64) -> f64 {
    match value.abs() <= ROUNDING * size {
        true => 0.0,
        false => value,
    }
}

/// A part as per cent.
pub fn percent(part: f64) -> String {
    format!("{:.2} %", 100.0 * part).replace('-', "−")
}

/// What stands for a value that does not exist.
pub const NOTHING: &str = "–";
