//! The contacts of an iteration: pairing, candidates, forces.

use std::sync::Arc;

use carom_contact::law::{Displacement, End, Level, Local, Status};
use carom_contact::{Contact, Law, Places, Sliding};

use super::{Newton, Vectors};
use crate::coulomb::Slip;
use crate::driver::{instant, least_gap, on_row, part_way};
use crate::error::Error;
use crate::interface::{Candidate, Failure, InterfaceProblem};
use crate::step_map::Row;

/// Additions of missed candidates within one iteration.
const ADDITIONS: usize = 10;

impl Newton {
    /// The law of a contact in the attempt under way. In a static stage nothing has a rate: a law in the rate holds in the
    /// gap there, as the displacement law.
    pub(super) fn law(&self, contact: &Contact) -> Law {
        match contact.law.get().level() {
            Level::Rate if self.map.inertia.x == 0.0 => {
                Law::Displacement(Displacement { projection: false })
            }
            _ => contact.law,
        }
    }

    /// The configuration in which a contact is paired: of a law in the gap the one that it constrains, of a law in the rate
    /// the captured one, which is known; of a scheme between two states their middle. With small sliding gaps are linear in
    /// the displacement, and are those of a configuration that is known.
    pub(super) fn paired_at(&self, contact: &Contact) -> Row {
        let map = &self.map;
        let law = self.law(contact);
        let captured = Row {
            v: map.placed.v + law.get().capture() * self.dt,
            ..map.placed
        };
        if contact.sliding == Sliding::Small {
            return captured;
        }
        if self.between() {
            let end = &map.displacement;
            return Row {
                u: 0.5 + 0.5 * end.u,
                v: 0.5 * end.v,
                a: 0.5 * end.a,
                x: 0.5 * end.x,
                ..Row::default()
            };
        }
        match law.get().level() {
            Level::Rate => captured,
            Level::Gap => map.gap,
            Level::GapAndRate => map.compliant()[0],
        }
    }

    /// Whether internal forces and contacts belong to the way of the step.
    pub(super) fn between(&self) -> bool {
        self.map.inertia.x != 0.0 && self.system.scheme.get().is_between()
    }

    /// Derivative of the paired configuration by the unknown; zero where all of it is known before the step.
    pub(super) fn turning(&self, contact: &Contact) -> f64 {
        self.paired_at(contact).x
    }

    /// Pairs all contacts at the x of the iteration. `first`: those in known configurations too.
    pub(super) fn pair(&mut self, first: bool) {
        let system = Arc::clone(&self.system);
        let known = |contact: &Contact| self.turning(contact) == 0.0;
        if !first && system.contacts.iter().all(known) {
            return;
        }
        self.pairing.clear();
        for (k, contact) in system.contacts.iter().enumerate() {
            let row = self.paired_at(contact);
            let ahead = self.looks_ahead(contact) && !self.vectors.ahead.is_empty();
            let motion = &self.state.motion;
            let Vectors {
                x,
                place,
                ahead: end,
                ..
            } = &mut self.vectors;
            match ahead {
                true => part_way(motion, end, &contact.law, place),
                false => row.whole(motion, x, &[], place),
            }
            self.pairing.span = self.span(contact);
            let first = self.pairing.len();
            self.append(k, self.state.time + self.paired_after(contact));
            if ahead {
                self.move_gaps(first, &row);
            }
        }
        self.stack();
    }

    /// Appends a contact at the configuration in `place`; `time`, s: where obstacles are. With small sliding the points are
    /// paired at their reference places, once, or with an obstacle that moves where it is now; gaps are then linear in the
    /// displacement, and rows and tangents do not turn with the bodies.
    pub(super) fn append(&mut self, number: usize, time: f64) {
        let system = Arc::clone(&self.system);
        let contact = &system.contacts[number];
        let search = &mut self.search[number];
        let Vectors { place, work, .. } = &mut self.vectors;
        let at = |u| Places {
            unknowns: &system.unknowns,
            time,
            x: &system.x,
            u,
        };
        if contact.sliding == Sliding::Finite {
            return contact.pair_fully(&at(place), search, &mut self.pairing);
        }
        let initial = &mut self.initial[number];
        if initial.is_empty() || contact.moves() {
            initial.clear();
            initial.span = self.pairing.span;
            work.fill(0.0);
            contact.pair_fully(&at(work), search, initial);
        }
        self.pairing.append_moved(initial, place);
    }

    /// How long after the start of the step a contact is paired, s.
    pub(super) fn paired_after(&self, contact: &Contact) -> f64 {
        let law = self.law(contact);
        match law.get().level() {
            _ if self.between() => 0.5 * self.dt,
            Level::Rate => law.get().capture() * self.dt,
            Level::Gap => self.dt,
            Level::GapAndRate => self.instant() - self.state.time,
        }
    }

    /// Gap and rate that the law of a point constrains, at the x of the iteration.
    pub(super) fn now(&self, point: usize) -> (f64, f64) {
        let rows = &self.pairing.rows;
        let (contact, _) = self.system.point(point);
        let motion = &self.state.motion;
        let xc = [&self.vectors.x[..], &[]];
        let [gap, rate] = self.constrained(contact).0;
        let ahead = gap.since(&self.paired_at(contact));
        let obstacle = rows.rate(point);
        let until = match self.law(contact).get().level() {
            Level::GapAndRate => self.instant() - self.state.time,
            Level::Gap | Level::Rate => self.dt,
        };
        let gap = rows.gap(point)
            + on_row(rows, point, &ahead, motion, xc)
            + obstacle * (until - self.paired_after(contact));
        (gap, on_row(rows, point, &rate, motion, xc) + obstacle)
    }

    /// Gap and rate that the law of a contact constrains, and their factors of x over those of the map.
    fn constrained(&self, contact: &Contact) -> ([Row; 2], [f64; 2]) {
        instant(&self.map, &self.law(contact))
    }

    /// What a motion of the unknown along the row of a point adds to the gap and the rate that its law constrains.
    fn added(&self, point: usize, step: f64) -> [f64; 2] {
        let [gap, rate] = self.constrained(self.system.point(point).0).0;
        [gap.x * step, rate.x * step]
    }

    /// What the law of a point may know before the forces.
    fn local(&self, point: usize, gap_free: f64) -> Local {
        let (contact, place) = self.system.point(point);
        let carrier = &contact.points[place];
        let rows = &self.pairing.rows;
        let gap = match self.between() {
            // S_d looks at the start of the step
            true => self.state.interface.gap[point],
            false => rows.gap(point),
        };
        let rate = self.rate_at_start(point);
        Local {
            area: carrier.area,
            share: carrier.share,
            gap,
            rate,
            start: self.map.start_in_way() * rate,
            gap_free,
            dt: self.dt,
            tolerance: self.system.tolerance,
            crush: self.state.interface.crush[point],
        }
    }

    /// Gap rate at the start of the step, m/s, with the rows of the iteration.
    pub(super) fn rate_at_start(&self, point: usize) -> f64 {
        let rows = &self.pairing.rows;
        rows.product(point, &self.state.motion.v) + rows.rate(point)
    }

    /// Whether a point takes part, where its law says so before the forces.
    fn told(&self, point: usize) -> Option<bool> {
        let gap = self.pairing.rows.gap(point);
        if gap == f64::INFINITY {
            return Some(false);
        }
        let law = self.law(self.system.point(point).0);
        let gap = match self.between() {
            true => self.state.interface.gap[point],
            false => {
                let way = law.get().capture() * self.dt * self.rate_at_start(point);
                least_gap(gap, way)
            }
        };
        law.get().watches(gap, self.system.tolerance)
    }

    /// Solves the interface problem of the iteration, whose motion without contact forces is in `dx` and whose begun solve
    /// in `half`; completes `dx`.
    pub(super) fn solve_interface(&mut self) -> Result<(), Error> {
        self.choose_candidates();
        if self.candidates.is_empty() {
            self.release();
            return Ok(());
        }
        let mut free = std::mem::take(&mut self.vectors.free);
        free.copy_from_slice(&self.vectors.dx);
        self.vectors.begun.copy_from_slice(&self.vectors.half);
        let mut solved = Ok(());
        for _ in 0..ADDITIONS {
            let Vectors { half, begun, .. } = &mut self.vectors;
            half.copy_from_slice(begun);
            solved = self.solve_candidates(&free);
            if solved.is_err() || !self.add_missed() {
                break;
            }
        }
        self.vectors.free = free;
        solved
    }

    fn choose_candidates(&mut self) {
        self.candidates.clear();
        for point in 0..self.system.points() {
            let chosen = match self.told(point) {
                Some(told) => told,
                None => {
                    let step = self.pairing.rows.product(point, &self.vectors.dx);
                    self.next.interface.status[point] != Status::Open
                        || self.now(point).0 + self.added(point, step)[0] <= self.system.tolerance
                }
            };
            self.next.interface.watched[point] = chosen;
            if chosen {
                self.candidates.push(point as u32);
            }
        }
    }

    fn solve_candidates(&mut self, free: &[f64]) -> Result<(), Error> {
        let system = Arc::clone(&self.system);
        let mut data = std::mem::take(&mut self.candidate_data);
        data.clear();
        data.extend(self.candidates.iter().map(|&point| {
            let at = point as usize;
            let step = self.pairing.rows.product(at, free);
            let (gap, rate) = self.now(at);
            let [closing, approach] = self.added(at, step);
            Candidate {
                law: self.law(system.point(at).0),
                local: self.local(at, gap + closing),
                rate_free: rate + approach,
                status: self.next.interface.status[at],
                faces_itself: system.point(at).0.faces_itself(),
                instant: self.constrained(system.point(at).0).1,
            }
        }));
        self.candidate_data = data;
        if self.rubs() {
            return self.solve_with_friction(free);
        }
        let rows = &self.pairing.rows;
        let factor = self.map.contact;
        let factors = [self.map.gap.x * factor, self.map.rate.x * factor];
        let Some((operators, compliance)) = self.effective.both() else {
            return Ok(());
        };
        compliance.update(&self.candidates, rows, &system.fixed, operators);
        let condensed = (
            &compliance.matrix[..],
            &compliance.candidates[..],
            compliance.version,
        );
        let matrix = self
            .with_weak
            .of(&self.weak, &system, (condensed, rows), factors);
        let solved = self.interface.solve(&self.candidate_data, matrix, factors);
        if let Err(failure) = solved {
            let compliance = matrix.0.to_vec();
            return Err(self.interface_error(failure, compliance, factors));
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
        self.end_iteration();
        self.take_weak();
        Ok(())
    }

    /// Takes the multipliers of the weak forms that belong to the forces as they stand.
    pub(super) fn take_weak(&mut self) {
        let forces = &self.next.interface.force;
        let points: Vec<u32> = (0..forces.len() as u32).collect();
        self.weak.take(&self.system, &points, forces, 1.0);
    }

    /// Gap and rate of a point with what its weak form adds to them.
    fn weakly(&self, point: usize, (gap, rate): (f64, f64)) -> (f64, f64) {
        let force = self.next.interface.force[point];
        match self.weak.shift(&self.system, point, force) {
            None => (gap, rate),
            Some((shift, Level::Gap)) => (gap + shift, rate),
            Some((shift, _)) => (gap, rate + shift),
        }
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

    /// The motion of the iteration from the begun solve with all forces in it.
    pub(super) fn end_iteration(&mut self) {
        if let Some((operators, _)) = self.effective.both() {
            operators.end(&mut self.vectors.half, &mut self.vectors.dx);
        }
        for (dx, jump) in self.vectors.dx.iter_mut().zip(&self.vectors.jump) {
            *dx += jump;
        }
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
            let (gap, rate) = self.now(point);
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

    /// Whether the law of an open point asks for a force at this gap and rate, beyond rounding.
    fn asks(&self, point: usize, gap: f64, rate: f64) -> bool {
        let end = End {
            gap_released: gap,
            gap,
            rate,
            force: 0.0,
        };
        let law = self.law(self.system.point(point).0);
        gap < -self.gap_tolerance()
            && law
                .get()
                .status(Status::Open, &end, &self.local(point, gap), 0)
                != Status::Open
    }

    /// Gap that counts as none where a step ends, m.
    pub(super) fn gap_tolerance(&self) -> f64 {
        100.0 * self.system.tolerance
    }

    /// The point that disobeys its law most at the x of the iteration, and by how much in tolerances.
    pub(super) fn worst_point(&self) -> Option<(usize, f64)> {
        let tolerance = self.gap_tolerance();
        let forces = self.next.interface.force.iter();
        let largest = forces.fold(0.0_f64, |most, force| most.max(force.abs()));
        let mut worst: Option<(usize, f64)> = None;
        for point in 0..self.system.points() {
            if self.told(point) == Some(false) {
                continue;
            }
            let (gap, rate) = self.weakly(point, self.now(point));
            let status = self.next.interface.status[point];
            let force = self.next.interface.force[point];
            let law = self.law(self.system.point(point).0);
            let defect = match status {
                Status::Open if self.told(point).is_none() => match self.asks(point, gap, rate) {
                    true => -gap / tolerance,
                    false => 0.0,
                },
                _ => {
                    let local = self.local(point, gap);
                    let relation = match status {
                        Status::Open => law.get().relation(Status::Closed, &local),
                        _ => law.get().relation(status, &local),
                    };
                    let left = relation.gap * gap
                        + relation.rate * rate
                        + relation.compliance * force
                        + relation.offset;
                    let scale = relation.gap.abs() + relation.rate.abs() / self.dt;
                    // a law that cuts tension off leaves a gap or a rate over where it would pull
                    match status == Status::Open || law.get().clips() && force == 0.0 {
                        true => (-left / scale / tolerance).max(0.0),
                        false => (left / scale / tolerance).abs(),
                    }
                }
            };
            let cone = self.cone_defect(point, largest) / self.system.nonlinear.iteration.tolerance;
            let defect = defect.max(self.slip_defect(point) / tolerance).max(cone);
            if worst.is_none_or(|(_, most)| defect > most) {
                worst = Some((point, defect));
            }
        }
        worst
    }

    /// Nᵀ P of the forces as they stand, into `contact`.
    pub(super) fn spread(&mut self) {
        let f = &mut self.vectors.contact;
        f.fill(0.0);
        for (point, &force) in self.next.interface.force.iter().enumerate() {
            if force != 0.0 {
                self.pairing.rows.add_force(point, force, f);
            }
        }
        self.spread_friction();
    }

    /// Contact, place in it and mesh node of a contact point.
    pub(super) fn name(&self, point: usize) -> String {
        let (contact, place) = self.system.point(point);
        let node = self.system.mesh_node[contact.points[place].node() as usize];
        format!("contact `{}`, point {place}, node {node}", contact.name)
    }

    pub(super) fn interface_error(
        &mut self,
        failure: Failure,
        compliance: Vec<f64>,
        factors: [f64; 2],
    ) -> Error {
        let step = self.state.step + 1;
        let names = self
            .candidates
            .iter()
            .map(|&point| self.name(point as usize));
        self.failed = Some(InterfaceProblem {
            step,
            names: names.collect(),
            candidates: self.candidate_data.clone(),
            compliance,
            factors,
        });
        match failure {
            Failure::Singular { points, cause } => Error::Interface {
                step,
                points,
                cause,
            },
            Failure::Cycling { passes, candidate } => {
                let (contact, point) = self.system.point(self.candidates[candidate] as usize);
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
