//! A rigid plane that does not move.

/// Rigid plane: the material must stay on the side to which the normal points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A point of the plane, m.
    pub point: [f64; 3],
    /// Unit normal, out of the obstacle.
    pub normal: [f64; 3],
}

impl Plane {
    /// Gap of a place x in m: n · (x - point), open when positive.
    pub fn gap(&self, x: &[f64; 3]) -> f64 {
        (0..3)
            .map(|i| self.normal[i] * (x[i] - self.point[i]))
            .sum()
    }
}
