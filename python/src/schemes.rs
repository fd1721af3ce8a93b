//! Time schemes and contact laws as plain numbers.

use carom_laws::{Defaults, Friction, GivenLaw, Law, Level, Local, Status};
use carom_schemes::{Row, Scheme};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// What is wrong with a scheme or a law, without the place in a text that the user has not seen.
fn wrong(error: &serde_json::Error) -> PyErr {
    let message = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    let cause = message.strip_suffix(&place).unwrap_or(&message);
    PyValueError::new_err(cause.to_owned())
}

/// A scheme as the case file has it.
pub(crate) fn read_scheme(json: &str) -> PyResult<Scheme> {
    serde_json::from_str(json).map_err(|error| wrong(&error))
}

/// A law as the case file has it, with what it leaves out at zero.
pub(crate) fn read_law(json: &str) -> PyResult<Law> {
    let given: GivenLaw = serde_json::from_str(json).map_err(|error| wrong(&error))?;
    let law = given.law(&Defaults::default());
    law.map_err(|error| PyValueError::new_err(error.to_string()))
}

/// A friction law as the case file has it.
pub(crate) fn read_friction(json: &str) -> PyResult<Friction> {
    let friction: Friction = serde_json::from_str(json).map_err(|error| wrong(&error))?;
    let law = friction.get();
    let holds = |mu: f64| (0.0..=law.sticks()).contains(&mu);
    match [0.0, f64::INFINITY]
        .map(|rate| law.slides(rate))
        .into_iter()
        .all(holds)
    {
        true => Ok(friction),
        false => Err(PyValueError::new_err(
            "friction: accepted: a coefficient of sliding from 0 to that of sticking",
        )),
    }
}

/// Name, order, lengths of the stages, and the rows of the map of a step of `dt` (s), or of its last stage, each with the factors of u, v, a,
/// memory, x and c.
#[pyfunction]
pub(crate) fn scheme<'py>(py: Python<'py>, json: &str, dt: f64) -> PyResult<Bound<'py, PyDict>> {
    let scheme = read_scheme(json)?;
    let (scheme, map) = (scheme.get(), scheme.get().step_map(dt));
    let row = |row: &Row| [row.u, row.v, row.a, row.m, row.x, row.c];
    let dict = PyDict::new(py);
    dict.set_item("name", scheme.name())?;
    dict.set_item("order", scheme.order())?;
    dict.set_item("critical", scheme.critical())?;
    dict.set_item("explicit", scheme.is_explicit())?;
    dict.set_item("between", scheme.is_between())?;
    dict.set_item("gap", scheme.takes(Level::Gap))?;
    dict.set_item("rate", scheme.takes(Level::Rate))?;
    dict.set_item("contact", map.contact)?;
    dict.set_item("instant", map.instant(dt))?;
    dict.set_item("stages", scheme.stages())?;
    let rows = PyDict::new(py);
    rows.set_item("inertia", row(&map.inertia))?;
    rows.set_item("force", row(&map.force))?;
    rows.set_item("displacement", row(&map.displacement))?;
    rows.set_item("velocity", row(&map.velocity))?;
    rows.set_item("acceleration", row(&map.acceleration))?;
    rows.set_item("gap", row(&map.gap))?;
    rows.set_item("rate", row(&map.rate))?;
    rows.set_item("memory", row(&map.memory))?;
    dict.set_item("rows", rows)?;
    Ok(dict)
}

/// Name, level and capture of a law, and the relation `gap g + rate ġ + compliance P + offset = 0` of a closed point of unit area.
#[pyfunction]
pub(crate) fn law<'py>(py: Python<'py>, json: &str) -> PyResult<Bound<'py, PyDict>> {
    let law = read_law(json)?;
    let local = Local {
        area: 1.0,
        share: 1.0,
        ..Local::default()
    };
    let relation = law.get().relation(Status::Closed, &local);
    let dict = PyDict::new(py);
    dict.set_item("name", law.get().name())?;
    dict.set_item(
        "level",
        match law.get().level() {
            Level::Gap => "gap",
            Level::Rate => "rate",
            Level::GapAndRate => "gap and rate",
        },
    )?;
    dict.set_item("capture", law.get().capture())?;
    dict.set_item("gap", relation.gap)?;
    dict.set_item("rate", relation.rate)?;
    dict.set_item("compliance", relation.compliance)?;
    dict.set_item("offset", relation.offset)?;
    Ok(dict)
}
