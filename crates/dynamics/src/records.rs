//! Extrema, impulses and impacts, gathered at every step whatever is written.

use serde::{Deserialize, Serialize};

use crate::ledger::Sum;
use crate::small::Smallness;
use crate::state::{ContactReport, State};
use crate::step_map::Impulse;
use crate::system::System;

/// Records of all contacts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Records {
    /// By contact.
    pub contacts: Vec<ContactRecord>,
    /// Impacts that have ended, in the order of their end.
    pub impacts: Vec<Impact>,
    /// Whether what is assumed small has stayed small.
    pub small: Smallness,
}

/// Record of one contact.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactRecord {
    /// Largest total force so far, N.
    pub peak_force: f64,
    /// End of the step of the largest force, s.
    pub peak_time: f64,
    /// Start of the first step with a force, s.
    pub first_closing: Option<f64>,
    /// End of the last step with a force, s.
    pub last_force: Option<f64>,
    /// How often a point's force began or ended.
    pub status_changes: u64,
    /// Largest penetration at the end of a step, m.
    pub penetration: f64,
    /// Energy lost in crush so far, J: what it took to crush the points, less what they can give back.
    pub energy_crushed: f64,
    /// Most nodes at the end of a step whose supports are partly closed; see [`ContactReport::mixed`].
    pub mixed: u64,
    /// Total force and force on the secondary body in the last step as they enter impulses, N.
    last: (f64, [f64; 3]),
    /// The impact going on.
    open: Option<OpenImpact>,
    impulse: Sum,
    defect: Sum,
}

impl ContactRecord {
    /// Impulse of the total normal force, N s.
    pub fn impulse(&self) -> f64 {
        self.impulse.get()
    }

    /// Σ |P ġ₊| dt, J.
    pub fn persistency_defect(&self) -> f64 {
        self.defect.get()
    }
}

/// One impact: an interval of steps with a force in a contact.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Impact {
    /// Index of the contact.
    pub contact: u32,
    /// Start of its first step, s.
    pub start: f64,
    /// Duration, s.
    pub duration: f64,
    /// Largest total force, N.
    pub peak_force: f64,
    /// Impulse on the secondary body, N s.
    pub impulse: f64,
    /// Speed at which the mean motions of the two bodies (one, on an obstacle) approached along the impulse, m/s.
    pub approach: f64,
    /// Speed at which they part, m/s; negative if they still approach.
    pub rebound: f64,
    /// Kinetic energy of the approach, ½ m w² with the reduced mass m of the two bodies, J.
    pub energy_given: f64,
    /// Energy lost in the contact, J: minus the work of its forces.
    pub energy_lost: f64,
    /// The part of it that is lost in crush, J; zero of laws without memory.
    pub energy_crushed: f64,
    /// Whether the run ended before the impact did.
    pub unfinished: bool,
}

impl Impact {
    /// Rebound over approach.
    pub fn restitution(&self) -> f64 {
        self.rebound / self.approach
    }
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct OpenImpact {
    start: f64,
    peak_force: f64,
    impulse: [Sum; 3],
    work: Sum,
    velocity: [f64; 3],
    crushed: Sum,
}

/// What a step adds to the record of a contact.
pub(crate) struct Step<'a> {
    /// Time at its start and end, s.
    pub(crate) span: [f64; 2],
    /// How forces make impulses in the scheme.
    pub(crate) impulse: Impulse,
    /// What the contact did.
    pub(crate) report: &'a ContactReport,
    /// Work of the contact's forces and impulses, J.
    pub(crate) work: f64,
    /// Energy lost in crush until its end, J.
    pub(crate) crushed: f64,
    /// Of a projection after the step: impulse in N s, and change of the force that the next step begins with in N; each
    /// as a sum over the points and as a vector on the secondary body.
    pub(crate) jump: [(f64, [f64; 3]); 2],
}

impl Records {
    /// Nothing yet.
    pub(crate) fn of(system: &System) -> Records {
        Records {
            contacts: vec![ContactRecord::default(); system.contacts.len()],
            impacts: Vec::new(),
            small: Smallness::of(system),
        }
    }

    /// Makes these the records of the state before the step, of which they are those of one step earlier or of an
    /// attempt given up: the impacts of both begin alike, and only the last are copied.
    pub(crate) fn follow(&mut self, before: &Records) {
        self.contacts.clone_from(&before.contacts);
        self.small.follow(&before.small);
        self.impacts.truncate(before.impacts.len());
        self.impacts
            .extend_from_slice(&before.impacts[self.impacts.len()..]);
    }

    /// Adds a step of one contact. `old`, `new`: the states around it.
    pub(crate) fn add(
        &mut self,
        system: &System,
        contact: usize,
        step: &Step,
        old: &State,
        new_velocity: &[f64],
    ) {
        let (report, dt) = (step.report, step.span[1] - step.span[0]);
        let record = &mut self.contacts[contact];
        let impulse = step.impulse;
        let mean = |before: f64, now: f64| dt * (impulse.old * before + impulse.new * now);
        let taken = |force: f64, before: f64| impulse.gain * force - impulse.carry * before;
        let before = record.last;
        let force = taken(report.force, before.0);
        let resultant = [0, 1, 2].map(|i| taken(report.resultant[i], before.1[i]));
        let [projected, change] = step.jump;
        record.last = (
            force + change.0,
            [0, 1, 2].map(|i| resultant[i] + change.1[i]),
        );
        record.impulse.add(mean(before.0, force));
        record.impulse.add(projected.0);
        record.defect.add(report.persistency_defect);
        record.status_changes += report.status_changes as u64;
        record.mixed = record.mixed.max(report.mixed as u64);
        if report.gap.is_finite() {
            record.penetration = record.penetration.max(-report.gap);
        }
        if report.force > record.peak_force {
            (record.peak_force, record.peak_time) = (report.force, step.span[1]);
        }
        let crushed = step.crushed - record.energy_crushed;
        record.energy_crushed = step.crushed;
        let active = report.closed > 0;
        if active {
            record.first_closing.get_or_insert(step.span[0]);
            record.last_force = Some(step.span[1]);
            record.open.get_or_insert_with(|| OpenImpact {
                start: step.span[0],
                velocity: approach_velocity(system, contact, &old.motion.v),
                ..OpenImpact::default()
            });
        }
        if let Some(open) = &mut record.open {
            open.peak_force = open.peak_force.max(report.force);
            open.work.add(step.work);
            open.crushed.add(crushed);
            for i in 0..3 {
                open.impulse[i].add(mean(before.1[i], resultant[i]));
                open.impulse[i].add(projected.1[i]);
            }
            if !active {
                let impact = open.finished(system, contact, step.span[1], new_velocity);
                self.impacts.push(impact);
                self.contacts[contact].open = None;
            }
        }
    }

    /// All impacts, those that still go on at the end of the run included.
    pub fn all_impacts(&self, system: &System, state: &State) -> Vec<Impact> {
        let open = self
            .contacts
            .iter()
            .enumerate()
            .filter_map(|(contact, record)| {
                let open = record.open.as_ref()?;
                Some(Impact {
                    unfinished: true,
                    ..open.finished(system, contact, state.time, &state.motion.v)
                })
            });
        self.impacts.iter().cloned().chain(open).collect()
    }
}

impl OpenImpact {
    fn finished(&self, system: &System, contact: usize, end: f64, v: &[f64]) -> Impact {
        let impulse = self.impulse.map(|sum| sum.get());
        let size = impulse.iter().map(|i| i * i).sum::<f64>().sqrt();
        let after = approach_velocity(system, contact, v);
        // along the force on the secondary body, which parts the two
        let along = |w: [f64; 3]| match size > 0.0 {
            true => (0..3).map(|i| w[i] * impulse[i]).sum::<f64>() / size,
            false => 0.0,
        };
        let approach = -along(self.velocity);
        let (secondary, primary) = system.sides[contact];
        let inverse = 1.0 / system.body_mass(secondary)
            + primary.map_or(0.0, |body| 1.0 / system.body_mass(body));
        Impact {
            contact: contact as u32,
            start: self.start,
            duration: end - self.start,
            peak_force: self.peak_force,
            impulse: size,
            approach,
            rebound: along(after),
            energy_given: 0.5 * approach * approach / inverse,
            energy_lost: -self.work.get(),
            energy_crushed: self.crushed.get(),
            unfinished: false,
        }
    }
}

/// Mean velocity of the secondary body less that of the primary one, m/s.
fn approach_velocity(system: &System, contact: usize, v: &[f64]) -> [f64; 3] {
    let (secondary, primary) = system.sides[contact];
    let mut relative = system.mean_velocity(secondary, v);
    if let Some(primary) = primary {
        let other = system.mean_velocity(primary, v);
        relative = [0, 1, 2].map(|i| relative[i] - other[i]);
    }
    relative
}
