//! A rigid circular cylinder without ends.

use super::distance::{Distance, Side, round};

/// Rigid cylinder of infinite length; in the plane, with its axis along z, a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// A point of its axis, m.
    pub point: [f64; 3],
    /// Unit vector along the axis.
    pub axis: [f64; 3],
    /// Its radius, m.
    pub radius: f64,
    /// Where the material must stay.
    pub side: Side,
}

impl Cylinder {
    /// Gap ± (|d| - radius) of a place x in m, + outside, with d = (I - a ⊗ a) (x - point) the way from the axis. On
    /// the axis itself the normal is some unit vector across it and the Hessian, which has no limit, is zero.
    pub fn distance(&self, x: &[f64; 3]) -> Distance {
        let r = [0, 1, 2].map(|i| x[i] - self.point[i]);
        let along: f64 = (0..3).map(|i| r[i] * self.axis[i]).sum();
        let d = [0, 1, 2].map(|i| r[i] - along * self.axis[i]);
        round(&d, &self.axis, self.radius, self.side)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::obstacle::tests::assert_derivatives;

    #[test]
    fn normal_and_hessian_are_the_derivatives_of_the_gap_on_both_sides() {
        for side in [Side::Outside, Side::Inside] {
            let cylinder = Cylinder {
                point: [0.3, -0.2, 1.0],
                axis: [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0],
                radius: 0.4,
                side,
            };
            assert_derivatives(|x| cylinder.distance(x), &[1.1, 0.4, 0.2]);
        }
    }

    #[test]
    fn the_gap_is_the_distance_from_the_axis_less_the_radius() {
        let mut cylinder = Cylinder {
            point: [5.0, 0.0, 0.0],
            axis: [1.0, 0.0, 0.0],
            radius: 2.0,
            side: Side::Inside,
        };
        let inside = cylinder.distance(&[-7.0, 0.6, 0.8]);
        assert!((inside.gap - 1.0).abs() < 1e-15);
        assert!((inside.normal[1] + 0.6).abs() < 1e-15);
        cylinder.side = Side::Outside;
        assert!((cylinder.distance(&[1e3, 3.0, 4.0]).gap - 3.0).abs() < 1e-12);
        // on the axis: any direction across it
        let n = cylinder.distance(&[1.0, 0.0, 0.0]).normal;
        assert!(n[0].abs() < 1e-15 && (n[1].hypot(n[2]) - 1.0).abs() < 1e-15);
    }
}
