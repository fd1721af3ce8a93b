//! Forces where nobody knows D: with the motion, by iterations.
//!
//! With statuses and the forces of slipping points given, the forces of all other rows are those of a symmetric problem, `N x + K P = b` with
//! the motion x of all forces ([`Saddle`]): normals of closed points and tangents of points that stick. A pass solves it, takes the statuses that
//! this asks for, and gives slipping points the force `μ P e` of what it has found. As long as statuses change few digits do; the others come
//! when they stand, as many as the slip forces are worth.

use std::cell::RefCell;
use std::mem;

use carom_algebra::Error;
use carom_algebra::solver::Saddle;
use carom_laws::Status;

use super::posed::Alone;
use super::trial::Trial;
use super::{Coulomb, FrictionFailure, Posed, Slip};

/// Tolerance of the iterations of passes at first, and over the largest defect of slip forces then.
const ROUGH: f64 = 1e-3;
const SHARE: f64 = 0.1;

/// Passes without fewer changes of status before statuses change one at a time.
const PATIENCE: usize = 10;

/// Passes at most.
const PASSES: usize = 200;

/// Defect over that of the pass before from which on a pass is slow, slow passes in a row after which slip forces go half as far, and the least part.
const SLOW: f64 = 0.95;
const SLOW_PASSES: usize = 3;
const LEAST: f64 = 1.0 / 64.0;

/// b/|t - ρ q| below which the direction of slip is that of the sliding, whatever the force.
const TURNS: f64 = 1e-6;

/// Compliance of tangents over that of their nodes, where rows depend on each other.
const SHIFT: f64 = 1e-10;

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
    /// Rows of the saddle before those of a pass, and of slipping candidates the row across their direction, with its own direction.
    count: usize,
    across: Vec<(usize, u32, [f64; 2])>,
    /// Candidates whose tension their law has cut off.
    cut: Vec<bool>,
    /// Compliance of tangents over that of their nodes.
    shift: f64,
}

impl Coulomb {
    /// The problem where D is not known.
    pub(super) fn solve_together(
        &mut self,
        problem: &Posed,
        saddle: &RefCell<Saddle>,
    ) -> Result<(), FrictionFailure> {
        self.cause = None;
        self.trial.go_on_from_last(problem);
        let mut rows = std::mem::take(&mut self.rows);
        rows.begin(problem, &self.trial.alone, saddle);
        let solved = self.pass_by_pass(problem, saddle, &mut rows);
        self.rows = rows;
        match solved {
            Ok(true) => Ok(()),
            Ok(false) => Err(self.failure()),
            Err(cause) => {
                self.cause = Some(cause);
                Err(self.failure())
            }
        }
    }

    /// Passes until statuses and slip forces stand; whether they do.
    fn pass_by_pass(
        &mut self,
        problem: &Posed,
        saddle: &RefCell<Saddle>,
        rows: &mut Rows,
    ) -> Result<bool, Error> {
        let (mut tolerance, mut pace) = (ROUGH, Pace::default());
        while self.passes < PASSES {
            self.passes += 1;
            self.start.copy_from(&self.trial);
            rows.pose((problem, pace.share), &self.trial, saddle);
            match rows.solve(saddle, tolerance) {
                Err(Error::NotPositiveDefinite { .. }) if rows.shift == 0.0 => {
                    rows.shift = SHIFT;
                    continue;
                }
                solved => solved?,
            }
            rows.take(problem, &mut self.trial);
            self.trial.measure(problem, &self.reversals);
            for i in (0..problem.len()).filter(|&i| rows.cut[i]) {
                self.trial.keep_status(i, &self.start);
            }
            self.best.copy_from(&self.trial);
            let defect = self.trial.largest_defect();
            if self.changes(problem.len(), &mut pace) || pace.is_slow(defect) {
                continue;
            }
            if defect > problem.tolerance {
                tolerance = tolerance.min(SHARE * defect);
            } else if tolerance > 0.0 {
                tolerance = 0.0;
            } else if !rows.cuts(problem, &self.trial) {
                self.finish(problem);
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether statuses have changed in the pass; where they go in circles those of one candidate alone.
    fn changes(&mut self, n: usize, pace: &mut Pace) -> bool {
        let changed = |i: &usize| !self.trial.has_statuses_of(*i, &self.start);
        let (count, last) = (0..n)
            .filter(changed)
            .fold((0, 0), |(count, _), i| (count + 1, i));
        if count == 0 {
            return false;
        }
        if pace.circles(count) {
            for i in (0..n).filter(|&i| i != last) {
                self.trial.keep_status(i, &self.start);
            }
        }
        for i in 0..n {
            let turned = self.trial.statuses[i] != self.start.statuses[i];
            self.reversals[i] += u32::from(turned);
        }
        true
    }
}

/// How passes go on.
struct Pace {
    /// Fewest statuses that have changed in a pass, and passes left until statuses go in circles.
    fewest: usize,
    patience: usize,
    /// How far slip forces go to what a pass asks for.
    share: f64,
    /// The defect of the pass before, and passes that have not made it smaller.
    defect: f64,
    slow: usize,
}

impl Default for Pace {
    fn default() -> Pace {
        Pace {
            fewest: usize::MAX,
            patience: PATIENCE,
            share: 1.0,
            defect: f64::INFINITY,
            slow: 0,
        }
    }
}

impl Pace {
    /// Whether so many changes of status are some of a circle.
    fn circles(&mut self, count: usize) -> bool {
        self.defect = f64::INFINITY;
        if count < self.fewest {
            (self.fewest, self.patience) = (count, PATIENCE);
        } else if self.patience > 0 {
            self.patience -= 1;
        } else {
            self.halve();
            return true;
        }
        false
    }

    /// Takes the defect of a pass; whether passes overshoot, which go half as far from here on.
    fn is_slow(&mut self, defect: f64) -> bool {
        self.slow = match defect > SLOW * self.defect {
            true => self.slow + 1,
            false => 0,
        };
        self.defect = defect;
        let overshoots = self.slow > SLOW_PASSES;
        if overshoots {
            self.halve();
        }
        overshoots
    }

    fn halve(&mut self) {
        self.share = (0.5 * self.share).max(LEAST);
        (self.slow, self.defect) = (0, f64::INFINITY);
    }
}

impl Rows {
    fn begin(&mut self, problem: &Posed, alone: &[Alone], saddle: &RefCell<Saddle>) {
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
    fn pose(&mut self, (problem, share): (&Posed, f64), trial: &Trial, saddle: &RefCell<Saddle>) {
        self.set_across(problem, trial, saddle);
        let saddle = saddle.borrow();
        for list in [&mut self.own, &mut self.b, &mut self.given] {
            list.clear();
        }
        self.numbers.clear();
        self.given.resize(problem.rows(), 0.0);
        let mut further = Vec::new();
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
        for (number, shared, free) in further {
            self.push(number, shared * saddle.diagonal(number as usize), free);
        }
        for (i, number, of) in mem::take(&mut self.across) {
            let free = &problem.friction[i].free;
            let free = -(of[0] * free[0] + of[1] * free[1]) / problem.s[2];
            // t - ρ q keeps its direction where (1 - c) t + c ρ q = 0 across it
            let c = trial.curvatures[i];
            let own = (1.0 - c) / (c * problem.weight(i) * problem.s[2]);
            self.push(number, own, free);
            self.across.push((i, number, of));
        }
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

    fn solve(&mut self, saddle: &RefCell<Saddle>, tolerance: f64) -> Result<(), Error> {
        let mut saddle = saddle.borrow_mut();
        saddle.load_with(&self.given);
        saddle.solve((&self.numbers, &self.own), tolerance, &mut self.b)
    }

    /// The forces found, into a trial.
    fn take(&self, problem: &Posed, trial: &mut Trial) {
        trial.p.copy_from_slice(&self.given);
        let found = self.numbers.iter().zip(&self.b);
        let (own, further): (Vec<_>, Vec<_>) =
            found.partition(|(number, _)| (**number as usize) < problem.rows());
        for (number, force) in own {
            trial.p[*number as usize] = *force;
        }
        let along = self.along.iter().enumerate();
        let along = along.filter_map(|(i, along)| along.map(|(number, of)| (i, number, of)));
        for (i, number, of) in along.chain(self.across.iter().copied()) {
            let found = further.binary_search_by_key(&number, |(number, _)| **number);
            if let Ok(place) = found {
                let (row, force) = (problem.normal(i), *further[place].1);
                trial.p[row + 1] += force * of[0];
                trial.p[row + 2] += force * of[1];
            }
        }
    }

    /// Whether laws cut tension off that a trial has: these points have no force from here on.
    fn cuts(&mut self, problem: &Posed, trial: &Trial) -> bool {
        let mut any = false;
        for (i, candidate) in problem.candidates.iter().enumerate() {
            if trial.p[problem.normal(i)] < 0.0 && candidate.law.get().clips() && !self.cut[i] {
                (self.cut[i], any) = (true, true);
            }
        }
        any
    }
}
