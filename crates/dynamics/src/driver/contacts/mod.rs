//! Contacts: search, pairing, points that may carry a force, their laws, the problems of forces and friction, what they did.

pub(crate) mod active;
pub(crate) mod apart;
pub(crate) mod approach;
pub(crate) mod balance;
pub(crate) mod candidates;
pub(crate) mod closing;
pub(crate) mod closings;
pub(crate) mod compressed;
pub(crate) mod deletion;
pub(crate) mod describe;
pub(crate) mod direct;
pub(crate) mod far;
pub(crate) mod forces;
pub(crate) mod held;
pub(crate) mod near;
pub(crate) mod pairing_modes;
pub(crate) mod passage;
pub(crate) mod points;
pub(crate) mod ranked;
pub(crate) mod rebound;
pub(crate) mod rebounding;
pub(crate) mod record;
pub(crate) mod refine;
pub(crate) mod solve;
pub(crate) mod span;
pub(crate) mod tangents;
pub(crate) mod weak;

use std::cell::RefCell;

use carom_algebra::solver::Saddle;
use carom_contact::law::Level;
use carom_contact::{Contact, Pairing, Rows, Search, Sliding};
use carom_nonsmooth::{CandidateData, ContactSolver};
use carom_system::ContactPair;

use crate::contact_sums::ContactSums;
use crate::coulomb::{FrictionProblem, Slip};
use crate::driver::attempt::{Attempt, SizeOfMaps};
use crate::driver::paired::PairingMode;
use crate::error::Error;
use crate::interface::InterfaceProblem;
use crate::system::System;
use active::Active;
use closings::Closings;
use far::Far;
use passage::Passage;
use rebound::Rebound;
use weak::{WeakForms, WithWeak};

/// Contacts: search, pairing, points that may carry a force, their laws, the problems of forces and friction, what they did.
pub(crate) struct Contacts {
    pub(crate) pairing_modes: Vec<PairingMode>,
    /// Whether any contact is paired where the unknown leads.
    pub(crate) turns: bool,
    /// Whether sliding is a velocity in steps of this size and stage.
    pub(crate) by_rate: bool,
    /// Solves for the forces of the candidates, and has what was found.
    pub(crate) solver: ContactSolver,
    /// Those of groups of candidates that do not act on each other, where there are several.
    pub(crate) group_solvers: Vec<ContactSolver>,
    /// The problem of contacts where matrices are solved with by iterations.
    pub(crate) saddle: RefCell<Saddle>,
    pub(crate) pairing: Pairing,
    /// Whether its rows are those of the reference places, so that its gaps alone move.
    pub(crate) rows_stand: bool,
    /// Contacts with small sliding where all nodes are at their reference places; empty until they are paired.
    pub(crate) initial: Vec<Pairing>,
    pub(crate) search: Vec<Search>,
    /// Contacts whose primary sides have lost cells, and the number of deleted elements that they are for; empty as long as none has.
    pub(crate) narrowed: Vec<Option<Contact>>,
    pub(crate) narrowed_for: u64,
    pub(crate) active: Active,
    pub(crate) passage: Passage,
    pub(crate) far: Far,
    pub(crate) closings: Closings,
    pub(crate) rebound: Rebound,
    /// Points that may carry a force, ascending.
    pub(crate) candidates: Vec<u32>,
    pub(crate) candidate_data: CandidateData,
    /// Gaps of the candidates at the end of the step without any contact force, m; of an adaptive step.
    pub(crate) free_gaps: Vec<f64>,
    pub(crate) weak: WeakForms,
    pub(crate) with_weak: WithWeak,
    /// Normal and tangential rows of all points, point after point, where there is friction; of steps with iterations.
    pub(crate) stacked: Rows,
    pub(crate) slips: Vec<Slip>,
    pub(crate) failed: Option<InterfaceProblem>,
    pub(crate) failed_friction: Option<FrictionProblem>,
    /// What the points of each contact did in the attempt: those of this process, then of all.
    pub(crate) sums: Vec<ContactSums>,
    /// Room for nodal forces of a contact whose moment is reported, N.
    pub(crate) nodal: Vec<f64>,
}

impl Contacts {
    /// Whether the effective matrix leaves out much of the derivative of the forces: of those between two states what is not
    /// symmetric, of contacts whose points slide how rows and weights move with them.
    pub(crate) fn leaves_out(&self, attempt: &Attempt) -> bool {
        let mut contacts = attempt.system.contacts.iter().enumerate();
        let slides = |(number, contact): (usize, &ContactPair)| {
            contact.sliding == Sliding::Finite && self.turning(number) != 0.0
        };
        attempt.between() || contacts.any(slides)
    }

    /// How long after the start of the step a contact is paired, s.
    pub(crate) fn paired_after(&self, attempt: &Attempt, number: usize) -> f64 {
        let law = attempt.law(&attempt.system.contacts[number]);
        match law.get().level() {
            _ if attempt.between() => 0.5 * attempt.dt,
            Level::Rate => self.captured(attempt, number) * attempt.dt,
            Level::Gap => attempt.dt,
            Level::GapAndRate => attempt.map_of(number).instant(attempt.dt),
        }
    }

    /// The map of the step of this size from the present state, of an explicit scheme before one of the size `next` (both s).
    pub(crate) fn size(&mut self, attempt: &mut Attempt, dt: f64, next: f64) {
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

    /// Those of a system.
    ///
    /// # Errors
    /// A weak form that is not positive definite.
    pub(crate) fn of(system: &System) -> Result<Contacts, Error> {
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
