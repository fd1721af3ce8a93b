//! The contacts of a step: pairing, candidates, forces.

use std::sync::Arc;

use carom_contact::law::{End, Level, Local, Status};
use carom_contact::{Contact, Law, Places, Rows, Sliding};

use super::{Driver, Vectors};
use crate::error::Error;
use crate::interface::{Candidate, Failure, InterfaceProblem};
use crate::state::Motion;
use crate::step_map::{Row, StepMap};
use crate::system::System;

impl Driver {
    pub(super) fn pair_initially(&mut self) {
        let system = Arc::clone(&self.system);
        let places = Places {
            unknowns: &system.unknowns,
            time: 0.0,
            x: &system.x,
            u: &self.vectors.work,
        };
        let rows = system
            .contacts
            .iter()
            .zip(&mut self.search)
            .map(|(contact, search)| match contact.sliding {
                Sliding::Finite => None,
                Sliding::Small => {
                    let mut rows = Rows::default();
                    rows.clear();
                    contact.pair(&places, search, &mut rows);
                    Some(rows)
                }
            });
        self.initial_rows = rows.collect();
    }

    /// Pairs all contacts at their captured instant; `now` takes the state as it is.
    pub(super) fn place(&mut self, now: bool) {
        let system = Arc::clone(&self.system);
        let (map, dt, motion) = (&self.map, self.map.moves, &self.state.motion);
        self.rows.clear();
        self.captured.clear();
        let mut capture = f64::NAN;
        for (k, contact) in system.contacts.iter().enumerate() {
            let place = match now {
                true => Row {
                    u: 1.0,
                    ..Row::default()
                },
                false => Row {
                    v: map.placed.v + contact.law.get().capture() * dt,
                    ..map.placed
                },
            };
            if capture != place.v {
                place.known(motion, &mut self.vectors.known);
                capture = place.v;
            }
            let u = &self.vectors.known;
            match &self.initial_rows[k] {
                Some(initial) => self.rows.append_moved(initial, u),
                None => {
                    let ahead = !now && looks_ahead(map, contact, &contact.law);
                    if ahead {
                        let end = &self.vectors.ahead;
                        part_way(motion, end, &contact.law, &mut self.vectors.work);
                    }
                    let u = if ahead { &self.vectors.work } else { u };
                    let places = Places {
                        unknowns: &system.unknowns,
                        time: 0.0,
                        x: &system.x,
                        u,
                    };
                    let first = self.rows.len();
                    contact.pair(&places, &mut self.search[k], &mut self.rows);
                    if ahead {
                        let Vectors { known, work, .. } = &mut self.vectors;
                        for (way, to) in work.iter_mut().zip(&*known) {
                            *way = to - *way;
                        }
                        self.rows.move_from(first, work);
                    }
                }
            }
            self.captured.resize(self.rows.len(), place);
        }
    }

    /// Predicts the displacement at the end of the step with the forces of contacts and links of the step before, for contacts
    /// that are paired ahead.
    pub(super) fn look_ahead(&mut self) {
        let system = &*self.system;
        let ahead = |contact: &Contact| looks_ahead(&self.map, contact, &contact.law);
        if !system.contacts.iter().any(ahead) {
            return;
        }
        let motion = &self.state.motion;
        let Vectors {
            residual,
            half,
            x,
            work,
            ahead,
            ..
        } = &mut self.vectors;
        for (i, r) in work.iter_mut().enumerate() {
            let link = motion.link_force.get(i).unwrap_or(&0.0);
            *r = match system.fixed[i] {
                true => 0.0,
                false => residual[i] + self.map.contact * motion.contact_force[i] + link,
            };
        }
        self.operators.begin(work, half);
        self.operators.end(half, x);
        ahead.resize(x.len(), 0.0);
        self.map.displacement.whole(motion, x, &[], ahead);
    }

    /// Points that may carry a force. Some laws say so from the captured gap; of others, those are taken that carried one or
    /// that twice the present rate would close, and the rest is looked at after the solve.
    pub(super) fn choose_candidates(&mut self) {
        let system = &self.system;
        self.candidates.clear();
        for point in 0..system.points() {
            let gap = self.rows.gap(point);
            let law = system.point(point).0.law.get();
            let rate = self.rows.product(point, &self.state.motion.v);
            let least = least_gap(gap, law.capture() * self.map.moves * rate);
            let chosen = match law.watches(least, system.tolerance) {
                _ if gap == f64::INFINITY => false,
                Some(watched) => watched,
                None => {
                    self.state.interface.status[point] != Status::Open
                        || gap + 2.0 * self.dt * rate.min(0.0) <= system.tolerance
                }
            };
            self.next.interface.watched[point] = chosen;
            if chosen {
                self.candidates.push(point as u32);
            }
        }
    }

    pub(super) fn solve_interface(&mut self) -> Result<(), Error> {
        let system = &*self.system;
        let motion = &self.state.motion;
        self.compliance.update(
            &self.candidates,
            &self.rows,
            &system.fixed,
            &mut self.operators,
        );
        self.candidate_data.clear();
        self.free_gaps.clear();
        for &point in &self.candidates {
            let at = point as usize;
            let (contact, place) = system.point(at);
            let free = self
                .compliance
                .free(point, &self.operators, &self.vectors.half);
            let [nu, nv, na] =
                [&motion.u, &motion.v, &motion.a].map(|vector| self.rows.product(at, vector));
            let nm = match motion.memory.is_empty() {
                true => 0.0,
                false => self.rows.product(at, &motion.memory),
            };
            let value =
                |row: &Row| row.u * nu + row.v * nv + row.a * na + row.m * nm + row.x * free;
            let ([gap, rate], instant) = instant(&self.map, &contact.law);
            let until = |gap: &Row| self.rows.gap(at) + value(&gap.since(&self.captured[at]));
            self.free_gaps.push(until(&self.map.displacement));
            let carrier = &contact.points[place];
            self.candidate_data.push(Candidate {
                law: contact.law,
                local: Local {
                    area: carrier.area,
                    share: carrier.share,
                    gap: self.rows.gap(at),
                    rate: nv,
                    start: self.map.start_in_way() * nv,
                    gap_free: until(&gap),
                    dt: self.map.moves,
                    tolerance: system.tolerance,
                    crush: self.state.interface.crush[at],
                },
                rate_free: value(&rate),
                status: self.state.interface.status[at],
                faces_itself: contact.faces_itself(),
                instant,
            });
        }
        let factor = self.map.contact;
        let impulsive = match &mut self.impulses {
            Some(stage) if sums_compliances(system, &self.map) => {
                let own = (self.map.rate.x * factor, &self.compliance.matrix[..]);
                stage.sum(system, &self.rows, &self.candidates, own, self.map.rate.c)
            }
            _ => None,
        };
        let (matrix, factors) = match impulsive {
            Some(matrix) => (matrix, [0.0, 1.0]),
            None => (
                &self.compliance.matrix[..],
                [self.map.gap.x * factor, self.map.rate.x * factor],
            ),
        };
        let compliance = (
            matrix,
            &self.compliance.candidates[..],
            self.compliance.version,
        );
        let compliance = self
            .with_weak
            .of(&self.weak, system, (compliance, &self.rows), factors);
        let solved = self
            .interface
            .solve(&self.candidate_data, compliance, factors);
        if let Err(failure) = solved {
            let matrix = compliance.0.to_vec();
            self.failed = Some(self.problem(matrix, factors));
            return Err(self.interface_error(failure, &self.candidates));
        }
        if let Some(candidate) = self.interface.circled {
            let name = self.name(self.candidates[candidate]);
            tracing::warn!(
                "step {}: contact statuses cycle at {name}; they now change one at a time",
                self.state.step + 1
            );
        }
        for (&point, &force) in self.candidates.iter().zip(&self.interface.forces) {
            if force != 0.0 {
                self.compliance.add(
                    point,
                    factor * force,
                    &self.operators,
                    &mut self.vectors.half,
                );
            }
        }
        self.spread();
        Ok(())
    }

    /// Renews the memory of the laws at the points that carry a force at the end of the step.
    pub(super) fn crush(&mut self) {
        let (old, new) = (&self.state.interface, &mut self.next.interface);
        new.crush.clone_from(&old.crush);
        for &point in &self.candidates {
            let point = point as usize;
            if new.status[point] != Status::Open {
                let law = &self.system.point(point).0.law;
                new.crush[point] = law.crushed(old.crush[point], new.gap[point]);
            }
        }
    }

    /// Nodal contact forces of the step, and the acceleration that they give by themselves where the scheme uses it.
    fn spread(&mut self) {
        let system = &*self.system;
        let f = &mut self.next.motion.contact_force;
        f.fill(0.0);
        for (&point, &force) in self.candidates.iter().zip(&self.interface.forces) {
            self.rows.add_force(point as usize, force, f);
        }
        if self.map.uses_contact_acceleration() {
            let accelerations = &mut self.vectors.contact_acceleration;
            for (i, c) in accelerations.iter_mut().enumerate() {
                *c = match system.fixed[i] {
                    true => 0.0,
                    false => f[i] / system.mass.lumped[i],
                };
            }
        }
    }

    /// Contact, place in it and mesh node of a contact point.
    fn name(&self, point: u32) -> String {
        let (contact, place) = self.system.point(point as usize);
        let node = self.system.mesh_node[contact.points[place].node() as usize];
        format!("contact `{}`, point {place}, node {node}", contact.name)
    }

    /// The interface problem as it stands.
    fn problem(&self, compliance: Vec<f64>, factors: [f64; 2]) -> InterfaceProblem {
        InterfaceProblem {
            step: self.state.step + 1,
            names: self
                .candidates
                .iter()
                .map(|&point| self.name(point))
                .collect(),
            candidates: self.candidate_data.clone(),
            compliance,
            factors,
        }
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

    /// Adds the points that were no candidates and whose law asks for a force at the end of the step; whether there are any.
    pub(super) fn add_missed(&mut self) -> bool {
        let before = self.candidates.len();
        let motion = &self.state.motion;
        self.weak
            .take(&self.system, &self.candidates, &self.interface.forces, 1.0);
        let xc = [&self.vectors.x[..], &self.vectors.contact_acceleration[..]];
        for point in 0..self.system.points() {
            let captured = self.rows.gap(point);
            let law = self.system.point(point).0.law.get();
            let told = law.watches(captured, self.system.tolerance).is_some();
            if told || captured == f64::INFINITY {
                continue;
            }
            if self.candidates[..before]
                .binary_search(&(point as u32))
                .is_ok()
            {
                continue;
            }
            let [gap, rate] = instant(&self.map, &self.system.point(point).0.law).0;
            let ahead = gap.since(&self.captured[point]);
            let gap = captured + on_row(&self.rows, point, &ahead, motion, xc);
            let rate = on_row(&self.rows, point, &rate, motion, xc);
            let pull = self.weak.pull(&self.system, point);
            let end = End {
                gap_released: gap - pull,
                gap: gap - pull,
                rate: rate - pull,
                force: 0.0,
            };
            let start = self.rows.product(point, &motion.v);
            let local = Local {
                gap: captured,
                rate: start,
                start: self.map.start_in_way() * start,
                gap_free: gap,
                dt: self.map.moves,
                tolerance: self.system.tolerance,
                crush: self.state.interface.crush[point],
                ..Local::default()
            };
            if law.status(Status::Open, &end, &local, 0) != Status::Open {
                self.candidates.push(point as u32);
                self.next.interface.watched[point] = true;
            }
        }
        self.candidates.sort_unstable();
        self.candidates.len() > before
    }
}

/// Whether laws in the rate hold for a velocity on which contact forces act through the mass too: the interface problem then
/// sums the compliances of the step and of the mass.
pub(super) fn sums_compliances(system: &System, map: &StepMap) -> bool {
    map.rate.c != 0.0 && system.scheme.get().takes(Level::Rate)
}

/// Gap and rate that a law constrains, and their factors of x over those of the map.
pub(crate) fn instant(map: &StepMap, law: &Law) -> ([Row; 2], [f64; 2]) {
    match law.get().level() {
        Level::GapAndRate => (map.compliant(), map.compliant_factors()),
        Level::Gap | Level::Rate => ([map.gap, map.rate], [1.0; 2]),
    }
}

/// Whether a contact is paired where the step is predicted to lead, for a law that looks ahead, and not where the present
/// velocity does. In a step much longer than a wave takes across an element the velocity of the shortest waves times dt/2
/// leads much further than any node gets, and the turning of the rows would be that of an explicit step of the mass m of the
/// surface nodes alone, unstable beyond dt² |P ∂²g/∂u²| = 4 m.
pub(crate) fn looks_ahead(map: &StepMap, contact: &Contact, law: &Law) -> bool {
    map.force.x != 0.0 && contact.turns() && law.get().capture() > 0.0
}

/// The gap by which a law tells whether a point is closed (S_d): at the captured instant, `gap`, or at the start, a `way`
/// (m) before it, whichever is less. A point that is closed and leaves stays with its law, which alone knows whether
/// the step turns it back.
pub(crate) fn least_gap(gap: f64, way: f64) -> f64 {
    gap - way.max(0.0)
}

/// The part of the way from the start of the step to `end` at which a law takes the geometry.
pub(crate) fn part_way(motion: &Motion, end: &[f64], law: &Law, out: &mut [f64]) {
    let part = law.get().capture();
    for (i, q) in out.iter_mut().enumerate() {
        *q = (1.0 - part) * motion.u[i] + part * end[i];
    }
}

/// N applied to a row of the step, for one point.
pub(crate) fn on_row(
    rows: &Rows,
    point: usize,
    row: &Row,
    motion: &Motion,
    [x, c]: [&[f64]; 2],
) -> f64 {
    row.u * rows.product(point, &motion.u)
        + row.v * rows.product(point, &motion.v)
        + row.a * rows.product(point, &motion.a)
        + row.x * rows.product(point, x)
        + if row.m == 0.0 {
            0.0
        } else {
            row.m * rows.product(point, &motion.memory)
        }
        + if row.c == 0.0 {
            0.0
        } else {
            row.c * rows.product(point, c)
        }
}
