//! A part of a matrix that is taken again and again while the values of the matrix change.

use std::ops::Range;

use crate::csr::Csr;

/// The rows and columns of some unknowns of a matrix, and where its entries come from.
pub struct Part {
    matrix: Csr,
    from: Vec<usize>,
}

impl Part {
    /// [`Csr::part`].
    pub fn new(whole: &Csr, ranges: &[Range<usize>], is_fixed: impl Fn(usize) -> bool) -> Part {
        let (matrix, from) = whole.gathered(ranges, is_fixed);
        Part { matrix, from }
    }

    /// Takes the values of the whole, which must have the pattern that it had.
    pub fn renew(&mut self, whole: &Csr) {
        self.matrix.take_again(whole, &self.from);
    }

    /// The part; what is changed in it is lost when it is taken again.
    pub fn matrix_mut(&mut self) -> &mut Csr {
        &mut self.matrix
    }
}
