//! What friction adds to a candidate, and what a solver that finds no solution says.

use serde::{Deserialize, Serialize};
use thiserror::Error as ThisError;

/// Tangential status of a contact point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Slip {
    /// The point is open: no force.
    #[default]
    Open,
    /// q = 0.
    Stick,
    /// |t| = μ P, with the lower μ of sliding where there is one; also without friction.
    Slip,
}

/// What friction adds to a candidate before the solve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tangential {
    /// μ, zero or more.
    pub mu: f64,
    /// μ of a point that slides, where it is lower: such a point sticks with |t| <= `mu` P, otherwise |t| = `sliding` P.
    #[serde(default)]
    pub sliding: Option<f64>,
    /// q_f, in m or m/s, along each tangent; the second is not used in the plane.
    pub free: [f64; 2],
    /// Status at the end of the last iteration or step: a guess.
    pub slip: Slip,
    /// Tangential force of the last iteration or step, N: a point that slipped is first tried in this direction.
    pub force: [f64; 2],
    /// Normal force of the last iteration or step, N: sweeps begin with it.
    #[serde(default)]
    pub pressed: f64,
}

/// A problem with friction was not solved.
#[derive(Clone, Copy, Debug, PartialEq, ThisError)]
#[error(
    "candidate {candidate} violates its laws by {defect:e} of its forces after {passes} passes and {sweeps} sweeps"
)]
pub struct FrictionFailure {
    /// The candidate with the largest defect.
    pub candidate: usize,
    /// Its defect, relative to the terms that should balance.
    pub defect: f64,
    /// Newton passes made.
    pub passes: usize,
    /// Sweeps made.
    pub sweeps: usize,
}
