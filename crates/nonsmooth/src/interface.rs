//! The interface problem of one step: forces and statuses of the candidate contact points.
//!
//! At the end of the step, gap and rate of the candidates are `g₊ = g_f + s_g D P`, `ġ₊ = ġ_f + s_v D P`, with D the
//! condensed compliance. With frozen statuses, the law of a closed point is linear; divided by its factor of D P it
//! reads `(D P)_i + κ_i P_i = -q_i`: a symmetric positive definite system over the closed points. Statuses follow the
//! solution until none changes (semi-smooth Newton, primal-dual active set). Where blocks of changes do not reduce the
//! number of points that disagree, one point at a time changes, the last first: for laws without corner this ends on
//! every positive definite D (Murty; Júdice and Pires 1994, block principal pivoting). Laws that are not linear give their tangents,
//! which are renewed around this (`renewed.rs`).
//!
//! The equations are solved by a dense factor, or, where D is the product of sparse rows or not known, by conjugate gradients.

use carom_algebra::Interrupt;
use carom_algebra::dense::DenseCholesky;
use carom_laws::{End, Relation, Status};

use crate::Compliance;
use crate::tangents::{Tangents, are_linear};
use iterated::Iterated;
use serde::{Deserialize, Serialize};
use thiserror::Error as ThisError;

pub use candidate::Candidate;

/// Why the problem was not solved.
#[derive(Debug, ThisError)]
pub enum Failure {
    /// The closed points' matrix is not positive definite.
    #[error("the matrix of {points} closed points is singular: {cause}")]
    Singular {
        /// Closed points.
        points: usize,
        /// Cause.
        cause: carom_algebra::Error,
    },
    /// A candidate still changes after all passes.
    #[error("candidate {candidate} still changes after {passes} passes")]
    Cycling {
        /// Passes made.
        passes: usize,
        /// The candidate.
        candidate: usize,
    },
    /// Somebody asked for the end.
    #[error("interrupted after {passes} passes")]
    Interrupted {
        /// Passes made.
        passes: usize,
    },
}

/// An interface problem by itself: what a failed step leaves on disk, to be looked at and solved again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct InterfaceProblem {
    /// Number of the step.
    pub step: u64,
    /// Contact, point and mesh node of each candidate.
    pub names: Vec<String>,
    /// The candidates.
    pub candidates: Vec<Candidate>,
    /// D over the candidates, row-major.
    pub compliance: Vec<f64>,
    /// Factors [s_g, s_v] of D P in the gap and in the rate.
    pub factors: [f64; 2],
}

/// Solution of an interface problem.
#[derive(Clone, Debug, PartialEq)]
pub struct InterfaceSolution {
    /// Force of each candidate, N.
    pub forces: Vec<f64>,
    /// Status of each candidate.
    pub statuses: Vec<Status>,
    /// Passes of the status loop.
    pub passes: usize,
    /// Whether blocks of changes went in circles, so that statuses then changed one at a time.
    pub circled: bool,
}

impl InterfaceProblem {
    /// Solves the problem as the step would.
    ///
    /// # Errors
    /// A singular problem, or statuses that do not settle.
    pub fn solve(&self) -> Result<InterfaceSolution, Failure> {
        let mut interface = Interface::default();
        let compliance = Compliance::Dense(&self.compliance);
        interface.solve(&self.candidates, (compliance, 1), self.factors)?;
        Ok(InterfaceSolution {
            forces: interface.forces,
            statuses: interface.statuses,
            passes: interface.passes,
            circled: interface.circled.is_some(),
        })
    }
}

/// Residual up to which motion and forces are found together by iterations while statuses change.
const ROUGH: f64 = 1e-3;

/// Blocks of changes without progress before single changes.
const PATIENCE: usize = 10;

/// Pivot of D, over its diagonal, up to which points count as dependent: rounding leaves 1e-15.
const DEPENDENT: f64 = 1e-13;

/// Part by which the diagonal of D grows where points are dependent, as two nodes of a surface that faces itself that meet
/// each other's faces. Their forces then differ from those of an exact law by that part of the gaps that they close.
const SHIFT: f64 = 1e-12;

/// Solver with its memory: scratch, and the factor of the last closed set.
#[derive(Default)]
pub struct Interface {
    /// Force of each candidate, N.
    pub forces: Vec<f64>,
    /// Status of each candidate.
    pub statuses: Vec<Status>,
    /// Passes of the last solve.
    pub passes: usize,
    /// The candidate from which on statuses changed one at a time, if blocks of changes went in circles.
    pub circled: Option<usize>,
    /// A candidate whose tension was cut off, where points that lose and regain their forces by turns did not settle.
    pub unsettled: Option<usize>,
    /// Ends passes without a solution where it is set.
    pub interrupt: Interrupt,
    factor: Option<DenseCholesky>,
    factor_of: (u64, Vec<(u32, Status)>),
    iterated: Iterated,
    /// Room for its matrix.
    matrix: Vec<f64>,
    /// Compliances of their own of the closed points, x per N: at hand, and those of the factor.
    own: [Vec<f64>; 2],
    /// Points that are not open.
    closed: Vec<(u32, Status)>,
    /// Those whose gap or rate depends on the forces of the step, and their numbers.
    coupled: Vec<(u32, Status)>,
    numbers: Vec<u32>,
    rhs: Vec<f64>,
    product: Vec<f64>,
    reversals: Vec<u32>,
    changes: Vec<u32>,
    /// Tolerance of iterations beyond their own.
    rough: f64,
    tangents: Tangents,
}

impl Interface {
    /// Solves for the forces and statuses. Relations of laws that are not linear are renewed until they stand.
    ///
    /// `compliance`: D over the candidates, and its version; `s`: [s_g, s_v], the factors of x in the gap and
    /// in the rate.
    pub fn solve(
        &mut self,
        candidates: &[Candidate],
        compliance: (Compliance, u64),
        s: [f64; 2],
    ) -> Result<(), Failure> {
        if are_linear(candidates) {
            return self.settle(candidates, compliance, s);
        }
        let mut tangents = std::mem::take(&mut self.tangents);
        tangents.begin(candidates);
        let solved = self.renew(&mut tangents, compliance, s);
        self.tangents = tangents;
        solved
    }

    /// Solves for the forces and statuses, with the relations of the candidates as they are.
    fn settle(
        &mut self,
        candidates: &[Candidate],
        compliance: (Compliance, u64),
        s: [f64; 2],
    ) -> Result<(), Failure> {
        let n = candidates.len();
        self.statuses.clear();
        // a corner is found anew in each step, from a closed point that opens
        self.statuses
            .extend(
                candidates
                    .iter()
                    .enumerate()
                    .map(|(i, candidate)| match candidate.status {
                        _ if is_stuck(candidate, i, compliance.0, n) => Status::Open,
                        Status::Open => Status::Open,
                        Status::Closed | Status::Corner => Status::Closed,
                        Status::Piece(piece) => Status::Piece(piece),
                    }),
            );
        self.reversals.clear();
        self.reversals.resize(n, 0);
        (self.circled, self.unsettled) = (None, None);
        self.rough = match compliance.0 {
            Compliance::Iterated(_) => ROUGH,
            Compliance::Dense(_) | Compliance::Lumped(_) => 0.0,
        };
        let (mut fewest, mut patience) = (usize::MAX, PATIENCE);
        let limit = 50 + 10 * n;
        for pass in 1..=limit {
            if self.interrupt.is_set() {
                return Err(Failure::Interrupted { passes: pass - 1 });
            }
            self.passes = pass;
            if pass > limit / 2 {
                self.rough = 0.0;
            }
            self.equalities(candidates, compliance, s)?;
            self.disagreements(candidates, compliance.0, s);
            let Some(&last) = self.changes.last() else {
                if self.rough == 0.0 {
                    return self.clip(candidates, compliance, s);
                }
                // statuses that stand are looked at again with all digits, and then solved for with them
                self.rough = 0.0;
                continue;
            };
            if self.changes.len() < fewest {
                (fewest, patience) = (self.changes.len(), PATIENCE);
            } else if patience > 0 {
                patience -= 1;
            } else {
                self.circled.get_or_insert(last as usize);
                self.changes.clear();
                self.changes.push(last);
            }
            for &i in &self.changes {
                let i = i as usize;
                let end = end(
                    &candidates[i],
                    i,
                    compliance.0,
                    s,
                    &self.forces,
                    &self.product,
                );
                self.statuses[i] = candidates[i].law.get().status(
                    self.statuses[i],
                    &end,
                    &candidates[i].local,
                    self.reversals[i],
                );
                self.reversals[i] += 1;
            }
            if pass == limit {
                return Err(Failure::Cycling {
                    passes: pass,
                    candidate: last as usize,
                });
            }
        }
        Ok(())
    }

    /// Forces for the frozen statuses, and D P.
    fn equalities(
        &mut self,
        candidates: &[Candidate],
        (d, version): (Compliance, u64),
        s: [f64; 2],
    ) -> Result<(), Failure> {
        let n = candidates.len();
        self.closed.clear();
        let statuses = self.statuses.iter().enumerate();
        self.closed.extend(
            statuses
                .filter(|(_, status)| **status != Status::Open)
                .map(|(i, &status)| (i as u32, status)),
        );
        self.forces.clear();
        self.forces.resize(n, 0.0);
        self.product.clear();
        self.product.resize(n, 0.0);
        let relation = |i: u32, status: Status| {
            let candidate = &candidates[i as usize];
            candidate.law.get().relation(status, &candidate.local)
        };
        let free = |i: u32, relation: &Relation| {
            let candidate = &candidates[i as usize];
            relation.gap * candidate.local.gap_free
                + relation.rate * candidate.rate_free
                + relation.offset
        };
        let scale = |i: u32, relation: &Relation| {
            let [gap, rate] = candidates[i as usize].factors(s);
            relation.gap * gap + relation.rate * rate
        };
        // Where neither gap nor rate depends on the forces of the step, a compliant law says its force at once.
        self.coupled.clear();
        for &(i, status) in &self.closed {
            let relation = relation(i, status);
            if scale(i, &relation) == 0.0 {
                self.forces[i as usize] = -free(i, &relation) / relation.compliance;
            } else {
                self.coupled.push((i, status));
            }
        }
        self.multiply(d)?;
        let own = |i: u32, status| {
            let relation = relation(i, status);
            let shift = match d {
                Compliance::Iterated(saddle) if candidates[i as usize].faces_itself => {
                    SHIFT * saddle.borrow().diagonal(i as usize)
                }
                _ => 0.0,
            };
            relation.compliance / scale(i, &relation) + shift
        };
        // of a compliant law they depend on the size of the step, on which an explicit D does not
        let [at_hand, of_factor] = &mut self.own;
        at_hand.clear();
        at_hand.extend(self.coupled.iter().map(|&(i, status)| own(i, status)));
        let stands = self.factor_of.0 == version && self.factor_of.1 == self.coupled;
        if let (Compliance::Dense(d), true) = (d, !stands || at_hand != of_factor) {
            of_factor.clone_from(at_hand);
            let shared = |i: u32| candidates[i as usize].faces_itself;
            self.factor_of.1.clear();
            let room = (&mut self.factor, &mut self.matrix);
            factor(&self.coupled, (d, n), own, shared, room)?;
            self.factor_of.0 = version;
            self.factor_of.1.clone_from(&self.coupled);
        }
        if self.coupled.is_empty() && !matches!(d, Compliance::Iterated(_)) {
            return Ok(());
        }
        self.rhs.clear();
        self.rhs.extend(self.coupled.iter().map(|&(i, status)| {
            let relation = relation(i, status);
            -free(i, &relation) / scale(i, &relation) - self.product[i as usize]
        }));
        self.solve_coupled(d)
    }

    /// Forces of the coupled candidates for the right-hand side at hand, and D P.
    fn solve_coupled(&mut self, d: Compliance) -> Result<(), Failure> {
        match (d, &self.factor) {
            (Compliance::Lumped(d), _) => {
                let own = &self.own[0];
                self.iterated
                    .solve(d, (&self.coupled, own), &mut self.rhs)
                    .map_err(|cause| Failure::Singular {
                        points: self.coupled.len(),
                        cause,
                    })?;
            }
            (Compliance::Iterated(saddle), _) => {
                self.numbers.clear();
                self.numbers.extend(self.coupled.iter().map(|(i, _)| *i));
                let (numbers, own) = (&self.numbers[..], &self.own[0][..]);
                let mut saddle_now = saddle.borrow_mut();
                let solved = saddle_now.solve((numbers, own), self.rough, &mut self.rhs);
                drop(saddle_now);
                solved.map_err(|cause| Failure::Singular {
                    points: numbers.len(),
                    cause,
                })?;
                for (&(i, _), &force) in self.coupled.iter().zip(&self.rhs) {
                    self.forces[i as usize] = force;
                }
                let saddle = saddle.borrow();
                for (i, product) in self.product.iter_mut().enumerate() {
                    *product = saddle.along(i);
                }
                return Ok(());
            }
            (Compliance::Dense(_), Some(factor)) => factor.solve(&mut self.rhs),
            (Compliance::Dense(_), None) => {}
        }
        for (&(i, _), &force) in self.coupled.iter().zip(&self.rhs) {
            self.forces[i as usize] = force;
        }
        self.multiply(d)
    }

    /// D P.
    fn multiply(&mut self, d: Compliance) -> Result<(), Failure> {
        let n = self.forces.len();
        match d {
            Compliance::Dense(d) => {
                for (i, product) in self.product.iter_mut().enumerate() {
                    *product = self
                        .closed
                        .iter()
                        .map(|&(j, _)| d[i * n + j as usize] * self.forces[j as usize])
                        .sum();
                }
            }
            Compliance::Lumped(d) => self.iterated.multiply(d, &self.forces, &mut self.product),
            Compliance::Iterated(saddle) => {
                let mut saddle = saddle.borrow_mut();
                let refused = |cause| Failure::Singular { points: n, cause };
                if saddle.give(&self.forces).map_err(refused)? {
                    for (i, product) in self.product.iter_mut().enumerate() {
                        *product = saddle.along_given(i);
                    }
                }
            }
        }
        Ok(())
    }

    /// Candidates whose law asks for another status.
    fn disagreements(&mut self, candidates: &[Candidate], d: Compliance, s: [f64; 2]) {
        self.changes.clear();
        for (i, candidate) in candidates.iter().enumerate() {
            if is_stuck(candidate, i, d, candidates.len()) {
                continue;
            }
            let end = end(candidate, i, d, s, &self.forces, &self.product);
            if candidate.law.get().status(
                self.statuses[i],
                &end,
                &candidates[i].local,
                self.reversals[i],
            ) != self.statuses[i]
            {
                self.changes.push(i as u32);
            }
        }
    }

    /// Cuts off the tension of laws that do not take it: the force is then zero, and the other points are solved for anew
    /// without it. A point comes back where its law presses after all.
    fn clip(
        &mut self,
        candidates: &[Candidate],
        compliance: (Compliance, u64),
        s: [f64; 2],
    ) -> Result<(), Failure> {
        let mut cut: Vec<(usize, Status)> = Vec::new();
        let mut settled = candidates.is_empty();
        for _ in 0..2 * candidates.len() {
            let before = cut.len();
            for (i, candidate) in candidates.iter().enumerate() {
                if self.forces[i] < 0.0 && candidate.law.get().clips() {
                    cut.push((i, self.statuses[i]));
                    self.statuses[i] = Status::Open;
                }
            }
            if cut.len() == before {
                let presses = |&(i, status): &(usize, Status)| {
                    let candidate = &candidates[i];
                    let end = end(candidate, i, compliance.0, s, &self.forces, &self.product);
                    let relation = candidate.law.get().relation(status, &candidate.local);
                    relation.gap * end.gap + relation.rate * end.rate + relation.offset < 0.0
                };
                let Some(back) = cut.iter().position(presses) else {
                    settled = true;
                    break;
                };
                let (i, status) = cut.remove(back);
                self.statuses[i] = status;
            }
            self.equalities(candidates, compliance, s)?;
        }
        if !settled {
            self.unsettled = Some(cut.first().map_or(0, |(i, _)| *i));
        }
        for (i, status) in cut {
            self.statuses[i] = status;
        }
        for (force, candidate) in self.forces.iter_mut().zip(candidates) {
            if candidate.law.get().clips() {
                *force = force.max(0.0);
            }
        }
        Ok(())
    }
}

/// Renews the factor of D over some points of `n`, with their own compliance on the diagonal; not for no point. Points of
/// surfaces that face themselves may say the same: [`SHIFT`] then tells them apart, and they share their force. `shared`: whether a
/// point is one.
fn factor(
    points: &[(u32, Status)],
    (d, n): (&[f64], usize),
    own: impl Fn(u32, Status) -> f64,
    shared: impl Fn(u32) -> bool,
    (held, matrix): (&mut Option<DenseCholesky>, &mut Vec<f64>),
) -> Result<(), Failure> {
    if points.is_empty() {
        return Ok(());
    }
    let mut renew = |shift: f64| {
        matrix.clear();
        for &(i, status) in points {
            matrix.extend(points.iter().map(|&(j, _)| {
                let entry = d[i as usize * n + j as usize];
                match i == j {
                    true if shared(i) => entry * (1.0 + shift) + own(i, status),
                    true => entry + own(i, status),
                    false => entry,
                }
            }));
        }
        match held {
            Some(factor) => factor.renew(points.len(), matrix)?,
            None => *held = Some(DenseCholesky::new(points.len(), matrix)?),
        }
        Ok(held.as_ref().map_or(0.0, DenseCholesky::least_pivot))
    };
    let renewed = match renew(0.0) {
        Ok(pivot) if pivot > DEPENDENT => Ok(pivot),
        other if points.iter().all(|&(i, _)| !shared(i)) => other,
        _ => renew(SHIFT),
    };
    renewed.map(|_| ()).map_err(|cause| Failure::Singular {
        points: points.len(),
        cause,
    })
}

/// Whether no force moves a point, all of its nodes being held, and its law does not say the force either: it carries none.
fn is_stuck(candidate: &Candidate, i: usize, d: Compliance, n: usize) -> bool {
    let relation = candidate
        .law
        .get()
        .relation(Status::Closed, &candidate.local);
    diagonal(d, i, n) == 0.0 && relation.compliance == 0.0
}

fn diagonal(d: Compliance, i: usize, n: usize) -> f64 {
    match d {
        Compliance::Dense(d) => d[i * n + i],
        Compliance::Lumped(d) => d.block(i, 0, 0),
        Compliance::Iterated(saddle) => saddle.borrow().diagonal(i),
    }
}

fn end(
    candidate: &Candidate,
    i: usize,
    d: Compliance,
    s: [f64; 2],
    forces: &[f64],
    product: &[f64],
) -> End {
    let own = diagonal(d, i, forces.len()) * forces[i];
    let s = candidate.factors(s);
    // In a closed point of an exact law the gap or the rate is zero by construction, and its sign but rounding: the
    // laws look at the force there.
    End {
        gap_released: candidate.local.gap_free + s[0] * (product[i] - own),
        gap: candidate.local.gap_free + s[0] * product[i],
        rate: candidate.rate_free + s[1] * product[i],
        force: forces[i],
    }
}

mod candidate;
mod iterated;
mod renewed;
#[cfg(test)]
mod tests;
