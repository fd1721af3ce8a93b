//! Stiffness against the motions that one integration point does not see.

use carom_elements::Kind;

/// Hourglass control of quadrilaterals and hexahedra with one point.
///
/// Each pattern h (products of reference coordinates at the nodes) is freed of its linear part,
/// γ_a = (h_a - Σ_j (Σ_b h_b X_bj) dN_a/dX_j) / nodes with the mean gradients, so that Σ_a γ_a = 0 and Σ_a γ_a X_a = 0.
/// The amplitude q = Σ_a γ_a x_a then vanishes for any linear motion, and in a hourglass motion x_a = X_a + h_a c it is c.
/// The energy is ½ k |q|² for each pattern, in the *current* positions: a rotation turns q and keeps its length, so that
/// rigid motions give neither energy nor force, and as it is quadratic, the force at the middle of a step does exactly its
/// work.
/// k = 2 μ κ V Σ_a |dN_a/dX|², with the shear modulus μ of the undeformed material: the bulk modulus would lock nearly
/// incompressible ones. On a square and κ = 1 this is 3/4 of the energy of full integration for λ = μ.
///
/// Patterns and projection: Flanagan and Belytschko (1981), there with λ + 2μ; the form in current positions is ours.
#[derive(Debug)]
pub(crate) struct Hourglass {
    /// h_a, pattern after pattern.
    patterns: Vec<Vec<f64>>,
    /// 2 μ κ in Pa.
    modulus: f64,
    /// γ_a of each element and pattern.
    shapes: Vec<f64>,
    /// k of each element in N/m.
    stiffness: Vec<f64>,
}

impl Hourglass {
    /// Of no element yet. `modulus`: 2 μ κ in Pa.
    pub(super) fn new(kind: Kind, modulus: f64) -> Hourglass {
        let products: &[&[usize]] = match kind.table().dim {
            2 => &[&[0, 1]],
            _ => &[&[1, 2], &[2, 0], &[0, 1], &[0, 1, 2]],
        };
        let reference = kind.table().reference;
        let pattern = |axes: &&[usize]| {
            let value = |xi: &[f64; 3]| axes.iter().map(|&i| xi[i]).product();
            reference.iter().map(value).collect()
        };
        Hourglass {
            patterns: products.iter().map(pattern).collect(),
            modulus,
            shapes: Vec::new(),
            stiffness: Vec::new(),
        }
    }

    /// Adds an element. `x`: its nodes in m; `gradient`: mean gradients in 1/m, of which the first `dim` entries are those in
    /// space; `volume`: ∫ δ dV in m³.
    pub(super) fn push(&mut self, x: &[[f64; 3]], gradient: &[[f64; 3]], volume: f64) {
        let dim = if self.patterns.len() == 1 { 2 } else { 3 };
        let nodes = x.len() as f64;
        for h in &self.patterns {
            let along = [0, 1, 2].map(|j| h.iter().zip(x).map(|(h, x)| h * x[j]).sum::<f64>());
            let shape = h.iter().zip(gradient).map(|(h, dn)| {
                let linear: f64 = (0..dim).map(|j| along[j] * dn[j]).sum();
                (h - linear) / nodes
            });
            self.shapes.extend(shape);
        }
        let square: f64 = gradient
            .iter()
            .map(|dn| dn[..dim].iter().map(|dn| dn * dn).sum::<f64>())
            .sum();
        self.stiffness.push(self.modulus * volume * square);
    }

    /// Adds the forces at `u` (m, `dim` entries per node) to `f` and returns the energy (J) there. `from`: displacement at
    /// the start of a step, for the forces at its middle.
    pub(super) fn force(
        &self,
        element: usize,
        dim: usize,
        u: &[f64],
        from: Option<&[f64]>,
        f: &mut [f64],
    ) -> f64 {
        let k = self.stiffness[element];
        let mut energy = 0.0;
        for shape in self.shapes(element, u.len() / dim) {
            for i in 0..dim {
                let amplitude = |u: &[f64]| {
                    let nodes = u.chunks_exact(dim).zip(shape);
                    nodes.map(|(u, shape)| shape * u[i]).sum::<f64>()
                };
                let q = amplitude(u);
                energy += 0.5 * k * q * q;
                let pull = k * from.map_or(q, |from| 0.5 * (q + amplitude(from)));
                for (f, shape) in f.chunks_exact_mut(dim).zip(shape) {
                    f[i] += pull * shape;
                }
            }
        }
        energy
    }

    /// Adds `factor` k γ_a γ_b to the diagonal blocks of a row-major element matrix, upper half and diagonal.
    pub(super) fn tangent(&self, element: usize, dim: usize, factor: f64, matrix: &mut [f64]) {
        let n = matrix.len().isqrt();
        let k = factor * self.stiffness[element];
        for shape in self.shapes(element, n / dim) {
            for (a, shape_a) in shape.iter().enumerate() {
                for (b, shape_b) in shape.iter().enumerate().skip(a) {
                    for i in 0..dim {
                        matrix[(dim * a + i) * n + dim * b + i] += k * shape_a * shape_b;
                    }
                }
            }
        }
    }

    fn shapes(&self, element: usize, nodes: usize) -> impl Iterator<Item = &[f64]> {
        let length = self.patterns.len() * nodes;
        self.shapes[element * length..][..length].chunks_exact(nodes)
    }
}
