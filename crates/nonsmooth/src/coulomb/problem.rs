//! A problem with friction that stands by itself.

use carom_laws::Status;
use serde::{Deserialize, Serialize};

use super::{Coulomb, FrictionFailure, Posed, Slip, Tangential};
use crate::Compliance;
use crate::interface::Candidate;

/// A problem with friction by itself: what a failed step leaves on disk, to be looked at and solved again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrictionProblem {
    /// Number of the step.
    pub step: u64,
    /// Contact, point and mesh node of each candidate.
    pub names: Vec<String>,
    /// The candidates.
    pub candidates: Vec<Candidate>,
    /// What friction adds to each.
    pub friction: Vec<Tangential>,
    /// Tangents of a candidate: 1 in the plane, 2 in space.
    pub tangents: usize,
    /// D, row-major: for each candidate its normal row, then its tangential rows.
    pub compliance: Vec<f64>,
    /// Factors [s_g, s_v, s_t] of D p in the gap, in the rate, and in the sliding quantity.
    pub factors: [f64; 3],
    /// Defect over the largest force with which forces are taken where no nearer ones are found.
    pub tolerance: f64,
}

/// Solution of a problem with friction.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionSolution {
    /// Normal force of each candidate, N.
    pub forces: Vec<f64>,
    /// Tangential force of each candidate on the secondary, N.
    pub tangential: Vec<[f64; 2]>,
    /// Normal status of each candidate.
    pub statuses: Vec<Status>,
    /// Tangential status of each candidate.
    pub slips: Vec<Slip>,
    /// Newton passes made.
    pub passes: usize,
    /// Sweeps that were needed besides.
    pub sweeps: usize,
}

impl FrictionProblem {
    /// Solves the problem as the step would.
    ///
    /// # Errors
    /// No solution was found.
    pub fn solve(&self) -> Result<FrictionSolution, FrictionFailure> {
        let mut coulomb = Coulomb::default();
        coulomb.solve(&self.posed())?;
        Ok(FrictionSolution {
            forces: coulomb.forces,
            tangential: coulomb.tangential,
            statuses: coulomb.statuses,
            slips: coulomb.slips,
            passes: coulomb.passes,
            sweeps: coulomb.sweeps,
        })
    }

    pub(super) fn posed(&self) -> Posed<'_> {
        Posed {
            candidates: &self.candidates,
            friction: &self.friction,
            tangents: self.tangents,
            d: Compliance::Dense(&self.compliance),
            s: self.factors,
            tolerance: self.tolerance,
        }
    }
}
