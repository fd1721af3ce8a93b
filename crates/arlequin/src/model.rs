//! The cells of one model, with point location.

use carom_elements::MAX_FACE_NODES;
use carom_mesh::{Bounds, BoxTree, ElementId, Mesh};

use crate::cell::Cell;
use crate::error::{Error, Model};

/// The cells of one model in the order given, and a tree over them.
#[derive(Clone, Debug)]
pub(crate) struct Cells<'a> {
    pub mesh: &'a Mesh,
    pub ids: Vec<ElementId>,
    /// Length, area or volume of each cell.
    pub measures: Vec<f64>,
    bounds: Vec<Bounds>,
    tree: BoxTree,
}

impl<'a> Cells<'a> {
    /// Errors: no cells, a cell of another dimension than the space, a defective cell.
    pub fn new(mesh: &'a Mesh, model: Model, ids: &[ElementId]) -> Result<Cells<'a>, Error> {
        if ids.is_empty() {
            return Err(Error::NoCells { model });
        }
        for &cell in ids {
            let found = mesh.kind(cell).table().dim;
            if found != mesh.dim {
                return Err(Error::Dimension {
                    model,
                    cell,
                    found,
                    expected: mesh.dim,
                });
            }
        }
        if let Some(&defect) = mesh.check(ids).first() {
            return Err(Error::Defect(defect));
        }
        let cells = ids.iter().map(|&id| Cell::new(mesh, id));
        let (bounds, measures): (Vec<_>, Vec<_>) = cells
            .map(|cell| (cell.bounds().widened(1e-9 * cell.size), cell.measure()))
            .unzip();
        Ok(Cells {
            mesh,
            ids: ids.to_vec(),
            measures,
            tree: BoxTree::new(&bounds),
            bounds,
        })
    }

    pub fn len(&self) -> usize {
        self.ids.len()
    }

    pub fn cell(&self, i: usize) -> Cell {
        Cell::new(self.mesh, self.ids[i])
    }

    pub fn nodes(&self, i: usize) -> &'a [u32] {
        self.mesh.element_nodes(self.ids[i])
    }

    /// Cells whose box touches that of a cell of another model, ascending.
    pub fn near(&self, other: &Cells, i: usize, found: &mut Vec<u32>) {
        self.tree.overlapping(&other.bounds[i], found);
    }

    /// The first cell that contains a position.
    pub fn locate(&self, x: &[f64; 3], scratch: &mut Vec<u32>) -> Option<usize> {
        self.tree.near(x, 0.0, scratch);
        let mut cells = scratch.iter().map(|&i| i as usize);
        cells.find(|&i| self.cell(i).contains(x))
    }

    /// Faces that only one cell has: cell, and face in the order of its kind.
    pub fn outside_faces(&self) -> Vec<(usize, usize)> {
        let mut faces = Vec::new();
        for i in 0..self.len() {
            let (nodes, table) = (self.nodes(i), self.mesh.kind(self.ids[i]).table());
            for (f, face) in table.faces.iter().enumerate() {
                let mut key = [u32::MAX; MAX_FACE_NODES];
                for (k, &a) in key.iter_mut().zip(face.nodes) {
                    *k = nodes[a];
                }
                key.sort_unstable();
                faces.push((key, i, f));
            }
        }
        faces.sort_unstable();
        let alone = |k: usize| {
            let differs = |j: usize| faces.get(j).is_none_or(|other| other.0 != faces[k].0);
            differs(k + 1) && (k == 0 || differs(k - 1))
        };
        let alone = (0..faces.len()).filter(|&k| alone(k));
        alone.map(|k| (faces[k].1, faces[k].2)).collect()
    }
}
