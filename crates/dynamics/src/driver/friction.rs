//! Friction in an iteration: rows of the tangents, the interface problem with them, slips.
//!
//! The sliding quantity q of a point is its way over the primary in the step, T (u₊ - u), and where all laws with friction
//! are laws in the rate, the velocity T v that they look at. T is that of the iteration, with the foot of the point there:
//! in a closed contact a rigid rotation gives no slip.

use std::sync::Arc;
use std::time::Instant;

use carom_contact::law::{Level, Status};

use super::Driver;
use super::candidates::sums_compliances;
use crate::coulomb::{FrictionFailure, FrictionProblem, Posed, Slip, Tangential};
use crate::error::Error;
use crate::state::ContactReport;
use crate::step_map::{Row, StepMap};

impl Driver {
    /// Whether a candidate has friction.
    pub(super) fn rubs(&self) -> bool {
        let mu = |&point: &u32| self.system.friction[self.system.contact_of(point as usize)];
        self.system.tangents() > 0 && self.candidates.iter().any(|point| mu(point) > 0.0)
    }

    /// Points that carried friction are first thought to stick.
    pub(super) fn guess_slips(&mut self) {
        let points = self.system.points();
        self.slips.clear();
        if self.system.tangents() == 0 {
            return;
        }
        let friction = &mut self.next.interface.friction;
        friction.resize(points, [0.0; 2]);
        self.slips
            .extend(friction.iter().map(|t| match t == &[0.0; 2] {
                true => Slip::Open,
                false => Slip::Stick,
            }));
    }

    /// Rows of all points, each with those of its tangents after it.
    pub(super) fn stack(&mut self) {
        let tangents = self.system.tangents();
        if tangents == 0 {
            return;
        }
        self.stacked.clear();
        for point in 0..self.pairing.len() {
            self.stacked.push_from(&self.pairing.rows, point);
            for rows in &self.pairing.tangents[..tangents] {
                self.stacked.push_from(rows, point);
            }
        }
    }

    /// Whether sliding is a velocity at the end of the step, or the way in it.
    fn slides_by_rate(&self) -> bool {
        let system = &*self.system;
        let of_rate = |k: usize| system.contacts[k].law.get().level() == Level::Rate;
        let mut rubbing = (0..system.contacts.len()).filter(|&k| system.friction[k] > 0.0);
        !self.maps.is_static() && rubbing.all(of_rate)
    }

    /// The times, from that at which the places of a contact are taken, over which its sliding is looked at, s.
    pub(super) fn span(&self, contact: usize) -> [f64; 2] {
        let after = self.paired_after(contact);
        match self.slides_by_rate() {
            true => [self.dt - after; 2],
            false => [-after, self.dt - after],
        }
    }

    /// The row of a map whose product with T is the sliding quantity, and the time that turns a rate into it.
    fn sliding(&self) -> (impl Fn(&StepMap) -> Row + Copy + use<>, f64) {
        let by_rate = self.slides_by_rate();
        let row = move |map: &StepMap| match by_rate {
            true => map.rate,
            false => map.displacement.since(&Row::START),
        };
        (row, if by_rate { 1.0 } else { self.dt })
    }

    /// Sliding quantity of a point along one tangent at the x of the iteration.
    fn slid(
        &self,
        point: usize,
        tangent: usize,
        (row, time): (impl Fn(&StepMap) -> Row, f64),
    ) -> f64 {
        let rows = &self.pairing.tangents[tangent];
        let xc = [&self.vectors.x[..], &self.vectors.push];
        let along = self.maps.on((rows, point), row, &self.state.motion, xc);
        along + time * rows.rate(point)
    }

    /// What friction adds to each candidate.
    fn tangential(&self) -> Vec<Tangential> {
        let (row, time) = self.sliding();
        // what the forces of the iteration give by themselves is in the matrix
        let without = move |map: &StepMap| Row { c: 0.0, ..row(map) };
        let tangents = self.system.tangents();
        let width = 1 + tangents as u32;
        let of = |&point: &u32| {
            let at = point as usize;
            let mut q = [0.0; 2];
            for (k, q) in q.iter_mut().enumerate().take(tangents) {
                let number = point * width + 1 + k as u32;
                let factor = row(self.map_of(self.system.contact_of(at))).x;
                let step = factor * self.free_along(number, &self.stacked);
                *q = self.slid(at, k, (without, time)) + step;
            }
            Tangential {
                mu: self.system.friction[self.system.contact_of(at)],
                free: q,
                slip: self.slips[at],
                force: self.next.interface.friction[at],
            }
        };
        self.candidates.iter().map(of).collect()
    }

    /// The interface problem of the candidates with friction.
    pub(super) fn solve_with_friction(&mut self) -> Result<(), Error> {
        let system = Arc::clone(&self.system);
        let tangents = system.tangents();
        let width = 1 + tangents as u32;
        let rows = |&point: &u32| point * width..(point + 1) * width;
        let stacked: Vec<u32> = self.candidates.iter().flat_map(rows).collect();
        let factor = self.maps.contact();
        let first = self.maps.first();
        let s = [first.gap.x, first.rate.x, self.sliding().0(first).x].map(|s| s * factor);
        let Some((operators, compliance)) = self.effective.both() else {
            return Ok(());
        };
        let begin = Instant::now();
        compliance.update(&stacked, &self.stacked, &system.fixed, operators);
        self.describe_candidates(Some(tangents as u32));
        let friction = self.tangential();
        let Some((operators, compliance, mut linking)) = self.effective.all() else {
            return Ok(());
        };
        let (matrix, _) = match &mut linking {
            Some(linking) => {
                linking.compliance(&system, (&mut *operators, compliance), &self.stacked)
            }
            None => (&compliance.matrix[..], compliance.version),
        };
        let impulsive = match &mut self.impulses {
            Some(stage) if sums_compliances(&system, self.maps.first()) => {
                let rate = self.maps.first().rate;
                let own = (rate.x * factor, matrix);
                stage.sum(&system, &self.stacked, &stacked, own, rate.c)
            }
            _ => None,
        };
        let (matrix, s) = match impulsive {
            Some(matrix) => (matrix, [0.0, 1.0, 1.0]),
            None => (matrix, s),
        };
        let posed = Posed {
            candidates: &self.candidate_data,
            friction: &friction,
            tangents,
            d: matrix,
            s,
            tolerance: system.nonlinear.iteration.tolerance,
        };
        let solved = self.coulomb.solve(&posed);
        self.phases.friction += begin.elapsed();
        if let Err(failure) = solved {
            let compliance = posed.d.to_vec();
            self.keep_failed(friction, compliance, s);
            return Err(self.friction_error(failure));
        }
        let interface = &mut self.next.interface;
        interface.force.fill(0.0);
        interface.friction.fill([0.0; 2]);
        interface.status.fill(Status::Open);
        self.slips.fill(Slip::Open);
        for (k, &point) in self.candidates.iter().enumerate() {
            let at = point as usize;
            let (p, t) = (self.coulomb.forces[k], self.coulomb.tangential[k]);
            interface.force[at] = p;
            interface.friction[at] = t;
            interface.status[at] = self.coulomb.statuses[k];
            self.slips[at] = self.coulomb.slips[k];
            let forces = [p, t[0], t[1]];
            for (row, force) in rows(&point).zip(forces).filter(|(_, force)| *force != 0.0) {
                compliance.add(row, factor * force, operators, &mut self.vectors.half);
            }
        }
        if let Some(linking) = linking {
            let coulomb = &self.coulomb;
            let of_point = |(k, point): (usize, &u32)| {
                let (p, t) = (coulomb.forces[k], coulomb.tangential[k]);
                let forces = [p, t[0], t[1]].map(|force| factor * force);
                rows(point).zip(forces)
            };
            let forces = self.candidates.iter().enumerate().flat_map(of_point);
            let pushed = &mut self.multipliers.change[1];
            linking.answer(&system, operators, forces, (&mut self.vectors.half, pushed));
        }
        Ok(())
    }

    /// Keeps the problem that was not solved.
    fn keep_failed(&mut self, friction: Vec<Tangential>, compliance: Vec<f64>, factors: [f64; 3]) {
        let name = |&point: &u32| self.name(point as usize);
        self.failed_friction = Some(FrictionProblem {
            step: self.state.step + 1,
            names: self.candidates.iter().map(name).collect(),
            candidates: self.candidate_data.clone(),
            friction,
            tangents: self.system.tangents(),
            compliance,
            factors,
            tolerance: self.system.nonlinear.iteration.tolerance,
        });
    }

    fn friction_error(&self, failure: FrictionFailure) -> Error {
        Error::Friction {
            step: self.state.step + 1,
            point: self.name(self.candidates[failure.candidate] as usize),
            cause: failure,
        }
    }

    /// Adds Tᵀ t to the nodal contact forces.
    pub(super) fn spread_friction(&mut self) {
        for (point, t) in self.next.interface.friction.iter().enumerate() {
            for (rows, &t) in self.pairing.tangents.iter().zip(t) {
                if t != 0.0 {
                    rows.add_force(point, t, &mut self.vectors.contact);
                }
            }
        }
    }

    /// How far a point that sticks has slid at the x of the iteration, m.
    pub(super) fn slip_defect(&self, point: usize) -> f64 {
        if self.slips.get(point) != Some(&Slip::Stick) {
            return 0.0;
        }
        let (row, time) = self.sliding();
        let slid = |k: usize| self.slid(point, k, (row, time)).powi(2);
        let slid: f64 = (0..self.system.tangents()).map(slid).sum();
        slid.sqrt() * self.dt / time
    }

    /// How far the friction of a point is from what its status allows, over `largest`, the largest force of all points:
    /// |t| - μ P of a point that sticks, | |t| - μ P | of one that slips, over what their equations may leave, 2 + μ.
    /// Forces of one solve obey this to its tolerance, a mixture of points that stick and slip need not.
    pub(super) fn cone_defect(&self, point: usize, largest: f64) -> f64 {
        let interface = &self.next.interface;
        let (Some(t), Some(slip)) = (interface.friction.get(point), self.slips.get(point)) else {
            return 0.0;
        };
        let mu = self.system.friction[self.system.contact_of(point)];
        let beyond = t[0].hypot(t[1]) - mu * interface.force[point].max(0.0);
        let defect = match slip {
            Slip::Slip => beyond.abs(),
            Slip::Stick | Slip::Open => beyond.max(0.0),
        };
        if defect == 0.0 {
            0.0
        } else {
            defect / ((2.0 + mu) * largest)
        }
    }

    /// Way that a point slides along one tangent in the step that was taken, m.
    fn way(&self, point: usize, tangent: usize) -> f64 {
        let rows = &self.pairing.tangents[tangent];
        let [old, new] =
            [&self.state.motion.u, &self.next.motion.u].map(|u| rows.product(point, u));
        new - old + self.dt * rows.rate(point)
    }

    /// Work in J of the friction forces of the step, old and new with these weights by zone, on the way that their points slide
    /// over the primary.
    pub(super) fn friction_work(&self, weights: &[[f64; 2]]) -> f64 {
        let (old, new) = (&self.state.interface, &self.next.interface);
        let mut work = 0.0;
        for (point, t) in new.friction.iter().enumerate() {
            let before = old.friction.get(point).copied().unwrap_or_default();
            let weights = weights[self.system.zone_of(self.system.contact_of(point))];
            for k in 0..self.system.tangents() {
                let mean = weights[0] * before[k] + weights[1] * t[k];
                if mean != 0.0 {
                    work += mean * self.way(point, k);
                }
            }
        }
        self.contact_factor() * work
    }

    /// Writes the friction of a contact into its report, and adds it to the resultant.
    pub(super) fn report_friction(&self, contact: usize, report: &mut ContactReport) {
        let points = self.system.first_point[contact]..self.system.first_point[contact + 1];
        let mut sum = [0.0; 3];
        for point in points {
            let Some(t) = self.next.interface.friction.get(point) else {
                return;
            };
            for (rows, t) in self
                .pairing
                .tangents
                .iter()
                .zip(t)
                .take(self.system.tangents())
            {
                for (sum, direction) in sum.iter_mut().zip(rows.resultant(point)) {
                    *sum += t * direction;
                }
            }
            let slips = self.slips[point] == Slip::Slip && t != &[0.0; 2];
            report.slipping += usize::from(slips);
        }
        report.friction = sum.iter().map(|f| f * f).sum::<f64>().sqrt();
        for (resultant, f) in report.resultant.iter_mut().zip(sum) {
            *resultant += f;
        }
    }
}
