//! Errors as exceptions.

use std::error::Error as StdError;

use carom_case::{Problem, Source};
use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

create_exception!(
    carom,
    CaseError,
    PyValueError,
    "A case that is wrong. `problems`: one dict for each cause, with `path`, `message`, `found`, `accepted`, `nearest`, `notes`, and `line` (from 1) where the case is a file."
);
create_exception!(
    carom,
    RunError,
    PyRuntimeError,
    "A run that failed. What was computed before is in its results folder."
);

/// All problems as one exception: a line for each with its place, the path of its key, and what the command says below.
pub(crate) fn refused(py: Python<'_>, sources: &[Source], problems: &[Problem]) -> PyErr {
    let lines: Vec<String> = problems.iter().map(|one| sentence(sources, one)).collect();
    let error = CaseError::new_err(lines.join("\n"));
    match list(py, sources, problems) {
        Ok(list) => match error.value(py).setattr("problems", list) {
            Ok(()) => error,
            Err(other) => other,
        },
        Err(other) => other,
    }
}

fn list<'py>(
    py: Python<'py>,
    sources: &[Source],
    problems: &[Problem],
) -> PyResult<Bound<'py, PyList>> {
    let list = PyList::empty(py);
    for problem in problems {
        let dict = PyDict::new(py);
        dict.set_item("path", &problem.path)?;
        dict.set_item("message", &problem.message)?;
        dict.set_item("found", &problem.found)?;
        dict.set_item("accepted", &problem.accepted)?;
        dict.set_item("nearest", &problem.nearest)?;
        dict.set_item("notes", &problem.notes)?;
        dict.set_item("line", line(sources, problem).map(|(_, line)| line))?;
        list.append(dict)?;
    }
    Ok(list)
}

/// Name of the text in which a problem stands, and its line, from 1. A case that was made of a dict has no text that its author knows.
fn line<'a>(sources: &'a [Source], problem: &Problem) -> Option<(&'a str, usize)> {
    let place = problem.place?;
    let source = sources.get(place.source)?;
    let before = source.text.as_bytes().get(..place.start)?;
    let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
    (!source.name.is_empty()).then_some((&source.name, line))
}

fn sentence(sources: &[Source], problem: &Problem) -> String {
    let place = line(sources, problem).map(|(name, line)| format!("{name}:{line}: "));
    let mut text = format!("{}{problem}", place.unwrap_or_default());
    if let Some(found) = &problem.found {
        text += &format!("\n  found: {found}");
    }
    if !problem.accepted.is_empty() {
        text += &format!("\n  accepted: {}", problem.accepted.join(", "));
    }
    for note in &problem.notes {
        text += &format!("\n  note: {note}");
    }
    if let Some(nearest) = &problem.nearest {
        text += &format!("\n  did you mean `{nearest}`?");
    }
    text
}

/// A failed run, with its causes.
pub(crate) fn failed(error: &dyn StdError) -> PyErr {
    let mut text = error.to_string();
    let mut next = error.source();
    while let Some(cause) = next {
        let words = cause.to_string();
        if !text.contains(&words) {
            text = format!("{text}: {words}");
        }
        next = cause.source();
    }
    RunError::new_err(text)
}

/// A `ValueError`.
pub(crate) fn wrong(message: impl Into<String>) -> PyErr {
    PyValueError::new_err(message.into())
}
