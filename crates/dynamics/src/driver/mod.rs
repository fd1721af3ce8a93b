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

mod ahead;
mod approach;
pub(crate) mod attempt;
mod attempts;
mod balance;
mod balance_works;
pub(crate) mod balances;
mod candidates;
mod contact_forces;
pub(crate) mod contacts;
mod direct;
mod direct_balance;
mod direct_hold;
pub(crate) mod explicit;
mod force_jump;
mod identity;
mod in_stages;
mod landing;
pub mod linearised;
pub mod linked;
pub(crate) mod links;
pub(crate) mod loads;
mod matrices;
mod multipliers;
mod obstacles;
pub mod paired;
pub(crate) mod parts;
mod projection;
mod ranked;
pub(crate) mod ranks;
mod rebounding;
pub(crate) mod record;
mod refine;
mod residual;
mod solve;
mod stable;
pub(crate) mod stages;
mod start;
mod step;
mod unfit;

use std::sync::Arc;

use carom_algebra::Interrupt;

pub use self::contacts::tangents::Rubbing;
pub use self::ranked::RankShare;
pub use self::unfit::why_not_on_ranks;
use crate::certificate::Certificate;
use crate::costs::Costs;
use crate::report::StepReport;
use crate::state::State;
use crate::system::System;
use crate::watch::Watch;
use attempt::Attempt;
use balances::Balances;
use contacts::Contacts;
use explicit::Explicit;
use links::Links;
use parts::Parts;
use ranks::RankWork;
use stages::Stages;

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
    /// Who looks at whether bodies pass through each other; not of zones, whose bodies others have, nor of several ranks.
    certificate: Option<Certificate>,
    /// Whether it is of a zone.
    is_zone: bool,
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
        self.parts.residuals()
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
            factors: self.parts.effective().stats().cloned().collect(),
            work: self.parts.effective().work(),
            compliance_bytes: self.parts.effective().compliance_bytes()
                + self
                    .explicit
                    .direct()
                    .map_or(0, |direct| direct.apart.bytes()),
            force_sweeps: self.parts.force_sweeps(),
            element_updates: (self.parts.force_sweeps() * elements) as u64,
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

    /// Ends a step early where this is set; it then fails with [`crate::Error::Interrupted`]. Not on ranks, which all
    /// take the same steps: they end between two steps.
    pub fn heed(&mut self, interrupt: &Interrupt) {
        if self.ranks.are_several() {
            return;
        }
        self.attempt.interrupt = interrupt.clone();
        self.contacts.heed(interrupt);
    }
}
