//! The rows of `[expect]`: names looked up in what a run of the model will have, units checked.

use std::collections::BTreeMap;

use carom_dynamics::System;
use carom_output::expectations::{Expectation, Expected, Kind, Range, Take};
use carom_output::{Quantity, Settings, columns_with_units, quantities};
use carom_quantities::units::{Dimension, parse_quantity};

use crate::error::Problem;
use crate::schema::{self, Amount, Case, Expect, ExpectKind};

/// Tables whose change does not change the model.
const HARMLESS: [&str; 3] = ["title", "output", "expect"];

/// The table of `output` that changes columns.
const THINNED: &str = "output.histories";

/// Most names that a message lists.
const SHOWN: usize = 40;

/// The rows of a case whose run ends at a time (s), or their problems. Of a model that overrides have `changed`, whose rows are not judged, those
/// that do not fit are left out.
pub(crate) fn rows(
    (case, changed): (&Case, bool),
    names: &Names,
    end: f64,
) -> Result<Expected, Vec<Problem>> {
    let (mut rows, mut problems) = (BTreeMap::new(), Vec::new());
    for (name, given) in case.expect.iter() {
        match names.row(&format!("expect.{name}"), given, end) {
            Ok(row) => drop(rows.insert(name.to_owned(), row)),
            Err(_) if changed => {}
            Err(problem) => problems.push(*problem),
        }
    }
    match problems.is_empty() {
        true => Ok(Expected {
            rows,
            unjudged: None,
        }),
        false => Err(problems),
    }
}

/// The rows of a run with some overrides: those that change the model make a run of another case.
pub(crate) fn expected(rows: &Expected, overrides: &[String]) -> Expected {
    let changes = overrides.iter().filter(|text| changes_the_model(text));
    let named: Vec<String> = changes
        .map(|text| format!("`--set {}`", text.trim()))
        .collect();
    let unjudged = match named.is_empty() {
        true => rows.unjudged.clone(),
        false => Some(format!(
            "they are stated for the file as it is, without {}",
            named.join(" ")
        )),
    };
    Expected {
        rows: rows.rows.clone(),
        unjudged,
    }
}

/// Whether an override changes the model, or what its rows read.
pub(crate) fn changes_the_model(text: &str) -> bool {
    let key = text.split('=').next().unwrap_or_default().trim();
    let is_of = |table: &str| {
        let rest = key.strip_prefix(table);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    is_of(THINNED) || !HARMLESS.into_iter().any(is_of)
}

/// The numbers that a run will have.
pub(crate) struct Names {
    of_summary: BTreeMap<String, &'static str>,
    of_columns: BTreeMap<String, &'static str>,
}

impl Names {
    /// Those of a run of a system with these settings.
    pub(crate) fn of(system: &System, settings: &Settings) -> Names {
        let by_name = |all: Vec<Quantity>| -> BTreeMap<String, &'static str> {
            all.into_iter().map(|one| (one.name, one.unit)).collect()
        };
        // twin columns are told where the run begins
        let columns = columns_with_units(system, settings).unwrap_or_default();
        Names {
            of_summary: by_name(quantities(system, settings)),
            of_columns: by_name(columns),
        }
    }

    /// A row to the time `end` (s).
    fn row(&self, path: &str, given: &Expect, end: f64) -> Result<Expectation, Box<Problem>> {
        let (key, quantity, all) = match (&given.summary, &given.column) {
            (Some(name), _) => ("summary", name, &self.of_summary),
            (None, Some(name)) => ("column", name, &self.of_columns),
            // the schema has refused it
            (None, None) => return refused(Problem::new(path, "no quantity")),
        };
        let unit = *all
            .get(quantity)
            .ok_or_else(|| Box::new(unknown(&format!("{path}.{key}"), quantity, all)))?;
        Ok(Expectation {
            quantity: quantity.clone(),
            take: taken(path, given, end)?,
            unit: unit.to_owned(),
            range: range(path, given, unit)?,
            kind: kind(given.kind),
            source: given.source.clone(),
            reason: reason(path, given)?,
        })
    }
}

/// The names that are accepted after the part of a name that is known, and the nearest of all.
fn unknown(path: &str, name: &str, all: &BTreeMap<String, &'static str>) -> Problem {
    let mut known = String::new();
    for part in name.split_inclusive('.') {
        let longer = format!("{known}{part}");
        if !part.ends_with('.') || !all.keys().any(|own| own.starts_with(&longer)) {
            break;
        }
        known = longer;
    }
    let below = all.keys().filter_map(|own| own.strip_prefix(&known));
    let mut next: Vec<&str> = below
        .map(|rest| rest.split_once('.').map_or(rest, |(part, _)| part))
        .collect();
    next.dedup();
    let hidden = next.len().saturating_sub(SHOWN);
    next.truncate(SHOWN);
    let next = next.into_iter().map(|part| format!("{known}{part}"));
    let nearest = carom_quantities::nearest(name, all.keys().map(String::as_str));
    let problem = Problem {
        nearest: nearest.map(str::to_owned),
        ..Problem::new(path, "no run of this case has such a number")
    };
    let problem = problem.found(name).accepted(next);
    match hidden {
        0 => problem,
        count => problem.note(format!("{count} more names are accepted")),
    }
}

fn taken(path: &str, given: &Expect, end: f64) -> Result<Option<Take>, Box<Problem>> {
    Ok(match given.take {
        None => None,
        Some(schema::Take::Largest) => Some(Take::Largest),
        Some(schema::Take::Smallest) => Some(Take::Smallest),
        Some(schema::Take::Last) => Some(Take::Last),
        Some(schema::Take::At(time)) if time.0 > end => {
            let problem = Problem::new(format!("{path}.take.at"), "after the end of the run");
            let found = problem.found(format!("{} s", time.0));
            return refused(found.accepted([format!("at most {end} s")]));
        }
        Some(schema::Take::At(time)) => Some(Take::At(time.0)),
    })
}

fn range(path: &str, given: &Expect, unit: &'static str) -> Result<Range, Box<Problem>> {
    let read = |key: &str, amount: &Option<Amount>| match amount {
        None => Ok(None),
        Some(amount) => si(&format!("{path}.{key}"), amount, unit).map(Some),
    };
    let [at_least, at_most] = [
        read("at-least", &given.at_least)?,
        read("at-most", &given.at_most)?,
    ];
    let Some(value) = read("value", &given.value)? else {
        return match (at_least, at_most) {
            (Some(low), Some(high)) if low > high => {
                let problem = Problem::new(format!("{path}.at-least"), "above `at-most`");
                refused(problem.found(low).accepted([format!("at most {high}")]))
            }
            _ => Ok(Range::Within { at_least, at_most }),
        };
    };
    if at_least.is_some() || at_most.is_some() {
        let key = ["at-most", "at-least"][usize::from(at_least.is_some())];
        let message = "a row has a value or bounds, not both";
        return refused(Problem::new(format!("{path}.{key}"), message).accepted(["no bounds"]));
    }
    let tolerance = tolerance(path, given, (value, unit))?;
    Ok(Range::Near { value, tolerance })
}

/// The largest difference from a value, in the unit of the value.
fn tolerance(
    path: &str,
    given: &Expect,
    (value, unit): (f64, &'static str),
) -> Result<f64, Box<Problem>> {
    let path = format!("{path}.tolerance");
    let written = given.tolerance.as_ref();
    let tolerance = match written {
        Some(Amount::Number(part)) if value == 0.0 && *part != 0.0 => {
            let message = "a bare number is a part of the value, and zero has no parts";
            let accepted = match unit {
                "" => "`at-least` and `at-most` in place of `value` and `tolerance`".to_owned(),
                unit => format!("a text with a unit, such as \"1 {unit}\""),
            };
            return refused(Problem::new(path, message).found(part).accepted([accepted]));
        }
        Some(Amount::Number(part)) => part * value.abs(),
        Some(text) => si(&path, text, unit)?,
        // the schema has refused it
        None => return refused(Problem::new(path, "no tolerance")),
    };
    if tolerance < 0.0 {
        let problem = Problem::new(path, "a tolerance is not negative");
        return refused(problem.accepted(["zero or more"]));
    }
    Ok(tolerance)
}

/// A number in the unit of its quantity.
fn si(path: &str, amount: &Amount, unit: &'static str) -> Result<f64, Box<Problem>> {
    let text = match amount {
        Amount::Number(value) => return Ok(*value),
        Amount::Text(text) => text,
    };
    let wanted = Dimension::of_unit(unit).unwrap_or(Dimension {
        length: 0,
        mass: 0,
        time: 0,
    });
    parse_quantity(text, wanted).map_err(|error| {
        let accepted = match unit {
            "" => "a number".to_owned(),
            unit => format!("a number in {unit}, or a text such as \"1.5 {unit}\""),
        };
        let problem = Problem::new(path, error.to_string());
        Box::new(Problem {
            nearest: error.meant(),
            ..problem.found(format!("{text:?}")).accepted([accepted])
        })
    })
}

fn refused<T>(problem: Problem) -> Result<T, Box<Problem>> {
    Err(Box::new(problem))
}

fn kind(given: ExpectKind) -> Kind {
    match given {
        ExpectKind::ClosedForm => Kind::ClosedForm,
        ExpectKind::Published => Kind::Published,
        ExpectKind::AnotherCode => Kind::AnotherCode,
        ExpectKind::SecondFormulation => Kind::SecondFormulation,
        ExpectKind::Regression => Kind::Regression,
    }
}

/// The reason for the tolerance. A figure of our own has no other hold than that.
fn reason(path: &str, given: &Expect) -> Result<Option<String>, Box<Problem>> {
    if given.kind == ExpectKind::Regression && given.reason.is_none() {
        let message = "a regression says why its tolerance is what it is";
        let problem = Problem::new(format!("{path}.kind"), message).found("regression");
        return refused(problem.accepted(["the key `reason` beside it"]));
    }
    Ok(given.reason.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overrides_of_output_title_and_expectations_leave_the_model_as_it_is() {
        for harmless in [
            "title=x",
            "output.fields.every=1",
            " expect.peak.tolerance = 0.1",
            "output.compress-histories=true",
        ] {
            assert!(!changes_the_model(harmless), "{harmless}");
        }
        for change in [
            "time.step=1",
            "output.histories.every=1",
            "title-of-mine=1",
            "mesh.refine=1",
        ] {
            assert!(changes_the_model(change), "{change}");
        }
        let given = ["title=x", "time.step=1", "mesh.refine=1"].map(str::to_owned);
        let why = expected(&Expected::default(), &given).unjudged;
        let why = why.unwrap_or_default();
        assert!(why.ends_with("without `--set time.step=1` `--set mesh.refine=1`"));
    }
}
