//! The one driver of all steps: free motion, interface problem, correction, balance.
//!
//! What it holds besides the state is a function of the system and the state, or scratch: a run goes on from a saved
//! state with the same bits.

mod attempt;
mod balance;
mod contacts;
mod impulse;
mod landing;
pub(crate) mod linked;
mod predictor;
mod projection;
mod restoring;
mod weak;

pub(crate) use balance::{contact_report, crush_energy};
pub(crate) use contacts::{instant, least_gap, looks_ahead, on_row, part_way};
pub(crate) use weak::{WeakForms, WithWeak};

use std::sync::Arc;
use std::time::{Duration, Instant};

use carom_algebra::solver::FactorStats;
use carom_bodies::Scratch;
use carom_contact::law::{Level, Status};
use carom_contact::{Contact, Rows, Search};

use crate::compliance::Compliance;
use crate::control::Control;
use crate::error::Error;
use crate::exchange::Exchange;
use crate::interface::{Candidate, Interface, InterfaceProblem};
use crate::ledger::{Energies, Ledger, reactions};
use crate::operator::Operators;
use crate::records::Records;
use crate::resultant::Resultant;
use crate::scheme::EnergyIdentity;
use crate::small::Watch;
use crate::state::{ContactReport, State, StepReport, empty_state};
use crate::step_map::{Row, StepMap};
use crate::system::System;
use attempt::Sized;
use balance::{energies, lagged, remembered};
use contacts::sums_compliances;
use impulse::Impulses;
use linked::Linked;
use predictor::Predictor;
use projection::Projected;
use restoring::Restoring;

/// Takes steps.
pub struct Driver {
    system: Arc<System>,
    /// Size of the step that the fields down to the interface are for, s.
    dt: f64,
    map: StepMap,
    identity: Option<EnergyIdentity>,
    operators: Operators,
    compliance: Compliance,
    weak: WeakForms,
    /// D with the compliance of the weak forms.
    with_weak: WithWeak,
    interface: Interface,
    /// The same for other step sizes, the last used last.
    kept: Vec<Sized>,
    /// Work with sizes that are not kept any more.
    retired: Work,
    /// Every which step is dropped once, in tests.
    forced: Option<u64>,
    /// Size of the next step that an event forces, in tests, s.
    unplanned: Option<f64>,
    forces: Forces,
    /// Solver of the stages with the mass alone; none where there is no such stage.
    impulses: Option<Impulses>,
    projected: Projected,
    predictor: Predictor,
    restoring: Restoring,
    /// Rows at zero displacement of contacts with small sliding.
    initial_rows: Vec<Option<Rows>>,
    search: Vec<Search>,
    watch: Watch,
    rows: Rows,
    /// For each point, the configuration in which it is paired.
    captured: Vec<Row>,
    candidates: Vec<u32>,
    candidate_data: Vec<Candidate>,
    /// Gaps of the candidates at the end of the step without any contact force, m.
    free_gaps: Vec<f64>,
    /// Strain energy where the residual was taken, J.
    predicted: f64,
    /// Forces of links in the step; none without links.
    linked: Option<Linked>,
    /// The interface problem that made the last step fail.
    failed: Option<InterfaceProblem>,
    state: State,
    next: State,
    report: StepReport,
    vectors: Vectors,
    phases: Phases,
}

/// Internal forces of all bodies with their buffers.
struct Forces {
    scratch: Vec<Scratch>,
    sweeps: usize,
}

impl Forces {
    /// f(u) into `f`; returns U(u).
    fn evaluate(&mut self, system: &System, u: &[f64], f: &mut [f64]) -> f64 {
        f.fill(0.0);
        self.sweeps += 1;
        let bodies = system.bodies.iter().zip(&mut self.scratch);
        bodies
            .map(|(body, scratch)| body.internal_force(u, scratch, f))
            .sum()
    }
}

#[derive(Default)]
struct Vectors {
    residual: Vec<f64>,
    half: Vec<f64>,
    x: Vec<f64>,
    known: Vec<f64>,
    work: Vec<f64>,
    inertia: Vec<f64>,
    contact_acceleration: Vec<f64>,
    /// Displacement at the end of the step, predicted; empty where no contact asks for it.
    ahead: Vec<f64>,
}

/// Wall time spent so far by phase of the step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Phases {
    /// Analysis and factorisation, before the first step.
    pub factorisation: Duration,
    /// Internal forces.
    pub forces: Duration,
    /// Forward and backward sweeps of the free motion and the correction.
    pub sweeps: Duration,
    /// Pairing, columns, interface problem without friction.
    pub contact: Duration,
    /// Columns and interface problem of contacts with friction.
    pub friction: Duration,
    /// Balance, records, vector updates.
    pub balance: Duration,
}

/// Counts of what factors were made and used for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Factors computed.
    pub factorisations: usize,
    /// Triangular sweeps, forward or backward.
    pub sweeps: usize,
    /// Columns A⁻¹ Nᵀ computed.
    pub columns: usize,
}

/// What the run cost so far.
#[derive(Clone, Debug, Default)]
pub struct Costs {
    /// One entry per connected part with a factor, for the present size of the step.
    pub factors: Vec<FactorStats>,
    /// Over all sizes of the step.
    pub work: Work,
    /// Bytes of columns and compliance for the present size of the step.
    pub compliance_bytes: usize,
    /// Internal-force sweeps.
    pub force_sweeps: usize,
    /// Elements whose internal forces were computed, over all sweeps.
    pub element_updates: u64,
    /// Times.
    pub phases: Phases,
}

impl Costs {
    /// Adds the costs of another driver.
    pub(crate) fn add(&mut self, other: Costs) {
        self.factors.extend(other.factors);
        let (work, its) = (&mut self.work, other.work);
        work.factorisations += its.factorisations;
        work.sweeps += its.sweeps;
        work.columns += its.columns;
        self.compliance_bytes += other.compliance_bytes;
        self.force_sweeps += other.force_sweeps;
        self.element_updates += other.element_updates;
        let (phases, its) = (&mut self.phases, other.phases);
        phases.factorisation += its.factorisation;
        phases.forces += its.forces;
        phases.sweeps += its.sweeps;
        phases.contact += its.contact;
        phases.friction += its.friction;
        phases.balance += its.balance;
    }

    /// Solutions with a factor: pairs of a forward and a backward sweep.
    pub fn solves(&self) -> u64 {
        self.work.sweeps as u64 / 2
    }
}

impl Driver {
    /// Factorises the effective matrix of each part and sets the initial state.
    ///
    /// # Errors
    /// A matrix that is not positive definite.
    pub fn new(system: Arc<System>) -> Result<Driver, Error> {
        if let Some(contact) = system.contacts.iter().find(|contact| contact.moves()) {
            return Err(Error::MovingObstacle {
                contact: contact.name.clone(),
            });
        }
        let scheme = system.scheme.get();
        let (map, identity) = (
            scheme.step_map(system.dt),
            scheme.energy_identity(system.dt),
        );
        let begin = Instant::now();
        let operators = Operators::new(&system, map.inertia.x, map.force.x, "effective matrix")?;
        let factorisation = begin.elapsed();
        let (n, points) = (system.unknowns(), system.points());
        let zeros = || vec![0.0; n];
        let projects = |contact: &Contact| contact.law.projects();
        let stages = scheme.projects_predictor()
            || scheme.restores_contact_work()
            || sums_compliances(&system, &map);
        let staged = stages && points > 0 || system.contacts.iter().any(projects);
        let impulses = match staged {
            true => Some(Impulses::new(&system)?),
            false => None,
        };
        let mut driver = Driver {
            dt: system.dt,
            map,
            identity,
            operators,
            compliance: Compliance::new(points),
            weak: WeakForms::new(&system)?,
            with_weak: WithWeak::default(),
            interface: Interface::default(),
            kept: Vec::new(),
            retired: Work::default(),
            forced: None,
            unplanned: None,
            forces: Forces {
                scratch: system.bodies.iter().map(|_| Scratch::default()).collect(),
                sweeps: 0,
            },
            impulses,
            projected: Projected::new(points),
            predictor: Predictor::default(),
            restoring: Restoring::default(),
            initial_rows: Vec::new(),
            search: system.contacts.iter().map(|_| Search::default()).collect(),
            watch: Watch::new(&system),
            rows: Rows::default(),
            captured: Vec::new(),
            candidates: Vec::new(),
            candidate_data: Vec::new(),
            free_gaps: Vec::new(),
            predicted: 0.0,
            linked: None,
            failed: None,
            state: empty_state(&system),
            next: empty_state(&system),
            report: StepReport {
                contacts: vec![ContactReport::default(); system.contacts.len()],
                ..StepReport::default()
            },
            vectors: Vectors {
                residual: zeros(),
                half: zeros(),
                x: zeros(),
                known: zeros(),
                work: zeros(),
                inertia: zeros(),
                contact_acceleration: zeros(),
                ahead: Vec::new(),
            },
            phases: Phases {
                factorisation,
                ..Phases::default()
            },
            system,
        };
        driver.pair_initially();
        let system = Arc::clone(&driver.system);
        driver.restart(&system.initial_displacement, &system.initial_velocity)?;
        Ok(driver)
    }

    /// A driver that goes on from a saved state.
    ///
    /// # Errors
    /// As [`Driver::new`].
    pub fn resume(system: Arc<System>, state: State) -> Result<Driver, Error> {
        let mut driver = Driver::new(system)?;
        driver.next.clone_from(&state);
        driver.state = state;
        Ok(driver)
    }

    /// Begins anew from another initial motion: displacement in m and velocity in m/s, one entry per unknown; those of
    /// held unknowns are zero whatever is given.
    ///
    /// # Errors
    /// As [`Driver::new`].
    pub fn restart(&mut self, displacement: &[f64], velocity: &[f64]) -> Result<(), Error> {
        self.state = empty_state(&self.system);
        self.begin_linked();
        let held = |values: &[f64], fixed: &[bool], out: &mut [f64]| {
            for i in 0..out.len() {
                out[i] = if fixed[i] { 0.0 } else { values[i] };
            }
        };
        let motion = &mut self.state.motion;
        held(displacement, &self.system.fixed, &mut motion.u);
        held(velocity, &self.system.fixed, &mut motion.v);
        self.start()
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

    /// The interface problem that made a step fail, to be kept and solved by itself.
    pub fn failed_problem(&self) -> Option<&InterfaceProblem> {
        self.failed.as_ref()
    }

    /// What the run cost so far.
    pub fn costs(&self) -> Costs {
        let elements: usize = self.system.bodies.iter().map(|b| b.cells().len()).sum();
        Costs {
            factors: self
                .operators
                .operators
                .iter()
                .filter_map(|operator| operator.stats().cloned())
                .collect(),
            work: self.work(),
            compliance_bytes: self.compliance.bytes(),
            force_sweeps: self.forces.sweeps,
            element_updates: (self.forces.sweeps * elements) as u64,
            phases: self.phases,
        }
    }

    /// Completes the initial state from its displacement and velocity: internal forces, the acceleration in balance without
    /// contact forces, gaps, energies.
    fn start(&mut self) -> Result<(), Error> {
        let system = Arc::clone(&self.system);
        let identity = self.identity.unwrap_or_default();
        let motion = &mut self.state.motion;
        let strain = self
            .forces
            .evaluate(&system, &motion.u, &mut motion.internal_force);
        if self.map.has_memory() {
            motion.memory.clone_from(&motion.v);
        }
        if system.scheme.get().keeps_acceleration() {
            let mut mass = Operators::new(&system, 1.0, 0.0, "mass matrix")?;
            for i in 0..system.unknowns() {
                let link = motion.link_force.get(i).copied().unwrap_or(0.0);
                let balance = system.load[i] - motion.internal_force[i] + link;
                self.vectors.residual[i] = if system.fixed[i] { 0.0 } else { balance };
            }
            mass.begin(&self.vectors.residual, &mut self.vectors.half);
            mass.end(&mut self.vectors.half, &mut motion.a);
        }
        let motion = &self.state.motion;
        let memory = remembered(
            &system,
            &identity,
            &motion.memory,
            &mut self.vectors,
            &mut self.forces,
        );
        let lagged = lagged(
            &system,
            &identity,
            (motion, strain),
            &mut self.vectors,
            &mut self.forces,
        );
        let work = &mut self.vectors.work;
        let energies = Energies {
            memory,
            lagged,
            ..energies(&system, motion, strain, work, identity.inertia != 0.0)
        };
        system.mass.multiply(&motion.a, &mut self.vectors.inertia);
        work.copy_from_slice(&motion.internal_force);
        reactions(
            &system,
            &self.map,
            motion,
            motion,
            &self.vectors.inertia,
            work,
        );
        let supports = Resultant::of(&system, work);
        for (i, force) in work.iter_mut().enumerate() {
            *force += system.load[i] + motion.link_of(i);
        }
        system.mass.multiply(&motion.v, &mut self.vectors.known);
        let none = vec![0.0; work.len()];
        let exchange = Exchange::start(&system, &self.vectors.known, [work, &none]);
        let loads = Resultant::of(&system, &system.load);
        let none = Resultant::default();
        let link = Resultant::of(&system, &self.state.motion.link_force);
        let forces = [loads, none, supports, none, link];
        self.state.ledger = Ledger::start(&energies, &identity, forces);
        self.state.control = Control::start(system.dt);
        self.state.records = Records::of(&system);
        self.state.exchange = exchange;
        self.place(true);
        for point in 0..system.points() {
            self.state.interface.gap[point] = self.rows.gap(point);
            self.state.interface.rate[point] = self.rows.product(point, &self.state.motion.v);
        }
        self.next.clone_from(&self.state);
        self.tell();
        Ok(())
    }

    /// Computes the next state from the state.
    fn attempt(&mut self) -> Result<(), Error> {
        self.prepare()?;
        self.complete()
    }

    /// The part of a step that the forces of links do not change: residual, pairing, candidates.
    pub(crate) fn prepare(&mut self) -> Result<(), Error> {
        let begin = Instant::now();
        self.predict()?;
        self.predicted = self.residual();
        self.renew_link();
        let forces = Instant::now();
        self.look_ahead();
        self.place(false);
        self.choose_candidates();
        self.phases.forces += forces - begin;
        self.phases.contact += forces.elapsed();
        Ok(())
    }

    /// The rest of a step, with the forces of links as they stand.
    pub(crate) fn complete(&mut self) -> Result<(), Error> {
        let begin = Instant::now();
        let mut sweeps = Duration::ZERO;
        self.add_link_force();
        loop {
            let begin = Instant::now();
            self.operators
                .begin(&self.vectors.residual, &mut self.vectors.half);
            sweeps += begin.elapsed();
            self.solve_interface()?;
            let begin = Instant::now();
            self.operators
                .end(&mut self.vectors.half, &mut self.vectors.x);
            sweeps += begin.elapsed();
            if !self.add_missed() {
                break;
            }
        }
        let solved = Instant::now();
        self.advance();
        let strain = self.end_forces(self.predicted);
        let ended = Instant::now();
        self.balance(strain);
        self.project(strain)?;
        self.restore(strain);
        self.record();
        self.next.motion.finite(self.next.step, self.next.time)?;
        self.phases.forces += ended - solved;
        self.phases.sweeps += sweeps;
        self.phases.contact += (solved - begin).saturating_sub(sweeps);
        self.phases.balance += ended.elapsed();
        Ok(())
    }

    /// Residual of the momentum balance with x = 0; returns the strain energy at the place of the internal forces.
    fn residual(&mut self) -> f64 {
        let (system, motion) = (&*self.system, &self.state.motion);
        let Vectors {
            residual,
            known,
            work,
            ..
        } = &mut self.vectors;
        self.map.force.known(motion, known);
        let energy = self.forces.evaluate(system, known, residual);
        self.map.inertia.known(motion, known);
        system.mass.multiply(known, work);
        // the internal forces are needed again at the end of an explicit step
        self.next.motion.internal_force.copy_from_slice(residual);
        for i in 0..residual.len() {
            residual[i] = if system.fixed[i] {
                0.0
            } else {
                system.load[i] - work[i] - residual[i]
            };
        }
        energy
    }

    /// Writes the motion and the interface at the end of the step.
    fn advance(&mut self) {
        let system = &*self.system;
        let (old, map) = (&self.state.motion, &self.map);
        let new = &mut self.next.motion;
        let Vectors {
            x,
            contact_acceleration: c,
            ..
        } = &self.vectors;
        map.displacement.whole(old, x, c, &mut new.u);
        map.velocity.whole(old, x, c, &mut new.v);
        map.acceleration.whole(old, x, c, &mut new.a);
        if map.has_memory() {
            map.memory.whole(old, x, c, &mut new.memory);
        }
        for i in system.massless.iter().map(|&unknown| unknown as usize) {
            (new.v[i], new.a[i]) = ((new.u[i] - old.u[i]) / self.dt, 0.0);
        }
        let interface = &mut self.next.interface;
        interface.force.fill(0.0);
        interface.status.fill(Status::Open);
        for (k, &point) in self.candidates.iter().enumerate() {
            interface.force[point as usize] = self.interface.forces[k];
            interface.status[point as usize] = self.interface.statuses[k];
        }
        interface.carried.clone_from(&interface.force);
        interface.count_flights(&self.state.interface.flight, self.dt);
        for point in 0..system.points() {
            let ahead = map.displacement.since(&self.captured[point]);
            interface.gap[point] =
                self.rows.gap(point) + on_row(&self.rows, point, &ahead, old, [x, c]);
            interface.rate[point] = match system.massless.is_empty() {
                true => on_row(&self.rows, point, &map.rate, old, [x, c]),
                false => self.rows.product(point, &new.v),
            };
            interface.opening[point] = match system.point(point).0.law.get().level() {
                Level::Rate => (map.start_in_way() * self.rows.product(point, &old.v)).max(0.0),
                Level::Gap | Level::GapAndRate => 0.0,
            };
        }
        self.next.step = self.state.step + 1;
        let State {
            step,
            time,
            control,
            ..
        } = &self.state;
        self.next.time = control.instant(*step, *time, self.dt);
        self.crush();
    }

    /// Internal forces at the end of the step; returns the strain energy.
    fn end_forces(&mut self, predicted: f64) -> f64 {
        if self.map.force.x == 0.0 && self.map.force == self.map.displacement {
            return predicted;
        }
        let motion = &mut self.next.motion;
        self.forces
            .evaluate(&self.system, &motion.u, &mut motion.internal_force)
    }
}
