//! The interface problem of an iteration: candidates, forces, and the motion with them.

use std::sync::Arc;
use std::time::Instant;

use carom_contact::law::{Level, Status};
use carom_contact::{Contact, Law, Rows};

use super::Driver;
use crate::coulomb::Slip;
use crate::error::Error;
use crate::interface::{Candidate, Failure, InterfaceProblem};
use crate::step_map::{Row, StepMap};
use crate::system::{Motion, System};

/// Additions of missed candidates within one iteration.
const ADDITIONS: usize = 10;

impl Driver {
    /// The motion `dx` of the iteration and the contact forces after it.
    pub(super) fn solve_interface(&mut self) -> Result<(), Error> {
        self.load_iteration();
        self.choose_candidates();
        for _ in 0..ADDITIONS {
            self.begin_solve();
            self.solve_candidates()?;
            self.end_iteration();
            if !self.add_missed() {
                break;
            }
        }
        Ok(())
    }

    /// Forces of the iteration without those of contacts, into `work`.
    fn load_iteration(&mut self) {
        self.begin_link_iteration();
        let jumps = self.jumps();
        let vectors = &mut self.vectors;
        vectors.work.copy_from_slice(&vectors.residual);
        if jumps {
            self.load_jump();
        }
    }

    /// Adds to the forces in `work` what the jump of the supports gives.
    fn load_jump(&mut self) {
        let vectors = &mut self.vectors;
        self.effective.load_of(&vectors.jump, &mut vectors.place);
        for (i, (r, k)) in vectors.work.iter_mut().zip(&vectors.place).enumerate() {
            *r = if self.system.fixed[i] { 0.0 } else { *r - k };
        }
    }

    /// The first half of the solve with the forces in `work`.
    fn begin_solve(&mut self) {
        let begin = Instant::now();
        if let Some((operators, _)) = self.effective.both() {
            operators.begin(&self.vectors.work, &mut self.vectors.half);
        }
        self.hold_links();
        self.phases.sweeps += begin.elapsed();
    }

    /// The motion of the iteration from the begun solve with all forces in it.
    fn end_iteration(&mut self) {
        let begin = Instant::now();
        if let Some((operators, _)) = self.effective.both() {
            operators.end(&mut self.vectors.half, &mut self.vectors.dx);
        }
        if self.vectors.jumps {
            for (dx, jump) in self.vectors.dx.iter_mut().zip(&self.vectors.jump) {
                *dx += jump;
            }
        }
        self.phases.sweeps += begin.elapsed();
    }

    /// The motion `dx` that the forces in `work` and the jump of the supports give.
    pub(super) fn free_motion(&mut self) {
        if self.jumps() {
            self.load_jump();
        }
        self.begin_solve();
        self.end_iteration();
    }

    /// Points that may carry a force. Some laws say so before the forces; of others, those are taken that carried one or that
    /// close at the x of the iteration or at twice the rate at the start, and the rest is looked at after the solve.
    fn choose_candidates(&mut self) {
        self.candidates.clear();
        for point in 0..self.system.points() {
            let chosen = match self.told(point) {
                Some(told) => told,
                None => self.next.interface.status[point] != Status::Open || self.approaches(point),
            };
            self.next.interface.watched[point] = chosen;
            if chosen {
                self.candidates.push(point as u32);
            }
        }
    }

    fn approaches(&self, point: usize) -> bool {
        let tolerance = self.system.tolerance;
        match self.is_affine() {
            true => {
                let gap = self.pairing.rows.gap(point);
                gap + 2.0 * self.dt * self.rate_at_start(point).min(0.0) <= tolerance
            }
            false => self.now(point, true).0 <= tolerance,
        }
    }

    /// What the laws of the candidates know; of adaptive steps their gaps without contact forces too. `tangents`: how many rows of
    /// tangents follow that of each point in the stacked rows; none where the points have rows of their own.
    pub(super) fn describe_candidates(&mut self, tangents: Option<u32>) {
        let mut data = std::mem::take(&mut self.candidate_data);
        data.clear();
        self.free_gaps.clear();
        for k in 0..self.candidates.len() {
            let point = self.candidates[k];
            let free = match tangents {
                Some(tangents) => self.free_along(point * (1 + tangents), &self.stacked),
                None => self.free_along(point, &self.pairing.rows),
            };
            data.push(self.candidate(point as usize, free));
            if self.system.adaptive.is_some() {
                let gap = self.gap_at_the_end(point as usize, free);
                self.free_gaps.push(gap);
            }
        }
        self.candidate_data = data;
    }

    /// What the law of a candidate knows. `free`: N x of the motion of the iteration without contact forces.
    fn candidate(&self, point: usize, free: f64) -> Candidate {
        let contact = self.system.point(point).0;
        let (gap, rate) = self.now(point, false);
        let [closing, approach] = self.added(point, free);
        Candidate {
            law: self.law(contact),
            local: self.local(point, gap + closing),
            rate_free: rate + approach,
            status: self.next.interface.status[point],
            faces_itself: contact.faces_itself(),
            instant: self.factors(self.system.contact_of(point)),
        }
    }

    /// N x of the motion of the iteration without contact forces, of the row of that number in `rows`.
    pub(super) fn free_along(&self, number: u32, rows: &Rows) -> f64 {
        let free = self.effective.free(number, &self.vectors.half);
        match self.jumps() {
            true => free + rows.product(number as usize, &self.vectors.jump),
            false => free,
        }
    }

    /// Forces and statuses of the candidates, whose forces are added to the begun solve.
    fn solve_candidates(&mut self) -> Result<(), Error> {
        if self.candidates.is_empty() {
            self.release();
            return Ok(());
        }
        if self.rubs() {
            return self.solve_with_friction();
        }
        let system = Arc::clone(&self.system);
        let Some((operators, compliance)) = self.effective.both() else {
            return Ok(());
        };
        let rows = &self.pairing.rows;
        compliance.update(&self.candidates, rows, &system.fixed, operators);
        self.describe_candidates(None);
        let factor = self.maps.contact();
        let Some((operators, compliance, mut linking)) = self.effective.all() else {
            return Ok(());
        };
        let rows = &self.pairing.rows;
        let (matrix, version) = match &mut linking {
            Some(linking) => linking.compliance(&system, (&mut *operators, compliance), rows),
            None => (&compliance.matrix[..], compliance.version),
        };
        let impulsive = match &mut self.impulses {
            Some(stage) if sums_compliances(&system, self.maps.first()) => {
                let rate = self.maps.first().rate;
                let own = (rate.x * factor, matrix);
                stage.sum(&system, rows, &self.candidates, own, rate.c)
            }
            _ => None,
        };
        let (matrix, factors) = match impulsive {
            Some(matrix) => (matrix, [0.0, 1.0]),
            None => (
                matrix,
                [
                    self.maps.first().gap.x * factor,
                    self.maps.first().rate.x * factor,
                ],
            ),
        };
        let condensed = (matrix, &compliance.candidates[..], version);
        let matrix = self
            .with_weak
            .of(&self.weak, &system, (condensed, rows), factors);
        let solved = self.interface.solve(&self.candidate_data, matrix, factors);
        if let Err(failure) = solved {
            let compliance = matrix.0.to_vec();
            return Err(self.keep_problem(failure, compliance, factors));
        }
        let interface = &mut self.next.interface;
        interface.force.fill(0.0);
        interface.status.fill(Status::Open);
        for (k, &point) in self.candidates.iter().enumerate() {
            let force = self.interface.forces[k];
            interface.force[point as usize] = force;
            interface.status[point as usize] = self.interface.statuses[k];
            if force != 0.0 {
                compliance.add(point, factor * force, operators, &mut self.vectors.half);
            }
        }
        if let Some(linking) = linking {
            let forces = self.candidates.iter().zip(&self.interface.forces);
            let forces = forces.map(|(&point, force)| (point, factor * force));
            let pushed = &mut self.multipliers.change[1];
            linking.answer(&system, operators, forces, (&mut self.vectors.half, pushed));
        }
        self.warn_of_circles();
        self.take_weak();
        Ok(())
    }

    fn warn_of_circles(&self) {
        if let Some(candidate) = self.interface.circled {
            let name = self.name(self.candidates[candidate] as usize);
            tracing::warn!(
                "step {}: contact statuses cycle at {name}; they now change one at a time",
                self.state.step + 1
            );
        }
    }

    /// Gap of a point at the end of the step without contact forces, m.
    fn gap_at_the_end(&self, point: usize, free: f64) -> f64 {
        let number = self.system.contact_of(point);
        let paired = self.paired_at(number);
        let ahead = |map: &StepMap| map.displacement.since(&paired.row(map));
        let xc = [&self.vectors.x[..], &self.vectors.push];
        let rows = &self.pairing.rows;
        let motion = &self.state.motion;
        let way = self.maps.on((rows, point), ahead, motion, xc);
        rows.gap(point) + way + self.map_of(number).displacement.x * free
    }

    /// Factors of x in gap and rate that the law of a contact constrains, over those of the problem: of the first map.
    fn factors(&self, contact: usize) -> [f64; 2] {
        let (map, [gap, rate]) = (self.map_of(contact), self.constrained(contact).1);
        if self.maps.only().is_some() {
            return [gap, rate];
        }
        let first = self.maps.first();
        let over = |own: f64, first: f64| if first == 0.0 { 1.0 } else { own / first };
        [
            gap * over(map.gap.x, first.gap.x),
            rate * over(map.rate.x, first.rate.x),
        ]
    }

    /// No contact force at all.
    fn release(&mut self) {
        let interface = &mut self.next.interface;
        interface.force.fill(0.0);
        interface.friction.fill([0.0; 2]);
        interface.status.fill(Status::Open);
        self.slips.fill(Slip::Open);
        self.take_weak();
    }

    /// Adds the points that were no candidates and whose law asks for a force; whether there are any.
    fn add_missed(&mut self) -> bool {
        let before = self.candidates.len();
        for point in 0..self.system.points() {
            let known = self.candidates[..before].binary_search(&(point as u32));
            if known.is_ok() || self.told(point).is_some() {
                continue;
            }
            let step = self.pairing.rows.product(point, &self.vectors.dx);
            let (gap, rate) = self.now(point, false);
            let [closing, approach] = self.added(point, step);
            let ahead = (gap + closing, rate + approach);
            let (gap, rate) = self.weakly(point, ahead);
            if self.asks(point, gap, rate) {
                self.candidates.push(point as u32);
                self.next.interface.watched[point] = true;
            }
        }
        self.candidates.sort_unstable();
        self.candidates.len() > before
    }

    /// Keeps the interface problem that was not solved, and names the failure.
    fn keep_problem(&mut self, failure: Failure, compliance: Vec<f64>, factors: [f64; 2]) -> Error {
        let names = self.candidates.iter();
        let names = names.map(|&point| self.name(point as usize));
        self.failed = Some(InterfaceProblem {
            step: self.state.step + 1,
            names: names.collect(),
            candidates: self.candidate_data.clone(),
            compliance,
            factors,
        });
        self.interface_error(failure, &self.candidates)
    }

    /// The error behind a failure of the interface problem of some points.
    pub(super) fn interface_error(&self, failure: Failure, candidates: &[u32]) -> Error {
        let step = self.state.step + 1;
        match failure {
            Failure::Singular { points, cause } => Error::Interface {
                step,
                points,
                cause,
            },
            Failure::Cycling { passes, candidate } => {
                let (contact, point) = self.system.point(candidates[candidate] as usize);
                Error::Statuses {
                    step,
                    passes,
                    contact: contact.name.clone(),
                    point,
                }
            }
        }
    }
}

/// Whether laws in the rate hold for a velocity on which contact forces act through the mass too: the interface problem then
/// sums the compliances of the step and of the mass.
pub(super) fn sums_compliances(system: &System, map: &StepMap) -> bool {
    map.rate.c != 0.0 && system.scheme.get().takes(Level::Rate)
}

/// Gap and rate that a law constrains, and their factors of x over those of the map.
pub(super) fn instant(map: &StepMap, law: &Law) -> ([Row; 2], [f64; 2]) {
    match law.get().level() {
        Level::GapAndRate => (map.compliant(), map.compliant_factors()),
        Level::Gap | Level::Rate => ([map.gap, map.rate], [1.0; 2]),
    }
}

/// Whether a contact is paired where the step is predicted to lead, for a law that looks ahead, and not where the present
/// velocity does. In a step much longer than a wave takes across an element the velocity of the shortest waves times dt/2
/// leads much further than any node gets, and the turning of the rows would be that of an explicit step of the mass m of the
/// surface nodes alone, unstable beyond dt² |P ∂²g/∂u²| = 4 m.
pub(super) fn looks_ahead(map: &StepMap, contact: &Contact, law: &Law) -> bool {
    map.force.x != 0.0 && contact.turns() && law.get().capture() > 0.0
}

/// The gap by which a law tells whether a point is closed (S_d): at the captured instant, `gap`, or at the start, a `way`
/// (m) before it, whichever is less. A point that is closed and leaves stays with its law, which alone knows whether
/// the step turns it back.
pub(super) fn least_gap(gap: f64, way: f64) -> f64 {
    gap - way.max(0.0)
}

/// The part of the way from the start of the step to `end` at which a law takes the geometry.
pub(super) fn part_way(motion: &Motion, end: &[f64], law: &Law, out: &mut [f64]) {
    let part = law.get().capture();
    for (i, q) in out.iter_mut().enumerate() {
        *q = (1.0 - part) * motion.u[i] + part * end[i];
    }
}
