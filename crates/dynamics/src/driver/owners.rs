//! What a driver consists of: owners of what belongs together, and the attempt of a step that all of them serve.

use std::cell::RefCell;
use std::sync::Arc;

use carom_algebra::Interrupt;
use carom_algebra::solver::Saddle;
use carom_bodies::{Scratch, Stored};
use carom_contact::{Contact, Pairing, Search};

use super::active::Active;
use super::carried::Carried;
use super::closings::Closings;
use super::effective::Effective;
use super::far::Far;
use super::floating::Floating;
use super::impulse::Impulses;
use super::leapfrog::Direct;
use super::linking::Multipliers;
use super::mixing::Mixing;
use super::paired::Manner;
use super::passage::Passage;
use super::rebound::Rebound;
use super::refined::Refined;
use super::scratch::{Pace, Predictor, Projected, Restoring, Squares, Vectors, Works};
use super::supports::Jump;
use super::weak::{WeakForms, WithWeak};
use crate::costs::Phases;
use crate::coulomb::{Coulomb, FrictionProblem, Slip};
use crate::interface::{Candidate, Interface, InterfaceProblem};
use crate::of_contact::OfContact;
use crate::report::Notices;
use crate::resultant::Resultant;
use crate::scheme::EnergyIdentity;
use crate::shapes::Rates;
use crate::shared::Shared;
use crate::state::State;
use crate::system::{LinkRow, Maps, System};

/// Contacts: search, pairing, points that may carry a force, their laws, the problems of forces and friction, what they did.
pub(super) struct Contacts {
    pub(super) manners: Vec<Manner>,
    /// Whether any contact is paired where the unknown leads.
    pub(super) turns: bool,
    /// Whether sliding is a velocity in steps of this size and stage.
    pub(super) by_rate: bool,
    pub(super) interface: Interface,
    /// Those of groups of candidates that do not act on each other, where there are several.
    pub(super) interfaces: Vec<Interface>,
    /// The problem of contacts where matrices are solved with by iterations.
    pub(super) saddle: RefCell<Saddle>,
    pub(super) pairing: Pairing,
    /// Whether its rows are those of the reference places, so that its gaps alone move.
    pub(super) rows_stand: bool,
    /// Contacts with small sliding where all nodes are at their reference places; empty until they are paired.
    pub(super) initial: Vec<Pairing>,
    pub(super) search: Vec<Search>,
    /// Contacts whose primary sides have lost cells, and the number of deleted elements that they are for; empty as long as none has.
    pub(super) narrowed: Vec<Option<Contact>>,
    pub(super) narrowed_for: u64,
    pub(super) active: Active,
    pub(super) passage: Passage,
    pub(super) far: Far,
    pub(super) closings: Closings,
    pub(super) rebound: Rebound,
    /// Points that may carry a force, ascending.
    pub(super) candidates: Vec<u32>,
    pub(super) candidate_data: Vec<Candidate>,
    /// Gaps of the candidates at the end of the step without any contact force, m; of an adaptive step.
    pub(super) free_gaps: Vec<f64>,
    pub(super) coulomb: Coulomb,
    pub(super) weak: WeakForms,
    pub(super) with_weak: WithWeak,
    /// Normal and tangential rows of all points, point after point, where there is friction; of steps with iterations.
    pub(super) stacked: carom_contact::Rows,
    pub(super) slips: Vec<Slip>,
    pub(super) failed: Option<InterfaceProblem>,
    pub(super) failed_friction: Option<FrictionProblem>,
    /// What the points of each contact did in the attempt: those of this process, then of all.
    pub(super) of_contacts: Vec<OfContact>,
    /// Room for nodal forces of a contact whose moment is reported, N.
    pub(super) nodal: Vec<f64>,
}

/// Stages of a step with the mass alone: impulses of contact points, what a predictor and a projection change.
pub(super) struct Stages {
    /// Solver of the stages with the mass alone; none where there is no such stage.
    pub(super) impulses: Option<Impulses>,
    pub(super) projected: Projected,
    pub(super) predictor: Predictor,
    pub(super) restoring: Restoring,
}

/// Connected parts: matrices and factors, forces and histories of the bodies, residual and iterations.
pub(super) struct Parts {
    pub(super) effective: Effective,
    pub(super) floating: Floating,
    /// Buffers of the bodies.
    pub(super) scratch: Vec<Scratch>,
    pub(super) force_sweeps: usize,
    /// Residuals of the iterations of the last attempt, relative.
    pub(super) residuals: Vec<f64>,
    pub(super) pace: Pace,
    pub(super) mixing: Mixing,
    pub(super) refined: Refined,
    pub(super) carried: Carried,
    /// Sizes of the forces of each assembly.
    pub(super) squares: Vec<Squares>,
    /// Energies of the iteration.
    pub(super) stored: Stored,
    /// Whether the residual without the forces of links, and the pairing, are those of the step.
    pub(super) prepared: bool,
    /// Norm of the forces that the iterations of the step may leave unbalanced, N.
    pub(super) left_over: f64,
}

/// Links between zones and within a model: rows and multipliers.
pub(super) struct Links {
    /// Forces of links in the step, N; empty without links.
    pub(super) force: Vec<f64>,
    pub(super) multipliers: Multipliers,
    /// The rows of the links; those that turn as they are in the iteration.
    pub(super) rows: Arc<Vec<LinkRow>>,
}

/// Explicit steps in one pass over the lumped mass.
pub(super) struct Explicit {
    /// For steps whose matrix is the lumped mass; none where there are no such steps.
    pub(super) direct: Option<Direct>,
    pub(super) rates: Rates,
}

/// What this process has of a run that several compute.
pub(super) struct RankWork {
    /// What this process has of a run that several compute; none of one process.
    pub(super) shared: Option<Box<Shared>>,
    /// Whether several compute it.
    pub(super) several: bool,
    /// The last step at which it was asked whether to look at what is assumed small, of such a run.
    pub(super) looked: u64,
}

/// What the balance of a step is made of, and forces of supports.
pub(super) struct Balances {
    pub(super) jump: Jump,
    /// Forces of the named supports in the last attempt.
    pub(super) reactions: Vec<Resultant>,
    pub(super) works: Works,
}

/// The attempt of a step under way: where it begins, how large it is, where it ends.
pub(super) struct Attempt {
    pub(super) system: Arc<System>,
    /// Size of the attempt under way, s, and the maps of the zones.
    pub(super) dt: f64,
    pub(super) maps: Maps,
    /// Size and stage of these maps; none before they are made.
    pub(super) sized: Option<(f64, f64, bool)>,
    /// The energy identity of the scheme; none of a static step, or where none is known.
    pub(super) identity: Option<EnergyIdentity>,
    /// Ends the attempt under way where it is set.
    pub(super) interrupt: Interrupt,
    pub(super) state: State,
    pub(super) next: State,
    /// What the attempt went on after.
    pub(super) notices: Notices,
    pub(super) vectors: Vectors,
    pub(super) phases: Phases,
}
