//! A shell and a solid that overlap, as they are given, and the shell as a volume.

use std::collections::{BTreeMap, BTreeSet};

use carom_elements::Kind;
use carom_mesh::{ElementId, Mesh};

use crate::cell::Cell;
use crate::error::{Error, Model};
use crate::overlap::Region;

/// Cosine of the angle of two directors of elements at a node from which on they are the same.
const SAME: f64 = 1.0 - 1e-6;

/// An element of a shell.
#[derive(Clone, Debug)]
pub struct ShellCell {
    /// The cell, of three or four nodes.
    pub cell: ElementId,
    /// Places of the middle surface at its nodes, m.
    pub x: Vec<[f64; 3]>,
    /// Unit directors there.
    pub directors: Vec<[f64; 3]>,
    /// Thickness, m.
    pub thickness: f64,
    /// From the nodes to the middle surface along the directors, m.
    pub offset: f64,
}

/// A shell and a solid of one material, with no node in common.
#[derive(Clone, Copy)]
pub struct ShellModels<'a> {
    /// The mesh of both, of space.
    pub mesh: &'a Mesh,
    /// Cells of the solid, of any kind.
    pub solid: &'a [ElementId],
    /// Elements of the shell.
    pub shell: &'a [ShellCell],
    /// Which of the two models the shell is.
    pub shell_is: Model,
}

impl ShellModels<'_> {
    /// Which of the two models the solid is.
    pub(super) fn solid_is(&self) -> Model {
        match self.shell_is {
            Model::Inner => Model::Outer,
            Model::Outer => Model::Inner,
        }
    }

    /// Refuses models without cells, and nodes of both.
    pub(super) fn check(&self) -> Result<(), Error> {
        if self.shell.is_empty() {
            return Err(Error::NoCells {
                model: self.shell_is,
            });
        }
        if self.solid.is_empty() {
            return Err(Error::NoCells {
                model: self.solid_is(),
            });
        }
        let mut used = vec![false; self.mesh.nodes.len()];
        for &cell in self.solid {
            let nodes = self.mesh.element_nodes(cell);
            nodes.iter().for_each(|&node| used[node as usize] = true);
        }
        let mut nodes = self.shell.iter().flat_map(|own| self.nodes(own));
        match nodes.find(|&&node| used[node as usize]) {
            Some(&node) => Err(Error::SharedNode { node }),
            None => Ok(()),
        }
    }

    /// Nodes of an element of the shell.
    pub(super) fn nodes(&self, shell: &ShellCell) -> &[u32] {
        self.mesh.element_nodes(shell.cell)
    }

    /// Refuses elements of the shell that meet at an angle.
    pub(super) fn refuse_folds(&self, elements: &[usize]) -> Result<(), Error> {
        let mut at_node: Vec<Option<(usize, [f64; 3])>> = vec![None; self.mesh.nodes.len()];
        for &element in elements {
            let shell = &self.shell[element];
            for (&node, d) in self.nodes(shell).iter().zip(&shell.directors) {
                let (other, before) = *at_node[node as usize].get_or_insert((element, *d));
                if crate::polytope::dot(&before, d) < SAME {
                    let cells = [other, element].map(|e| self.shell[e].cell).to_vec();
                    return Err(Error::Fold { cells });
                }
            }
        }
        Ok(())
    }
}

/// The mesh with the elements of the shell extruded through their thickness.
pub(super) struct Prisms {
    pub mesh: Mesh,
    /// One for each element of the shell.
    pub cells: Vec<ElementId>,
    elements: BTreeMap<ElementId, usize>,
}

impl Prisms {
    /// Errors: an element that folds over in its thickness.
    pub fn new(models: &ShellModels) -> Result<Prisms, Error> {
        let mut mesh = models.mesh.clone();
        let mut cells = Vec::with_capacity(models.shell.len());
        for shell in models.shell {
            let count = shell.x.len();
            let mut nodes = Vec::with_capacity(2 * count);
            for side in [-0.5, 0.5] {
                for (x, d) in shell.x.iter().zip(&shell.directors) {
                    nodes.push(mesh.nodes.len() as u32);
                    let place = [0, 1, 2].map(|i| x[i] + side * shell.thickness * d[i]);
                    mesh.nodes.push(place);
                }
            }
            let kind = if count == 3 { Kind::Wedge6 } else { Kind::Hex8 };
            let prism = mesh.push(kind, &nodes);
            if !mesh.check(&[prism]).is_empty() {
                return Err(Error::FoldsOver { cell: shell.cell });
            }
            cells.push(prism);
        }
        let elements = cells.iter().enumerate().map(|(element, &id)| (id, element));
        Ok(Prisms {
            elements: elements.collect(),
            mesh,
            cells,
        })
    }

    /// The extruded element.
    pub fn cell(&self, element: usize) -> Cell {
        Cell::new(&self.mesh, self.cells[element])
    }

    /// The element of the shell behind a cell of this mesh, if it is one.
    pub fn element(&self, cell: ElementId) -> Option<usize> {
        self.elements.get(&cell).copied()
    }

    /// A region with the extruded elements in place of those of the shell, its cells sorted.
    pub fn region(&self, models: &ShellModels, region: &Region) -> Region {
        let Region::Cells(cells) = region else {
            return region.clone();
        };
        let asked: BTreeSet<ElementId> = cells.iter().copied().collect();
        let shell = models.shell.iter().zip(&self.cells);
        let prisms = shell.filter(|(shell, _)| asked.contains(&shell.cell));
        let solid = models.solid.iter().filter(|cell| asked.contains(cell));
        let mut cells: Vec<ElementId> = prisms.map(|(_, &prism)| prism).collect();
        cells.extend(solid);
        cells.sort_unstable();
        Region::Cells(cells)
    }
}
