//! A body of a model, reduced to retained nodes and modes.

use std::f64::consts::TAU;
use std::sync::Arc;

use carom_algebra::basis::Amplitude;
use carom_algebra::csr::Csr;
use carom_algebra::dense::DenseCholesky;
use carom_algebra::eigen::{Eigenpairs, Problem, lowest};
use carom_algebra::unknowns::Kind;
use carom_bodies::{MassKind, Reducible, Reduction};
use carom_system::{Damping, Model, ModelBody, System};

use crate::error::Error;
use crate::matrices::Matrices;
use crate::retained::retained;
use crate::statics::{Statics, add, dot};

/// Part of the shift below which ω² is that of a rigid motion.
const RIGID: f64 = 1e-4;

/// Force of a rigid motion over the largest stiffness above which something else than the body holds it.
const HELD: f64 = 1e-8;

/// What a reduction keeps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Keep {
    /// Number of modes.
    pub modes: usize,
    /// Nodes of the mesh that are retained beside those on which something acts.
    pub nodes: Vec<u32>,
    /// Whether the retained unknowns have no mass: modes are then those of the body with free retained nodes.
    pub massless: bool,
    /// Damping ratio of the modes.
    pub ratio: f64,
    /// Rayleigh's damping.
    pub rayleigh: Damping,
}

/// Reduces a body of a model: its system then has the unknowns of the retained nodes, on which contacts, links, other bodies,
/// discrete elements, loads or motions act, and the amplitudes of modes.
///
/// The modes are those with held retained nodes, beside the static responses to their unit displacements (Craig and Bampton 1968). With
/// `massless` they are those with free retained nodes, beside the static responses to unit forces without what the modes have of them
/// (MacNeal 1971; without mass at the retained nodes Monjaraz-Tec, Gross and Krack 2022). Supports are part of the reduction.
///
/// # Errors
/// A body that is rigid or not linear; more modes than there are; with `massless` so many that no flexibility is left to the retained
/// nodes; no convergence.
pub fn reduce(model: &mut Model, body: usize, keep: &Keep) -> Result<(), Error> {
    let reduction = reduction(model, body, keep)?;
    let given = &mut model.bodies[body];
    given.mass = MassKind::Consistent;
    given.reduced = Some(Arc::new(reduction));
    Ok(())
}

/// The full body by itself.
struct Full {
    name: String,
    system: Arc<System>,
    matrices: Matrices,
    /// Held by supports, and not retained.
    fixed: Vec<bool>,
    /// Retained unknowns.
    border: Vec<usize>,
}

/// Columns of T, and K and M.
struct Condensed {
    columns: Vec<Vec<f64>>,
    stiffness: Vec<f64>,
    mass: Vec<f64>,
}

fn reduction(model: &Model, body: usize, keep: &Keep) -> Result<Reduction, Error> {
    let retained = retained(model, body, &keep.nodes);
    let full = Full::new(model, body, &retained)?;
    let total = full.system.body_mass(0);
    let pairs = full.modes(keep)?;
    let condensed = match keep.massless {
        false => full.craig_bampton(&pairs, total)?,
        true => full.macneal(&pairs, total)?,
    };
    let (count, border) = (condensed.columns.len(), full.border.len());
    let inertia = [0, 1, 2].map(|axis| full.inertia(&condensed, &full.translation(axis)));
    let share = |motion: &[f64], inertia: &[f64]| -> Vec<f64> {
        let of = |q: usize| {
            let row = &condensed.mass[q * count..q * count + border];
            let known = row.iter().zip(&full.border);
            let known: f64 = known.map(|(m, &unknown)| m * motion[unknown]).sum();
            (inertia[q] - known) / total
        };
        (border..count).map(of).collect()
    };
    let mut amplitudes = vec![Amplitude::default(); count - border];
    let mut is_grounded = false;
    for axis in 0..3 {
        // nodes that supports hold do not move with the others
        let [moved, turned] = [full.translation(axis), full.rotation(axis, [0.0; 3])]
            .map(|motion| full.freed(motion));
        let moves = share(&moved, &full.inertia(&condensed, &moved));
        let turns = share(&turned, &full.inertia(&condensed, &turned));
        let mut motion: Vec<f64> = full.border.iter().map(|&unknown| moved[unknown]).collect();
        motion.extend(&moves);
        is_grounded |= holds(&condensed.stiffness, &motion);
        for (amplitude, (moves, turns)) in amplitudes.iter_mut().zip(moves.iter().zip(&turns)) {
            (amplitude.translation[axis], amplitude.rotation[axis]) = (*moves, *turns);
        }
    }
    let squares: Vec<f64> = pairs.values.iter().map(|value| value.max(0.0)).collect();
    let unknowns = full.system.unknowns();
    let rows = (0..unknowns).flat_map(|i| condensed.columns.iter().map(move |column| column[i]));
    let system = &full.system;
    let spec = model.bodies[body].spec.clone();
    let own = Reducible::new(&system.mesh, spec, &system.number, &system.unknowns);
    let masses = system.body_masses[0].iter();
    let centre = [0, 1, 2].map(|i| {
        let moments = system.body_masses[0].iter();
        moments
            .map(|(node, m)| m * system.x[*node as usize][i])
            .sum::<f64>()
            / total
    });
    Ok(Reduction {
        rows: rows.collect(),
        full: own.map_err(carom_system::Error::from)?,
        unknowns: system.unknowns.clone(),
        mesh_node: system.mesh_node.clone(),
        retained,
        damping: damping(&condensed, keep, (&squares, total)),
        stiffness: condensed.stiffness,
        mass: condensed.mass,
        amplitudes,
        inertia,
        is_grounded,
        is_massless: keep.massless,
        masses: masses
            .map(|(node, m)| (system.mesh_node[*node as usize], *m))
            .collect(),
        centre,
        frequencies: squares.iter().map(|square| square.sqrt() / TAU).collect(),
    })
}

/// Whether a translation needs a force.
fn holds(stiffness: &[f64], motion: &[f64]) -> bool {
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let forces = stiffness
        .chunks_exact(motion.len().max(1))
        .map(|row| dot(row, motion));
    let force = forces.fold(0.0_f64, |most, force| most.max(force.abs()));
    force > HELD * largest(stiffness) * largest(motion)
}

/// C = α M + β K, and 2 ζ ω m of the amplitudes.
fn damping(condensed: &Condensed, keep: &Keep, (squares, mass): (&[f64], f64)) -> Option<Vec<f64>> {
    let Damping {
        mass: alpha,
        stiffness: beta,
    } = keep.rayleigh;
    if keep.ratio == 0.0 && alpha == 0.0 && beta == 0.0 {
        return None;
    }
    let pairs = condensed.mass.iter().zip(&condensed.stiffness);
    let mut damping: Vec<f64> = pairs.map(|(m, k)| alpha * m + beta * k).collect();
    let count = condensed.columns.len();
    for (q, square) in (count - squares.len()..count).zip(squares) {
        damping[q * count + q] += 2.0 * keep.ratio * square.sqrt() * mass;
    }
    Some(damping)
}

impl Full {
    fn new(model: &Model, body: usize, retained: &[u32]) -> Result<Full, Error> {
        let given = &model.bodies[body];
        let refused = |why| Error::Refused {
            body: given.spec.name.clone(),
            why,
        };
        if given.rigid.is_some() {
            return Err(refused("it is rigid"));
        }
        let own = ModelBody {
            mass: given.mass,
            ..ModelBody::new(given.spec.clone())
        };
        let system = System::whole(Model {
            supports: model.supports.clone(),
            ..Model::new(vec![own], model.mesh.clone(), model.scheme, 1.0)
        })?;
        if !system.bodies[0].is_linear() {
            return Err(refused(
                "it is at finite strain; a reduced body has the forces of small strain",
            ));
        }
        let of_node = |&node: &u32| system.unknowns.of(system.number[node as usize]);
        let border: Vec<usize> = retained.iter().flat_map(of_node).collect();
        let mut fixed = system.fixed.clone();
        border.iter().for_each(|&unknown| fixed[unknown] = false);
        Ok(Full {
            name: given.spec.name.clone(),
            matrices: Matrices::new(&system),
            system,
            fixed,
            border,
        })
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

    /// Unknowns that supports hold, and the retained ones.
    fn held(&self, border: bool) -> Vec<bool> {
        let mut held = self.fixed.clone();
        self.border
            .iter()
            .for_each(|&unknown| held[unknown] |= border);
        held
    }

    fn refused(&self, cause: carom_algebra::Error) -> Error {
        Error::Static {
            body: self.name.clone(),
            cause,
        }
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
    fn craig_bampton(&self, pairs: &Eigenpairs, total: f64) -> Result<Condensed, Error> {
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
        Ok(Condensed {
            stiffness: projected(stiffness, &columns),
            mass: projected(mass, &columns),
            columns,
        })
    }

    /// With the flexibility G of the retained unknowns b that the modes Φ leave: u = Φ q + G_b G_bb⁻¹ (u_b - Φ_b q).
    fn macneal(&self, pairs: &Eigenpairs, total: f64) -> Result<Condensed, Error> {
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
        Ok(Condensed {
            columns,
            stiffness: matrix,
            mass: inertia,
        })
    }

    /// 1 for translations along an axis.
    fn translation(&self, axis: usize) -> Vec<f64> {
        let moves = |i: usize| self.system.unknowns.kind(i) == Kind::Translation(axis);
        let all = 0..self.system.unknowns();
        all.map(|i| if moves(i) { 1.0 } else { 0.0 }).collect()
    }

    /// A motion without that of the unknowns that supports hold.
    fn freed(&self, mut motion: Vec<f64>) -> Vec<f64> {
        for (motion, _) in motion
            .iter_mut()
            .zip(&self.fixed)
            .filter(|(_, fixed)| **fixed)
        {
            *motion = 0.0;
        }
        motion
    }

    /// The motion of a unit rotation about an axis through a place.
    fn rotation(&self, axis: usize, about: [f64; 3]) -> Vec<f64> {
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        let unknowns = &self.system.unknowns;
        let of = |i: usize| {
            let x = &self.system.x[unknowns.node(i) as usize];
            match unknowns.kind(i) {
                Kind::Translation(a) if a == j => about[k] - x[k],
                Kind::Translation(a) if a == k => x[j] - about[j],
                Kind::Rotation(a) if a == axis => 1.0,
                _ => 0.0,
            }
        };
        (0..self.system.unknowns()).map(of).collect()
    }

    /// Tᵀ M r.
    fn inertia(&self, condensed: &Condensed, motion: &[f64]) -> Vec<f64> {
        let mut image = vec![0.0; motion.len()];
        self.matrices.mass.multiply(motion, &mut image);
        condensed
            .columns
            .iter()
            .map(|column| dot(column, &image))
            .collect()
    }
}

/// Number of modes that are rigid motions.
fn rigid_modes(pairs: &Eigenpairs) -> usize {
    pairs
        .values
        .partition_point(|value| *value < -RIGID * pairs.shift)
}

/// Tᵀ A T of a symmetric matrix.
fn projected(matrix: &Csr, columns: &[Vec<f64>]) -> Vec<f64> {
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
