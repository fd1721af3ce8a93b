//! Modes of the parts of a system, and how a motion of the base takes part in them.

use std::f64::consts::TAU;
use std::ops::Range;

use carom_algebra::eigen::{Count, Eigenpairs, lowest};
use carom_algebra::unknowns::Kind;
use carom_bodies::Body;
use carom_system::System;

use crate::error::Error;
use crate::matrices::{Group, Matrices, groups};

/// Part of the shift below which ω² is that of a rigid motion.
const RIGID: f64 = 1e-4;

/// How a mode φ with φᵀ M φ = 1 takes part in a motion r of the base, by direction: r is 1 in the translations along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Participation {
    /// Γ = φᵀ M r, √kg.
    pub factor: [f64; 3],
}

impl Participation {
    /// Effective modal mass Γ², kg; the sum over all modes is the mass that moves with unknowns that are not held.
    pub fn effective_mass(&self) -> [f64; 3] {
        self.factor.map(|factor| factor * factor)
    }
}

/// The lowest modes of one part.
#[derive(Clone, Debug)]
pub struct Modes {
    /// Indices of its bodies.
    pub bodies: Vec<usize>,
    /// Unknowns, held ones left out.
    pub unknowns: usize,
    /// Pairs of K φ = ω² M φ, over the unknowns of the part.
    pairs: Eigenpairs,
    ranges: Vec<Range<usize>>,
    /// Participation of each mode.
    pub participation: Vec<Participation>,
    /// Mass by direction, held nodes included, kg.
    pub mass: [f64; 3],
}

impl Modes {
    /// Number of modes.
    pub fn len(&self) -> usize {
        self.pairs.values.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.pairs.values.is_empty()
    }

    /// Number of modes that the part has.
    pub fn existing(&self) -> usize {
        self.pairs.existing
    }

    /// Whether a mode is a rigid motion: its ω² is zero to rounding.
    pub fn is_rigid(&self, mode: usize) -> bool {
        self.pairs.values[mode] < -RIGID * self.pairs.shift
    }

    /// Frequency of a mode, Hz; zero of a rigid motion.
    pub fn frequency(&self, mode: usize) -> f64 {
        match self.is_rigid(mode) {
            true => 0.0,
            false => self.pairs.values[mode].sqrt() / TAU,
        }
    }

    /// ω² of a mode, 1/s²: of a rigid motion the rounding that it is.
    pub fn square(&self, mode: usize) -> f64 {
        self.pairs.values[mode]
    }

    /// Bound of the relative error of the frequency of a mode against K and M, from its residual; none of a rigid motion.
    pub fn error(&self, mode: usize) -> Option<f64> {
        let value = self.pairs.values[mode];
        let bound = self.pairs.bounds[mode] * (value - self.pairs.shift);
        (!self.is_rigid(mode)).then(|| 0.5 * bound / value)
    }

    /// How many modes there are up to one near the last, by inertia, and how many of them were found.
    pub fn count(&self) -> Count {
        self.pairs.count
    }

    /// A mode over all unknowns of the system, zero in other parts; φᵀ M φ = 1.
    pub fn shape(&self, mode: usize, unknowns: usize) -> Vec<f64> {
        let mut whole = vec![0.0; unknowns];
        let all = self.ranges.iter().cloned().flatten();
        for (unknown, x) in all.zip(&self.pairs.vectors[mode]) {
            whole[unknown] = *x;
        }
        whole
    }

    fn new(
        system: &System,
        matrices: &Matrices,
        (group, count): (&Group, usize),
    ) -> Result<Modes, Error> {
        let names = || {
            group
                .bodies
                .iter()
                .map(|&body| system.bodies[body].name().to_owned())
        };
        let solved = group.problem(system, matrices, |problem| lowest(problem, count));
        let pairs = solved.map_err(|cause| Error::Eigenvalues {
            bodies: names().collect(),
            cause,
        })?;
        let unknowns = || group.ranges.iter().cloned().flatten();
        let mut modes = Modes {
            bodies: group.bodies.clone(),
            unknowns: unknowns().filter(|&i| !system.fixed[i]).count(),
            ranges: group.ranges.clone(),
            participation: vec![Participation { factor: [0.0; 3] }; pairs.values.len()],
            mass: [0.0; 3],
            pairs,
        };
        let (mut base, mut force) = (vec![0.0; system.unknowns()], Vec::new());
        for axis in 0..system.dim {
            base.fill(0.0);
            for unknown in unknowns() {
                if system.unknowns.kind(unknown) == Kind::Translation(axis) {
                    base[unknown] = 1.0;
                }
            }
            for (unknown, amplitude) in system.unknowns.amplitudes() {
                base[unknown] = amplitude.translation[axis];
            }
            force.resize(base.len(), 0.0);
            matrices.mass.multiply(&base, &mut force);
            let reduced = group.bodies.iter().map(|&body| &system.bodies[body]);
            for body in reduced.clone().filter_map(Body::as_reduced) {
                let missing = body.missing(axis).into_iter();
                missing.for_each(|(unknown, m)| force[unknown] += m);
            }
            let missing = reduced.filter_map(Body::as_reduced);
            modes.mass[axis] = unknowns().map(|i| base[i] * force[i]).sum::<f64>()
                + missing.map(|body| body.missing_mass(axis)).sum::<f64>();
            for (own, shape) in modes.participation.iter_mut().zip(&modes.pairs.vectors) {
                own.factor[axis] = unknowns().zip(shape).map(|(i, x)| force[i] * x).sum();
            }
        }
        Ok(modes)
    }
}

/// The `count` lowest modes of each part of a system, or all where there are fewer. `told`: called with each part when it is done.
///
/// # Errors
/// A part whose stiffness is not positive semi-definite; eigenvalues that do not converge.
pub fn modes(
    system: &System,
    count: usize,
    told: &mut dyn FnMut(usize, usize),
) -> Result<Vec<Modes>, Error> {
    let matrices = Matrices::new(system)?;
    let groups = groups(system);
    let mut all = Vec::with_capacity(groups.len());
    for (number, group) in groups.iter().enumerate() {
        all.push(Modes::new(system, &matrices, (group, count))?);
        told(number + 1, groups.len());
    }
    Ok(all)
}
