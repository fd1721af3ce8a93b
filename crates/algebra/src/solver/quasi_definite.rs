//! Sparse factorisation K = Pᵀ L D Lᵀ P of a symmetric quasi-definite matrix `[A, -Cᵀ; -C, -D]`, with A positive definite
//! and D positive semi-definite: multipliers joined to the unknowns that they act on.
//!
//! No pivoting: each multiplier is eliminated in the group of a node that it constrains, after the unknowns of that node,
//! where its pivot is negative (Vanderbei 1995 for D > 0). The factor and its solves are faer's, by one thread.

use super::supernodal::{Lower, Symbolic, analyse};
use crate::ordering::{self, Ordering};
use crate::{Error, csr::Csr};
use faer::{
    Conj, MatMut, Par,
    dyn_stack::{MemBuffer, MemStack},
    linalg::cholesky::ldlt::factor::{LdltError, LdltRegularization},
    sparse::linalg::cholesky::supernodal::{
        SupernodalLdltRef, factorize_supernodal_numeric_ldlt,
        factorize_supernodal_numeric_ldlt_scratch,
    },
    sparse::{SparseColMatRef, SymbolicSparseColMatRef},
};

/// Factor of a symmetric quasi-definite matrix.
pub struct QuasiDefinite {
    /// Position in the factor to unknown: `connected` unknowns of the factor, then those without neighbours.
    permutation: Vec<u32>,
    connected: usize,
    symbolic: Symbolic,
    values: Vec<f64>,
    /// Diagonal entries of the unknowns without neighbours.
    isolated: Vec<f64>,
    y: Vec<f64>,
    memory: MemBuffer,
}

impl QuasiDefinite {
    /// Factorises a symmetric matrix; `negative`: first unknown of the negative block, to the end.
    ///
    /// `group_of[i]`: node of unknown i, for a multiplier that of a node which it constrains. Entries of the diagonal must be
    /// stored, zeros too.
    ///
    /// # Errors
    /// A pivot that vanishes or has the wrong sign, which is that of redundant multipliers; entries that are not finite; a
    /// lack of memory.
    pub fn new(matrix: &Csr, group_of: &[u32], negative: usize) -> Result<Self, Error> {
        let factor = Self::of(matrix, group_of)?;
        factor.check(matrix, negative)?;
        Ok(factor)
    }

    /// Number of negative eigenvalues of a symmetric matrix: that of its negative pivots, by Sylvester's law of inertia.
    ///
    /// Entries of the diagonal must be stored. Pivots are taken in their order: a matrix with a leading block that is nearly
    /// singular loses digits, and with them perhaps a sign.
    ///
    /// # Errors
    /// A pivot that vanishes; entries that are not finite; a lack of memory.
    pub fn negative_eigenvalues(matrix: &Csr, group_of: &[u32]) -> Result<usize, Error> {
        let factor = Self::of(matrix, group_of)?;
        let alone = factor.isolated.iter().filter(|d| **d < 0.0).count();
        let connected = factor.pivots().filter(|(_, pivot)| *pivot < 0.0).count();
        Ok(alone + connected)
    }

    fn of(matrix: &Csr, group_of: &[u32]) -> Result<Self, Error> {
        let order = Ordering::new(matrix, group_of, None)?;
        let (connected, permutation) = (order.connected, order.permutation);
        let position = ordering::inverse(matrix.n, &permutation);
        let symbolic = analyse(matrix, &permutation[..connected], &position)?;
        let lower = Lower::new(matrix, &permutation[..connected], &position)?;
        let isolated = permutation[connected..]
            .iter()
            .map(|&i| matrix.get(i as usize, i as usize));
        let mut factor = Self {
            isolated: isolated.collect(),
            values: vec![0.0; symbolic.len_val()],
            y: vec![0.0; connected],
            memory: MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq)),
            permutation,
            connected,
            symbolic,
        };
        factor.factorise(&lower)?;
        Ok(factor)
    }

    fn factorise(&mut self, lower: &Lower) -> Result<(), Error> {
        let n = self.connected;
        let pattern =
            SymbolicSparseColMatRef::new_unsorted_checked(n, n, &lower.col_ptr, None, &lower.row);
        let matrix = SparseColMatRef::new(pattern, &lower.values[..]);
        let requirement = factorize_supernodal_numeric_ldlt_scratch::<usize, f64>(
            &self.symbolic,
            Par::Seq,
            Default::default(),
        );
        let mut memory = MemBuffer::try_new(requirement).map_err(|_| Error::Analysis {
            unknowns: n,
            reason: "out of memory".into(),
        })?;
        let done = factorize_supernodal_numeric_ldlt(
            &mut self.values,
            matrix,
            LdltRegularization::default(),
            &self.symbolic,
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        );
        done.map(|_| ()).map_err(|LdltError::ZeroPivot { index }| {
            let unknown = self.permutation[index.min(n.saturating_sub(1))] as usize;
            Error::NotPositiveDefinite {
                unknown,
                diagonal: 0.0,
            }
        })
    }

    /// Unknowns of the factor, and their pivots or the inverses of these.
    fn pivots(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let first = self.symbolic.col_ptr_for_val();
        (0..self.symbolic.n_supernodes()).flat_map(move |s| {
            let columns = self.symbolic.supernode_begin()[s]..self.symbolic.supernode_end()[s];
            let rows = (first[s + 1] - first[s]) / columns.len();
            let pivot = move |(k, column): (usize, usize)| {
                let pivot = self.values[first[s] + k * rows + k];
                (self.permutation[column] as usize, pivot)
            };
            columns.enumerate().map(pivot)
        })
    }

    /// Signs of the pivots: positive above, negative for multipliers.
    fn check(&self, matrix: &Csr, negative: usize) -> Result<(), Error> {
        let wrong = |(unknown, pivot): &(usize, f64)| {
            let sign = if *unknown < negative { 1.0 } else { -1.0 };
            !(pivot * sign > 0.0 && pivot.is_finite())
        };
        match self.pivots().find(wrong) {
            None => Ok(()),
            Some((unknown, _)) => Err(Error::NotPositiveDefinite {
                unknown,
                diagonal: matrix.get(unknown, unknown),
            }),
        }
    }

    /// x ← K⁻¹ x; no allocation.
    pub fn solve(&mut self, x: &mut [f64]) {
        for (y, &i) in self.y.iter_mut().zip(&self.permutation) {
            *y = x[i as usize];
        }
        let factor = SupernodalLdltRef::new(&self.symbolic, &self.values[..]);
        let rhs = MatMut::from_column_major_slice_mut(&mut self.y, self.connected, 1);
        factor.solve_in_place_with_conj(Conj::No, rhs, Par::Seq, MemStack::new(&mut self.memory));
        for (y, &i) in self.y.iter().zip(&self.permutation) {
            x[i as usize] = *y;
        }
        let alone = self.permutation[self.connected..].iter();
        for (&i, d) in alone.zip(&self.isolated) {
            x[i as usize] /= d;
        }
    }

    /// Bytes held by the factor.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.values)
            + size_of_val(&*self.permutation)
            + size_of_val(self.symbolic.row_idx())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pattern::Cliques;

    #[test]
    fn multipliers_without_a_diagonal_are_solved_to_rounding() {
        // a chain of springs on the ground, its two ends tied to each other and its middle to the first: K x = b
        let n = 9;
        let rows: [&[(usize, f64)]; 2] = [&[(0, 1.0), (n - 1, -1.0)], &[(n / 2, 1.0), (0, -0.5)]];
        let mut cliques = Cliques::new();
        (0..n - 1).for_each(|i| cliques.push(&[i as u32, i as u32 + 1]));
        for (k, row) in rows.iter().enumerate() {
            row.iter()
                .for_each(|(i, _)| cliques.push(&[*i as u32, (n + k) as u32]));
        }
        let mut matrix = Csr::from_cliques(n + 2, &cliques);
        for i in 0..n {
            matrix.add(i, i, 2.5);
        }
        for i in 0..n - 1 {
            matrix.add(i, i + 1, -1.0);
            matrix.add(i + 1, i, -1.0);
        }
        for (k, row) in rows.iter().enumerate() {
            for &(i, c) in row.iter() {
                matrix.add(i, n + k, -c);
                matrix.add(n + k, i, -c);
            }
        }
        let mut groups: Vec<u32> = (0..n as u32).collect();
        groups.extend([0, n as u32 / 2]);
        let mut factor = QuasiDefinite::new(&matrix, &groups, n).unwrap();
        let exact: Vec<f64> = (0..n + 2).map(|i| (1.0 + i as f64).sin()).collect();
        let mut x = vec![0.0; n + 2];
        matrix.multiply(&exact, &mut x);
        factor.solve(&mut x);
        for (x, exact) in x.iter().zip(&exact) {
            assert!((x - exact).abs() < 1e-13);
        }
    }

    #[test]
    fn a_row_that_stands_twice_is_refused() {
        let mut cliques = Cliques::new();
        cliques.push(&[0, 1]);
        cliques.push(&[0, 2]);
        let mut matrix = Csr::from_cliques(3, &cliques);
        matrix.add(0, 0, 1.0);
        for k in [1, 2] {
            matrix.add(0, k, -1.0);
            matrix.add(k, 0, -1.0);
        }
        assert!(QuasiDefinite::new(&matrix, &[0, 0, 0], 1).is_err());
    }
}
