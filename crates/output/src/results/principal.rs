//! Principal values.

use carom_algebra::tensor::Mat3;

/// The principal values of a symmetric tensor, the largest first.
pub(crate) fn principal(tensor: &Mat3) -> [f64; 3] {
    // iterations on what is no number have no end
    if !tensor.iter().all(|component| component.is_finite()) {
        return [f64::NAN; 3];
    }
    let mut values: [f64; 3] = tensor.symmetric_eigenvalues().into();
    values.sort_by(|a, b| b.total_cmp(a));
    values
}
