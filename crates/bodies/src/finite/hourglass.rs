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
pub(super) struct Hourglass {
    /// γ_a of each pattern.
    shapes: [[f64; MAX_CORNERS]; MAX_PATTERNS],
    patterns: usize,
    nodes: usize,
    /// k in N/m.
    stiffness: f64,
}

/// Nodes of a hexahedron.
const MAX_CORNERS: usize = 8;
/// Patterns of a hexahedron.
const MAX_PATTERNS: usize = 4;

/// The products of reference coordinates that are the patterns of a quadrilateral or a hexahedron.
pub(crate) fn patterns(kind: Kind) -> &'static [&'static [usize]] {
    match kind.table().dim {
        2 => &[&[0, 1]],
        _ => &[&[1, 2], &[2, 0], &[0, 1], &[0, 1, 2]],
    }
}

/// h_a of a pattern at a node of these reference coordinates.
pub(crate) fn pattern(axes: &[usize], xi: &[f64; 3]) -> f64 {
    axes.iter().map(|&i| xi[i]).product()
}

impl Hourglass {
    /// `modulus`: 2 μ κ in Pa; `x`: nodes in m; `gradient`: mean gradients in 1/m, of which the first `dim` entries are those in
    /// space; `volume`: ∫ δ dV in m³.
    pub(super) fn new(
        kind: Kind,
        modulus: f64,
        x: &[[f64; 3]],
        gradient: &[[f64; 3]],
        volume: f64,
    ) -> Hourglass {
        let (dim, nodes) = (kind.table().dim, x.len());
        let mut shapes = [[0.0; MAX_CORNERS]; MAX_PATTERNS];
        let patterns = patterns(kind);
        for (shape, axes) in shapes.iter_mut().zip(patterns) {
            let h = |node: usize| pattern(axes, &kind.table().reference[node]);
            let along = [0, 1, 2].map(|j| (0..nodes).map(|a| h(a) * x[a][j]).sum::<f64>());
            for (a, (shape, dn)) in shape.iter_mut().zip(gradient).enumerate() {
                let linear: f64 = (0..dim).map(|j| along[j] * dn[j]).sum();
                *shape = (h(a) - linear) / nodes as f64;
            }
        }
        let square: f64 = gradient
            .iter()
            .map(|dn| dn[..dim].iter().map(|dn| dn * dn).sum::<f64>())
            .sum();
        Hourglass {
            shapes,
            patterns: patterns.len(),
            nodes,
            stiffness: modulus * volume * square,
        }
    }

    /// Adds the forces at `u` (m, `dim` entries per node) to `f` and returns the energy (J) there. `from`: displacement at
    /// the start of a step, for the forces at its middle.
    pub(super) fn force(&self, dim: usize, u: &[f64], from: Option<&[f64]>, f: &mut [f64]) -> f64 {
        let k = self.stiffness;
        let mut energy = 0.0;
        for shape in self.shapes() {
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
    pub(super) fn tangent(&self, dim: usize, (factor, whole): (f64, bool), matrix: &mut [f64]) {
        let n = matrix.len().isqrt();
        let k = factor * self.stiffness;
        for shape in self.shapes() {
            for (a, shape_a) in shape.iter().enumerate() {
                let first = if whole { 0 } else { a };
                for (b, shape_b) in shape.iter().enumerate().skip(first) {
                    for i in 0..dim {
                        matrix[(dim * a + i) * n + dim * b + i] += k * shape_a * shape_b;
                    }
                }
            }
        }
    }

    fn shapes(&self) -> impl Iterator<Item = &[f64]> {
        let shapes = self.shapes[..self.patterns].iter();
        shapes.map(|shape| &shape[..self.nodes])
    }
}
