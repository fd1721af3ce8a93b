//! The one driver of all steps.
//!
//! The unknown x of a step is found by Newton's method: each iteration linearises internal forces and gaps at the present x, and
//! solves the interface problem of that linearisation exactly, with its signs,
//!
//! `A Δx - c Nᵀ P = r(x)`, `A = inertia.x M + force.x K(x) + damping - c ∂(Nᵀ P)/∂x`, `0 ≤ q(x) + s N Δx ⟂ P ≥ 0`.
//!
//! Where all is linear in x the first iteration is the last: free motion, interface problem, correction. A is that of each connected part
//! by itself; the factor of a linear part stands for the run. Other steps end when the forces balance and every point obeys its law in
//! the configuration reached.
//!
//! What the driver holds besides the state is a function of the system and the state, or scratch: a run goes on from a saved state
//! with the same bits.

mod active;
mod ahead;
mod apart;
mod approach;
mod attempt;
mod balance;
mod balance_works;
mod begun_solve;
mod bolts;
mod candidates;
mod carried;
mod closing;
mod closings;
mod compressed;
mod contact_forces;
mod contacts;
mod deletion;
mod describe;
mod direct;
mod direct_balance;
mod direct_hold;
mod direct_links;
mod effective;
mod factored_step;
mod far;
mod floating;
mod followed;
mod force_jump;
mod forces;
mod held;
mod identity;
mod impulse;
mod in_stages;
mod joined;
mod landing;
mod leapfrog;
mod linear_part;
pub mod linearised;
pub mod linked;
mod linking;
mod links;
pub(crate) mod loads;
mod matrices;
mod mean_forces;
mod mixing;
mod near;
mod obstacles;
mod owners;
pub mod paired;
mod pairing_modes;
mod part_matrix;
mod passage;
mod passed;
mod pieces;
mod predictor;
mod projection;
mod ranked;
mod rebound;
mod rebounding;
pub(crate) mod record;
mod refine;
mod refined;
mod renewal;
mod reported;
mod residual;
mod restoring;
mod rigid;
mod rounding;
mod scheme_stage;
mod scratch;
mod shared_looks;
mod solve;
mod span;
mod springs;
mod stable;
mod start;
mod step;
mod supports;
mod tangent_solver;
pub(crate) mod tangents;
mod turned;
mod unfit;
mod weak;

use std::sync::Arc;

use carom_algebra::Interrupt;
use carom_contact::law::{Displacement, Level};
use carom_contact::{Contact, Law};

use crate::costs::Costs;
use crate::error::Error;
use crate::report::StepReport;
use crate::state::State;
use crate::step_map::StepMap;
use crate::system::System;
use crate::watch::Watch;
use owners::{Attempt, Balances, Contacts, Explicit, Links, Parts, RankWork, SizeOfMaps, Stages};
pub use ranked::RankShare;
use scratch::Vectors;
pub use unfit::why_not_on_ranks;

/// What a law in the rate is in a static stage.
static AT_REST: Law = Law::Displacement(Displacement { projection: false });

/// Takes steps.
pub struct Driver {
    attempt: Attempt,
    contacts: Contacts,
    parts: Parts,
    links: Links,
    stages: Stages,
    explicit: Explicit,
    ranks: RankWork,
    balances: Balances,
    /// That of the dynamics, as long as bodies wait for these in a static stage.
    released: Option<Arc<System>>,
    /// The state at the start of the step whose later stages are under way.
    origin: Option<Box<State>>,
    /// Points that close in stages before the last one of the attempt, of adaptive steps, and when after its start, s.
    early: Vec<(usize, f64)>,
    /// Every which step is dropped once, in tests.
    forced: Option<u64>,
    /// Size of the step after that of a zone, s.
    ahead: f64,
    /// Size of the next step that an event forces, in tests, s.
    unplanned: Option<f64>,
    watch: Watch,
    report: StepReport,
    /// What the run cost before this driver went on with it.
    earlier: Costs,
}

impl Driver {
    /// The system.
    pub fn system(&self) -> &System {
        &self.attempt.system
    }

    /// The last accepted state.
    pub fn state(&self) -> &State {
        &self.attempt.state
    }

    /// What the last step did.
    pub fn report(&self) -> &StepReport {
        &self.report
    }

    /// Relative residuals of the iterations of the last step.
    pub fn residuals(&self) -> &[f64] {
        &self.parts.residuals
    }

    /// What the run cost so far.
    pub fn costs(&self) -> Costs {
        let elements: usize = self
            .attempt
            .system
            .bodies
            .iter()
            .map(|b| b.cells().len())
            .sum();
        let mut costs = Costs {
            factors: self.parts.effective.stats().cloned().collect(),
            work: self.parts.effective.work(),
            compliance_bytes: self.parts.effective.compliance_bytes()
                + self
                    .explicit
                    .direct
                    .as_ref()
                    .map_or(0, |direct| direct.apart.bytes()),
            force_sweeps: self.parts.force_sweeps,
            element_updates: (self.parts.force_sweeps * elements) as u64,
            phases: self.attempt.phases,
            zones: Vec::new(),
        };
        costs.add(&self.earlier);
        costs
    }

    /// Counts what the run cost before this driver went on with it.
    pub fn add_earlier(&mut self, costs: &Costs) {
        self.earlier.add(costs);
    }

    /// Ends a step early where this is set; it then fails with [`Error::Interrupted`]. Not on ranks, which all
    /// take the same steps: they end between two steps.
    pub fn heed(&mut self, interrupt: &Interrupt) {
        if self.ranks.several {
            return;
        }
        self.attempt.interrupt = interrupt.clone();
        let Contacts {
            solver,
            group_solvers,
            ..
        } = &mut self.contacts;
        std::iter::once(solver)
            .chain(group_solvers)
            .for_each(|solver| solver.heed(interrupt));
    }
}

impl Attempt {
    /// What an attempt has come to: nothing, where somebody has asked for its end meanwhile. Part of what loops found may be missing then.
    pub(super) fn unless_interrupted(&self, outcome: Result<(), Error>) -> Result<(), Error> {
        match self.interrupt.is_set() {
            true => Err(Error::Interrupted),
            false => outcome,
        }
    }

    /// The law of a contact in the attempt under way. In a static stage nothing has a rate: a law in the rate holds in the
    /// gap there, as the displacement law.
    pub(super) fn law<'a>(&self, contact: &'a Contact) -> &'a Law {
        match contact.law.get().level() {
            Level::Rate if self.maps.is_static() => &AT_REST,
            _ => &contact.law,
        }
    }

    /// The map of the secondary side of a contact.
    pub(super) fn map_of(&self, contact: usize) -> &StepMap {
        &self.maps.all()[self.system.zone_of(contact)]
    }

    /// Whether internal forces and contacts belong to the way of the step.
    pub(super) fn between(&self) -> bool {
        !self.maps.is_static() && self.system.scheme.get().is_between()
    }

    /// Contact, place in it and mesh node of a contact point.
    pub(super) fn name(&self, point: usize) -> String {
        let (contact, place) = self.system.point(point);
        let node = self.system.mesh_node[contact.points[place].node() as usize];
        format!("contact `{}`, point {place}, node {node}", contact.name)
    }

    /// Whether the step from the present state is static.
    pub(super) fn is_static(&self) -> bool {
        let preload = self.system.nonlinear.preload;
        preload.is_some_and(|preload| self.state.step < preload.steps)
    }

    /// Whether supports jump in the iteration.
    pub(super) fn jumps(&self) -> bool {
        self.vectors.jumps
    }

    pub(super) fn renew_maps(&mut self, dt: f64, next: f64) {
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
    pub(super) fn contact_factor(&self) -> f64 {
        match self.vectors.push.is_empty() {
            true => self.maps.contact(),
            false => 1.0,
        }
    }
}

impl Parts {
    /// Whether pieces float in the attempt under way.
    pub(super) fn floats(&self, attempt: &Attempt) -> bool {
        attempt.maps.is_static() && !self.floating.pieces.is_empty()
    }
}

impl Contacts {
    /// How long after the start of the step a contact is paired, s.
    pub(super) fn paired_after(&self, attempt: &Attempt, number: usize) -> f64 {
        let law = attempt.law(&attempt.system.contacts[number]);
        match law.get().level() {
            _ if attempt.between() => 0.5 * attempt.dt,
            Level::Rate => self.captured(attempt, number) * attempt.dt,
            Level::Gap => attempt.dt,
            Level::GapAndRate => attempt.map_of(number).instant(attempt.dt),
        }
    }

    /// The map of the step of this size from the present state, of an explicit scheme before one of the size `next` (both s).
    pub(super) fn size(&mut self, attempt: &mut Attempt, dt: f64, next: f64) {
        attempt.dt = dt;
        let sized = Some(SizeOfMaps {
            dt,
            next,
            is_static: attempt.is_static(),
            stage: attempt.stage.key(),
        });
        if attempt.sized == sized {
            return;
        }
        attempt.sized = sized;
        attempt.renew_maps(dt, next);
        self.renew_pairing_modes(attempt);
    }
}

/// A configuration of the step.
#[derive(Clone, Copy)]
enum Configuration {
    /// The scratch configuration and velocity.
    Place,
    /// The end of the step.
    Next,
}
