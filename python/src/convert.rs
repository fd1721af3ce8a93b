//! Tables of TOML as Python dicts, and back.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyMapping, PyString};
use toml::{Table, Value};

/// The tables of a text in TOML.
#[pyfunction]
pub(crate) fn read_toml<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    let table: Table = text
        .parse()
        .map_err(|error: toml::de::Error| PyValueError::new_err(error.to_string()))?;
    to_python(py, &Value::Table(table))
}

/// A dict as a text in TOML.
#[pyfunction]
pub(crate) fn write_toml(tables: &Bound<'_, PyAny>) -> PyResult<String> {
    let value = from_python(tables, "")?;
    toml::to_string(&value).map_err(|error| PyValueError::new_err(error.to_string()))
}

fn to_python<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::String(text) => PyString::new(py, text).into_any(),
        Value::Integer(number) => number.into_pyobject(py)?.into_any(),
        Value::Float(number) => number.into_pyobject(py)?.into_any(),
        Value::Boolean(value) => value.into_pyobject(py)?.to_owned().into_any(),
        Value::Datetime(date) => PyString::new(py, &date.to_string()).into_any(),
        Value::Array(values) => {
            let list = PyList::empty(py);
            for value in values {
                list.append(to_python(py, value)?)?;
            }
            list.into_any()
        }
        Value::Table(table) => {
            let dict = PyDict::new(py);
            for (key, value) in table {
                dict.set_item(key, to_python(py, value)?)?;
            }
            dict.into_any()
        }
    })
}

/// A value; `path`: of its key, for messages. Numbers and arrays of NumPy are numbers and lists, paths are texts; what is `None` is left out.
fn from_python(value: &Bound<'_, PyAny>, path: &str) -> PyResult<Value> {
    if let Ok(truth) = value.extract::<bool>() {
        return Ok(Value::Boolean(truth));
    }
    if let Ok(text) = value.extract::<String>() {
        return Ok(Value::String(text));
    }
    if value.hasattr("tolist")? {
        return from_python_plain(&value.call_method0("tolist")?, path);
    }
    from_python_plain(value, path)
}

fn from_python_plain(value: &Bound<'_, PyAny>, path: &str) -> PyResult<Value> {
    if value.hasattr("__index__")? {
        return Ok(Value::Integer(value.extract()?));
    }
    if let Ok(number) = value.extract::<f64>() {
        return Ok(Value::Float(number));
    }
    if let Ok(mapping) = value.cast::<PyMapping>() {
        let mut table = Table::new();
        for entry in mapping.items()?.iter() {
            let (key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = entry.extract()?;
            let key: String = key.extract().map_err(|_| {
                PyTypeError::new_err(format!("{path}: a key that is no text: {key}"))
            })?;
            if !value.is_none() {
                let inner = match path.is_empty() {
                    true => key.clone(),
                    false => format!("{path}.{key}"),
                };
                let value = from_python(&value, &inner)?;
                table.insert(key, value);
            }
        }
        return Ok(Value::Table(table));
    }
    if value.hasattr("__fspath__")? {
        return Ok(Value::String(value.call_method0("__fspath__")?.extract()?));
    }
    // schemes and laws as objects
    if let Ok(table) = value.getattr("table") {
        return from_python(&table, path);
    }
    if let Ok(items) = value.try_iter() {
        let items = items.enumerate();
        let items = items.map(|(k, item)| from_python(&item?, &format!("{path}[{k}]")));
        return Ok(Value::Array(items.collect::<PyResult<_>>()?));
    }
    let kind = value.get_type().name()?;
    Err(PyTypeError::new_err(format!(
        "{path}: a value of the type {kind}, which a case cannot hold; accepted: texts, numbers, booleans, lists, dicts"
    )))
}
