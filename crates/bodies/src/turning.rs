//! Nodes with finite rotations: how their increments turn directions, and how moments in space act on them.

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::{Mat3, Vec3};

/// Moments about the axes at the start of a step in those in which they balance: A z of forces over the step, `cay(θ)ᵀ z` of others.
pub fn balanced(moment: &Vec3, increment: &Vec3, between: bool) -> Vec3 {
    match between {
        true => moment - (increment * 0.5).cross(moment),
        false => Rotation::cayley(increment).matrix().tr_mul(moment),
    }
}

/// What a change of the increment θ turns in space: R (I + θ̂/2)/(1 + θ²/4).
pub(crate) fn spatial(start: &Mat3, increment: &Vec3) -> Mat3 {
    let half = increment * 0.5;
    start * (Mat3::identity() + half.cross_matrix()) / (1.0 + half.norm_squared())
}
