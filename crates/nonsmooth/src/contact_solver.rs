//! One entry to the interface problem, with and without friction.

use carom_laws::Status;
use thiserror::Error as ThisError;

use crate::Compliance;
use crate::coulomb::{Coulomb, FrictionFailure, Posed, Slip, Tangential};
use crate::interface::{Candidate, Failure, Interface};

/// What the points of a problem have in common.
pub struct Condensed<'a> {
    /// D over the rows of the candidates: the normal of each, with friction followed by its tangents.
    pub d: Compliance<'a>,
    /// Version of D: a factor of it is kept while it stands.
    pub version: u64,
    /// [s_g, s_v, s_t], the factors of D p in the gap, in the rate, and in the sliding quantity.
    pub s: [f64; 3],
    /// Tangents of a candidate: none without friction, 1 in the plane, 2 in space.
    pub tangents: usize,
    /// Defect over the largest force with which forces are taken where no nearer ones are found, with friction.
    pub tolerance: f64,
}

/// A problem that was not solved.
#[derive(Debug, ThisError)]
pub enum Unsolved {
    /// Without friction.
    #[error(transparent)]
    Normal(#[from] Failure),
    /// With friction.
    #[error(transparent)]
    Friction(#[from] FrictionFailure),
}

/// Forces and statuses of one candidate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointForces {
    /// Normal force, N, compressive positive.
    pub normal: f64,
    /// Friction force along the tangents, N.
    pub tangential: [f64; 2],
    /// Status of the law.
    pub status: Status,
    /// Status of friction.
    pub slip: Slip,
}

/// The candidates of a step, and what solves for their forces.
#[derive(Default)]
pub struct ContactSolver {
    /// What their laws know.
    pub candidates: Vec<Candidate>,
    /// What friction adds to each; not looked at without tangents.
    pub friction: Vec<Tangential>,
    /// The solver without friction.
    pub interface: Interface,
    /// The solver with friction.
    pub coulomb: Coulomb,
    rubs: bool,
}

impl ContactSolver {
    /// Solves for the forces and statuses of the candidates.
    ///
    /// # Errors
    /// [`Unsolved`].
    pub fn solve(&mut self, problem: Condensed) -> Result<(), Unsolved> {
        self.rubs = problem.tangents > 0;
        if !self.rubs {
            let d = (problem.d, problem.version);
            let s = [problem.s[0], problem.s[1]];
            return Ok(self.interface.solve(&self.candidates, d, s)?);
        }
        let posed = Posed {
            candidates: &self.candidates,
            friction: &self.friction,
            tangents: problem.tangents,
            d: problem.d,
            s: problem.s,
            tolerance: problem.tolerance,
        };
        Ok(self.coulomb.solve(&posed)?)
    }

    /// What the last solve found of a candidate.
    pub fn found(&self, candidate: usize) -> PointForces {
        let (interface, coulomb) = (&self.interface, &self.coulomb);
        match self.rubs {
            false => PointForces {
                normal: interface.forces[candidate],
                tangential: [0.0; 2],
                status: interface.statuses[candidate],
                slip: Slip::Open,
            },
            true => PointForces {
                normal: coulomb.forces[candidate],
                tangential: coulomb.tangential[candidate],
                status: coulomb.statuses[candidate],
                slip: coulomb.slips[candidate],
            },
        }
    }
}
