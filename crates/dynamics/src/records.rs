//! Extrema, impulses and impacts, gathered at every step whatever is written.

use serde::{Deserialize, Serialize};

use crate::impact::{Given, Impact, OpenImpact};
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
    /// Impacts after which a flight has lasted, in the order of their end; see [`Records::ended`].
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
    /// The impact going on, or whose flight does not last yet.
    open: Option<OpenImpact>,
    impulse: Sum,
    defect: Sum,
    forces: Sum,
    jumps: Sum,
    resizing: Sum,
    /// The sum of these three as a vector on the secondary body.
    exchanged: [Sum; 3],
    /// What `last` gives after the step, over itself, s.
    later: f64,
}

impl ContactRecord {
    /// Impulse of the total normal force, N s: what the contact has given to the momentum of the bodies so far.
    pub fn impulse(&self) -> f64 {
        self.impulse.get()
    }

    /// Σ P dt, the total forces reported times the lengths of their steps, N s.
    pub fn impulse_of_forces(&self) -> f64 {
        self.forces.get()
    }

    /// Impulses beside the forces, N s: those of the projection where points close, and of a second stage of the velocity.
    pub fn impulse_of_jumps(&self) -> f64 {
        self.jumps.get()
    }

    /// What the sizes of the steps around add to Σ P dt, N s: some schemes give a part of the impulse of a force in the steps
    /// after it, which may be longer or shorter. Zero where sizes change in flight alone.
    pub fn impulse_of_resizing(&self) -> f64 {
        self.resizing.get()
    }

    /// What of these the bodies have not got yet, N s: zero once the contact is open, up to what a memory of the scheme still
    /// holds. [`ContactRecord::impulse`] is the sum of the three less this.
    pub fn impulse_to_come(&self) -> f64 {
        self.later * self.last.0
    }

    /// Impulse on the secondary body as the forces reported, jumps and resizing tell it, less what is to come, N s.
    pub(crate) fn exchanged(&self) -> [f64; 3] {
        [0, 1, 2].map(|i| self.exchanged[i].get() - self.later * self.last.1[i])
    }

    /// Σ |P (ġ₊ + opening)| dt, J.
    pub fn persistency_defect(&self) -> f64 {
        self.defect.get()
    }
}

/// What a step adds to the record of a contact.
pub(crate) struct Step<'a> {
    /// Time at its start and end, s.
    pub(crate) span: [f64; 2],
    /// Its length, s: the difference of the two but for rounding.
    pub(crate) dt: f64,
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
        let (report, dt) = (step.report, step.dt);
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
        let later = dt * impulse.later();
        record.forces.add(dt * report.force);
        record.resizing.add((later - record.later) * before.0);
        record.jumps.add(projected.0 + later * change.0);
        for i in 0..3 {
            let sum = &mut record.exchanged[i];
            sum.add(dt * report.resultant[i]);
            sum.add((later - record.later) * before.1[i]);
            sum.add(projected.1[i] + later * change.1[i]);
        }
        record.later = later;
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
        }
        let given = Given {
            span: step.span,
            active,
            force: report.force,
            impulse: [0, 1, 2].map(|i| mean(before.1[i], resultant[i]) + projected.1[i]),
            normal: [0, 1, 2].map(|i| dt * report.normal[i] + projected.1[i]),
            work: step.work,
            crushed,
        };
        let velocities = [&old.motion.v[..], new_velocity];
        let place = (system, contact);
        let ended = OpenImpact::follow(&mut record.open, place, &given, velocities);
        self.impacts.extend(ended);
    }

    /// The impacts that have ended, those included whose last release is too short ago to tell that the flight lasts.
    pub fn ended(&self) -> impl Iterator<Item = Impact> + '_ {
        let flying = self.contacts.iter().enumerate();
        let flying = flying.filter_map(|(contact, record)| {
            let released = record.open.as_ref()?.released()?;
            Some(Impact {
                contact: contact as u32,
                ..released.clone()
            })
        });
        self.impacts.iter().cloned().chain(flying)
    }

    /// All impacts, those whose contact is closed at the end of the run included.
    pub fn all_impacts(&self, system: &System, state: &State) -> Vec<Impact> {
        let contacts = self.contacts.iter().enumerate();
        let closed = contacts.filter_map(|(contact, record)| {
            let open = record.open.as_ref()?;
            open.released().is_none().then(|| Impact {
                unfinished: true,
                restitution: None,
                ..open.impact(system, contact, state.time, &state.motion.v)
            })
        });
        self.ended().chain(closed).collect()
    }
}
