//! Contacts: search, pairing, points that may carry a force, their laws, the problems of forces and friction, what they did.

mod active;
mod apart;
mod approach;
mod balance;
mod candidates;
mod closing;
mod closings;
mod compressed;
mod deletion;
mod describe;
mod direct;
mod far;
mod forces;
mod held;
mod near;
mod pairing_modes;
mod passage;
mod points;
mod ranked;
mod rebound;
mod rebounding;
pub(crate) mod record;
mod refine;
mod solve;
pub(crate) mod span;
pub(crate) mod tangents;
mod telling;
pub(crate) mod weak;

use std::cell::RefCell;

use carom_algebra::Interrupt;
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
use crate::march::FailedProblem;
use crate::system::System;
use active::Active;
use closings::Closings;
use far::Far;
use passage::Passage;
use rebound::Rebound;
use telling::Telling;
use weak::{WeakForms, WithWeak};

/// Contacts: search, pairing, points that may carry a force, their laws, the problems of forces and friction, what they did.
pub(crate) struct Contacts {
    pairing_modes: Vec<PairingMode>,
    /// Whether any contact is paired where the unknown leads.
    turns: bool,
    /// Whether sliding is a velocity in steps of this size and stage.
    by_rate: bool,
    /// Solves for the forces of the candidates, and has what was found.
    solver: ContactSolver,
    /// Those of groups of candidates that do not act on each other, where there are several.
    group_solvers: Vec<ContactSolver>,
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
    active: Active,
    passage: Passage,
    far: Far,
    closings: Closings,
    rebound: Rebound,
    /// Points that may carry a force, ascending.
    candidates: Vec<u32>,
    telling: Telling,
    candidate_data: CandidateData,
    /// Gaps of the candidates at the end of the step without any contact force, m; of an adaptive step.
    free_gaps: Vec<f64>,
    weak: WeakForms,
    with_weak: WithWeak,
    /// Normal and tangential rows of all points, point after point, where there is friction; of steps with iterations.
    stacked: Rows,
    slips: Vec<Slip>,
    failed: Option<InterfaceProblem>,
    failed_friction: Option<FrictionProblem>,
    /// What the points of each contact did in the attempt: those of this process, then of all.
    sums: Vec<ContactSums>,
    /// Room for nodal forces of a contact whose moment is reported, N.
    nodal: Vec<f64>,
}

impl Contacts {
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
            telling: Telling::of(system),
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

    /// Points of a contact whose weak form gives them a force of another sign than their own.
    pub(crate) fn mixed(&mut self, contact: usize, forces: &[f64]) -> usize {
        self.weak.mixed(contact, forces)
    }

    /// Points that may carry a force, ascending.
    pub(crate) fn candidates(&self) -> &[u32] {
        &self.candidates
    }

    /// The points that the attempt looks at.
    pub(crate) fn active(&self) -> &Active {
        &self.active
    }

    /// Where the points are paired, with their rows.
    pub(crate) fn pairing(&self) -> &Pairing {
        &self.pairing
    }

    /// Rows of N.
    pub(crate) fn normal_rows(&self) -> &Rows {
        &self.pairing.rows
    }

    /// Rows of the tangents that friction has.
    pub(crate) fn tangent_rows(&self, attempt: &Attempt) -> &[Rows] {
        &self.pairing.tangents[..attempt.system.tangents()]
    }

    /// Weak forms and what they add.
    pub(crate) fn weak(&self) -> &WeakForms {
        &self.weak
    }

    /// What the points of each contact did in the attempt.
    pub(crate) fn sums(&self) -> &[ContactSums] {
        &self.sums
    }

    /// Status of friction of each point.
    pub(crate) fn slips(&self) -> &[Slip] {
        &self.slips
    }

    /// Passes of the status loop of the last problem.
    pub(crate) fn passes(&self) -> usize {
        self.solver.passes
    }

    /// The problem that had no solution in the last attempt.
    pub(crate) fn failed_problem(&self) -> Option<FailedProblem<'_>> {
        let normal = self.failed.as_ref().map(FailedProblem::Normal);
        let friction = self.failed_friction.as_ref();
        normal.or(friction.map(FailedProblem::Friction))
    }

    /// Begins an attempt, in which no problem has failed and no point has left its contact yet.
    pub(crate) fn begin_attempt(&mut self) {
        (self.failed, self.failed_friction) = (None, None);
        self.telling.begin();
    }

    /// Forgets which points have passed what they face.
    pub(crate) fn forget_passages(&mut self) {
        self.passage.forget();
    }

    /// Makes the attempt the state.
    pub(crate) fn accept(&mut self) {
        self.active.accept();
    }

    /// Tells that an attempt looks at all points.
    pub(crate) fn leave_active(&mut self) {
        self.active.leave();
    }

    /// Begins the search of a step.
    pub(crate) fn begin_search(&mut self, attempt: &Attempt) {
        self.search.iter_mut().for_each(Search::begin_step);
        self.remember(attempt);
    }

    /// Has the searches remember the edges that points are closed at.
    pub(super) fn remember(&mut self, attempt: &Attempt) {
        let interface = &attempt.state.interface;
        for (number, search) in self.search.iter_mut().enumerate() {
            search.remember(interface.faced_of(attempt.system.points_of(number)));
        }
    }

    /// Ends solves early where this is set.
    pub(crate) fn heed(&mut self, interrupt: &Interrupt) {
        let groups = self.group_solvers.iter_mut();
        std::iter::once(&mut self.solver)
            .chain(groups)
            .for_each(|solver| solver.heed(interrupt));
    }

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
    fn paired_after(&self, attempt: &Attempt, number: usize) -> f64 {
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
}
