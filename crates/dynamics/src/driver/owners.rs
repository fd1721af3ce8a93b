//! What a driver consists of: owners of what belongs together, and the attempt of a step that all of them serve.

use std::cell::RefCell;
use std::sync::Arc;

use carom_algebra::Interrupt;
use carom_algebra::solver::Saddle;
use carom_bodies::{Scratch, Stored};
use carom_contact::{Contact, Pairing, Rows, Search};
use carom_nonsmooth::{CandidateData, ContactSolver};
use carom_system::ContactPair;

use super::active::Active;
use super::carried::Carried;
use super::closings::Closings;
use super::effective::Effective;
use super::far::Far;
use super::floating::Floating;
use super::force_jump::ForceJump;
use super::impulse::Impulses;
use super::leapfrog::Direct;
use super::linking::Multipliers;
use super::mixing::Mixing;
use super::paired::{PairingMode, sums_compliances};
use super::passage::Passage;
use super::rebound::Rebound;
use super::refined::Refined;
use super::scheme_stage::SchemeStage;
use super::scratch::{Pace, Predictor, Projected, Restoring, Squares, Vectors, Works};
use super::supports::Jump;
use super::weak::{WeakForms, WithWeak};
use crate::contact_sums::ContactSums;
use crate::costs::Phases;
use crate::coulomb::{FrictionProblem, Slip};
use crate::error::Error;
use crate::interface::InterfaceProblem;
use crate::report::Notices;
use crate::resultant::Resultant;
use crate::scheme::EnergyIdentity;
use crate::shapes::Rates;
use crate::shared::Shared;
use crate::state::{State, state_without_motion};
use crate::system::{LinkRow, Maps, System};

/// Contacts: search, pairing, points that may carry a force, their laws, the problems of forces and friction, what they did.
pub(super) struct Contacts {
    pub(super) pairing_modes: Vec<PairingMode>,
    /// Whether any contact is paired where the unknown leads.
    pub(super) turns: bool,
    /// Whether sliding is a velocity in steps of this size and stage.
    pub(super) by_rate: bool,
    /// Solves for the forces of the candidates, and has what was found.
    pub(super) solver: ContactSolver,
    /// Those of groups of candidates that do not act on each other, where there are several.
    pub(super) group_solvers: Vec<ContactSolver>,
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
    pub(super) candidate_data: CandidateData,
    /// Gaps of the candidates at the end of the step without any contact force, m; of an adaptive step.
    pub(super) free_gaps: Vec<f64>,
    pub(super) weak: WeakForms,
    pub(super) with_weak: WithWeak,
    /// Normal and tangential rows of all points, point after point, where there is friction; of steps with iterations.
    pub(super) stacked: Rows,
    pub(super) slips: Vec<Slip>,
    pub(super) failed: Option<InterfaceProblem>,
    pub(super) failed_friction: Option<FrictionProblem>,
    /// What the points of each contact did in the attempt: those of this process, then of all.
    pub(super) sums: Vec<ContactSums>,
    /// Room for nodal forces of a contact whose moment is reported, N.
    pub(super) nodal: Vec<f64>,
}

impl Contacts {
    /// Those of a system.
    ///
    /// # Errors
    /// A weak form that is not positive definite.
    pub(super) fn of(system: &System) -> Result<Contacts, Error> {
        Ok(Contacts {
            pairing_modes: Vec::new(),
            turns: false,
            by_rate: false,
            solver: ContactSolver::default(),
            group_solvers: Vec::new(),
            saddle: RefCell::default(),
            pairing: Pairing::default(),
            initial: vec![Pairing::default(); system.contacts.len()],
            search: system.contacts.iter().map(|_| Search::default()).collect(),
            narrowed: Vec::new(),
            narrowed_for: 0,
            active: Active::of(system),
            passage: Passage::of(system),
            far: Far::of(system, |_| true),
            closings: Closings::of(system),
            rebound: Rebound::of(system),
            candidates: Vec::new(),
            candidate_data: CandidateData::default(),
            free_gaps: Vec::new(),
            weak: WeakForms::new(system)?,
            with_weak: WithWeak::default(),
            stacked: Rows::default(),
            slips: Vec::new(),
            failed: None,
            failed_friction: None,
            sums: Vec::new(),
            nodal: Vec::new(),
            rows_stand: false,
        })
    }
}

/// Stages of a step with the mass alone: impulses of contact points, what a predictor and a projection change.
pub(super) struct Stages {
    /// Solver of the stages with the mass alone; none where there is no such stage.
    pub(super) impulses: Option<Impulses>,
    pub(super) projected: Projected,
    pub(super) predictor: Predictor,
    pub(super) restoring: Restoring,
}

impl Stages {
    /// Those of a system, which is `released` in the dynamics.
    ///
    /// # Errors
    /// A mass that is not positive definite.
    pub(super) fn of(system: &System, released: &System) -> Result<Stages, Error> {
        let (scheme, points) = (system.scheme.get(), system.points());
        let map = scheme.step_map(system.dt);
        let projects = |contact: &ContactPair| contact.law.projects();
        let stages = scheme.projects_predictor()
            || scheme.restores_contact_work()
            || sums_compliances(system, &map)
            || map.uses_contact_acceleration() && !system.links.rows.is_empty();
        let staged = stages && points > 0 || system.contacts.iter().any(projects);
        Ok(Stages {
            impulses: match staged {
                true => Some(Impulses::new(released)?),
                false => None,
            },
            projected: Projected::new(points),
            predictor: Predictor::default(),
            restoring: Restoring::default(),
        })
    }
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

impl Parts {
    /// Those of a system.
    ///
    /// # Errors
    /// A static stage of a body that neither supports nor contacts could hold.
    pub(super) fn of(system: &System) -> Result<Parts, Error> {
        Ok(Parts {
            effective: Effective::new(),
            floating: Floating::new(system)?,
            scratch: system.bodies.iter().map(|_| Scratch::default()).collect(),
            force_sweeps: 0,
            residuals: Vec::new(),
            pace: Pace::default(),
            mixing: Mixing::default(),
            refined: Refined::default(),
            carried: Carried::default(),
            squares: Vec::new(),
            stored: Stored::default(),
            prepared: false,
            left_over: 0.0,
        })
    }
}

/// Links between zones and within a model: rows and multipliers.
pub(super) struct Links {
    /// Forces of links in the step, N; empty without links.
    pub(super) force: Vec<f64>,
    pub(super) jump: ForceJump,
    pub(super) multipliers: Multipliers,
    /// The rows of the links; those that turn as they are in the iteration.
    pub(super) rows: Arc<Vec<LinkRow>>,
}

impl Links {
    /// Those of a system.
    pub(super) fn of(system: &System) -> Links {
        let unknowns = match system.links.rows.is_empty() {
            true => 0,
            false => system.unknowns(),
        };
        Links {
            force: vec![0.0; unknowns],
            jump: ForceJump::default(),
            multipliers: Multipliers::new(system),
            rows: Arc::clone(&system.links.rows),
        }
    }
}

/// Explicit steps in one pass over the lumped mass.
pub(super) struct Explicit {
    /// For steps whose matrix is the lumped mass; none where there are no such steps.
    pub(super) direct: Option<Direct>,
    pub(super) rates: Rates,
}

/// What this process has of a run that several compute.
#[derive(Default)]
pub(super) struct RankWork {
    /// What this process has of a run that several compute; none of one process.
    pub(super) shared: Option<Box<Shared>>,
    /// Whether several compute it.
    pub(super) several: bool,
    /// The last step at which it was asked whether to look at what is assumed small, of such a run.
    pub(super) looked: u64,
}

/// What the balance of a step is made of, and forces of supports.
#[derive(Default)]
pub(super) struct Balances {
    pub(super) jump: Jump,
    /// Forces of the named supports in the last attempt.
    pub(super) reactions: Vec<Resultant>,
    pub(super) works: Works,
}

/// What the maps of an attempt are of.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct SizeOfMaps {
    /// Size of the attempt and of the one after it, s.
    pub(super) dt: f64,
    pub(super) next: f64,
    pub(super) is_static: bool,
    /// Number of the stage, and the step that it belongs to, s.
    pub(super) stage: (usize, f64),
}

/// The attempt of a step under way: where it begins, how large it is, where it ends.
pub(super) struct Attempt {
    pub(super) system: Arc<System>,
    /// Size of the attempt under way, s, and the maps of the zones.
    pub(super) dt: f64,
    pub(super) maps: Maps,
    /// The stage of the step that the attempt computes, of schemes of several.
    pub(super) stage: SchemeStage,
    /// What these maps are of; none before they are made.
    pub(super) sized: Option<SizeOfMaps>,
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

impl Attempt {
    /// The first one of a system.
    pub(super) fn of(system: Arc<System>) -> Attempt {
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
}
