//! Calls of faer: the supernodal structure of a factor, of the matrix in the order of elimination, restricted to the unknowns that have
//! neighbours.

use crate::{Error, csr::Csr};
use faer::{
    dyn_stack::{MemBuffer, MemStack, StackReq},
    sparse::SymbolicSparseColMatRef,
    sparse::linalg::{
        SymbolicSupernodalParams,
        cholesky::{simplicial, supernodal},
    },
};

/// Supernodes of a factor.
pub(super) type Symbolic = supernodal::SymbolicSupernodalCholesky<usize>;

/// Lower triangle of the permuted matrix by columns.
pub(super) struct Lower {
    pub(super) col_ptr: Vec<usize>,
    pub(super) row: Vec<usize>,
    pub(super) values: Vec<f64>,
}

impl Lower {
    pub fn new(matrix: &Csr, connected: &[u32], position: &[u32]) -> Result<Self, Error> {
        let mut lower = Self {
            col_ptr: vec![0],
            row: vec![],
            values: vec![],
        };
        for (k, &unknown) in connected.iter().enumerate() {
            let (columns, values) = matrix.row(unknown as usize);
            for (&j, &value) in columns.iter().zip(values) {
                if !value.is_finite() {
                    return Err(Error::NotFinite {
                        row: unknown as usize,
                        column: j as usize,
                        value,
                    });
                }
                let i = position[j as usize] as usize;
                if i >= k {
                    lower.row.push(i);
                    lower.values.push(value);
                }
            }
            lower.col_ptr.push(lower.row.len());
        }
        Ok(lower)
    }
}

/// Supernodes of the factor of the permuted matrix.
pub(super) fn analyse(
    matrix: &Csr,
    connected: &[u32],
    position: &[u32],
) -> Result<Symbolic, Error> {
    let n = connected.len();
    let (mut col_ptr, mut row) = (vec![0], vec![]);
    for (k, &unknown) in connected.iter().enumerate() {
        let columns = matrix.row(unknown as usize).0.iter();
        row.extend(
            columns
                .map(|&j| position[j as usize] as usize)
                .filter(|&i| i <= k),
        );
        col_ptr.push(row.len());
    }
    let upper = SymbolicSparseColMatRef::new_unsorted_checked(n, n, &col_ptr, None, &row);
    let requirement = StackReq::any_of(&[
        simplicial::prefactorize_symbolic_cholesky_scratch::<usize>(n, row.len()),
        supernodal::factorize_supernodal_symbolic_cholesky_scratch::<usize>(n),
    ]);
    let failed = |reason: &dyn std::fmt::Display| Error::Analysis {
        unknowns: n,
        reason: reason.to_string(),
    };
    let mut memory = MemBuffer::try_new(requirement).map_err(|_| failed(&"out of memory"))?;
    let stack = MemStack::new(&mut memory);
    let (mut tree, mut counts) = (vec![0isize; n], vec![0usize; n]);
    let tree = simplicial::prefactorize_symbolic_cholesky(&mut tree, &mut counts, upper, stack);
    supernodal::factorize_supernodal_symbolic_cholesky(
        upper,
        tree,
        &counts,
        stack,
        SymbolicSupernodalParams::default(),
    )
    .map_err(|error| failed(&error))
}
