//! The one driver of all steps: free motion, interface problem, correction, balance.
//!
//! What it holds besides the state is a function of the system and the state, or scratch: a run goes on from a saved
//! state with the same bits.

use std::sync::Arc;
use std::time::{Duration, Instant};

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::reduce::dot;
use carom_algebra::solver::FactorStats;
use carom_bodies::Scratch;
use carom_contact::law::{Level, Status};
use carom_contact::{Places, Rows, Search, Sliding};

use crate::compliance::Compliance;
use crate::error::Error;
use crate::interface::{Candidate, Failure, Interface};
use crate::ledger::{Energies, Ledger, Resultant, Squares, reactions};
use crate::operator::{Operator, Operators};
use crate::records::{ContactRecord, Records, Step};
use crate::scheme::EnergyIdentity;
use crate::state::{ContactReport, InterfaceState, Motion, State, StepReport};
use crate::step_map::{Row, StepMap};
use crate::system::{System, push_cliques};

/// Takes steps.
pub struct Driver {
    system: Arc<System>,
    map: StepMap,
    identity: EnergyIdentity,
    operators: Operators,
    compliance: Compliance,
    interface: Interface,
    forces: Forces,
    /// Rows at zero displacement of contacts with small sliding.
    initial_rows: Vec<Option<Rows>>,
    search: Vec<Search>,
    rows: Rows,
    /// For each point, the factors of u, v, a and x in its gap at the end, counted from the paired configuration.
    ahead: Vec<Row>,
    candidates: Vec<u32>,
    candidate_data: Vec<Candidate>,
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
    /// Pairing, columns, interface problem.
    pub contact: Duration,
    /// Balance, records, vector updates.
    pub balance: Duration,
}

/// What the run cost so far.
#[derive(Clone, Debug, Default)]
pub struct Costs {
    /// One entry per connected part with a factor.
    pub factors: Vec<FactorStats>,
    /// Columns A⁻¹ Nᵀ computed.
    pub columns: usize,
    /// Bytes of columns and compliance.
    pub compliance_bytes: usize,
    /// Internal-force sweeps.
    pub force_sweeps: usize,
    /// Times.
    pub phases: Phases,
}

impl Driver {
    /// Factorises the effective matrix of each part and sets the initial state.
    ///
    /// # Errors
    /// A matrix that is not positive definite.
    pub fn new(system: Arc<System>) -> Result<Driver, Error> {
        let scheme = system.scheme.get();
        let (map, identity) = (
            scheme.step_map(system.dt),
            scheme.energy_identity(system.dt),
        );
        let begin = Instant::now();
        let operators = operators(&system, map.inertia.x, map.force.x, "effective matrix")?;
        let factorisation = begin.elapsed();
        let (n, points) = (system.unknowns(), system.points());
        let zeros = || vec![0.0; n];
        let mut driver = Driver {
            map,
            identity,
            operators,
            compliance: Compliance::new(points),
            interface: Interface::default(),
            forces: Forces {
                scratch: system.bodies.iter().map(|_| Scratch::default()).collect(),
                sweeps: 0,
            },
            initial_rows: Vec::new(),
            search: system.contacts.iter().map(|_| Search::default()).collect(),
            rows: Rows::default(),
            ahead: Vec::new(),
            candidates: Vec::new(),
            candidate_data: Vec::new(),
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
            },
            phases: Phases {
                factorisation,
                ..Phases::default()
            },
            system,
        };
        driver.pair_initially();
        driver.start()?;
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

    /// What the run cost so far.
    pub fn costs(&self) -> Costs {
        Costs {
            factors: self
                .operators
                .operators
                .iter()
                .filter_map(|operator| operator.stats().cloned())
                .collect(),
            columns: self.compliance.columns_computed,
            compliance_bytes: self.compliance.bytes(),
            force_sweeps: self.forces.sweeps,
            phases: self.phases,
        }
    }

    fn pair_initially(&mut self) {
        let system = Arc::clone(&self.system);
        let places = Places {
            dim: system.dim,
            x: &system.x,
            u: &self.vectors.work,
        };
        let rows = system
            .contacts
            .iter()
            .zip(&mut self.search)
            .map(|(contact, search)| match contact.sliding {
                Sliding::Finite => None,
                Sliding::Small => {
                    let mut rows = Rows::default();
                    rows.clear();
                    contact.pair(&places, search, &mut rows);
                    Some(rows)
                }
            });
        self.initial_rows = rows.collect();
    }

    /// Initial state: internal forces, the acceleration in balance without contact forces, gaps, energies.
    fn start(&mut self) -> Result<(), Error> {
        let system = Arc::clone(&self.system);
        let motion = &mut self.state.motion;
        motion.u.copy_from_slice(&system.initial_displacement);
        motion.v.copy_from_slice(&system.initial_velocity);
        let strain = self
            .forces
            .evaluate(&system, &motion.u, &mut motion.internal_force);
        if system.scheme.get().keeps_acceleration() {
            let mut mass = operators(&system, 1.0, 0.0, "mass matrix")?;
            for i in 0..system.unknowns() {
                let balance = system.load[i] - motion.internal_force[i];
                self.vectors.residual[i] = if system.fixed[i] { 0.0 } else { balance };
            }
            mass.begin(&self.vectors.residual, &mut self.vectors.half);
            mass.end(&mut self.vectors.half, &mut motion.a);
        }
        let energies = energies(
            &system,
            motion,
            strain,
            &mut self.vectors.work,
            self.identity.inertia != 0.0,
        );
        system.mass.multiply(&motion.a, &mut self.vectors.inertia);
        let motion = &self.state.motion;
        reactions(
            &system,
            &self.map,
            motion,
            motion,
            &self.vectors.inertia,
            &mut self.vectors.work,
        );
        let supports = Resultant::of(&system, &self.vectors.work);
        let loads = Resultant::of(&system, &system.load);
        self.state.ledger = Ledger::start(
            &energies,
            &self.identity,
            [loads, Resultant::default(), supports],
        );
        self.state.records = Records {
            contacts: vec![ContactRecord::default(); system.contacts.len()],
            impacts: Vec::new(),
        };
        self.place(true);
        for point in 0..system.points() {
            self.state.interface.gap[point] = self.rows.gap(point);
            self.state.interface.rate[point] = self.rows.product(point, &self.state.motion.v);
        }
        self.next.clone_from(&self.state);
        self.tell();
        Ok(())
    }

    /// Takes one step.
    ///
    /// # Errors
    /// A contact problem without solution, or a motion that is not finite. The state is then the one before the step.
    pub fn step(&mut self) -> Result<(), Error> {
        let begin = Instant::now();
        let predicted = self.residual();
        let forces = Instant::now();
        self.place(false);
        self.choose_candidates();
        let mut sweeps = Duration::ZERO;
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
        let strain = self.end_forces(predicted);
        let ended = Instant::now();
        self.balance(strain);
        self.finite()?;
        self.phases.forces += (forces - begin) + (ended - solved);
        self.phases.sweeps += sweeps;
        self.phases.contact += (solved - forces).saturating_sub(sweeps);
        self.phases.balance += ended.elapsed();
        std::mem::swap(&mut self.state, &mut self.next);
        self.tell();
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
        self.map.force.known(&motion.u, &motion.v, &motion.a, known);
        let energy = self.forces.evaluate(system, known, residual);
        self.map
            .inertia
            .known(&motion.u, &motion.v, &motion.a, known);
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

    /// Pairs all contacts at their captured instant; `now` takes the state as it is.
    fn place(&mut self, now: bool) {
        let system = Arc::clone(&self.system);
        let (map, dt, motion) = (&self.map, system.dt, &self.state.motion);
        self.rows.clear();
        self.ahead.clear();
        let mut capture = f64::NAN;
        for (k, contact) in system.contacts.iter().enumerate() {
            let place = match now {
                true => Row {
                    u: 1.0,
                    ..Row::default()
                },
                false => Row {
                    v: map.placed.v + contact.law.get().capture() * dt,
                    ..map.placed
                },
            };
            if capture != place.v {
                place.known(&motion.u, &motion.v, &motion.a, &mut self.vectors.known);
                capture = place.v;
            }
            let u = &self.vectors.known;
            match &self.initial_rows[k] {
                Some(initial) => self.rows.append_moved(initial, u),
                None => {
                    let places = Places {
                        dim: system.dim,
                        x: &system.x,
                        u,
                    };
                    contact.pair(&places, &mut self.search[k], &mut self.rows);
                }
            }
            let end = map.displacement;
            let ahead = Row {
                u: end.u - place.u,
                v: end.v - place.v,
                a: end.a - place.a,
                x: end.x,
            };
            self.ahead.resize(self.rows.len(), ahead);
        }
    }

    /// Points that may carry a force. Laws in the rate say so themselves; others are taken when they carried one or when
    /// twice the present rate would close them, and the others checked after the solve.
    fn choose_candidates(&mut self) {
        let system = &self.system;
        self.candidates.clear();
        for point in 0..system.points() {
            let gap = self.rows.gap(point);
            let law = system.point(point).0.law;
            let watched = gap < f64::INFINITY && law.get().watches(gap, system.tolerance);
            let within = law.get().level() == Level::Rate
                || self.state.interface.status[point] != Status::Open
                || gap + 2.0 * system.dt * self.rows.product(point, &self.state.motion.v).min(0.0)
                    <= system.tolerance;
            self.next.interface.watched[point] = watched;
            if watched && within {
                self.candidates.push(point as u32);
            }
        }
    }

    fn solve_interface(&mut self) -> Result<(), Error> {
        let system = &*self.system;
        let motion = &self.state.motion;
        let interface_error = |cause, points| Error::Interface {
            step: self.state.step + 1,
            points,
            cause,
        };
        self.compliance
            .update(
                &self.candidates,
                &self.rows,
                &system.fixed,
                &mut self.operators,
            )
            .map_err(|cause| interface_error(cause, self.candidates.len()))?;
        self.candidate_data.clear();
        for &point in &self.candidates {
            let at = point as usize;
            let (contact, place) = system.point(at);
            let free = self
                .compliance
                .free(point, &self.operators, &self.vectors.half);
            let [nu, nv, na] =
                [&motion.u, &motion.v, &motion.a].map(|vector| self.rows.product(at, vector));
            let value = |row: &Row| row.u * nu + row.v * nv + row.a * na + row.x * free;
            self.candidate_data.push(Candidate {
                law: contact.law,
                area: contact.points[place].area,
                gap_free: self.rows.gap(at) + value(&self.ahead[at]),
                rate_free: value(&self.map.rate),
                status: self.state.interface.status[at],
            });
        }
        let factors = [self.map.displacement.x, self.map.rate.x];
        let solved = self.interface.solve(
            &self.candidate_data,
            (&self.compliance.matrix, self.compliance.version),
            factors,
        );
        if let Err(failure) = solved {
            return Err(match failure {
                Failure::Singular { points, cause } => interface_error(cause, points),
                Failure::Cycling { passes, candidate } => {
                    let (contact, point) = system.point(self.candidates[candidate] as usize);
                    Error::Statuses {
                        step: self.state.step + 1,
                        passes,
                        contact: contact.name.clone(),
                        point,
                    }
                }
            });
        }
        for (&point, &force) in self.candidates.iter().zip(&self.interface.forces) {
            if force != 0.0 {
                self.compliance
                    .add(point, force, &self.operators, &mut self.vectors.half);
            }
        }
        Ok(())
    }

    /// Adds the points that ended penetrating without having been candidates; whether there are any.
    fn add_missed(&mut self) -> bool {
        let before = self.candidates.len();
        let motion = &self.state.motion;
        for point in 0..self.system.points() {
            let level = self.system.point(point).0.law.get().level();
            if level == Level::Rate || self.rows.gap(point) == f64::INFINITY {
                continue;
            }
            if self.candidates[..before]
                .binary_search(&(point as u32))
                .is_ok()
            {
                continue;
            }
            if self.rows.gap(point)
                + on_row(
                    &self.rows,
                    point,
                    &self.ahead[point],
                    motion,
                    &self.vectors.x,
                )
                < 0.0
            {
                self.candidates.push(point as u32);
            }
        }
        self.candidates.sort_unstable();
        self.candidates.len() > before
    }

    /// Writes the motion and the interface at the end of the step.
    fn advance(&mut self) {
        let system = &*self.system;
        let (old, map, x) = (&self.state.motion, &self.map, &self.vectors.x);
        let new = &mut self.next.motion;
        map.displacement
            .whole(&old.u, &old.v, &old.a, x, &mut new.u);
        map.velocity.whole(&old.u, &old.v, &old.a, x, &mut new.v);
        map.acceleration
            .whole(&old.u, &old.v, &old.a, x, &mut new.a);
        new.contact_force.fill(0.0);
        let interface = &mut self.next.interface;
        interface.force.fill(0.0);
        interface.status.fill(Status::Open);
        for (k, &point) in self.candidates.iter().enumerate() {
            interface.force[point as usize] = self.interface.forces[k];
            interface.status[point as usize] = self.interface.statuses[k];
            self.rows.add_force(
                point as usize,
                self.interface.forces[k],
                &mut new.contact_force,
            );
        }
        for point in 0..system.points() {
            interface.gap[point] =
                self.rows.gap(point) + on_row(&self.rows, point, &self.ahead[point], old, x);
            interface.rate[point] = on_row(&self.rows, point, &map.rate, old, x);
        }
        self.next.step = self.state.step + 1;
        self.next.time = self.next.step as f64 * system.dt;
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

    /// Energy and momentum of the step, then the records of the contacts.
    fn balance(&mut self, strain: f64) {
        let system = Arc::clone(&self.system);
        let (dt, identity) = (system.dt, self.identity);
        let (old, new) = (&self.state.motion, &self.next.motion);
        let Vectors {
            x,
            known,
            work,
            inertia,
            ..
        } = &mut self.vectors;
        let energies = energies(&system, new, strain, work, identity.inertia != 0.0);
        let mut squares = Squares::default();
        if identity.velocity != 0.0 {
            squares.velocity = change_squared(&system, &old.v, &new.v, known, work);
        }
        if identity.acceleration != 0.0 {
            squares.acceleration = change_squared(&system, &old.a, &new.a, known, work);
        }
        self.map.inertia.whole(&old.u, &old.v, &old.a, x, known);
        system.mass.multiply(known, inertia);
        reactions(&system, &self.map, old, new, inertia, work);
        let supports = Resultant::of(&system, work);
        let contact = Resultant::of(&system, &new.contact_force);
        let loads = Resultant::of(&system, &system.load);
        for i in 0..known.len() {
            known[i] = new.u[i] - old.u[i];
        }
        if identity.displacement != 0.0 {
            // K is linear and symmetric: |Δu|²_K = Δu · Δf
            squares.displacement =
                dot(known, &new.internal_force) - dot(known, &old.internal_force);
        }
        let work_contact = identity.old * dot(known, &old.contact_force)
            + identity.new * dot(known, &new.contact_force);
        let work_loads = dot(known, &system.load);
        self.next.ledger.clone_from(&self.state.ledger);
        self.next.ledger.add(
            (dt, &identity),
            &energies,
            [work_loads, work_contact],
            &squares,
            [loads, contact, supports],
        );
        self.record();
    }

    fn record(&mut self) {
        let system = Arc::clone(&self.system);
        self.next.records.clone_from(&self.state.records);
        for k in 0..system.contacts.len() {
            let report = contact_report(
                &system,
                k,
                &self.rows,
                &self.state.interface,
                &self.next.interface,
            );
            let weights = [self.identity.old, self.identity.new];
            let step = Step {
                span: [self.state.time, self.next.time],
                weights,
                report: &report,
                work: contact_work(&system, k, &self.rows, weights, (&self.state, &self.next)),
            };
            let State {
                motion, records, ..
            } = &mut self.next;
            records.add(&system, k, &step, &self.state, &motion.v);
            self.report.contacts[k] = report;
        }
    }

    fn finite(&self) -> Result<(), Error> {
        let motion = &self.next.motion;
        let bad = [
            ("displacement", &motion.u),
            ("velocity", &motion.v),
            ("contact force", &motion.contact_force),
        ]
        .into_iter()
        .find(|(_, vector)| !vector.iter().sum::<f64>().is_finite());
        match bad {
            None => Ok(()),
            Some((quantity, _)) => Err(Error::NotFinite {
                step: self.next.step,
                time: self.next.time,
                quantity,
            }),
        }
    }

    /// Completes the report of the state just accepted.
    fn tell(&mut self) {
        let state = &self.state;
        self.report.step = state.step;
        self.report.time = state.time;
        self.report.balance = state.ledger.balance;
        self.report.passes = if self.candidates.is_empty() {
            0
        } else {
            self.interface.passes
        };
        if state.step == 0 {
            for (k, report) in self.report.contacts.iter_mut().enumerate() {
                *report = contact_report(
                    &self.system,
                    k,
                    &self.rows,
                    &state.interface,
                    &state.interface,
                );
            }
        }
    }
}

fn empty_state(system: &System) -> State {
    let (zeros, points) = (vec![0.0; system.unknowns()], system.points());
    State {
        step: 0,
        time: 0.0,
        motion: Motion {
            u: zeros.clone(),
            v: zeros.clone(),
            a: zeros.clone(),
            internal_force: zeros.clone(),
            contact_force: zeros,
        },
        interface: InterfaceState {
            force: vec![0.0; points],
            gap: vec![0.0; points],
            rate: vec![0.0; points],
            status: vec![Status::Open; points],
            watched: vec![false; points],
        },
        ledger: Ledger::default(),
        records: Records::default(),
    }
}

/// `mass_factor` M + `stiffness_factor` K of every part, ready to solve with.
fn operators(
    system: &System,
    mass_factor: f64,
    stiffness_factor: f64,
    matrix: &'static str,
) -> Result<Operators, Error> {
    let operator = |part: &std::ops::Range<usize>| {
        let lumped = system.mass.lumped[part.clone()]
            .iter()
            .map(|m| mass_factor * m);
        let fixed = &system.fixed[part.clone()];
        if stiffness_factor == 0.0 && system.mass.consistent.is_none() {
            return Ok(Operator::diagonal(&lumped.collect::<Vec<_>>(), fixed));
        }
        let mut cliques = Cliques::new();
        for body in &system.bodies {
            push_cliques(body, system.dim, part, &mut cliques);
        }
        let mut a = Csr::from_cliques(part.len(), &cliques);
        for body in &system.bodies {
            body.assemble(stiffness_factor, 0.0, part, &mut a);
        }
        for (i, m) in lumped.enumerate() {
            a.add(i, i, m);
        }
        if let Some(mass) = &system.mass.consistent {
            for i in part.clone() {
                let (columns, values) = mass.row(i);
                for (&j, m) in columns.iter().zip(values).filter(|(_, m)| **m != 0.0) {
                    a.add(i - part.start, j as usize - part.start, mass_factor * m);
                }
            }
        }
        let node = system.mesh_node[part.start / system.dim];
        Operator::factored(&a, fixed, system.dim).map_err(|cause| Error::Factor {
            matrix,
            node,
            cause,
        })
    };
    let operators = system
        .parts
        .iter()
        .map(operator)
        .collect::<Result<_, _>>()?;
    Ok(Operators {
        parts: system.parts.clone(),
        operators,
    })
}

fn energies(
    system: &System,
    motion: &Motion,
    strain: f64,
    work: &mut [f64],
    with_acceleration: bool,
) -> Energies {
    system.mass.multiply(&motion.v, work);
    let (kinetic, momentum) = (0.5 * dot(&motion.v, work), Resultant::of(system, work));
    let mut acceleration = 0.0;
    if with_acceleration {
        system.mass.multiply(&motion.a, work);
        acceleration = dot(&motion.a, work);
    }
    Energies {
        kinetic,
        strain,
        acceleration,
        momentum,
    }
}

/// |new - old|²_M.
fn change_squared(
    system: &System,
    old: &[f64],
    new: &[f64],
    change: &mut [f64],
    work: &mut [f64],
) -> f64 {
    for i in 0..change.len() {
        change[i] = new[i] - old[i];
    }
    system.mass.multiply(change, work);
    dot(change, work)
}

/// N applied to a row of the step, for one point.
fn on_row(rows: &Rows, point: usize, row: &Row, motion: &Motion, x: &[f64]) -> f64 {
    row.u * rows.product(point, &motion.u)
        + row.v * rows.product(point, &motion.v)
        + row.a * rows.product(point, &motion.a)
        + row.x * rows.product(point, x)
}

fn contact_report(
    system: &System,
    contact: usize,
    rows: &Rows,
    old: &InterfaceState,
    new: &InterfaceState,
) -> ContactReport {
    let mut report = ContactReport {
        gap: f64::INFINITY,
        ..ContactReport::default()
    };
    for point in system.first_point[contact]..system.first_point[contact + 1] {
        let force = new.force[point];
        report.force += force;
        for (sum, n) in report.resultant.iter_mut().zip(rows.normal(point)) {
            *sum += force * n;
        }
        if new.gap[point] < report.gap {
            (report.gap, report.rate) = (new.gap[point], new.rate[point]);
        }
        report.closed += usize::from(force != 0.0);
        report.status_changes += usize::from((force != 0.0) != (old.force[point] != 0.0));
        report.persistency_defect += (force * new.rate[point]).abs() * system.dt;
    }
    report
}

/// Work of the forces of one contact on the motion of the step, J. `states`: at its start and end.
fn contact_work(
    system: &System,
    contact: usize,
    rows: &Rows,
    weights: [f64; 2],
    (old, new): (&State, &State),
) -> f64 {
    let points = system.first_point[contact]..system.first_point[contact + 1];
    points
        .map(|point| {
            let force =
                weights[0] * old.interface.force[point] + weights[1] * new.interface.force[point];
            force * (rows.product(point, &new.motion.u) - rows.product(point, &old.motion.u))
        })
        .sum()
}
