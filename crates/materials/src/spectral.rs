//! Eigenvalues and eigenvectors of a symmetric matrix of three rows.

use carom_algebra::tensor::Mat3;

/// Most passes over the three off-diagonal entries; each squares what is left of them, so that five are the usual number.
const PASSES: usize = 20;

/// A = N diag(λ) Nᵀ of a symmetric A: the eigenvalues in no order, the eigenvectors as columns of N, orthonormal also where
/// eigenvalues coincide. Rotations of Jacobi (Golub and Van Loan (2013), Matrix Computations, 8.5): errors of an eigenvalue are
/// round-off of |A|.
pub(crate) fn spectral(a: &Mat3) -> ([f64; 3], Mat3) {
    let (mut a, mut n) = (*a, Mat3::identity());
    for _ in 0..PASSES {
        let off = a[(0, 1)].abs() + a[(1, 2)].abs() + a[(0, 2)].abs();
        if off <= 1e-18 * (a[(0, 0)].abs() + a[(1, 1)].abs() + a[(2, 2)].abs()) {
            break;
        }
        rotate(&mut a, &mut n, (0, 1, 2));
        rotate(&mut a, &mut n, (1, 2, 0));
        rotate(&mut a, &mut n, (0, 2, 1));
    }
    ([a[(0, 0)], a[(1, 1)], a[(2, 2)]], n)
}

/// Turns the axes p and q so that A_pq, with its partner, becomes zero; r is the third axis.
#[inline(always)]
fn rotate(a: &mut Mat3, n: &mut Mat3, (p, q, r): (usize, usize, usize)) {
    let apart = a[(p, q)];
    if apart == 0.0 {
        return;
    }
    let cotangent = (a[(q, q)] - a[(p, p)]) / (2.0 * apart);
    let tangent =
        1.0_f64.copysign(cotangent) / (cotangent.abs() + (cotangent * cotangent + 1.0).sqrt());
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    let sine = tangent * cosine;
    a[(p, p)] -= tangent * apart;
    a[(q, q)] += tangent * apart;
    let (rp, rq) = (a[(r, p)], a[(r, q)]);
    let turned = (cosine * rp - sine * rq, sine * rp + cosine * rq);
    (a[(p, q)], a[(q, p)]) = (0.0, 0.0);
    (a[(r, p)], a[(p, r)]) = (turned.0, turned.0);
    (a[(r, q)], a[(q, r)]) = (turned.1, turned.1);
    for i in 0..3 {
        let (np, nq) = (n[(i, p)], n[(i, q)]);
        (n[(i, p)], n[(i, q)]) = (cosine * np - sine * nq, sine * np + cosine * nq);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_testing::Random;

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
                let (lambda, n) = spectral(&a);
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
