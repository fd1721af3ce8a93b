//! Hinges: rotations at an end of an element that are not those of its node.
//!
//! A released rotation takes the value at which the element has no moment there, `u_r = -K_rr⁻¹ K_rk u_k`. With that as a part of
//! `u = T u_k` the element has Tᵀ K T and Tᵀ M T over the unknowns of its nodes (static condensation, Guyan 1965): exact at rest, and in
//! motion of the order of the element.

use super::element::Matrix;

/// Pivot over the diagonal below which a released rotation is that of a mechanism.
const MECHANISM: f64 = 1e-10;

/// T: all unknowns by those that are kept, with zeros in the columns of the released ones; none for a mechanism.
pub(super) fn transformation(k: &Matrix, released: &[bool; 12]) -> Option<Box<Matrix>> {
    let out: Vec<usize> = (0..12).filter(|&i| released[i]).collect();
    let mut rows = *k;
    for (place, &r) in out.iter().enumerate() {
        let pivot = rows[r][r];
        if pivot <= MECHANISM * k[r][r] || k[r][r] == 0.0 {
            return None;
        }
        let own = rows[r].map(|value| value / pivot);
        rows[r] = own;
        for (other, &i) in out.iter().enumerate() {
            let factor = rows[i][r];
            if other != place {
                for (value, own) in rows[i].iter_mut().zip(own) {
                    *value -= factor * own;
                }
            }
        }
    }
    let mut t = Box::new([[0.0; 12]; 12]);
    for (i, row) in t.iter_mut().enumerate() {
        match released[i] {
            false => row[i] = 1.0,
            true => {
                for (j, value) in row.iter_mut().enumerate().filter(|(j, _)| !released[*j]) {
                    *value = -rows[i][j];
                }
            }
        }
    }
    Some(t)
}

/// Tᵀ A T.
pub(super) fn condensed(a: &Matrix, t: &Matrix) -> Matrix {
    let (mut half, mut whole) = ([[0.0; 12]; 12], [[0.0; 12]; 12]);
    for i in 0..12 {
        for k in (0..12).filter(|&k| a[i][k] != 0.0) {
            for j in 0..12 {
                half[i][j] += a[i][k] * t[k][j];
            }
        }
    }
    for k in 0..12 {
        for i in (0..12).filter(|&i| t[k][i] != 0.0) {
            for j in 0..12 {
                whole[i][j] += t[k][i] * half[k][j];
            }
        }
    }
    whole
}
