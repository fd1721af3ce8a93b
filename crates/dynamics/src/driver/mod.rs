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
mod attempt;
mod balance;
mod candidates;
mod carried;
mod contacts;
mod effective;
mod floating;
mod friction;
mod held;
mod identity;
mod impulse;
mod landing;
pub(crate) mod linked;
mod linking;
mod links;
mod loads;
mod matrices;
mod mixing;
mod obstacles;
mod part_matrix;
mod predictor;
mod projection;
pub(crate) mod record;
mod residual;
mod restoring;
mod rigid;
mod solve;
mod springs;
mod stable;
mod start;
mod step;
mod supports;
mod weak;

use std::sync::Arc;

use carom_bodies::{Scratch, Stored};
use carom_contact::{Contact, Pairing, Search};

use crate::costs::{Costs, Phases};
use crate::coulomb::{Coulomb, FrictionProblem, Slip};
use crate::error::Error;
use crate::interface::{Candidate, Interface, InterfaceProblem};
use crate::march::{FailedProblem, Stepper};
use crate::scheme::EnergyIdentity;
use crate::small::Watch;
use crate::state::{ContactReport, State, StepReport, empty_state};
use crate::system::Maps;
use crate::system::System;
use carried::Carried;
use effective::Effective;
use floating::Floating;
use impulse::Impulses;
use links::Multipliers;
use mixing::Mixing;
use predictor::Predictor;
use projection::Projected;
use restoring::Restoring;
use solve::Pace;
use supports::Jump;
use weak::{WeakForms, WithWeak};

pub(crate) use obstacles::Pushed;

/// Takes steps.
pub struct Driver {
    system: Arc<System>,
    /// Size of the attempt under way, s, and the maps of the zones.
    dt: f64,
    maps: Maps,
    /// The energy identity of the scheme; none of a static step, or where none is known.
    identity: Option<EnergyIdentity>,
    effective: Effective,
    floating: Floating,
    /// Every which step is dropped once, in tests.
    forced: Option<u64>,
    /// Size of the next step that an event forces, in tests, s.
    unplanned: Option<f64>,
    /// Solver of the stages with the mass alone; none where there is no such stage.
    impulses: Option<Impulses>,
    projected: Projected,
    predictor: Predictor,
    restoring: Restoring,
    interface: Interface,
    pairing: Pairing,
    /// Contacts with small sliding where all nodes are at their reference places; empty until they are paired.
    initial: Vec<Pairing>,
    search: Vec<Search>,
    watch: Watch,
    /// Points that may carry a force, ascending.
    candidates: Vec<u32>,
    candidate_data: Vec<Candidate>,
    /// Gaps of the candidates at the end of the step without any contact force, m; of an adaptive step.
    free_gaps: Vec<f64>,
    coulomb: Coulomb,
    weak: WeakForms,
    with_weak: WithWeak,
    /// Normal and tangential rows of all points, point after point, where there is friction.
    stacked: carom_contact::Rows,
    slips: Vec<Slip>,
    /// Buffers of the bodies.
    scratch: Vec<Scratch>,
    force_sweeps: usize,
    /// Residuals of the iterations of the last attempt, relative.
    residuals: Vec<f64>,
    pace: Pace,
    mixing: Mixing,
    carried: Carried,
    jump: Jump,
    failed: Option<InterfaceProblem>,
    failed_friction: Option<FrictionProblem>,
    state: State,
    next: State,
    report: StepReport,
    vectors: Vectors,
    /// Energies of the iteration.
    stored: Stored,
    /// Forces of links in the step, N; empty without links.
    link_force: Vec<f64>,
    multipliers: Multipliers,
    /// Whether the residual without the forces of links, and the pairing, are those of the step.
    prepared: bool,
    /// Norm of the forces that the iterations of the step may leave unbalanced, N.
    left_over: f64,
    phases: Phases,
}

/// System vectors of the iterations.
#[derive(Default)]
struct Vectors {
    /// The unknown.
    x: Vec<f64>,
    dx: Vec<f64>,
    /// What supports that move add to the unknown in the first iteration.
    jump: Vec<f64>,
    /// Whether any of it is not zero.
    jumps: bool,
    /// Loads, inertia, internal and damping forces at x, N.
    load: Vec<f64>,
    inertia: Vec<f64>,
    internal: Vec<f64>,
    damping: Vec<f64>,
    /// Internal forces in the balance of the step, N.
    balanced: Vec<f64>,
    /// The residual without the forces of links, N; empty without links.
    unlinked: Vec<f64>,
    /// Acceleration that the contact forces give by themselves, m/s²; empty of schemes that do not use it.
    push: Vec<f64>,
    contact: Vec<f64>,
    residual: Vec<f64>,
    half: Vec<f64>,
    /// The unknown before an iteration.
    before: Vec<f64>,
    /// A configuration or an acceleration.
    place: Vec<f64>,
    /// Velocity at the instant of the internal forces.
    rate: Vec<f64>,
    /// Displacement at the end of the step at the x of the iteration; empty without rotations.
    end: Vec<f64>,
    /// Displacement at the end of the step, predicted; empty where no contact is paired ahead.
    ahead: Vec<f64>,
    work: Vec<f64>,
    /// Histories of the bodies at the end of the attempt.
    history: Vec<f64>,
}

impl Driver {
    /// Sets the initial state.
    ///
    /// # Errors
    /// A matrix that is not positive definite, elements that are turned inside out, a static stage of a body that
    /// neither supports nor contacts could hold.
    pub fn new(system: Arc<System>) -> Result<Driver, Error> {
        let (n, points) = (system.unknowns(), system.points());
        let zeros = || vec![0.0; n];
        let state = empty_state(&system);
        let scheme = system.scheme.get();
        let maps = Maps::new(&system, system.dt, system.dt);
        let projects = |contact: &Contact| contact.law.projects();
        let stages = scheme.projects_predictor()
            || scheme.restores_contact_work()
            || candidates::sums_compliances(&system, maps.first());
        let staged = stages && points > 0 || system.contacts.iter().any(projects);
        let push = match maps.first().uses_contact_acceleration() {
            true => zeros(),
            false => Vec::new(),
        };
        let mut driver = Driver {
            dt: 0.0,
            maps,
            identity: None,
            effective: Effective::new(),
            floating: Floating::new(&system)?,
            forced: None,
            unplanned: None,
            impulses: match staged {
                true => Some(Impulses::new(&system)?),
                false => None,
            },
            projected: Projected::new(points),
            predictor: Predictor::default(),
            restoring: Restoring::default(),
            interface: Interface::default(),
            pairing: Pairing::default(),
            initial: vec![Pairing::default(); system.contacts.len()],
            search: system.contacts.iter().map(|_| Search::default()).collect(),
            watch: Watch::new(&system),
            candidates: Vec::new(),
            candidate_data: Vec::new(),
            free_gaps: Vec::new(),
            coulomb: Coulomb::default(),
            weak: WeakForms::new(&system)?,
            with_weak: WithWeak::default(),
            stacked: carom_contact::Rows::default(),
            slips: Vec::new(),
            scratch: system.bodies.iter().map(|_| Scratch::default()).collect(),
            force_sweeps: 0,
            residuals: Vec::new(),
            pace: Pace::default(),
            mixing: Mixing::default(),
            carried: Carried::default(),
            jump: Jump::default(),
            failed: None,
            failed_friction: None,
            report: StepReport {
                contacts: vec![ContactReport::default(); system.contacts.len()],
                ..StepReport::default()
            },
            vectors: Vectors {
                x: zeros(),
                dx: zeros(),
                jump: zeros(),
                jumps: false,
                load: zeros(),
                inertia: zeros(),
                internal: zeros(),
                damping: zeros(),
                balanced: zeros(),
                unlinked: Vec::new(),
                push,
                contact: zeros(),
                residual: zeros(),
                half: zeros(),
                before: zeros(),
                place: zeros(),
                rate: zeros(),
                end: Vec::new(),
                ahead: Vec::new(),
                work: zeros(),
                history: state.motion.history.clone(),
            },
            next: state.clone(),
            state,
            stored: Stored::default(),
            link_force: match system.link_rows.is_empty() {
                true => Vec::new(),
                false => zeros(),
            },
            multipliers: Multipliers::new(&system),
            prepared: false,
            left_over: 0.0,
            phases: Phases::default(),
            system,
        };
        let system = Arc::clone(&driver.system);
        driver.restart(&system.initial_displacement, &system.initial_velocity)?;
        Ok(driver)
    }

    /// A solver that goes on from a saved state.
    ///
    /// # Errors
    /// As [`Driver::new`].
    pub fn resume(system: Arc<System>, state: State) -> Result<Driver, Error> {
        let mut driver = Driver::new(system)?;
        driver.next.clone_from(&state);
        driver.state = state;
        Ok(driver)
    }

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
        Costs {
            factors: self.effective.stats().cloned().collect(),
            work: self.effective.work(),
            compliance_bytes: self.effective.compliance_bytes(),
            force_sweeps: self.force_sweeps,
            element_updates: (self.force_sweeps * elements) as u64,
            phases: self.phases,
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

impl Stepper for Driver {
    fn step(&mut self) -> Result<(), Error> {
        self.step()
    }

    fn system(&self) -> &System {
        self.system()
    }

    fn state(&self) -> &State {
        self.state()
    }

    fn report(&self) -> &StepReport {
        self.report()
    }

    fn saved(&self) -> Result<Vec<u8>, Error> {
        self.state().to_bytes()
    }

    fn costs(&self) -> Costs {
        self.costs()
    }

    fn failed_problem(&self) -> Option<FailedProblem<'_>> {
        let friction = self.failed_friction.as_ref();
        let normal = self.failed.as_ref().map(FailedProblem::Normal);
        normal.or(friction.map(FailedProblem::Friction))
    }
}
