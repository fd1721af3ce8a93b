//! A rigid plane.

use super::distance::Distance;

/// Rigid plane: the material must stay on the side to which the normal points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A point of the plane, m.
    pub point: [f64; 3],
    /// Unit normal, out of the obstacle.
    pub normal: [f64; 3],
}

impl Plane {
    /// Gap n · (x - point) of a place x in m.
    pub fn distance(&self, x: &[f64; 3]) -> Distance {
        Distance {
            gap: (0..3)
                .map(|i| self.normal[i] * (x[i] - self.point[i]))
                .sum(),
            normal: self.normal,
            hessian: [[0.0; 3]; 3],
        }
    }
}
