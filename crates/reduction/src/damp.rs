//! Damping of the modes of a body that is not reduced.

use std::f64::consts::TAU;
use std::sync::Arc;

use carom_algebra::eigen::{Eigenpairs, Problem, lowest};
use carom_system::{ModalDamping, Model};

use crate::condense::rigid_modes;
use crate::error::Error;
use crate::full::Full;

/// Number of modes that are computed first, where a frequency says up to which.
const FIRST: usize = 16;

/// Most modes that are damped: each costs as much as some products of a vector of the body in each solve.
const MOST: usize = 400;

/// Which modes are damped, and how.
#[derive(Clone, Debug, PartialEq)]
pub enum Ratios {
    /// The lowest ones that are no rigid motions, each with its ratio.
    Each(Vec<f64>),
    /// All below a frequency (Hz) that are no rigid motions, with one ratio.
    Below {
        /// Ratio ζ.
        ratio: f64,
        /// Frequency, Hz.
        frequency: f64,
    },
}

/// Damps modes of a body: those of the body by itself with its supports. Returns frequency (Hz) and ratio of each.
///
/// # Errors
/// A body that is rigid, reduced or not linear; more modes than there are, none or more than 400 below the frequency; no convergence.
pub fn damp(model: &mut Model, body: usize, ratios: &Ratios) -> Result<Vec<[f64; 2]>, Error> {
    let full = Full::new(model, body, &[])?;
    let pairs = match ratios {
        Ratios::Each(each) => full.elastic(each.len())?,
        Ratios::Below { frequency, .. } => full.below(*frequency)?,
    };
    let rigid = rigid_modes(&pairs);
    let squares = pairs.values[rigid..].iter().map(|square| square.max(0.0));
    let frequencies: Vec<f64> = squares.map(|square| square.sqrt() / TAU).collect();
    let modes: Vec<[f64; 2]> = match ratios {
        Ratios::Each(each) => frequencies
            .into_iter()
            .zip(each)
            .map(|(f, ratio)| [f, *ratio])
            .collect(),
        Ratios::Below { ratio, frequency } => {
            let below = frequencies.into_iter().take_while(|f| f <= frequency);
            below.map(|f| [f, *ratio]).collect()
        }
    };
    let column = |(mode, [f, ratio]): (&Vec<f64>, &[f64; 2])| {
        let mut inertia = vec![0.0; mode.len()];
        full.matrices.mass.multiply(mode, &mut inertia);
        let root = (2.0 * ratio * TAU * f).sqrt();
        inertia.iter_mut().for_each(|x| *x *= root);
        inertia
    };
    let system = &full.system;
    model.bodies[body].modal = Some(Arc::new(ModalDamping {
        unknowns: system.unknowns.clone(),
        mesh_node: system.mesh_node.clone(),
        columns: pairs.vectors[rigid..]
            .iter()
            .zip(&modes)
            .map(column)
            .collect(),
        modes: modes.clone(),
    }));
    Ok(modes)
}

impl Full {
    /// The lowest modes of the body, `count` beside the rigid motions.
    fn elastic(&self, count: usize) -> Result<Eigenpairs, Error> {
        let pairs = self.lowest(count)?;
        let rigid = rigid_modes(&pairs);
        let pairs = match rigid {
            0 => pairs,
            _ => self.lowest(count + rigid)?,
        };
        match pairs.values.len() < count + rigid {
            false => Ok(pairs),
            true => Err(Error::Damped {
                body: self.name.clone(),
                why: format!(
                    "it has {} modes that are no rigid motions",
                    pairs.existing - rigid
                ),
            }),
        }
    }

    /// Modes up to one above a frequency (Hz).
    fn below(&self, frequency: f64) -> Result<Eigenpairs, Error> {
        let square = (TAU * frequency).powi(2);
        let refused = |why: String| Error::Damped {
            body: self.name.clone(),
            why,
        };
        let mut count = FIRST;
        loop {
            let pairs = self.lowest(count)?;
            let inside = pairs
                .values
                .iter()
                .filter(|value| **value <= square)
                .count();
            if inside == rigid_modes(&pairs) {
                let lowest = pairs
                    .values
                    .get(inside)
                    .map_or(f64::INFINITY, |value| value.sqrt() / TAU);
                return Err(refused(format!(
                    "its lowest mode has {lowest:.4} Hz, above {frequency} Hz"
                )));
            }
            if inside < pairs.values.len() || pairs.values.len() == pairs.existing {
                return Ok(pairs);
            }
            if count == MOST {
                return Err(refused(format!(
                    "it has more than {MOST} modes below {frequency} Hz"
                )));
            }
            count = (2 * count).min(MOST);
        }
    }

    fn lowest(&self, count: usize) -> Result<Eigenpairs, Error> {
        let problem = Problem {
            stiffness: &self.matrices.stiffness,
            mass: &self.matrices.mass,
            fixed: &self.fixed,
            groups: self.system.unknowns.node_of_each(),
            constraints: &[],
        };
        lowest(&problem, count).map_err(|cause| Error::Eigenvalues {
            bodies: vec![self.name.clone()],
            cause,
        })
    }
}
