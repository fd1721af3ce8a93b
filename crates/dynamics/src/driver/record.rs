//! The records and the report of a step.

use std::sync::Arc;

use carom_contact::Rows;

use super::Driver;
use super::contacts::record::total;
use crate::contact_sums::ContactSums;
use crate::exchange::sum;
use crate::moment::moment;
use crate::records::Step;
use crate::report::ContactReport;
use crate::state::{InterfaceState, State};

impl Driver {
    /// Records of the contacts, and what they give to each part.
    pub(super) fn record(&mut self) {
        self.report_contacts();
        self.record_contacts();
        if !self.attempt.maps.is_static() {
            let system = Arc::clone(&self.attempt.system);
            let work = &mut self.attempt.vectors.work;
            system.mass.multiply(&self.attempt.next.motion.v, work);
            let records = &self.attempt.next.records.contacts;
            let momenta = |part: usize| sum(&system, &system.parts[part], work);
            self.attempt.next.exchange.close(&system, momenta, records);
            let bodies = self.parts.energy_of_bodies();
            self.balances
                .balance_assemblies(&self.contacts, &mut self.attempt, bodies);
        }
        self.look_at_the_end();
    }

    /// What the points of the contacts did in the step: those that this process has.
    pub(super) fn report_contacts(&mut self) {
        let mut all = self.contacts.take_sums();
        let mut nodal = self.contacts.take_nodal();
        all.clear();
        for k in 0..self.attempt.system.contacts.len() {
            let forces = &self.attempt.next.interface.force[self.attempt.system.points_of(k)];
            let mixed = self.contacts.mixed(k, forces);
            let mut of = self.of_contact(k, &mut nodal);
            of.report.mixed = mixed;
            all.push(of);
        }
        self.contacts.forget_passages();
        self.contacts.keep_sums(all);
        self.contacts.keep_nodal(nodal);
    }

    fn of_contact(&self, k: usize, nodal: &mut Vec<f64>) -> ContactSums {
        let (system, rows, projected) = (
            &*self.attempt.system,
            self.contacts.normal_rows(),
            self.stages.projected(),
        );
        // without inertia forces give no impulse, and closing is no impact
        let dt = if self.attempt.maps.is_static() {
            0.0
        } else {
            self.attempt.dt
        };
        let impulse = self.attempt.contact_impulse(k);
        let (old, new) = (&self.attempt.state.interface, &self.attempt.next.interface);
        let points = || self.contacts.active().within(system.points_of(k));
        let mut report = contact_report(
            (points(), system.contacts[k].tolerance),
            rows,
            [old, new],
            self.attempt.dt,
        );
        self.contacts.report_friction(&self.attempt, k, &mut report);
        report.moment = self.moment_of(k, nodal);
        report.friction_loss = -self.contacts.friction_work_of(
            &self.attempt,
            k,
            self.attempt.weights_as_told([impulse.old, impulse.new]),
        );
        // between stages forces are carried on as sums, and no projection changes them
        let staged = self.attempt.stage.is_one_of_several() && !self.attempt.maps.is_static();
        let change = |of: &InterfaceState, point: usize| match staged {
            true => 0.0,
            false => of.carried[point] - of.force[point],
        };
        let carried_on =
            |point: usize| projected.impulse(point) + dt * impulse.old * change(old, point);
        report.impulsive = points().map(carried_on).sum();
        let changed = |point: usize| change(new, point);
        let contact = &system.contacts[k];
        let crush = |point: usize| {
            let share = contact.points[point - system.contacts[k].range.start].share;
            let energy = |crush: f64| share * contact.law.crush_energy(crush);
            match new.crush[point] == old.crush[point] {
                true => 0.0,
                false => energy(new.crush[point]) - energy(old.crush[point]),
            }
        };
        let passed = self.contacts.passed(&self.attempt, k);
        ContactSums {
            near: passed > 0 || points().next().is_some(),
            motion: f64::INFINITY,
            work: self.contacts.contact_work(&self.attempt, k)
                + points().map(|p| projected.work(p)).sum::<f64>(),
            crushed: points().map(crush).sum(),
            pushed: self.contacts.pushed(&self.attempt, k),
            passing: self.contacts.passing(&self.attempt, k),
            passed,
            jump: [
                total(points(), rows, |point| projected.impulse(point)),
                total(points(), rows, changed),
            ],
            report,
        }
    }

    /// Records of the contacts, from what was reported of them.
    pub(super) fn record_contacts(&mut self) {
        let system = Arc::clone(&self.attempt.system);
        self.attempt
            .next
            .records
            .follow(&self.attempt.state.records);
        self.attempt.next.time = self.attempt.state.time + self.attempt.dt;
        let dt = if self.attempt.maps.is_static() {
            0.0
        } else {
            self.attempt.dt
        };
        let span = [self.attempt.state.time, self.attempt.next.time];
        for (k, of) in self.contacts.sums().iter().enumerate() {
            let impulse = self.attempt.contact_impulse(k);
            let durations = self.attempt.durations(k);
            let State {
                motion,
                records,
                interface,
                ..
            } = &mut self.attempt.next;
            let step = Step {
                span,
                dt,
                durations,
                impulse,
                forces: [&self.attempt.state.interface.force, &interface.force],
                report: &of.report,
                work: of.work,
                crushed: of.crushed,
                jump: of.jump,
            };
            let velocities = [&self.attempt.state.motion.v[..], &motion.v];
            let points = self.contacts.active().within(system.points_of(k));
            records.add((&system, k), (&step, points), velocities);
            records.contacts[k].passing = of.passing;
            records.contacts[k].passed += of.passed;
            records.contacts[k].pushed = of.pushed;
            self.report.contacts[k].clone_from(&of.report);
        }
    }

    /// Looks at the end of the step, whose energies are known; ranks look once the step is taken, together.
    pub(super) fn look_at_the_end(&mut self) {
        if !self.is_shared() {
            let (system, step) = (
                Arc::clone(&self.attempt.system),
                self.attempt.state.step + 1,
            );
            self.watch.look_alone(&system, step, &mut self.attempt.next);
        }
    }

    /// Moment of a contact in the step, about the point that it names, N m; zero where it names none.
    fn moment_of(&self, contact: usize, nodal: &mut Vec<f64>) -> [f64; 3] {
        let (old, new) = (&self.attempt.state.motion, &self.attempt.next.motion);
        let at = (&old.frames[..], &[&old.u[..], &new.u[..]][..]);
        let forces = self.forces_of(contact, &self.attempt.next.interface);
        moment((&self.attempt.system, contact), forces, at, nodal)
    }

    /// Rows, points and forces of a contact along them, normals and tangents, N.
    fn forces_of<'a>(
        &'a self,
        contact: usize,
        interface: &'a InterfaceState,
    ) -> impl Iterator<Item = (&'a Rows, usize, f64)> {
        let points = self
            .contacts
            .active()
            .within(self.attempt.system.points_of(contact));
        let tangents = self.contacts.tangent_rows(&self.attempt);
        points.flat_map(move |point| {
            let normal = (self.contacts.normal_rows(), point, interface.force[point]);
            let friction = interface.friction.get(point);
            let friction = tangents.iter().zip(friction.into_iter().flatten());
            let friction = friction.map(move |(rows, t)| (rows, point, *t));
            std::iter::once(normal).chain(friction)
        })
    }

    /// Completes the report of the state just accepted. `dt`: the whole step, s.
    pub(super) fn tell(&mut self, dt: f64) {
        let state = &self.attempt.state;
        self.report.step = state.step;
        self.report.time = state.time;
        self.report.dt = dt;
        self.report.balance = state.ledger.balance;
        if state.step > 0 {
            self.report.supports.clear();
            let reactions = self.balances.reactions();
            self.report.supports.extend_from_slice(reactions);
        }
        self.report.passes = match self.attempt.system.is_nonlinear() {
            true => self.parts.residuals().len(),
            false if self.contacts.candidates().is_empty() && !self.is_shared() => 0,
            false => self.contacts.passes(),
        };
        if state.step == 0 {
            let mut nodal = self.contacts.take_nodal();
            for (k, report) in self.report.contacts.iter_mut().enumerate() {
                let (rows, interface) = (self.contacts.normal_rows(), &state.interface);
                let points = self.attempt.system.points_of(k);
                let tolerance = self.attempt.system.contacts[k].tolerance;
                *report = contact_report((points.clone(), tolerance), rows, [interface; 2], 0.0);
                let forces = points.map(|point| (rows, point, interface.force[point]));
                let at = (&state.motion.frames[..], &[&state.motion.u[..]][..]);
                report.moment = moment((&self.attempt.system, k), forces, at, &mut nodal);
            }
            self.contacts.keep_nodal(nodal);
        }
    }
}

/// What a contact did in a step of `dt` (s): its points, those left out being open before and after it. `tolerance`: m, up to which a gap is the least
/// one.
pub fn contact_report(
    (points, tolerance): (impl Iterator<Item = usize> + Clone, f64),
    rows: &Rows,
    [old, new]: [&InterfaceState; 2],
    dt: f64,
) -> ContactReport {
    let gaps = points.clone().map(|point| new.gap[point]);
    let mut report = ContactReport {
        gap: gaps.fold(f64::INFINITY, f64::min),
        ..ContactReport::default()
    };
    let least = (points.clone()).filter(|&point| new.gap[point] <= report.gap + tolerance);
    if report.gap.is_finite() {
        let rates = least.map(|point| new.rate[point]);
        report.rate = rates.fold(f64::NEG_INFINITY, f64::max);
    }
    for point in points {
        let force = new.force[point];
        report.force += force;
        for (sum, n) in report.resultant.iter_mut().zip(rows.resultant(point)) {
            *sum += force * n;
        }
        report.closed += usize::from(force != 0.0);
        report.status_changes += usize::from((force != 0.0) != (old.force[point] != 0.0));
        report.persistency_defect += (force * (new.rate[point] + new.opening[point])).abs() * dt;
    }
    report.normal = report.resultant;
    report
}
