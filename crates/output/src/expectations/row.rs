//! A row of what a case must give, and what a run gave.

use std::collections::BTreeMap;
use std::fmt;

use carom_pages::form::percent;
use carom_pages::plot::{quantity, rounded};
use serde::{Deserialize, Serialize};

/// Part of a bound that rounding may exceed it by.
const ROUNDING: f64 = 1e-12;

/// What the value of a row is; the kinds of `carom verify`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// An exact solution, an identity, a conservation law, or a bound that theory states.
    ClosedForm,
    /// A figure printed in the literature.
    Published,
    /// A figure of an implementation that shares no code with Carom.
    AnotherCode,
    /// Another scheme, law, mesh or formulation of Carom.
    SecondFormulation,
    /// A figure that Carom itself gave: the row shows that it has not changed, not that it is right.
    Regression,
}

impl Kind {
    /// Its words.
    pub fn name(self) -> &'static str {
        match self {
            Kind::ClosedForm => "closed form",
            Kind::Published => "published",
            Kind::AnotherCode => "another code",
            Kind::SecondFormulation => "second formulation",
            Kind::Regression => "regression",
        }
    }
}

/// Which number of a column.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Take {
    /// The largest.
    Largest,
    /// The smallest.
    Smallest,
    /// That of the last row.
    Last,
    /// That at a time (s), between two rows on the line that joins them.
    At(f64),
}

/// What a number must be, in SI units; bounds are part of the range.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Range {
    /// |found - value| ≤ tolerance.
    Near {
        /// The value.
        value: f64,
        /// Largest difference.
        tolerance: f64,
    },
    /// Between two bounds, or beyond one.
    Within {
        /// Smallest number.
        at_least: Option<f64>,
        /// Largest number.
        at_most: Option<f64>,
    },
}

impl Range {
    /// Whether a number is within it. What is no number is not.
    pub fn contains(self, found: f64) -> bool {
        let above = |low: f64| found >= low - ROUNDING * low.abs();
        let below = |high: f64| found <= high + ROUNDING * high.abs();
        match self {
            Range::Near { value, tolerance } => {
                (found - value).abs() <= tolerance + ROUNDING * value.abs()
            }
            Range::Within { at_least, at_most } => {
                !found.is_nan() && at_least.is_none_or(above) && at_most.is_none_or(below)
            }
        }
    }

    /// By how much a number differs: from the value, or from the bound that it is beyond; zero between bounds.
    pub fn difference(self, found: f64) -> f64 {
        match self {
            Range::Near { value, .. } => found - value,
            Range::Within { at_least, at_most } => match (at_least, at_most) {
                (Some(low), _) if found < low => found - low,
                (_, Some(high)) if found > high => found - high,
                _ => 0.0,
            },
        }
    }

    /// The value or the bounds as text, and the tolerance.
    pub fn texts(self, unit: &str) -> [String; 2] {
        let show = |number: f64| shown(number, unit);
        match self {
            Range::Near { value, tolerance } => {
                [show(value), format!("± {}", quantity(tolerance, unit))]
            }
            Range::Within { at_least, at_most } => {
                let text = match (at_least, at_most) {
                    (Some(low), Some(high)) => format!("{} to {}", show(low), show(high)),
                    (Some(low), None) => format!("at least {}", show(low)),
                    (None, Some(high)) => format!("at most {}", show(high)),
                    (None, None) => String::new(),
                };
                [text, String::new()]
            }
        }
    }
}

/// A number with its unit, in five digits; a count as it is.
fn shown(number: f64, unit: &str) -> String {
    match unit.is_empty() && number == number.trunc() && number.abs() < 1e6 {
        true => number.to_string(),
        false => rounded(number, unit, 5),
    }
}

/// A row: a number of the results, and what it must be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Expectation {
    /// Keys of a number of `summary.json` joined by dots, or name of a column of `histories.csv`.
    pub quantity: String,
    /// Which number of the column; `None` of a number of the summary.
    pub take: Option<Take>,
    /// Unit of the numbers; empty of a pure number.
    pub unit: String,
    /// What it must be.
    #[serde(flatten)]
    pub range: Range,
    /// What that is.
    pub kind: Kind,
    /// Where it is from.
    pub source: String,
    /// Why the tolerance is what it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// `largest probe.tip.displacement_x_m`.
impl fmt::Display for Expectation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.take {
            None => f.write_str(&self.quantity),
            Some(Take::Largest) => write!(f, "largest {}", self.quantity),
            Some(Take::Smallest) => write!(f, "smallest {}", self.quantity),
            Some(Take::Last) => write!(f, "last {}", self.quantity),
            Some(Take::At(time)) => write!(f, "{} at {}", self.quantity, quantity(time, "s")),
        }
    }
}

/// The rows of a case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Expected {
    /// By name.
    pub rows: BTreeMap<String, Expectation>,
    /// Why they do not hold for this run, in a sentence without its beginning; `None` where they do.
    pub unjudged: Option<String>,
}

/// A row with what a run gave.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Judged {
    /// The row.
    #[serde(flatten)]
    pub row: Expectation,
    /// The number found; `None` where the run has none.
    pub found: Option<f64>,
    /// Whether it is what it must be; `None` where the row is not judged.
    pub met: Option<bool>,
}

/// What the rows of a case found.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Expectations {
    /// Number of rows that are not met.
    pub missed: usize,
    /// Why the rows are not judged; `None` where they are.
    pub unjudged: Option<String>,
    /// By name.
    pub rows: BTreeMap<String, Judged>,
}

/// A row as texts, for tables.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Told {
    /// Its name.
    pub name: String,
    /// What is compared.
    pub quantity: String,
    /// The value or the bounds.
    pub expected: String,
    /// Empty with bounds.
    pub tolerance: String,
    /// Empty where the run has no such number.
    pub found: String,
    /// From the value, or from the bound that it is beyond.
    pub difference: String,
    /// `met`, `missed` or `not judged`.
    pub met: &'static str,
    /// What the value is.
    pub kind: &'static str,
    /// Where it is from.
    pub source: String,
    /// Why the tolerance is what it is, or nothing.
    pub reason: String,
}

impl Expectations {
    /// The rows as texts, those that are missed first.
    pub fn told(&self) -> Vec<Told> {
        let mut told: Vec<Told> = self.rows.iter().map(|(name, row)| row.told(name)).collect();
        told.sort_by_key(|row| row.met != MISSED);
        told
    }
}

/// The word for a row that is not met.
pub const MISSED: &str = "missed";

impl Judged {
    fn told(&self, name: &str) -> Told {
        let row = &self.row;
        let [expected, tolerance] = row.range.texts(&row.unit);
        let difference = match (self.found, row.range) {
            (None, _) => String::new(),
            (Some(found), Range::Near { value, .. }) if value != 0.0 => {
                percent((found - value) / value.abs())
            }
            (Some(found), range) => quantity(range.difference(found), &row.unit),
        };
        Told {
            name: name.to_owned(),
            quantity: row.to_string(),
            expected,
            tolerance,
            found: self
                .found
                .map_or(String::new(), |found| shown(found, &row.unit)),
            difference,
            met: match self.met {
                Some(true) => "met",
                Some(false) => MISSED,
                None => "not judged",
            },
            kind: row.kind.name(),
            source: row.source.clone(),
            reason: row.reason.clone().unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_belong_to_their_range_and_what_is_no_number_does_not() {
        let near = Range::Near {
            value: 2.0,
            tolerance: 0.5,
        };
        let within = Range::Within {
            at_least: Some(-1.0),
            at_most: Some(3.0),
        };
        for (range, low, high) in [(near, 1.5, 2.5), (within, -1.0, 3.0)] {
            assert!(range.contains(low) && range.contains(high));
            assert!(!range.contains(low - 1e-9) && !range.contains(high + 1e-9));
            assert!(!range.contains(f64::NAN));
        }
        assert_eq!(near.difference(2.75), 0.75);
        assert_eq!(within.difference(2.75), 0.0);
        assert_eq!(within.difference(3.5), 0.5);
        assert_eq!(within.difference(-1.5), -0.5);
    }
}
