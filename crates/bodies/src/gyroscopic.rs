//! The moment of a spinning inertia, W × J W, about axes that turn with it, along which J is diagonal.

use carom_algebra::csr::Csr;
use carom_algebra::tensor::{Mat3, Vec3};

/// W of three unknowns of a system vector from `first` on, rad/s.
fn spin((v, first): (&[f64], usize)) -> Vec3 {
    Vec3::new(v[first], v[first + 1], v[first + 2])
}

/// Adds W × J W (N m) to the three entries of a system vector from `first` on. `moments`: of inertia, kg m²; `v`: system vector of rates.
pub(crate) fn add_moment(moments: &[f64; 3], (v, first): (&[f64], usize), f: &mut [f64]) {
    let w = spin((v, first));
    let moment = w.cross(&Vec3::from(*moments).component_mul(&w));
    for (f, moment) in f[first..].iter_mut().zip(moment.iter()) {
        *f += moment;
    }
}

/// Adds `by_v` times the symmetric part of its derivative by W, Ŵ J - (J W)^, whose second term has none.
pub(crate) fn add_slope(
    moments: &[f64; 3],
    (v, first): (&[f64], usize),
    by_v: f64,
    matrix: &mut Csr,
) {
    let slope = spin((v, first)).cross_matrix() * Mat3::from_diagonal(&Vec3::from(*moments));
    for i in 0..3 {
        for j in 0..3 {
            let mean = 0.5 * (slope[(i, j)] + slope[(j, i)]);
            matrix.add(first + i, first + j, by_v * mean);
        }
    }
}
