//! The contacts of an iteration: where they are paired, and what their laws see.

use std::sync::Arc;

use carom_contact::law::{End, Level, Status};
use carom_contact::{Balance, Sliding};
use carom_system::ContactPair;

use super::Contacts;
use super::deletion::as_narrowed;
use crate::driver::attempt::Attempt;
use crate::driver::attempt::vectors::Vectors;
use crate::driver::paired::{Paired, append, instant, part_way, told};
use crate::driver::parts::Parts;
use crate::step_map::{Row, StepMap};
use crate::system::System;

/// Entry of a row of unit normals that is no rounding of a direction.
const CLEARLY: f64 = 1e-3;

impl Contacts {
    /// The configuration in which a contact is paired.
    pub(crate) fn paired_at(&self, number: usize) -> Paired {
        match self.closings.instant(number) {
            Some(instant) => Paired::Captured(instant),
            None => self.pairing_modes[number].paired,
        }
    }

    /// Derivative of the paired configuration by the unknown; zero where all of it is known before the step.
    pub(crate) fn turning(&self, contact: usize) -> f64 {
        self.pairing_modes[contact].turning
    }

    /// Pairs all contacts at the x of the iteration. `first`: those in known configurations too.
    pub(crate) fn pair(&mut self, attempt: &mut Attempt, first: bool) {
        let system = Arc::clone(&attempt.system);
        // moments about axes that turn depend on the rotation of the step
        let turns = !system.unknowns.turning().is_empty();
        if !first && !turns && !self.turns {
            return;
        }
        if turns {
            let Vectors { x, push, end, .. } = &mut attempt.vectors;
            end.resize(x.len(), 0.0);
            attempt.maps.whole(
                |map| map.displacement,
                &attempt.state.motion,
                [x, push],
                end,
            );
        }
        let predicts = !attempt.vectors.ahead.is_empty();
        let stand = self.rows_stand && !predicts;
        if !stand {
            self.pairing.clear();
        }
        let mut placed = None;
        for (k, contact) in system.contacts.iter().enumerate() {
            let paired = self.paired_at(k);
            let ahead = predicts && attempt.looks_ahead(k) && self.closings.instant(k).is_none();
            let motion = &attempt.state.motion;
            let Vectors {
                x,
                push,
                place,
                ahead: predicted,
                ..
            } = &mut attempt.vectors;
            let configuration = (!ahead).then_some(paired);
            if ahead || placed != configuration {
                self.far.forget_places();
            }
            match ahead {
                true => part_way(motion, predicted, &contact.law, place),
                // where the one before was paired
                false if placed == configuration => {}
                false => attempt
                    .maps
                    .whole(|map| paired.row(map), motion, [x, push], place),
            }
            placed = configuration;
            if stand {
                let (first, place) = (system.contacts[k].range.start, &attempt.vectors.place);
                let initial = &self.initial[k].rows;
                self.pairing.rows.move_again(first, initial, place);
                continue;
            }
            self.pairing.span = self.span(attempt, k);
            let first = self.pairing.len();
            self.append(
                attempt,
                k,
                attempt.state.time + self.paired_after(attempt, k),
            );
            if ahead {
                self.move_gaps(attempt, first, paired);
            }
        }
        let stands = |contact: &ContactPair| contact.sliding == Sliding::Small && !contact.moves();
        self.rows_stand = !turns && !predicts && system.contacts.iter().all(stands);
        self.stack(attempt);
    }

    /// Appends a contact at the configuration in `place`; `time`, s: where obstacles are.
    pub(crate) fn append(&mut self, attempt: &mut Attempt, number: usize, time: f64) {
        let system = Arc::clone(&attempt.system);
        let (middle, frames) = (attempt.between(), &attempt.state.motion.frames);
        let fraction = attempt.map_of(number).force_fraction.unwrap_or(1.0);
        let Vectors {
            place, work, end, ..
        } = &mut attempt.vectors;
        let mut places = system.places(time, place, frames);
        places.frames.middle = middle;
        places.frames.balance = (!end.is_empty()).then_some(Balance { end, fraction });
        let contact = as_narrowed(&self.narrowed, &system, number);
        if self.far.has(number) {
            let (gaps, first) = (
                &attempt.state.interface.gap,
                system.contacts[number].range.start,
            );
            let inside = |point: usize| gaps[first + point] < 0.0;
            let kept = (&mut self.search[number], &mut self.pairing);
            let (motion, time) = (&attempt.state.motion, attempt.state.time);
            let start = system.places(time, &motion.u, &motion.frames);
            let placed = (&places, &start);
            return self.far.append((contact, number), placed, &inside, kept);
        }
        let kept = (&mut self.search[number], &mut self.initial[number]);
        append(contact, &places, work, kept, &mut self.pairing);
    }

    /// Gap and rate that the law of a point constrains, at the x of the iteration. `pushed`: with what the contact forces of the
    /// iteration give to the rate by themselves.
    pub(crate) fn now(&self, attempt: &Attempt, point: usize, pushed: bool) -> (f64, f64) {
        let rows = &self.pairing.rows;
        let number = attempt.system.contact_of(point);
        let contact = &attempt.system.contacts[number];
        let motion = &attempt.state.motion;
        let xc = [&attempt.vectors.x[..], &attempt.vectors.push];
        let (law, paired) = (attempt.law(contact), self.paired_at(number));
        let ahead = |map: &StepMap| instant(map, law).0[0].since(&paired.row(map));
        let rate = |map: &StepMap| {
            let mut rate = instant(map, law).0[1];
            if !pushed {
                rate.c = 0.0;
            }
            rate
        };
        let obstacle = rows.rate(point);
        let until = match law.get().level() {
            Level::GapAndRate => attempt.map_of(number).instant(attempt.dt),
            Level::Gap | Level::Rate => attempt.dt,
        };
        let gap = rows.gap(point)
            + attempt.maps.on((rows, point), ahead, motion, xc)
            + obstacle * (until - self.paired_after(attempt, number));
        (
            gap,
            attempt.maps.on((rows, point), rate, motion, xc) + obstacle,
        )
    }

    /// Gap rate at the start of the step, m/s, with the rows of the iteration.
    pub(crate) fn rate_at_start(&self, attempt: &Attempt, point: usize) -> f64 {
        let rows = &self.pairing.rows;
        rows.product(point, &attempt.state.motion.v) + rows.rate(point)
    }

    /// Whether a point takes part, where its law says so before the forces.
    pub(crate) fn told(&self, attempt: &Attempt, point: usize) -> Option<bool> {
        let gap = self.pairing.rows.gap(point);
        if gap == f64::INFINITY || self.is_held(attempt, point) {
            return Some(false);
        }
        let law = attempt.law(attempt.system.point(point).0);
        let tolerance = attempt.system.tolerance_at(point);
        if attempt.between() {
            let gap = attempt.state.interface.gap[point];
            return law.get().watches(gap, tolerance);
        }
        if self
            .closings
            .instant(attempt.system.contact_of(point))
            .is_some()
        {
            return law.get().watches(gap, tolerance);
        }
        let landed = attempt.state.interface.landed[point];
        let rate = self.rate_at_start(attempt, point);
        told(law, (gap + landed, rate), attempt.moves(point), tolerance)
    }

    /// Whether no force moves a point, what its row moves being held but for rounding, and its law does not say the force either: the support
    /// takes what presses it, and no force of the contact is decided by anything.
    fn is_held(&self, attempt: &Attempt, point: usize) -> bool {
        let (unknowns, row) = self.pairing.rows.row(point);
        let (mut free, mut whole) = (0.0, 0.0);
        for (&unknown, n) in unknowns.iter().zip(row) {
            if !attempt.system.fixed[unknown as usize] {
                if n.abs() > CLEARLY {
                    return false;
                }
                free += n * n;
            }
            whole += n * n;
        }
        if free > f64::EPSILON * whole || unknowns.is_empty() {
            return false;
        }
        let law = attempt.law(attempt.system.point(point).0);
        let relation = law
            .get()
            .relation(Status::Closed, &self.local(attempt, point, 0.0));
        relation.compliance == 0.0
    }

    /// Takes the multipliers of the weak forms that belong to the forces as they stand.
    pub(crate) fn take_weak(&mut self, attempt: &Attempt) {
        let forces = attempt.next.interface.force.iter().copied().enumerate();
        self.weak.take(&attempt.system, forces, 1.0);
    }

    /// The same of other forces: of some points, in N once multiplied with `factor`.
    pub(crate) fn take_weak_forces(
        &mut self,
        system: &System,
        forces: impl Iterator<Item = (usize, f64)> + Clone,
        factor: f64,
    ) {
        self.weak.take(system, forces, factor);
    }

    /// Gap and rate of a point with what its weak form adds to them.
    pub(super) fn weakly(
        &self,
        attempt: &Attempt,
        point: usize,
        (gap, rate): (f64, f64),
    ) -> (f64, f64) {
        let force = attempt.next.interface.force[point];
        match self.weak.shift(&attempt.system, point, force) {
            None => (gap, rate),
            Some((shift, Level::Gap)) => (gap + shift, rate),
            Some((shift, _)) => (gap, rate + shift),
        }
    }

    /// Pairs all contacts as the state has them.
    pub(crate) fn pair_now(&mut self, attempt: &mut Attempt) {
        self.rows_stand = false;
        self.pairing.clear();
        self.pairing.span = [0.0; 2];
        attempt.vectors.end.clear();
        attempt.vectors.place.clone_from(&attempt.state.motion.u);
        self.remember(attempt);
        self.begin_far(attempt);
        for contact in 0..attempt.system.contacts.len() {
            self.append(attempt, contact, attempt.state.time);
        }
        self.candidates.clear();
    }

    /// Begins a step of the contacts that do not look for what is far.
    pub(crate) fn begin_far(&mut self, attempt: &Attempt) {
        self.far.forget_places();
        let unknowns = &attempt.system.unknowns;
        self.far
            .begin(unknowns, (&attempt.state.motion.v, attempt.dt));
    }

    /// Pairs again where the motion of the iteration leads further than contacts have looked.
    pub(crate) fn look_further(&mut self, attempt: &mut Attempt) {
        if self.far.is_empty() {
            return;
        }
        let Vectors {
            x, push, place, dx, ..
        } = &mut attempt.vectors;
        let way = |map: &StepMap| map.displacement.since(&Row::START);
        attempt
            .maps
            .whole(way, &attempt.state.motion, [x, push], place);
        for (span, map) in attempt.maps.spans() {
            for i in span {
                place[i] += map.displacement.x * dx[i];
            }
        }
        if !self.far.is_enough(&attempt.system.unknowns, place) {
            // pairing uses the room of the forces of the iteration
            let work = attempt.vectors.work.clone();
            self.pair(attempt, true);
            attempt.vectors.work = work;
        }
    }

    /// Moves the gaps of the points from `first` on, paired at the configuration in `place`, to another one.
    fn move_gaps(&mut self, attempt: &mut Attempt, first: usize, to: Paired) {
        let Vectors {
            x,
            push,
            place,
            work,
            ..
        } = &mut attempt.vectors;
        let motion = &attempt.state.motion;
        attempt
            .maps
            .whole(|map| to.row(map), motion, [x, push], work);
        for (way, from) in work.iter_mut().zip(place) {
            *way -= *from;
        }
        self.pairing.rows.move_from(first, work);
    }

    /// Whether the law of an open point asks for a force at this gap and rate, beyond rounding.
    pub(crate) fn asks(
        &self,
        parts: &Parts,
        attempt: &Attempt,
        point: usize,
        gap: f64,
        rate: f64,
    ) -> bool {
        let end = End {
            gap_released: gap,
            gap,
            rate,
            force: 0.0,
        };
        let law = attempt.law(attempt.system.point(point).0);
        let least = match self.is_affine(parts) {
            true => 0.0,
            false => -attempt.gap_tolerance(attempt.system.contact_of(point)),
        };
        gap < least
            && law
                .get()
                .status(Status::Open, &end, &self.local(attempt, point, gap), 0)
                != Status::Open
    }

    /// The point that disobeys its law most at the x of the iteration, and by how much in tolerances.
    pub(crate) fn worst_point(&self, parts: &Parts, attempt: &Attempt) -> Option<(usize, f64)> {
        let contacts = 0..attempt.system.contacts.len();
        let worst = contacts.filter_map(|contact| self.worst_point_of(parts, attempt, contact));
        worst.reduce(|one, other| if other.1 > one.1 { other } else { one })
    }

    /// The same of a contact. Its forces are compared with the largest of its own.
    fn worst_point_of(
        &self,
        parts: &Parts,
        attempt: &Attempt,
        contact: usize,
    ) -> Option<(usize, f64)> {
        let tolerance = attempt.gap_tolerance(contact);
        let points = attempt.system.points_of(contact);
        let forces = attempt.next.interface.force[points.clone()].iter();
        let largest = forces.fold(0.0_f64, |most, force| most.max(force.abs()));
        let mut worst: Option<(usize, f64)> = None;
        for point in points {
            let has_left = || self.telling.has_left(point as u32);
            if self.told(attempt, point) == Some(false) || has_left() {
                continue;
            }
            let (gap, rate) = self.weakly(attempt, point, self.now(attempt, point, true));
            let status = attempt.next.interface.status[point];
            let force = attempt.next.interface.force[point];
            let law = attempt.law(attempt.system.point(point).0);
            let defect = match status {
                Status::Open if self.told(attempt, point).is_none() => {
                    match self.asks(parts, attempt, point, gap, rate) {
                        true => -gap / tolerance,
                        false => 0.0,
                    }
                }
                _ => {
                    let local = self.local(attempt, point, gap).about(gap, rate);
                    let relation = match status {
                        Status::Open => law.get().relation(Status::Closed, &local),
                        _ => law.get().relation(status, &local),
                    };
                    let left = relation.gap * gap
                        + relation.rate * rate
                        + relation.compliance * force
                        + relation.offset;
                    let scale = relation.gap.abs() + relation.rate.abs() / attempt.dt;
                    // a law that cuts tension off leaves a gap or a rate over where it would pull
                    match status == Status::Open || law.get().clips() && force == 0.0 {
                        true => (-left / scale / tolerance).max(0.0),
                        false => (left / scale / tolerance).abs(),
                    }
                }
            };
            let cone = self.cone_defect(attempt, point, largest)
                / attempt.system.nonlinear.iteration.tolerance;
            let defect = defect
                .max(self.slip_defect(attempt, point) / tolerance)
                .max(cone);
            if worst.is_none_or(|(_, most)| defect > most) {
                worst = Some((point, defect));
            }
        }
        worst
    }

    /// Whether all is linear in the unknown, so that one iteration is all.
    pub(crate) fn is_affine(&self, parts: &Parts) -> bool {
        !self.turns && !parts.effective().iterates()
    }
}
