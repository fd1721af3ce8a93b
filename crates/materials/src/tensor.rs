//! Tensors of three rows with any [`Number`] as entries.
//!
//! `array::from_fn` would keep lanes from staying in registers (see `carom_algebra::lanes`).

use carom_algebra::number::Number;
use carom_algebra::tensor::Mat3;

/// Rows of a tensor.
pub type Tensor<T> = [[T; 3]; 3];

/// As the matrix type of the linear algebra.
pub(crate) fn matrix(a: &Tensor<f64>) -> Mat3 {
    Mat3::from_fn(|i, j| a[i][j])
}

/// Rows of a matrix.
pub(crate) fn rows(a: &Mat3) -> Tensor<f64> {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| a[(i, j)]))
}

/// A tensor by its entries. Written out and not looped over: a loop over entries is turned into vectors across the entries,
/// with lanes that pass one by one through memory.
macro_rules! entries {
    ($entry:expr) => {{
        let entry = $entry;
        [
            [entry(0, 0), entry(0, 1), entry(0, 2)],
            [entry(1, 0), entry(1, 1), entry(1, 2)],
            [entry(2, 0), entry(2, 1), entry(2, 2)],
        ]
    }};
}

/// A symmetric tensor by its entries on and above the diagonal.
macro_rules! symmetric_entries {
    ($entry:expr) => {{
        let entry = $entry;
        let (xy, yz, xz) = (entry(0, 1), entry(1, 2), entry(0, 2));
        [
            [entry(0, 0), xy, xz],
            [xy, entry(1, 1), yz],
            [xz, yz, entry(2, 2)],
        ]
    }};
}

pub(crate) use {entries, symmetric_entries};

#[inline(always)]
fn three<T: Number>(a: [T; 3], b: [T; 3]) -> T {
    a[2].mul_add(b[2], a[1].mul_add(b[1], a[0] * b[0]))
}

#[inline(always)]
fn column<T: Number>(a: &Tensor<T>, j: usize) -> [T; 3] {
    [a[0][j], a[1][j], a[2][j]]
}

/// A B.
#[inline(always)]
pub fn product<T: Number>(a: &Tensor<T>, b: &Tensor<T>) -> Tensor<T> {
    entries!(|i: usize, j: usize| three(a[i], column(b, j)))
}

/// A Bᵀ.
#[inline(always)]
pub fn product_transposed<T: Number>(a: &Tensor<T>, b: &Tensor<T>) -> Tensor<T> {
    entries!(|i: usize, j: usize| three(a[i], b[j]))
}

/// Aᵀ B.
#[inline(always)]
pub fn transposed_product<T: Number>(a: &Tensor<T>, b: &Tensor<T>) -> Tensor<T> {
    entries!(|i: usize, j: usize| three(column(a, i), column(b, j)))
}

/// A B of symmetric tensors whose product is symmetric.
#[inline(always)]
pub fn symmetric_product<T: Number>(a: &Tensor<T>, b: &Tensor<T>) -> Tensor<T> {
    symmetric_entries!(|i: usize, j: usize| three(a[i], column(b, j)))
}

/// Cofactors, det(A) A⁻ᵀ.
#[inline(always)]
pub fn cofactor<T: Number>(a: &Tensor<T>) -> Tensor<T> {
    entries!(|i: usize, j: usize| {
        let (p, q, r, s) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        a[p][r] * a[q][s] - a[p][s] * a[q][r]
    })
}

/// det(A).
#[inline(always)]
pub fn determinant<T: Number>(a: &Tensor<T>) -> T {
    let minor = |j: usize, k: usize| a[1][j] * a[2][k] - a[1][k] * a[2][j];
    let last = a[0][2] * minor(0, 1);
    a[0][0].mul_add(minor(1, 2), a[0][1].mul_add(minor(2, 0), last))
}

/// det(I + H) - 1 = tr H + the sum of the principal minors of two rows + det H.
#[inline(always)]
pub fn determinant_less_1<T: Number>(h: &Tensor<T>) -> T {
    let minor = |i: usize, j: usize| h[i][i] * h[j][j] - h[i][j] * h[j][i];
    let upper = |j: usize, k: usize| h[1][j] * h[2][k] - h[1][k] * h[2][j];
    let det = h[0][0] * upper(1, 2) + h[0][1] * upper(2, 0) + h[0][2] * upper(0, 1);
    (h[0][0] + h[1][1] + h[2][2]) + (minor(0, 1) + minor(1, 2) + minor(0, 2)) + det
}

/// A_11 + A_22 + A_33.
#[inline(always)]
pub fn trace<T: Number>(a: &Tensor<T>) -> T {
    a[0][0] + a[1][1] + a[2][2]
}

/// A : B.
#[inline(always)]
pub fn double<T: Number>(a: &Tensor<T>, b: &Tensor<T>) -> T {
    three(a[0], b[0]) + three(a[1], b[1]) + three(a[2], b[2])
}

/// factor · A.
#[inline(always)]
pub fn scaled<T: Number>(a: &Tensor<T>, factor: T) -> Tensor<T> {
    entries!(|i: usize, j: usize| a[i][j] * factor)
}

/// A + factor · B.
#[inline(always)]
pub fn plus<T: Number>(a: &Tensor<T>, factor: T, b: &Tensor<T>) -> Tensor<T> {
    entries!(|i: usize, j: usize| b[i][j].mul_add(factor, a[i][j]))
}

/// A + factor · I.
#[inline(always)]
pub fn plus_unit<T: Number>(a: &Tensor<T>, factor: T) -> Tensor<T> {
    [
        [a[0][0] + factor, a[0][1], a[0][2]],
        [a[1][0], a[1][1] + factor, a[1][2]],
        [a[2][0], a[2][1], a[2][2] + factor],
    ]
}

/// Green-Lagrange strain E = (H + Hᵀ + HᵀH)/2 of F = I + H: no digit is lost where F is near I.
#[inline(always)]
pub fn green_lagrange<T: Number>(h: &Tensor<T>) -> Tensor<T> {
    symmetric_entries!(|i: usize, j: usize| {
        let square = three(column(h, i), column(h, j));
        (h[i][j] + h[j][i] + square).scale(0.5)
    })
}

/// The symmetric tensor of six numbers of a history: 11, 22, 33, 12, 23, 13.
#[inline(always)]
pub(crate) fn unpack<T: Number>(v: &[T]) -> Tensor<T> {
    [[v[0], v[3], v[5]], [v[3], v[1], v[4]], [v[5], v[4], v[2]]]
}

/// Writes a symmetric tensor as the six numbers 11, 22, 33, 12, 23, 13.
#[inline(always)]
pub(crate) fn pack<T: Number>(a: &Tensor<T>, out: &mut [T]) {
    out[0] = a[0][0];
    out[1] = a[1][1];
    out[2] = a[2][2];
    out[3] = a[0][1];
    out[4] = a[1][2];
    out[5] = a[0][2];
}
