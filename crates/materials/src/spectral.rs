//! Eigenvalues and eigenvectors of a symmetric matrix of three rows.

use carom_algebra::number::Number;

use crate::tensor::{Tensor, plus_unit};

/// Most passes over the three off-diagonal entries; each squares what is left of them, so that five are the usual number.
const PASSES: usize = 20;

/// A = N diag(λ) Nᵀ of a symmetric A: the eigenvalues in no order, the eigenvectors as columns of N, orthonormal also where
/// eigenvalues coincide. Rotations of Jacobi (Golub and Van Loan (2013), Matrix Computations, 8.5): errors of an eigenvalue are
/// round-off of |A|. Passes go on until all lanes are done.
#[inline(always)]
pub(crate) fn spectral<T: Number>(a: &Tensor<T>) -> ([T; 3], Tensor<T>) {
    let zero = a[0][0].like(0.0);
    let (mut a, mut n) = (*a, plus_unit(&[[zero; 3]; 3], zero.like(1.0)));
    for _ in 0..PASSES {
        let off = a[0][1].abs() + a[1][2].abs() + a[0][2].abs();
        let size = a[0][0].abs() + a[1][1].abs() + a[2][2].abs();
        let left = (off - size.scale(1e-18)).largest();
        if left <= 0.0 || left.is_nan() {
            break;
        }
        rotate::<T, 0, 1, 2>(&mut a, &mut n);
        rotate::<T, 1, 2, 0>(&mut a, &mut n);
        rotate::<T, 0, 2, 1>(&mut a, &mut n);
    }
    ([a[0][0], a[1][1], a[2][2]], n)
}

/// Turns the axes P and Q so that A_pq, with its partner, becomes zero; R is the third axis. The tangent of the angle is
/// 2 A_pq sign(d)/(|d| + sqrt(d² + 4 A_pq²)), d = A_qq - A_pp.
#[inline(always)]
fn rotate<T: Number, const P: usize, const Q: usize, const R: usize>(
    a: &mut Tensor<T>,
    n: &mut Tensor<T>,
) {
    let apart = a[P][Q];
    let (zero, one) = (apart.like(0.0), apart.like(1.0));
    let difference = a[Q][Q] - a[P][P];
    let twice = apart.scale(2.0);
    let root = twice.mul_add(twice, difference * difference).sqrt();
    let signed = difference.if_below(zero, -twice, twice);
    let tangent = signed / (difference.abs() + root).most(apart.like(f64::MIN_POSITIVE));
    let cosine = one / tangent.mul_add(tangent, one).sqrt();
    let sine = tangent * cosine;
    let change = tangent * apart;
    a[P][P] -= change;
    a[Q][Q] += change;
    let (rp, rq) = (a[R][P], a[R][Q]);
    let turned = (cosine * rp - sine * rq, sine * rp + cosine * rq);
    (a[P][Q], a[Q][P]) = (zero, zero);
    (a[R][P], a[P][R]) = (turned.0, turned.0);
    (a[R][Q], a[Q][R]) = (turned.1, turned.1);
    turn::<T, P, Q>(&mut n[0], cosine, sine);
    turn::<T, P, Q>(&mut n[1], cosine, sine);
    turn::<T, P, Q>(&mut n[2], cosine, sine);
}

#[inline(always)]
fn turn<T: Number, const P: usize, const Q: usize>(row: &mut [T; 3], cosine: T, sine: T) {
    let (np, nq) = (row[P], row[Q]);
    row[P] = cosine * np - sine * nq;
    row[Q] = sine * np + cosine * nq;
}

#[cfg(test)]
mod tests {
    use carom_algebra::tensor::Mat3;
    use carom_testing::Random;

    use super::*;
    use crate::tensor::{matrix, rows};

    #[test]
    fn the_parts_give_the_matrix_back_also_where_eigenvalues_coincide() {
        let mut random = Random(7);
        for values in [
            [3.0, -1.0, 0.5],
            [2.0, 2.0, 1.0],
            [1.0, 1.0 + 1e-15, 1.0],
            [1.0, 1e-12, 0.0],
        ] {
            for _ in 0..50 {
                let axis = nalgebra::Vector3::from_fn(|_, _| random.next());
                let q = nalgebra::Rotation3::new(axis * 3.0).into_inner();
                let a = q * Mat3::from_diagonal(&values.into()) * q.transpose();
                let a = (a + a.transpose()) * 0.5;
                let (lambda, n) = spectral(&rows(&a));
                let n = matrix(&n);
                // a few dozen roundings of entries of order one
                assert!(
                    (n * Mat3::from_diagonal(&lambda.into()) * n.transpose() - a).amax() < 1e-14
                );
                assert!((n.tr_mul(&n) - Mat3::identity()).amax() < 1e-14);
                let (mut found, mut expected) = (lambda, values);
                found.sort_by(f64::total_cmp);
                expected.sort_by(f64::total_cmp);
                assert!((0..3).all(|i| (found[i] - expected[i]).abs() < 1e-14));
            }
        }
    }
}
