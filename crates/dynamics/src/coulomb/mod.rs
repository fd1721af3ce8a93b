//! The interface problem of one step with Coulomb friction: normal and tangential forces, statuses of both.
//!
//! With D the condensed compliance over the normal and tangential rows of all candidates and p = (P, t) their forces,
//! ```text
//! gap and rate     g₊ = g_f + s_g (D p)_n,   ġ₊ = ġ_f + s_v (D p)_n,   the relation of the law, as without friction
//! sliding          q = q_f + s_t (D p)_t     of the secondary over the primary
//! friction         |t| <= μ max(P, 0);   q = 0 where |t| < μ P,   else q = -α t with α >= 0
//! ```
//! t is the force on the secondary. In space the cone is round. Stick or slip is a sign field beside that of the normal.
//!
//! Method: the semi-smooth Newton method on the equations of Alart and Curnier (1991), [`trial`] and [`newton`]; in the
//! plane it moves from one set of statuses to the next. Where its passes bring nothing, sweeps of nonsmooth Gauss-Seidel
//! (Jean and Moreau 1992), [`sweep`], give it a better start, and the next passes are damped, then proximal; the number
//! of sweeps doubles each time. The methods are known, the texts of both papers were not at hand; the equations are
//! derived in [`trial`].
//!
//! Solutions exist for positive definite D, but for large μ there may be several. Nearly all such problems are solved in
//! about ten passes; where many contacts jam a body of few freedoms (D of low rank, μ of one and more) some are not, and
//! the error names the worst candidate.
//! [`FrictionProblem::defect`] measures a solution by code that knows no solver.

mod defect;
mod newton;
mod posed;
mod sweep;
#[cfg(test)]
mod tests;
mod trial;

use carom_contact::law::Status;
use serde::{Deserialize, Serialize};
use thiserror::Error as ThisError;

use crate::interface::Candidate;
pub(crate) use posed::Posed;
use trial::Trial;

/// Tangential status of a contact point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Slip {
    /// The point is open: no force.
    #[default]
    Open,
    /// q = 0.
    Stick,
    /// |t| = μ P; also without friction.
    Slip,
}

/// What friction adds to a candidate before the solve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tangential {
    /// μ, zero or more.
    pub mu: f64,
    /// q_f, in m or m/s, along each tangent; the second is not used in the plane.
    pub free: [f64; 2],
    /// Status at the end of the last step: a guess.
    pub slip: Slip,
    /// Tangential force of the last step, N: a point that slipped is first tried in this direction.
    pub force: [f64; 2],
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

    fn posed(&self) -> Posed<'_> {
        Posed {
            candidates: &self.candidates,
            friction: &self.friction,
            tangents: self.tangents,
            d: &self.compliance,
            s: self.factors,
            tolerance: self.tolerance,
        }
    }
}

/// Largest defect of a solution, relative to the terms that should balance in its candidate. Passes go on to it where they
/// can; where they bring nothing more, [`Posed::tolerance`] decides.
const TOLERANCE: f64 = 1e-12;
/// Newton passes without progress before sweeps.
const PATIENCE: usize = 10;
/// Newton passes of a round.
const PASSES: usize = 200;
/// Shift of the linear systems, and halvings of a pass whose whole length does not reduce the defects, in each round in
/// turn. The large shift makes proximal steps: where D is singular or the contacts jam, it keeps forces that little
/// decides from running away.
const MEANS: [(f64, i32); 3] = [(newton::SHIFT, 0), (newton::SHIFT, 8), (1e-3, 8)];
/// Sweeps of the first round; each further round makes twice as many.
const SWEEPS: usize = 16;
/// Rounds of passes and sweeps.
const ROUNDS: usize = 9;

/// Solver with its memory.
#[derive(Default)]
pub(crate) struct Coulomb {
    /// Normal force of each candidate, N.
    pub(crate) forces: Vec<f64>,
    /// Tangential force of each candidate, N.
    pub(crate) tangential: Vec<[f64; 2]>,
    /// Normal status of each candidate.
    pub(crate) statuses: Vec<Status>,
    /// Tangential status of each candidate.
    pub(crate) slips: Vec<Slip>,
    /// Newton passes of the last solve.
    pub(crate) passes: usize,
    /// Sweeps of the last solve.
    pub(crate) sweeps: usize,
    trial: Trial,
    best: Trial,
    start: Trial,
    change: Vec<f64>,
    reversals: Vec<u32>,
}

impl Coulomb {
    /// Solves for the forces and statuses.
    pub(crate) fn solve(&mut self, problem: &Posed) -> Result<(), FrictionFailure> {
        (self.passes, self.sweeps) = (0, 0);
        self.reversals.clear();
        self.reversals.resize(problem.len(), 0);
        self.change.clear();
        self.change.resize(problem.rows(), 0.0);
        self.trial.start(problem);
        self.best = self.trial.clone();
        self.best.merit = f64::INFINITY;
        for round in 0..ROUNDS {
            if self.newton(problem, MEANS[round % MEANS.len()]) {
                self.finish(problem);
                return Ok(());
            }
            self.trial = self.best.clone();
            if self.trial.is_near(problem) {
                self.finish(problem);
                return Ok(());
            }
            for _ in 0..SWEEPS << round {
                sweep::sweep(problem, &mut self.trial);
            }
            self.sweeps += SWEEPS << round;
            self.trial.measure(problem, &self.reversals);
            self.best = self.trial.clone();
        }
        if self.trial.worst.0 <= TOLERANCE || self.trial.is_near(problem) {
            self.finish(problem);
            return Ok(());
        }
        let (defect, candidate) = self.best.worst;
        Err(FrictionFailure {
            candidate,
            defect,
            passes: self.passes,
            sweeps: self.sweeps,
        })
    }

    /// Newton passes while they bring the trial nearer; whether it is a solution then. `best` is the nearest trial.
    /// `means`: shift and halvings.
    fn newton(&mut self, problem: &Posed, means: (f64, i32)) -> bool {
        let mut patience = PATIENCE;
        for _ in 0..PASSES {
            if patience == 0 {
                break;
            }
            if self.best.merit.is_finite() && self.trial.worst.0 <= TOLERANCE {
                return true;
            }
            self.passes += 1;
            if newton::step(problem, &self.trial, means.0, &mut self.change).is_err() {
                return false;
            }
            self.advance(problem, means.1);
            if self.trial.merit < 0.999 * self.best.merit {
                self.best.clone_from(&self.trial);
                patience = PATIENCE;
            } else {
                patience -= 1;
            }
        }
        false
    }

    /// Goes along the change, all the way or, within some halvings, as far as the defects fall; all the way if they
    /// never do.
    fn advance(&mut self, problem: &Posed, halvings: i32) {
        self.start.clone_from(&self.trial);
        for halving in (0..=halvings).chain([0]) {
            let share = 0.5_f64.powi(halving);
            self.trial.clone_from(&self.start);
            for (p, change) in self.trial.p.iter_mut().zip(&self.change) {
                *p += share * change;
            }
            self.trial.measure(problem, &self.reversals);
            if self.trial.merit < (1.0 - 0.01 * share) * self.start.merit {
                break;
            }
        }
        let statuses = self.trial.statuses.iter().zip(&self.start.statuses);
        for ((now, before), reversals) in statuses.zip(&mut self.reversals) {
            *reversals += u32::from(now != before);
        }
    }

    /// Takes the forces of the trial over, tension cut off where the law wants it.
    fn finish(&mut self, problem: &Posed) {
        let p = |row: usize| self.trial.p[row];
        self.statuses.clone_from(&self.trial.statuses);
        self.slips.clone_from(&self.trial.slips);
        self.forces.clear();
        self.tangential.clear();
        for (i, candidate) in problem.candidates.iter().enumerate() {
            let row = problem.normal(i);
            let cut = p(row) < 0.0 && candidate.law.get().clips();
            self.forces.push(if cut { 0.0 } else { p(row) });
            let second = if problem.tangents == 2 {
                p(row + 2)
            } else {
                0.0
            };
            self.tangential.push([p(row + 1), second]);
        }
    }
}
