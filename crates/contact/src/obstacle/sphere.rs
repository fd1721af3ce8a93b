//! A rigid sphere.

use super::distance::{Distance, Side, round};

/// Rigid sphere, a circle in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its centre, m.
    pub centre: [f64; 3],
    /// Its radius, m.
    pub radius: f64,
    /// Where the material must stay.
    pub side: Side,
}

impl Sphere {
    /// Gap ± (|x - centre| - radius) of a place x in m, + outside. At the centre itself the normal is ± the last axis
    /// and the Hessian, which has no limit, is zero.
    pub fn distance(&self, x: &[f64; 3]) -> Distance {
        let d = [0, 1, 2].map(|i| x[i] - self.centre[i]);
        round(&d, &[0.0; 3], self.radius, self.side)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::obstacle::tests::assert_derivatives;

    #[test]
    fn normal_and_hessian_are_the_derivatives_of_the_gap_on_both_sides() {
        for side in [Side::Outside, Side::Inside] {
            let sphere = Sphere {
                centre: [0.3, -0.2, 1.0],
                radius: 0.7,
                side,
            };
            assert_derivatives(|x| sphere.distance(x), &[1.1, 0.4, 0.2]);
            let sign = if side == Side::Outside { 1.0 } else { -1.0 };
            assert!((sphere.distance(&[0.3, -0.2, 2.0]).gap - 0.3 * sign).abs() < 1e-15);
        }
    }
}
