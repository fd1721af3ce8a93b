//! Histories: one row per accepted step, one column per quantity.
//!
//! Column names are paths in snake case that end with the unit, so that a table needs no other explanation:
//! `time_s`, `contact.shock.force_n`, `energy.kinetic_j`, `probe.a.displacement_x_m`.

use std::path::Path;

use crate::Error;
use crate::rows::{Cell, Rows};

/// A table of histories, open for appending.
#[derive(Debug)]
pub struct History {
    rows: Rows,
}

impl History {
    /// Creates the file with its line of column names; make the names with [`column()`].
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::TwinColumns`] if a name occurs twice.
    pub fn create<S: AsRef<str>>(path: &Path, columns: &[S]) -> Result<History, Error> {
        Ok(History {
            rows: Rows::create(path, columns)?,
        })
    }

    /// Adds a row, one value per column in the order of the names: a number, with the fewest digits that give it back exactly, or
    /// nothing.
    ///
    /// # Errors
    /// [`Error::RowLength`]; [`Error::File`] if rows were due on the disk and did not fit. What was written before
    /// stays readable.
    pub fn push<'a>(&mut self, values: &[impl Into<Cell<'a>> + Copy]) -> Result<(), Error> {
        self.rows.push(values.iter().map(|value| (*value).into()))
    }

    /// Opens the table of a run that goes on, cut back to this length.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::Cut`].
    pub fn go_on(path: &Path, columns: usize, length: u64) -> Result<History, Error> {
        Ok(History {
            rows: Rows::go_on(path, columns, length)?,
        })
    }

    /// Hands all rows to the operating system, when somebody wants to look.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn flush(&mut self) -> Result<(), Error> {
        self.rows.flush()
    }

    /// Forces all rows to the disk, before a checkpoint; the length of the file.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn sync(&mut self) -> Result<u64, Error> {
        self.rows.sync()
    }

    /// Closes the table, forced to the disk.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn finish(self) -> Result<(), Error> {
        self.rows.finish()
    }
}

/// The name of a column: `path` in snake case joined by dots, then the unit (`""` for a pure number).
///
/// `column(&["contact", "Shock 1", "force"], "N")` is `contact.shock_1.force_n`; the unit `m/s` becomes `m_s`, `m/s²`
/// becomes `m_s2`, `N s` becomes `n_s`.
pub fn column(path: &[&str], unit: &str) -> String {
    let mut name = path
        .iter()
        .map(|part| snake_case(part))
        .collect::<Vec<_>>()
        .join(".");
    if !unit.is_empty() {
        name.push('_');
        name.push_str(&snake_case(unit));
    }
    name
}

/// Lower case, with one underscore for each run of anything that is neither a letter nor a digit.
fn snake_case(text: &str) -> String {
    let mut name = String::new();
    for letter in text.chars() {
        let letter = match letter {
            '²' => '2',
            '³' => '3',
            other => other,
        };
        if letter.is_alphanumeric() {
            name.extend(letter.to_lowercase());
        } else if !name.is_empty() && !name.ends_with('_') {
            name.push('_');
        }
    }
    name.truncate(name.trim_end_matches('_').len());
    name
}
