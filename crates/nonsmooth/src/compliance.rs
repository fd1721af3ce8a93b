//! The condensed compliance D of an interface problem: all entries, or the sparse rows that it is a product of.

use std::cell::RefCell;

use carom_algebra::solver::Saddle;

use crate::Lumped;

/// D, symmetric and positive semi-definite, in x per N.
#[derive(Clone, Copy)]
pub enum Compliance<'a> {
    /// All entries, row-major: of few points, or where a factor couples them all.
    Dense(&'a [f64]),
    /// `D = N M⁻¹ Nᵀ` with sparse N and diagonal M.
    Lumped(&'a Lumped),
    /// `D = N A⁻¹ Nᵀ` with A whose columns nobody computes: forces and motion are found together, by iterations. As its entries over the rows of a
    /// point count those with the blocks of nodes of A in place of A, which measure what a force moves, but are no part of the equations.
    Iterated(&'a RefCell<Saddle>),
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
            Compliance::Iterated(_) => None,
        }
    }
}
