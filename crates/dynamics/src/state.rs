//! Everything that influences the next step or the results: the state is the checkpoint.

use std::ops::Range;

use carom_contact::Faced;
use carom_contact::law::Status;
use carom_system::{Motion, System};
use serde::{Deserialize, Serialize};

use crate::Error;
use crate::assembly_energy::AssemblyEnergies;
use crate::certificate::told::Told;
use crate::control::Control;
use crate::exchange::Exchange;
use crate::impact::Impact;
use crate::ledger::Ledger;
use crate::records::Records;
use crate::scheme::Scheme;
use crate::shapes::Shapes;
use crate::step_forces::StepForces;

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
    /// Nodal forces of the last step as its balance by works takes them, N; each empty where the next step does not need it. Of explicit steps in
    /// one pass those of links are taken from those of damping.
    pub forces: StepForces<Vec<f64>>,
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
    /// Energies of the assemblies since the start of the dynamics.
    pub assemblies: AssemblyEnergies,
    /// Shapes of the elements since their frequencies were last looked at, of an explicit scheme.
    pub shapes: Shapes,
    /// What passed through each other since the start; none where nobody has looked, as on several ranks.
    pub crossings: Option<Told>,
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

impl Links {
    /// Whether they are of this system; none where it has none.
    fn are_of(&self, system: &System) -> bool {
        let (rows, schemes) = (system.links.rows.len(), system.schemes.len());
        let is_none = rows == 0 && self.mixed.is_empty();
        self.multipliers.len() == rows
            && (is_none || self.mixed.len() == schemes)
            && self.mixed.iter().all(|mixed| mixed.len() == rows)
            && (self.works.len() == system.links.named.len() || rows == 0 && self.works.is_empty())
    }

    /// Without forces and works.
    pub(crate) fn at_rest(system: &System) -> Links {
        let rows = system.links.rows.len();
        Links {
            multipliers: vec![0.0; rows],
            mixed: vec![vec![0.0; rows]; system.schemes.len()],
            works: vec![[0.0; 2]; system.links.named.len()],
        }
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
    /// one in balance with the acceleration; after a stage as the momentum takes it ([`Impulse`](crate::Impulse)).
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
    /// Penetration at which the contact of a rigid body landed, m, until it is open: the part of a step by which the impact
    /// is early or late. Points count as closed from there on.
    pub landed: Vec<f64>,
    /// Points of edges that are closed, ascending, and the edges that they are closed at.
    pub faced: Vec<(u32, Faced)>,
}

impl InterfaceState {
    /// Whether it is of so many contact points.
    pub fn is_of(&self, points: usize) -> bool {
        let arrays = [
            &self.force,
            &self.carried,
            &self.gap,
            &self.rate,
            &self.opening,
            &self.flight,
            &self.crush,
            &self.landed,
        ];
        arrays.iter().all(|array| array.len() == points)
            && self.status.len() == points
            && self.watched.len() == points
            && [0, points].contains(&self.friction.len())
            && self.faced.is_sorted_by(|one, other| one.0 < other.0)
            && (self.faced.last()).is_none_or(|(point, _)| (*point as usize) < points)
    }

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
        self.landed.clone_from(&before.landed);
        self.faced.clone_from(&before.faced);
    }

    /// Becomes a copy at some points, and already is one at the others, but for the time without force.
    pub(crate) fn follow_at(
        &mut self,
        before: &InterfaceState,
        points: impl Iterator<Item = usize>,
    ) {
        self.friction.resize(before.friction.len(), [0.0; 2]);
        self.faced.clone_from(&before.faced);
        for point in points {
            self.take_point(point, (before, point));
        }
    }

    /// Makes a point what one of another state is, but for the time without force. Friction is taken where both have any.
    pub fn take_point(&mut self, to: usize, (other, from): (&InterfaceState, usize)) {
        self.force[to] = other.force[from];
        if let (Some(own), Some(friction)) = (self.friction.get_mut(to), other.friction.get(from)) {
            *own = *friction;
        }
        self.carried[to] = other.carried[from];
        self.gap[to] = other.gap[from];
        self.rate[to] = other.rate[from];
        self.opening[to] = other.opening[from];
        self.status[to] = other.status[from];
        self.watched[to] = other.watched[from];
        self.crush[to] = other.crush[from];
        self.landed[to] = other.landed[from];
        self.set_faced(to, other.faced(from));
    }

    /// The edge that a point is closed at, if it is a point of an edge.
    pub fn faced(&self, point: usize) -> Option<Faced> {
        self.faced[self.first_faced(point)..]
            .first()
            .filter(|(of, _)| *of as usize == point)
            .map(|(_, faced)| *faced)
    }

    /// Those of the points of a contact, by their numbers in it.
    pub fn faced_of(&self, points: Range<usize>) -> impl Iterator<Item = (u32, Faced)> + '_ {
        let own = self.first_faced(points.start)..self.first_faced(points.end);
        let number = move |&(point, faced): &(u32, Faced)| (point - points.start as u32, faced);
        self.faced[own].iter().map(number)
    }

    /// Sets the edge that a point is closed at.
    pub fn set_faced(&mut self, point: usize, faced: Option<Faced>) {
        let place = self.first_faced(point);
        let is_there = self.faced.get(place).map(|(of, _)| *of as usize) == Some(point);
        match (faced, is_there) {
            (Some(faced), true) => self.faced[place].1 = faced,
            (Some(faced), false) => self.faced.insert(place, (point as u32, faced)),
            (None, true) => drop(self.faced.remove(place)),
            (None, false) => (),
        }
    }

    /// The place of the first point that is not before one.
    fn first_faced(&self, point: usize) -> usize {
        self.faced.partition_point(|(of, _)| (*of as usize) < point)
    }

    /// Takes the force of a point.
    pub(crate) fn release(&mut self, point: usize) {
        self.force[point] = 0.0;
        if let Some(friction) = self.friction.get_mut(point) {
            *friction = [0.0; 2];
        }
        self.status[point] = Status::Open;
    }

    /// Counts the time without force after a step of `dt` (s), from that of the state before.
    pub fn count_flights(&mut self, before: &[f64], dt: f64) {
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
        let state = State::decode(bytes)?;
        state.check(system)?;
        Ok(state)
    }

    /// The state in these bytes, whatever it is of.
    pub(crate) fn decode(bytes: &[u8]) -> Result<State, Error> {
        postcard::from_bytes(bytes).map_err(|cause| Error::State {
            cause: cause.to_string(),
        })
    }

    /// Refuses a state of another size than the system's, in any of its arrays, or of a time that is none.
    pub fn check(&self, system: &System) -> Result<(), Error> {
        let n = system.unknowns();
        let interface = self.interface.is_of(system.points());
        let fits = self.has_motion_of(system)
            && interface
            && self
                .forces
                .each()
                .iter()
                .all(|force| [0, n].contains(&force.len()))
            && self.links.are_of(system)
            && self.records.are_of(system)
            && self.exchange.is_of(system, self.step)
            && self.assemblies.are_of(system)
            && self.shapes.are_of(system)
            && (self.crossings.as_ref()).is_none_or(|told| told.is_of(system));
        let cause = match (fits, self.time >= 0.0 && self.time.is_finite()) {
            (true, true) => return Ok(()),
            (true, false) => format!("its time is {} s", self.time),
            (false, _) => format!(
                "it belongs to another model than this one of {n} unknowns and {} contact points",
                system.points()
            ),
        };
        Err(Error::State { cause })
    }

    fn has_motion_of(&self, system: &System) -> bool {
        let (n, motion) = (system.unknowns(), &self.motion);
        let remembers = |scheme: &Scheme| scheme.get().step_map(system.dt).has_memory();
        let remembered = match system.schemes.iter().any(remembers) {
            true => n,
            false => 0,
        };
        let vectors = [
            &motion.u,
            &motion.v,
            &motion.a,
            &motion.internal_force,
            &motion.contact_force,
        ];
        vectors.iter().all(|vector| vector.len() == n)
            && [0, n].contains(&motion.link_force.len())
            && motion.frames.len() == system.initial.frames.len()
            && motion.memory.len() == remembered
            && motion.history.len() == system.start_histories().len()
    }

    /// All impacts so far, those whose contact is closed now included.
    pub fn impacts(&self, system: &System) -> Vec<Impact> {
        self.records.all_impacts(system, self.time, &self.motion.v)
    }
}

/// At rest, nothing done yet.
pub fn empty_state(system: &System) -> State {
    let zeros = || vec![0.0; system.unknowns()];
    let remembers = |scheme: &Scheme| scheme.get().step_map(system.dt).has_memory();
    let remembers = system.schemes.iter().any(remembers);
    State {
        motion: Motion {
            u: zeros(),
            v: zeros(),
            a: zeros(),
            frames: system.initial.frames.clone(),
            memory: match remembers {
                true => zeros(),
                false => Vec::new(),
            },
            internal_force: zeros(),
            contact_force: zeros(),
            link_force: Vec::new(),
            history: system.start_histories(),
        },
        ..state_without_motion(system)
    }
}

/// The same without the vectors of the motion.
pub(crate) fn state_without_motion(system: &System) -> State {
    let points = system.points();
    State {
        step: 0,
        time: 0.0,
        motion: Motion::default(),
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
            landed: vec![0.0; points],
            faced: Vec::new(),
        },
        forces: StepForces::default(),
        links: Links::default(),
        control: Control::start(system.dt),
        ledger: Ledger::default(),
        records: Records::default(),
        exchange: Exchange::default(),
        assemblies: AssemblyEnergies::default(),
        shapes: Shapes::default(),
        crossings: None,
    }
}
