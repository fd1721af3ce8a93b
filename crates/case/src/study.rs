//! `carom study`: the runs of a case over the values of a key.

use std::path::PathBuf;

use carom_output::Reference;
use carom_output::study::{Abscissa, Run, Study};

use crate::error::{Place, Problem};
use crate::input::{Input, Source};
use crate::sweep::{Ended, Job, Sweep, SweepError, folder_name, prepare, run_all};

/// A key path and the values that it takes, one per run, in TOML.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Vary {
    /// The key path: `time.step.courant`.
    pub key: String,
    /// Its values.
    pub values: Vec<String>,
}

impl Vary {
    /// Reads `key.path=value,value,...`. Commas inside brackets, braces or quotes belong to a value.
    ///
    /// # Errors
    /// There is no `=`, no key before it, or an empty value.
    pub fn read(text: &str) -> Result<Vary, SweepError> {
        let wrong = |message: &str| {
            let all = Place {
                source: 0,
                start: 0,
                end: text.len(),
            };
            let problem = Problem::new("", message).at(all);
            SweepError::Input {
                sources: vec![Source {
                    name: "--vary".to_owned(),
                    text: text.to_owned(),
                }],
                problems: vec![
                    problem
                        .accepted(["key.path=value,value,..., as in time.step.courant=1,0.5,0.25"]),
                ],
            }
        };
        let Some((key, values)) = text.split_once('=') else {
            return Err(wrong("a key to vary has no `=`"));
        };
        let vary = Vary {
            key: key.trim().to_owned(),
            values: split(values),
        };
        if vary.key.is_empty() {
            return Err(wrong("no key stands before the `=`"));
        }
        if vary.values.iter().any(String::is_empty) {
            return Err(wrong("a value is missing"));
        }
        Ok(vary)
    }
}

/// Splits at the commas that stand in no bracket, brace or quotes.
fn split(text: &str) -> Vec<String> {
    let mut values = vec![String::new()];
    let (mut depth, mut quote) = (0_i32, None);
    for letter in text.chars() {
        match (quote, letter) {
            (Some(open), letter) if open == letter => quote = None,
            (None, '"' | '\'') => quote = Some(letter),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth -= 1,
            (None, ',') if depth == 0 => {
                values.push(String::new());
                continue;
            }
            _ => {}
        }
        if let Some(value) = values.last_mut() {
            value.push(letter);
        }
    }
    values.iter().map(|value| value.trim().to_owned()).collect()
}

/// Runs the case once for every value and writes the study into the folder of `sweep`; returns it with the path of its
/// page. Several keys vary together: the first run takes the first value of each.
///
/// # Errors
/// The case, a key or a value is wrong, the keys have not equally many values, or no run can be made: nothing is written
/// then. A common file cannot be written.
pub fn study(input: &Input, vary: &[Vary], sweep: &Sweep) -> Result<(Study, PathBuf), SweepError> {
    let base = Job::new("", input, Vec::new())?;
    let count = vary.first().map_or(0, |vary| vary.values.len());
    if let Some(other) = vary.iter().find(|other| other.values.len() != count) {
        let message = "keys that vary together need equally many values";
        let found = format!("{} values of {}", other.values.len(), other.key);
        let problem = Problem::new("", message).found(found);
        return Err(base.refuse(vec![problem.accepted([format!("{count}")])]));
    }
    let job = |k: usize| {
        let overrides = vary
            .iter()
            .map(|vary| format!("{}={}", vary.key, vary.values[k]));
        let name = run_name(&vary[0].key, &vary[0].values[k], k);
        Job::new(&name, input, overrides.collect())
    };
    let jobs = (0..count).map(job).collect::<Result<Vec<Job>, _>>()?;
    let mut folder = prepare(&jobs, sweep)?;
    let study = gather(base.title(), vary, run_all(&jobs, sweep));
    let page = study.write(&mut folder)?;
    Ok((study, page))
}

/// Number, last part of the key, value: `2-courant-0.5`.
pub(crate) fn run_name(key: &str, value: &str, k: usize) -> String {
    let last = key.rsplit('.').next().unwrap_or_default();
    format!("{}-{}", k + 1, folder_name(&format!("{last} {value}")))
}

fn gather(title: String, vary: &[Vary], ended: Vec<Ended>) -> Study {
    let step = |one: &Ended| {
        one.variant
            .done()
            .map(|done| done.summary.time.largest_step)
    };
    let steps: Vec<f64> = ended.iter().filter_map(step).collect();
    let numbers = vary.first().map_or(Vec::new(), |vary| {
        let number = |value: &String| value.parse::<f64>().ok();
        vary.values.iter().map(number).collect()
    });
    let same = |pair: &[f64]| (pair[1] - pair[0]).abs() <= 1e-9 * pair[0];
    let abscissa = match steps.windows(2).all(same) {
        false => Abscissa::Step,
        true if !numbers.is_empty() && numbers.iter().all(Option::is_some) => Abscissa::Key,
        true => Abscissa::Nothing,
    };
    let run = |(k, one): (usize, Ended)| Run {
        x: match abscissa {
            Abscissa::Step => step(&one),
            Abscissa::Key => numbers.get(k).copied().flatten(),
            Abscissa::Nothing => None,
        },
        exact_mean_force: one.exact.as_ref().and_then(|exact| {
            let end = one.variant.done()?.summary.time.end;
            exact_mean_force(exact, end)
        }),
        variant: one.variant,
    };
    Study {
        title,
        keys: vary
            .iter()
            .map(|vary| (vary.key.clone(), vary.values.clone()))
            .collect(),
        runs: ended.into_iter().enumerate().map(run).collect(),
        abscissa,
    }
}

/// Exact impulse over the time spent in exact contact up to `end`, N.
fn exact_mean_force(exact: &Reference, end: f64) -> Option<f64> {
    let contacts = exact.solution.contacts().iter();
    let closed: f64 = contacts
        .map(|contact| (contact.end.min(end) - contact.start).max(0.0))
        .sum();
    (closed > 0.0).then(|| exact.solution.impulse(end) / closed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_inside_a_value_do_not_split_it() {
        let vary = Vary::read("a.b = [1, 2], { x = 1, y = \"3,4\" } ,5").unwrap();
        assert_eq!(vary.key, "a.b");
        assert_eq!(vary.values, ["[1, 2]", "{ x = 1, y = \"3,4\" }", "5"]);
    }

    #[test]
    fn what_is_no_list_of_values_is_refused() {
        for text in ["a.b", "=1,2", "a=", "a=1,,2"] {
            assert!(
                matches!(Vary::read(text), Err(SweepError::Input { .. })),
                "{text}"
            );
        }
    }
}
