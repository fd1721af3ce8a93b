//! What a check is, and the run over all of them.

use std::fmt;
use std::io::{self, Write};
use std::time::Instant;

use crate::Error;

/// How large the models of a check are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// The smallest model that shows the fact: tests.
    Quick,
    /// The size at which the fact is stated: `carom verify`.
    Full,
}

/// A case with a known answer.
#[derive(Clone, Copy, Debug)]
pub struct Check {
    /// Name, by which it is called.
    pub name: &'static str,
    /// The fact, in one sentence.
    pub fact: &'static str,
    /// Computes the rows at a size.
    pub run: fn(Size) -> Result<Vec<Row>, Error>,
}

/// One number and what it must be.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What was computed, with its unit unless it is a ratio.
    pub quantity: String,
    /// The number found.
    pub value: f64,
    /// What it must be.
    pub expected: Expected,
}

/// What a number must be. A number that is none fails everything.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expected {
    /// Within `tolerance` of `reference`, borders included.
    Near {
        /// Reference.
        reference: f64,
        /// Largest absolute difference.
        tolerance: f64,
    },
    /// Not above.
    AtMost(f64),
    /// Not below.
    AtLeast(f64),
}

impl Row {
    /// |value - reference| <= tolerance.
    pub fn near(quantity: impl Into<String>, value: f64, reference: f64, tolerance: f64) -> Row {
        Row {
            quantity: quantity.into(),
            value,
            expected: Expected::Near {
                reference,
                tolerance,
            },
        }
    }

    /// |value - reference| <= tolerance |reference|.
    pub fn relative(quantity: impl Into<String>, value: f64, reference: f64, part: f64) -> Row {
        Row::near(quantity, value, reference, part * reference.abs())
    }

    /// The value agrees with a published number within its digits: the tolerance is one unit of the last one, since a
    /// number may have been rounded more than once on its way into a table. Without a decimal point it is a count, and
    /// exact.
    ///
    /// `printed` is a decimal number without exponent; anything else makes a row that fails.
    pub fn printed(quantity: impl Into<String>, value: f64, printed: &str) -> Row {
        let reference = printed.parse().unwrap_or(f64::NAN);
        let unit = printed.split_once('.').map_or(0.0, |(_, decimals)| {
            0.1_f64.powi(decimals.len() as i32) * (1.0 + 1e-9)
        });
        Row::near(quantity, value, reference, unit)
    }

    /// As [`Row::printed`], or within `part` of the number where that is more.
    pub fn printed_or(quantity: impl Into<String>, value: f64, printed: &str, part: f64) -> Row {
        let mut row = Row::printed(quantity, value, printed);
        if let Expected::Near {
            reference,
            tolerance,
        } = &mut row.expected
        {
            *tolerance = tolerance.max(part * reference.abs());
        }
        row
    }

    /// An exact count.
    pub fn count(quantity: impl Into<String>, value: usize, reference: usize) -> Row {
        Row::near(quantity, value as f64, reference as f64, 0.0)
    }

    /// value <= bound.
    pub fn at_most(quantity: impl Into<String>, value: f64, bound: f64) -> Row {
        Row {
            quantity: quantity.into(),
            value,
            expected: Expected::AtMost(bound),
        }
    }

    /// value >= bound.
    pub fn at_least(quantity: impl Into<String>, value: f64, bound: f64) -> Row {
        Row {
            quantity: quantity.into(),
            value,
            expected: Expected::AtLeast(bound),
        }
    }

    /// Whether the value is what it must be.
    pub fn holds(&self) -> bool {
        match self.expected {
            Expected::Near {
                reference,
                tolerance,
            } => (self.value - reference).abs() <= tolerance,
            Expected::AtMost(bound) => self.value <= bound,
            Expected::AtLeast(bound) => self.value >= bound,
        }
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.holds() { "ok  " } else { "FAIL" };
        write!(
            f,
            "{verdict}  {:<84}  {:>12}",
            self.quantity,
            short(self.value)
        )?;
        match self.expected {
            Expected::Near {
                reference,
                tolerance: 0.0,
            } => write!(f, "   = {}", short(reference)),
            Expected::Near {
                reference,
                tolerance,
            } => write!(f, "   = {} ± {tolerance:.1e}", short(reference)),
            Expected::AtMost(bound) => write!(f, "  <= {}", short(bound)),
            Expected::AtLeast(bound) => write!(f, "  >= {}", short(bound)),
        }
    }
}

/// Six digits; exponents only where they are needed.
fn short(value: f64) -> String {
    let size = value.abs();
    if value == value.trunc() && size < 1e6 {
        format!("{value}")
    } else if (1e-3..1e6).contains(&size) {
        let decimals = 5 - size.log10().floor() as i32;
        format!("{value:.*}", decimals.max(0) as usize)
    } else {
        format!("{value:.5e}")
    }
}

/// What a run over the checks found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    /// Checks run; zero if the filter fits none.
    pub checks: usize,
    /// Rows computed.
    pub rows: usize,
    /// Rows that do not hold, and checks that could not be made.
    pub failed: usize,
}

impl Verdict {
    /// Whether there was something to check and all of it holds.
    pub fn holds(&self) -> bool {
        self.checks > 0 && self.failed == 0
    }
}

/// Runs these checks, or those of them whose name contains `filter`, and writes one line per row.
///
/// # Errors
/// Only of `out`; a check that cannot be made is written and counted as failed.
pub fn verify(
    checks: &[Check],
    filter: Option<&str>,
    size: Size,
    out: &mut dyn Write,
) -> io::Result<Verdict> {
    let mut verdict = Verdict::default();
    let wanted = |check: &&Check| filter.is_none_or(|part| check.name.contains(part));
    for check in checks.iter().filter(wanted) {
        writeln!(out, "{}: {}", check.name, check.fact)?;
        let begin = Instant::now();
        verdict.checks += 1;
        match (check.run)(size) {
            Ok(rows) => {
                for row in &rows {
                    writeln!(out, "  {row}")?;
                }
                verdict.rows += rows.len();
                verdict.failed += rows.iter().filter(|row| !row.holds()).count();
            }
            Err(error) => {
                writeln!(out, "  FAIL  could not be made: {error}")?;
                verdict.failed += 1;
            }
        }
        writeln!(
            out,
            "  {} in {:.1} s",
            check.name,
            begin.elapsed().as_secs_f64()
        )?;
        out.flush()?;
    }
    writeln!(
        out,
        "{} checks, {} rows, {} failed",
        verdict.checks, verdict.rows, verdict.failed
    )?;
    Ok(verdict)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printed_number_gives_a_unit_of_its_last_digit() {
        assert!(Row::printed("x", 0.04709, "0.0470").holds());
        assert!(!Row::printed("x", 0.04711, "0.0470").holds());
        assert!(Row::printed("x", -0.0401, "-0.05").holds());
        assert!(Row::printed("x", 11.0, "10.9").holds());
        assert!(Row::printed("n", 59.0, "59").holds());
        assert!(!Row::printed("n", 60.0, "59").holds());
        assert!(!Row::printed("x", 1.0, "one").holds());
    }

    #[test]
    fn what_is_no_number_holds_nowhere() {
        let rows = [
            Row::near("x", f64::NAN, 0.0, f64::INFINITY),
            Row::at_most("x", f64::NAN, f64::INFINITY),
            Row::at_least("x", f64::NAN, -1.0),
        ];
        assert!(rows.iter().all(|row| !row.holds()));
    }

    #[test]
    fn failures_are_counted_and_the_filter_is_a_part_of_the_name() {
        let rows = |_| {
            Ok(vec![
                Row::at_most("a", 1.0, 2.0),
                Row::at_most("b", 3.0, 2.0),
            ])
        };
        let failing = |_| Err(Error::Group { name: "g".into() });
        let check = |name, run| Check {
            name,
            fact: "",
            run,
        };
        let checks = [check("one", rows), check("two", failing)];
        let run = |filter| verify(&checks, filter, Size::Quick, &mut Vec::new()).unwrap();
        let verdict = |checks, rows, failed| Verdict {
            checks,
            rows,
            failed,
        };
        assert_eq!(run(None), verdict(2, 2, 2));
        assert_eq!(run(Some("on")), verdict(1, 2, 1));
        assert!(!run(Some("three")).holds());
    }
}
