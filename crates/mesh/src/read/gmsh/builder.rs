//! The mesh as it grows while a file is read: node tags, elements by kind, members of physical groups.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use carom_elements::{Kind, MAX_NODES};

use super::cursor::Fault;
use crate::read::flatten::flatten;
use crate::{Block, ElementId, Group, Mesh};

/// A physical group: its dimension and its tag.
type Physical = (usize, u64);

/// What has been read so far.
#[derive(Default)]
pub(super) struct Builder {
    nodes: Vec<[f64; 3]>,
    /// Sorted by tag once [`Builder::sort_nodes`] ran.
    tags: Vec<NodeTag>,
    /// Nodes of the elements of each kind.
    cells: BTreeMap<Kind, Vec<u32>>,
    members: BTreeMap<Physical, Vec<(Kind, u32)>>,
    names: BTreeMap<Physical, Name>,
}

struct NodeTag {
    tag: u64,
    node: u32,
    at: usize,
}

struct Name {
    name: String,
    at: usize,
}

impl Builder {
    /// Adds a node; `at` is where its tag stands in the file.
    pub(super) fn add_node(&mut self, tag: u64, at: usize, x: [f64; 3]) {
        let node = self.nodes.len() as u32;
        self.nodes.push(x);
        self.tags.push(NodeTag { tag, node, at });
    }

    /// Makes the nodes added so far known to [`Builder::node`]. Fails if a tag is there twice.
    pub(super) fn sort_nodes(&mut self) -> Result<(), Fault> {
        self.tags.sort_by_key(|entry| (entry.tag, entry.at));
        match self.tags.windows(2).find(|pair| pair[0].tag == pair[1].tag) {
            Some(pair) => {
                let found = format!("a second node with the tag {}", pair[1].tag);
                Err(Fault::new(pair[1].at, found, "a tag not used before"))
            }
            None => Ok(()),
        }
    }

    /// The node with this tag; `at` is where the tag stands. Fails if no node has it.
    pub(super) fn node(&self, tag: u64, at: usize) -> Result<u32, Fault> {
        // Nearly always the tags are 1 to n: then the place is known.
        let first = self.tags.first().map_or(0, |entry| entry.tag);
        let guess = tag.wrapping_sub(first) as usize;
        if let Some(entry) = self.tags.get(guess).filter(|entry| entry.tag == tag) {
            return Ok(entry.node);
        }
        match self.tags.binary_search_by_key(&tag, |entry| entry.tag) {
            Ok(place) => Ok(self.tags[place].node),
            Err(_) => {
                let expected = "the tag of a node defined before, in $Nodes";
                Err(Fault::new(at, format!("node tag {tag}"), expected))
            }
        }
    }

    /// Adds an element that is in these physical groups; `nodes` in Gmsh's order.
    pub(super) fn add_element(&mut self, kind: Kind, nodes: &[u32], physicals: &[u64]) {
        let cells = self.cells.entry(kind).or_default();
        let index = (cells.len() / nodes.len()) as u32;
        cells.extend(kind.table().gmsh_order.iter().map(|&place| nodes[place]));
        for &tag in physicals {
            let members = self.members.entry((kind.table().dim, tag)).or_default();
            members.push((kind, index));
        }
    }

    /// Names a physical group; `at` is where the name stands. Fails if the group has another name already.
    pub(super) fn name(
        &mut self,
        physical: Physical,
        name: String,
        at: usize,
    ) -> Result<(), Fault> {
        match self.names.entry(physical) {
            Entry::Occupied(old) if old.get().name != name => {
                let found = format!(
                    "the name \"{name}\" for a group called \"{}\" before",
                    old.get().name
                );
                Err(Fault::new(at, found, "one name for each dimension and tag"))
            }
            Entry::Occupied(_) => Ok(()),
            Entry::Vacant(free) => {
                free.insert(Name { name, at });
                Ok(())
            }
        }
    }

    /// The mesh; `end` is the length of the file. Fails if there is no node or no element, or if two groups have
    /// one name.
    pub(super) fn finish(mut self, end: usize) -> Result<Mesh, Fault> {
        if self.nodes.is_empty() {
            return Err(Fault::new(
                end,
                "no node",
                "at least one in a section $Nodes",
            ));
        }
        let Some(dim) = self.cells.keys().map(|kind| kind.table().dim).max() else {
            let expected = "at least one in a section $Elements (where a file has physical groups, \
                            Gmsh writes only their elements)";
            return Err(Fault::new(end, "no element", expected));
        };
        let mut mesh = Mesh::new(flatten(&mut self.nodes, dim));
        mesh.nodes = std::mem::take(&mut self.nodes);
        let mut numbers = BTreeMap::new();
        for (&kind, cells) in &self.cells {
            let (nodes, kept) = merge_twins(cells, kind.table().nodes);
            numbers.insert(kind, (mesh.blocks.len() as u32, kept));
            mesh.blocks.push(Block { kind, nodes });
        }
        for (physical, Name { name, at }) in self.all_names(end) {
            let members = self.members.get(&physical).into_iter().flatten();
            let elements = members.map(|&(kind, index)| {
                let (block, kept) = &numbers[&kind];
                let (block, index) = (*block, kept[index as usize]);
                ElementId { block, index }
            });
            let group = Group::new(physical.0, elements.collect());
            if mesh.groups.contains_key(&name) {
                let found = format!("a second group called \"{name}\"");
                return Err(Fault::new(at, found, "distinct names, over all dimensions"));
            }
            mesh.groups.insert(name, group);
        }
        Ok(mesh)
    }

    /// The names that the file gives, and those made up for groups that have elements only.
    fn all_names(&mut self, end: usize) -> BTreeMap<Physical, Name> {
        let mut names = std::mem::take(&mut self.names);
        for &(dim, tag) in self.members.keys() {
            names.entry((dim, tag)).or_insert_with(|| Name {
                name: format!("{dim}:{tag}"),
                at: end,
            });
        }
        names
    }
}

/// Keeps one of the elements that are on the same nodes, the first. Returns the nodes of those kept and, for each
/// element given, the number of the one kept for it.
fn merge_twins(nodes: &[u32], width: usize) -> (Vec<u32>, Vec<u32>) {
    let elements = nodes.chunks_exact(width);
    let mut first: Vec<u32> = (0..elements.len() as u32).collect();
    let sorted = |(element, i): (&[u32], u32)| {
        let mut key = [u32::MAX; MAX_NODES];
        key[..width].copy_from_slice(element);
        key.sort_unstable();
        (key, i)
    };
    let mut keys: Vec<_> = elements.clone().zip(0..).map(sorted).collect();
    keys.sort_unstable();
    for pair in keys.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        first[pair[1].1 as usize] = first[pair[0].1 as usize];
    }
    let (mut kept, mut numbers) = (
        Vec::with_capacity(nodes.len()),
        Vec::with_capacity(first.len()),
    );
    for ((i, &first), element) in first.iter().enumerate().zip(elements) {
        if first as usize == i {
            numbers.push((kept.len() / width) as u32);
            kept.extend_from_slice(element);
        } else {
            numbers.push(numbers[first as usize]);
        }
    }
    (kept, numbers)
}
