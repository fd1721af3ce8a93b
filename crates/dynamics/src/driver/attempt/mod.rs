//! The attempt of a step under way: what all owners serve.

pub(crate) mod balance;
mod bolts;
pub(crate) mod critical;
mod deletion;
pub(crate) mod forces;
pub(crate) mod identity;
mod in_stages;
mod jump;
mod links;
mod points;
mod residual;
mod scheme_stage;
mod springs;
mod start;
pub(crate) mod vectors;

use std::sync::Arc;
use std::time::Instant;

use carom_algebra::Interrupt;
use carom_contact::law::{Displacement, Level};
use carom_contact::{Contact, Law};

use crate::contact_sums::ContactSums;
use crate::control::Control;
use crate::costs::Phases;
use crate::error::Error;
use crate::report::Notices;
use crate::scheme::EnergyIdentity;
use crate::state::{State, state_without_motion};
use crate::step_map::StepMap;
use crate::system::{Maps, System};
use scheme_stage::SchemeStage;
use vectors::Vectors;

/// The attempt of a step under way: where it begins, how large it is, where it ends.
pub(crate) struct Attempt {
    pub(crate) system: Arc<System>,
    /// Size of the attempt under way, s, and the maps of the zones.
    pub(crate) dt: f64,
    pub(crate) maps: Maps,
    /// The stage of the step that the attempt computes, of schemes of several.
    pub(crate) stage: SchemeStage,
    /// What these maps are of; none before they are made.
    pub(crate) sized: Option<SizeOfMaps>,
    /// The energy identity of the scheme; none of a static step, or where none is known.
    pub(crate) identity: Option<EnergyIdentity>,
    /// Ends the attempt under way where it is set.
    pub(crate) interrupt: Interrupt,
    pub(crate) state: State,
    pub(crate) next: State,
    /// What the attempt went on after.
    pub(crate) notices: Notices,
    pub(crate) vectors: Vectors,
    pub(crate) phases: Phases,
}

impl Attempt {
    /// Counts as contact the time since `begin` that has not been added to the phases `before` elsewhere.
    pub(crate) fn count_contact(&mut self, begin: Instant, before: Phases) {
        let counted = |phases: &Phases| {
            phases.factorisation + phases.forces + phases.sweeps + phases.friction
        };
        let counted = counted(&self.phases) - counted(&before);
        self.phases.contact += begin.elapsed().saturating_sub(counted);
    }

    /// What an attempt has come to: nothing, where somebody has asked for its end meanwhile. Part of what loops found may be missing then.
    pub(crate) fn unless_interrupted(&self, outcome: Result<(), Error>) -> Result<(), Error> {
        match self.interrupt.is_set() {
            true => Err(Error::Interrupted),
            false => outcome,
        }
    }

    /// The law of a contact in the attempt under way. In a static stage nothing has a rate: a law in the rate holds in the
    /// gap there, as the displacement law.
    pub(crate) fn law<'a>(&self, contact: &'a Contact) -> &'a Law {
        match contact.law.get().level() {
            Level::Rate if self.maps.is_static() => &AT_REST,
            _ => &contact.law,
        }
    }

    /// The map of the secondary side of a contact.
    pub(crate) fn map_of(&self, contact: usize) -> &StepMap {
        &self.maps.all()[self.system.zone_of(contact)]
    }

    /// Whether internal forces and contacts belong to the way of the step.
    pub(crate) fn between(&self) -> bool {
        !self.maps.is_static() && self.system.scheme.get().is_between()
    }

    /// Contact, place in it and mesh node of a contact point.
    pub(crate) fn name(&self, point: usize) -> String {
        let (contact, place) = self.system.point(point);
        let node = self.system.mesh_node[contact.points[place].node() as usize];
        format!("contact `{}`, point {place}, node {node}", contact.name)
    }

    /// Whether the step from the present state is static.
    pub(crate) fn is_static(&self) -> bool {
        let preload = self.system.nonlinear.preload;
        preload.is_some_and(|preload| self.state.step < preload.steps)
    }

    /// Whether supports jump in the iteration.
    pub(crate) fn jumps(&self) -> bool {
        self.vectors.jumps
    }

    pub(crate) fn renew_maps(&mut self, dt: f64, next: f64) {
        if self.is_static() {
            self.maps.rest();
            self.identity = None;
            return;
        }
        match self.stage.is_one_of_several() {
            true => self
                .maps
                .stage(&self.system.scheme, self.stage.number, self.stage.of),
            false => self.maps.resize(&self.system.schemes, (dt, next)),
        }
        // zones of different schemes are balanced by works
        self.identity = match &self.system.schemes[..] {
            [scheme] => scheme.get().energy_identity(dt),
            _ => None,
        };
    }

    /// Factor of Nᵀ P in the contact forces that the ledger counts.
    pub(crate) fn contact_factor(&self) -> f64 {
        match self.vectors.push.is_empty() {
            true => self.maps.contact(),
            false => 1.0,
        }
    }

    /// The first one of a system.
    pub(crate) fn of(system: Arc<System>) -> Attempt {
        let maps = Maps::new(&system, system.dt, system.dt);
        let pushed = match maps.first().uses_contact_acceleration() {
            true => system.unknowns(),
            false => 0,
        };
        Attempt {
            dt: 0.0,
            maps,
            stage: SchemeStage::first(&system),
            sized: None,
            identity: None,
            interrupt: Interrupt::default(),
            notices: Notices::default(),
            vectors: Vectors {
                push: vec![0.0; pushed],
                ..Vectors::default()
            },
            next: state_without_motion(&system),
            state: state_without_motion(&system),
            phases: Phases::default(),
            system,
        }
    }

    /// Whether an impact of a contact begins or ends in the step.
    pub(crate) fn impacts_change(&self, contacts: &[ContactSums]) -> bool {
        let mut records = self.state.records.contacts.iter().zip(contacts);
        records.any(|(record, of)| record.changes(of.report.closed > 0))
    }

    /// What the control remembers: of the sizes of steps those of the dynamics alone, once these have begun.
    pub(crate) fn control(&self) -> Control {
        let mut control = self.state.control;
        if self.state.step == self.system.static_steps() {
            control.range = [0.0; 2];
        }
        control
    }

    /// Times that a step of fixed size may be halved: none where all of it is linear, whose failures have other causes.
    pub(crate) fn most_halvings(&self) -> u32 {
        match self.system.is_nonlinear() {
            true => self.system.nonlinear.iteration.halvings,
            false => 0,
        }
    }

    /// The instant at which the next step of this size (s) ends, s: instants of equal steps are products, not sums.
    pub(crate) fn end_of_step(&self, size: f64) -> f64 {
        let step = self.state.step;
        match self.system.nonlinear.preload {
            Some(preload) if step < preload.steps => {
                preload.end * ((step + 1) as f64 / preload.steps as f64)
            }
            _ => self.state.control.instant(step, self.state.time, size),
        }
    }
}

/// What a law in the rate is in a static stage.
static AT_REST: Law = Law::Displacement(Displacement { projection: false });

/// What the maps of an attempt are of.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct SizeOfMaps {
    /// Size of the attempt and of the one after it, s.
    pub(crate) dt: f64,
    pub(crate) next: f64,
    pub(crate) is_static: bool,
    /// Number of the stage, and the step that it belongs to, s.
    pub(crate) stage: (usize, f64),
}

/// A configuration of the step.
#[derive(Clone, Copy)]
pub(crate) enum Configuration {
    /// The scratch configuration and velocity.
    Place,
    /// The end of the step.
    Next,
}
