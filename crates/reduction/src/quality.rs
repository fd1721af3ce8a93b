//! What a basis leaves out: estimates of the errors of its frequencies, and the mass that it does not move.

use std::f64::consts::TAU;

use carom_algebra::dense::DenseCholesky;
use carom_algebra::dense_eigen::eigenpairs;
use carom_algebra::solver::Cholesky;

use crate::error::Error;
use crate::full::Full;
use crate::statics::{dot, mass_of};

/// Frequencies (Hz) of modes that the basis has exactly.
pub(crate) fn exact(squares: &[f64]) -> Vec<[f64; 2]> {
    squares
        .iter()
        .map(|square| [square.sqrt() / TAU, 0.0])
        .collect()
}

impl Full {
    /// Frequencies (Hz) of the reduced body below the highest mode kept, and estimates of their relative errors, with Craig and
    /// Bampton's basis. `None` where a retained unknown moves no mass at all.
    ///
    /// The modes k with held retained nodes that are left out add -λ² Σ L Lᵀ/(λ_k - λ) to the dynamic stiffness of the retained
    /// unknowns, with their participations L = (Ψᵀ M)_b φ_k. The sum of L Lᵀ over all modes is Ψᵀ M Ψ without the mass C that stays at the
    /// retained unknowns however the others move, C = M_bb - M_bi M_ii⁻¹ M_ib. Without the modes kept it is R, and λ_k is at
    /// least that of the last one kept, λ_N. To first order a mode with φᵀ M φ = 1 has
    ///
    ///     δω/ω ≤ ½ λ/(λ_N - λ) φ_bᵀ R φ_b.
    pub(crate) fn estimates(
        &self,
        (stiffness, mass): (&[f64], &[f64]),
        squares: &[f64],
    ) -> Result<Option<Vec<[f64; 2]>>, Error> {
        let (b, n) = (self.border.len(), self.border.len() + squares.len());
        let rest = self.left_out(mass, n)?;
        let Ok((values, vectors)) = eigenpairs(n, stiffness, mass) else {
            return Ok(None);
        };
        let highest = squares.last().copied().unwrap_or(0.0);
        let modes = values.iter().zip(vectors.chunks_exact(n.max(1)));
        let estimate = |(value, mode): (&f64, &[f64])| {
            let value = value.max(0.0);
            let rows = rest.chunks_exact(b).zip(mode);
            let part: f64 = rows.map(|(row, x)| x * dot(row, &mode[..b])).sum();
            let error = 0.5 * value / (highest - value) * part.max(0.0);
            [value.sqrt() / TAU, error]
        };
        let below = modes.take_while(|(value, _)| **value < highest);
        Ok(Some(below.map(estimate).collect()))
    }

    /// R of [`Full::estimates`], kg; `mass` has `n` rows.
    fn left_out(&self, mass: &[f64], n: usize) -> Result<Vec<f64>, Error> {
        let b = self.border.len();
        let own = self.own_mass()?;
        let mut rest = own;
        for i in 0..b {
            for j in 0..b {
                let kept: f64 = (b..n)
                    .map(|q| mass[i * n + q] * mass[j * n + q] / mass[q * n + q])
                    .sum();
                rest[i * b + j] = mass[i * n + j] - kept - rest[i * b + j];
            }
        }
        Ok(rest)
    }

    /// C of [`Full::estimates`], kg.
    fn own_mass(&self) -> Result<Vec<f64>, Error> {
        let mass = &self.matrices.mass;
        let held = self.held(true);
        let weightless = (0..mass.n).map(|i| held[i] || mass.get(i, i) <= 0.0);
        let weightless: Vec<bool> = weightless.collect();
        let coupling = |unknown: usize| {
            let mut column = vec![0.0; mass.n];
            let (others, values) = mass.row(unknown);
            let free = others
                .iter()
                .zip(values)
                .filter(|(i, _)| !weightless[**i as usize]);
            free.for_each(|(i, m)| column[*i as usize] = *m);
            column
        };
        let couplings: Vec<Vec<f64>> = self.border.iter().map(|&i| coupling(i)).collect();
        let mut own: Vec<f64> = self
            .border
            .iter()
            .flat_map(|&i| self.border.iter().map(move |&j| mass.get(i, j)))
            .collect();
        // a lumped mass has none
        if couplings.iter().flatten().any(|m| *m != 0.0) {
            let nodes = self.system.unknowns.node_of_each();
            let factor = Cholesky::new(&mass.with_identity(&weightless), nodes);
            let mut factor = factor.map_err(|cause| self.refused(cause))?;
            for (j, coupling) in couplings.iter().enumerate() {
                let mut moved = coupling.clone();
                factor.solve(&mut moved);
                for (i, other) in couplings.iter().enumerate() {
                    own[i * couplings.len() + j] -= dot(other, &moved);
                }
            }
        }
        Ok(own)
    }

    /// Mass (kg) that moves with a motion as far as a basis with these columns and this mass matrix has it: that of its M-projection.
    /// `None` where a retained unknown moves no mass at all.
    pub(crate) fn moved(&self, columns: &[Vec<f64>], mass: &[f64], motion: &[f64]) -> Option<f64> {
        let inertia = self.inertia(columns, motion);
        let mut parts = inertia.clone();
        DenseCholesky::new(columns.len(), mass)
            .ok()?
            .solve(&mut parts);
        Some(dot(&inertia, &parts))
    }

    /// Part of the mass that does not move along each axis, of what supports leave free. `moved`: mass that moves with a motion.
    pub(crate) fn unmoved(&self, moved: impl Fn(&[f64]) -> Option<f64>) -> Option<[f64; 3]> {
        let mut unmoved = [0.0; 3];
        for (axis, unmoved) in unmoved.iter_mut().enumerate() {
            let motion = self.freed(self.translation(axis));
            let all = mass_of(&self.matrices.mass, &motion);
            if all > 0.0 {
                *unmoved = (1.0 - moved(&motion)? / all).max(0.0);
            }
        }
        Some(unmoved)
    }
}
