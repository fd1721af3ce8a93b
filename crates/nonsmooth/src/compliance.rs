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
/// D itself is never made, so that memory and the cost of a product grow as the entries of N. Of each candidate the block of D
/// over its own rows is kept beside them.
#[derive(Clone, Debug, Default)]
pub struct Lumped {
    /// Rows of a candidate: one, or its normal and its tangents.
    width: usize,
    /// Where rows begin, and one end more.
    starts: Vec<u32>,
    /// Unknowns, numbered from 0 without gaps.
    unknowns: Vec<u32>,
    /// Entries of B.
    entries: Vec<f64>,
    /// Number of the unknowns.
    count: usize,
    /// Blocks of D over the rows of each candidate, row-major.
    blocks: Vec<f64>,
    /// One row of B over all unknowns, else zero.
    spread: Vec<f64>,
}

impl Lumped {
    /// Removes all rows. `width`: rows of each candidate.
    pub fn clear(&mut self, width: usize) {
        self.width = width;
        self.starts.clear();
        self.starts.push(0);
        self.unknowns.clear();
        self.entries.clear();
        self.blocks.clear();
        self.count = 0;
    }

    /// Appends a row: unknowns and entries of B. An unknown may come more than once.
    pub fn push(&mut self, row: impl Iterator<Item = (u32, f64)>) {
        for (unknown, entry) in row {
            self.unknowns.push(unknown);
            self.entries.push(entry);
            self.count = self.count.max(unknown as usize + 1);
        }
        self.starts.push(self.unknowns.len() as u32);
    }

    /// Makes the blocks, once all rows are there.
    pub fn finish(&mut self) {
        let mut spread = std::mem::take(&mut self.spread);
        spread.clear();
        spread.resize(self.count, 0.0);
        for first in (0..self.rows()).step_by(self.width.max(1)) {
            for one in first..first + self.width {
                self.add(one, 1.0, &mut spread);
                for other in first..first + self.width {
                    let entry = self.along(other, &spread);
                    self.blocks.push(entry);
                }
                for &unknown in self.row(one).0 {
                    spread[unknown as usize] = 0.0;
                }
            }
        }
        self.spread = spread;
    }

    /// Number of the rows.
    pub fn rows(&self) -> usize {
        self.starts.len().saturating_sub(1)
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

    fn row(&self, row: usize) -> (&[u32], &[f64]) {
        let range = self.starts[row] as usize..self.starts[row + 1] as usize;
        (&self.unknowns[range.clone()], &self.entries[range])
    }

    /// (B x)_row.
    pub(crate) fn along(&self, row: usize, x: &[f64]) -> f64 {
        let (unknowns, entries) = self.row(row);
        let terms = unknowns.iter().zip(entries);
        terms.map(|(&k, b)| b * x[k as usize]).sum()
    }

    /// x += Bᵀ p of one row.
    pub(crate) fn add(&self, row: usize, p: f64, x: &mut [f64]) {
        let (unknowns, entries) = self.row(row);
        for (&k, b) in unknowns.iter().zip(entries) {
            x[k as usize] += b * p;
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
            let (unknowns, entries) = self.row(row);
            for (&k, b) in unknowns.iter().zip(entries) {
                x[k as usize] += (b * p).abs();
            }
        }
        let size = |row: usize| -> f64 {
            let (unknowns, entries) = self.row(row);
            let terms = unknowns.iter().zip(entries);
            terms.map(|(&k, b)| b.abs() * x[k as usize]).sum()
        };
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
            for &unknown in self.row(one).0 {
                x[unknown as usize] = 0.0;
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
        assert_eq!(lumped.numbers(), 9 + 8);
        let (p, mut x, mut sizes) = ([1.0, 0.0, -2.0, 4.0], Vec::new(), Vec::new());
        lumped.gather(&p, &mut x);
        let product: Vec<f64> = (0..4).map(|row| lumped.along(row, &x)).collect();
        assert_eq!(product, [7.0, -5.0, -18.0, 9.5]);
        lumped.sizes(&p, &mut x, &mut sizes);
        for (row, (product, size)) in product.iter().zip(&sizes).enumerate() {
            let own: f64 = (0..4).map(|j| (dense[4 * row + j] * p[j]).abs()).sum();
            assert!(*size >= own && own >= product.abs());
        }
    }
}
