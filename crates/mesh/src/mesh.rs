//! Nodes, blocks of elements, named groups.
//!
//! Elements of all dimensions live in one mesh, as in Gmsh: the facets of a surface are elements too, named by a
//! group of their own. There is one block per element kind. Points have three components always; in a plane mesh
//! the third is zero, on a line the second and the third.

use std::collections::BTreeMap;
use std::fmt;

use carom_elements::{Kind, MAX_NODES, map};

use crate::{ElementId, Error};

/// A mesh: nodes, elements by kind, named groups of elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Dimension of the space, 1, 2 or 3.
    pub dim: usize,
    /// Node coordinates, in m once scaled; components beyond `dim` are zero.
    pub nodes: Vec<[f64; 3]>,
    /// Elements, one block per kind.
    pub blocks: Vec<Block>,
    /// Named groups, each of one dimension.
    pub groups: BTreeMap<String, Group>,
}

/// The elements of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Their kind.
    pub kind: Kind,
    /// Node numbers (from 0, all below the number of nodes), as many per element as the kind has nodes.
    pub nodes: Vec<u32>,
}

/// A named group of elements of one dimension.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Dimension of the elements, 0 to 3.
    pub dim: usize,
    /// The elements, sorted, each once.
    pub elements: Vec<ElementId>,
}

/// What makes an element unfit for computation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Defect {
    /// A coordinate of a node is infinite or not a number.
    NotFinite {
        /// The element that uses the node.
        element: ElementId,
        /// The node.
        node: u32,
    },
    /// An element names the same node twice.
    RepeatedNode {
        /// The element.
        element: ElementId,
        /// The node.
        node: u32,
    },
    /// Somewhere in the element the map from the reference cell turns space inside out.
    Inverted {
        /// The element.
        element: ElementId,
        /// The least determinant of the Jacobian over nodes and integration points, in length^dim.
        determinant: f64,
    },
    /// Somewhere the element has no length, area or volume: least determinant below 1e-12 of its diameter^dim.
    Degenerate {
        /// The element.
        element: ElementId,
    },
}

impl Defect {
    /// The element that has the defect.
    pub fn element(&self) -> ElementId {
        match *self {
            Defect::NotFinite { element, .. }
            | Defect::RepeatedNode { element, .. }
            | Defect::Inverted { element, .. }
            | Defect::Degenerate { element } => element,
        }
    }
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Defect::NotFinite { node, .. } => {
                write!(f, "node {node} has a coordinate that is not finite")
            }
            Defect::RepeatedNode { node, .. } => write!(f, "node {node} is listed twice"),
            Defect::Inverted { determinant, .. } => {
                write!(f, "inverted (least Jacobian determinant {determinant:e})")
            }
            Defect::Degenerate { .. } => write!(f, "without length, area or volume somewhere"),
        }
    }
}

impl Group {
    /// The group of these elements, sorted, each once.
    pub fn new(dim: usize, mut elements: Vec<ElementId>) -> Group {
        elements.sort_unstable();
        elements.dedup();
        Group { dim, elements }
    }
}

impl Block {
    /// Number of elements.
    pub fn len(&self) -> usize {
        self.nodes.len() / self.kind.table().nodes
    }

    /// Whether the block has no element.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }
}

impl Mesh {
    /// A mesh without nodes in a space of `dim` dimensions.
    pub fn new(dim: usize) -> Mesh {
        Mesh {
            dim,
            nodes: Vec::new(),
            blocks: Vec::new(),
            groups: BTreeMap::new(),
        }
    }

    /// Gives up the room that it grew with.
    pub fn shrink_to_fit(&mut self) {
        self.nodes.shrink_to_fit();
        for block in &mut self.blocks {
            block.nodes.shrink_to_fit();
        }
        for group in self.groups.values_mut() {
            group.elements.shrink_to_fit();
        }
    }

    /// Adds an element to the block of its kind, which is made if there is none. `nodes` has the length that the
    /// kind asks for.
    pub fn push(&mut self, kind: Kind, nodes: &[u32]) -> ElementId {
        debug_assert_eq!(nodes.len(), kind.table().nodes);
        let block = self.block_of(kind);
        let index = self.blocks[block].len();
        self.blocks[block].nodes.extend_from_slice(nodes);
        ElementId {
            block: block as u32,
            index: index as u32,
        }
    }

    /// The nodes of an element, in the order of its kind.
    pub fn element_nodes(&self, id: ElementId) -> &[u32] {
        let block = &self.blocks[id.block as usize];
        let n = block.kind.table().nodes;
        let start = id.index as usize * n;
        &block.nodes[start..start + n]
    }

    /// The mean of the nodes of an element, m.
    pub fn middle(&self, id: ElementId) -> [f64; 3] {
        let nodes = self.element_nodes(id);
        [0, 1, 2].map(|i| {
            let sum: f64 = nodes.iter().map(|&node| self.nodes[node as usize][i]).sum();
            sum / nodes.len() as f64
        })
    }

    /// The kind of an element.
    pub fn kind(&self, id: ElementId) -> Kind {
        self.blocks[id.block as usize].kind
    }

    /// The nodes of a group, sorted, each once.
    pub fn group_nodes(&self, group: &Group) -> Vec<u32> {
        let mut nodes: Vec<u32> = group
            .elements
            .iter()
            .flat_map(|&id| self.element_nodes(id))
            .copied()
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Appends another mesh. Nothing is fused: coincident nodes stay two. Group names are kept. The dimension
    /// becomes the larger of both.
    ///
    /// `name` is what messages call the other mesh. Fails, without change, if a group name is in both.
    pub fn merge(&mut self, name: &str, other: Mesh) -> Result<(), Error> {
        if let Some(group) = other.groups.keys().find(|g| self.groups.contains_key(*g)) {
            return Err(Error::GroupClash {
                mesh: name.to_owned(),
                group: group.clone(),
            });
        }
        let first_node = self.nodes.len() as u32;
        self.dim = self.dim.max(other.dim);
        self.nodes.extend(other.nodes);
        let mut moved = Vec::with_capacity(other.blocks.len());
        for block in other.blocks {
            let target = self.block_of(block.kind);
            moved.push((target as u32, self.blocks[target].len() as u32));
            let nodes = block.nodes.iter().map(|node| node + first_node);
            self.blocks[target].nodes.extend(nodes);
        }
        for (name, group) in other.groups {
            let elements = group.elements.iter().map(|id| {
                let (block, first) = moved[id.block as usize];
                ElementId {
                    block,
                    index: id.index + first,
                }
            });
            self.groups
                .insert(name, Group::new(group.dim, elements.collect()));
        }
        Ok(())
    }

    /// Multiplies all coordinates by a factor, such as 1e-3 for a file in millimetres.
    pub fn scale(&mut self, factor: f64) {
        for x in self.nodes.iter_mut().flatten() {
            *x *= factor;
        }
    }

    /// Diagonal of the bounding box of all nodes, in m; zero for an empty mesh. The length that absolute
    /// tolerances are fractions of.
    pub fn size(&self) -> f64 {
        let extent = |i: usize| {
            let x = self.nodes.iter().map(|x| x[i]);
            x.clone().fold(f64::MIN, f64::max) - x.fold(f64::MAX, f64::min)
        };
        if self.nodes.is_empty() {
            return 0.0;
        }
        (0..3).map(|i| extent(i).powi(2)).sum::<f64>().sqrt()
    }

    /// What the place of a node may be beside the true one because its coordinates are rounded, and so the difference of two places, m: two
    /// roundings of the largest coordinate.
    pub fn rounding(&self) -> f64 {
        let coordinates = self.nodes.iter().flatten();
        2.0 * f64::EPSILON * coordinates.fold(0.0, |largest: f64, x| largest.max(x.abs()))
    }

    /// The defects of these elements, in their order, one per element at most: the first that applies of
    /// repeated node, coordinate not finite, inverted, degenerate.
    ///
    /// Only elements that fill their space (plane cells in two dimensions, solids in three) can be inverted.
    pub fn check(&self, cells: &[ElementId]) -> Vec<Defect> {
        cells.iter().filter_map(|&id| self.defect(id)).collect()
    }

    fn defect(&self, element: ElementId) -> Option<Defect> {
        let nodes = self.element_nodes(element);
        for (i, &node) in nodes.iter().enumerate() {
            if nodes[..i].contains(&node) {
                return Some(Defect::RepeatedNode { element, node });
            }
            if self.nodes[node as usize].iter().any(|x| !x.is_finite()) {
                return Some(Defect::NotFinite { element, node });
            }
        }
        let mut buffer = [[0.0; 3]; MAX_NODES];
        let x = gather(&self.nodes, nodes, &mut buffer);
        let table = self.kind(element).table();
        let determinant = self.least_determinant(self.kind(element), x);
        let tolerance = 1e-12 * diameter(x).powi(table.dim as i32);
        if table.dim == 0 {
            None
        } else if determinant < -tolerance {
            Some(Defect::Inverted {
                element,
                determinant,
            })
        } else if determinant <= tolerance {
            Some(Defect::Degenerate { element })
        } else {
            None
        }
    }

    /// Least determinant of the Jacobian over the nodes and the integration points of an element; a length or
    /// area factor, never negative, for one that does not fill its space.
    fn least_determinant(&self, kind: Kind, x: &[[f64; 3]]) -> f64 {
        let table = kind.table();
        let fills = table.dim == self.dim && table.dim > 1;
        let mut dn = [[0.0; 3]; MAX_NODES];
        let dn = &mut dn[..table.nodes];
        let points = table.reference.iter().chain(table.mass_rule.points);
        points.fold(f64::MAX, |least, xi| {
            (table.gradient)(xi, dn);
            let here = match fills {
                true => map::jacobian(x, dn, table.dim).1,
                false => map::measure(x, dn, table.dim).0,
            };
            least.min(here)
        })
    }

    fn block_of(&mut self, kind: Kind) -> usize {
        match self.blocks.iter().position(|block| block.kind == kind) {
            Some(block) => block,
            None => {
                let nodes = Vec::new();
                self.blocks.push(Block { kind, nodes });
                self.blocks.len() - 1
            }
        }
    }
}

/// Copies the positions of some nodes into a buffer and returns the part that was filled.
///
/// `positions`: one point per node of the mesh, reference or current; `nodes`: at most [`MAX_NODES`] of them.
#[inline]
pub fn gather<'a>(
    positions: &[[f64; 3]],
    nodes: &[u32],
    buffer: &'a mut [[f64; 3]; MAX_NODES],
) -> &'a [[f64; 3]] {
    for (x, &node) in buffer.iter_mut().zip(nodes) {
        *x = positions[node as usize];
    }
    &buffer[..nodes.len()]
}

/// Largest distance between two of the points.
fn diameter(x: &[[f64; 3]]) -> f64 {
    let distance = |a: &[f64; 3], b: &[f64; 3]| {
        let squares = (0..3).map(|i| (a[i] - b[i]).powi(2));
        squares.sum::<f64>().sqrt()
    };
    x.iter()
        .enumerate()
        .flat_map(|(i, a)| x[..i].iter().map(move |b| distance(a, b)))
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Mesh {
        let mut mesh = Mesh::new(2);
        for x in [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]] {
            mesh.nodes.push([x[0], x[1], 0.0]);
        }
        mesh
    }

    fn only(mesh: &Mesh, id: ElementId) -> Option<Defect> {
        let defects = mesh.check(&[id]);
        assert!(defects.len() < 2);
        assert!(defects.iter().all(|defect| defect.element() == id));
        defects.first().copied()
    }

    #[test]
    fn elements_keep_their_nodes_and_kinds_share_a_block() {
        let mut mesh = square();
        let a = mesh.push(Kind::Tri3, &[0, 1, 2]);
        let side = mesh.push(Kind::Bar2, &[1, 2]);
        let b = mesh.push(Kind::Tri3, &[0, 2, 3]);
        assert_eq!(mesh.blocks.len(), 2);
        assert_eq!(mesh.blocks[0].len(), 2);
        assert_eq!(mesh.element_nodes(a), [0, 1, 2]);
        assert_eq!(mesh.element_nodes(b), [0, 2, 3]);
        assert_eq!(mesh.element_nodes(side), [1, 2]);
        assert_eq!(mesh.kind(side), Kind::Bar2);
        let group = Group::new(2, vec![b, a, b]);
        assert_eq!(group.elements, [a, b]);
        assert_eq!(mesh.group_nodes(&group), [0, 1, 2, 3]);
    }

    #[test]
    fn a_merged_mesh_keeps_points_elements_and_groups_of_both() {
        let mut one = square();
        let a = one.push(Kind::Bar2, &[0, 1]);
        one.groups.insert("one".to_owned(), Group::new(1, vec![a]));
        let mut two = square();
        two.dim = 3;
        two.push(Kind::Point1, &[3]);
        let b = two.push(Kind::Bar2, &[2, 3]);
        two.groups.insert("two".to_owned(), Group::new(1, vec![b]));
        one.merge("two", two.clone()).unwrap();
        assert_eq!((one.dim, one.nodes.len()), (3, 8));
        assert_eq!(one.element_nodes(one.groups["one"].elements[0]), [0, 1]);
        assert_eq!(one.element_nodes(one.groups["two"].elements[0]), [6, 7]);

        let before = one.clone();
        let clash = Error::GroupClash {
            mesh: "again".to_owned(),
            group: "two".to_owned(),
        };
        assert_eq!(one.merge("again", two), Err(clash));
        assert_eq!(one, before);
    }

    #[test]
    fn the_size_is_the_diagonal_and_scales() {
        let mut mesh = square();
        assert_eq!(mesh.size(), 5.0f64.sqrt());
        mesh.scale(1e-3);
        assert!((mesh.size() - 1e-3 * 5.0f64.sqrt()).abs() < 1e-18);
        assert_eq!(Mesh::new(3).size(), 0.0);
    }

    #[test]
    fn sound_elements_have_no_defect_in_any_position_of_their_nodes_in_the_cycle() {
        let mut mesh = square();
        for nodes in [[0, 1, 2, 3], [1, 2, 3, 0]] {
            let id = mesh.push(Kind::Quad4, &nodes);
            assert_eq!(only(&mesh, id), None);
        }
        // Lines and points have no inside; a line may run either way.
        let ids = [
            mesh.push(Kind::Bar2, &[1, 0]),
            mesh.push(Kind::Point1, &[0]),
        ];
        assert_eq!(mesh.check(&ids), []);
    }

    #[test]
    fn defects_are_told_apart() {
        let mut mesh = square();
        let turned = mesh.push(Kind::Quad4, &[0, 3, 2, 1]);
        let crossed = mesh.push(Kind::Quad4, &[0, 2, 1, 3]);
        for element in [turned, crossed] {
            let defect = only(&mesh, element);
            assert!(
                matches!(defect, Some(Defect::Inverted { determinant, .. }) if determinant < -0.4)
            );
        }
        let element = mesh.push(Kind::Tri3, &[0, 1, 1]);
        let node = 1;
        assert_eq!(
            only(&mesh, element),
            Some(Defect::RepeatedNode { element, node })
        );
        mesh.nodes.push([1.0, 0.0, 0.0]);
        let element = mesh.push(Kind::Tri3, &[0, 4, 1]);
        assert_eq!(only(&mesh, element), Some(Defect::Degenerate { element }));
        mesh.nodes.push([f64::NAN, 0.0, 0.0]);
        let element = mesh.push(Kind::Bar2, &[0, 5]);
        let node = 5;
        assert_eq!(
            only(&mesh, element),
            Some(Defect::NotFinite { element, node })
        );
        mesh.nodes.push(mesh.nodes[0]);
        let element = mesh.push(Kind::Bar2, &[0, 6]);
        assert_eq!(only(&mesh, element), Some(Defect::Degenerate { element }));
    }

    #[test]
    fn whether_a_cell_is_sound_does_not_depend_on_the_unit_of_length() {
        for factor in [1e-9, 1e9] {
            let mut mesh = square();
            mesh.scale(factor);
            let good = mesh.push(Kind::Quad4, &[0, 1, 2, 3]);
            let bad = mesh.push(Kind::Quad4, &[3, 2, 1, 0]);
            assert_eq!(only(&mesh, good), None);
            assert!(matches!(only(&mesh, bad), Some(Defect::Inverted { .. })));
        }
    }
}
