//! A rigid sphere that does not move.

/// Rigid sphere, a circle in the plane: the material must stay outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its centre, m.
    pub centre: [f64; 3],
    /// Its radius, m.
    pub radius: f64,
}

impl Sphere {
    /// Gap of a place x in m, |x - centre| - radius, open when positive, and the unit normal out of the sphere there: the
    /// gradient of the gap. At the centre itself the normal is the last axis.
    pub fn gap(&self, x: &[f64; 3]) -> (f64, [f64; 3]) {
        let d = [0, 1, 2].map(|i| x[i] - self.centre[i]);
        let distance = d.iter().map(|d| d * d).sum::<f64>().sqrt();
        match distance > 0.0 {
            true => (distance - self.radius, d.map(|d| d / distance)),
            false => (-self.radius, [0.0, 0.0, 1.0]),
        }
    }

    /// Second derivative of the gap by the place, (I - n nᵀ) / |x - centre|, in 1/m; zero at the centre itself.
    pub fn hessian(&self, x: &[f64; 3]) -> [[f64; 3]; 3] {
        let (gap, n) = self.gap(x);
        let distance = gap + self.radius;
        let entry = |i: usize, j: usize| match distance > 0.0 {
            true => (f64::from(u8::from(i == j)) - n[i] * n[j]) / distance,
            false => 0.0,
        };
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
    }
}

#[cfg(test)]
mod tests {
    use super::Sphere;

    #[test]
    fn the_normal_is_the_gradient_of_the_gap() {
        let sphere = Sphere {
            centre: [0.3, -0.2, 1.0],
            radius: 0.7,
        };
        let x = [1.1, 0.4, 0.2];
        let (_, normal) = sphere.gap(&x);
        for i in 0..3 {
            let at = |step: f64| {
                let mut x = x;
                x[i] += step;
                sphere.gap(&x).0
            };
            // central differences err by the square of the step over the radius of curvature
            assert!(((at(1e-4) - at(-1e-4)) / 2e-4 - normal[i]).abs() < 1e-7);
        }
        assert!((sphere.gap(&[0.3, -0.2, 2.0]).0 - 0.3).abs() < 1e-15);
    }
}
