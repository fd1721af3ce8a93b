//! Cases: checks, runs, comparisons and studies.

use std::path::PathBuf;

use carom_case::schema::{Case, json_schema};
use carom_case::{
    Axis, Built, Choices, Fit, Input, Locator, NotResumed, Problem, Resume, Source, Sweep,
    SweepError,
};
use carom_dynamics::Observer;
use carom_studies::compare::Variant;
use pyo3::prelude::*;

use crate::errors::{failed, refused};
use crate::watch::{Shown, Watch};

/// Name and text of a case, the folder that its paths start from, and overrides `key.path=value`.
pub(crate) type Given = (String, String, PathBuf, Vec<String>);

/// Name, verdict and reason of a run in a table.
type Row = (String, &'static str, String);

pub(crate) fn input((name, text, folder, overrides): Given) -> Input {
    Input {
        folder,
        ..Input::from_text(&name, &text, &overrides)
    }
}

/// Facts by their names, and warnings.
type Checked = (Vec<(String, String)>, Vec<String>);

/// A case that has been read and built.
pub(crate) struct Loaded {
    pub(crate) input: Input,
    pub(crate) case: Case,
    pub(crate) locator: Locator,
    pub(crate) built: Built,
}

/// What builds a case: to be run, or to be looked at.
type Build = fn(&Case, &Locator, &Input) -> Result<Built, Vec<Problem>>;

/// Reads and builds a case.
pub(crate) fn load(py: Python<'_>, given: Given) -> PyResult<Loaded> {
    load_by(py, given, carom_case::build)
}

fn load_by(py: Python<'_>, given: Given, build: Build) -> PyResult<Loaded> {
    let input = input(given);
    let loaded = py.detach(|| {
        let (case, locator) = carom_case::parse(&input)?;
        let built = build(&case, &locator, &input)?;
        Ok((case, locator, built))
    });
    match loaded {
        Ok((case, locator, built)) => Ok(Loaded {
            input,
            case,
            locator,
            built,
        }),
        Err(problems) => Err(refuse(py, &input.sources, problems)),
    }
}

fn refuse(py: Python<'_>, sources: &[Source], problems: Vec<Problem>) -> PyErr {
    refused(py, sources, &problems)
}

/// The text of a case file.
#[pyfunction]
pub(crate) fn read_file(py: Python<'_>, path: PathBuf) -> PyResult<String> {
    match Input::read(&path, &[]) {
        Ok(mut input) => Ok(input.sources.swap_remove(0).text),
        Err(problems) => Err(refuse(py, &[], problems)),
    }
}

/// The JSON schema of a case.
#[pyfunction]
pub(crate) fn schema() -> String {
    json_schema().to_string()
}

/// Facts and warnings of a case that can be run.
#[pyfunction]
pub(crate) fn check(py: Python<'_>, given: Given) -> PyResult<Checked> {
    let built = load_by(py, given, carom_case::build_to_look)?.built;
    let facts = py.detach(|| {
        let mut facts = carom_case::facts(&built);
        facts.extend(carom_case::mesh_facts(&built).0);
        facts
    });
    let facts = facts.into_iter().map(|fact| (fact.name, fact.value));
    Ok((facts.collect(), built.warnings.clone()))
}

/// Runs a case into a folder; returns its summary as JSON.
#[pyfunction]
pub(crate) fn run(
    py: Python<'_>,
    given: Given,
    folder: PathBuf,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    let Loaded {
        input, case, built, ..
    } = load(py, given)?;
    let watch = Watch::new(progress);
    let ended = py.detach(|| {
        let mut shown = Shown(watch.clone(), built.end);
        let stop = || watch.stops();
        carom_case::run((&input, &case, &built), folder, &mut shown, &stop)
    });
    summary(&watch, ended)
}

fn summary(
    watch: &Watch,
    ended: Result<carom_case::Finished, carom_case::Failed>,
) -> PyResult<String> {
    watch.outcome()?;
    let finished = ended.map_err(|error| failed(&error))?;
    finished.summary.to_json().map_err(|error| failed(&error))
}

/// Goes on with the run in a folder; returns its summary as JSON.
#[pyfunction]
pub(crate) fn resume(
    py: Python<'_>,
    folder: PathBuf,
    overrides: Vec<String>,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    let opened = py.detach(|| Resume::open(&folder, &overrides));
    let run = opened.map_err(|error| match error {
        NotResumed::Case(sources, problems) => refuse(py, &sources, problems),
        NotResumed::Folder(error) => failed(&error),
    })?;
    let watch = Watch::new(progress);
    let ended = py.detach(|| {
        let mut shown = Shown(watch.clone(), run.end());
        run.run(&mut shown, &|| watch.stops())
    });
    summary(&watch, ended)
}

/// Gives `work` the way to make the runs of a table.
fn sweep<T: Send>(
    py: Python<'_>,
    (folder, contact, jobs): (PathBuf, Option<String>, usize),
    work: impl FnOnce(&Sweep) -> Result<T, SweepError> + Send,
) -> PyResult<T> {
    let watch = Watch::new(None);
    let made = py.detach(|| {
        let shown =
            |_: &str, end: f64| -> Box<dyn Observer> { Box::new(Shown(watch.clone(), end)) };
        work(&Sweep {
            folder: &folder,
            contact: contact.as_deref(),
            jobs,
            watch: &shown,
            stop: &|| watch.stops(),
        })
    });
    watch.outcome()?;
    made.map_err(|error| wrong(py, error))
}

fn wrong(py: Python<'_>, error: SweepError) -> PyErr {
    match error {
        SweepError::Input { sources, problems } => refuse(py, &sources, problems),
        SweepError::Output(error) => failed(&error),
    }
}

fn row(variant: &Variant) -> Row {
    let (verdict, reason) = variant.verdict();
    (variant.name.clone(), verdict, reason)
}

/// Schemes, laws, other cases, and the reference.
type Chosen = (Vec<String>, Vec<String>, Vec<Given>, Option<String>);

/// Runs the variants of a case into a folder.
#[pyfunction]
pub(crate) fn compare(
    py: Python<'_>,
    given: Given,
    choices: Chosen,
    into: (PathBuf, Option<String>, usize),
) -> PyResult<Vec<Row>> {
    let case = input(given);
    let (schemes, laws, beside, reference) = choices;
    let choices = Choices {
        schemes,
        laws,
        beside: beside.into_iter().map(input).collect(),
        reference,
    };
    sweep(py, into, |sweep| {
        let (comparison, _) = carom_case::compare(&case, &choices, sweep)?;
        Ok(comparison.variants.iter().map(row).collect())
    })
}

/// Runs a case over the values of keys, `key.path=value,value;key=value,value` for each axis, into a folder.
#[pyfunction]
pub(crate) fn study(
    py: Python<'_>,
    given: Given,
    axes: Vec<String>,
    into: (PathBuf, Option<String>, usize),
) -> PyResult<Vec<Row>> {
    let input = input(given);
    sweep(py, into, |sweep| {
        let axes = axes.iter().map(|axis| Axis::read(axis));
        let axes = axes.collect::<Result<Vec<_>, _>>()?;
        let (study, _) = carom_case::study(&input, &axes, sweep)?;
        Ok(study.runs.iter().map(|run| row(&run.variant)).collect())
    })
}

/// Looks for the value of a key that gives a result, and writes the trials into a folder. `wanted`: the key, `least,largest`, and `result=value`.
#[pyfunction]
pub(crate) fn fit(
    py: Python<'_>,
    given: Given,
    wanted: (String, String, String),
    into: (PathBuf, Option<String>, usize),
) -> PyResult<Vec<Row>> {
    let input = input(given);
    let (key, between, to) = wanted;
    sweep(py, into, |sweep| {
        let fit = Fit::read(&key, &between, &to, sweep.contact)?;
        let (study, _) = carom_case::fit(&input, &fit, sweep)?;
        Ok(study.runs.iter().map(|run| row(&run.variant)).collect())
    })
}
