//! A writer of MSH files for tests: both versions, text and binary of either byte order, any node tags.

use carom_mesh::{ElementId, Mesh};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

pub const ENCODINGS: [Encoding; 3] = [Encoding::Text, Encoding::LittleEndian, Encoding::BigEndian];

/// Writes a mesh in version 2.2; `tag` gives the tag of a node by its number.
pub fn write_22(mesh: &Mesh, encoding: Encoding, tag: impl Fn(u32) -> u64) -> Vec<u8> {
    let mut out = Sink::new("2.2", encoding);
    out.names(mesh);
    out.line(&format!("$Nodes\n{}", mesh.nodes.len()));
    for (i, x) in (0..).zip(&mesh.nodes) {
        out.int(tag(i) as i32);
        x.iter().for_each(|&x| out.real(x));
        out.end();
    }
    out.line("$EndNodes");
    let records: Vec<(ElementId, Option<i32>)> = elements(mesh)
        .flat_map(|id| match &groups_of(mesh, id)[..] {
            [] => vec![(id, None)],
            groups => groups.iter().map(|&group| (id, Some(group))).collect(),
        })
        .collect();
    out.line(&format!("$Elements\n{}", records.len()));
    for (number, (id, group)) in (1..).zip(records) {
        let kind = mesh.kind(id).table().gmsh as i32;
        // Tags: the group, the geometric entity, and the partitions, here one; or no tag at all.
        let tags = group.map_or(vec![], |group| vec![group, 1, 1, 1]);
        let count = tags.len() as i32;
        let head = match encoding {
            Encoding::Text => [number, kind, count],
            _ => [kind, 1, count],
        };
        head.iter().for_each(|&i| out.int(i));
        if encoding != Encoding::Text {
            out.int(number);
        }
        tags.iter().for_each(|&i| out.int(i));
        let nodes = in_order_of_gmsh(mesh, id).into_iter();
        nodes.for_each(|node| out.int(tag(node) as i32));
        out.end();
    }
    out.line("$EndElements");
    out.bytes
}

/// Writes a mesh in version 4.1, its nodes in two blocks, the second with a parameter for each node, its elements in
/// one block for each run of
/// elements of one kind in the same groups.
pub fn write_41(mesh: &Mesh, encoding: Encoding, tag: impl Fn(u32) -> u64) -> Vec<u8> {
    let mut out = Sink::new("4.1", encoding);
    out.names(mesh);
    let mut ids: Vec<ElementId> = elements(mesh).collect();
    ids.sort_by_key(|&id| mesh.kind(id));
    let like = |&a: &ElementId, &b: &ElementId| {
        mesh.kind(a) == mesh.kind(b) && groups_of(mesh, a) == groups_of(mesh, b)
    };
    let blocks: Vec<&[ElementId]> = ids.chunk_by(like).collect();
    out.entities(mesh, &blocks);
    out.nodes(mesh, &tag);
    out.line("$Elements");
    [blocks.len(), ids.len(), 1, ids.len()]
        .into_iter()
        .for_each(|size| out.size(size as u64));
    out.end();
    for (entity, block) in (1..).zip(&blocks) {
        let row = mesh.kind(block[0]).table();
        [row.dim as i32, entity, row.gmsh as i32]
            .into_iter()
            .for_each(|i| out.int(i));
        out.size(block.len() as u64);
        out.end();
        for &id in *block {
            out.size(1);
            let nodes = in_order_of_gmsh(mesh, id).into_iter();
            nodes.for_each(|node| out.size(tag(node)));
            out.end();
        }
    }
    out.line("$EndElements");
    out.bytes
}

fn in_order_of_gmsh(mesh: &Mesh, id: ElementId) -> Vec<u32> {
    let nodes = mesh.element_nodes(id);
    let mut out = nodes.to_vec();
    for (&node, &place) in nodes.iter().zip(mesh.kind(id).table().gmsh_order) {
        out[place] = node;
    }
    out
}

fn elements(mesh: &Mesh) -> impl Iterator<Item = ElementId> {
    (0..)
        .zip(&mesh.blocks)
        .flat_map(|(block, it)| (0..it.len() as u32).map(move |index| ElementId { block, index }))
}

/// Tags of the groups of an element: their places among the groups of the mesh, from 1.
fn groups_of(mesh: &Mesh, id: ElementId) -> Vec<i32> {
    let groups = (1..).zip(mesh.groups.values());
    groups
        .filter(|(_, group)| group.elements.contains(&id))
        .map(|(tag, _)| tag)
        .collect()
}

/// Bytes of a file and the way to write numbers into them.
struct Sink {
    bytes: Vec<u8>,
    encoding: Encoding,
}

impl Sink {
    fn new(version: &str, encoding: Encoding) -> Sink {
        let binary = i32::from(encoding != Encoding::Text);
        let bytes = Vec::new();
        let mut out = Sink { bytes, encoding };
        out.line(&format!("$MeshFormat\n{version} {binary} 8"));
        if encoding != Encoding::Text {
            out.int(1);
            out.line("");
        }
        out.line("$EndMeshFormat");
        out
    }

    fn names(&mut self, mesh: &Mesh) {
        self.line(&format!("$PhysicalNames\n{}", mesh.groups.len()));
        for (tag, (name, group)) in (1..).zip(&mesh.groups) {
            self.line(&format!("{} {tag} \"{name}\"", group.dim));
        }
        self.line("$EndPhysicalNames");
    }

    /// One entity for each block of elements, which are sorted by kind and so by dimension.
    fn entities(&mut self, mesh: &Mesh, blocks: &[&[ElementId]]) {
        self.line("$Entities");
        let dim = |block: &[ElementId]| mesh.kind(block[0]).table().dim;
        for i in 0..4 {
            let here = blocks.iter().filter(|block| dim(block) == i);
            self.size(here.count() as u64);
        }
        self.end();
        for (entity, block) in (1..).zip(blocks) {
            let (dim, groups) = (dim(block), groups_of(mesh, block[0]));
            self.int(entity);
            (0..if dim == 0 { 3 } else { 6 }).for_each(|_| self.real(0.0));
            self.size(groups.len() as u64);
            groups.iter().for_each(|&tag| self.int(tag));
            if dim > 0 {
                self.size(2);
                [1, -2].into_iter().for_each(|tag| self.int(tag));
            }
            self.end();
        }
        self.line("$EndEntities");
    }

    fn nodes(&mut self, mesh: &Mesh, tag: impl Fn(u32) -> u64) {
        let count = mesh.nodes.len() as u32;
        self.line("$Nodes");
        [2, count, 1, count]
            .into_iter()
            .for_each(|size| self.size(size.into()));
        self.end();
        for (parametric, nodes) in [(0, 0..count / 2), (1, count / 2..count)] {
            [1, 1, parametric].into_iter().for_each(|i| self.int(i));
            self.size(nodes.len() as u64);
            self.end();
            for node in nodes.clone() {
                self.size(tag(node));
                self.end();
            }
            for node in nodes {
                mesh.nodes[node as usize]
                    .into_iter()
                    .for_each(|x| self.real(x));
                (0..parametric).for_each(|_| self.real(0.5));
                self.end();
            }
        }
        self.line("$EndNodes");
    }

    fn line(&mut self, text: &str) {
        self.bytes.extend_from_slice(text.as_bytes());
        self.bytes.push(b'\n');
    }

    /// Ends a record: a line of text.
    fn end(&mut self) {
        if self.encoding == Encoding::Text {
            self.bytes.push(b'\n');
        }
    }

    fn int(&mut self, value: i32) {
        self.number(&value.to_string(), value.to_le_bytes());
    }

    fn size(&mut self, value: u64) {
        self.number(&value.to_string(), value.to_le_bytes());
    }

    fn real(&mut self, value: f64) {
        self.number(&format!("{value:e}"), value.to_le_bytes());
    }

    fn number<const N: usize>(&mut self, text: &str, mut little: [u8; N]) {
        match self.encoding {
            Encoding::Text => self.bytes.extend_from_slice(format!("{text} ").as_bytes()),
            Encoding::LittleEndian => self.bytes.extend_from_slice(&little),
            Encoding::BigEndian => {
                little.reverse();
                self.bytes.extend_from_slice(&little);
            }
        }
    }
}
