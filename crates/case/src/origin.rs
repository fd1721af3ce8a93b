//! Which case a checkpoint is of: what goes into it, and how another case differs.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use carom_algebra::fingerprint::Fingerprint;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::error::Problem;
use crate::input::Input;
use crate::schema::Case;
use crate::tree::join;

/// What may change when a run goes on.
const FREE: [&str; 4] = ["title", "output", "expect", "time.end"];

/// The case of a run, as its checkpoints keep it.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Origin {
    /// Title of the report.
    pub(crate) title: String,
    /// Name of the case file.
    pub(crate) file: String,
    /// Folder that the paths of the case file start from, relative to the results folder.
    pub(crate) folder: PathBuf,
    /// Overrides of the command line, `key.path=value`.
    pub(crate) overrides: Vec<String>,
    /// The case with overrides and defaults, in SI units.
    case: Value,
    /// Fingerprints of the files that the case reads, by the key path of their name.
    files: BTreeMap<String, String>,
}

impl Origin {
    /// That of a case whose results go into a folder.
    pub(crate) fn of(input: &Input, case: &Case, results: &Path) -> Origin {
        let overrides = input.sources.iter().filter(|s| s.name == "--set");
        let name = input.sources.first().map(|source| source.name.clone());
        let file = name.as_deref().and_then(|name| Path::new(name).file_name());
        let case_value = value(case);
        Origin {
            file: file.unwrap_or_default().to_string_lossy().into_owned(),
            title: case.title.clone().or(name).unwrap_or_default(),
            folder: relative(results, &input.folder),
            overrides: overrides.map(|source| source.text.clone()).collect(),
            files: fingerprints(&case_value, &input.folder),
            case: case_value,
        }
    }

    /// That of no run, to ask what a run would have.
    pub(crate) fn of_none() -> Origin {
        Origin {
            title: String::new(),
            file: String::new(),
            folder: PathBuf::new(),
            overrides: Vec::new(),
            case: Value::Null,
            files: BTreeMap::new(),
        }
    }

    /// The same of a run with forces that are in no case file.
    pub(crate) fn with_forces(mut self, names: &[&str]) -> Origin {
        if let (false, Value::Object(case)) = (names.is_empty(), &mut self.case) {
            case.insert(
                "forces set by a program".to_owned(),
                names.join(", ").into(),
            );
        }
        self
    }

    /// That of the run which goes on as this case.
    pub(crate) fn of_the_rest(self, input: &Input, case: &Case) -> Origin {
        Origin {
            title: self.title,
            file: self.file,
            folder: self.folder,
            ..Origin::of(input, case, Path::new(""))
        }
    }

    /// As the text of a checkpoint.
    pub(crate) fn to_json(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }

    /// Why a run from a checkpoint at a time (s) cannot go on as this case.
    pub(crate) fn differences(&self, case: &Case, input: &Input, time: f64) -> Vec<Problem> {
        let now = value(case);
        let files = fingerprints(&now, &input.folder);
        let mut problems = Vec::new();
        let both = |path: &str| self.files.get(path).zip(files.get(path));
        compare(("", &self.case, &now), &mut |path, before, now| {
            let problem = match both(path) {
                Some((before, now)) if before == now => return,
                Some(_) => changed_file(path, now),
                None => {
                    let problem = Problem::new(path, "the run cannot go on with another model");
                    problem.found(text(now)).accepted([text(before)])
                }
            };
            problems.push(problem);
        });
        // files whose names are the same
        for (path, before) in &self.files {
            let told = problems.iter().any(|problem| problem.path == *path);
            if files.get(path).is_some_and(|now| now != before) && !told {
                problems.push(changed_file(path, &at(&now, path)));
            }
        }
        problems.extend(self.end(case, time));
        problems.extend(self.format(case));
        problems
    }

    /// Why the histories cannot go on as this case has them.
    fn format(&self, case: &Case) -> Option<Problem> {
        let path = "output.compress-histories";
        let before = at(&self.case, path).as_bool().unwrap_or_default();
        let now = case.output.compress_histories;
        let message = "the histories of a run that goes on keep their format";
        (before != now).then(|| {
            let problem = Problem::new(path, message).found(now.to_string());
            problem.accepted([before.to_string()])
        })
    }

    /// Why the run cannot go on to the end of the case.
    fn end(&self, case: &Case, time: f64) -> Option<Problem> {
        let end = case.time.end.0;
        let before = at(&self.case, "time.end").as_f64();
        let problem = |message: &str| Problem::new("time.end", message).found(format!("{end} s"));
        let before = before.filter(|before| *before != end)?;
        // the last step may lead beyond the end
        if end < time {
            let message = "the checkpoint is later than the end of the run";
            return Some(problem(message).accepted([format!("at least {time} s")]));
        }
        let same = || [format!("{before} s, as before")];
        if case.load.iter().any(|(_, load)| load.random.is_some()) {
            let message = "a random force is made for the duration of the run: another end would give another force";
            return Some(problem(message).accepted(same()));
        }
        let stage = case.time.stage.map(|stage| stage.end.0)?;
        (stage == before || stage == end).then(|| {
            problem("a run that ends with its static stage has other steps").accepted(same())
        })
    }
}

fn value(case: &Case) -> Value {
    serde_json::to_value(case).unwrap_or_default()
}

/// A value for people.
fn text(value: &Value) -> String {
    match value {
        Value::Null => "nothing".to_owned(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

fn changed_file(path: &str, name: &Value) -> Problem {
    let message = "the run cannot go on with another model: the content of this file has changed";
    let problem = Problem::new(path, message).found(text(name));
    problem.accepted(["the file as it was"])
}

/// The value at a key path of bare keys.
fn at(value: &Value, path: &str) -> Value {
    let mut keys = path.split('.');
    keys.try_fold(value, |value, key| value.get(key))
        .cloned()
        .unwrap_or_default()
}

/// Calls `differ` with the path and both values wherever two cases differ, as deep as possible. What is left out is null.
fn compare(
    (path, before, now): (&str, &Value, &Value),
    differ: &mut dyn FnMut(&str, &Value, &Value),
) {
    if before == now || FREE.contains(&path) {
        return;
    }
    match (before, now) {
        (Value::Object(one), Value::Object(other)) => {
            let mut keys: Vec<&String> = one.keys().chain(other.keys()).collect();
            keys.sort_unstable();
            keys.dedup();
            for key in keys {
                let [before, now] = [one, other].map(|all| all.get(key).unwrap_or(&Value::Null));
                compare((&join(path, key), before, now), differ);
            }
        }
        (Value::Array(one), Value::Array(other)) if one.len() == other.len() => {
            for (k, (before, now)) in one.iter().zip(other).enumerate() {
                compare((&format!("{path}[{k}]"), before, now), differ);
            }
        }
        _ => differ(path, before, now),
    }
}

/// Fingerprints of the files that a case names. The file of a reduction is none of them: it is made anew where it does not fit.
fn fingerprints(case: &Value, folder: &Path) -> BTreeMap<String, String> {
    let mut names = Vec::new();
    gather(("", case), &mut names);
    let print = |(path, name): (String, &str)| {
        let bytes = std::fs::read(folder.join(name)).ok()?;
        Some((path, Fingerprint::default().bytes(&bytes).digits()))
    };
    names.into_iter().filter_map(print).collect()
}

fn gather<'a>((path, value): (&str, &'a Value), names: &mut Vec<(String, &'a str)>) {
    let Value::Object(entries) = value else {
        return;
    };
    for (key, value) in entries.iter().filter(|(key, _)| *key != "reduction") {
        let path = join(path, key);
        match value {
            Value::String(name) if key == "file" => names.push((path, name)),
            _ => gather((&path, value), names),
        }
    }
}

/// The way from one folder to another; the other one where there is no way.
fn relative(from: &Path, to: &Path) -> PathBuf {
    let to = if to.as_os_str().is_empty() {
        Path::new(".")
    } else {
        to
    };
    let plain = |path: &Path| std::path::absolute(path).ok();
    let Some((from, to)) = plain(from).zip(plain(to)) else {
        return to.to_owned();
    };
    let common = from.components().zip(to.components());
    let common = common.take_while(|(one, other)| one == other).count();
    let rest: Vec<Component> = from.components().skip(common).collect();
    let up = |part: &Component| matches!(part, Component::ParentDir);
    if common == 0 || rest.iter().any(up) {
        return to;
    }
    let down = to.components().skip(common);
    let mut way: PathBuf = rest.iter().map(|_| Component::ParentDir).collect();
    way.extend(down);
    way
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_from_the_results_leads_to_the_folder_of_the_case() {
        for (from, to, way) in [
            ("/a/b/case.carom", "/a/b", ".."),
            ("/r/case.carom", "/a/b", "../../a/b"),
            ("/a/b", "/a/b/c", "c"),
        ] {
            let found = relative(Path::new(from), Path::new(to));
            assert_eq!(found, Path::new(way), "{from} {to}");
        }
    }

    #[test]
    fn values_that_differ_are_named_by_their_paths() {
        let before: Value = serde_json::json!({ "a": { "b": [1.0, 2.0], "c": null }, "output": 1, "time": { "end": 1 } });
        let now = serde_json::json!({ "a": { "b": [1.0, 3.0], "d": 4 }, "output": 2, "time": { "end": 2 } });
        let mut found = Vec::new();
        compare(("", &before, &now), &mut |path, one, other| {
            found.push(format!("{path}: {} {}", text(one), text(other)));
        });
        assert_eq!(found, ["a.b[1]: 2.0 3.0", "a.d: nothing 4"]);
    }
}
