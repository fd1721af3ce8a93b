//! The balance of a step, the records of its contacts, and its report.

use std::ops::Range;
use std::sync::Arc;

use carom_algebra::reduce::dot;
use carom_contact::Rows;

use super::{Driver, Forces, Vectors};
use crate::ledger::{Energies, Squares, reactions};
use crate::records::Step;
use crate::resultant::Resultant;
use crate::scheme::EnergyIdentity;
use crate::state::{ContactReport, InterfaceState, Motion, State};
use crate::step_map::Impulse;
use crate::system::System;

impl Driver {
    /// Energy and momentum of the step.
    pub(super) fn balance(&mut self, strain: f64) {
        let system = Arc::clone(&self.system);
        let identity = self.identity.unwrap_or_default();
        let new = &self.next.motion;
        let lagged = lagged(
            &system,
            &identity,
            (new, strain),
            &mut self.vectors,
            &mut self.forces,
        );
        let memory = remembered(
            &system,
            &identity,
            &new.memory,
            &mut self.vectors,
            &mut self.forces,
        );
        let filtered = self.filtered(&identity);
        let new = &self.next.motion;
        let work = &mut self.vectors.work;
        let energies = Energies {
            memory,
            lagged,
            ..energies(&system, new, strain, work, identity.inertia != 0.0)
        };
        let [supports, held] = self.reactions();
        let (old, new) = (&self.state.motion, &self.next.motion);
        let contact = Resultant::of(&system, &new.contact_force);
        let loads = Resultant::of(&system, &system.load);
        let weights = self.work_weights();
        let stage = self.predictor_loss();
        let Vectors {
            residual: travel,
            known,
            work,
            ..
        } = &mut self.vectors;
        let squares = Squares {
            stage,
            filtered,
            ..squares(&system, &identity, (old, new), (travel, known, work))
        };
        if identity.lag != 0.0 {
            for i in 0..travel.len() {
                travel[i] -= identity.lag * (new.v[i] - old.v[i]);
            }
        }
        let work_contact = weights.old * dot(travel, &old.contact_force)
            + weights.new * dot(travel, &new.contact_force);
        let work_loads = dot(travel, &system.load);
        let work_links = match new.link_force.is_empty() {
            true => 0.0,
            false => {
                let weights = &self.map.impulse;
                weights.old * dot(travel, &old.link_force)
                    + weights.new * dot(travel, &new.link_force)
            }
        };
        let links = Resultant::of(&system, &new.link_force);
        self.next.ledger.clone_from(&self.state.ledger);
        if self.dt != self.state.control.taken {
            self.resize_energy();
        }
        self.next.ledger.add(
            (
                self.dt,
                &identity,
                [&self.map.impulse, &self.map.contact_impulse],
            ),
            &energies,
            [work_loads, work_contact, work_links],
            &squares,
            [loads, contact, supports, held, links],
        );
    }

    /// Counts what the energy that the scheme balances gains by the new size of the step alone.
    fn resize_energy(&mut self) {
        let system = Arc::clone(&self.system);
        let identity = self.identity.unwrap_or_default();
        let strain = self.state.ledger.balance.strain;
        let old = &self.state.motion;
        let (vectors, forces) = (&mut self.vectors, &mut self.forces);
        let lagged = lagged(&system, &identity, (old, strain), vectors, forces);
        let memory = remembered(&system, &identity, &old.memory, vectors, forces);
        let work = &mut vectors.work;
        let energies = Energies {
            lagged,
            memory,
            ..energies(&system, old, strain, work, identity.inertia != 0.0)
        };
        self.next.ledger.resize(&identity, &energies);
    }

    /// |Δm|²_K of the step, as far as the identity asks for it.
    fn filtered(&mut self, identity: &EnergyIdentity) -> f64 {
        if identity.filtered == 0.0 {
            return 0.0;
        }
        let Vectors { known, work, .. } = &mut self.vectors;
        let [old, new] = [&self.state, &self.next].map(|state| &state.motion.memory);
        difference(old, new, known);
        2.0 * self.forces.evaluate(&self.system, known, work)
    }

    /// Resultants of the forces of the supports in the step; apart, those against contact forces that act in the
    /// impulse in their own way.
    fn reactions(&mut self) -> [Resultant; 2] {
        let system = &*self.system;
        let (old, new) = (&self.state.motion, &self.next.motion);
        let Vectors {
            half,
            x,
            known,
            work,
            inertia,
            contact_acceleration: c,
            ..
        } = &mut self.vectors;
        if self.map.force_fraction.is_none() {
            self.map.force.whole(old, x, c, known);
            self.forces.evaluate(system, known, work);
        }
        self.map.inertia.whole(old, x, c, known);
        system.mass.multiply(known, inertia);
        reactions(system, &self.map, old, new, inertia, work);
        let exchange = &mut self.next.exchange;
        exchange.follow(&self.state.exchange);
        let own = |i: usize| work[i] + system.load[i] + new.link_of(i);
        exchange.add(system, (0, self.dt, &self.map.impulse), own);
        let supports = Resultant::of(system, work);
        if self.map.impulse == self.map.contact_impulse {
            return [supports, Resultant::default()];
        }
        for (i, held) in half.iter_mut().enumerate() {
            *held = match system.fixed[i] {
                true => -new.contact_force[i],
                false => 0.0,
            };
        }
        exchange.add(system, (1, self.dt, &self.map.contact_impulse), |i| half[i]);
        [supports, Resultant::of(system, half)]
    }

    /// Weights of the contact forces at the start and of the step in their work: those of the energy identity, or of the
    /// impulse where there is none.
    fn work_weights(&self) -> WorkWeights {
        let Impulse { old, new, .. } = self.map.contact_impulse;
        let of_impulse = WorkWeights { old, new, lag: 0.0 };
        self.identity.map_or(of_impulse, |identity| WorkWeights {
            old: identity.old,
            new: identity.new,
            lag: identity.lag,
        })
    }

    /// Records of the contacts.
    pub(super) fn record(&mut self) {
        let system = Arc::clone(&self.system);
        self.next.records.follow(&self.state.records);
        for k in 0..system.contacts.len() {
            let mut report = contact_report(
                &system,
                k,
                &self.rows,
                &self.state.interface,
                &self.next.interface,
                self.dt,
            );
            let forces = &self.next.interface.force[points(&system, k)];
            report.mixed = self.weak.mixed(k, forces);
            let weights = self.work_weights();
            let before = &self.state.interface;
            let projected = &self.projected;
            let carried_on = |point: usize| {
                let changed = before.carried[point] - before.force[point];
                projected.impulse(point) + self.dt * self.map.contact_impulse.old * changed
            };
            report.impulsive = points(&system, k).map(carried_on).sum();
            let work = contact_work(&system, k, &self.rows, weights, (&self.state, &self.next));
            let time = self.next.time;
            let State {
                motion,
                records,
                interface,
                ..
            } = &mut self.next;
            let step = Step {
                span: [self.state.time, time],
                dt: self.dt,
                impulse: self.map.contact_impulse,
                forces: [&before.force, &interface.force],
                report: &report,
                work: work + points(&system, k).map(|p| projected.work(p)).sum::<f64>(),
                crushed: crush_energy(&system, k, interface),
                jump: [
                    total(&system, k, &self.rows, |point| projected.impulse(point)),
                    total(&system, k, &self.rows, |point| {
                        interface.carried[point] - interface.force[point]
                    }),
                ],
            };
            records.add(&system, k, &step, &self.state, &motion.v);
            self.report.contacts[k] = report;
        }
        self.watch.look(&system, self.next.step, &mut self.next);
        let work = &mut self.vectors.work;
        system.mass.multiply(&self.next.motion.v, work);
        let records = &self.next.records.contacts;
        self.next.exchange.close(&system, work, records);
    }

    /// Completes the report of the state just accepted.
    pub(super) fn tell(&mut self) {
        let state = &self.state;
        self.report.step = state.step;
        self.report.time = state.time;
        self.report.dt = if state.step == 0 { 0.0 } else { self.dt };
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
                    0.0,
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
        memory: 0.0,
        lagged: 0.0,
        momentum,
    }
}

/// U(u - lag v) - U(u), J.
pub(super) fn lagged(
    system: &System,
    identity: &EnergyIdentity,
    (motion, strain): (&Motion, f64),
    Vectors { known, work, .. }: &mut Vectors,
    forces: &mut Forces,
) -> f64 {
    if identity.lag == 0.0 {
        return 0.0;
    }
    for i in 0..known.len() {
        known[i] = motion.u[i] - identity.lag * motion.v[i];
    }
    forces.evaluate(system, known, work) - strain
}

/// |m|²_K of a memory m, J/s².
pub(super) fn remembered(
    system: &System,
    identity: &EnergyIdentity,
    memory: &[f64],
    Vectors { work, .. }: &mut Vectors,
    forces: &mut Forces,
) -> f64 {
    match identity.memory == 0.0 {
        true => 0.0,
        // U is quadratic
        false => 2.0 * forces.evaluate(system, memory, work),
    }
}

/// What changed from the old to the new motion, as far as the identity asks for it. Leaves Δu in `travel`.
fn squares(
    system: &System,
    identity: &EnergyIdentity,
    (old, new): (&Motion, &Motion),
    (travel, change, work): (&mut [f64], &mut [f64], &mut [f64]),
) -> Squares {
    let mut squares = Squares::default();
    difference(&old.u, &new.u, travel);
    if identity.velocity != 0.0 {
        difference(&old.v, &new.v, change);
        system.mass.multiply(change, work);
        squares.velocity = dot(change, work);
    }
    if identity.acceleration != 0.0 || identity.mixed != 0.0 {
        difference(&old.a, &new.a, change);
        system.mass.multiply(change, work);
        squares.acceleration = dot(change, work);
        squares.mixed = dot(travel, work);
    }
    if identity.contact != 0.0 {
        difference(&old.a, &new.a, change);
        squares.contact = dot(change, &new.contact_force);
    }
    if identity.displacement != 0.0 {
        // K is linear and symmetric: |Δu|²_K = Δu · Δf
        squares.displacement = dot(travel, &new.internal_force) - dot(travel, &old.internal_force);
    }
    squares
}

/// new - old.
fn difference(old: &[f64], new: &[f64], change: &mut [f64]) {
    for i in 0..change.len() {
        change[i] = new[i] - old[i];
    }
}

pub(crate) fn contact_report(
    system: &System,
    contact: usize,
    rows: &Rows,
    old: &InterfaceState,
    new: &InterfaceState,
    dt: f64,
) -> ContactReport {
    let mut report = ContactReport {
        gap: f64::INFINITY,
        ..ContactReport::default()
    };
    for point in points(system, contact) {
        let force = new.force[point];
        report.force += force;
        for (sum, n) in report.resultant.iter_mut().zip(rows.resultant(point)) {
            *sum += force * n;
        }
        if new.gap[point] < report.gap {
            (report.gap, report.rate) = (new.gap[point], new.rate[point]);
        }
        report.closed += usize::from(force != 0.0);
        report.status_changes += usize::from((force != 0.0) != (old.force[point] != 0.0));
        report.persistency_defect += (force * (new.rate[point] + new.opening[point])).abs() * dt;
    }
    report.normal = report.resultant;
    report
}

/// How contact forces work in the energy balance.
#[derive(Clone, Copy)]
struct WorkWeights {
    /// Weight of the forces at the start.
    old: f64,
    /// Weight of the forces of the step.
    new: f64,
    /// How far the displacements on which they work lie back along the velocity, s.
    lag: f64,
}

/// Work of the forces of one contact on the motion of the step, J. `states`: at its start and end.
fn contact_work(
    system: &System,
    contact: usize,
    rows: &Rows,
    weights: WorkWeights,
    (old, new): (&State, &State),
) -> f64 {
    let place = |point: usize, motion: &Motion| {
        let u = rows.product(point, &motion.u);
        match weights.lag == 0.0 {
            true => u,
            false => u - weights.lag * rows.product(point, &motion.v),
        }
    };
    points(system, contact)
        .map(|point| {
            let force = weights.old * old.interface.carried[point]
                + weights.new * new.interface.force[point];
            force * (place(point, &new.motion) - place(point, &old.motion))
        })
        .sum()
}

/// Energy that the crush of one contact has taken so far, J: a function of the largest penetrations.
pub(crate) fn crush_energy(system: &System, contact: usize, interface: &InterfaceState) -> f64 {
    let (first, contact) = (system.first_point[contact], &system.contacts[contact]);
    let of_point = |(k, point): (usize, &carom_contact::Point)| {
        point.share * contact.law.crush_energy(interface.crush[first + k])
    };
    contact.points.iter().enumerate().map(of_point).sum()
}

/// Contact points of a contact.
fn points(system: &System, contact: usize) -> Range<usize> {
    system.first_point[contact]..system.first_point[contact + 1]
}

/// Sum of a normal force or impulse over the points of a contact, and its resultant on the secondary body.
fn total(
    system: &System,
    contact: usize,
    rows: &Rows,
    of_point: impl Fn(usize) -> f64,
) -> (f64, [f64; 3]) {
    let (mut sum, mut resultant) = (0.0, [0.0; 3]);
    for point in points(system, contact) {
        let value = of_point(point);
        sum += value;
        for (sum, n) in resultant.iter_mut().zip(rows.resultant(point)) {
            *sum += value * n;
        }
    }
    (sum, resultant)
}
