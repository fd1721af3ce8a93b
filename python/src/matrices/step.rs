//! One step: the motion without contact forces, the interface problem of the candidates, and the end of the step.

use carom_dynamics::paired::told;
use carom_laws::{Law, Level, Status};
use carom_nonsmooth::{Compliance, Condensed as Posed, ContactPoint, PointForces};
use carom_schemes::{Known, Row, StepMap};
use pyo3::prelude::*;

use super::{Condensed, MatrixRun, Motion, damping_rate};
use crate::errors::{failed, wrong};

/// Defect of friction over the largest force, with which it is taken where none nearer is found: that of cases.
const TOLERANCE: f64 = 1e-10;

impl Motion {
    fn known(&self) -> Known<'_> {
        Known {
            u: &self.u,
            v: &self.v,
            a: &self.a,
            memory: &self.memory,
        }
    }
}

/// Gap and rate that a law constrains.
fn constrained(map: &StepMap, law: &Law) -> [Row; 2] {
    match law.get().level() {
        Level::GapAndRate => map.compliant(),
        Level::Gap | Level::Rate => [map.gap, map.rate],
    }
}

impl MatrixRun {
    /// A row of the contacts times what a row of the map says; `with_x`: with the unknown as it stands, that of the motion without contact forces.
    fn quantity(&self, row: usize, of: &Row, with_x: bool) -> f64 {
        let Motion { u, v, a, memory } = &self.motion;
        let x = (if with_x { of.x } else { 0.0 }, &self.room.x);
        let terms = [(of.u, u), (of.v, v), (of.a, a), x, (of.m, memory)];
        let terms = terms.iter().filter(|(factor, _)| *factor != 0.0);
        terms
            .map(|(factor, vector)| factor * self.rows.along(row, vector))
            .sum()
    }

    /// r = p - M ẍ_known - C u̇_known - K u_known.
    fn evaluate_residual(&mut self, load: &[f64]) {
        let rate = damping_rate(&self.map);
        let room = &mut self.room;
        room.residual.copy_from_slice(load);
        let parts = [
            (&self.map.inertia, Some(&self.mass)),
            (&rate, self.damping.as_ref()),
            (&self.map.force, Some(&self.stiffness)),
        ];
        for (row, matrix) in parts {
            let Some(matrix) = matrix else { continue };
            row.known(self.motion.known(), &mut room.work);
            matrix.multiply(&room.work, &mut room.x);
            for (r, p) in room.residual.iter_mut().zip(&room.x) {
                *r -= p;
            }
        }
    }

    /// Chooses the points that may close and says what their laws know.
    fn choose(&mut self, tolerance: f64) {
        let mut condensed = std::mem::take(&mut self.condensed);
        condensed.candidates.clear();
        condensed.data.clear();
        let (map, sliding, tangents) = (self.map, self.sliding(), self.rows.tangents());
        for point in 0..self.points.len() {
            let row = self.rows.normal(point);
            let given = &self.points[point];
            let law = given.law;
            let placed = given.gap + self.quantity(row, &map.placed, false);
            let moving = self.rows.along(row, &self.motion.v);
            if told(&law, (placed, moving), map.moves, tolerance) == Some(false) {
                self.points[point].last = PointForces::default();
                continue;
            }
            let [gap, rate] = constrained(&map, &law);
            condensed.candidates.push(point as u32);
            let instant = match law.get().level() {
                Level::GapAndRate => map.compliant_factors(),
                Level::Gap | Level::Rate => [1.0; 2],
            };
            let free = [
                given.gap + self.quantity(row, &gap, true),
                self.quantity(row, &rate, true),
            ];
            let described = ContactPoint {
                law,
                area: 1.0,
                share: 1.0,
                tolerance,
                faces_itself: false,
                crush: given.crush,
                gap: placed,
                rate: moving,
                rebound: 1.0,
                in_way: map.start_in_way(),
                dt: map.moves,
                last: given.last,
            };
            let data = &mut condensed.data;
            data.normal.push(described.candidate(free, instant));
            if tangents > 0 {
                let (mut slid, mut square) = ([0.0; 2], 0.0);
                for (k, slid) in slid.iter_mut().enumerate().take(tangents) {
                    *slid = self.quantity(row + 1 + k, &sliding, true);
                    square += self.rows.along(row + 1 + k, &self.motion.v).powi(2);
                }
                let friction = &given.friction;
                let tangential = described.tangential(friction, square.sqrt(), slid);
                data.friction.push(tangential);
            }
        }
        self.condensed = condensed;
    }

    /// Whether laws in the rate see what forces do through the mass too.
    fn sums_compliances(&self) -> bool {
        self.map.rate.c != 0.0 && self.scheme.get().takes(Level::Rate)
    }

    /// D over the rows of the candidates.
    fn condense(&mut self, before: &[u32]) {
        let condensed = &mut self.condensed;
        if condensed.candidates == before && condensed.version > 0 {
            return;
        }
        condensed.version += 1;
        let width = 1 + self.rows.tangents() as u32;
        let rows = condensed.candidates.iter();
        condensed.rows = rows
            .flat_map(|point| point * width..(point + 1) * width)
            .collect();
        condensed.d.clear();
        let all = self.columns.len();
        for &i in &condensed.rows {
            let row = &self.whole[i as usize * all..(i as usize + 1) * all];
            let entries = condensed.rows.iter().map(|j| row[*j as usize]);
            condensed.d.extend(entries);
        }
        if !self.sums_compliances() {
            return;
        }
        let (map, condensed) = (&self.map, &mut self.condensed);
        let factor = map.rate.x * map.contact;
        condensed.d.iter_mut().for_each(|d| *d *= factor);
        if let Some(of_mass) = &self.of_mass {
            of_mass.add(map.rate.c, &condensed.rows, &mut condensed.d);
        }
    }

    /// The row whose product with T is the sliding: a velocity where laws in the rate are all that have friction, and in explicit steps, in which
    /// no force changes the way; otherwise the way of the step.
    fn sliding(&self) -> Row {
        let mut rubbing = self.points.iter().filter(|point| point.friction.acts());
        let by_rate = rubbing.all(|point| point.law.get().level() == Level::Rate);
        match by_rate || self.map.displacement.x == 0.0 {
            true => self.map.rate,
            false => self.map.displacement.since(&Row::START),
        }
    }

    /// Solves for forces and statuses of the candidates.
    fn solve(&mut self) -> PyResult<()> {
        if self.condensed.candidates.is_empty() {
            return Ok(());
        }
        let (factor, sliding) = (self.map.contact, self.sliding());
        let s = match self.sums_compliances() {
            true => [0.0, 1.0, 1.0],
            false => [self.map.gap.x, self.map.rate.x, sliding.x].map(|s| s * factor),
        };
        let tangents = self.rows.tangents();
        let Condensed {
            data,
            solver,
            d,
            version,
            ..
        } = &mut self.condensed;
        let problem = Posed {
            d: Compliance::Dense(d),
            version: *version,
            s,
            tangents,
            tolerance: TOLERANCE,
        };
        let solved = solver.solve(data.all(), &problem);
        solved.map_err(|error| failed(&error))
    }

    /// Gives the points their forces and adds these to the motion.
    fn take_forces(&mut self) {
        let condensed = &self.condensed;
        let tangents = self.rows.tangents();
        let factor = self.map.contact;
        self.room.push.fill(0.0);
        for (k, &number) in condensed.candidates.iter().enumerate() {
            let point = &mut self.points[number as usize];
            point.last = condensed.solver.found[k];
            let first = self.rows.normal(number as usize);
            let [t1, t2] = point.last.tangential;
            let forces = [point.last.normal, t1, t2];
            let forces = || (first..=first + tangents).zip(forces);
            for (row, force) in forces().filter(|(_, force)| *force != 0.0) {
                for (x, c) in self.room.x.iter_mut().zip(&self.columns[row]) {
                    *x += factor * force * c;
                }
            }
            if let (Some(of_mass), true) = (&self.of_mass, self.map.uses_contact_acceleration()) {
                of_mass.spread(forces(), &mut self.room.push);
            }
        }
    }

    /// The motion at the end of the step.
    fn end(&mut self) {
        let (map, room) = (&self.map, &mut self.room);
        let Motion { u, v, a, memory } = &mut room.next;
        let known = self.motion.known();
        let rows = [map.displacement, map.velocity, map.acceleration, map.memory];
        for (row, out) in rows.iter().zip([u, v, a, memory]) {
            row.whole(known, &room.x, &room.push, out);
        }
    }

    /// One step with the load (N) at its instant.
    pub(super) fn take_step(&mut self, load: &[f64], tolerance: f64) -> PyResult<()> {
        self.project_predictor()?;
        self.evaluate_residual(load);
        self.room.x.copy_from_slice(&self.room.residual);
        self.factor.solve(&mut self.room.x);
        let before = self.condensed.candidates.clone();
        let statuses: Vec<Status> = self.points.iter().map(|point| point.last.status).collect();
        self.choose(tolerance);
        self.condense(&before);
        self.solve()?;
        self.take_forces();
        self.end();
        self.restore(&statuses);
        self.project(&statuses)?;
        std::mem::swap(&mut self.motion, &mut self.room.next);
        for (k, point) in self.points.iter_mut().enumerate() {
            if point.last.normal != 0.0 {
                let gap = point.gap + self.rows.along_normal(k, &self.motion.u);
                point.crush = point.law.crushed(point.crush, gap);
            }
        }
        self.step += 1;
        match self.motion.u.iter().all(|u| u.is_finite()) {
            true => Ok(()),
            false => Err(wrong(format!(
                "step {}: the motion is not finite",
                self.step
            ))),
        }
    }
}
