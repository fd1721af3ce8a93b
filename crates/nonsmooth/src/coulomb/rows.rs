//! The rows that a pass solves for where D is not known.

use std::cell::RefCell;
use std::mem;

use carom_algebra::Error;
use carom_algebra::solver::Saddle;
use carom_laws::Status;

use super::posed::Alone;
use super::trial::Trial;
use super::{Posed, Slip};

/// b/|t - ρ q| below which the direction of slip is that of the sliding, whatever the force.
const TURNS: f64 = 1e-6;

/// Compliance of tangents over that of their nodes, where rows depend on each other.
pub(super) const SHIFT: f64 = 1e-10;

/// What a pass solves for: rows of the problem with the forces of others given.
#[derive(Default)]
pub(super) struct Rows {
    /// Rows of [`Saddle`], ascending, their own compliances, and what they are to be; then their forces.
    numbers: Vec<u32>,
    own: Vec<f64>,
    b: Vec<f64>,
    /// Forces of the other rows, N.
    given: Vec<f64>,
    /// Of candidates that move along one tangent alone the row along it, and its direction.
    along: Vec<Option<(u32, [f64; 2])>>,
    /// What of these is solved for: row, compliance and what it is to be.
    further: Vec<(u32, f64, f64)>,
    /// Rows of the saddle before those of a pass, and of slipping candidates the row across their direction, with its own direction.
    count: usize,
    across: Vec<(usize, u32, [f64; 2])>,
    /// Candidates whose tension their law has cut off.
    pub(super) cut: Vec<bool>,
    /// Compliance of tangents over that of their nodes.
    pub(super) shift: f64,
}

impl Rows {
    pub(super) fn begin(&mut self, problem: &Posed, alone: &[Alone], saddle: &RefCell<Saddle>) {
        let mut saddle = saddle.borrow_mut();
        self.shift = 0.0;
        self.cut.clear();
        self.cut.resize(problem.len(), false);
        self.along.clear();
        for (i, alone) in alone.iter().enumerate() {
            let direction = alone.only_direction(problem.tangents);
            self.along.push(direction.map(|of| {
                let row = problem.normal(i) as u32;
                (saddle.add_row_along([row + 1, row + 2], of), of)
            }));
        }
        self.count = problem.rows() + self.along.iter().flatten().count();
    }

    /// The rows that are solved for with the statuses of a trial, and the forces of the others.
    /// Slip forces go a `share` of the way to what the trial asks for.
    pub(super) fn pose(
        &mut self,
        (problem, share): (&Posed, f64),
        trial: &Trial,
        saddle: &RefCell<Saddle>,
    ) {
        self.set_across(problem, trial, saddle);
        let saddle = saddle.borrow();
        for list in [&mut self.own, &mut self.b, &mut self.given] {
            list.clear();
        }
        self.numbers.clear();
        self.given.resize(problem.rows(), 0.0);
        let mut further = mem::take(&mut self.further);
        further.clear();
        for i in 0..problem.len() {
            if trial.statuses[i] == Status::Open || self.cut[i] {
                continue;
            }
            let (row, candidate) = (problem.normal(i), &problem.candidates[i]);
            let shared = if candidate.faces_itself {
                SHIFT
            } else {
                self.shift
            };
            let relation = problem.relation(i, trial.statuses[i]);
            let (factor, free) = (problem.factor(i, &relation), problem.free(i, &relation));
            if factor == 0.0 {
                self.given[row] = -free / relation.compliance;
            } else {
                let shift = match candidate.faces_itself {
                    true => SHIFT * saddle.diagonal(row),
                    false => 0.0,
                };
                self.push(
                    row as u32,
                    relation.compliance / factor + shift,
                    -free / factor,
                );
            }
            let mu = problem.friction[i].mu;
            if mu == 0.0 {
                continue;
            }
            if trial.slips[i] == Slip::Slip {
                let bound = mu * trial.p[row].max(0.0);
                for k in 0..problem.tangents {
                    let before = trial.p[row + 1 + k];
                    let asked = bound * trial.directions[i][k];
                    self.given[row + 1 + k] = before + share * (asked - before);
                }
                continue;
            }
            let free = problem.friction[i].free.map(|free| -free / problem.s[2]);
            let mobile = trial.alone[i].mobile;
            match self.along[i] {
                Some((number, of)) => {
                    further.push((number, shared, of[0] * free[0] + of[1] * free[1]))
                }
                None if mobile[0][0] < 0.5 => {}
                None => {
                    for (k, free) in free.into_iter().enumerate().take(problem.tangents) {
                        let row = row + 1 + k;
                        self.push(row as u32, shared * saddle.diagonal(row), free);
                    }
                }
            }
        }
        for &(number, shared, free) in &further {
            self.push(number, shared * saddle.diagonal(number as usize), free);
        }
        self.further = further;
        let across = mem::take(&mut self.across);
        for &(i, number, of) in &across {
            let free = &problem.friction[i].free;
            let free = -(of[0] * free[0] + of[1] * free[1]) / problem.s[2];
            // t - ρ q keeps its direction where (1 - c) t + c ρ q = 0 across it
            let c = trial.curvatures[i];
            let own = (1.0 - c) / (c * problem.weight(i) * problem.s[2]);
            self.push(number, own, free);
        }
        self.across = across;
    }

    /// Makes the rows across the directions of slip, along which the force of a point turns with its sliding: as that of a dashpot.
    fn set_across(&mut self, problem: &Posed, trial: &Trial, saddle: &RefCell<Saddle>) {
        let mut saddle = saddle.borrow_mut();
        saddle.keep_rows(self.count);
        self.across.clear();
        if problem.tangents < 2 {
            return;
        }
        for i in 0..problem.len() {
            let slips = trial.slips[i] == Slip::Slip && trial.statuses[i] != Status::Open;
            let moves = self.along[i].is_none() && trial.alone[i].mobile[0][0] > 0.5;
            let c = trial.curvatures[i];
            if !(slips && moves && !self.cut[i] && (TURNS..1.0).contains(&c)) {
                continue;
            }
            let [x, y] = trial.directions[i];
            let row = problem.normal(i) as u32;
            let number = saddle.add_row_along([row + 1, row + 2], [-y, x]);
            self.across.push((i, number, [-y, x]));
        }
    }

    fn push(&mut self, number: u32, own: f64, b: f64) {
        self.numbers.push(number);
        self.own.push(own);
        self.b.push(b);
    }

    pub(super) fn solve(&mut self, saddle: &RefCell<Saddle>, tolerance: f64) -> Result<(), Error> {
        let mut saddle = saddle.borrow_mut();
        saddle.load_with(&self.given);
        saddle.solve((&self.numbers, &self.own), tolerance, &mut self.b)
    }

    /// The forces found, into a trial.
    pub(super) fn take(&self, problem: &Posed, trial: &mut Trial) {
        trial.p.copy_from_slice(&self.given);
        let own = self
            .numbers
            .partition_point(|number| (*number as usize) < problem.rows());
        for (&number, &force) in self.numbers[..own].iter().zip(&self.b) {
            trial.p[number as usize] = force;
        }
        let (further, forces) = (&self.numbers[own..], &self.b[own..]);
        let along = self.along.iter().enumerate();
        let along = along.filter_map(|(i, along)| along.map(|(number, of)| (i, number, of)));
        for (i, number, of) in along.chain(self.across.iter().copied()) {
            if let Ok(place) = further.binary_search(&number) {
                let (row, force) = (problem.normal(i), forces[place]);
                trial.p[row + 1] += force * of[0];
                trial.p[row + 2] += force * of[1];
            }
        }
    }

    /// Whether laws cut tension off that a trial has: these points have no force from here on.
    pub(super) fn cuts(&mut self, problem: &Posed, trial: &Trial) -> bool {
        let mut any = false;
        for (i, candidate) in problem.candidates.iter().enumerate() {
            if trial.p[problem.normal(i)] < 0.0 && candidate.law.get().clips() && !self.cut[i] {
                (self.cut[i], any) = (true, true);
            }
        }
        any
    }
}
