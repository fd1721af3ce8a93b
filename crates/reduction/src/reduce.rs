//! A body of a model, reduced to retained nodes and modes.

use std::f64::consts::TAU;
use std::sync::Arc;

use carom_algebra::basis::Amplitude;
use carom_algebra::dense::DenseCholesky;
use carom_algebra::eigen::{Eigenpairs, Problem, lowest};
use carom_algebra::unknowns::Kind;
use carom_bodies::{BodySpec, MassKind, Reducible, Reduction};
use carom_system::{Damping, Model, ModelBody, System};

use crate::condense::{Condensed, projected, rigid_modes};
use crate::error::Error;
use crate::matrices::Matrices;
use crate::retained::retained;
use crate::statics::{add, dot};

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
    let (full, retained) = Full::of(model, body, keep)?;
    let condensed = full.condensed(keep)?;
    full.put(model, body, (keep, retained, condensed))
}

/// Where a reduction comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// The bytes given.
    Saved,
    /// It was made anew; these are its bytes.
    Made(Vec<u8>),
}

/// As [`reduce`], with the bytes of an earlier reduction. They are used if that followed from the same full body, retained nodes and
/// modes; the reduced body is then the same, bit for bit.
///
/// # Errors
/// As [`reduce`]; bytes that are no reduction or are damaged.
pub fn reduce_from(
    model: &mut Model,
    body: usize,
    keep: &Keep,
    saved: Option<&[u8]>,
) -> Result<Source, Error> {
    let (full, retained) = Full::of(model, body, keep)?;
    let known = match saved {
        Some(bytes) => full.decoded(keep, bytes)?,
        None => None,
    };
    let (condensed, source) = match known {
        Some(condensed) => (condensed, Source::Saved),
        None => {
            let condensed = full.condensed(keep)?;
            let bytes = full.encoded(keep, &condensed)?;
            (condensed, Source::Made(bytes))
        }
    };
    full.put(model, body, (keep, retained, condensed))?;
    Ok(source)
}

/// The full body by itself.
pub(crate) struct Full {
    pub(crate) name: String,
    pub(crate) system: Arc<System>,
    pub(crate) matrices: Matrices,
    /// Held by supports, and not retained.
    pub(crate) fixed: Vec<bool>,
    /// Retained unknowns.
    pub(crate) border: Vec<usize>,
}

fn reduction(
    full: &Full,
    spec: BodySpec,
    (keep, retained, condensed): (&Keep, Vec<u32>, Condensed),
) -> Result<Reduction, Error> {
    let total = full.system.body_mass(0);
    let (count, border) = (condensed.columns.len(), full.border.len());
    let inertia = [0, 1, 2].map(|axis| full.inertia(&condensed.columns, &full.translation(axis)));
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
        let moves = share(&moved, &full.inertia(&condensed.columns, &moved));
        let turns = share(&turned, &full.inertia(&condensed.columns, &turned));
        let mut motion: Vec<f64> = full.border.iter().map(|&unknown| moved[unknown]).collect();
        motion.extend(&moves);
        is_grounded |= holds(&condensed.stiffness, &motion);
        for (amplitude, (moves, turns)) in amplitudes.iter_mut().zip(moves.iter().zip(&turns)) {
            (amplitude.translation[axis], amplitude.rotation[axis]) = (*moves, *turns);
        }
    }
    let unknowns = full.system.unknowns();
    let rows = (0..unknowns).flat_map(|i| condensed.columns.iter().map(move |column| column[i]));
    let system = &full.system;
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
        damping: damping(&condensed, keep, total),
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
        frequencies: hertz(&condensed.squares),
        estimates: condensed.estimates,
        unmoved: condensed.unmoved,
    })
}

/// Frequencies, Hz.
fn hertz(squares: &[f64]) -> Vec<f64> {
    squares.iter().map(|square| square.sqrt() / TAU).collect()
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
fn damping(condensed: &Condensed, keep: &Keep, mass: f64) -> Option<Vec<f64>> {
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
    let squares = &condensed.squares;
    for (q, square) in (count - squares.len()..count).zip(squares) {
        damping[q * count + q] += 2.0 * keep.ratio * square.sqrt() * mass;
    }
    Some(damping)
}

impl Full {
    /// The full body, and the nodes of the mesh that are retained.
    fn of(model: &Model, body: usize, keep: &Keep) -> Result<(Full, Vec<u32>), Error> {
        let retained = retained(model, body, &keep.nodes);
        Ok((Full::new(model, body, &retained)?, retained))
    }

    /// Puts the reduction in the place of the body.
    fn put(
        &self,
        model: &mut Model,
        body: usize,
        parts: (&Keep, Vec<u32>, Condensed),
    ) -> Result<(), Error> {
        let given = &mut model.bodies[body];
        let reduction = reduction(self, given.spec.clone(), parts)?;
        given.mass = MassKind::Consistent;
        given.reduced = Some(Arc::new(reduction));
        Ok(())
    }

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

    fn condensed(&self, keep: &Keep) -> Result<Condensed, Error> {
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

    /// Unknowns that supports hold, and the retained ones.
    pub(crate) fn held(&self, border: bool) -> Vec<bool> {
        let mut held = self.fixed.clone();
        self.border
            .iter()
            .for_each(|&unknown| held[unknown] |= border);
        held
    }

    pub(crate) fn refused(&self, cause: carom_algebra::Error) -> Error {
        Error::Static {
            body: self.name.clone(),
            cause,
        }
    }

    /// 1 for translations along an axis.
    pub(crate) fn translation(&self, axis: usize) -> Vec<f64> {
        let moves = |i: usize| self.system.unknowns.kind(i) == Kind::Translation(axis);
        let all = 0..self.system.unknowns();
        all.map(|i| if moves(i) { 1.0 } else { 0.0 }).collect()
    }

    /// A motion without that of the unknowns that supports hold.
    pub(crate) fn freed(&self, mut motion: Vec<f64>) -> Vec<f64> {
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
    pub(crate) fn inertia(&self, columns: &[Vec<f64>], motion: &[f64]) -> Vec<f64> {
        let mut image = vec![0.0; motion.len()];
        self.matrices.mass.multiply(motion, &mut image);
        columns.iter().map(|column| dot(column, &image)).collect()
    }
}
