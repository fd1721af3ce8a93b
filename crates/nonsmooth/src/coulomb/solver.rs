//! The solver: Newton passes, and sweeps where they bring nothing.

use carom_algebra::Interrupt;
use carom_laws::Status;

use super::anderson::Anderson;
use super::posed::Alone;
use super::rows::Rows;
use super::sweep::Product;
use super::trial::Trial;
use super::{FrictionFailure, Posed, Slip, newton, sweep};
use crate::tangents::{Tangents, are_linear};
use crate::{Compliance, PointForces};

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
/// Sweeps of few points, whose passes cost as much as some tens of them.
const OF_FEW: usize = 50;
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
    pub(super) trial: Trial,
    pub(super) best: Trial,
    pub(super) start: Trial,
    change: Vec<f64>,
    pub(super) reversals: Vec<u32>,
    /// What sweeps keep: D p, or Bᵀ p of a lumped mass.
    kept: Vec<f64>,
    /// Ends passes and sweeps without a solution where it is set.
    pub interrupt: Interrupt,
    /// Why iterations have failed, where D is not known.
    pub cause: Option<carom_algebra::Error>,
    pub(super) rows: Rows,
    /// All entries of D where passes took over from sweeps.
    entries: Vec<f64>,
    anderson: Anderson,
    tangents: Tangents,
}

impl Coulomb {
    /// What the last solve found of each candidate.
    pub(crate) fn found(&self) -> impl Iterator<Item = PointForces> + '_ {
        (0..self.forces.len()).map(|k| PointForces {
            normal: self.forces[k],
            tangential: self.tangential[k],
            status: self.statuses[k],
            slip: self.slips[k],
        })
    }

    /// Solves for the forces and statuses. Relations of laws that are not linear are renewed until they stand; points that slide where
    /// they would slide with the larger coefficient too have the lower one.
    pub fn solve(&mut self, problem: &Posed) -> Result<(), FrictionFailure> {
        match problem.friction.iter().all(|own| own.sliding.is_none()) {
            true => self.solve_at_once(problem),
            false => self.lower(problem),
        }
    }

    /// Solves for the forces and statuses, with the coefficients as they are.
    pub(super) fn solve_at_once(&mut self, problem: &Posed) -> Result<(), FrictionFailure> {
        if are_linear(problem.candidates) {
            return self.settle(problem);
        }
        let mut tangents = std::mem::take(&mut self.tangents);
        tangents.begin(problem.candidates);
        let solved = self.renew(problem, &mut tangents);
        self.tangents = tangents;
        solved
    }

    /// Solves for the forces and statuses, with the relations of the candidates as they are.
    pub(super) fn settle(&mut self, problem: &Posed) -> Result<(), FrictionFailure> {
        self.settle_with_tension(problem)?;
        self.cut_off(problem);
        Ok(())
    }

    /// The same, where tension that laws cut off still acts on the other points.
    pub(super) fn settle_with_tension(&mut self, problem: &Posed) -> Result<(), FrictionFailure> {
        (self.passes, self.sweeps) = (0, 0);
        self.reversals.clear();
        self.reversals.resize(problem.len(), 0);
        self.change.clear();
        self.change.resize(problem.rows(), 0.0);
        self.trial.start(problem);
        self.best.copy_from(&self.trial);
        self.best.merit = f64::INFINITY;
        let d = match problem.d {
            Compliance::Dense(d) => return self.solve_few((problem, d)),
            Compliance::Lumped(d) => d,
            Compliance::Iterated(d) => return self.solve_together(problem, d),
        };
        let few = d.rows() <= FEW_ROWS;
        let sweeps = if few { BEFORE_PASSES } else { ALONE };
        let relaxed = self.relax((problem, d), sweeps, true);
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

    /// Few points: sweeps where each point is solved in closed form, or passes.
    fn solve_few(&mut self, (problem, d): (&Posed, &[f64])) -> Result<(), FrictionFailure> {
        let in_closed_form = |alone: &Alone| alone.diagonal.is_some();
        if self.trial.alone.iter().all(in_closed_form) {
            if self.relax((problem, d), OF_FEW, false).is_ok() {
                return Ok(());
            }
            self.trial.start(problem);
            self.best.copy_from(&self.trial);
            self.best.merit = f64::INFINITY;
        }
        self.rounds((problem, d))
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
                if self.interrupt.is_set() {
                    return Err(self.failure());
                }
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

    /// Sweeps alone, mixed after Anderson: of points of a lumped mass few are needed, and each costs no more than one product with D.
    /// `near`: whether the tolerance that is asked for will do.
    fn relax<D: Product + ?Sized>(
        &mut self,
        (problem, d): (&Posed, &D),
        most: usize,
        near: bool,
    ) -> Result<(), FrictionFailure> {
        self.trial.go_on_from_last(problem);
        d.gather(&self.trial.p, &mut self.kept);
        let asked = if near { problem.tolerance } else { 0.0 };
        let (mut patience, settled) = (PATIENCE, SETTLED * asked.max(10.0 * TOLERANCE));
        let is_solution =
            |trial: &Trial| trial.worst.0 <= TOLERANCE || near && trial.is_near(problem);
        let alone = problem.len() == 1;
        self.anderson.begin(&self.trial.p);
        for _ in 0..most {
            if self.interrupt.is_set() {
                return Err(self.failure());
            }
            self.sweeps += 1;
            let room = (&mut self.trial, &mut self.kept);
            if sweep::sweep((problem, d), room.0, room.1) > settled && !alone {
                self.anderson.go_on(&mut room.0.p, room.1);
                continue;
            }
            self.trial.measure(problem, &self.reversals);
            if is_solution(&self.trial) {
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
            self.anderson.note(&self.trial.p);
        }
        self.trial.measure(problem, &self.reversals);
        self.best.copy_from(&self.trial);
        if is_solution(&self.trial) {
            self.finish(problem);
            return Ok(());
        }
        Err(self.failure())
    }

    pub(super) fn failure(&self) -> FrictionFailure {
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
            if patience == 0 || self.interrupt.is_set() {
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
    pub(super) fn finish(&mut self, problem: &Posed) {
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

#[cfg(test)]
mod tests {
    use carom_laws::{Capture, Law, Local, Reading, Velocity};

    use super::super::{FrictionProblem, Tangential};
    use super::*;
    use crate::interface::Candidate;

    /// A node of 2 kg that comes down with 3 m/s and slides with `slides`, D = 1/m. Stopped along the normal it takes 6 N s, and along
    /// the plane m |v| or μ times that.
    fn node(slides: [f64; 2]) -> FrictionProblem {
        let law = Law::Velocity(Velocity {
            capture: Capture::Now,
            reading: Reading::Closed,
        });
        FrictionProblem {
            step: 1,
            names: vec!["node".to_string()],
            candidates: vec![Candidate {
                law,
                local: Local::default(),
                rate_free: -3.0,
                status: Status::Closed,
                faces_itself: false,
                instant: [1.0; 2],
            }],
            friction: vec![Tangential {
                mu: 0.5,
                free: slides,
                slip: Slip::Stick,
                ..Tangential::default()
            }],
            tangents: 2,
            compliance: vec![0.5, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.5],
            factors: [0.0, 1.0, 1.0],
            tolerance: 1e-10,
        }
    }

    #[test]
    fn an_interrupt_ends_the_search_before_the_next_pass() {
        let problem = node([0.75, -1.0]);
        let mut coulomb = Coulomb::default();
        coulomb.solve(&problem.posed()).unwrap();
        coulomb.interrupt.set();
        let failure = coulomb.solve(&problem.posed()).unwrap_err();
        assert_eq!((failure.passes, failure.sweeps), (0, 0));
        // it names a candidate of this problem
        assert_eq!(failure.candidate, 0);
    }

    #[test]
    fn a_node_with_equal_masses_takes_no_pass() {
        // 2.5 N s would stop it; 10 N s are more than μ P
        for (slides, t) in [([0.75, -1.0], [-1.5, 2.0]), ([3.0, -4.0], [-1.8, 2.4])] {
            let solution = node(slides).solve().unwrap();
            assert_eq!(solution.passes, 0);
            assert!((solution.forces[0] - 6.0).abs() < 1e-14);
            let off = [0, 1].map(|k| (solution.tangential[0][k] - t[k]).abs());
            assert!(off.into_iter().all(|off| off < 1e-14), "{solution:?}");
        }
    }
}
