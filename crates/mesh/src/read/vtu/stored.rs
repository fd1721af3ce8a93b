//! All that a file has, fields included, as it stands there.

use std::path::Path;

use super::array::{Numbers, numbers};
use super::document::Fault;
use super::{File, error, file};
use crate::read::ReadError;

/// A grid with its fields, as it stands in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Stored {
    /// Coordinates, m.
    pub points: Vec<[f64; 3]>,
    /// Nodes of all cells, in the order of VTK.
    pub connectivity: Vec<i64>,
    /// Where the nodes of each cell end.
    pub ends: Vec<i64>,
    /// VTK's number of the kind of each cell.
    pub types: Vec<i64>,
    /// The fields.
    pub arrays: Vec<StoredArray>,
}

/// A field as it stands in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredArray {
    /// Whether it has a value for each point, or one for each cell.
    pub of_points: bool,
    /// Its name.
    pub name: String,
    /// Numbers of a value.
    pub components: usize,
    /// All numbers, value after value.
    pub values: Numbers,
}

/// Reads a file with its fields; `path` is only for messages.
///
/// # Errors
/// As [`parse`](super::parse).
pub fn stored(path: &Path, content: &[u8]) -> Result<Stored, ReadError> {
    let read = || {
        let file = file(content)?;
        let cells = Some(file.document.cells);
        Ok(Stored {
            points: file.nodes()?,
            connectivity: file.integers("connectivity", None)?.1,
            ends: file.integers("offsets", cells)?.1,
            types: file.integers("types", cells)?.1,
            arrays: file.fields()?,
        })
    };
    read().map_err(|fault| error(path, fault))
}

impl File<'_> {
    fn fields(&self) -> Result<Vec<StoredArray>, Fault> {
        let mut fields = Vec::new();
        for array in &self.document.arrays {
            let (of_points, count) = match array.section.as_str() {
                "PointData" => (true, self.document.points),
                "CellData" => (false, self.document.cells),
                _ => continue,
            };
            let wrong =
                |found: String| (array.line, found, "a value for each point or cell", false);
            let expected = count.checked_mul(array.components);
            let own = (array, expected);
            let values = numbers(&self.document.header, own, self.appended).map_err(wrong)?;
            if Some(values.len()) != expected {
                return Err(wrong(format!("{} numbers", values.len())));
            }
            fields.push(StoredArray {
                of_points,
                name: array.name.clone(),
                components: array.components,
                values,
            });
        }
        Ok(fields)
    }
}
