//! Finite rotations, as unit quaternions, and Cayley's map of their increments.

use serde::{Deserialize, Serialize};

use crate::tensor::{Mat3, Vec3};

/// A rotation R: unit quaternion, scalar part first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rotation([f64; 4]);

impl Default for Rotation {
    fn default() -> Rotation {
        Rotation::IDENTITY
    }
}

impl Rotation {
    /// No rotation.
    pub const IDENTITY: Rotation = Rotation([1.0, 0.0, 0.0, 0.0]);

    /// Cayley's map of an increment θ (rad): `(I - θ̂/2)⁻¹ (I + θ̂/2)`, the rotation about θ by 2 atan(|θ|/2).
    pub fn cayley(increment: &Vec3) -> Rotation {
        let half = increment * 0.5;
        Rotation([1.0, half.x, half.y, half.z]).normalised()
    }

    /// The increment that Cayley's map turns into a rotation by `angle` (rad) about its axis: 2 tan(angle/2).
    pub fn increment(angle: f64) -> f64 {
        2.0 * (0.5 * angle).tan()
    }

    /// The rotation whose matrix has these columns, orthonormal and right-handed.
    pub fn of_matrix(matrix: &Mat3) -> Rotation {
        let rotation = nalgebra::Rotation3::from_matrix_unchecked(*matrix);
        let q = nalgebra::UnitQuaternion::from_rotation_matrix(&rotation);
        Rotation([q.w, q.i, q.j, q.k]).normalised()
    }

    /// R times another rotation: the other one about axes that turn with R.
    pub fn then(&self, other: &Rotation) -> Rotation {
        let ([a, x, y, z], [b, u, v, w]) = (self.0, other.0);
        Rotation([
            a * b - x * u - y * v - z * w,
            a * u + b * x + y * w - z * v,
            a * v + b * y + z * u - x * w,
            a * w + b * z + x * v - y * u,
        ])
        .normalised()
    }

    /// The matrix R.
    pub fn matrix(&self) -> Mat3 {
        let [a, x, y, z] = self.0;
        Mat3::new(
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - a * z),
            2.0 * (x * z + a * y),
            2.0 * (x * y + a * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - a * x),
            2.0 * (x * z - a * y),
            2.0 * (y * z + a * x),
            1.0 - 2.0 * (x * x + y * y),
        )
    }

    fn normalised(self) -> Rotation {
        let norm = self.0.iter().map(|q| q * q).sum::<f64>().sqrt();
        Rotation(self.0.map(|q| q / norm))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hat(v: &Vec3) -> Mat3 {
        v.cross_matrix()
    }

    #[test]
    fn cayley_is_the_quotient_that_it_says_and_products_are_those_of_matrices() {
        let (a, b) = (Vec3::new(0.3, -1.2, 0.7), Vec3::new(-0.4, 0.1, 2.0));
        let quotient = |t: &Vec3| {
            let (minus, plus) = (
                Mat3::identity() - hat(t) / 2.0,
                Mat3::identity() + hat(t) / 2.0,
            );
            minus.try_inverse().unwrap() * plus
        };
        let [r, s] = [a, b].map(|t| Rotation::cayley(&t));
        assert!((r.matrix() - quotient(&a)).norm() < 1e-15);
        assert!((r.then(&s).matrix() - quotient(&a) * quotient(&b)).norm() < 2e-15);
        let back = Rotation::of_matrix(&r.then(&s).matrix());
        assert!((back.matrix() - r.then(&s).matrix()).norm() < 2e-15);
    }

    #[test]
    fn the_increment_of_an_angle_turns_by_it() {
        let angle = 2.5;
        let turn = Rotation::cayley(&Vec3::new(0.0, 0.0, Rotation::increment(angle)));
        let x = turn.matrix() * Vec3::x();
        assert!((x - Vec3::new(angle.cos(), angle.sin(), 0.0)).norm() < 1e-15);
    }
}
