//! Columns of text files in SI units.

use std::path::Path;

use carom_mesh::read::file;
use carom_quantities::units::{Dimension, parse_quantity};
use carom_signals::{Error, Table};

use super::problems::Problems;
use crate::error::Problem;

/// Most bytes of a file, 256 MiB.
const LARGEST: u64 = 256 << 20;

/// A column of a text file, and the keys of the case file that say so.
pub(super) struct FileColumn<'a> {
    /// Key of its name.
    pub(super) key: &'a str,
    /// Its name.
    pub(super) name: &'a str,
    /// Key of its unit.
    pub(super) unit_key: &'a str,
    /// Unit that the case file gives.
    pub(super) unit: Option<&'a String>,
    /// What it has.
    pub(super) dimension: &'a str,
}

/// Columns of a file in SI units, and the lines of their rows.
pub(super) fn file_columns<const N: usize>(
    folder: &Path,
    path: &str,
    file: &str,
    keys: [FileColumn; N],
    problems: &mut Problems,
) -> Option<(Vec<[f64; N]>, Vec<usize>)> {
    let bytes = file::regular(&folder.join(file), LARGEST);
    let text = bytes.map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    let table = text
        .map_err(|error| error.to_string())
        .and_then(|text| Table::parse(&text).map_err(|error| error.to_string()));
    let table = match table {
        Ok(table) => table,
        Err(error) => {
            let message = format!("{file}: {error}");
            return problems.refuse(Problem::new(format!("{path}.file"), message));
        }
    };
    let found = keys.map(|column| file_column(path, (file, &table), &column, problems));
    let mut columns = Vec::with_capacity(N);
    let mut lines = Vec::new();
    for column in found {
        let (values, of_values) = column?;
        columns.push(values);
        lines = of_values;
    }
    let row = |k: usize| std::array::from_fn(|column| columns[column][k]);
    Some(((0..lines.len()).map(row).collect(), lines))
}

/// The values of a column in SI units, and their lines.
fn file_column(
    path: &str,
    (file, table): (&str, &Table),
    wanted: &FileColumn,
    problems: &mut Problems,
) -> Option<(Vec<f64>, Vec<usize>)> {
    let FileColumn {
        key,
        name,
        unit_key,
        unit,
        dimension,
    } = wanted;
    let column = match table.column(name) {
        Ok(column) => column,
        Err(Error::NoColumn { name, columns }) => {
            let message = format!("{file} has no column of this name");
            let problem = Problem::new(format!("{path}.{key}"), message);
            let columns = columns.iter().map(String::as_str);
            return problems.refuse(problem.unknown(&name, columns));
        }
        Err(error) => {
            let message = format!("{file}: {error}");
            return problems.refuse(Problem::new(format!("{path}.{key}"), message));
        }
    };
    let unit_path = format!("{path}.{unit_key}");
    let written = match (&column.unit, unit) {
        (Some(of_file), Some(unit)) if of_file != *unit => {
            let message = format!("column `{name}` has the unit [{of_file}] already");
            let problem = Problem::new(unit_path, message).found(*unit);
            return problems.refuse(problem);
        }
        (Some(of_file), _) => Some((of_file, format!("{path}.{key}"))),
        (None, unit) => unit.map(|unit| (unit, unit_path)),
    };
    let factor = match written {
        None => 1.0,
        Some((unit, path)) => factor_of(&path, unit, dimension, problems)?,
    };
    let values = column.values.iter().map(|value| factor * value).collect();
    Some((values, column.lines))
}

/// The SI value of one of a unit.
fn factor_of(path: &str, unit: &str, dimension: &str, problems: &mut Problems) -> Option<f64> {
    let wanted = Dimension::named(dimension)?;
    match parse_quantity(&format!("1 {unit}"), wanted) {
        Ok(factor) => Some(factor),
        Err(error) => {
            let mut problem = Problem::new(path, error.to_string()).found(unit);
            problem.nearest = error.meant();
            problems.refuse(
                problem.accepted([format!("a unit of {dimension}, such as {}", wanted.unit())]),
            )
        }
    }
}
