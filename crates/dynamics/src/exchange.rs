//! The momentum that contacts give to the bodies, told by the forces that they report.
//!
//! Between two bodies contact forces cancel in the momentum of the whole, so that its balance says nothing of their size.
//! Here each connected part is balanced by itself: what its momentum has changed by, less the impulses of loads, supports and
//! links, must be the impulse of the contacts on it as their records tell it,
//! [`Σ P dt + jumps + resizing - what is to come`](crate::records::ContactRecord::impulse_of_forces).

use std::ops::Range;

use carom_algebra::unknowns::Kind;
use serde::{Deserialize, Serialize};

use crate::records::ContactRecord;
use crate::step_map::Impulse;
use crate::sum::Sum;
use crate::system::System;

/// The exchange of momentum since the start.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Exchange {
    parts: Vec<Part>,
    /// Largest component of what is left over of a part's momentum so far, N s.
    pub largest_residual: f64,
    /// Largest component of the momentum of a part, or of the impulse of a contact, so far, N s.
    pub largest_momentum: f64,
}

/// One connected part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Part {
    /// Momentum at the start.
    start: [f64; 3],
    /// Impulses of loads, supports and links.
    own: [Sum; 3],
    /// R of loads, supports and links, and of supports against contact forces that have an impulse of their own.
    before: [[f64; 3]; 2],
    /// Impulse of the contacts until now, while it is gathered.
    #[serde(skip)]
    given: [f64; 3],
    /// Whether a contact that has several bodies on a side acts on it, of which the record tells the sum alone.
    #[serde(skip)]
    untold: bool,
}

/// Sum of the forces on the unknowns of a part; of an axisymmetric one only the axial sum is a force.
fn total(system: &System, part: &Range<usize>, force: &impl Fn(usize) -> f64) -> [f64; 3] {
    let mut total = [0.0; 3];
    for unknown in part.clone() {
        if let Kind::Translation(axis) = system.unknowns.kind(unknown) {
            total[axis] += force(unknown);
        }
    }
    axial(system, total)
}

/// Sum of a vector over the unknowns of a part.
pub(crate) fn sum(system: &System, part: &Range<usize>, forces: &[f64]) -> [f64; 3] {
    total(system, part, &|unknown| forces[unknown])
}

fn axial(system: &System, mut force: [f64; 3]) -> [f64; 3] {
    if system.axisymmetric {
        force[0] = 0.0;
    }
    force
}

fn largest(of: &[f64; 3]) -> f64 {
    of.iter().fold(0.0, |most, x| most.max(x.abs()))
}

impl Exchange {
    /// At the start. `momentum`: of each unknown; `forces`: of loads, supports and links, and of supports against contact forces.
    pub(crate) fn start(system: &System, momentum: &[f64], forces: [&[f64]; 2]) -> Exchange {
        let part = |part: &Range<usize>| Part {
            start: sum(system, part, momentum),
            before: forces.map(|forces| sum(system, part, forces)),
            ..Part::default()
        };
        let parts: Vec<Part> = system.parts.iter().map(part).collect();
        Exchange {
            largest_momentum: parts
                .iter()
                .map(|part| largest(&part.start))
                .fold(0.0, f64::max),
            parts,
            largest_residual: 0.0,
        }
    }

    /// Whether it is of this system at a step: it begins with the dynamics.
    pub(crate) fn is_of(&self, system: &System, step: u64) -> bool {
        let begins = step <= system.static_steps();
        self.parts.len() == system.parts.len() || begins && self.parts.is_empty()
    }

    /// Makes this the exchange of the state before the step.
    pub(crate) fn follow(&mut self, before: &Exchange) {
        self.parts.clone_from(&before.parts);
        self.largest_residual = before.largest_residual;
        self.largest_momentum = before.largest_momentum;
    }

    /// Adds the impulses of one kind of forces in a step of `dt`: 0 for loads, supports and links, 1 for supports against contact
    /// forces. `impulse`: how they change the momentum of the part with this unknown; `force`: of each unknown.
    pub(crate) fn add(
        &mut self,
        system: &System,
        kind: (usize, f64, impl Fn(usize) -> Impulse),
        force: impl Fn(usize) -> f64,
    ) {
        let sums = |part: usize| total(system, &system.parts[part], &force);
        self.add_sums(system, kind, sums);
    }

    /// The same from the sum of the forces on each part.
    pub(crate) fn add_sums(
        &mut self,
        system: &System,
        (kind, dt, impulse): (usize, f64, impl Fn(usize) -> Impulse),
        sums: impl Fn(usize) -> [f64; 3],
    ) {
        for (number, part) in self.parts.iter_mut().enumerate() {
            let impulse = impulse(system.parts[number].start);
            let total = axial(system, sums(number));
            for i in 0..3 {
                let before = part.before[kind][i];
                let now = impulse.gain * total[i] - impulse.carry * before;
                part.own[i].add(dt * (impulse.old * before + impulse.new * now));
                part.before[kind][i] = now;
            }
        }
    }

    /// Adds impulses of supports that act at once, one of each unknown.
    pub(crate) fn jump(&mut self, system: &System, impulses: &[f64]) {
        for (part, range) in self.parts.iter_mut().zip(&system.parts) {
            let jump = sum(system, range, impulses);
            for i in 0..3 {
                part.own[i].add(jump[i]);
            }
        }
    }

    /// Adds to the forces of loads, supports and links at the present instant.
    pub(crate) fn jump_force(&mut self, system: &System, force: impl Fn(usize) -> f64) {
        for (part, range) in self.parts.iter_mut().zip(&system.parts) {
            let jump = total(system, range, &force);
            for i in 0..3 {
                part.before[0][i] += jump[i];
            }
        }
    }

    /// Sets the forces of loads, supports and links that the next step begins with.
    pub(crate) fn renew(&mut self, system: &System, force: impl Fn(usize) -> f64) {
        for (part, range) in self.parts.iter_mut().zip(&system.parts) {
            part.before[0] = total(system, range, &force);
        }
    }

    /// Compares with the records of the contacts at the end of a step. `momenta`: of each part.
    pub(crate) fn close(
        &mut self,
        system: &System,
        momenta: impl Fn(usize) -> [f64; 3],
        records: &[ContactRecord],
    ) {
        for (number, record) in records.iter().enumerate() {
            let contact = &system.contacts[number];
            if system.is_of_many(number) {
                for &body in &contact.bodies {
                    self.parts[system.part_of_body[body]].untold = true;
                }
                continue;
            }
            let impulse = axial(system, record.exchanged());
            self.largest_momentum = self.largest_momentum.max(largest(&impulse));
            let of = |body: usize| system.part_of_body[body];
            let (one, other) = (of(contact.secondary_body), contact.primary_body.map(of));
            if Some(one) == other {
                continue;
            }
            for i in 0..3 {
                self.parts[one].given[i] += impulse[i];
                if let Some(other) = other {
                    self.parts[other].given[i] -= impulse[i];
                }
            }
        }
        for (number, part) in self.parts.iter_mut().enumerate() {
            let now = axial(system, momenta(number));
            let given = std::mem::take(&mut part.given);
            let left = [0, 1, 2].map(|i| now[i] - part.start[i] - part.own[i].get() - given[i]);
            if !part.untold {
                self.largest_residual = self.largest_residual.max(largest(&left));
            }
            self.largest_momentum = self.largest_momentum.max(largest(&now));
        }
    }

    /// Makes this the exchange of zones: the largest of theirs.
    pub fn gather<'a>(&mut self, zones: impl Iterator<Item = &'a Exchange>) {
        for zone in zones {
            self.largest_residual = self.largest_residual.max(zone.largest_residual);
            self.largest_momentum = self.largest_momentum.max(zone.largest_momentum);
        }
    }

    /// The largest residual over the largest momentum; `None` where nothing has moved.
    pub fn relative(&self) -> Option<f64> {
        (self.largest_momentum > 0.0).then(|| self.largest_residual / self.largest_momentum)
    }
}
