//! One entry to the interface problem, with and without friction.

use std::ops::Range;

use carom_algebra::{Error as AlgebraError, Interrupt};
use thiserror::Error as ThisError;

use crate::Compliance;
use crate::coulomb::{Coulomb, FrictionFailure, Posed, Tangential};
use crate::interface::{Candidate, Failure, Interface};
use crate::point_forces::PointForces;

/// The candidates of a problem, and what friction adds to each.
#[derive(Clone, Copy)]
pub struct Candidates<'a> {
    /// The candidates.
    pub normal: &'a [Candidate],
    /// Friction of each; empty without friction.
    pub friction: &'a [Tangential],
}

/// The same, kept.
#[derive(Clone, Debug, Default)]
pub struct CandidateData {
    /// The candidates.
    pub normal: Vec<Candidate>,
    /// Friction of each; empty without friction.
    pub friction: Vec<Tangential>,
}

impl CandidateData {
    /// Leaves none.
    pub fn clear(&mut self) {
        self.normal.clear();
        self.friction.clear();
    }

    /// All of them.
    #[must_use]
    pub fn all(&self) -> Candidates<'_> {
        self.within(0..self.normal.len())
    }

    /// Some that follow each other.
    #[must_use]
    pub fn within(&self, range: Range<usize>) -> Candidates<'_> {
        Candidates {
            normal: &self.normal[range.clone()],
            friction: self.friction.get(range).unwrap_or_default(),
        }
    }

    /// Those at some places.
    #[must_use]
    pub fn at(&self, places: &[u32]) -> CandidateData {
        let places = || places.iter().map(|&place| place as usize);
        let friction = places().filter_map(|place| self.friction.get(place));
        CandidateData {
            normal: places().map(|place| self.normal[place]).collect(),
            friction: friction.copied().collect(),
        }
    }
}

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
    /// Iterations that find motion and forces together did not end.
    #[error("iterations of motion and contact forces did not end: {cause}")]
    Iterations {
        /// The unknown with the largest residual.
        unknown: usize,
        /// Cause.
        cause: AlgebraError,
    },
}

/// Solves for the forces of contact points.
#[derive(Default)]
pub struct ContactSolver {
    /// Forces and statuses of each candidate.
    pub found: Vec<PointForces>,
    /// Passes of the status loop of the last solve without friction.
    pub passes: usize,
    /// The candidate from which on statuses changed one at a time, if blocks of changes went in circles.
    pub circled: Option<usize>,
    /// A candidate whose tension was cut off, where points that lose and regain their forces by turns did not settle.
    pub unsettled: Option<usize>,
    interface: Interface,
    coulomb: Coulomb,
}

impl ContactSolver {
    /// Ends solves without a solution where this is set.
    pub fn heed(&mut self, interrupt: &Interrupt) {
        self.interface.interrupt.clone_from(interrupt);
        self.coulomb.interrupt.clone_from(interrupt);
    }

    /// Forgets what was found, and has `n` open candidates in its place: those of problems that others solve.
    pub fn open(&mut self, n: usize) {
        self.found.clear();
        self.found.resize(n, PointForces::default());
        (self.passes, self.circled, self.unsettled) = (0, None, None);
    }

    /// Solves for the forces and statuses of the candidates.
    ///
    /// # Errors
    /// [`Unsolved`].
    pub fn solve(&mut self, points: Candidates, problem: &Condensed) -> Result<(), Unsolved> {
        self.open(0);
        match problem.tangents {
            0 => self.solve_normal(points.normal, problem),
            _ => self.solve_rubbing(points, problem),
        }
    }

    fn solve_normal(
        &mut self,
        candidates: &[Candidate],
        problem: &Condensed,
    ) -> Result<(), Unsolved> {
        let s = [problem.s[0], problem.s[1]];
        let solver = &mut self.interface;
        let solved = solver.solve(candidates, (problem.d, problem.version), s);
        solved.map_err(|failure| match failure {
            Failure::Singular {
                cause: cause @ AlgebraError::Iterations { unknown, .. },
                ..
            } => Unsolved::Iterations { unknown, cause },
            other => Unsolved::Normal(other),
        })?;
        let both = solver.forces.iter().zip(&solver.statuses);
        self.found
            .extend(both.map(|(&normal, &status)| PointForces {
                normal,
                status,
                ..PointForces::default()
            }));
        (self.passes, self.circled) = (solver.passes, solver.circled);
        self.unsettled = solver.unsettled;
        Ok(())
    }

    fn solve_rubbing(&mut self, points: Candidates, problem: &Condensed) -> Result<(), Unsolved> {
        let solver = &mut self.coulomb;
        let solved = solver.solve(&Posed {
            candidates: points.normal,
            friction: points.friction,
            tangents: problem.tangents,
            d: problem.d,
            s: problem.s,
            tolerance: problem.tolerance,
        });
        match (solved, solver.cause.take()) {
            (Ok(()), _) => {}
            (Err(_), Some(cause @ AlgebraError::Iterations { unknown, .. })) => {
                return Err(Unsolved::Iterations { unknown, cause });
            }
            (Err(failure), _) => return Err(Unsolved::Friction(failure)),
        }
        self.found.extend(solver.found());
        Ok(())
    }
}
