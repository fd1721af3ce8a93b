//! Square sparse matrices, stored by rows.
//!
//! Both triangles are stored and the columns of a row are sorted. The pattern is fixed when the matrix is made; adding to an
//! entry that is not in it is a bug and panics.

use std::borrow::Cow;
use std::ops::Range;

use crate::pattern::Cliques;

/// Marks in [`Csr::gathered`] the 1 on the diagonal of an unknown that is held.
const HELD: usize = usize::MAX;

/// Square sparse matrix with both triangles and the whole diagonal stored.
#[derive(Clone, Debug)]
pub struct Csr {
    /// Number of rows and of columns.
    pub n: usize,
    row_ptr: Vec<usize>,
    col: Vec<u32>,
    val: Vec<f64>,
    /// Whether the row has the columns of the one before it.
    alike: Vec<bool>,
    /// Places of the pairs of nodes that were added since the matrix was cleared, and of those before: the next time they come in the same
    /// order, and are not searched for.
    found: Vec<u32>,
    /// Number of pairs since then.
    added: usize,
    /// Whose rows are kept; empty where all are. What is added outside of the pattern in another row is left out.
    kept: Vec<bool>,
}

impl Csr {
    fn new(n: usize, row_ptr: Vec<usize>, col: Vec<u32>, val: Vec<f64>) -> Self {
        let columns = |i: usize| &col[row_ptr[i]..row_ptr[i + 1]];
        let alike = (0..n).map(|i| i > 0 && columns(i) == columns(i - 1));
        Self {
            n,
            alike: alike.collect(),
            row_ptr,
            col,
            val,
            found: Vec::new(),
            added: 0,
            kept: Vec::new(),
        }
    }

    /// Matrix of zeros of which some rows are `kept`, those of one of several ranks. The lists are those with a kept unknown; the other rows have
    /// what these couple, and what is added to them beside it is left out.
    pub fn of_rows(kept: Vec<bool>, cliques: &Cliques) -> Self {
        let all = Self::from_cliques(kept.len(), cliques);
        Self { kept, ..all }
    }

    /// Matrix of zeros that has an entry for every pair of unknowns of every list, and the diagonal.
    ///
    /// `n`: number of unknowns, larger than any unknown of the lists.
    pub fn from_cliques(n: usize, cliques: &Cliques) -> Self {
        let (offsets, lists) = cliques.by_unknown(n);
        let mut row_ptr = Vec::with_capacity(n + 1);
        let mut col = Vec::new();
        let mut seen = vec![u32::MAX; n];
        row_ptr.push(0);
        for i in 0..n {
            let begin = col.len();
            seen[i] = i as u32;
            col.push(i as u32);
            for &list in &lists[offsets[i]..offsets[i + 1]] {
                for &j in cliques.get(list as usize) {
                    if seen[j as usize] != i as u32 {
                        seen[j as usize] = i as u32;
                        col.push(j);
                    }
                }
            }
            col[begin..].sort_unstable();
            row_ptr.push(col.len());
        }
        // a vector that has grown may have room for twice as many
        col.shrink_to_fit();
        let val = vec![0.0; col.len()];
        Self::new(n, row_ptr, col, val)
    }

    /// Number of stored entries.
    pub fn nnz(&self) -> usize {
        self.col.len()
    }

    /// Columns and values of row `i`; the columns ascend.
    pub fn row(&self, i: usize) -> (&[u32], &[f64]) {
        let range = self.row_ptr[i]..self.row_ptr[i + 1];
        (&self.col[range.clone()], &self.val[range])
    }

    /// Columns and values of some rows, one row after the other.
    pub fn entries(&self, rows: Range<usize>) -> (&[u32], &[f64]) {
        let range = self.row_ptr[rows.start]..self.row_ptr[rows.end];
        (&self.col[range.clone()], &self.val[range])
    }

    /// Entry (i, j); zero where none is stored.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let (columns, values) = self.row(i);
        columns
            .binary_search(&(j as u32))
            .map_or(0.0, |k| values[k])
    }

    /// Adds `value` to entry (i, j). Panics if the entry is not in the pattern.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        if let Some(k) = self.position(i, j as u32) {
            self.val[k] += value;
        }
    }

    /// Adds a dense block: entry (a, b) of `block` (row-major, `unknowns.len()` squared entries) goes to row `unknowns[a]`,
    /// column `unknowns[b]`. Panics if an entry is not in the pattern.
    pub fn add_block(&mut self, unknowns: &[u32], block: &[f64]) {
        debug_assert_eq!(block.len(), unknowns.len() * unknowns.len());
        for (a, &i) in unknowns.iter().enumerate() {
            for (b, &j) in unknowns.iter().enumerate() {
                if let Some(k) = self.position(i as usize, j) {
                    self.val[k] += block[a * unknowns.len() + b];
                }
            }
        }
    }

    /// Adds `factor` times a dense block over the unknowns of nodes, `dim` consecutive ones of each, as [`Csr::add_block`]: a pair of
    /// nodes is looked for once, in the first row. Panics if an entry is not in the pattern.
    ///
    /// `first`: the first unknown of each node.
    pub fn add_nodes(&mut self, first: &[u32], dim: usize, of: (f64, &[f64])) {
        match dim {
            1 => self.add_of_nodes::<1>(first, of),
            2 => self.add_of_nodes::<2>(first, of),
            _ => {
                debug_assert_eq!(dim, 3);
                self.add_of_nodes::<3>(first, of);
            }
        }
    }

    fn add_of_nodes<const D: usize>(&mut self, first: &[u32], (factor, block): (f64, &[f64])) {
        let nodes = first.len();
        let (entries, _) = block.as_chunks::<D>();
        debug_assert_eq!(entries.len(), nodes * nodes * D);
        for (a, &row) in first.iter().enumerate() {
            let row = row as usize;
            // rows of a node differ where the pattern couples one of its unknowns alone
            let alike = self.alike[row + 1..row + D].iter().all(|alike| *alike);
            for (b, &column) in first.iter().enumerate() {
                let Some(place) = self.found_place(row, column) else {
                    continue;
                };
                let offset = place - self.row_ptr[row];
                for i in 0..D {
                    let k = match alike {
                        true => Some(self.row_ptr[row + i] + offset),
                        false => self.position(row + i, column),
                    };
                    let Some(k) = k else { continue };
                    debug_assert_eq!(self.col[k + D - 1], column + D as u32 - 1);
                    let values = self.val[k..k + D].iter_mut();
                    for (value, entry) in values.zip(&entries[(D * a + i) * nodes + b]) {
                        *value += factor * entry;
                    }
                }
            }
        }
    }

    /// Place of an entry, which is likely that of the pair of nodes that was added at this turn before.
    #[inline(always)]
    fn found_place(&mut self, i: usize, j: u32) -> Option<usize> {
        let turn = self.added;
        self.added += 1;
        if let Some(&place) = self.found.get(turn) {
            let place = place as usize;
            if place >= self.row_ptr[i]
                && place < self.row_ptr[i + 1]
                && self.col.get(place) == Some(&j)
            {
                return Some(place);
            }
        }
        let Some(place) = self.position(i, j) else {
            self.added = turn;
            return None;
        };
        self.found.truncate(turn);
        self.found.push(place as u32);
        Some(place)
    }

    /// Sets every stored entry to zero; the pattern stays.
    pub fn clear(&mut self) {
        self.val.fill(0.0);
        self.added = 0;
    }

    /// Takes the values of another matrix of the same pattern.
    pub fn copy_values(&mut self, other: &Csr) {
        self.val.copy_from_slice(&other.val);
    }

    /// A ← (A + Aᵀ)/2.
    pub fn symmetrise(&mut self) {
        // row j meets the rows above it in their order, and so do its columns left of the diagonal
        let mut left: Vec<usize> = self.row_ptr[..self.n].to_vec();
        for i in 0..self.n {
            for k in self.row_ptr[i]..self.row_ptr[i + 1] {
                let j = self.col[k] as usize;
                if j > i {
                    let other = left[j];
                    debug_assert_eq!(self.col[other] as usize, i, "the pattern is symmetric");
                    let mean = 0.5 * (self.val[k] + self.val[other]);
                    (self.val[k], self.val[other]) = (mean, mean);
                    left[j] += 1;
                }
            }
        }
    }

    /// A ← s A.
    pub fn scale(&mut self, s: f64) {
        self.val.iter_mut().for_each(|value| *value *= s);
    }

    /// Product y = A x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        self.multiply_rows(0..self.n, x, y);
    }

    /// Product y = A x in some rows; the others of `y` stay.
    pub fn multiply_rows(&self, rows: Range<usize>, x: &[f64], y: &mut [f64]) {
        let mut i = rows.start;
        while i < rows.end {
            // rows of a node have the same columns: these and x are read once for two
            if i + 1 < rows.end && self.alike[i + 1] {
                let ((columns, first), (_, second)) = (self.row(i), self.row(i + 1));
                let mut sums = [0.0; 2];
                for ((&j, a), b) in columns.iter().zip(first).zip(second) {
                    let x = x[j as usize];
                    sums[0] += a * x;
                    sums[1] += b * x;
                }
                y[i..i + 2].copy_from_slice(&sums);
                i += 2;
            } else {
                let (columns, values) = self.row(i);
                let products = columns.iter().zip(values);
                y[i] = products.map(|(&j, a)| a * x[j as usize]).sum();
                i += 1;
            }
        }
    }

    /// The matrix in which the rows and columns of the unknowns marked `fixed` hold 1 on the diagonal and nothing else, not even
    /// a stored zero: a factorisation then spends nothing on them. A copy where there are any.
    pub fn with_identity(&self, fixed: &[bool]) -> Cow<'_, Self> {
        match fixed.contains(&true) {
            true => Cow::Owned(self.part(std::slice::from_ref(&(0..self.n)), |i| fixed[i])),
            false => Cow::Borrowed(self),
        }
    }

    /// The rows and columns of the unknowns in `ranges`, numbered one range after the other; entries in other columns are left out.
    pub fn restricted(&self, ranges: &[Range<usize>]) -> Self {
        self.part(ranges, |_| false)
    }

    /// [`Csr::restricted`], with [`Csr::with_identity`] of what `is_fixed` of the unknowns of this matrix.
    pub fn part(&self, ranges: &[Range<usize>], is_fixed: impl Fn(usize) -> bool) -> Self {
        self.gathered(ranges, is_fixed).0
    }

    /// [`Csr::part`], and for [`Csr::take_again`] where each of its entries comes from.
    pub(crate) fn gathered(
        &self,
        ranges: &[Range<usize>],
        is_fixed: impl Fn(usize) -> bool,
    ) -> (Self, Vec<usize>) {
        let rows = ranges.iter().cloned().flatten();
        let n = ranges.iter().map(|range| range.len()).sum();
        let most = rows.clone().map(|i| self.row(i).0.len()).sum();
        let mut row_ptr = Vec::with_capacity(n + 1);
        let (mut col, mut from) = (Vec::with_capacity(most), Vec::with_capacity(most));
        row_ptr.push(0);
        for i in rows {
            let columns = self.row(i).0;
            let alone = is_fixed(i);
            let mut first = 0;
            for range in ranges {
                let [begin, end] = [range.start, range.end]
                    .map(|end| columns.partition_point(|&j| (j as usize) < end));
                for (place, &j) in (begin..).zip(&columns[begin..end]) {
                    let j = j as usize;
                    if j == i || !(alone || is_fixed(j)) {
                        col.push((j - range.start + first) as u32);
                        from.push(match alone {
                            true => HELD,
                            false => self.row_ptr[i] + place,
                        });
                    }
                }
                first += range.len();
            }
            row_ptr.push(col.len());
        }
        let val = vec![0.0; col.len()];
        let mut part = Self::new(n, row_ptr, col, val);
        part.take_again(self, &from);
        (part, from)
    }

    /// Takes the values of the matrix that it was gathered from, which must have the pattern that it had.
    pub(crate) fn take_again(&mut self, whole: &Csr, from: &[usize]) {
        for (value, &from) in self.val.iter_mut().zip(from) {
            *value = match from {
                HELD => 1.0,
                from => whole.val[from],
            };
        }
    }

    /// Place of an entry; none of one that other ranks have.
    fn position(&self, i: usize, j: u32) -> Option<usize> {
        let (columns, _) = self.row(i);
        match columns.binary_search(&j) {
            Ok(k) => Some(self.row_ptr[i] + k),
            Err(_) if self.kept.get(i) == Some(&false) => None,
            Err(_) => panic!("entry ({i}, {j}) is not in the pattern of the matrix"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain() -> Csr {
        let mut cliques = Cliques::new();
        cliques.push(&[1, 0]);
        cliques.push(&[1, 2]);
        let mut matrix = Csr::from_cliques(4, &cliques);
        matrix.add_block(&[1, 0], &[2.0, -2.0, -2.0, 2.0]);
        matrix.add_block(&[1, 2], &[3.0, -3.0, -3.0, 3.0]);
        matrix
    }

    #[test]
    fn pattern_is_the_union_of_the_lists_and_the_diagonal() {
        let matrix = chain();
        assert_eq!(matrix.row(0).0, [0, 1]);
        assert_eq!(matrix.row(1).0, [0, 1, 2]);
        assert_eq!(matrix.row(3).0, [3]);
        assert_eq!(matrix.nnz(), 8);
    }

    #[test]
    fn blocks_are_summed_where_they_overlap() {
        let matrix = chain();
        assert_eq!(matrix.get(1, 1), 5.0);
        assert_eq!(matrix.get(0, 1), -2.0);
        assert_eq!(matrix.get(0, 2), 0.0);
        let mut y = [9.0; 4];
        matrix.multiply(&[1.0, 1.0, 1.0, 1.0], &mut y);
        assert_eq!(y, [0.0; 4]);
        matrix.multiply(&[0.0, 1.0, 0.0, 7.0], &mut y);
        assert_eq!(y, [-2.0, 5.0, -3.0, 0.0]);
    }

    #[test]
    fn the_symmetric_part_is_half_the_sum_with_the_transpose() {
        let mut matrix = chain();
        matrix.add_block(&[1, 2], &[0.0, 4.0, -2.0, 1.0]);
        matrix.add_block(&[1, 0], &[0.0, 6.0, 0.0, 0.0]);
        let whole = matrix.clone();
        matrix.symmetrise();
        for i in 0..4 {
            for j in 0..4 {
                let mean = 0.5 * (whole.get(i, j) + whole.get(j, i));
                assert_eq!(matrix.get(i, j), mean, "({i}, {j})");
            }
        }
    }

    #[test]
    fn identity_rows_store_the_diagonal_alone() {
        let matrix = chain()
            .with_identity(&[false, false, true, true])
            .into_owned();
        assert_eq!(matrix.row(2), ([2].as_slice(), [1.0].as_slice()));
        assert_eq!(matrix.row(3), ([3].as_slice(), [1.0].as_slice()));
        assert_eq!(matrix.row(1), ([0, 1].as_slice(), [-2.0, 5.0].as_slice()));
    }

    #[test]
    fn a_restriction_holds_the_entries_among_its_unknowns() {
        let matrix = chain().restricted(&[0..1, 2..4]);
        assert_eq!(matrix.n, 3);
        assert_eq!(matrix.row(0), ([0].as_slice(), [2.0].as_slice()));
        assert_eq!(matrix.row(1), ([1].as_slice(), [3.0].as_slice()));
        let all = chain();
        let same = all.restricted(&[0..2, 2..4]);
        assert!((0..4).all(|i| same.row(i) == all.row(i)));
    }

    #[test]
    fn rows_of_a_rank_are_those_of_all_whatever_is_added_elsewhere() {
        let links: [(&[u32], &[f64]); 3] = [
            (&[1, 0], &[2.0, -2.0, -2.0, 2.0]),
            (&[1, 2], &[3.0, -3.0, -3.0, 3.0]),
            (&[2, 3], &[5.0, -5.0, -4.0, 4.0]),
        ];
        let (mut all, mut own) = (Cliques::new(), Cliques::new());
        links.iter().for_each(|(unknowns, _)| all.push(unknowns));
        links[..2]
            .iter()
            .for_each(|(unknowns, _)| own.push(unknowns));
        let mut whole = Csr::from_cliques(4, &all);
        let mut part = Csr::of_rows(vec![true, true, false, false], &own);
        for matrix in [&mut whole, &mut part] {
            for (unknowns, block) in links {
                matrix.add_block(unknowns, block);
                matrix.add_nodes(unknowns, 1, (0.5, block));
            }
            matrix.symmetrise();
        }
        assert!((0..2).all(|i| part.row(i) == whole.row(i)));
        assert_eq!(part.nnz(), 8);
        let (x, mut y, mut of_part) = ([1.0, -2.0, 4.0, 8.0], [0.0; 4], [0.0; 4]);
        whole.multiply(&x, &mut y);
        part.multiply_rows(0..2, &x, &mut of_part);
        assert_eq!(of_part, [y[0], y[1], 0.0, 0.0]);
    }

    #[test]
    #[should_panic(expected = "entry (0, 2) is not in the pattern")]
    fn adding_outside_the_pattern_is_a_bug() {
        chain().add(0, 2, 1.0);
    }
}
