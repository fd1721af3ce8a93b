//! The initial state, and the passage from the static stage to the dynamics.

use std::sync::Arc;

use super::Driver;
use super::attempt::identity::{End, energies};
use super::attempt::{Attempt, Configuration};
use super::balances::Balances;
use super::contacts::Contacts;
use super::explicit::Explicit;
use super::explicit::leapfrog::Direct;
use super::parts::Parts;
use super::ranks::RankWork;
use super::stages::Stages;
use crate::control::Control;
use crate::costs::Costs;
use crate::error::Error;
use crate::ledger::Ledger;
use crate::operator::Operators;
use crate::records::Records;
use crate::report::{ContactReport, StepReport};
use crate::resultant::Resultant;
use crate::state::{Links, State, empty_state, state_without_motion};
use crate::step_forces::{OutsideForces, StepForces};
use crate::step_terms::Energies;
use crate::system::System;
use crate::watch::Watch;

impl Driver {
    /// Sets the initial state.
    ///
    /// # Errors
    /// A matrix that is not positive definite, elements that are turned inside out, a static stage of a body that
    /// neither supports nor contacts could hold.
    pub fn new(system: Arc<System>) -> Result<Driver, Error> {
        let direct = Direct::of(&system);
        Driver::begun(system, direct)
    }

    /// The same for a zone whose steps others complete ([`Driver::complete`]): all forces of a step are kept for the works of links.
    ///
    /// # Errors
    /// As [`Driver::new`].
    pub fn of_zone(system: Arc<System>) -> Result<Driver, Error> {
        let mut driver = Driver::begun(system, None)?;
        driver.is_zone = true;
        Ok(driver)
    }

    fn begun(released: Arc<System>, direct: Option<Direct>) -> Result<Driver, Error> {
        let system = Arc::clone(released.staged.as_ref().unwrap_or(&released));
        let mut driver = Driver {
            contacts: Contacts::of(&system)?,
            parts: Parts::of(&system)?,
            links: super::links::Links::of(&system),
            stages: Stages::of(&system, &released)?,
            explicit: Explicit::new(direct, system.parts.len()),
            ranks: RankWork::default(),
            balances: Balances::default(),
            origin: None,
            early: Vec::new(),
            forced: None,
            ahead: system.dt,
            unplanned: None,
            watch: Watch::new(&system),
            certificate: None,
            is_zone: false,
            report: StepReport {
                contacts: vec![ContactReport::default(); system.contacts.len()],
                ..StepReport::default()
            },
            earlier: Costs::default(),
            released: match Arc::ptr_eq(&system, &released) {
                true => None,
                false => Some(released),
            },
            attempt: Attempt::of(system),
        };
        let system = Arc::clone(&driver.attempt.system);
        driver.restart(&system.initial.displacement, &system.initial.velocity)?;
        Ok(driver)
    }

    /// A solver that goes on from a saved state.
    ///
    /// # Errors
    /// As [`Driver::new`].
    pub fn resume(system: Arc<System>, state: State) -> Result<Driver, Error> {
        let mut driver = Driver::new(system)?;
        driver.attempt.next.clone_from(&state);
        driver.attempt.state = state;
        driver.look_from_here();
        Ok(driver)
    }

    /// Begins anew from another initial motion: displacement in m and velocity in m/s, one entry per unknown. Held
    /// unknowns are where their supports are, whatever is given; the velocity of those that move as prescribed is the one
    /// before the support takes hold of them, in the first step. With a static stage velocities are those of its end.
    ///
    /// # Errors
    /// As [`Driver::new`].
    pub fn restart(&mut self, displacement: &[f64], velocity: &[f64]) -> Result<(), Error> {
        let system = Arc::clone(&self.attempt.system);
        self.certificate = None;
        // their room before that of new ones is taken
        self.attempt.state = state_without_motion(&system);
        self.attempt.next = state_without_motion(&system);
        self.attempt.state = empty_state(&system);
        if self.attempt.has_links() {
            self.links.clear_force();
        }
        let link_force = &mut self.attempt.state.motion.link_force;
        link_force.clear();
        link_force.extend_from_slice(self.links.force());
        let motion = &mut self.attempt.state.motion;
        let follows = system.nonlinear.follows.iter();
        let prescribed = follows.map(|follows| follows.unknown as usize);
        for i in (0..system.unknowns())
            .filter(|&i| !system.fixed[i])
            .chain(prescribed)
        {
            motion.u[i] = displacement[i];
            if system.nonlinear.preload.is_none() {
                motion.v[i] = velocity[i];
            }
        }
        system.nonlinear.prescribe([0.0; 2], &mut motion.u);
        motion.compose(&system.unknowns);
        self.start()
    }

    /// Begins the dynamics where a static stage ended that another driver took, with the velocity (m/s) and the force of links (N) there, one entry per unknown.
    /// `end`: motion, contact points and records at the end of the stage, in the numbers of this system.
    ///
    /// # Errors
    /// As [`Driver::new`].
    pub fn begin_dynamics(
        &mut self,
        end: &State,
        velocity: &[f64],
        force: Vec<f64>,
    ) -> Result<(), Error> {
        let system = Arc::clone(&self.attempt.system);
        self.contacts.size(&mut self.attempt, system.dt, system.dt);
        self.parts.set_prepared(false);
        self.leave_direct();
        self.attempt.state.clone_from(end);
        let state = &mut self.attempt.state;
        state.control = Control::after_stage(system.dt, state.step, state.time);
        for (i, v) in velocity.iter().enumerate() {
            state.motion.v[i] = if system.fixed[i] { 0.0 } else { *v };
        }
        state.motion.link_force.clone_from(&force);
        state.records.begin_dynamics();
        self.links.set_force(force);
        self.begin()?;
        self.keep_for_direct_steps();
        self.attempt.next.clone_from(&self.attempt.state);
        self.attempt.show_followed(0.0);
        self.tell(0.0);
        Ok(())
    }

    /// Nodal forces of some contacts in the present configuration, N.
    pub fn forces_of_contacts(&mut self, chosen: impl Fn(usize) -> bool) -> Vec<f64> {
        self.contacts.pair_now(&mut self.attempt);
        let (system, interface) = (&*self.attempt.system, &self.attempt.state.interface);
        let mut forces = vec![0.0; system.unknowns()];
        let pairing = self.contacts.pairing();
        for point in (0..system.points()).filter(|point| chosen(system.contact_of(*point))) {
            let force = interface.force[point];
            if force != 0.0 {
                pairing.rows.add_force(point, force, &mut forces);
            }
            let tangential = interface.friction.get(point).into_iter().flatten();
            for (rows, &t) in pairing.tangents.iter().zip(tangential) {
                if t != 0.0 {
                    rows.add_force(point, t, &mut forces);
                }
            }
        }
        forces
    }

    /// Room for what the start of these steps computes.
    fn make_room_for_start(&mut self) {
        match self.is_direct() {
            true => self
                .attempt
                .vectors
                .make_room_for_start(&self.attempt.state.motion),
            false => self.attempt.vectors.make_room(&self.attempt.state.motion),
        }
    }

    /// Completes the initial state.
    fn start(&mut self) -> Result<(), Error> {
        let system = Arc::clone(&self.attempt.system);
        self.contacts.size(&mut self.attempt, system.dt, system.dt);
        self.parts.set_prepared(false);
        self.leave_direct();
        self.attempt.state.records = Records::of(&system);
        self.make_room_for_start();
        self.attempt.vectors.x.fill(0.0);
        self.contacts.compress(&mut self.attempt);
        if !self.is_direct() {
            self.attempt.next.clone_from(&self.attempt.state);
        }
        self.begin()?;
        if self.attempt.has_links() && self.attempt.is_static() {
            self.attempt.state.links = Links::at_rest(&system);
        } else if self.attempt.has_links() {
            self.begin_with_links()?;
        }
        self.keep_for_direct_steps();
        self.attempt.state.control = Control::start(system.dt);
        self.attempt.next.clone_from(&self.attempt.state);
        self.attempt.show_followed(0.0);
        self.tell(0.0);
        Ok(())
    }

    /// Links change the velocities, on which the forces depend that links answer to.
    fn begin_with_links(&mut self) -> Result<(), Error> {
        self.links.start_links(&mut self.attempt)?;
        self.contacts.compress(&mut self.attempt);
        self.begin()?;
        self.links.start_links(&mut self.attempt)?;
        self.begin()
    }

    /// Gives the state the velocities, accelerations and balance with which a stage begins.
    fn begin(&mut self) -> Result<(), Error> {
        let system = Arc::clone(&self.attempt.system);
        self.make_room_for_start();
        self.attempt
            .vectors
            .place
            .clone_from(&self.attempt.state.motion.u);
        self.attempt
            .vectors
            .rate
            .clone_from(&self.attempt.state.motion.v);
        self.parts
            .internal(&mut self.attempt, (Configuration::Place, false), |_| 0.0)?;
        let stored = *self.parts.stored();
        self.attempt
            .state
            .motion
            .internal_force
            .clone_from(&self.attempt.vectors.internal);
        self.attempt.evaluate_loads(self.attempt.state.time);
        self.parts.evaluate_damping(&mut self.attempt);
        if self.attempt.maps.first().has_memory() {
            let motion = &mut self.attempt.state.motion;
            motion.memory.clone_from(&motion.v);
        }
        let keeps = |zone: usize| system.schemes[zone].get().keeps_acceleration();
        if (0..system.schemes.len()).any(keeps) && !self.attempt.is_static() {
            let mut mass = Operators::new(&system, 1.0, 0.0, "mass matrix")?;
            let (vectors, motion) = (&mut self.attempt.vectors, &mut self.attempt.state.motion);
            for i in 0..system.unknowns() {
                let outside = vectors.load[i] + motion.contact_force[i] + motion.link_of(i);
                let balance = outside - vectors.internal[i] - vectors.damping[i];
                vectors.residual[i] = if system.fixed[i] { 0.0 } else { balance };
            }
            mass.begin(&vectors.residual, &mut vectors.half);
            mass.end(&mut vectors.half, &mut motion.a);
            for (span, _) in system.spans.iter().filter(|(_, zone)| !keeps(*zone)) {
                motion.a[span.clone()].fill(0.0);
            }
        }
        match system.is_nonlinear() {
            true => self.start_works(stored.strain, stored.hardening),
            false => self.parts.start_identity(&mut self.attempt, stored.strain),
        }
        self.attempt.start_assemblies(self.parts.energy_of_bodies());
        Ok(())
    }

    /// Keeps what direct steps need of the start: loads that vary, and forces beside the internal ones.
    fn keep_for_direct_steps(&mut self) {
        if !self.is_direct() {
            return;
        }
        let beside = match self.attempt.has_forces_beside() {
            true => {
                let (damping, motion) = (&self.attempt.vectors.damping, &self.attempt.state.motion);
                let own = damping.iter().enumerate();
                own.map(|(i, own)| own - motion.link_of(i)).collect()
            }
            false => Vec::new(),
        };
        let mut load = std::mem::take(&mut self.attempt.state.forces.load);
        if self.attempt.system.nonlinear.loads.is_empty() {
            load.clear();
        }
        self.attempt.state.forces = StepForces {
            load,
            damping: beside,
            ..StepForces::default()
        };
        self.attempt.vectors.give_up_room();
    }

    /// The ledger at the start, where forces are not all linear.
    fn start_works(&mut self, strain: f64, hardening: f64) {
        let system = Arc::clone(&self.attempt.system);
        // where the forces of the start were evaluated
        let mut springs = Vec::new();
        self.attempt.springs_at_place(false, &mut springs);
        self.forces_at_the_start(springs);
        self.attempt.start_exchange();
        let identity = self.attempt.identity_of_ledger();
        let [memory, lagged] =
            self.parts
                .own_energies(&mut self.attempt, End::Start, &identity, strain);
        let motion = &self.attempt.state.motion;
        let of = (strain, identity.inertia != 0.0, Some(&motion.u[..]));
        let of_motion = energies(&system, motion, of, &mut self.attempt.vectors.work);
        let energies = Energies {
            memory,
            lagged,
            ..of_motion.of_zones(&self.attempt.maps, &system, motion)
        };
        let kept = &self.attempt.state.forces;
        let at = |force: &[f64]| match kept.is_empty() {
            true => Resultant::default(),
            false => Resultant::at(&system, (&motion.frames, &[&motion.u]), force),
        };
        let forces = OutsideForces {
            loads: at(&kept.load),
            contacts: at(&kept.contact),
            supports: at(&kept.reaction).plus(&at(&kept.spring).reversed()),
            held: Resultant::default(),
            links: at(&kept.link).plus(&at(&kept.damping).reversed()),
        };
        self.attempt.state.ledger = Ledger::start(&energies, &identity, forces);
        self.attempt.state.ledger.store(hardening);
    }

    /// Forces that a step with a balance at both of its ends begins with, those of `springs` (N) also by themselves: none where a static stage begins out of balance.
    fn forces_at_the_start(&mut self, springs: Vec<f64>) {
        self.attempt.state.forces = StepForces::default();
        let system = &*self.attempt.system;
        let mut maps = self.attempt.maps.all().iter();
        let of_end = match self.attempt.is_plain() {
            true => maps.all(|map| map.impulse.of_start() == 0.0),
            false => maps.all(|map| map.impulse.old == 0.0),
        };
        if of_end && !self.attempt.is_static() {
            return;
        }
        let motion = &self.attempt.state.motion;
        let mut inertia = vec![0.0; system.unknowns()];
        if !self.attempt.is_static() {
            system.mass.multiply(&motion.a, &mut inertia);
        } else if !self.attempt.is_balanced() {
            return;
        }
        let (load, internal) = (&self.attempt.vectors.load, &motion.internal_force);
        let reaction = (0..system.unknowns()).map(|i| match system.fixed[i] {
            true => {
                let inside = inertia[i] + internal[i] + self.attempt.vectors.damping[i];
                inside - load[i] - motion.contact_force[i] - motion.link_of(i)
            }
            false => 0.0,
        });
        let reaction = reaction.collect();
        // the ledger of direct steps begins with resultants alone
        let internal = match self.is_direct() {
            true => Vec::new(),
            false => internal.clone(),
        };
        let damping = match system.has_damping() || !self.is_direct() {
            true => self.attempt.vectors.damping.clone(),
            false => Vec::new(),
        };
        let links = match self.attempt.has_links() || !self.is_direct() {
            true => (0..system.unknowns()).map(|i| motion.link_of(i)).collect(),
            false => Vec::new(),
        };
        self.attempt.state.forces = StepForces {
            load: load.clone(),
            contact: motion.contact_force.clone(),
            reaction,
            inertia,
            internal,
            damping,
            link: links,
            spring: springs,
        };
    }

    /// Lets go of the bodies that have waited for the dynamics.
    fn let_go(&mut self) {
        if let Some(released) = self.released.take() {
            self.attempt.system = released;
            self.parts.forget_matrices();
        }
    }

    /// At the end of the static stage bodies are given their velocities, and the balance begins anew.
    pub(super) fn begin_stage(&mut self) -> Result<(), Error> {
        let Some(preload) = self.attempt.system.nonlinear.preload else {
            return Ok(());
        };
        if self.attempt.state.step >= preload.steps {
            self.let_go();
        }
        let system = Arc::clone(&self.attempt.system);
        if self.attempt.state.step != preload.steps
            || self.attempt.state.motion.v.iter().any(|v| *v != 0.0)
        {
            return Ok(());
        }
        if self.attempt.state.time != preload.end {
            return Ok(());
        }
        self.attempt
            .state
            .motion
            .v
            .clone_from(&system.initial.velocity);
        self.attempt.state.records.begin_dynamics();
        self.begin()?;
        if self.attempt.has_links() {
            self.begin_with_links()?;
        }
        self.keep_for_direct_steps();
        Ok(())
    }
}
