//! The end of an outer step: its forces become the state, with gaps, rates and records.

use std::sync::Arc;

use carom_contact::Pairing;
use carom_contact::law::Status;
use carom_dynamics::records::{Records, Step};
use carom_dynamics::state::InterfaceState;
use carom_dynamics::{Driver, Rubbing, contact_report, moment};
use carom_nonsmooth::coulomb::Slip;
use carom_schemes::Durations;
use carom_schemes::step_map::Impulse;

use super::CrossZoneContacts;
use super::geometry::{gather, without_forces};
use crate::stage::StageEnd;

impl CrossZoneContacts {
    /// Makes the forces those of the state at `time`, the end of an outer step of `dt` (both s).
    pub(crate) fn accept(&mut self, drivers: &[Driver], [time, dt]: [f64; 2]) {
        let before = self.state.interface.clone();
        let interface = &mut self.state.interface;
        interface.force.fill(0.0);
        interface.friction.fill([0.0; 2]);
        interface.status.fill(Status::Open);
        interface.watched.fill(false);
        let width = self.candidates.width();
        for (k, &point) in self.candidates.points.iter().enumerate() {
            let point = point as usize;
            let own = &self.candidates.forces[k * width..(k + 1) * width];
            interface.force[point] = own[0];
            if let Some(friction) = interface.friction.get_mut(point) {
                let tangential = friction.iter_mut().zip(&own[1..]);
                tangential.for_each(|(t, own)| *t = *own);
            }
            interface.status[point] = self.solver.found[k].status;
            interface.watched[point] = true;
        }
        interface.carried.clone_from(&interface.force);
        interface.count_flights(&before.flight, dt);
        for (sum, now) in self.state.works.iter_mut().zip(&self.now) {
            sum.iter_mut().zip(now).for_each(|(sum, now)| *sum += now);
        }
        let geometry = &mut self.geometry;
        gather(drivers, &geometry.places, &mut geometry.end);
        let ([u, v], [end, rate]) = (&geometry.start, &geometry.end);
        let rows = &geometry.pairing.rows;
        for (number, contact) in self.system.contacts.iter().enumerate() {
            let part = contact.law.get().capture() * dt;
            for point in self.system.points_of(number) {
                let paired = rows.product(point, u) + part * rows.product(point, v);
                let way = rows.product(point, end) - paired;
                let interface = &mut self.state.interface;
                interface.gap[point] = rows.gap(point) + way;
                interface.rate[point] = rows.product(point, rate);
                let is_closed = interface.force[point] != 0.0 || interface.gap[point] <= 0.0;
                let faced = geometry.pairing.faced(point).filter(|_| is_closed);
                interface.set_faced(point, faced);
                if interface.force[point] != 0.0 {
                    let (crush, gap) = (&mut interface.crush[point], interface.gap[point]);
                    *crush = contact.law.crushed(*crush, gap);
                }
            }
        }
        self.keep_pushed();
        self.add_records(&before, [time, dt]);
    }

    /// Records of a step of `dt` to `end` (both s), from the interface at its start.
    fn add_records(&mut self, before: &InterfaceState, [end, dt]: [f64; 2]) {
        let system = Arc::clone(&self.system);
        for contact in 0..system.contacts.len() {
            let points = || system.points_of(contact);
            let now = &self.state.interface;
            let rows = &self.geometry.pairing.rows;
            let mut report = contact_report(
                (points(), system.contacts[contact].tolerance),
                rows,
                [before, now],
                dt,
            );
            let slips = |point: usize| self.slip(point) == Slip::Slip;
            let rubbing = Rubbing {
                tangents: &self.geometry.pairing.tangents[..system.tangents()],
                forces: &now.friction,
                slips: &slips,
            };
            rubbing.add(points(), &mut report);
            report.friction_loss = -self.now[contact][1];
            report.moment = self.moment(contact);
            let share = |point: usize| {
                let (contact, place) = system.point(point);
                let energy =
                    |crush: f64| contact.points[place].share * contact.law.crush_energy(crush);
                energy(self.state.interface.crush[point]) - energy(before.crush[point])
            };
            let impulse = Impulse::weights(0.0, 1.0);
            let step = Step {
                span: [end - dt, end],
                dt,
                durations: Durations::of_step(dt, &impulse),
                impulse,
                forces: [&before.force, &self.state.interface.force],
                report: &report,
                work: self.now[contact][0],
                crushed: points().map(share).sum(),
                jump: Default::default(),
            };
            let velocities = [&self.geometry.start[1][..], &self.geometry.end[1]];
            let of = (&*system, contact);
            self.state.records.add(of, (&step, points()), velocities);
            self.reports[contact] = report;
        }
    }

    /// Status of friction that the last solve found of a point.
    fn slip(&self, point: usize) -> Slip {
        let place = self.candidates.points.binary_search(&(point as u32));
        place.map_or(Slip::Open, |k| self.solver.found[k].slip)
    }

    /// Forgets the forces and works so far.
    pub(crate) fn restart(&mut self, drivers: &[Driver]) {
        self.state.interface = without_forces(&self.system);
        self.state.works.fill([0.0; 2]);
        self.state
            .pushed
            .iter_mut()
            .for_each(|pushed| pushed.fill(0.0));
        self.state.records = Records::of(&self.system);
        self.geometry.gather_start(drivers);
        self.geometry
            .pair((&self.system, &self.state.interface), (0.0, 0.0));
        let (rows, interface) = (&self.geometry.pairing.rows, &mut self.state.interface);
        for point in 0..self.system.points() {
            interface.gap[point] = rows.gap(point);
            interface.rate[point] = rows.product(point, &self.geometry.start[1]);
        }
        for contact in 0..self.contacts.len() {
            let now = &self.state.interface;
            let points = self.system.points_of(contact);
            self.reports[contact] = contact_report(
                (points, self.system.contacts[contact].tolerance),
                rows,
                [now; 2],
                0.0,
            );
        }
    }

    /// Takes the forces that a static stage ended with.
    pub(crate) fn begin_dynamics(&mut self, drivers: &[Driver], end: &StageEnd) {
        self.restart(drivers);
        let own = &mut self.state.interface;
        for (to, from) in end.between.iter().enumerate() {
            own.take_point(to, (&end.whole.interface, *from));
        }
        for (record, &contact) in self.state.records.contacts.iter_mut().zip(&self.contacts) {
            record.clone_from(&end.whole.records.contacts[contact]);
        }
        self.state.records.begin_dynamics();
        let of = (&*self.system, &self.geometry, &self.compliance.rigid);
        self.candidates.choose(of, &self.state.interface, 0.0);
        self.keep_pushed();
    }

    /// Makes `force` (N, by unknown of a zone) that of the candidates.
    pub(crate) fn spread(&self, zone: usize, force: &mut [f64]) {
        force.fill(0.0);
        for (row, terms) in &self.candidates.rows[zone] {
            for &(unknown, c) in terms {
                force[unknown as usize] += c * self.candidates.forces[*row as usize];
            }
        }
    }

    /// Moment of a contact about the point that it names, at the mean of the places at start and end of the step, N m.
    fn moment(&mut self, contact: usize) -> [f64; 3] {
        let interface = &self.state.interface;
        let geometry = &mut self.geometry;
        let Pairing { rows, tangents, .. } = &geometry.pairing;
        let of_point = |point: usize| {
            let normal = std::iter::once((rows, point, interface.force[point]));
            let friction = tangents
                .iter()
                .zip(interface.friction.get(point).into_iter().flatten());
            normal.chain(friction.map(move |(rows, t)| (rows, point, *t)))
        };
        let forces = self.system.points_of(contact).flat_map(of_point);
        let ends = [&geometry.start[0][..], &geometry.end[0]];
        let at = (&geometry.frames[..], &ends[..]);
        moment((&self.system, contact), forces, at, &mut geometry.nodal)
    }
}
