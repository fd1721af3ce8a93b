//! Where stresses are looked for, and how they compare.

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::Mat3;

/// Displacements (m) and rotations of the system, and the history of the body.
#[derive(Clone, Copy, Debug)]
pub struct StressedState<'a> {
    /// Displacements, m.
    pub u: &'a [f64],
    /// Rotations of the nodes.
    pub frames: &'a [Rotation],
    /// Of this body.
    pub history: &'a [f64],
}

/// The larger of two values, the one with the smaller number if they are equal.
pub(super) fn larger(one: (f64, u32), other: (f64, u32)) -> (f64, u32) {
    match other.0 > one.0 || other.0 == one.0 && other.1 < one.1 {
        true => other,
        false => one,
    }
}

/// Equivalent stress of von Mises, √(½ Σ (σ_ii - σ_jj)² + 3 Σ τ²), Pa.
pub(super) fn von_mises(s: &Mat3) -> f64 {
    let normal = (s[(0, 0)] - s[(1, 1)]).powi(2)
        + (s[(1, 1)] - s[(2, 2)]).powi(2)
        + (s[(2, 2)] - s[(0, 0)]).powi(2);
    let shear = s[(0, 1)].powi(2) + s[(1, 2)].powi(2) + s[(0, 2)].powi(2);
    (0.5 * normal + 3.0 * shear).sqrt()
}
