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
mod bolts;
mod candidates;
mod carried;
mod closing;
mod closings;
mod compressed;
mod contacts;
mod deletion;
mod describe;
mod direct;
mod direct_hold;
mod direct_links;
mod effective;
mod factored_step;
mod far;
mod floating;
mod followed;
mod forces;
mod friction;
mod held;
mod identity;
mod impulse;
mod iterated;
mod joined;
mod landing;
mod leapfrog;
mod linear_part;
pub mod linked;
mod linking;
mod links;
pub(crate) mod loads;
mod manner;
mod matrices;
mod mean_forces;
mod mixing;
mod near;
mod obstacles;
pub mod paired;
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
mod scratch;
mod solve;
mod span;
mod springs;
mod stable;
mod start;
mod step;
mod supports;
mod tangent_solver;
mod tangents;
mod turned;
mod unfit;
mod weak;

use std::cell::RefCell;
use std::sync::Arc;

use carom_algebra::Interrupt;
use carom_algebra::solver::Saddle;
use carom_bodies::{Scratch, Stored};
use carom_contact::law::{Displacement, Level};
use carom_contact::{Contact, Law, Pairing, Search};

use crate::costs::{Costs, Phases};
use crate::coulomb::{Coulomb, FrictionProblem, Slip};
use crate::error::Error;
use crate::interface::{Candidate, Interface, InterfaceProblem};
use crate::of_contact::OfContact;
use crate::report::{Notices, StepReport};
use crate::resultant::Resultant;
use crate::scheme::EnergyIdentity;
use crate::shapes::Rates;
use crate::shared::Shared;
use crate::state::State;
use crate::step_map::StepMap;
use crate::system::{LinkRow, Maps, System};
use crate::watch::Watch;
use active::Active;
use carried::Carried;
use closings::Closings;
use effective::Effective;
use far::Far;
use floating::Floating;
use impulse::Impulses;
use leapfrog::Direct;
use linking::Multipliers;
use mixing::Mixing;
use paired::Manner;
use passage::Passage;
pub use ranked::RankShare;
use rebound::Rebound;
use refined::Refined;
use scratch::{Pace, Predictor, Projected, Restoring, Squares, Vectors, Works};
use supports::Jump;
pub use unfit::why_not_on_ranks;
use weak::{WeakForms, WithWeak};

/// What a law in the rate is in a static stage.
static AT_REST: Law = Law::Displacement(Displacement { projection: false });

/// Takes steps.
pub struct Driver {
    system: Arc<System>,
    /// That of the dynamics, as long as bodies wait for these in a static stage.
    released: Option<Arc<System>>,
    /// Size of the attempt under way, s, and the maps of the zones.
    dt: f64,
    maps: Maps,
    /// Size and stage of these maps; none before they are made.
    sized: Option<(f64, f64, bool)>,
    manners: Vec<Manner>,
    /// Whether any contact is paired where the unknown leads.
    turns: bool,
    /// Whether sliding is a velocity in steps of this size and stage.
    by_rate: bool,
    /// The energy identity of the scheme; none of a static step, or where none is known.
    identity: Option<EnergyIdentity>,
    effective: Effective,
    /// For steps whose matrix is the lumped mass; none where there are no such steps.
    direct: Option<Direct>,
    rates: Rates,
    /// What this process has of a run that several compute; none of one process.
    shared: Option<Box<Shared>>,
    /// Whether several compute it.
    several: bool,
    /// The last step at which it was asked whether to look at what is assumed small, of such a run.
    looked: u64,
    floating: Floating,
    /// Every which step is dropped once, in tests.
    forced: Option<u64>,
    /// Size of the step after that of a zone, s.
    ahead: f64,
    /// Size of the next step that an event forces, in tests, s.
    unplanned: Option<f64>,
    /// Solver of the stages with the mass alone; none where there is no such stage.
    impulses: Option<Impulses>,
    projected: Projected,
    predictor: Predictor,
    restoring: Restoring,
    interface: Interface,
    /// Those of groups of candidates that do not act on each other, where there are several.
    interfaces: Vec<Interface>,
    /// The problem of contacts where matrices are solved with by iterations.
    saddle: RefCell<Saddle>,
    pairing: Pairing,
    /// Whether its rows are those of the reference places, so that its gaps alone move.
    rows_stand: bool,
    /// Contacts with small sliding where all nodes are at their reference places; empty until they are paired.
    initial: Vec<Pairing>,
    search: Vec<Search>,
    /// Contacts whose primary sides have lost cells, and the number of deleted elements that they are for; empty as long as none has.
    narrowed: Vec<Option<Contact>>,
    narrowed_for: u64,
    watch: Watch,
    active: Active,
    passage: Passage,
    far: Far,
    closings: Closings,
    rebound: Rebound,
    /// Points that may carry a force, ascending.
    candidates: Vec<u32>,
    candidate_data: Vec<Candidate>,
    /// Gaps of the candidates at the end of the step without any contact force, m; of an adaptive step.
    free_gaps: Vec<f64>,
    coulomb: Coulomb,
    /// Ends the attempt under way where it is set.
    interrupt: Interrupt,
    weak: WeakForms,
    with_weak: WithWeak,
    /// Normal and tangential rows of all points, point after point, where there is friction; of steps with iterations.
    stacked: carom_contact::Rows,
    slips: Vec<Slip>,
    /// Buffers of the bodies.
    scratch: Vec<Scratch>,
    force_sweeps: usize,
    /// Residuals of the iterations of the last attempt, relative.
    residuals: Vec<f64>,
    pace: Pace,
    mixing: Mixing,
    refined: Refined,
    carried: Carried,
    jump: Jump,
    failed: Option<InterfaceProblem>,
    failed_friction: Option<FrictionProblem>,
    state: State,
    next: State,
    report: StepReport,
    /// What the attempt went on after.
    notices: Notices,
    /// What the points of each contact did in the attempt: those of this process, then of all.
    of_contacts: Vec<OfContact>,
    /// Room for nodal forces of a contact whose moment is reported, N.
    nodal: Vec<f64>,
    /// Forces of the named supports in the last attempt.
    reactions: Vec<Resultant>,
    vectors: Vectors,
    works: Works,
    /// Sizes of the forces of each assembly.
    squares: Vec<Squares>,
    /// Energies of the iteration.
    stored: Stored,
    /// Forces of links in the step, N; empty without links.
    link_force: Vec<f64>,
    multipliers: Multipliers,
    /// The rows of the links; those that turn as they are in the iteration.
    rows: Arc<Vec<LinkRow>>,
    /// Whether the residual without the forces of links, and the pairing, are those of the step.
    prepared: bool,
    /// Norm of the forces that the iterations of the step may leave unbalanced, N.
    left_over: f64,
    phases: Phases,
    /// What the run cost before this driver went on with it.
    earlier: Costs,
}

impl Driver {
    /// The system.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// The last accepted state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// What the last step did.
    pub fn report(&self) -> &StepReport {
        &self.report
    }

    /// Relative residuals of the iterations of the last step.
    pub fn residuals(&self) -> &[f64] {
        &self.residuals
    }

    /// What the run cost so far.
    pub fn costs(&self) -> Costs {
        let elements: usize = self.system.bodies.iter().map(|b| b.cells().len()).sum();
        let mut costs = Costs {
            factors: self.effective.stats().cloned().collect(),
            work: self.effective.work(),
            compliance_bytes: self.effective.compliance_bytes()
                + self
                    .direct
                    .as_ref()
                    .map_or(0, |direct| direct.apart.bytes()),
            force_sweeps: self.force_sweeps,
            element_updates: (self.force_sweeps * elements) as u64,
            phases: self.phases,
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
        if self.several {
            return;
        }
        self.interrupt = interrupt.clone();
        self.coulomb.interrupt = interrupt.clone();
        for interface in std::iter::once(&mut self.interface).chain(&mut self.interfaces) {
            interface.interrupt = interrupt.clone();
        }
    }

    /// What an attempt has come to: nothing, where somebody has asked for its end meanwhile. Part of what loops found may be missing then.
    fn unless_interrupted(&self, outcome: Result<(), Error>) -> Result<(), Error> {
        match self.interrupt.is_set() {
            true => Err(Error::Interrupted),
            false => outcome,
        }
    }

    /// Whether pieces float in the attempt under way.
    pub(super) fn floats(&self) -> bool {
        self.maps.is_static() && !self.floating.pieces.is_empty()
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

    /// How long after the start of the step a contact is paired, s.
    pub(super) fn paired_after(&self, number: usize) -> f64 {
        let law = self.law(&self.system.contacts[number]);
        match law.get().level() {
            _ if self.between() => 0.5 * self.dt,
            Level::Rate => self.captured(number) * self.dt,
            Level::Gap => self.dt,
            Level::GapAndRate => self.map_of(number).instant(self.dt),
        }
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

    /// The map of the step of this size from the present state, of an explicit scheme before one of the size `next` (both s).
    pub(super) fn size(&mut self, dt: f64, next: f64) {
        self.dt = dt;
        let sized = Some((dt, next, self.is_static()));
        if self.sized == sized {
            return;
        }
        self.sized = sized;
        self.renew_maps(dt, next);
        self.renew_manners();
    }

    fn renew_maps(&mut self, dt: f64, next: f64) {
        if self.is_static() {
            self.maps.rest();
            self.identity = None;
            return;
        }
        self.maps.resize(&self.system.schemes, (dt, next));
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

/// A configuration of the step.
#[derive(Clone, Copy)]
enum Which {
    /// The scratch configuration and velocity.
    Place,
    /// The end of the step.
    Next,
}
