//! The cells that a problem is about, as a file to look at.

use std::path::{Path, PathBuf};

use carom_elements::Kind;
use carom_mesh::{ElementId, Mesh};
use carom_output::Error;
use carom_output::vtu::{self, Cells, Grid};

/// Cells that a problem is about.
#[derive(Clone, Debug, PartialEq)]
pub struct Offenders {
    /// Name of their file, without its ending.
    pub name: String,
    /// Coordinates of their nodes, m.
    points: Vec<[f64; 3]>,
    /// Node numbers by kind.
    cells: Vec<(Kind, Vec<u32>)>,
}

impl Offenders {
    /// These cells of a mesh.
    pub(crate) fn new(name: String, mesh: &Mesh, cells: &[ElementId]) -> Offenders {
        let nodes = cells.iter().flat_map(|&cell| mesh.element_nodes(cell));
        let mut used: Vec<u32> = nodes.copied().collect();
        used.sort_unstable();
        used.dedup();
        let mut by_kind: Vec<(Kind, Vec<u32>)> = Vec::new();
        for &cell in cells {
            let kind = mesh.kind(cell);
            let nodes = mesh.element_nodes(cell).iter();
            let nodes = nodes.map(|node| used.partition_point(|other| other < node) as u32);
            match by_kind.iter_mut().find(|(other, _)| *other == kind) {
                Some((_, all)) => all.extend(nodes),
                None => by_kind.push((kind, nodes.collect())),
            }
        }
        Offenders {
            name,
            points: used.iter().map(|&node| mesh.nodes[node as usize]).collect(),
            cells: by_kind,
        }
    }

    /// The folder for the cells of a case's problems: its name with the ending `.check`, beside it.
    pub fn folder(case: &Path) -> PathBuf {
        case.with_extension("check")
    }

    /// Path of the file in that folder.
    pub fn path(&self, case: &Path) -> PathBuf {
        Offenders::folder(case).join(format!("{}.vtu", self.name))
    }

    /// Writes the cells to [`Offenders::path`].
    ///
    /// # Errors
    /// The system refuses.
    pub fn write(&self, case: &Path) -> Result<(), Error> {
        let folder = Offenders::folder(case);
        std::fs::create_dir_all(&folder).map_err(|source| Error::File {
            action: "create",
            path: folder.clone(),
            source,
        })?;
        let cells: Vec<Cells> = self
            .cells
            .iter()
            .map(|(kind, nodes)| Cells { kind: *kind, nodes })
            .collect();
        let grid = Grid {
            time: 0.0,
            points: &self.points,
            cells: &cells,
            point_fields: &[],
            cell_fields: &[],
        };
        vtu::write(&self.path(case), &grid)
    }
}
