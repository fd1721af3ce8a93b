//! The bases: columns of T with their matrices.

use carom_algebra::csr::Csr;
use carom_algebra::dense::DenseCholesky;
use carom_algebra::eigen::{Eigenpairs, Problem, lowest};

use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::full::{Full, Keep};
use crate::matrices::Matrices;
use crate::quality::exact;
use crate::statics::{Statics, add, dot};

/// Part of the shift below which ω² is that of a rigid motion.
const RIGID: f64 = 1e-4;

/// Columns of T, and K and M.
#[derive(Deserialize, Serialize)]
pub(crate) struct Condensed {
    pub(crate) columns: Vec<Vec<f64>>,
    pub(crate) stiffness: Vec<f64>,
    pub(crate) mass: Vec<f64>,
    /// ω² of the modes kept, (rad/s)².
    pub(crate) squares: Vec<f64>,
    /// Frequencies (Hz) that the reduced body has, and estimates of their relative errors.
    pub(crate) estimates: Option<Vec<[f64; 2]>>,
    /// Part of the mass that no mode of the reduced body moves along each axis.
    pub(crate) unmoved: Option<[f64; 3]>,
}

impl Condensed {
    /// Whether the sizes fit together, for a full body of so many unknowns.
    pub(crate) fn has_sizes(&self, unknowns: usize, border: usize, modes: usize) -> bool {
        let n = border + modes;
        let lengths = [self.stiffness.len(), self.mass.len()];
        let columns = self.columns.iter().map(Vec::len);
        lengths == [n * n; 2]
            && self.squares.len() == modes
            && self.columns.len() == n
            && columns.into_iter().all(|length| length == unknowns)
    }
}

impl Full {
    pub(crate) fn condensed(&self, keep: &Keep) -> Result<Condensed, Error> {
        let pairs = self.modes(keep)?;
        let total = self.system.body_mass(0);
        match keep.massless {
            false => self.craig_bampton(&pairs, total),
            true => self.macneal(&pairs, total),
        }
    }

    /// Modes with held retained nodes, or with free ones.
    fn modes(&self, keep: &Keep) -> Result<Eigenpairs, Error> {
        let pairs = lowest(
            &Problem {
                stiffness: &self.matrices.stiffness,
                mass: &self.matrices.mass,
                fixed: &self.held(!keep.massless),
                groups: self.system.unknowns.node_of_each(),
                constraints: &[],
            },
            keep.modes,
        );
        let pairs = pairs.map_err(|cause| Error::Eigenvalues {
            bodies: vec![self.name.clone()],
            cause,
        })?;
        if keep.modes > pairs.existing {
            return Err(Error::Count {
                body: self.name.clone(),
                asked: keep.modes,
                exist: pairs.existing,
            });
        }
        self.straightened(pairs)
    }

    /// The pairs, those of rigid motions exactly rigid: their combination nearest to each, where all of these are modes.
    fn straightened(&self, mut pairs: Eigenpairs) -> Result<Eigenpairs, Error> {
        let mass = self.system.body_masses[0].iter();
        let total = self.system.body_mass(0);
        let centre = [0, 1, 2].map(|i| {
            let moments = mass
                .clone()
                .map(|(node, m)| m * self.system.x[*node as usize][i]);
            moments.sum::<f64>() / total
        });
        let turned = (0..3).map(|axis| self.rotation(axis, centre));
        let motions = (0..3).map(|axis| self.translation(axis)).chain(turned);
        let moves = |motion: &Vec<f64>| motion.iter().any(|x| *x != 0.0);
        let motions: Vec<Vec<f64>> = motions.filter(moves).collect();
        let n = motions.len();
        if rigid_modes(&pairs) != n {
            return Ok(pairs);
        }
        let factor = DenseCholesky::new(n, &projected(&self.matrices.mass, &motions));
        let factor = factor.map_err(|cause| self.refused(cause))?;
        let mut image = vec![0.0; self.matrices.mass.n];
        for mode in &mut pairs.vectors[..n] {
            self.matrices.mass.multiply(mode, &mut image);
            let mut parts: Vec<f64> = motions.iter().map(|motion| dot(motion, &image)).collect();
            factor.solve(&mut parts);
            mode.fill(0.0);
            for (part, motion) in parts.iter().zip(&motions) {
                add(*part, motion, mode);
            }
        }
        pairs.values[..n].fill(0.0);
        Ok(pairs)
    }

    /// M φ of the modes.
    fn inertias(&self, pairs: &Eigenpairs) -> Vec<Vec<f64>> {
        let of = |mode: &Vec<f64>| {
            let mut image = vec![0.0; mode.len()];
            self.matrices.mass.multiply(mode, &mut image);
            image
        };
        pairs.vectors.iter().map(of).collect()
    }

    /// Static responses to unit displacements of the retained unknowns, and modes with these held, times the root of the mass.
    pub(crate) fn craig_bampton(&self, pairs: &Eigenpairs, total: f64) -> Result<Condensed, Error> {
        let Matrices { stiffness, mass } = &self.matrices;
        let held = self.held(true);
        let mut columns = Vec::new();
        if !self.border.is_empty() {
            let inertias = self.inertias(pairs);
            let rigid = rigid_modes(pairs);
            let modes = pairs.vectors[..rigid].iter().zip(&inertias);
            let modes: Vec<_> = modes
                .map(|(mode, inertia)| [&mode[..], &inertia[..]])
                .collect();
            let nodes = self.system.unknowns.node_of_each();
            let statics = Statics::new((stiffness, mass), &held, (modes, rigid > 0), nodes);
            let mut statics = statics.map_err(|cause| self.refused(cause))?;
            for &unknown in &self.border {
                let mut force = vec![0.0; held.len()];
                let (others, values) = stiffness.row(unknown);
                for (&i, k) in others.iter().zip(values) {
                    force[i as usize] = -k;
                }
                let mut column = statics.solve(force);
                column[unknown] = 1.0;
                columns.push(column);
            }
        }
        let root = total.sqrt();
        let scaled = |mode: &Vec<f64>| mode.iter().map(|x| root * x).collect::<Vec<_>>();
        columns.extend(pairs.vectors.iter().map(scaled));
        let (mut stiffness, mut mass) = (projected(stiffness, &columns), projected(mass, &columns));
        self.uncouple(&mut stiffness, &mut mass);
        let squares = squares(pairs);
        Ok(Condensed {
            estimates: match self.border.is_empty() {
                true => Some(exact(&squares)),
                false => self.estimates((&stiffness, &mass), &squares)?,
            },
            unmoved: self.unmoved(|motion| self.moved(&columns, &mass, motion)),
            squares,
            stiffness,
            mass,
            columns,
        })
    }

    /// Sets to zero what rounding leaves of Ψᵀ K Φ and beside the diagonals of Φᵀ K Φ and Φᵀ M Φ: static responses need no force on the other
    /// unknowns, and modes are orthogonal.
    fn uncouple(&self, stiffness: &mut [f64], mass: &mut [f64]) {
        let (b, n) = (self.border.len(), stiffness.len().isqrt());
        for i in 0..n {
            for j in (0..n).filter(|&j| j != i && i.max(j) >= b) {
                stiffness[i * n + j] = 0.0;
                if i.min(j) >= b {
                    mass[i * n + j] = 0.0;
                }
            }
        }
    }

    /// With the flexibility G of the retained unknowns b that the modes Φ leave: u = Φ q + G_b G_bb⁻¹ (u_b - Φ_b q).
    pub(crate) fn macneal(&self, pairs: &Eigenpairs, total: f64) -> Result<Condensed, Error> {
        let Matrices { stiffness, mass } = &self.matrices;
        let nodes = self.system.unknowns.node_of_each();
        let inertias = self.inertias(pairs);
        let modes = pairs.vectors.iter().zip(&inertias);
        let modes: Vec<_> = modes
            .map(|(mode, inertia)| [&mode[..], &inertia[..]])
            .collect();
        let floats = rigid_modes(pairs) > 0;
        let statics = Statics::new((stiffness, mass), &self.fixed, (modes, floats), nodes);
        let mut statics = statics.map_err(|cause| self.refused(cause))?;
        let mut responses = Vec::new();
        for &unknown in &self.border {
            let mut force = vec![0.0; mass.n];
            force[unknown] = 1.0;
            responses.push(statics.solve(force));
        }
        let b = self.border.len();
        let flexibility: Vec<f64> = (0..b * b)
            .map(|e| {
                let (i, j) = (e / b, e % b);
                0.5 * (responses[i][self.border[j]] + responses[j][self.border[i]])
            })
            .collect();
        let factor = DenseCholesky::new(b, &flexibility).map_err(|cause| self.refused(cause))?;
        let root = total.sqrt();
        let n = b + pairs.values.len();
        let mut columns: Vec<Vec<f64>> = Vec::new();
        let mut matrix = vec![0.0; n * n];
        for j in 0..b {
            let mut weights = vec![0.0; b];
            weights[j] = 1.0;
            factor.solve(&mut weights);
            let mut column = vec![0.0; mass.n];
            for (weight, response) in weights.iter().zip(&responses) {
                add(*weight, response, &mut column);
            }
            for (i, weight) in weights.iter().enumerate() {
                matrix[i * n + j] = *weight;
            }
            columns.push(column);
        }
        let mut inertia = vec![0.0; n * n];
        let at_border: Vec<Vec<f64>> = pairs
            .vectors
            .iter()
            .map(|mode| self.border.iter().map(|&i| root * mode[i]).collect())
            .collect();
        for (q, mode) in pairs.vectors.iter().enumerate() {
            let mut forces = at_border[q].clone();
            factor.solve(&mut forces);
            let mut column: Vec<f64> = mode.iter().map(|x| root * x).collect();
            for (x, response) in forces.iter().zip(&responses) {
                add(-x, response, &mut column);
            }
            columns.push(column);
            let row = b + q;
            for (i, force) in forces.iter().enumerate() {
                (matrix[i * n + row], matrix[row * n + i]) = (-force, -force);
            }
            for (p, other) in at_border.iter().enumerate() {
                matrix[row * n + b + p] = dot(&forces, other);
            }
            matrix[row * n + row] += total * pairs.values[q].max(0.0);
            inertia[row * n + row] = total;
        }
        // held retained unknowns must be exactly themselves
        for (j, &unknown) in self.border.iter().enumerate() {
            for (k, column) in columns.iter_mut().enumerate() {
                column[unknown] = if k == j { 1.0 } else { 0.0 };
            }
        }
        let squares = squares(pairs);
        let in_modes = |motion: &[f64]| {
            let parts = inertias.iter().map(|inertia| dot(inertia, motion).powi(2));
            Some(parts.sum())
        };
        Ok(Condensed {
            columns,
            stiffness: matrix,
            mass: inertia,
            estimates: Some(exact(&squares)),
            unmoved: self.unmoved(in_modes),
            squares,
        })
    }
}

fn squares(pairs: &Eigenpairs) -> Vec<f64> {
    pairs.values.iter().map(|value| value.max(0.0)).collect()
}

/// Number of modes that are rigid motions.
pub(crate) fn rigid_modes(pairs: &Eigenpairs) -> usize {
    pairs
        .values
        .partition_point(|value| *value < -RIGID * pairs.shift)
}

/// Tᵀ A T of a symmetric matrix.
pub(crate) fn projected(matrix: &Csr, columns: &[Vec<f64>]) -> Vec<f64> {
    let n = columns.len();
    let mut projected = vec![0.0; n * n];
    let mut image = vec![0.0; matrix.n];
    for (i, column) in columns.iter().enumerate() {
        matrix.multiply(column, &mut image);
        for (j, other) in columns.iter().enumerate().take(i + 1) {
            let entry = dot(other, &image);
            (projected[i * n + j], projected[j * n + i]) = (entry, entry);
        }
    }
    projected
}
