//! The balance of a step, the records of its contacts, and its report.

use std::sync::Arc;

use carom_algebra::reduce::dot;
use carom_contact::Rows;

use super::{Driver, Vectors};
use crate::error::Error;
use crate::ledger::{Energies, Resultant, Squares, reactions};
use crate::records::Step;
use crate::state::{ContactReport, InterfaceState, Motion, State};
use crate::step_map::Impulse;
use crate::system::System;

impl Driver {
    /// Energy and momentum of the step, then the records of the contacts.
    pub(super) fn balance(&mut self, strain: f64) {
        let system = Arc::clone(&self.system);
        let identity = self.identity.unwrap_or_default();
        let [before, now] = self.work_weights();
        let (old, new) = (&self.state.motion, &self.next.motion);
        let Vectors {
            x,
            known,
            work,
            inertia,
            contact_acceleration,
            ..
        } = &mut self.vectors;
        let energies = energies(&system, new, strain, work, identity.inertia != 0.0);
        let mut squares = Squares::default();
        if identity.velocity != 0.0 {
            squares.velocity = change_squared(&system, &old.v, &new.v, known, work);
        }
        if identity.acceleration != 0.0 {
            squares.acceleration = change_squared(&system, &old.a, &new.a, known, work);
        }
        self.map.inertia.whole(old, x, contact_acceleration, known);
        system.mass.multiply(known, inertia);
        reactions(&system, &self.map, old, new, inertia, work);
        let supports = Resultant::of(&system, work);
        let contact = Resultant::of(&system, &new.contact_force);
        let loads = Resultant::of(&system, &system.load);
        for i in 0..known.len() {
            known[i] = new.u[i] - old.u[i];
        }
        if identity.displacement != 0.0 {
            // K is linear and symmetric: |Δu|²_K = Δu · Δf
            squares.displacement =
                dot(known, &new.internal_force) - dot(known, &old.internal_force);
        }
        let work_contact =
            before * dot(known, &old.contact_force) + now * dot(known, &new.contact_force);
        let work_loads = dot(known, &system.load);
        self.next.ledger.clone_from(&self.state.ledger);
        self.next.ledger.add(
            (
                system.dt,
                &identity,
                [&self.map.impulse, &self.map.contact_impulse],
            ),
            &energies,
            [work_loads, work_contact],
            &squares,
            [loads, contact, supports],
        );
        self.record();
    }

    /// Weights of the forces at the start and of the step in the work on Δu: those of the energy identity, or of the
    /// impulse where there is none.
    fn work_weights(&self) -> [f64; 2] {
        let Impulse { old, new, .. } = self.map.contact_impulse;
        self.identity
            .map_or([old, new], |identity| [identity.old, identity.new])
    }

    pub(super) fn record(&mut self) {
        let system = Arc::clone(&self.system);
        self.next.records.follow(&self.state.records);
        for k in 0..system.contacts.len() {
            let report = contact_report(
                &system,
                k,
                &self.rows,
                &self.state.interface,
                &self.next.interface,
            );
            let weights = self.work_weights();
            let step = Step {
                span: [self.state.time, self.next.time],
                impulse: self.map.contact_impulse,
                report: &report,
                work: contact_work(&system, k, &self.rows, weights, (&self.state, &self.next)),
            };
            let State {
                motion, records, ..
            } = &mut self.next;
            records.add(&system, k, &step, &self.state, &motion.v);
            self.report.contacts[k] = report;
        }
    }

    pub(super) fn finite(&self) -> Result<(), Error> {
        let motion = &self.next.motion;
        let bad = [
            ("displacement", &motion.u),
            ("velocity", &motion.v),
            ("contact force", &motion.contact_force),
        ]
        .into_iter()
        .find(|(_, vector)| !vector.iter().sum::<f64>().is_finite());
        match bad {
            None => Ok(()),
            Some((quantity, _)) => Err(Error::NotFinite {
                step: self.next.step,
                time: self.next.time,
                quantity,
            }),
        }
    }

    /// Completes the report of the state just accepted.
    pub(super) fn tell(&mut self) {
        let state = &self.state;
        self.report.step = state.step;
        self.report.time = state.time;
        self.report.balance = state.ledger.balance;
        self.report.passes = if self.candidates.is_empty() {
            0
        } else {
            self.interface.passes
        };
        if state.step == 0 {
            for (k, report) in self.report.contacts.iter_mut().enumerate() {
                *report = contact_report(
                    &self.system,
                    k,
                    &self.rows,
                    &state.interface,
                    &state.interface,
                );
            }
        }
    }
}

pub(super) fn energies(
    system: &System,
    motion: &Motion,
    strain: f64,
    work: &mut [f64],
    with_acceleration: bool,
) -> Energies {
    system.mass.multiply(&motion.v, work);
    let (kinetic, momentum) = (0.5 * dot(&motion.v, work), Resultant::of(system, work));
    let mut acceleration = 0.0;
    if with_acceleration {
        system.mass.multiply(&motion.a, work);
        acceleration = dot(&motion.a, work);
    }
    Energies {
        kinetic,
        strain,
        acceleration,
        momentum,
    }
}

/// |new - old|²_M.
fn change_squared(
    system: &System,
    old: &[f64],
    new: &[f64],
    change: &mut [f64],
    work: &mut [f64],
) -> f64 {
    for i in 0..change.len() {
        change[i] = new[i] - old[i];
    }
    system.mass.multiply(change, work);
    dot(change, work)
}

fn contact_report(
    system: &System,
    contact: usize,
    rows: &Rows,
    old: &InterfaceState,
    new: &InterfaceState,
) -> ContactReport {
    let mut report = ContactReport {
        gap: f64::INFINITY,
        ..ContactReport::default()
    };
    for point in system.first_point[contact]..system.first_point[contact + 1] {
        let force = new.force[point];
        report.force += force;
        for (sum, n) in report.resultant.iter_mut().zip(rows.normal(point)) {
            *sum += force * n;
        }
        if new.gap[point] < report.gap {
            (report.gap, report.rate) = (new.gap[point], new.rate[point]);
        }
        report.closed += usize::from(force != 0.0);
        report.status_changes += usize::from((force != 0.0) != (old.force[point] != 0.0));
        report.persistency_defect += (force * new.rate[point]).abs() * system.dt;
    }
    report
}

/// Work of the forces of one contact on the motion of the step, J. `states`: at its start and end.
fn contact_work(
    system: &System,
    contact: usize,
    rows: &Rows,
    weights: [f64; 2],
    (old, new): (&State, &State),
) -> f64 {
    let points = system.first_point[contact]..system.first_point[contact + 1];
    points
        .map(|point| {
            let force =
                weights[0] * old.interface.force[point] + weights[1] * new.interface.force[point];
            force * (rows.product(point, &new.motion.u) - rows.product(point, &old.motion.u))
        })
        .sum()
}
