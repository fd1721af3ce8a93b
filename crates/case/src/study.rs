//! `carom study`: the runs of a case over the values of a key.

use std::collections::BTreeSet;
use std::path::PathBuf;

use carom_output::Reference;
use carom_studies::study::{Abscissa, Run, Study};

use crate::error::{Place, Problem};
use crate::input::{Input, Source};
use crate::sweep::{Ended, Job, Sweep, SweepError, folder_name, prepare, run_all};

/// A key path and the values that it takes, one after the other, in TOML.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Vary {
    /// The key path: `time.step.courant`.
    pub key: String,
    /// Its values.
    pub values: Vec<String>,
}

/// Keys that vary together: the first run takes the first value of each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axis {
    /// The keys; at least one, with equally many values each.
    keys: Vec<Vary>,
}

impl Axis {
    /// Reads `key.path=value,value,...`, or several of them with semicolons between. Commas and semicolons inside brackets,
    /// braces or quotes belong to a value.
    ///
    /// # Errors
    /// There is no `=`, no key before it, an empty value, or the keys have not equally many values.
    pub fn read(text: &str) -> Result<Axis, SweepError> {
        let keys = split(text, ';');
        let keys = keys.iter().map(|key| Vary::read(key));
        let keys = keys.collect::<Result<Vec<Vary>, SweepError>>()?;
        let count = keys[0].values.len();
        match keys.iter().find(|key| key.values.len() != count) {
            None => Ok(Axis { keys }),
            Some(other) => {
                let message = "keys that vary together need equally many values";
                let found = format!("{} values of {}", other.values.len(), other.key);
                let problem = Problem::new("", message).found(found);
                Err(SweepError::Input {
                    sources: vec![Source {
                        name: "--vary".to_owned(),
                        text: text.to_owned(),
                    }],
                    problems: vec![problem.accepted([format!("{count}")])],
                })
            }
        }
    }

    /// How many values it has.
    fn len(&self) -> usize {
        self.keys[0].values.len()
    }

    /// The overrides of its value number `k`.
    fn overrides(&self, k: usize) -> impl Iterator<Item = String> + '_ {
        let one = move |vary: &Vary| format!("{}={}", vary.key, vary.values[k]);
        self.keys.iter().map(one)
    }

    /// Last part of the first key and its value number `k`: `courant 0.5`.
    fn name(&self, k: usize) -> String {
        let Vary { key, values } = &self.keys[0];
        format!("{} {}", last_part(key), values[k])
    }
}

impl Vary {
    /// Reads `key.path=value,value,...`.
    fn read(text: &str) -> Result<Vary, SweepError> {
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
            values: split(values, ','),
        };
        if vary.key.is_empty() {
            return Err(wrong("there is no key before the `=`"));
        }
        if vary.values.iter().any(String::is_empty) {
            return Err(wrong("a value is missing"));
        }
        Ok(vary)
    }
}

/// Splits at the separators that stand in no bracket, brace or quotes.
fn split(text: &str, separator: char) -> Vec<String> {
    let mut values = vec![String::new()];
    let (mut depth, mut quote) = (0_i32, None);
    for letter in text.chars() {
        match (quote, letter) {
            (Some(open), letter) if open == letter => quote = None,
            (None, '"' | '\'') => quote = Some(letter),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth -= 1,
            (None, letter) if letter == separator && depth == 0 => {
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

/// Runs the case for every combination of the values of the axes, the last axis fastest, and writes the study into the
/// folder of `sweep`; returns it with the path of its page.
///
/// # Errors
/// The case, a key or a value is wrong, or no run can be made: nothing is written then. A common file cannot be written.
pub fn study(input: &Input, axes: &[Axis], sweep: &Sweep) -> Result<(Study, PathBuf), SweepError> {
    let base = Job::new("", input, Vec::new())?;
    base.has_contact(sweep.contact)?;
    no_key_twice(axes)?;
    let grid = combinations(axes);
    let job = |(k, places): (usize, &Vec<usize>)| {
        let chosen = || axes.iter().zip(places);
        let overrides = chosen().flat_map(|(axis, place)| axis.overrides(*place));
        let names: Vec<String> = chosen().map(|(axis, place)| axis.name(*place)).collect();
        let name = format!("{}-{}", k + 1, folder_name(&names.join(" ")));
        Job::new(&name, input, overrides.collect())
    };
    let jobs = grid.iter().enumerate().map(job);
    let jobs = jobs.collect::<Result<Vec<Job>, _>>()?;
    let mut folder = prepare(&jobs, sweep)?;
    let study = gather(base.title(), axes, &grid, run_all(&jobs, sweep));
    let page = study.write(&mut folder)?;
    Ok((study, page))
}

/// # Errors
/// Two axes, or two keys that vary together, change the same key.
fn no_key_twice(axes: &[Axis]) -> Result<(), SweepError> {
    let mut seen = BTreeSet::new();
    for vary in axes.iter().flat_map(|axis| &axis.keys) {
        let parts: Vec<&str> = vary.key.split('.').map(str::trim).collect();
        if !seen.insert(parts) {
            let problem = Problem::new("", format!("`--vary` has the key `{}` twice", vary.key));
            let accepted = "each key once, with all of its values: time.step.courant=1,0.5,0.25";
            return Err(SweepError::Input {
                sources: Vec::new(),
                problems: vec![problem.accepted([accepted])],
            });
        }
    }
    Ok(())
}

/// Places of the values on the axes, for every combination; none without an axis.
fn combinations(axes: &[Axis]) -> Vec<Vec<usize>> {
    let mut all = match axes.is_empty() {
        true => Vec::new(),
        false => vec![Vec::new()],
    };
    for axis in axes {
        let with = |places: Vec<usize>| (0..axis.len()).map(move |k| [&places[..], &[k]].concat());
        all = all.into_iter().flat_map(with).collect();
    }
    all
}

/// Number, last part of the key, value: `2-courant-0.5`.
pub(crate) fn run_name(key: &str, value: &str, k: usize) -> String {
    let text = format!("{} {value}", last_part(key));
    format!("{}-{}", k + 1, folder_name(&text))
}

fn last_part(key: &str) -> &str {
    key.rsplit('.').next().unwrap_or_default()
}

fn gather(title: String, axes: &[Axis], grid: &[Vec<usize>], ended: Vec<Ended>) -> Study {
    let step = |one: &Ended| {
        one.variant
            .done()
            .map(|done| done.summary.time.largest_step)
    };
    let series = |places: &Vec<usize>| {
        let others = axes.iter().zip(places).skip(1);
        let names: Vec<String> = others.map(|(axis, place)| axis.name(*place)).collect();
        names.join(", ")
    };
    // whether the step differs along the first axis, the others standing
    let steps = ended.iter().zip(grid);
    let steps: Vec<(String, f64)> = steps
        .filter_map(|(one, places)| Some((series(places), step(one)?)))
        .collect();
    let differ = steps.iter().any(|(name, step)| {
        let same = |other: f64| (other - step).abs() <= 1e-9 * step;
        steps
            .iter()
            .any(|(other, value)| other == name && !same(*value))
    });
    let numbers = axes.first().map_or(Vec::new(), |axis| {
        let number = |value: &String| value.parse::<f64>().ok();
        axis.keys[0].values.iter().map(number).collect()
    });
    let abscissa = match differ {
        true => Abscissa::Step,
        false if !numbers.is_empty() && numbers.iter().all(Option::is_some) => Abscissa::Key,
        false => Abscissa::Nothing,
    };
    let run = |(one, places): (Ended, &Vec<usize>)| Run {
        x: match abscissa {
            Abscissa::Step => step(&one),
            Abscissa::Key => numbers.get(places[0]).copied().flatten(),
            Abscissa::Nothing => None,
        },
        exact_mean_force: one.exact.as_ref().and_then(|exact| {
            let end = one.variant.done()?.summary.time.end;
            exact_mean_force(exact, end)
        }),
        series: series(places),
        variant: one.variant,
    };
    let keys = axes.iter().enumerate().flat_map(|(at, axis)| {
        axis.keys.iter().map(move |vary| {
            let values = grid.iter().map(|places| vary.values[places[at]].clone());
            (vary.key.clone(), values.collect())
        })
    });
    Study {
        title,
        keys: keys.collect(),
        runs: ended.into_iter().zip(grid).map(run).collect(),
        abscissa,
        fitted: None,
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
    fn commas_and_semicolons_inside_a_value_do_not_split_it() {
        let axis = Axis::read("a.b = [1, 2], { x = 1, y = \"3,4\" } ,\"5;6\"; c=7,8,9").unwrap();
        let [vary, other] = &axis.keys[..] else {
            panic!("{axis:?}");
        };
        assert_eq!(vary.key, "a.b");
        assert_eq!(vary.values, ["[1, 2]", "{ x = 1, y = \"3,4\" }", "\"5;6\""]);
        assert_eq!(other.values, ["7", "8", "9"]);
    }

    #[test]
    fn a_grid_has_every_combination_once_the_last_axis_fastest() {
        let axes = ["a=1,2;b=3,4", "c=5,6,7"].map(|text| Axis::read(text).unwrap());
        let places = [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [1, 2]];
        assert_eq!(combinations(&axes), places);
        assert!(combinations(&[]).is_empty());
    }

    #[test]
    fn a_key_that_varies_twice_is_refused() {
        let axes = |texts: &[&str]| -> Vec<Axis> {
            texts.iter().map(|text| Axis::read(text).unwrap()).collect()
        };
        for twice in [&["a.b=1,2", "a . b=3,4"][..], &["a.b=1,2;a.b=3,4"]] {
            let error = no_key_twice(&axes(twice));
            assert!(matches!(error, Err(SweepError::Input { .. })), "{twice:?}");
        }
        assert!(no_key_twice(&axes(&["a.b=1,2;a.c=3,4", "b=1,2"])).is_ok());
    }

    #[test]
    fn what_is_no_list_of_values_is_refused() {
        for text in ["a.b", "=1,2", "a=", "a=1,,2", "a=1;", "a=1,2;b=3"] {
            assert!(
                matches!(Axis::read(text), Err(SweepError::Input { .. })),
                "{text}"
            );
        }
    }
}
