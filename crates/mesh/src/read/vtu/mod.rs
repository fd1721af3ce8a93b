//! Unstructured grids of VTK (`.vtu`): points, cells and integer fields of cells, as text, in base64 or appended, plain or compressed by
//! zlib. One piece, little-endian.
//!
//! **Groups.** An integer field of cells whose values are 0 and 1 is the group of its name, of the cells with 1. Any other integer field gives a group
//! `name.value` for each value but 0. Where such a group has cells of several dimensions, that of the highest has the name, the
//! others end with their dimension (`name.2d`). Without any field the group `cells` has those of the highest dimension. Real fields
//! and fields of points are left out.
//!
//! **Nodes.** All are kept, in file order. The dimension is found as for [Gmsh's files](super::gmsh).
//!
//! Reference: VTK file formats, XML; The VTK User's Guide, cell types and their nodes.

mod array;
mod document;
mod stored;

use std::collections::BTreeMap;
use std::path::Path;

use carom_elements::Kind;

use super::flatten::flatten;
use super::groups::add;
use super::{Place, ReadError};
use crate::{Block, ElementId, Mesh};
pub use array::Numbers;
use array::numbers;
use document::{Array, Document, Fault, document};
pub use stored::{Stored, StoredArray, stored};

/// The group of all cells of a file without groups.
const CELLS: &str = "cells";

/// Reads the mesh in the content of a file; `path` is only for messages.
///
/// # Errors
/// The first thing that is malformed or of a sort that is not read, with the line of its element.
pub fn parse(path: &Path, content: &[u8]) -> Result<Mesh, ReadError> {
    read(content).map_err(|fault| error(path, fault))
}

fn error(path: &Path, (line, found, expected, unsupported): Fault) -> ReadError {
    let told = (found, expected.to_owned());
    ReadError::of_content(path, Place::Line(line), told, unsupported)
}

fn file(content: &[u8]) -> Result<File<'_>, Fault> {
    let mark = b"<AppendedData";
    let start = content.windows(mark.len()).position(|found| found == mark);
    let underscore = start.and_then(|start| {
        let after = content[start..].iter().position(|byte| *byte == b'_');
        after.map(|after| start + after)
    });
    let (text, appended) = match underscore {
        Some(place) => (&content[..place], &content[place + 1..]),
        None => (content, &[][..]),
    };
    let document = document(&String::from_utf8_lossy(text))?;
    Ok(File { document, appended })
}

fn read(content: &[u8]) -> Result<Mesh, Fault> {
    let file = file(content)?;
    let mut mesh = Mesh {
        dim: 3,
        nodes: file.nodes()?,
        blocks: Vec::new(),
        groups: BTreeMap::new(),
    };
    let ids = file.cells(&mut mesh)?;
    file.groups(&mut mesh, &ids)?;
    let blocks = mesh.blocks.iter();
    let least = blocks.map(|block| block.kind.table().dim).max();
    mesh.dim = flatten(&mut mesh.nodes, least.unwrap_or(1));
    Ok(mesh)
}

/// The document with its appended data.
struct File<'a> {
    document: Document,
    appended: &'a [u8],
}

impl File<'_> {
    fn array(&self, section: &str, name: Option<&str>) -> Result<&Array, Fault> {
        let mut own = self.document.arrays.iter();
        let found = own
            .find(|array| array.section == section && name.is_none_or(|name| array.name == name));
        found.ok_or_else(|| {
            let what = format!("{section} without {}", name.unwrap_or("an array"));
            (
                1,
                what,
                "arrays of points, connectivity, offsets and types",
                false,
            )
        })
    }

    fn nodes(&self) -> Result<Vec<[f64; 3]>, Fault> {
        let array = self.array("Points", None)?;
        let wrong = |found: String| {
            (
                array.line,
                found,
                "three finite coordinates for each point",
                false,
            )
        };
        let most = self.document.points.checked_mul(3);
        let values = numbers(&self.document.header, (array, most), self.appended);
        let values = values.map_err(wrong)?.reals();
        if array.components != 3 || values.len() != 3 * self.document.points {
            let found = format!(
                "{} numbers for {} points",
                values.len(),
                self.document.points
            );
            return Err(wrong(found));
        }
        if let Some(value) = values.iter().find(|value| !value.is_finite()) {
            return Err(wrong(value.to_string()));
        }
        let points = values.chunks_exact(3);
        Ok(points.map(|x| [x[0], x[1], x[2]]).collect())
    }

    fn integers(&self, name: &str, count: Option<usize>) -> Result<(usize, Vec<i64>), Fault> {
        let array = self.array("Cells", Some(name))?;
        let wrong = |found: String| {
            (
                array.line,
                found,
                "integers, one for each cell or node of a cell",
                false,
            )
        };
        // all cells have as many nodes as the kind with the most
        let nodes = Kind::ALL.iter().map(|kind| kind.table().nodes).max();
        let most = count.or(self.document.cells.checked_mul(nodes.unwrap_or(0)));
        let values = numbers(&self.document.header, (array, most), self.appended);
        let values = values.map_err(wrong)?;
        let found = format!("{} numbers", values.len());
        let values = values
            .integers()
            .filter(|v| count.is_none_or(|count| v.len() == count));
        Ok((array.line, values.ok_or_else(|| wrong(found))?))
    }

    /// Writes the blocks; the element of each cell.
    fn cells(&self, mesh: &mut Mesh) -> Result<Vec<ElementId>, Fault> {
        let count = Some(self.document.cells);
        let (line, connectivity) = self.integers("connectivity", None)?;
        let (_, ends) = self.integers("offsets", count)?;
        let (line_of_types, types) = self.integers("types", count)?;
        let (mut ids, mut begin) = (Vec::new(), 0);
        for (end, number) in ends.into_iter().zip(types) {
            let kind = of_vtk(number).ok_or_else(|| {
                let found = format!("cells of type {number}");
                (line_of_types, found, "linear and quadratic cells", true)
            })?;
            let table = kind.table();
            let wrong = |found| (line, found, "the nodes of each cell", false);
            let nodes = usize::try_from(end)
                .ok()
                .and_then(|end| connectivity.get(begin..end));
            let nodes = nodes.filter(|nodes| nodes.len() == table.nodes);
            let nodes =
                nodes.ok_or_else(|| wrong(format!("a {} from {begin} to {end}", table.name)))?;
            begin += nodes.len();
            if let Some(node) = nodes
                .iter()
                .find(|n| !(0..mesh.nodes.len() as i64).contains(n))
            {
                return Err(wrong(format!("node {node} of {}", mesh.nodes.len())));
            }
            let nodes = table.vtk_order.iter().map(|place| nodes[*place] as u32);
            let found = mesh.blocks.iter().position(|block| block.kind == kind);
            let block = found.unwrap_or(mesh.blocks.len());
            if found.is_none() {
                mesh.blocks.push(Block {
                    kind,
                    nodes: Vec::new(),
                });
            }
            let own = &mut mesh.blocks[block].nodes;
            ids.push(ElementId {
                block: block as u32,
                index: (own.len() / table.nodes) as u32,
            });
            own.extend(nodes);
        }
        Ok(ids)
    }

    fn groups(&self, mesh: &mut Mesh, ids: &[ElementId]) -> Result<(), Fault> {
        let arrays = self.document.arrays.iter();
        let of_cells = arrays.filter(|array| array.section == "CellData" && array.components == 1);
        for array in of_cells.filter(|array| array.number.contains("Int")) {
            let wrong = |found: String| (array.line, found, "an integer for each cell", false);
            let own = (array, Some(ids.len()));
            let values = numbers(&self.document.header, own, self.appended).map_err(wrong)?;
            let found = format!("{} numbers for {} cells", values.len(), ids.len());
            let values = values.integers().filter(|values| values.len() == ids.len());
            let values = values.ok_or_else(|| wrong(found))?;
            let mut members: BTreeMap<i64, Vec<ElementId>> = BTreeMap::new();
            for (value, id) in values.iter().zip(ids).filter(|(value, _)| **value != 0) {
                members.entry(*value).or_default().push(*id);
            }
            let is_one = members.keys().all(|value| *value == 1);
            for (value, elements) in members {
                let name = match is_one {
                    true => array.name.clone(),
                    false => format!("{}.{value}", array.name),
                };
                add(mesh, &name, elements);
            }
        }
        if mesh.groups.is_empty() {
            add(mesh, CELLS, ids.to_vec());
            mesh.groups.retain(|name, _| name == CELLS);
        }
        Ok(())
    }
}

fn of_vtk(number: i64) -> Option<Kind> {
    let mut kinds = Kind::ALL.iter();
    kinds
        .find(|kind| i64::from(kind.table().vtk) == number)
        .copied()
}
