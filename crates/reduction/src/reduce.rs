//! A body of a model, reduced to retained nodes and modes.

use std::f64::consts::TAU;
use std::sync::Arc;

use carom_algebra::arrowhead::Arrowhead;
use carom_algebra::basis::Amplitude;
use carom_bodies::{BodySpec, MassKind, ReducedMatrices, Reducible, Reduction};
use carom_system::{Damping, Model};

use crate::condense::Condensed;
use crate::error::Error;
use crate::full::{Full, Keep};
use crate::statics::{dot, mass_of};

/// Force of a rigid motion over the largest stiffness above which something else than the body holds it.
const HELD: f64 = 1e-8;

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
    let (mut is_grounded, mut is_free) = (false, [false; 3]);
    for axis in 0..3 {
        // nodes that supports hold do not move with the others
        let [moved, turned] = [full.translation(axis), full.rotation(axis, [0.0; 3])]
            .map(|motion| full.freed(motion));
        is_free[axis] = full.is_free(&moved);
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
    let held = (0..unknowns).filter(|&unknown| full.fixed[unknown]);
    let held = held.map(|unknown| {
        let node = system.unknowns.node(unknown);
        (
            system.mesh_node[node as usize],
            system.unknowns.kind(unknown),
        )
    });
    Ok(Reduction {
        rows: rows.collect(),
        full: own.map_err(carom_system::Error::from)?,
        unknowns: system.unknowns.clone(),
        mesh_node: system.mesh_node.clone(),
        retained,
        matrices: Arc::new(ReducedMatrices {
            damping: damping(&condensed, keep, total).map(|c| Arrowhead::new(count, &c)),
            stiffness: Arrowhead::new(count, &condensed.stiffness),
            mass: Arrowhead::new(count, &condensed.mass),
        }),
        amplitudes,
        inertia,
        translated: [0, 1, 2].map(|axis| mass_of(&full.matrices.mass, &full.translation(axis))),
        is_grounded,
        held: held.collect(),
        is_free,
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
    /// Puts the reduction in the place of the body.
    fn put(
        &self,
        model: &mut Model,
        body: usize,
        parts: (&Keep, Vec<u32>, Condensed),
    ) -> Result<(), Error> {
        let spec = model.bodies[body].spec.clone();
        let mut reduction = reduction(self, spec, parts)?;
        // steps that read the matrices of bodies of one kind find them in the cache
        let others = || model.bodies.iter().filter_map(|body| body.reduced.as_ref());
        if let Some(equal) = others().find(|other| other.matrices == reduction.matrices) {
            reduction.matrices = Arc::clone(&equal.matrices);
        }
        if let Some(equal) = others().find(|other| other.rows == reduction.rows) {
            reduction.rows = Arc::clone(&equal.rows);
        }
        let given = &mut model.bodies[body];
        given.mass = MassKind::Consistent;
        given.reduced = Some(Arc::new(reduction));
        Ok(())
    }
}
