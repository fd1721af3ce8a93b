//! Symmetric arrowhead matrices: a dense leading block, its coupling with the other unknowns, and the diagonal of these.
//!
//! ```text
//! A = [ D   E ]     D d × d, T diagonal, E left out where it is zero
//!     [ Eᵀ  T ]
//! ```
//!
//! Products are those of whole columns, several rows at a time, in one order and without fused operations: their bits depend on the
//! matrix and the vector alone, on no instruction set.

use pulp::Arch;

/// Rows of a panel: their sums stay in registers, and do not wait for each other.
const ROWS: usize = 16;

/// A symmetric arrowhead matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrowhead {
    /// Number of rows.
    len: usize,
    /// Rows of the dense block.
    dense: usize,
    /// Columns of the panels: all where there is a coupling, otherwise those of the dense block.
    columns: usize,
    /// D and E, [`ROWS`] rows at a time, column after column, rows beyond the last zero.
    panels: Vec<[f64; ROWS]>,
    /// T.
    diagonal: Vec<f64>,
}

impl Arrowhead {
    /// The matrix with these entries, row after row; the dense block is the smallest that leaves a diagonal.
    ///
    /// `entries`: symmetric, `len` squared.
    pub fn new(len: usize, entries: &[f64]) -> Arrowhead {
        debug_assert_eq!(entries.len(), len * len);
        let at = |i: usize, j: usize| entries[i * len + j];
        let is_zero =
            |i: usize, mut columns: std::ops::Range<usize>| columns.all(|j| at(i, j) == 0.0);
        // rows without a coupling, and without one among each other: of the two forms the smaller one
        let alone = |i: &usize| is_zero(*i, 0..*i) && is_zero(*i, *i + 1..len);
        let uncoupled = len - (0..len).rev().take_while(alone).count();
        let apart = |i: &usize| is_zero(*i, *i + 1..len);
        let coupled = len - (0..len).rev().take_while(apart).count();
        let numbers = |rows: usize, columns: usize| rows.div_ceil(ROWS) * columns;
        let (dense, columns) = match numbers(uncoupled, uncoupled) <= numbers(coupled, len) {
            true => (uncoupled, uncoupled),
            false => (coupled, len),
        };
        let panel = |first: usize| {
            (0..columns).map(move |j| {
                std::array::from_fn(|lane| match first + lane < dense {
                    true => at(first + lane, j),
                    false => 0.0,
                })
            })
        };
        Arrowhead {
            len,
            dense,
            columns,
            panels: (0..dense).step_by(ROWS).flat_map(panel).collect(),
            diagonal: (dense..len).map(|i| at(i, i)).collect(),
        }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether it has no row.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Numbers stored, zeros that fill the last panel included.
    pub fn stored(&self) -> usize {
        ROWS * self.panels.len() + self.diagonal.len()
    }

    /// Entry (i, j).
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let (row, column) = (i.min(j), i.max(j));
        match (row < self.dense, column < self.columns) {
            (true, true) => self.panels[row / ROWS * self.columns + column][row % ROWS],
            (true, false) => 0.0,
            (false, _) if row == column => self.diagonal[row - self.dense],
            (false, _) => 0.0,
        }
    }

    /// Visits parts of the entries of A x by row: a row may come several times, and its entry is the sum. `x`: by row.
    pub fn each_product(&self, x: impl Fn(usize) -> f64, visit: impl FnMut(usize, f64)) {
        Arch::new().dispatch(
            #[inline(always)]
            || self.products(x, visit),
        );
    }

    #[inline(always)]
    fn products(&self, x: impl Fn(usize) -> f64, mut visit: impl FnMut(usize, f64)) {
        let panels = self.panels.chunks_exact(self.columns.max(1));
        for (first, panel) in (0..self.dense).step_by(ROWS).zip(panels) {
            let rows = ROWS.min(self.dense - first);
            let (own, coupling) = panel.split_at(self.dense);
            let mut sums = [0.0; ROWS];
            for (j, column) in own.iter().enumerate() {
                add_scaled(x(j), column, &mut sums);
            }
            let mut of_rows = [0.0; ROWS];
            if !coupling.is_empty() {
                let entries = of_rows.iter_mut().take(rows).enumerate();
                entries.for_each(|(lane, of)| *of = x(first + lane));
            }
            for (j, column) in (self.dense..).zip(coupling) {
                add_scaled(x(j), column, &mut sums);
                visit(j, dot(column, &of_rows));
            }
            for (lane, sum) in sums.iter().enumerate().take(rows) {
                visit(first + lane, *sum);
            }
        }
        for (j, entry) in (self.dense..).zip(&self.diagonal) {
            visit(j, entry * x(j));
        }
    }
}

/// y += factor x.
#[inline(always)]
fn add_scaled(factor: f64, x: &[f64; ROWS], y: &mut [f64; ROWS]) {
    for lane in 0..ROWS {
        y[lane] += factor * x[lane];
    }
}

/// x · y, lanes added by halves.
#[inline(always)]
fn dot(x: &[f64; ROWS], y: &[f64; ROWS]) -> f64 {
    let mut products = [0.0; ROWS];
    for lane in 0..ROWS {
        products[lane] = x[lane] * y[lane];
    }
    let mut half = ROWS / 2;
    while half > 0 {
        for lane in 0..half {
            products[lane] += products[lane + half];
        }
        half /= 2;
    }
    products[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integers, so that products are exact in any order: a dense block, a coupling or none, a diagonal.
    fn entries(len: usize, dense: usize, coupled: bool) -> Vec<f64> {
        let entry = |k: usize| {
            let (i, j) = ((k / len).min(k % len), (k / len).max(k % len));
            let value = 1.0 + ((31 * i + 17 * j) % 23) as f64;
            match (i < dense, j < dense || i == j || i < dense && coupled) {
                (_, false) => 0.0,
                (true, true) => value,
                (false, true) if i == j => value,
                (false, true) => 0.0,
            }
        };
        (0..len * len).map(entry).collect()
    }

    #[test]
    fn products_and_entries_are_those_of_the_full_matrix() {
        for (len, dense, coupled) in [
            (0, 0, false),
            (1, 1, false),
            (5, 0, false),
            (16, 16, false),
            (37, 27, true),
            (37, 27, false),
            (40, 32, true),
            (19, 3, true),
        ] {
            let full = entries(len, dense, coupled);
            let matrix = Arrowhead::new(len, &full);
            let x: Vec<f64> = (0..len).map(|i| (i % 7) as f64 - 3.0).collect();
            let mut y = vec![0.0; len];
            matrix.each_product(|j| x[j], |i, part| y[i] += part);
            for i in 0..len {
                let exact: f64 = (0..len).map(|j| full[i * len + j] * x[j]).sum();
                assert_eq!(y[i], exact, "{len} {dense} {coupled}, row {i}");
                (0..len).for_each(|j| assert_eq!(matrix.get(i, j), full[i * len + j]));
            }
            assert_eq!((matrix.len(), matrix.is_empty()), (len, len == 0));
        }
    }

    #[test]
    fn nothing_is_stored_of_the_zeros_beside_the_diagonal() {
        let stored = |dense, coupled| Arrowhead::new(48, &entries(48, dense, coupled)).stored();
        assert_eq!(stored(32, false), 32 * 32 + 16);
        assert_eq!(stored(32, true), 32 * 48 + 16);
        assert_eq!(stored(0, false), 48);
    }
}
