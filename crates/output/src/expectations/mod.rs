//! What a case must give: rows with a number of the results, what it must be, and what judges it.
//!
//! A row reads a number of `summary.json`, by its keys joined by dots, or one of a column of `histories.csv`.
//! [`quantities`](crate::results::quantities) and [`columns`](crate::results::columns_with_units) list the names that a model has, with their
//! units, before anything is computed. After a run that came to its end `Expected::judge` finds the numbers and compares.

mod column;
mod row;

use std::collections::BTreeMap;
use std::path::Path;

use carom_pages::form::Form;
use serde_json::Value;

use crate::Error;
use crate::verdict::{Bounds, Line};
pub use row::{Expectation, Expectations, Expected, Judged, Kind, MISSED, Range, Take, Told};

impl Expected {
    /// Finds the numbers of the rows in a `summary` as JSON and in the table of histories at a path.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub(crate) fn judge(
        &self,
        summary: &Value,
        histories: &Path,
        unfinished: bool,
    ) -> Result<Expectations, Error> {
        let wanted: Vec<(&str, Take)> = self
            .rows
            .values()
            .filter_map(|row| Some((row.quantity.as_str(), row.take?)))
            .collect();
        let mut of_columns = column::take(histories, &wanted)?.into_iter();
        let unjudged = match unfinished {
            true => Some("the run has not come to its end".to_owned()),
            false => self.unjudged.clone(),
        };
        let judged = self.rows.iter().map(|(name, row)| {
            let found = match row.take {
                Some(_) => of_columns.next().flatten(),
                None => number(summary, &row.quantity),
            };
            let met = found.is_some_and(|found| row.range.contains(found));
            let judged = Judged {
                row: row.clone(),
                found,
                met: unjudged.is_none().then_some(met),
            };
            (name.clone(), judged)
        });
        let rows: BTreeMap<String, Judged> = judged.collect();
        Ok(Expectations {
            missed: rows.values().filter(|row| row.met == Some(false)).count(),
            unjudged,
            rows,
        })
    }
}

impl Expectations {
    /// The line of the verdict; `None` where the rows are not judged.
    pub(crate) fn line(&self) -> Option<Line> {
        if self.unjudged.is_some() {
            return None;
        }
        let missed = self.rows.iter().filter(|(_, row)| row.met == Some(false));
        let names: Vec<String> = missed.map(|(name, _)| format!("`{name}`")).collect();
        let named = match names.is_empty() {
            true => String::new(),
            false => format!(" ({})", names.join(", ")),
        };
        Some(Line::new(
            "expectations",
            (
                &format!("rows of `[expect]` that are not met{named}"),
                self.missed as f64,
                Form::Count,
            ),
            Bounds::Bad(0.0),
            "the table of expectations has the numbers: find what has changed, the model, the program or what is expected",
        ))
    }
}

/// Tables of the summary with a key only where there is something.
const SPARSE: [&str; 3] = ["energy.works", "energy.dissipations", "energy.stored"];

/// The number at some keys joined by dots. What a balance of energy does not name is zero.
fn number(summary: &Value, keys: &str) -> Option<f64> {
    let mut at = summary;
    for key in keys.split('.') {
        at = match at {
            Value::Array(values) => values.get(key.parse::<usize>().ok()?)?,
            other => match other.get(key) {
                Some(value) => value,
                None => {
                    let table = keys.rsplit_once('.').map(|(table, _)| table);
                    return table.filter(|table| SPARSE.contains(table)).map(|_| 0.0);
                }
            },
        };
    }
    at.as_f64()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_found_by_their_keys() {
        let summary = serde_json::json!({
            "momentum": { "final": [1.0, 2.0, 3.0] },
            "energy": { "works": { "loads": 4.0 } },
            "exact": null,
        });
        assert_eq!(number(&summary, "momentum.final.1"), Some(2.0));
        assert_eq!(number(&summary, "momentum.final.3"), None);
        assert_eq!(number(&summary, "energy.works.loads"), Some(4.0));
        assert_eq!(number(&summary, "energy.works.links"), Some(0.0));
        assert_eq!(number(&summary, "energy.kinetic_final"), None);
        assert_eq!(number(&summary, "exact.overshoot"), None);
    }
}
