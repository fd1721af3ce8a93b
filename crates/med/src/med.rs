//! Meshes of Salome and code_aster (`.med`): HDF5 files of MED 3 and 4. One mesh, unstructured, without steps in time.
//!
//! **Groups.** Each node and each cell has a family, and each family the names of its groups. A group of cells is the group of that name; where it
//! has cells of several dimensions, that of the highest has the name, the others end with their dimension (`name.2d`). A group of
//! nodes is one of points, with `.nodes` behind its name where a group of cells has the name. Without any group `cells` has the cells of
//! the highest dimension.
//!
//! **Nodes.** All are kept, in file order. The dimension is found as for [Gmsh's files](carom_mesh::read::gmsh).
//!
//! MED turns cells of three dimensions inside out, as seen by most others: its tetrahedron (0 1 2 3) has the node 3 on the other side.
//!
//! Source: MED, format of files (Salome); numbers of nodes compared with a writer of another program.

use std::collections::BTreeMap;
use std::path::Path;

use carom_elements::Kind;
use carom_mesh::read::flatten::flatten;
use carom_mesh::read::groups::add;
use carom_mesh::read::{Place, ReadError};
use carom_mesh::{Block, ElementId, Group, Mesh};
use hdf5_pure::{AttrValue, Dataset, File, Group as Folder};

/// The group of all cells of a file without groups.
const CELLS: &str = "cells";

/// Bytes of the name of a group.
const NAME: usize = 80;

/// Kinds of cells: name in the file, kind, and which node of the file is each node of a Gmsh file.
const KINDS: &[(&str, Kind, &[usize])] = &[
    ("PO1", Kind::Point1, &[0]),
    ("SE2", Kind::Bar2, &[0, 1]),
    ("SE3", Kind::Bar3, &[0, 1, 2]),
    ("TR3", Kind::Tri3, &[0, 1, 2]),
    ("TR6", Kind::Tri6, &[0, 1, 2, 3, 4, 5]),
    ("QU4", Kind::Quad4, &[0, 1, 2, 3]),
    ("QU8", Kind::Quad8, &[0, 1, 2, 3, 4, 5, 6, 7]),
    ("QU9", Kind::Quad9, &[0, 1, 2, 3, 4, 5, 6, 7, 8]),
    ("TE4", Kind::Tet4, &[0, 2, 1, 3]),
    ("T10", Kind::Tet10, &[0, 2, 1, 3, 6, 5, 4, 7, 8, 9]),
    ("PY5", Kind::Pyramid5, &[0, 3, 2, 1, 4]),
    ("PE6", Kind::Wedge6, &[0, 2, 1, 3, 5, 4]),
    (
        "P15",
        Kind::Wedge15,
        &[0, 2, 1, 3, 5, 4, 8, 6, 12, 7, 14, 13, 11, 9, 10],
    ),
    ("HE8", Kind::Hex8, &[0, 3, 2, 1, 4, 7, 6, 5]),
    ("H20", Kind::Hex20, HEXAHEDRON.split_at(20).0),
    ("H27", Kind::Hex27, &HEXAHEDRON),
];

/// Nodes of hexahedra.
const HEXAHEDRON: [usize; 27] = [
    0, 3, 2, 1, 4, 7, 6, 5, 11, 8, 16, 10, 19, 9, 18, 17, 15, 12, 14, 13, 20, 24, 21, 23, 22, 25,
    26,
];

/// What is wrong, where, what was expected, and whether it is sound but not read.
type Fault = (&'static str, String, &'static str, bool);

/// Reads the mesh in the content of a file; `path` is only for messages.
///
/// # Errors
/// The first thing that is malformed or of a sort that is not read, with the object of the file that it is in.
pub fn parse(path: &Path, content: Vec<u8>) -> Result<Mesh, ReadError> {
    read(content).map_err(|(object, found, expected, unsupported)| {
        let told = (found, expected.to_owned());
        ReadError::of_content(path, Place::Object(object), told, unsupported)
    })
}

/// A fault of the file as HDF5.
fn broken(object: &'static str) -> impl Fn(hdf5_pure::Error) -> Fault {
    move |error| (object, error.to_string(), "a sound HDF5 file", false)
}

fn read(content: Vec<u8>) -> Result<Mesh, Fault> {
    let file = File::from_bytes(content).map_err(broken("the file"))?;
    let meshes = file.group("ENS_MAA").map_err(broken("ENS_MAA"))?;
    let (name, of_mesh) = only(&meshes, "ENS_MAA", "a file of one mesh")?;
    let (_, step) = only(&of_mesh, "ENS_MAA/mesh", "a mesh of one step")?;
    let nodes = step.group("NOE").map_err(broken("NOE"))?;
    let x = coordinates(&nodes)?;
    let mut mesh = Mesh {
        dim: 3,
        nodes: x,
        blocks: Vec::new(),
        groups: BTreeMap::new(),
    };
    let mut members: BTreeMap<i64, Vec<ElementId>> = BTreeMap::new();
    let cells = step.group("MAI").map_err(broken("MAI"))?;
    for kind in cells.groups().map_err(broken("MAI"))? {
        let of_kind = cells.group(&kind).map_err(broken("MAI"))?;
        add_cells(&mut mesh, &kind, &of_kind, &mut members)?;
    }
    let families = families(&file, &name)?;
    let mut groups: BTreeMap<&str, Vec<ElementId>> = BTreeMap::new();
    for (family, elements) in &members {
        for group in families.get(family).into_iter().flatten() {
            groups.entry(group).or_default().extend(elements);
        }
    }
    for (name, elements) in groups {
        add(&mut mesh, name, elements);
    }
    add_nodes(&mut mesh, &nodes, &families)?;
    if mesh.groups.is_empty() {
        let all: Vec<ElementId> = members.into_values().flatten().collect();
        add(&mut mesh, CELLS, all);
        mesh.groups.retain(|name, _| name == CELLS);
    }
    let blocks = mesh.blocks.iter();
    let least = blocks.map(|block| block.kind.table().dim).max();
    mesh.dim = flatten(&mut mesh.nodes, least.unwrap_or(1));
    Ok(mesh)
}

/// The one group in another.
fn only(
    parent: &Folder,
    object: &'static str,
    what: &'static str,
) -> Result<(String, Folder), Fault> {
    let names = parent.groups().map_err(broken(object))?;
    match &names[..] {
        [name] => {
            let group = parent.group(name).map_err(broken(object))?;
            Ok((name.clone(), group))
        }
        _ => Err((object, format!("{} groups", names.len()), what, true)),
    }
}

/// Numbers of a data set, of which the file says no more than `most`.
fn checked(data: &Dataset, object: &'static str) -> Result<u64, Fault> {
    let shape = data.shape().map_err(broken(object))?;
    let count = shape.iter().try_fold(1_u64, |all, n| all.checked_mul(*n));
    let wrong = || {
        (
            object,
            format!("an array of {shape:?}"),
            "fewer numbers than the file has bytes",
            false,
        )
    };
    count.filter(|count| *count <= MOST).ok_or_else(wrong)
}

/// Most numbers of an array.
const MOST: u64 = 1 << 31;

fn integers(parent: &Folder, name: &str, object: &'static str) -> Result<Option<Vec<i64>>, Fault> {
    let there = parent.datasets().map_err(broken(object))?;
    if !there.iter().any(|found| found == name) {
        return Ok(None);
    }
    let data = parent.dataset(name).map_err(broken(object))?;
    checked(&data, object)?;
    data.read_i64().map(Some).map_err(broken(object))
}

/// Coordinates, component after component in the file.
fn coordinates(nodes: &Folder) -> Result<Vec<[f64; 3]>, Fault> {
    let object = "NOE/COO";
    let data = nodes.dataset("COO").map_err(broken(object))?;
    checked(&data, object)?;
    let attributes = data.attrs().map_err(broken(object))?;
    let wrong = |found: String| (object, found, "finite coordinates of each node", false);
    let count = attributes.get("NBR").and_then(whole);
    let count = count.and_then(|count| usize::try_from(count).ok());
    let count = count.filter(|count| *count > 0);
    let count = count.ok_or_else(|| wrong("no number of nodes (NBR)".to_owned()))?;
    let values = data.read_f64().map_err(broken(object))?;
    let dim = values.len() / count;
    if dim * count != values.len() || !(1..=3).contains(&dim) {
        return Err(wrong(format!("{} numbers for {count} nodes", values.len())));
    }
    if let Some(value) = values.iter().find(|value| !value.is_finite()) {
        return Err(wrong(value.to_string()));
    }
    let place = |node: usize| {
        let mut x = [0.0; 3];
        (0..dim).for_each(|i| x[i] = values[i * count + node]);
        x
    };
    Ok((0..count).map(place).collect())
}

fn whole(value: &AttrValue) -> Option<i64> {
    match value {
        AttrValue::I32(value) => Some(i64::from(*value)),
        AttrValue::I64(value) => Some(*value),
        AttrValue::I64Array(values) => values.first().copied(),
        AttrValue::I32Array(values) => values.first().map(|value| i64::from(*value)),
        _ => None,
    }
}

/// Adds the cells of a kind, and each to those of its family.
fn add_cells(
    mesh: &mut Mesh,
    name: &str,
    folder: &Folder,
    members: &mut BTreeMap<i64, Vec<ElementId>>,
) -> Result<(), Fault> {
    let object = "MAI";
    let known = KINDS.iter().find(|(known, ..)| *known == name);
    let Some((_, kind, order)) = known else {
        let found = format!("cells of kind {name}");
        return Err((
            object,
            found,
            "linear and quadratic cells, pyramids linear",
            true,
        ));
    };
    let wrong = |found: String| (object, found, "the nodes of each cell, from 1", false);
    let nodes = integers(folder, "NOD", object)?;
    let nodes = nodes.ok_or_else(|| wrong(format!("{name} without NOD")))?;
    let count = nodes.len() / order.len();
    if count * order.len() != nodes.len() {
        return Err(wrong(format!("{} nodes of {name}", nodes.len())));
    }
    let most = mesh.nodes.len() as i64;
    if let Some(node) = nodes.iter().find(|node| !(1..=most).contains(*node)) {
        return Err(wrong(format!("node {node} of {most}")));
    }
    let block = mesh.blocks.len() as u32;
    // component after component, as coordinates
    let places: Vec<usize> = kind
        .table()
        .gmsh_order
        .iter()
        .map(|&place| order[place])
        .collect();
    let of_cell = |cell: usize| places.iter().map(move |place| (place, cell));
    let all = (0..count).flat_map(of_cell);
    let all = all.map(|(place, cell)| (nodes[place * count + cell] - 1) as u32);
    mesh.blocks.push(Block {
        kind: *kind,
        nodes: all.collect(),
    });
    let families = integers(folder, "FAM", object)?.unwrap_or_else(|| vec![0; count]);
    if families.len() != count {
        return Err(wrong(format!(
            "{} families of {count} {name}",
            families.len()
        )));
    }
    for (index, family) in families.into_iter().enumerate() {
        let index = index as u32;
        members
            .entry(family)
            .or_default()
            .push(ElementId { block, index });
    }
    Ok(())
}

/// Names of the groups of each family.
fn families(file: &File, mesh: &str) -> Result<BTreeMap<i64, Vec<String>>, Fault> {
    let object = "FAS";
    let mut families = BTreeMap::new();
    let root = file.root();
    if !root
        .groups()
        .map_err(broken(object))?
        .iter()
        .any(|name| name == object)
    {
        return Ok(families);
    }
    let all = root.group(object).map_err(broken(object))?;
    if !all
        .groups()
        .map_err(broken(object))?
        .iter()
        .any(|name| name == mesh)
    {
        return Ok(families);
    }
    let of_mesh = all.group(mesh).map_err(broken(object))?;
    for sort in of_mesh.groups().map_err(broken(object))? {
        let sort = of_mesh.group(&sort).map_err(broken(object))?;
        for (_, family) in sort.iter_groups().map_err(broken(object))? {
            let attributes = family.attrs().map_err(broken(object))?;
            let Some(number) = attributes.get("NUM").and_then(whole) else {
                continue;
            };
            let has = family.groups().map_err(broken(object))?;
            let names = match has.iter().any(|name| name == "GRO") {
                true => names(&family.group("GRO").map_err(broken(object))?)?,
                false => Vec::new(),
            };
            families.insert(number, names);
        }
    }
    Ok(families)
}

/// The names of groups, each of 80 bytes with zeros or blanks at its end.
fn names(folder: &Folder) -> Result<Vec<String>, Fault> {
    let object = "FAS/GRO";
    let data = folder.dataset("NOM").map_err(broken(object))?;
    checked(&data, object)?;
    let bytes = data.read_raw().map_err(broken(object))?;
    let name = |bytes: &[u8]| {
        let end = bytes.iter().position(|byte| *byte == 0);
        let name = String::from_utf8_lossy(&bytes[..end.unwrap_or(bytes.len())]);
        name.trim().to_owned()
    };
    let names = bytes.chunks(NAME).map(name);
    Ok(names.filter(|name| !name.is_empty()).collect())
}

/// Adds the groups of nodes as points.
fn add_nodes(
    mesh: &mut Mesh,
    nodes: &Folder,
    families: &BTreeMap<i64, Vec<String>>,
) -> Result<(), Fault> {
    let object = "NOE/FAM";
    let Some(of_nodes) = integers(nodes, "FAM", object)? else {
        return Ok(());
    };
    if of_nodes.len() != mesh.nodes.len() {
        let found = format!("{} families of {} nodes", of_nodes.len(), mesh.nodes.len());
        return Err((object, found, "the family of each node", false));
    }
    let mut groups: BTreeMap<&str, Vec<u32>> = BTreeMap::new();
    for (node, family) in (0..).zip(of_nodes) {
        for name in families.get(&family).into_iter().flatten() {
            groups.entry(name).or_default().push(node);
        }
    }
    for (name, nodes) in groups {
        let block = mesh.blocks.len() as u32;
        let points = (0..nodes.len() as u32).map(|index| ElementId { block, index });
        let group = Group::new(0, points.collect());
        mesh.blocks.push(Block {
            kind: Kind::Point1,
            nodes,
        });
        let name = match mesh.groups.contains_key(name) {
            true => format!("{name}.nodes"),
            false => name.to_owned(),
        };
        mesh.groups.insert(name, group);
    }
    Ok(())
}
