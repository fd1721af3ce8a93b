//! Which unknowns are coupled: lists of unknowns, one per element, from which a sparse pattern is made.

/// Lists of unknowns that are all coupled to one another (the unknowns of one element, or of one constraint).
#[derive(Clone, Debug, Default)]
pub struct Cliques {
    ends: Vec<usize>,
    unknowns: Vec<u32>,
}

impl Cliques {
    /// No list yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one list; an unknown may appear in any number of lists.
    pub fn push(&mut self, unknowns: &[u32]) {
        self.unknowns.extend_from_slice(unknowns);
        self.ends.push(self.unknowns.len());
    }

    /// Number of lists.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// True when no list was added.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The lists, in the order in which they were added.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let begins = std::iter::once(0).chain(self.ends.iter().copied());
        begins
            .zip(&self.ends)
            .map(|(begin, &end)| &self.unknowns[begin..end])
    }

    /// For each of `n` unknowns, the numbers of the lists that contain it: (offsets of length n + 1, list numbers).
    pub(crate) fn by_unknown(&self, n: usize) -> (Vec<usize>, Vec<u32>) {
        let mut offsets = vec![0usize; n + 1];
        for &i in &self.unknowns {
            offsets[i as usize + 1] += 1;
        }
        for i in 0..n {
            offsets[i + 1] += offsets[i];
        }
        let mut next = offsets.clone();
        let mut lists = vec![0u32; self.unknowns.len()];
        for (number, list) in self.iter().enumerate() {
            for &i in list {
                lists[next[i as usize]] = number as u32;
                next[i as usize] += 1;
            }
        }
        (offsets, lists)
    }

    /// The list of that number.
    pub(crate) fn get(&self, number: usize) -> &[u32] {
        let begin = if number == 0 {
            0
        } else {
            self.ends[number - 1]
        };
        &self.unknowns[begin..self.ends[number]]
    }
}
