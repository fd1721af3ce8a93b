//! The condensed compliance D of an interface problem: all entries, or the sparse rows that it is the product of.

/// D, symmetric and positive semi-definite, in x per N.
#[derive(Clone, Copy)]
pub enum Compliance<'a> {
    /// All entries, row-major: of few points, or where a factor couples them all.
    Dense(&'a [f64]),
    /// `D = B Bᵀ` with sparse B: of a diagonal mass.
    Lumped(&'a Lumped),
}

impl Compliance<'_> {
    /// All entries, row-major, of at most `most` rows.
    pub fn entries(&self, most: usize) -> Option<Vec<f64>> {
        match self {
            Compliance::Dense(entries) => Some(entries.to_vec()),
            Compliance::Lumped(rows) => (rows.rows() <= most).then(|| {
                let mut entries = Vec::new();
                rows.dense(&mut entries);
                entries
            }),
        }
    }
}

/// The sparse rows B of `D = N M⁻¹ Nᵀ = B Bᵀ`, `B = N M^(-1/2)`, M diagonal.
///
/// D itself is never made, so that memory and the cost of a product grow as the entries of N. The rows of a candidate are over the same
/// unknowns, which are kept once, with the entries of all its rows side by side; beside them, its block of D over its own rows.
#[derive(Clone, Debug, Default)]
pub struct Lumped {
    /// Rows of a candidate: one, or its normal and its tangents.
    width: usize,
    /// Number of the rows.
    rows: usize,
    /// Where the unknowns of candidates begin, and one end more.
    starts: Vec<u32>,
    /// Unknowns, numbered from 0 without gaps.
    unknowns: Vec<u32>,
    /// Entries of B: of each unknown of a candidate those in its rows.
    entries: Vec<f64>,
    /// Number of the unknowns.
    count: usize,
    /// Blocks of D over the rows of each candidate, row-major.
    blocks: Vec<f64>,
}

impl Lumped {
    /// Removes all rows. `width`: rows of each candidate, three at most.
    pub fn clear(&mut self, width: usize) {
        self.width = width;
        self.rows = 0;
        self.starts.clear();
        self.starts.push(0);
        self.unknowns.clear();
        self.entries.clear();
        self.blocks.clear();
        self.count = 0;
    }

    /// Appends a row: unknowns and entries of B. An unknown may come more than once.
    pub fn push(&mut self, row: impl Iterator<Item = (u32, f64)>) {
        let (candidate, k) = (self.rows / self.width, self.rows % self.width);
        let first = self.starts[candidate] as usize;
        // mostly the unknowns of the row before, in their order
        let mut next = first;
        for (unknown, entry) in row {
            if self.unknowns.get(next) != Some(&unknown) {
                let own = self.unknowns[first..].iter();
                next = match own.clone().position(|own| *own == unknown) {
                    Some(place) => first + place,
                    None => {
                        self.unknowns.push(unknown);
                        self.entries.resize(self.entries.len() + self.width, 0.0);
                        self.count = self.count.max(unknown as usize + 1);
                        self.unknowns.len() - 1
                    }
                };
            }
            self.entries[next * self.width + k] += entry;
            next += 1;
        }
        self.rows += 1;
        if self.rows.is_multiple_of(self.width) {
            self.starts.push(self.unknowns.len() as u32);
        }
    }

    /// Makes the blocks, once all rows are there.
    pub fn finish(&mut self) {
        let mut blocks = std::mem::take(&mut self.blocks);
        for i in 0..self.rows / self.width {
            let (_, entries) = self.candidate(i);
            for k in 0..self.width {
                for l in 0..self.width {
                    let terms = entries.chunks_exact(self.width).map(|of| of[k] * of[l]);
                    blocks.push(terms.sum());
                }
            }
        }
        self.blocks = blocks;
    }

    /// Number of the rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Numbers that it holds: entries of B and of the blocks.
    pub fn numbers(&self) -> usize {
        self.entries.len() + self.blocks.len()
    }

    /// Bytes that it holds in these numbers, and in those of the unknowns.
    pub fn bytes(&self) -> usize {
        8 * self.numbers() + 4 * self.unknowns.len()
    }

    /// Number of the unknowns.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// Unknowns and entries of a candidate.
    fn candidate(&self, i: usize) -> (&[u32], &[f64]) {
        let range = self.starts[i] as usize..self.starts[i + 1] as usize;
        let entries = range.start * self.width..range.end * self.width;
        (&self.unknowns[range], &self.entries[entries])
    }

    /// Unknowns and entries of a row.
    fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> {
        let (unknowns, entries) = self.candidate(row / self.width);
        let entries = entries.iter().skip(row % self.width).step_by(self.width);
        unknowns.iter().map(|&k| k as usize).zip(entries.copied())
    }

    /// (B x)_row.
    pub(crate) fn along(&self, row: usize, x: &[f64]) -> f64 {
        self.row(row).map(|(k, b)| b * x[k]).sum()
    }

    /// x += Bᵀ p of one row.
    pub(crate) fn add(&self, row: usize, p: f64, x: &mut [f64]) {
        for (k, b) in self.row(row) {
            x[k] += b * p;
        }
    }

    /// B x in the rows of candidate `i`.
    pub(crate) fn along_all(&self, i: usize, x: &[f64]) -> [f64; 3] {
        let mut sums = [0.0; 3];
        match self.width {
            3 => sums = self.sums::<3>(i, x),
            2 => sums[..2].copy_from_slice(&self.sums::<2>(i, x)),
            _ => sums[0] = self.along(i, x),
        }
        sums
    }

    fn sums<const W: usize>(&self, i: usize, x: &[f64]) -> [f64; W] {
        let (unknowns, entries) = self.candidate(i);
        let (entries, _) = entries.as_chunks::<W>();
        let mut sums = [0.0; W];
        for (&unknown, entries) in unknowns.iter().zip(entries) {
            let x = x[unknown as usize];
            for (sum, entry) in sums.iter_mut().zip(entries) {
                *sum += entry * x;
            }
        }
        sums
    }

    /// x += Bᵀ p of the rows of candidate `i`.
    pub(crate) fn add_all(&self, i: usize, p: &[f64; 3], x: &mut [f64]) {
        match self.width {
            3 => self.add_sums(i, p, x),
            2 => self.add_sums(i, &[p[0], p[1]], x),
            _ => self.add(i, p[0], x),
        }
    }

    fn add_sums<const W: usize>(&self, i: usize, p: &[f64; W], x: &mut [f64]) {
        let (unknowns, entries) = self.candidate(i);
        let (entries, _) = entries.as_chunks::<W>();
        for (&unknown, entries) in unknowns.iter().zip(entries) {
            let terms = entries.iter().zip(p).map(|(entry, p)| entry * p);
            x[unknown as usize] += terms.sum::<f64>();
        }
    }

    /// x = Bᵀ p.
    pub(crate) fn gather(&self, p: &[f64], x: &mut Vec<f64>) {
        x.clear();
        x.resize(self.count, 0.0);
        for (row, &p) in p.iter().enumerate().filter(|(_, p)| **p != 0.0) {
            self.add(row, p, x);
        }
    }

    /// Bounds of Σ |D_ij p_j|: |B| |B|ᵀ |p|. `x`: scratch.
    pub(crate) fn sizes(&self, p: &[f64], x: &mut Vec<f64>, sizes: &mut Vec<f64>) {
        x.clear();
        x.resize(self.count, 0.0);
        for (row, &p) in p.iter().enumerate().filter(|(_, p)| **p != 0.0) {
            for (k, b) in self.row(row) {
                x[k] += (b * p).abs();
            }
        }
        let size = |row: usize| -> f64 { self.row(row).map(|(k, b)| b.abs() * x[k]).sum() };
        sizes.clear();
        sizes.extend((0..self.rows()).map(size));
    }

    /// Entry of the block of candidate `i` over its own rows `k` and `l`.
    pub(crate) fn block(&self, i: usize, k: usize, l: usize) -> f64 {
        self.blocks[(i * self.width + k) * self.width + l]
    }

    /// Writes all entries of D, row-major: for few rows.
    pub fn dense(&self, dense: &mut Vec<f64>) {
        let n = self.rows();
        dense.clear();
        let mut x = vec![0.0; self.count];
        for one in 0..n {
            self.add(one, 1.0, &mut x);
            dense.extend((0..n).map(|other| self.along(other, &x)));
            for (k, _) in self.row(one) {
                x[k] = 0.0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_product_of_the_rows_is_the_matrix() {
        let rows: [&[(u32, f64)]; 4] = [
            &[(0, 1.0), (2, -2.0)],
            &[(2, 3.0), (0, 1.0), (2, 1.0)],
            &[(1, 1.0), (3, 2.0)],
            &[(3, -1.0), (0, 0.5)],
        ];
        let mut lumped = Lumped::default();
        lumped.clear(2);
        for row in rows {
            lumped.push(row.iter().copied());
        }
        lumped.finish();
        let dense = [
            5.0, -7.0, 0.0, 0.5, -7.0, 17.0, 0.0, 0.5, 0.0, 0.0, 5.0, -2.0, 0.5, 0.5, -2.0, 1.25,
        ];
        let mut entries = Vec::new();
        lumped.dense(&mut entries);
        assert_eq!(entries, dense);
        let block = |i: usize| [0, 1, 2, 3].map(|k| lumped.block(i, k / 2, k % 2));
        assert_eq!(block(0), [5.0, -7.0, -7.0, 17.0]);
        assert_eq!(block(1), [5.0, -2.0, -2.0, 1.25]);
        assert_eq!(lumped.numbers(), 2 * (2 + 3) + 8);
        let (p, mut x, mut sizes) = ([1.0, 0.0, -2.0, 4.0], Vec::new(), Vec::new());
        lumped.gather(&p, &mut x);
        let product: Vec<f64> = (0..4).map(|row| lumped.along(row, &x)).collect();
        assert_eq!(product, [7.0, -5.0, -18.0, 9.5]);
        let all = [0, 1].map(|i| lumped.along_all(i, &x));
        assert_eq!(all, [[7.0, -5.0, 0.0], [-18.0, 9.5, 0.0]]);
        let mut sum = vec![0.0; 4];
        lumped.add_all(0, &[1.0, 0.0, 0.0], &mut sum);
        lumped.add_all(1, &[-2.0, 4.0, 0.0], &mut sum);
        assert_eq!(sum, x);
        lumped.sizes(&p, &mut x, &mut sizes);
        for (row, (product, size)) in product.iter().zip(&sizes).enumerate() {
            let own: f64 = (0..4).map(|j| (dense[4 * row + j] * p[j]).abs()).sum();
            assert!(*size >= own && own >= product.abs());
        }
    }
}
