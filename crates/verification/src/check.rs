//! What a check is, and the run over all of them.

use std::fmt;
use std::io::{self, Write};
use std::time::Instant;

use crate::Error;
use crate::kind::{Counts, Kind};
use crate::side_by_side::side_by_side;
use crate::witness::{Shown, look};
use crate::words::words;

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

/// One number, what it must be, and what it is judged by.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What was computed, with its unit unless it is a ratio.
    pub quantity: String,
    /// The number found.
    pub value: f64,
    /// What it must be.
    pub expected: Expected,
    /// What that is: a [closed form](Kind::ClosedForm) unless the row says otherwise.
    pub kind: Kind,
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
    /// Anything: the number is shown.
    Anything,
}

impl Row {
    fn new(quantity: impl Into<String>, value: f64, expected: Expected) -> Row {
        Row {
            quantity: words(&quantity.into()),
            value,
            expected,
            kind: Kind::ClosedForm,
        }
    }

    /// |value - reference| <= tolerance.
    pub fn near(quantity: impl Into<String>, value: f64, reference: f64, tolerance: f64) -> Row {
        let expected = Expected::Near {
            reference,
            tolerance,
        };
        Row::new(quantity, value, expected)
    }

    /// |value - reference| <= tolerance |reference|.
    pub fn relative(quantity: impl Into<String>, value: f64, reference: f64, part: f64) -> Row {
        Row::near(quantity, value, reference, part * reference.abs())
    }

    /// The value agrees with a printed number within its digits: the tolerance is one unit of the last one, since a
    /// number may have been rounded more than once on its way into a table. Without a decimal point it is a count, and
    /// exact.
    ///
    /// `kind`: whose number it is. `printed` is a decimal number without exponent; anything else makes a row that fails.
    pub fn printed(kind: Kind, quantity: impl Into<String>, value: f64, printed: &str) -> Row {
        let reference = printed.parse().unwrap_or(f64::NAN);
        let unit = printed.split_once('.').map_or(0.0, |(_, decimals)| {
            0.1_f64.powi(decimals.len() as i32) * (1.0 + 1e-9)
        });
        Row::near(quantity, value, reference, unit).of(kind)
    }

    /// As [`Row::printed`], or within `part` of the number where that is more.
    pub fn printed_or(
        kind: Kind,
        quantity: impl Into<String>,
        value: f64,
        printed: &str,
        part: f64,
    ) -> Row {
        let mut row = Row::printed(kind, quantity, value, printed);
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
        Row::new(quantity, value, Expected::AtMost(bound))
    }

    /// value >= bound.
    pub fn at_least(quantity: impl Into<String>, value: f64, bound: f64) -> Row {
        Row::new(quantity, value, Expected::AtLeast(bound))
    }

    /// A number that is shown and not judged: [`Kind::Information`].
    pub fn shown(quantity: impl Into<String>, value: f64) -> Row {
        Row::new(quantity, value, Expected::Anything).of(Kind::Information)
    }

    /// Judged by a figure of the literature: [`Kind::Published`].
    pub fn published(self) -> Row {
        self.of(Kind::Published)
    }

    /// Judged by a figure of a program that shares no code with Carom: [`Kind::OtherCode`].
    pub fn other_code(self) -> Row {
        self.of(Kind::OtherCode)
    }

    /// Judged by another scheme, mesh, formulation or run of Carom: [`Kind::SecondFormulation`].
    pub fn second_formulation(self) -> Row {
        self.of(Kind::SecondFormulation)
    }

    /// Judged by Carom's own figure of an earlier day: [`Kind::Regression`].
    pub fn regression(self) -> Row {
        self.of(Kind::Regression)
    }

    fn of(self, kind: Kind) -> Row {
        Row { kind, ..self }
    }

    /// Whether the value is what it must be; a number that is shown has to be one.
    pub fn holds(&self) -> bool {
        match self.expected {
            Expected::Near {
                reference,
                tolerance,
            } => (self.value - reference).abs() <= tolerance,
            Expected::AtMost(bound) => self.value <= bound,
            Expected::AtLeast(bound) => self.value >= bound,
            Expected::Anything => !self.value.is_nan(),
        }
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = match (self.holds(), self.expected) {
            (false, _) => "FAIL",
            (true, Expected::Anything) => "info",
            (true, _) => "ok  ",
        };
        let (quantity, value) = (&self.quantity, short(self.value));
        let (expected, kind) = (self.expected.to_string(), self.kind);
        write!(
            f,
            "{verdict}  {quantity:<84}  {value:>12}  {expected:<24}  {kind}"
        )
    }
}

/// `<= 0.5`; nothing where the number is only shown.
impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Expected::Near {
                reference,
                tolerance: 0.0,
            } => write!(f, " = {}", short(reference)),
            Expected::Near {
                reference,
                tolerance,
            } => write!(f, " = {} ± {tolerance:.1e}", short(reference)),
            Expected::AtMost(bound) => write!(f, "<= {}", short(bound)),
            Expected::AtLeast(bound) => write!(f, ">= {}", short(bound)),
            Expected::Anything => Ok(()),
        }
    }
}

/// Six digits; exponents only where they are needed.
pub(crate) fn short(value: f64) -> String {
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
    pub rows: Counts,
    /// Rows that do not hold.
    pub failed: Counts,
    /// Checks that could not be made.
    pub unmade: usize,
}

impl Verdict {
    /// Whether there was something to check and all of it holds.
    pub fn holds(&self) -> bool {
        self.checks > 0 && self.failed.total() == 0 && self.unmade == 0
    }

    fn count(&mut self, rows: &[Row]) {
        for row in rows {
            self.rows.add(row.kind);
            if !row.holds() {
                self.failed.add(row.kind);
            }
        }
    }
}

/// `2 checks, 6 rows: 5 closed form, 1 regression; 1 failed: 1 regression`.
impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let colon = |counts: &Counts| if counts.total() > 0 { ": " } else { "" };
        let (rows, failed) = (&self.rows, &self.failed);
        write!(f, "{} checks, {} rows", self.checks, rows.total())?;
        write!(f, "{}{rows}; {} failed", colon(rows), failed.total())?;
        write!(f, "{}{failed}", colon(failed))?;
        match self.unmade {
            0 => Ok(()),
            count => write!(f, "; checks that could not be made: {count}"),
        }
    }
}

/// A check that was run.
#[derive(Debug)]
pub struct Made {
    /// The check.
    pub check: Check,
    /// Its rows, or why it could not be made.
    pub rows: Result<Vec<Row>, Error>,
    /// Wall time, s.
    pub seconds: f64,
    /// What it has shown; nothing unless somebody looked.
    pub shown: Shown,
}

impl Made {
    /// Whether it could be made and all its rows hold.
    pub fn holds(&self) -> bool {
        let rows = self.rows.as_ref();
        rows.is_ok_and(|rows| rows.iter().all(Row::holds))
    }
}

impl Check {
    /// Makes it; `looks` as [`verify`] takes it.
    fn make(self, (size, looks): (Size, bool)) -> Made {
        let begin = Instant::now();
        let (rows, shown) = match looks {
            true => look(|| (self.run)(size)),
            false => ((self.run)(size), Shown::default()),
        };
        Made {
            check: self,
            rows,
            seconds: begin.elapsed().as_secs_f64(),
            shown,
        }
    }
}

/// Runs these checks, or those of them whose name contains `filter`, and writes one line per row in the order of the list; returns what
/// each found too, and where somebody `looks` what it has shown. Checks are made [side by side](side_by_side) unless somebody looks.
///
/// # Errors
/// Of `out`, and if no threads can be started; a check that cannot be made is written and counted as failed.
pub fn verify(
    checks: &[Check],
    filter: Option<&str>,
    (size, looks): (Size, bool),
    out: &mut dyn Write,
) -> io::Result<(Verdict, Vec<Made>)> {
    let mut verdict = Verdict::default();
    let mut made = Vec::new();
    let wanted = |check: &&Check| filter.is_none_or(|part| check.name.contains(part));
    let wanted: Vec<Check> = checks.iter().filter(wanted).copied().collect();
    // what is shown is kept in one place
    let workers = if looks {
        1
    } else {
        rayon::current_num_threads()
    };
    let names: Vec<&str> = wanted.iter().map(|check| check.name).collect();
    let make = |place: usize| wanted[place].make((size, looks));
    side_by_side(&names, workers, make, &mut |found: Made| {
        verdict.checks += 1;
        writeln!(out, "{}: {}", found.check.name, found.check.fact)?;
        match &found.rows {
            Ok(rows) => {
                for row in rows {
                    writeln!(out, "  {row}")?;
                }
                verdict.count(rows);
            }
            Err(error) => {
                writeln!(out, "  FAIL  could not be made: {error}")?;
                verdict.unmade += 1;
            }
        }
        writeln!(out, "  {} in {:.1} s", found.check.name, found.seconds)?;
        out.flush()?;
        made.push(found);
        Ok(())
    })?;
    writeln!(out, "{verdict}")?;
    Ok((verdict, made))
}
