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

    /// Stiffness w E A / L [e⊗e, -e⊗e; -e⊗e, e⊗e], row-major, in N/m. `weight`: w at the middle.
    pub(crate) fn stiffness(&self, dim: usize, weight: f64, x: &[[f64; 3]], k: &mut [f64]) {
        let (axis, length) = Bar::axis(x);
        let stiffness = weight * (self.young * self.area / length);
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

    /// Scalar consistent mass ∫ ρ A w N_a N_b ds = ρ A L / 12 [3 w_1 + w_2, w_1 + w_2; w_1 + w_2, w_1 + 3 w_2] in kg,
    /// row-major. `weights`: w_1 and w_2 at the nodes, linear between them.
    pub(crate) fn mass(&self, weights: &[f64], x: &[[f64; 3]], m: &mut [f64]) {
        let sixth = self.density * self.area * Bar::axis(x).1 / 6.0;
        let (w1, w2) = (weights[0], weights[1]);
        // halves of whole numbers for w = 1, so that it changes no bit
        let product = 0.5 * (w1 + w2) * sixth;
        m.copy_from_slice(&[
            0.5 * (3.0 * w1 + w2) * sixth,
            product,
            product,
            0.5 * (w1 + 3.0 * w2) * sixth,
        ]);
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
