//! Stiffness, mass and stress of a straight two-node bar in one, two or three dimensions: strain along its axis only,
//! ε = e · (u_2 - u_1) / L. Slices hold the two nodes. Internal forces are in `force.rs`.

use carom_algebra::tensor::Mat3;

/// What a bar kernel needs to know of its body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bar {
    /// Young's modulus in Pa.
    pub(crate) young: f64,
    /// Cross-section in m².
    pub(crate) area: f64,
    /// Density in kg/m³.
    pub(crate) density: f64,
}

impl Bar {
    /// Unit axis from the first node to the second, and length in m.
    pub(crate) fn axis(x: &[[f64; 3]]) -> ([f64; 3], f64) {
        let d = [0, 1, 2].map(|i| x[1][i] - x[0][i]);
        let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        (d.map(|d| d / length), length)
    }

    fn strain(axis: &[f64; 3], length: f64, u: &[[f64; 3]]) -> f64 {
        (0..3).map(|i| axis[i] * (u[1][i] - u[0][i])).sum::<f64>() / length
    }

    /// Stiffness E A / L [e⊗e, -e⊗e; -e⊗e, e⊗e], row-major, in N/m.
    pub(crate) fn stiffness(&self, dim: usize, x: &[[f64; 3]], k: &mut [f64]) {
        let (axis, length) = Bar::axis(x);
        let stiffness = self.young * self.area / length;
        for a in 0..2 {
            for b in 0..2 {
                let sign = if a == b { 1.0 } else { -1.0 };
                for i in 0..dim {
                    for j in 0..dim {
                        k[(dim * a + i) * 2 * dim + dim * b + j] =
                            sign * stiffness * axis[i] * axis[j];
                    }
                }
            }
        }
    }

    /// Scalar consistent mass ρ A L / 6 [2, 1; 1, 2] in kg, row-major.
    pub(crate) fn mass(&self, x: &[[f64; 3]], m: &mut [f64]) {
        let sixth = self.density * self.area * Bar::axis(x).1 / 6.0;
        m.copy_from_slice(&[2.0 * sixth, sixth, sixth, 2.0 * sixth]);
    }

    /// Volume in m³ and stress tensor E ε e⊗e in Pa.
    pub(crate) fn stress(&self, x: &[[f64; 3]], u: &[[f64; 3]]) -> (f64, Mat3) {
        let (axis, length) = Bar::axis(x);
        let stress = self.young * Bar::strain(&axis, length, u);
        (
            self.area * length,
            Mat3::from_fn(|i, j| stress * axis[i] * axis[j]),
        )
    }
}
