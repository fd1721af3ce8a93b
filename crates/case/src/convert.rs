//! A mesh from one format to another.

use std::path::{Path, PathBuf};

use carom_med::read;
use carom_mesh::read::ReadError;
use carom_mesh::{ElementId, Mesh};
use carom_output::vtu::{self, Cells, Field, Grid, Values};
use thiserror::Error as ThisError;

/// Endings of the files that are written.
const WRITTEN: &str = "vtu";

/// Why a mesh was not converted.
#[derive(Debug, ThisError)]
pub enum NotConverted {
    /// It cannot be read.
    #[error(transparent)]
    Unread(#[from] ReadError),
    /// No writer has the ending.
    #[error("{}: found the extension \"{found}\", expected: {WRITTEN}", path.display())]
    Ending {
        /// The file to write.
        path: PathBuf,
        /// Its extension.
        found: String,
    },
    /// It cannot be written.
    #[error(transparent)]
    Unwritten(#[from] carom_output::Error),
}

/// Writes the mesh in a file to another one, in the unit of its coordinates: to `.vtu` with an integer field for each group, 1 in its elements
/// and 0 elsewhere. Returns the numbers of nodes, elements and groups.
///
/// # Errors
/// The mesh cannot be read; the ending is not written; the file cannot be written.
pub fn convert(from: &Path, to: &Path) -> Result<[usize; 3], NotConverted> {
    let ending = to.extension().unwrap_or_default().to_string_lossy();
    if ending.to_lowercase() != WRITTEN {
        return Err(NotConverted::Ending {
            path: to.to_owned(),
            found: ending.into_owned(),
        });
    }
    let mesh = read(from)?;
    let cells: Vec<Cells> = mesh
        .blocks
        .iter()
        .map(|block| Cells {
            kind: block.kind,
            nodes: &block.nodes,
        })
        .collect();
    let members: Vec<Vec<i32>> = mesh
        .groups
        .values()
        .map(|group| membership(&mesh, &group.elements))
        .collect();
    let fields = mesh.groups.keys().zip(&members);
    let fields: Vec<Field> = fields
        .map(|(name, values)| Field {
            name,
            values: Values::Integer(values),
        })
        .collect();
    let grid = Grid {
        time: 0.0,
        points: &mesh.nodes,
        cells: &cells,
        point_fields: &[],
        cell_fields: &fields,
    };
    vtu::write(to, &grid)?;
    let elements = members
        .first()
        .map_or_else(|| membership(&mesh, &[]).len(), Vec::len);
    Ok([mesh.nodes.len(), elements, mesh.groups.len()])
}

/// 1 for each element of the mesh that is one of these, 0 for the others.
fn membership(mesh: &Mesh, elements: &[ElementId]) -> Vec<i32> {
    let counts = mesh.blocks.iter();
    let counts = counts.map(|block| block.nodes.len() / block.kind.table().nodes);
    let mut values: Vec<Vec<i32>> = counts.map(|count| vec![0; count]).collect();
    for element in elements {
        values[element.block as usize][element.index as usize] = 1;
    }
    values.concat()
}
