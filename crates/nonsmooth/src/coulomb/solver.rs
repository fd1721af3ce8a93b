//! The solver: Newton passes, and sweeps where they bring nothing.

use carom_laws::Status;

use super::conjugate::Conjugate;
use super::trial::Trial;
use super::{FrictionFailure, Posed, Slip, newton, sweep};
use crate::{Compliance, Lumped};

/// Largest defect of a solution, relative to the terms that should balance in its candidate. Passes go on to it where they
/// can; where they bring nothing more, [`Posed::tolerance`] decides.
const TOLERANCE: f64 = 1e-12;
/// Newton passes without progress before sweeps.
const PATIENCE: usize = 10;
/// Newton passes of a round.
const PASSES: usize = 200;
/// Shift of the linear systems, and how far a pass goes, in each round in turn. The large shift makes proximal steps: where D
/// is singular or the contacts jam, it keeps forces that little decides from running away.
const MEANS: [(f64, Length); 4] = [
    (newton::SHIFT, Length::Whole),
    (newton::SHIFT, Length::UpToChange),
    (newton::SHIFT, Length::Halved),
    (1e-3, Length::Halved),
];
/// Halvings of a pass whose whole length does not reduce the defects.
const HALVINGS: i32 = 8;
/// Share of a pass below which a change of status is one of the start, and by which a pass goes beyond a change.
const BEYOND: f64 = 1e-9;
/// Sweeps of the first round; each further round makes twice as many.
const SWEEPS: usize = 16;
/// Rounds of passes and sweeps.
const ROUNDS: usize = 9;
/// Sweeps alone, where D is the product of sparse rows. With masses that are alike some twenty are usual; in a row of n bodies pressed
/// together n² are needed.
const ALONE: usize = 20_000;
/// Rows of D for which passes take over where sweeps are slow: their entries are made then, 8 MB at most.
const FEW_ROWS: usize = 1000;
/// Sweeps before passes take over, which cost as much as some hundred of them.
const BEFORE_PASSES: usize = 500;
/// Change of the forces in a sweep, over the largest and what is asked for, from which on defects are looked at.
const SETTLED: f64 = 0.1;

/// How far a pass goes along the change of the forces.
#[derive(Clone, Copy, PartialEq)]
enum Length {
    /// All the way.
    Whole,
    /// Just beyond the first change of a status.
    ///
    /// Where rows of D are dependent and the equations of the present statuses contradict each other, as of two closed points
    /// that stick to one rigid section and are to leave with different velocities, the change is long and along the forces that D
    /// does not see. A solution is where one of the points begins to slip or opens; no defect falls on the way there.
    UpToChange,
    /// As far as the defects fall, within some halvings; all the way if they never do.
    Halved,
}

/// Solver with its memory.
#[derive(Default)]
pub struct Coulomb {
    /// Normal force of each candidate, N.
    pub forces: Vec<f64>,
    /// Tangential force of each candidate, N.
    pub tangential: Vec<[f64; 2]>,
    /// Normal status of each candidate.
    pub statuses: Vec<Status>,
    /// Tangential status of each candidate.
    pub slips: Vec<Slip>,
    /// Newton passes of the last solve.
    pub passes: usize,
    /// Sweeps of the last solve.
    pub sweeps: usize,
    trial: Trial,
    best: Trial,
    start: Trial,
    change: Vec<f64>,
    reversals: Vec<u32>,
    /// What sweeps keep: D p, or Bᵀ p of a lumped mass.
    kept: Vec<f64>,
    /// All entries of D where passes took over from sweeps.
    entries: Vec<f64>,
    conjugate: Conjugate,
}

impl Coulomb {
    /// Solves for the forces and statuses.
    pub fn solve(&mut self, problem: &Posed) -> Result<(), FrictionFailure> {
        (self.passes, self.sweeps) = (0, 0);
        self.reversals.clear();
        self.reversals.resize(problem.len(), 0);
        self.change.clear();
        self.change.resize(problem.rows(), 0.0);
        self.trial.start(problem);
        self.best.copy_from(&self.trial);
        self.best.merit = f64::INFINITY;
        let d = match problem.d {
            Compliance::Dense(d) => return self.rounds((problem, d)),
            Compliance::Lumped(d) => d,
        };
        let few = d.rows() <= FEW_ROWS;
        let sweeps = if few { BEFORE_PASSES } else { ALONE };
        let relaxed = self.relax((problem, d), sweeps);
        if relaxed.is_ok() || !few {
            return relaxed;
        }
        let mut entries = std::mem::take(&mut self.entries);
        d.dense(&mut entries);
        self.best.merit = f64::INFINITY;
        let dense = Compliance::Dense(&entries);
        let solved = self.rounds((
            &Posed {
                d: dense,
                ..*problem
            },
            &entries,
        ));
        self.entries = entries;
        solved
    }

    /// Newton passes, and sweeps where they bring nothing.
    fn rounds(&mut self, (problem, d): (&Posed, &[f64])) -> Result<(), FrictionFailure> {
        for round in 0..ROUNDS {
            if self.newton((problem, d), MEANS[round % MEANS.len()]) {
                self.finish(problem);
                return Ok(());
            }
            self.trial.copy_from(&self.best);
            if self.trial.is_near(problem) {
                self.finish(problem);
                return Ok(());
            }
            self.kept.clone_from(&self.trial.product);
            for _ in 0..SWEEPS << round {
                sweep::sweep((problem, d), &mut self.trial, &mut self.kept);
            }
            self.sweeps += SWEEPS << round;
            self.trial.measure(problem, &self.reversals);
            self.best.copy_from(&self.trial);
        }
        if self.trial.worst.0 <= TOLERANCE || self.trial.is_near(problem) {
            self.finish(problem);
            return Ok(());
        }
        Err(self.failure())
    }

    /// Sweeps alone, along conjugate directions: of points of a lumped mass few are needed, and each costs no more than one product with D.
    fn relax(
        &mut self,
        (problem, d): (&Posed, &Lumped),
        most: usize,
    ) -> Result<(), FrictionFailure> {
        self.trial.go_on_from_last(problem);
        d.gather(&self.trial.p, &mut self.kept);
        let (mut patience, settled) = (PATIENCE, SETTLED * problem.tolerance.max(10.0 * TOLERANCE));
        self.conjugate.begin(&self.trial.p, &self.kept);
        for _ in 0..most {
            self.sweeps += 1;
            let room = (&mut self.trial, &mut self.kept);
            self.conjugate.note(&room.0.p, room.1);
            if sweep::sweep((problem, d), room.0, room.1) > settled {
                self.conjugate.go_on(&mut room.0.p, room.1);
                continue;
            }
            self.trial.measure(problem, &self.reversals);
            if self.trial.worst.0 <= TOLERANCE || self.trial.is_near(problem) {
                self.finish(problem);
                return Ok(());
            }
            if self.trial.merit < self.best.merit {
                self.best.copy_from(&self.trial);
                patience = PATIENCE;
            } else if patience > 0 {
                patience -= 1;
            } else {
                break;
            }
        }
        self.trial.measure(problem, &self.reversals);
        self.best.copy_from(&self.trial);
        if self.trial.is_near(problem) {
            self.finish(problem);
            return Ok(());
        }
        Err(self.failure())
    }

    fn failure(&self) -> FrictionFailure {
        let (defect, candidate) = self.best.worst;
        FrictionFailure {
            candidate,
            defect,
            passes: self.passes,
            sweeps: self.sweeps,
        }
    }

    /// Newton passes while they bring the trial nearer; whether it is a solution then. `best` is the nearest trial.
    /// `means`: shift of the systems, length of the passes.
    fn newton(&mut self, (problem, d): (&Posed, &[f64]), means: (f64, Length)) -> bool {
        let most = match means.1 {
            // one point after the other may change
            Length::UpToChange => PATIENCE + problem.len(),
            Length::Whole | Length::Halved => PATIENCE,
        };
        let mut patience = most;
        for _ in 0..PASSES {
            if patience == 0 {
                break;
            }
            if self.best.merit.is_finite() && self.trial.worst.0 <= TOLERANCE {
                return true;
            }
            self.passes += 1;
            if newton::step((problem, d), &self.trial, means.0, &mut self.change).is_err() {
                return false;
            }
            self.advance((problem, d), means.1);
            if self.trial.merit < 0.999 * self.best.merit {
                self.best.copy_from(&self.trial);
                patience = most;
            } else {
                patience -= 1;
            }
        }
        false
    }

    /// Goes along the change.
    fn advance(&mut self, (problem, d): (&Posed, &[f64]), length: Length) {
        self.start.copy_from(&self.trial);
        match length {
            Length::Whole => self.go(problem, 1.0),
            Length::UpToChange => {
                let share = self.start.first_change(problem, (d, &self.change), BEYOND);
                self.go(problem, f64::min(1.0, (1.0 + BEYOND) * share));
            }
            Length::Halved => {
                for halving in (0..=HALVINGS).chain([0]) {
                    let share = 0.5_f64.powi(halving);
                    self.go(problem, share);
                    if self.trial.merit < (1.0 - 0.01 * share) * self.start.merit {
                        break;
                    }
                }
            }
        }
        let statuses = self.trial.statuses.iter().zip(&self.start.statuses);
        for ((now, before), reversals) in statuses.zip(&mut self.reversals) {
            *reversals += u32::from(now != before);
        }
    }

    /// The trial this share of the change away from the start.
    fn go(&mut self, problem: &Posed, share: f64) {
        self.trial.copy_from(&self.start);
        for (p, change) in self.trial.p.iter_mut().zip(&self.change) {
            *p += share * change;
        }
        self.trial.measure(problem, &self.reversals);
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
