//! Extrema, impulses and impacts, gathered at every step whatever is written.

use serde::{Deserialize, Serialize};

use crate::chatter::{Closing, TREMBLE, Waiting, chatter};
use crate::impact::{Given, Impact, NoRestitution, OpenImpact, TIE};
use crate::report::ContactReport;
use crate::scheme::Durations;
use crate::small::{Largest, Smallness};
use crate::step_map::Impulse;
use crate::sum::Sum;
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
    /// Time at which the force of each contact point ended last, s; of a closing that counts.
    pub(crate) opened: Vec<f64>,
    /// What each contact point has done that is still to be counted.
    pub(crate) waiting: Vec<Waiting>,
    /// Whether all elements at the node of each contact point are deleted; empty as long as none is.
    pub(crate) loose: Vec<bool>,
}

/// Record of one contact.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactRecord {
    /// Largest total force so far, N.
    pub peak_force: f64,
    /// End of the step of the largest force, s.
    pub peak_time: f64,
    /// Points with a force in that step.
    pub peak_closed: u64,
    /// Those of them at sharp edges and corners of their surface.
    pub peak_sharp: u64,
    /// Start of the first step with a force, s; after a static stage of the first one of the dynamics.
    pub first_closing: Option<f64>,
    /// End of the last step with a force, s.
    pub last_force: Option<f64>,
    /// How often a point's force began or ended.
    pub status_changes: u64,
    /// How often a point closed again, with a force that counts, sooner after it opened than mesh and step can tell
    /// ([`ContactRecord::chatter`]).
    pub hasty_closings: u64,
    /// How often a point closed otherwise with a force that counts.
    pub closings: u64,
    /// How often the force of a point began whose elements are all deleted, not counted in the two before: it strikes by itself, as often
    /// as its flight has it.
    pub loose_closings: u64,
    /// Σ force times step over the steps in which points were closed hastily, N s.
    pub(crate) hasty_impulse: f64,
    /// Largest penetration at the end of a step, m.
    pub penetration: f64,
    /// Largest depth of a point behind the plane that it faced in a step, at its start or at its end, m; by the node of the point. Where it
    /// passed what it faced that is the depth of its start, seen from the far side. Of sides that are paired anew.
    pub passing: Largest,
    /// How often a point has passed what it faces in a step without a force, to where it is not seen behind it
    /// ([`Contact::passed`](carom_contact::Contact::passed)).
    pub passed: u64,
    /// Largest depth of a node of the primary side behind the secondary one, m: between its points, where no force keeps it out. Of sides that
    /// are paired anew, at the looks of [`Smallness`].
    pub between: Largest,
    /// Energy lost in crush so far, J: what it took to crush the points, less what they can give back.
    pub energy_crushed: f64,
    /// Energy that friction has taken so far, J.
    rubbed: Sum,
    /// The same over the static stage before the dynamics, J.
    rubbed_before: f64,
    /// Work of the normal forces and of the impulses so far, beyond that of a moving obstacle, J; of the dynamics without their static stage, in which
    /// contacts give what an interference has pressed into the bodies.
    worked: Sum,
    /// Largest such work so far, J: what the contact has made at most.
    pub largest_work: f64,
    /// Most nodes at the end of a step whose supports are partly closed; see [`ContactReport::mixed`].
    pub mixed: u64,
    /// Total force and force on the secondary body in the last step as they enter impulses, N.
    last: (f64, [f64; 3]),
    /// What the stage after the last step has changed in them.
    changed: (f64, [f64; 3]),
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
    /// Force of an obstacle that moves.
    pub(crate) pushed: Pushed,
}

/// Force of a moving obstacle at the end of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Pushed {
    /// On the bodies, friction included, N.
    pub(crate) force: [f64; 3],
    /// Power of its turn, W.
    pub(crate) turn: f64,
}

impl ContactRecord {
    /// Whether an impact begins or ends in a step after which the contact is `active` or not: the velocities of the bodies are asked for then.
    pub(crate) fn changes(&self, active: bool) -> bool {
        match &self.open {
            None => active,
            Some(open) => !active && open.released().is_none(),
        }
    }

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

    /// What is counted by point: closings, hasty, others, and those of loose points, and points at sharp edges at the largest force; and the impulse
    /// of the hasty ones, N s.
    pub(crate) fn counts_mut(&mut self) -> ([&mut u64; 4], &mut f64) {
        let counts = [
            &mut self.hasty_closings,
            &mut self.closings,
            &mut self.loose_closings,
            &mut self.peak_sharp,
        ];
        (counts, &mut self.hasty_impulse)
    }

    /// Changes of status to a closing that is due: 2 where each point closes once and opens once in an impact. A closing is
    /// not due if the point had no force in the four steps before it at most, or for less time than a wave needs to pass over four
    /// elements: mesh and step carry nothing that fast. A closing counts once its force is more than a hundredth of the largest so far,
    /// shared by the closed points; one that opens before does not, nor does its opening. Those that are not due count as none where their
    /// impulses are a hundredth of that of the contact at most. Points whose elements are all deleted are not counted: nothing makes
    /// their force begin again but their own flight. 0 where nothing ever closed.
    pub fn chatter(&self) -> f64 {
        let impulses = [self.hasty_impulse, self.impulse()];
        chatter([self.closings, self.hasty_closings], impulses)
    }

    /// Whether an impact of the contact counts: its largest force is more than a hundredth of the largest of the contact.
    pub fn counts(&self, impact: &Impact) -> bool {
        impact.peak_force > TREMBLE * self.peak_force
    }

    /// Work of the normal forces and of the impulses on the bodies so far, beyond that of a moving obstacle, J: negative where closing
    /// takes energy.
    pub fn work(&self) -> f64 {
        self.worked.get()
    }

    /// Energy that friction has taken so far, J: its work on what slides, which wears it off.
    pub fn friction_loss(&self) -> f64 {
        self.rubbed.get()
    }

    /// Work beside friction, and what friction took, since the start of the dynamics, J, as one work.
    pub fn work_with_friction(&self) -> f64 {
        self.work() - (self.rubbed.get() - self.rubbed_before)
    }

    /// Σ |P (ġ₊ + opening)| dt, J.
    pub fn persistency_defect(&self) -> f64 {
        self.defect.get()
    }
}

impl ContactRecord {
    /// Begins with this total force and force on the secondary body, N: what is compressed at the start.
    pub(crate) fn begin(&mut self, force: (f64, [f64; 3])) {
        self.last = force;
    }
}

/// What a step adds to the record of a contact.
pub struct Step<'a> {
    /// Time at its start and end, s.
    pub span: [f64; 2],
    /// Its length, s: the difference of the two but for rounding; 0 of a static step, in which forces give no impulse.
    pub dt: f64,
    /// How long its forces give their impulse.
    pub durations: Durations,
    /// How forces make impulses in the scheme.
    pub impulse: Impulse,
    /// Normal forces of all points at the start and of the step, N.
    pub forces: [&'a [f64]; 2],
    /// What the contact did.
    pub report: &'a ContactReport,
    /// Work of the contact's forces and impulses, J.
    pub work: f64,
    /// Energy lost in crush, J.
    pub crushed: f64,
    /// Of a projection after the step: impulse in N s, and change of the force that the next step begins with in N; each
    /// as a sum over the points and as a vector on the secondary body.
    pub jump: [(f64, [f64; 3]); 2],
}

impl Records {
    /// Nothing yet.
    pub fn of(system: &System) -> Records {
        Records {
            contacts: vec![ContactRecord::default(); system.contacts.len()],
            impacts: Vec::new(),
            small: Smallness::of(system),
            opened: vec![f64::NEG_INFINITY; system.points()],
            waiting: vec![Waiting::default(); system.points()],
            loose: Vec::new(),
        }
    }

    /// Whether they are of this system.
    pub fn are_of(&self, system: &System) -> bool {
        let (contacts, points) = (system.contacts.len(), system.points());
        let small = &self.small;
        self.contacts.len() == contacts
            && self.opened.len() == points
            && self.waiting.len() == points
            && [0, points].contains(&self.loose.len())
            && small.bodies.len() == system.bodies.len()
            && small.contacts.len() == contacts
            && self
                .impacts
                .iter()
                .all(|impact| (impact.contact as usize) < contacts)
    }

    /// Starts the clocks and the works of the contacts at the end of a static stage: what is compressed there closes with the first step of the
    /// dynamics, whose balance begins anew.
    pub fn begin_dynamics(&mut self) {
        for record in &mut self.contacts {
            (record.first_closing, record.last_force) = (None, None);
            (record.worked, record.largest_work) = (Sum::default(), 0.0);
            record.rubbed_before = record.rubbed.get();
        }
    }

    /// Makes these the records of the state before the step, of which they are those of one step earlier or of an
    /// attempt given up: the impacts of both begin alike, and only the last are copied.
    pub(crate) fn follow(&mut self, before: &Records) {
        self.contacts.clone_from(&before.contacts);
        self.small.follow(&before.small);
        self.opened.clone_from(&before.opened);
        self.waiting.clone_from(&before.waiting);
        self.loose.clone_from(&before.loose);
        self.impacts.truncate(before.impacts.len());
        self.impacts
            .extend_from_slice(&before.impacts[self.impacts.len()..]);
    }

    /// Adds a step of one contact. `points`: those of its points whose force may begin or end in the step, and are counted here; `velocities`:
    /// at its start and at its end.
    pub fn add(
        &mut self,
        (system, contact): (&System, usize),
        (step, points): (&Step, impl Iterator<Item = usize> + Clone),
        velocities: [&[f64]; 2],
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
        // what the last stage changed in the force works in this step, and is in no force that was told
        let carried = (
            dt * impulse.old * record.changed.0,
            record.changed.1.map(|force| dt * impulse.old * force),
        );
        record.changed = change;
        record.last = (
            force + change.0,
            [0, 1, 2].map(|i| resultant[i] + change.1[i]),
        );
        record.impulse.add(mean(before.0, force));
        record.impulse.add(projected.0);
        let Durations {
            force: lasts,
            later,
            before: expected,
        } = step.durations;
        record.forces.add(lasts * report.force);
        record.resizing.add((expected - record.later) * before.0);
        record.jumps.add(projected.0 + later * change.0);
        for i in 0..3 {
            let sum = &mut record.exchanged[i];
            sum.add(lasts * report.resultant[i]);
            sum.add((expected - record.later) * before.1[i]);
            sum.add(projected.1[i] + later * change.1[i]);
        }
        record.later = later;
        record.defect.add(report.persistency_defect);
        record.rubbed.add(report.friction_loss);
        record.worked.add(step.work);
        record.largest_work = record.largest_work.max(record.worked.get());
        record.status_changes += report.status_changes as u64;
        if report.status_changes > 0 || report.closed > 0 {
            let step = Closing {
                span: step.span,
                dt,
                forces: step.forces,
                least: TREMBLE * record.peak_force / report.closed.max(1) as f64,
                passage: system.contacts[contact].passage,
            };
            let known = (&mut self.opened[..], &mut self.waiting[..], &self.loose[..]);
            let counted = step.count(points.clone(), known);
            record.closings += counted.due;
            record.hasty_closings += counted.hasty;
            record.loose_closings += counted.loose;
            record.hasty_impulse += counted.hasty_impulse;
        }
        record.mixed = record.mixed.max(report.mixed as u64);
        if report.gap.is_finite() {
            record.penetration = record.penetration.max(-report.gap);
        }
        if report.force > record.peak_force * (1.0 + TIE) {
            (record.peak_force, record.peak_time) = (report.force, step.span[1]);
            record.peak_closed = report.closed as u64;
            let is_sharp = |point: &usize| step.forces[1][*point] != 0.0 && system.is_sharp(*point);
            record.peak_sharp = points.filter(is_sharp).count() as u64;
        }
        record.energy_crushed += step.crushed;
        let active = report.closed > 0;
        if active {
            record.first_closing.get_or_insert(step.span[0]);
            record.last_force = Some(step.span[1]);
        }
        let given = Given {
            span: step.span,
            // an impact begins with the dynamics
            active: active && dt > 0.0,
            force: report.force,
            impulse: [0, 1, 2].map(|i| mean(before.1[i], resultant[i]) + projected.1[i]),
            impulsive: [0, 1, 2].map(|i| projected.1[i] + carried.1[i]),
            normal: [0, 1, 2].map(|i| lasts * report.normal[i] + projected.1[i]),
            work: step.work,
            crushed: step.crushed,
            rubbed: report.friction_loss,
        };
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

    /// All impacts until `time` (s), those whose contact is closed then included. `v`: velocities then, m/s.
    pub(crate) fn all_impacts(&self, system: &System, time: f64, v: &[f64]) -> Vec<Impact> {
        let contacts = self.contacts.iter().enumerate();
        let closed = contacts.filter_map(|(contact, record)| {
            let open = record.open.as_ref()?;
            open.released().is_none().then(|| Impact {
                unfinished: true,
                restitution: None,
                no_restitution: Some(NoRestitution::Unfinished),
                ..open.impact(system, contact, time, v)
            })
        });
        self.ended().chain(closed).collect()
    }
}
