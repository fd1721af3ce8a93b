//! Everything that influences the next step or the results: the state is the checkpoint.

use carom_contact::law::Status;
use carom_system::{Motion, System};
use serde::{Deserialize, Serialize};

use crate::Error;
use crate::control::Control;
use crate::exchange::Exchange;
use crate::ledger::{Balance, Ledger};
use crate::records::Records;
use crate::scheme::Scheme;

/// State at an accepted instant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Steps taken.
    pub step: u64,
    /// Time in s: `step * dt` for equal steps.
    pub time: f64,
    /// Motion of the nodes and the forces that belong to it.
    pub motion: Motion,
    /// Contact forces and statuses.
    pub interface: InterfaceState,
    /// Nodal forces of the last step as its balance by works takes them, N: loads, contacts, supports, inertia, internal,
    /// damping, links; empty where the next step does not need them.
    pub forces: Vec<Vec<f64>>,
    /// Links between velocities.
    pub links: Links,
    /// Step control.
    pub control: Control,
    /// Energy and momentum balance since the start.
    pub ledger: Ledger,
    /// Extrema, impulses and impacts since the start.
    pub records: Records,
    /// Momentum that contacts have given to the bodies since the start.
    pub exchange: Exchange,
}

/// Links at an accepted instant; empty without links.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Links {
    /// Multiplier of each row, N per unit of the row.
    pub multipliers: Vec<f64>,
    /// Multipliers as the balance of the last step saw them, by scheme.
    pub mixed: Vec<Vec<f64>>,
    /// Work of each link on its inner and its outer side since the start, J.
    pub works: Vec<[f64; 2]>,
}

/// # Errors
/// A vector of the motion at the end of a step, at this time (s), with an entry that is no number.
pub(crate) fn check_finite(motion: &Motion, step: u64, time: f64) -> Result<(), Error> {
    match motion.not_finite() {
        None => Ok(()),
        Some(quantity) => Err(Error::NotFinite {
            step,
            time,
            quantity,
        }),
    }
}

/// Arrays over all contact points.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct InterfaceState {
    /// Contact force P of the last step, N, compressive positive.
    pub force: Vec<f64>,
    /// Friction force along the two tangents, N; empty without friction.
    pub friction: Vec<[f64; 2]>,
    /// Contact force that stands at the beginning of the next step, N: that of the last step, or after a projection the
    /// one in balance with the acceleration.
    pub carried: Vec<f64>,
    /// Gap at the end of the step, m, open positive; infinite where a point faces nothing.
    pub gap: Vec<f64>,
    /// Gap rate that a law in the rate constrains, m/s, opening positive.
    pub rate: Vec<f64>,
    /// What laws in the rate added to it in the last step, m/s: they hold `rate + opening`. Zero of other laws and where the gap did
    /// not open at the start of the step ([`Local::start`](carom_contact::law::Local)).
    pub opening: Vec<f64>,
    /// Status: the sign S_g of laws in the gap, S_v of laws in the rate.
    pub status: Vec<Status>,
    /// S_d: the point took part in the last step.
    pub watched: Vec<bool>,
    /// Time since the point last carried a force, s; infinite where it never did.
    pub flight: Vec<f64>,
    /// Memory of the law: the largest penetration of the point so far, m; zero of laws without memory.
    pub crush: Vec<f64>,
}

impl InterfaceState {
    /// Becomes a copy, without new memory.
    pub(crate) fn follow(&mut self, before: &InterfaceState) {
        self.force.clone_from(&before.force);
        self.friction.clone_from(&before.friction);
        self.carried.clone_from(&before.carried);
        self.gap.clone_from(&before.gap);
        self.rate.clone_from(&before.rate);
        self.opening.clone_from(&before.opening);
        self.status.clone_from(&before.status);
        self.watched.clone_from(&before.watched);
        self.flight.clone_from(&before.flight);
        self.crush.clone_from(&before.crush);
    }

    /// Counts the time without force after a step of `dt` (s), from that of the state before.
    pub(crate) fn count_flights(&mut self, before: &[f64], dt: f64) {
        let points = self.flight.iter_mut().zip(&self.force).zip(before);
        for ((flight, force), before) in points {
            *flight = match *force == 0.0 {
                true => before + dt,
                false => 0.0,
            };
        }
    }
}

impl State {
    /// Bytes from which [`State::from_bytes`] makes the same state.
    ///
    /// # Errors
    /// None is known; the encoder's own error is passed on.
    pub fn to_bytes(&self) -> Result<Vec<u8>, Error> {
        postcard::to_stdvec(self).map_err(|cause| Error::State {
            cause: cause.to_string(),
        })
    }

    /// The state in these bytes, which must belong to `system`.
    ///
    /// # Errors
    /// The bytes are no state, or one of another size.
    pub fn from_bytes(system: &System, bytes: &[u8]) -> Result<State, Error> {
        let state: State = postcard::from_bytes(bytes).map_err(|cause| Error::State {
            cause: cause.to_string(),
        })?;
        state.check(system)?;
        Ok(state)
    }

    /// Whether a contact point carries a force or may do so within `dt` (s), at twice its present rate. `tolerance`: gap
    /// that counts as closed, m.
    pub(crate) fn may_touch(&self, dt: f64, tolerance: f64) -> bool {
        let interface = &self.interface;
        let points = interface.gap.iter().zip(&interface.rate);
        let touches = |((gap, rate), force): ((&f64, &f64), &f64)| {
            *force != 0.0 || gap + 2.0 * dt * rate.min(0.0) <= tolerance
        };
        points.zip(&interface.force).any(touches)
    }

    /// Refuses a state of another size than the system's.
    pub(crate) fn check(&self, system: &System) -> Result<(), Error> {
        let (n, points) = (system.unknowns(), system.points());
        let motion = &self.motion;
        let vectors = [
            &motion.u,
            &motion.v,
            &motion.a,
            &motion.internal_force,
            &motion.contact_force,
        ];
        let remembers = |scheme: &Scheme| scheme.get().step_map(system.dt).has_memory();
        let remembered = match system.schemes.iter().any(remembers) {
            true => n,
            false => 0,
        };
        if vectors.iter().any(|vector| vector.len() != n)
            || motion.frames.len() != system.initial_frames.len()
            || motion.memory.len() != remembered
            || self.interface.force.len() != points
        {
            let cause = format!(
                "it belongs to another model than this one of {n} unknowns and {points} contact points"
            );
            return Err(Error::State { cause });
        }
        Ok(())
    }
}

/// At rest, nothing done yet.
pub(crate) fn empty_state(system: &System) -> State {
    let (zeros, points) = (vec![0.0; system.unknowns()], system.points());
    let remembers = |scheme: &Scheme| scheme.get().step_map(system.dt).has_memory();
    let remembers = system.schemes.iter().any(remembers);
    State {
        step: 0,
        time: 0.0,
        motion: Motion {
            u: zeros.clone(),
            v: zeros.clone(),
            a: zeros.clone(),
            frames: system.initial_frames.clone(),
            memory: match remembers {
                true => zeros.clone(),
                false => Vec::new(),
            },
            internal_force: zeros.clone(),
            contact_force: zeros,
            link_force: Vec::new(),
            history: system.start_histories(),
        },
        interface: InterfaceState {
            force: vec![0.0; points],
            friction: Vec::new(),
            carried: vec![0.0; points],
            gap: vec![0.0; points],
            rate: vec![0.0; points],
            opening: vec![0.0; points],
            status: vec![Status::Open; points],
            watched: vec![false; points],
            flight: vec![f64::INFINITY; points],
            crush: vec![0.0; points],
        },
        forces: Vec::new(),
        links: Links::default(),
        control: Control::start(system.dt),
        ledger: Ledger::default(),
        records: Records::default(),
        exchange: Exchange::default(),
    }
}

/// What one contact did in a step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactReport {
    /// Sum of the normal forces of its points, N, compressive positive.
    pub force: f64,
    /// Impulse of the step that is in no force, N s: of a projection or another stage after a step, and of the force that it
    /// changes at the beginning of the next. Force times step and this are the impulse.
    pub impulsive: f64,
    /// Force on the secondary body, N.
    pub resultant: [f64; 3],
    /// The part of it of the normal forces, N.
    pub normal: [f64; 3],
    /// Magnitude of the sum of the friction forces of its points, N.
    pub friction: f64,
    /// Points that slip with a friction force.
    pub slipping: usize,
    /// Least gap at the end of the step, m; infinite where nothing faces anything.
    pub gap: f64,
    /// Gap rate at the point of the least gap, m/s.
    pub rate: f64,
    /// Points with a force.
    pub closed: usize,
    /// Points whose force began or ended in this step.
    pub status_changes: usize,
    /// Σ |P (ġ₊ + opening)| dt, J: zero when forces act on closed points only.
    pub persistency_defect: f64,
    /// Nodes of the secondary surface whose supports are partly closed: there the pressure of the weak form depends on r.
    /// Zero with another integration.
    pub mixed: usize,
}

/// What all contacts did in a part of a step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactSample {
    /// Time at its end, s.
    pub time: f64,
    /// Its length, s.
    pub dt: f64,
    /// By contact.
    pub contacts: Vec<ContactReport>,
}

/// What a step did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Number of the step, from 1; 0 for the initial state.
    pub step: u64,
    /// Time at the end of the step, s.
    pub time: f64,
    /// Size of the step, s; zero for the initial state.
    pub dt: f64,
    /// Attempts made, the last one taken.
    pub attempts: u32,
    /// By contact. Of a step in parts: forces are means over the step, gap and rate those at its end, closed, slipping and
    /// mixed the most in one of its parts, the rest sums.
    pub contacts: Vec<ContactReport>,
    /// Energies, works and momentum at the end of the step.
    pub balance: Balance,
    /// Passes of the status loop; in zones the passes over the step until the links hold.
    pub passes: usize,
    /// What the contacts did in the parts of the step, where it has some: the inner steps of zones, the halves of a nonlinear
    /// step that found no equilibrium. A contact of a zone without inner steps does in each part what it does in the step.
    pub samples: Vec<ContactSample>,
}

impl StepReport {
    /// End, length (both s) and contacts of each part of the step; of the step itself if it has none.
    pub fn parts(&self) -> impl Iterator<Item = (f64, f64, &[ContactReport])> {
        let whole = self.samples.is_empty();
        let step = whole.then_some((self.time, self.dt, &self.contacts[..]));
        let parts = self.samples.iter();
        step.into_iter()
            .chain(parts.map(|part| (part.time, part.dt, &part.contacts[..])))
    }

    /// Adds a part that ends at `time` (s) after `dt` (s), in which the contacts did what `contacts` says now.
    pub(crate) fn add_part(&mut self, time: f64, dt: f64) {
        self.samples.push(ContactSample {
            time,
            dt,
            contacts: self.contacts.clone(),
        });
    }

    /// Writes what the contacts did in the step from its parts, if it has some.
    pub(crate) fn join_parts(&mut self) {
        for (contact, whole) in self.contacts.iter_mut().enumerate() {
            let parts = self.samples.iter();
            join(parts.map(|part| (part.dt, &part.contacts[contact])), whole);
        }
    }
}

/// What a contact did in the parts of a step, as [`StepReport::contacts`] has it.
fn join<'a>(parts: impl Iterator<Item = (f64, &'a ContactReport)>, whole: &mut ContactReport) {
    let (mut sum, mut length) = (ContactReport::default(), 0.0);
    for (dt, part) in parts {
        length += dt;
        sum.force += dt * part.force;
        sum.impulsive += part.impulsive;
        for i in 0..3 {
            sum.resultant[i] += dt * part.resultant[i];
            sum.normal[i] += dt * part.normal[i];
        }
        sum.friction += dt * part.friction;
        sum.slipping = sum.slipping.max(part.slipping);
        (sum.gap, sum.rate) = (part.gap, part.rate);
        sum.closed = sum.closed.max(part.closed);
        sum.mixed = sum.mixed.max(part.mixed);
        sum.status_changes += part.status_changes;
        sum.persistency_defect += part.persistency_defect;
    }
    if length > 0.0 {
        *whole = ContactReport {
            force: sum.force / length,
            resultant: sum.resultant.map(|r| r / length),
            normal: sum.normal.map(|r| r / length),
            friction: sum.friction / length,
            ..sum
        };
    }
}
