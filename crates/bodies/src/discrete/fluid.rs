//! The inertia of a fluid in the gap between two coaxial cylinders.
//!
//! An ideal, incompressible fluid of density ρ between a cylinder of radius R₁ and a shell of radius R₂ around it, both of length l and
//! moving across their axis by u₁ and u₂, acts on them with `F = -M ü` (Fritz 1972, J. Eng. Ind. 94, 167),
//!
//! `M = [M_H, -(M₁ + M_H); -(M₁ + M_H), M₁ + M₂ + M_H]`, `M_H = M₁ (R₂² + R₁²)/(R₂² - R₁²)`, `M₁ = ρ π R₁² l`, `M₂ = ρ π R₂² l`.
//!
//! It is symmetric and positive semi-definite. Its sum is M₂ - M₁, the mass of the fluid; a common acceleration acts on body 1 with
//! the buoyancy -M₁.

/// The mass matrix of a fluid gap between two nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluidGap {
    /// M₁₁, M₁₂, M₂₂ in kg: of the inner node, between both, of the outer node.
    pub masses: [f64; 3],
    /// Unit vector along the axis of the cylinders, along which no fluid is moved; none in the plane, where it is across.
    pub axis: Option<[f64; 3]>,
    /// Width of the gap R₂ - R₁, m; none where the masses are given without it.
    pub width: Option<f64>,
}

impl FluidGap {
    /// That of a fluid of a density (kg/m³) between radii R₁ and R₂ (m) over a length (m).
    pub fn new(density: f64, [inner, outer]: [f64; 2], length: f64) -> FluidGap {
        let [one, two] = [inner, outer].map(|r| density * std::f64::consts::PI * r * r * length);
        let moved = one * (outer * outer + inner * inner) / (outer * outer - inner * inner);
        FluidGap {
            masses: [moved, -(one + moved), one + two + moved],
            axis: None,
            width: Some(outer - inner),
        }
    }

    /// Per length of a cylinder in a shell that does not move, kg/m: the added mass M_H, and the mass M₁ that it displaces, with which a common
    /// acceleration acts on it.
    pub fn around(density: f64, radii: [f64; 2]) -> [f64; 2] {
        let [moved, between, _] = FluidGap::new(density, radii, 1.0).masses;
        [moved, -between - moved]
    }

    /// Visits the entries of the mass over the translations of two nodes, which begin at these unknowns.
    pub(super) fn each_entry(
        &self,
        (first, dim): (&[usize; 2], usize),
        visit: &mut dyn FnMut(usize, usize, f64),
    ) {
        let along = self.axis.unwrap_or([0.0; 3]);
        let [inner, between, outer] = self.masses;
        for (a, row) in [[inner, between], [between, outer]].into_iter().enumerate() {
            for (b, m) in row.into_iter().enumerate() {
                for i in 0..dim {
                    for j in 0..dim {
                        let across = f64::from(u8::from(i == j)) - along[i] * along[j];
                        if across != 0.0 {
                            visit(first[a] + i, first[b] + j, m * across);
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sum_is_the_mass_of_the_fluid_and_a_wide_shell_gives_that_of_free_fluid() {
        let gap = FluidGap::new(1000.0, [0.1, 0.2], 2.0);
        let [a, b, c] = gap.masses;
        let fluid = 1000.0 * std::f64::consts::PI * 0.03 * 2.0;
        assert!((a + 2.0 * b + c - fluid).abs() < 1e-12 * fluid);
        assert!(a * c - b * b > 0.0);
        let [free, displaced] = FluidGap::around(1000.0, [0.1, 1e4]);
        let cylinder = 1000.0 * std::f64::consts::PI * 0.01;
        assert!((free / cylinder - 1.0).abs() < 1e-9);
        assert!((displaced / cylinder - 1.0).abs() < 1e-9);
    }
}
