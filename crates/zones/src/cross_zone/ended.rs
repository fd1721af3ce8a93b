//! The end of an outer step: its forces become the state, with gaps, rates and records.

use std::sync::Arc;

use carom_contact::law::Status;
use carom_dynamics::records::{Records, Step};
use carom_dynamics::state::{InterfaceState, empty_state};
use carom_dynamics::{Driver, contact_report, moment};
use carom_schemes::step_map::Impulse;

use super::{CrossZoneContacts, gather};

impl CrossZoneContacts {
    /// Makes the forces those of the state at `time`, the end of an outer step of `dt` (both s).
    pub(crate) fn accept(&mut self, drivers: &[Driver], [time, dt]: [f64; 2]) {
        let before = self.state.interface.clone();
        let interface = &mut self.state.interface;
        interface.force.fill(0.0);
        interface.status.fill(Status::Open);
        interface.watched.fill(false);
        for (k, &point) in self.candidates.iter().enumerate() {
            let point = point as usize;
            interface.force[point] = self.forces[k];
            interface.status[point] = self.interface.statuses[k];
            interface.watched[point] = true;
        }
        interface.carried.clone_from(&interface.force);
        interface.count_flights(&before.flight, dt);
        for (sum, now) in self.state.works.iter_mut().zip(&self.now) {
            *sum += now;
        }
        gather(drivers, &self.places, &mut self.end);
        let ([u, v], [end, rate], rows) = (&self.start, &self.end, &self.pairing.rows);
        for contact in 0..self.contacts.len() {
            let part = self.captured(contact) * dt;
            for point in self.system.points_of(contact) {
                let paired = rows.product(point, u) + part * rows.product(point, v);
                let way = rows.product(point, end) - paired;
                let interface = &mut self.state.interface;
                interface.gap[point] = rows.gap(point) + way;
                interface.rate[point] = rows.product(point, rate);
            }
        }
        self.add_records(&before, [time, dt]);
    }

    /// Records of a step of `dt` to `end` (both s), from the interface at its start.
    fn add_records(&mut self, before: &InterfaceState, [end, dt]: [f64; 2]) {
        let system = Arc::clone(&self.system);
        for contact in 0..system.contacts.len() {
            let now = &self.state.interface;
            let rows = &self.pairing.rows;
            let mut report = contact_report(system.points_of(contact), rows, [before, now], dt);
            report.moment = self.moment(contact);
            let now = &self.state.interface;
            let step = Step {
                span: [end - dt, end],
                dt,
                impulse: Impulse::weights(0.0, 1.0),
                forces: [&before.force, &now.force],
                report: &report,
                work: self.now[contact],
                crushed: 0.0,
                jump: Default::default(),
            };
            let velocities = [&self.start[1][..], &self.end[1]];
            let points = system.points_of(contact);
            let of = (&*system, contact);
            self.state.records.add(of, (&step, points), velocities);
            self.reports[contact] = report;
        }
    }

    /// Forgets the forces and works so far.
    pub(crate) fn restart(&mut self, drivers: &[Driver]) {
        self.state.interface = empty_state(&self.system).interface;
        self.state.works.fill(0.0);
        self.state.records = Records::of(&self.system);
        gather(drivers, &self.places, &mut self.start);
        self.gather_frames(drivers);
        self.pair((0.0, 0.0));
        let (rows, interface) = (&self.pairing.rows, &mut self.state.interface);
        for point in 0..self.system.points() {
            interface.gap[point] = rows.gap(point);
            interface.rate[point] = rows.product(point, &self.start[1]);
        }
        for contact in 0..self.contacts.len() {
            let (rows, now) = (&self.pairing.rows, &self.state.interface);
            self.reports[contact] =
                contact_report(self.system.points_of(contact), rows, [now; 2], 0.0);
        }
    }

    /// Moment of a contact about the point that it names, at the mean of the places at start and end of the step, N m.
    fn moment(&mut self, contact: usize) -> [f64; 3] {
        let (rows, force) = (&self.pairing.rows, &self.state.interface.force);
        let points = self.system.points_of(contact);
        let forces = points.map(|point| (rows, point, force[point]));
        let ends = [&self.start[0][..], &self.end[0]];
        let at = (&self.frames[..], &ends[..]);
        moment((&self.system, contact), forces, at, &mut self.nodal)
    }
}
