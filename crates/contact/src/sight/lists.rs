//! Lists of faces around points and nodes.

use carom_mesh::Face;

/// Lists of numbers in one pool.
#[derive(Clone, Debug, Default)]
pub(super) struct Lists {
    pub(super) numbers: Vec<u32>,
    ends: Vec<u32>,
}

impl Lists {
    pub(super) fn push(&mut self, list: impl IntoIterator<Item = u32>) {
        self.numbers.extend(list);
        self.ends.push(self.numbers.len() as u32);
    }

    pub(super) fn of(&self, k: usize) -> &[u32] {
        let first = k.checked_sub(1).map_or(0, |k| self.ends[k]);
        &self.numbers[first as usize..self.ends[k] as usize]
    }
}

/// Faces by the nodes that they have: sorted pairs.
pub(super) struct Incidence(Vec<(u32, u32)>);

impl Incidence {
    pub(super) fn new(faces: &[Face]) -> Incidence {
        let pairs = faces.iter().zip(0..);
        let mut pairs: Vec<(u32, u32)> = pairs
            .flat_map(|(face, k)| face.corners().iter().map(move |&node| (node, k)))
            .collect();
        pairs.sort_unstable();
        Incidence(pairs)
    }

    /// Faces that have a node.
    pub(super) fn of(&self, node: u32) -> impl Iterator<Item = u32> + '_ {
        let first = self.0.partition_point(|(n, _)| *n < node);
        let pairs = self.0[first..].iter();
        pairs.take_while(move |(n, _)| *n == node).map(|(_, k)| *k)
    }
}
