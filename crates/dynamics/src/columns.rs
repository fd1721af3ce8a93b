//! Columns of a symmetric matrix at the unknowns that supports hold: what a motion of supports does to all others.

use carom_algebra::csr::Csr;

/// Columns of a symmetric matrix, each with its unknown.
#[derive(Default)]
pub(crate) struct HeldColumns {
    unknowns: Vec<u32>,
    /// Where the entries of each column end.
    ends: Vec<usize>,
    rows: Vec<u32>,
    values: Vec<f64>,
}

impl HeldColumns {
    /// Appends the columns of the held unknowns of a part, whose first unknown is `first`; entries that are zero are left out.
    pub(crate) fn append(&mut self, matrix: &Csr, fixed: &[bool], first: usize) {
        for held in (0..matrix.n).filter(|&unknown| fixed[unknown]) {
            let (rows, values) = matrix.row(held);
            for (&row, &value) in rows.iter().zip(values).filter(|(_, value)| **value != 0.0) {
                self.rows.push(first as u32 + row);
                self.values.push(value);
            }
            self.unknowns.push((first + held) as u32);
            self.ends.push(self.rows.len());
        }
    }

    /// Appends the columns of the held unknowns of a part whose matrix is a diagonal.
    pub(crate) fn append_diagonal(&mut self, diagonal: &[f64], fixed: &[bool], first: usize) {
        for held in (0..diagonal.len()).filter(|&unknown| fixed[unknown]) {
            self.rows.push((first + held) as u32);
            self.values.push(diagonal[held]);
            self.unknowns.push((first + held) as u32);
            self.ends.push(self.rows.len());
        }
    }

    /// Adds A x to `y` for an x, a system vector, that is zero where nothing is held.
    pub(crate) fn add_product(&self, x: &[f64], y: &mut [f64]) {
        for (held, rows, values) in self.each() {
            let x = x[held];
            if x != 0.0 {
                for (&row, value) in rows.iter().zip(values) {
                    y[row as usize] += value * x;
                }
            }
        }
    }

    /// Writes the entries of A x at the held unknowns into `y`, both system vectors.
    pub(crate) fn product_at_held(&self, x: &[f64], y: &mut [f64]) {
        for (held, rows, values) in self.each() {
            let terms = rows.iter().zip(values);
            y[held] = terms.map(|(&row, value)| value * x[row as usize]).sum();
        }
    }

    /// Unknown, rows and values of each column.
    fn each(&self) -> impl Iterator<Item = (usize, &[u32], &[f64])> {
        let starts = std::iter::once(&0).chain(&self.ends);
        let columns = self.unknowns.iter().zip(starts.zip(&self.ends));
        columns.map(|(&held, (&begin, &end))| {
            let entries = begin..end;
            (
                held as usize,
                &self.rows[entries.clone()],
                &self.values[entries],
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_algebra::pattern::Cliques;

    #[test]
    fn products_with_held_columns_are_those_of_the_matrix() {
        let mut cliques = Cliques::new();
        (1..6).for_each(|i| cliques.push(&[i - 1, i]));
        let mut matrix = Csr::from_cliques(6, &cliques);
        for i in 1..6_u32 {
            let k = f64::from(i);
            matrix.add_block(&[i - 1, i], &[k, -k, -k, k]);
        }
        let fixed = [false, true, false, false, false, true];
        let mut columns = HeldColumns::default();
        columns.append(&matrix, &fixed, 2);
        let whole = |x: &[f64]| {
            let mut y = vec![0.0; 6];
            matrix.multiply(x, &mut y);
            y
        };
        let moved = [0.0, 3.0, 0.0, 0.0, 0.0, -2.0];
        let mut y = [1.0; 8];
        columns.add_product(&[&[9.0; 2], &moved[..]].concat(), &mut y);
        let exact: Vec<f64> = whole(&moved).iter().map(|y| 1.0 + y).collect();
        assert_eq!(y[2..], exact);
        let x = [1.0, -2.0, 4.0, 0.5, 3.0, 7.0];
        let mut y = [0.0; 8];
        columns.product_at_held(&[&[9.0; 2], &x[..]].concat(), &mut y);
        let exact = whole(&x);
        assert_eq!(y, [0.0, 0.0, 0.0, exact[1], 0.0, 0.0, 0.0, exact[5]]);
    }
}
