//! The solver of steps that are not linear: finite strain, plasticity, friction, sliding, loads in time, static stages.
//!
//! A step has the same table of numbers, the same laws and the same state as in the linear [`Driver`](crate::Driver). Its
//! unknown x is found by Newton's method: each iteration linearises internal forces and gaps at the present x, and solves
//! the interface problem of that linearisation exactly, with its signs,
//!
//! `A Δx - c Nᵀ P = r(x)`, `A = inertia.x M + force.x K(x) + damping - c ∂(Nᵀ P)/∂x`, `0 ≤ q(x) + s N Δx ⟂ P ≥ 0`.
//!
//! A is factorised at the start of a step, and again where keeping it would cost more. The step ends when the forces
//! balance and every point obeys its law in the configuration reached. A step that finds no end is taken in halves.

mod ahead;
mod balance;
mod carried;
mod contacts;
mod effective;
mod floating;
mod friction;
mod held;
mod linked;
mod loads;
mod mixing;
mod obstacles;
mod rigid;
mod solve;
mod stable;
mod start;
mod supports;

use std::sync::Arc;
use std::time::Instant;

use carom_bodies::{Placement, Scratch, Stored};
use carom_contact::{Pairing, Rows, Search};

use crate::coulomb::{Coulomb, FrictionProblem, Slip};
use crate::driver::{Costs, Phases, WeakForms, WithWeak};
use crate::error::Error;
use crate::interface::{Candidate, Interface, InterfaceProblem};
use crate::march::{FailedProblem, Stepper};
use crate::small::Watch;
use crate::state::{ContactReport, State, StepReport, empty_state};
use crate::step_map::StepMap;
use crate::system::System;
use carried::Carried;
use effective::Effective;
use floating::Floating;
use mixing::Mixing;
use solve::Pace;
use supports::Jump;

pub(crate) use obstacles::Pushed;

/// Takes steps of systems that are not linear.
pub struct Newton {
    system: Arc<System>,
    /// Size of the attempt under way, s, and its map.
    dt: f64,
    map: StepMap,
    effective: Effective,
    floating: Floating,
    interface: Interface,
    pairing: Pairing,
    /// Contacts with small sliding where all nodes are at their reference places; empty until they are paired.
    initial: Vec<Pairing>,
    search: Vec<Search>,
    watch: Watch,
    /// Points that may carry a force, ascending.
    candidates: Vec<u32>,
    candidate_data: Vec<Candidate>,
    coulomb: Coulomb,
    weak: WeakForms,
    with_weak: WithWeak,
    /// Normal and tangential rows of all points, point after point, where there is friction.
    stacked: Rows,
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
    /// Forces of links to other zones in the step, N; empty without links.
    link_force: Vec<f64>,
    /// Internal forces in the balance of the step, N.
    balanced: Vec<f64>,
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
    /// Loads, inertia, internal and damping forces at x, N.
    load: Vec<f64>,
    inertia: Vec<f64>,
    internal: Vec<f64>,
    damping: Vec<f64>,
    contact: Vec<f64>,
    residual: Vec<f64>,
    half: Vec<f64>,
    /// The unknown before an iteration, and its motion and begun solve without contact forces.
    before: Vec<f64>,
    free: Vec<f64>,
    begun: Vec<f64>,
    /// A configuration or an acceleration.
    place: Vec<f64>,
    /// Velocity at the instant of the internal forces.
    rate: Vec<f64>,
    /// Displacement at the end of the step, predicted; empty where no contact is paired ahead.
    ahead: Vec<f64>,
    work: Vec<f64>,
    /// Histories of the bodies at the end of the attempt.
    history: Vec<f64>,
}

impl Newton {
    /// Sets the initial state.
    ///
    /// # Errors
    /// A mass matrix that is not positive definite, elements that are turned inside out, a static stage of a body that
    /// neither supports nor contacts could hold.
    pub fn new(system: Arc<System>) -> Result<Newton, Error> {
        let n = system.unknowns();
        let zeros = || vec![0.0; n];
        let state = empty_state(&system);
        let mut newton = Newton {
            dt: 0.0,
            map: system.scheme.get().step_map(system.dt),
            effective: Effective::new(&system),
            floating: Floating::new(&system)?,
            interface: Interface::default(),
            pairing: Pairing::default(),
            initial: vec![Pairing::default(); system.contacts.len()],
            search: system.contacts.iter().map(|_| Search::default()).collect(),
            watch: Watch::new(&system),
            candidates: Vec::new(),
            candidate_data: Vec::new(),
            coulomb: Coulomb::default(),
            weak: WeakForms::new(&system)?,
            with_weak: WithWeak::default(),
            stacked: Rows::default(),
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
                load: zeros(),
                inertia: zeros(),
                internal: zeros(),
                damping: zeros(),
                contact: zeros(),
                residual: zeros(),
                half: zeros(),
                before: zeros(),
                free: zeros(),
                begun: zeros(),
                place: zeros(),
                rate: zeros(),
                ahead: Vec::new(),
                work: zeros(),
                history: state.motion.history.clone(),
            },
            next: state.clone(),
            state,
            stored: Stored::default(),
            link_force: Vec::new(),
            balanced: zeros(),
            left_over: 0.0,
            phases: Phases::default(),
            system,
        };
        let system = Arc::clone(&newton.system);
        newton.restart(&system.initial_displacement, &system.initial_velocity)?;
        Ok(newton)
    }

    /// A solver that goes on from a saved state.
    ///
    /// # Errors
    /// As [`Newton::new`].
    pub fn resume(system: Arc<System>, state: State) -> Result<Newton, Error> {
        let mut newton = Newton::new(system)?;
        newton.next.clone_from(&state);
        newton.state = state;
        Ok(newton)
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
            factors: self.effective.stats().into_iter().cloned().collect(),
            work: self.effective.work(),
            compliance_bytes: self.effective.compliance_bytes(),
            force_sweeps: self.force_sweeps,
            element_updates: (self.force_sweeps * elements) as u64,
            phases: self.phases,
        }
    }

    /// Takes one step: whole, or in halves of halves where it finds no equilibrium, and of an explicit scheme where elements
    /// have become too small for it.
    ///
    /// # Errors
    /// No equilibrium with the smallest part of the step, or one that is not stable; the state is then the one before the step.
    pub fn step(&mut self) -> Result<(), Error> {
        let (taken, first) = (self.state.step, self.state.time);
        let (end, size) = (self.end_of_step(), self.size_of_step());
        let whole = self.stable_level(end - first)?;
        let mut control = self.state.control;
        let (mut done, mut level) = (0u64, whole);
        // a cause that an attempt has named says more than the end of the last one
        let mut unheld: Option<Error> = None;
        // kept only by a step that goes in parts
        let mut start: Option<State> = None;
        let parts = 1u64 << self.system.nonlinear.iteration.halvings;
        self.report.attempts = 0;
        self.report.samples.clear();
        while done < parts {
            let part = parts >> level;
            let to = first + (end - first) * ((done + part) as f64 / parts as f64);
            self.report.attempts += 1;
            match self.attempt(size * (part as f64 / parts as f64)) {
                Ok(()) => {
                    done += part;
                    if part < parts && !self.is_static() {
                        self.report.add_part(to, self.dt);
                    }
                    if done < parts {
                        start.get_or_insert_with(|| self.state.clone());
                        std::mem::swap(&mut self.state, &mut self.next);
                        self.state.time = to;
                        // parts of a step are of the same stage
                        (self.state.step, self.state.control) = (taken, control);
                    }
                    while level > whole
                        && done.is_multiple_of(2 * part)
                        && done.is_multiple_of(parts >> (level - 1))
                    {
                        level -= 1;
                    }
                }
                Err(error) if level < self.system.nonlinear.iteration.halvings => {
                    tracing::debug!("step {}: {error}; halved", taken + 1);
                    if matches!(error, Error::Unheld { .. }) {
                        unheld.get_or_insert(error);
                    }
                    control.failed += 1;
                    level += 1;
                }
                Err(error) => {
                    if let Some(start) = start {
                        self.state = start;
                    }
                    return Err(unheld.unwrap_or(error));
                }
            }
        }
        control.take(None, (taken, first, size), self.system.dt);
        self.next.step = taken + 1;
        self.next.time = end;
        control.pace = self.pace.fresh;
        self.next.control = control;
        std::mem::swap(&mut self.state, &mut self.next);
        self.report.join_parts();
        self.tell(size);
        Ok(())
    }

    /// The instant at which the next step ends, s: instants of equal steps are products, not sums.
    fn end_of_step(&self) -> f64 {
        let (step, dt) = (self.state.step, self.system.dt);
        match self.system.nonlinear.preload {
            Some(preload) if step < preload.steps => {
                preload.end * ((step + 1) as f64 / preload.steps as f64)
            }
            Some(preload) => preload.end + (step + 1 - preload.steps) as f64 * dt,
            None => (step + 1) as f64 * dt,
        }
    }

    /// Size of the next step, s: the same bits for equal steps, so that a constant matrix is.
    fn size_of_step(&self) -> f64 {
        match self.system.nonlinear.preload {
            Some(preload) if self.is_static() => preload.end / preload.steps as f64,
            _ => self.system.dt,
        }
    }

    /// Whether the step from the present state is static.
    fn is_static(&self) -> bool {
        let preload = self.system.nonlinear.preload;
        preload.is_some_and(|preload| self.state.step < preload.steps)
    }

    /// Computes the next state from the state, a step of `dt` further.
    fn attempt(&mut self, dt: f64) -> Result<(), Error> {
        (self.failed, self.failed_friction) = (None, None);
        self.size(dt);
        self.begin_stage()?;
        self.attempt_after_jump(|newton| {
            newton.solve_on_the_clock()?;
            let (solved, forces) = (Instant::now(), newton.phases.forces);
            newton.advance()?;
            newton.balance();
            newton.record();
            let forces = newton.phases.forces - forces;
            newton.phases.balance += solved.elapsed().saturating_sub(forces);
            Ok(())
        })?;
        self.next
            .motion
            .finite(self.state.step + 1, self.state.time)
    }

    /// Solves, and counts as contact the time that is not counted elsewhere; that of attempts that fail too.
    fn solve_on_the_clock(&mut self) -> Result<(), Error> {
        let (begin, before) = (Instant::now(), self.phases);
        let solved = self.solve();
        let counted = |phases: &Phases| {
            phases.factorisation + phases.forces + phases.sweeps + phases.friction
        };
        let counted = counted(&self.phases) - counted(&before);
        self.phases.contact += begin.elapsed().saturating_sub(counted);
        solved
    }

    /// Internal forces of all bodies where `place` says, into `out`; histories into the scratch history.
    ///
    /// # Errors
    /// An element turned inside out, a material without stress.
    fn internal(&mut self, (place, from): (Which, bool), dt: f64) -> Result<Stored, Error> {
        let begin = Instant::now();
        let system = &*self.system;
        let Vectors {
            place: configuration,
            rate,
            internal,
            history,
            ..
        } = &mut self.vectors;
        let (u, v) = match place {
            Which::Place => (&configuration[..], &rate[..]),
            Which::Next => (&self.next.motion.u[..], &self.next.motion.v[..]),
        };
        let from = from.then_some(&self.state.motion.u[..]);
        internal.fill(0.0);
        self.force_sweeps += 1;
        let mut sum = Stored::default();
        for (k, body) in system.bodies.iter().enumerate() {
            let range = system.nonlinear.histories[k].clone();
            let at = Placement {
                u,
                v,
                from,
                dt,
                old: &self.state.motion.history[range.clone()],
            };
            let stored = body.force(&at, &mut history[range], &mut self.scratch[k], internal)?;
            sum.strain += stored.strain;
            sum.hardening += stored.hardening;
            sum.dissipated += stored.dissipated;
        }
        self.phases.forces += begin.elapsed();
        Ok(sum)
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

impl Stepper for Newton {
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
