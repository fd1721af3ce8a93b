//! The map of unknowns: which entries of a system vector belong to a node, and what each of them is.
//!
//! A node has its translations, its translations followed by its rotations, or none, if another node carries it or a basis
//! gives its motion. The amplitudes of a basis belong to a node without a place. Nothing else decides where the unknowns of a
//! node are: whoever needs them asks this map.

use std::ops::Range;

use crate::basis::{Amplitude, Basis};

/// What an unknown is, with its axis: 0, 1, 2 for x, y, z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A displacement, m.
    Translation(usize),
    /// A rotation, rad; in the plane about z.
    Rotation(usize),
    /// The amplitude of a motion of many nodes, m, by its number in its basis.
    Amplitude(usize),
}

/// Unknowns of the nodes of a system, those of a node next to each other, in the order of the nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Unknowns {
    dim: usize,
    /// First unknown of each node, and one end more.
    first: Vec<u32>,
    /// Node of each unknown.
    node: Vec<u32>,
    /// Nodes with finite rotations, ascending: the order of their frames.
    turning: Vec<u32>,
    /// What carries a node that is carried, by node; empty where none is.
    carriers: Vec<Option<Carrier>>,
    /// Whether the unknowns of a node are amplitudes, by node; empty where there are none.
    amplitudes: Vec<bool>,
    /// Motions of nodes by unknowns of others.
    bases: Vec<Basis>,
    /// The basis that gives the motion of a node, by node; empty where none does.
    basis: Vec<Option<u32>>,
}

/// What carries a node without unknowns: it keeps its place in the frame of another node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carrier {
    /// The node that carries it, with rotations.
    pub node: u32,
    /// From that node to the carried one, in the axes of its frame, m.
    pub arm: [f64; 3],
}

impl Unknowns {
    /// Nodes that have `dim` translations each.
    pub fn translations(dim: usize, nodes: usize) -> Unknowns {
        Unknowns::new(dim, std::iter::repeat_n(NodeKind::Translations, nodes))
    }

    /// Nodes of these kinds in space of `dim` dimensions.
    pub fn new(dim: usize, nodes: impl IntoIterator<Item = NodeKind>) -> Unknowns {
        let mut map = Unknowns {
            dim,
            first: vec![0],
            ..Unknowns::default()
        };
        for (number, kind) in nodes.into_iter().enumerate() {
            let own = std::iter::repeat_n(number as u32, kind.unknowns(dim));
            map.node.extend(own);
            map.first.push(map.node.len() as u32);
            match kind {
                NodeKind::Translations | NodeKind::SmallRotations | NodeKind::Recovered => {}
                NodeKind::Amplitudes(_) => {
                    map.amplitudes.resize(number + 1, false);
                    map.amplitudes[number] = true;
                }
                NodeKind::Turning => map.turning.push(number as u32),
                NodeKind::Carried(carrier) => {
                    map.carriers.resize(number + 1, None);
                    map.carriers[number] = Some(carrier);
                }
            }
        }
        map.node.shrink_to_fit();
        map.first.shrink_to_fit();
        map
    }

    /// Dimension of space: translations of a node that has any.
    #[inline]
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Number of nodes.
    #[inline]
    pub fn nodes(&self) -> usize {
        self.first.len() - 1
    }

    /// Number of unknowns.
    #[inline]
    pub fn len(&self) -> usize {
        self.node.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.node.is_empty()
    }

    /// First unknown of a node; of a node without any, that of the next one.
    #[inline]
    pub fn first(&self, node: u32) -> usize {
        self.first[node as usize] as usize
    }

    /// All unknowns of a node.
    #[inline]
    pub fn of(&self, node: u32) -> Range<usize> {
        self.first(node)..self.first[node as usize + 1] as usize
    }

    /// All unknowns of nodes that follow each other.
    #[inline]
    pub fn of_range(&self, nodes: Range<usize>) -> Range<usize> {
        self.first[nodes.start] as usize..self.first[nodes.end] as usize
    }

    /// Translations of a node: `dim` of them, or none.
    #[inline]
    pub fn translations_of(&self, node: u32) -> Range<usize> {
        let all = self.of(node);
        match self.has_amplitudes(node) {
            true => all.start..all.start,
            false => all.start..all.end.min(all.start + self.dim),
        }
    }

    #[inline]
    fn has_amplitudes(&self, node: u32) -> bool {
        self.amplitudes.get(node as usize) == Some(&true)
    }

    /// Adds the motions of nodes by the unknowns of others.
    pub fn recover(&mut self, basis: Basis) {
        self.basis.resize(self.nodes(), None);
        let number = self.bases.len() as u32;
        for node in basis.nodes() {
            self.basis[node as usize].get_or_insert(number);
        }
        self.bases.push(basis);
    }

    /// Each amplitude, and what of a rigid motion it is.
    pub fn amplitudes(&self) -> impl Iterator<Item = (usize, &Amplitude)> {
        self.bases.iter().flat_map(Basis::amplitudes)
    }

    /// Rotations of a node.
    #[inline]
    pub fn rotations_of(&self, node: u32) -> Range<usize> {
        let all = self.of(node);
        match self.has_amplitudes(node) {
            true => all.end..all.end,
            false => self.translations_of(node).end..all.end,
        }
    }

    /// What carries a node, if anything does.
    #[inline]
    pub fn carrier(&self, node: u32) -> Option<&Carrier> {
        self.carriers.get(node as usize)?.as_ref()
    }

    /// The node whose unknowns move a node: its carrier, or itself.
    #[inline]
    pub fn moved_by(&self, node: u32) -> u32 {
        self.carrier(node).map_or(node, |carrier| carrier.node)
    }

    /// Nodes with finite rotations, in the order of their frames.
    #[inline]
    pub fn turning(&self) -> &[u32] {
        &self.turning
    }

    /// Place of the frame of a node with finite rotations.
    pub fn frame(&self, node: u32) -> Option<usize> {
        self.turning.binary_search(&node).ok()
    }

    /// The rotations of a node in a system vector, about the axes of its frame, or of coordinates where it has none, with zeros
    /// where there are none.
    pub fn spin(&self, node: u32, values: &[f64]) -> [f64; 3] {
        let mut spin = [0.0; 3];
        for unknown in self.rotations_of(node) {
            if let Kind::Rotation(axis) = self.kind(unknown) {
                spin[axis] = values[unknown];
            }
        }
        spin
    }

    /// Node of an unknown.
    #[inline]
    pub fn node(&self, unknown: usize) -> u32 {
        self.node[unknown]
    }

    /// Node of each unknown.
    pub fn node_of_each(&self) -> &[u32] {
        &self.node
    }

    /// Kind of an unknown.
    #[inline]
    pub fn kind(&self, unknown: usize) -> Kind {
        let place = unknown - self.first(self.node[unknown]);
        if self.has_amplitudes(self.node[unknown]) {
            return Kind::Amplitude(place);
        }
        match (place < self.dim, self.dim) {
            (true, _) => Kind::Translation(place),
            (false, 2) => Kind::Rotation(2),
            (false, _) => Kind::Rotation(place - self.dim),
        }
    }

    /// The unknown of a node of a kind, if the node has it.
    pub fn find(&self, node: u32, kind: Kind) -> Option<usize> {
        let place = match (kind, self.dim) {
            (Kind::Translation(axis), _) => axis,
            (Kind::Rotation(axis), 2) => (axis == 2).then_some(2)?,
            (Kind::Rotation(axis), dim) => dim + axis,
            (Kind::Amplitude(number), _) => number,
        };
        let unknown = self.first(node) + place;
        (self.of(node).contains(&unknown) && self.kind(unknown) == kind).then_some(unknown)
    }

    /// The translations of a node in a system vector, with zeros beyond the dimension.
    #[inline]
    pub fn vector(&self, node: u32, values: &[f64]) -> [f64; 3] {
        match values[self.translations_of(node)] {
            [x, y, z] => [x, y, z],
            [x, y] => [x, y, 0.0],
            [x] => [x, 0.0, 0.0],
            _ => self.recovered(node, values),
        }
    }
}

impl Unknowns {
    /// The translations of a node that a basis gives, zero of other nodes without any.
    fn recovered(&self, node: u32, values: &[f64]) -> [f64; 3] {
        let basis = self.basis.get(node as usize).copied().flatten();
        let motion =
            basis.and_then(|basis| self.bases[basis as usize].motion(node, self.dim, values));
        motion.unwrap_or([0.0; 3])
    }
}

/// Which unknowns a node has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NodeKind {
    /// Its translations.
    Translations,
    /// Its translations, and its rotations, which are small: one in the plane, three in space, none on a line.
    SmallRotations,
    /// Its translations, and its rotations, which may be finite: one in the plane, three in space, none on a line.
    Turning,
    /// None: another node carries it.
    Carried(Carrier),
    /// None: a basis gives its motion ([`Unknowns::recover`]).
    Recovered,
    /// So many amplitudes of a basis: it has no place.
    Amplitudes(usize),
}

impl NodeKind {
    fn unknowns(self, dim: usize) -> usize {
        match (self, dim) {
            (NodeKind::Carried(_) | NodeKind::Recovered, _) => 0,
            (NodeKind::Amplitudes(count), _) => count,
            (NodeKind::Translations, _) | (_, 0 | 1) => dim,
            (NodeKind::SmallRotations | NodeKind::Turning, 2) => 3,
            (NodeKind::SmallRotations | NodeKind::Turning, _) => 6,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unknown_is_found_again_by_its_node_and_kind() {
        let carried = NodeKind::Carried(Carrier {
            node: 2,
            arm: [0.0; 3],
        });
        let kinds = [NodeKind::Translations, carried, NodeKind::Turning, carried];
        for (dim, counts) in [(1, [1, 0, 1, 0]), (2, [2, 0, 3, 0]), (3, [3, 0, 6, 0])] {
            let map = Unknowns::new(dim, kinds);
            assert_eq!(map.nodes(), 4);
            assert_eq!(map.len(), counts.iter().sum::<usize>());
            for node in 0..4 {
                assert_eq!(map.of(node).len(), counts[node as usize]);
                for unknown in map.of(node) {
                    assert_eq!(map.node(unknown), node);
                    assert_eq!(map.find(node, map.kind(unknown)), Some(unknown));
                }
            }
            assert_eq!(map.find(0, Kind::Rotation(2)), None);
            assert_eq!(map.find(1, Kind::Translation(0)), None);
            assert_eq!(map.of_range(0..4), 0..map.len());
            assert_eq!([0, 1, 2, 3].map(|node| map.moved_by(node)), [0, 2, 2, 2]);
            assert_eq!(map.frame(2), Some(0));
        }
    }

    #[test]
    fn small_rotations_are_unknowns_without_a_frame() {
        for (dim, count) in [(1, 1), (2, 3), (3, 6)] {
            let map = Unknowns::new(dim, [NodeKind::SmallRotations]);
            assert_eq!(map.len(), count);
            assert_eq!(map.rotations_of(0).len(), count - dim);
            assert_eq!((map.turning(), map.frame(0)), (&[][..], None));
        }
    }

    #[test]
    fn a_basis_moves_a_node_without_unknowns() {
        // node 1 moves by half of node 0 and the amplitude, which is a third of a translation along y
        let kinds = [
            NodeKind::Translations,
            NodeKind::Recovered,
            NodeKind::Amplitudes(1),
        ];
        let mut map = Unknowns::new(2, kinds);
        let amplitude = Amplitude {
            translation: [0.0, 1.0 / 3.0, 0.0],
            rotation: [0.0; 3],
        };
        map.recover(Basis::new(
            vec![0, 1, 2],
            vec![0.5, 0.0, 1.0, 0.0, 0.5, -1.0].into(),
            vec![(1, 0)],
            vec![(2, amplitude)],
        ));
        assert_eq!((map.len(), map.kind(2)), (3, Kind::Amplitude(0)));
        assert_eq!(map.find(2, Kind::Amplitude(0)), Some(2));
        assert!(map.translations_of(2).is_empty() && map.rotations_of(2).is_empty());
        let values = [2.0, 4.0, 7.0];
        assert_eq!(map.vector(1, &values), [8.0, -5.0, 0.0]);
        assert_eq!(map.vector(2, &values), [0.0; 3]);
        assert_eq!(map.amplitudes().collect::<Vec<_>>(), [(2, &amplitude)]);
    }

    #[test]
    fn the_vector_of_a_node_is_that_of_its_translations() {
        let map = Unknowns::new(2, [NodeKind::Turning, NodeKind::Translations]);
        let values = [1.0, 2.0, 3.0, 4.0, 5.0];
        assert_eq!(map.vector(0, &values), [1.0, 2.0, 0.0]);
        assert_eq!(map.vector(1, &values), [4.0, 5.0, 0.0]);
        assert_eq!(map.spin(0, &values), [0.0, 0.0, 3.0]);
    }
}
