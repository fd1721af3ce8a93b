//! Forces where nobody knows D: with the motion, by iterations.
//!
//! With statuses and the forces of slipping points given, the forces of all other rows are those of a symmetric problem, `N x + K P = b` with
//! the motion x of all forces ([`Saddle`]): normals of closed points and tangents of points that stick. A pass solves it, takes the statuses that
//! this asks for, and gives slipping points the force `μ P e` of what it has found. As long as statuses change few digits do; the others come
//! when they stand, as many as the slip forces are worth.

use std::cell::RefCell;

use carom_algebra::Error;
use carom_algebra::solver::Saddle;

use super::rows::{Rows, SHIFT};
use super::{Coulomb, FrictionFailure, Posed};

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
        while self.passes < PASSES && !self.interrupt.is_set() {
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
