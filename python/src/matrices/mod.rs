//! A linear model given by its matrices, with contact rows: M ü + C u̇ + K u = p + Nᵀ P + Tᵀ t, gaps g = g₀ + N u, sliding T u̇.
//!
//! The step is that of the crates: the map of the scheme says how everything depends on the unknown x,
//! `A = inertia.x M + rate.x C + force.x K` is factorised once, `D = N A⁻¹ Nᵀ` condensed once, and the interface problem solved in each step
//! with the exact signs of the laws. [`stages`]: what some schemes and laws do beside it with the mass alone.

mod of_mass;
mod rows;
mod sparse;
mod stages;
mod step;

use carom_algebra::csr::Csr;
use carom_algebra::solver::Cholesky;
use carom_laws::{Friction, Law};
use carom_nonsmooth::{CandidateData, ContactSolver, PointForces};
use carom_schemes::{LaursenChawla, Row, Scheme, StepMap, TimeScheme};
use pyo3::prelude::*;

use crate::errors::{failed, wrong};
use crate::schemes::{read_friction, read_law, read_scheme};
use of_mass::OfMass;
use rows::Rows;
use sparse::{GivenMatrix, read, sum};

/// Rows with their unknowns and coefficients, the tangents of each point after its normal; gaps, laws and friction laws of the points.
type GivenContacts = (Vec<Vec<(usize, f64)>>, Vec<f64>, Vec<String>, Vec<String>);

/// Normal forces of the points, their tangential ones, and displacements, step by step.
type History = (Vec<Vec<f64>>, Vec<Vec<[f64; 2]>>, Vec<Vec<f64>>);

/// Vectors of the motion.
#[derive(Clone, Default)]
struct Motion {
    u: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    memory: Vec<f64>,
}

/// What a contact point has, and what it starts the next step with.
#[derive(Clone)]
struct Point {
    law: Law,
    /// g₀, m.
    gap: f64,
    /// Friction.
    friction: Friction,
    /// Forces and statuses of the last step.
    last: PointForces,
    /// Force in the balance at the start of the next step, N.
    carried: f64,
    /// Largest penetration so far, m.
    crush: f64,
}

/// Solvers of the interface problem, and D over its candidates.
#[derive(Default)]
struct Condensed {
    solver: ContactSolver,
    data: CandidateData,
    /// The candidates of the last step, and their rows.
    candidates: Vec<u32>,
    rows: Vec<u32>,
    d: Vec<f64>,
    version: u64,
}

/// Vectors of a step in work.
#[derive(Default)]
struct Room {
    residual: Vec<f64>,
    x: Vec<f64>,
    /// M⁻¹ Nᵀ P.
    push: Vec<f64>,
    work: Vec<f64>,
    next: Motion,
}

/// A run of a model given by its matrices.
#[pyclass(module = "carom")]
pub(crate) struct MatrixRun {
    scheme: Scheme,
    map: StepMap,
    dt: f64,
    mass: Csr,
    damping: Option<Csr>,
    stiffness: Csr,
    rows: Rows,
    points: Vec<Point>,
    factor: Cholesky,
    /// A⁻¹ Nᵀ, one column for each row, and D over all rows.
    columns: Vec<Vec<f64>>,
    whole: Vec<f64>,
    /// The mass alone, of schemes and laws that have stages with it.
    of_mass: Option<OfMass>,
    condensed: Condensed,
    motion: Motion,
    step: u64,
    room: Room,
}

/// The velocity that damping acts on: that of the instant of the internal forces, or of an explicit step the one known before the forces.
fn damping_rate(map: &StepMap) -> Row {
    match map.force.x == 0.0 {
        true => Row {
            x: 0.0,
            ..map.velocity
        },
        false => Row::MOVING.towards(&map.velocity, map.force_fraction.unwrap_or(0.5)),
    }
}

/// The map of a step of a linear model. The discrete gradient of energy-momentum is there the force of the middle, and the scheme that of Laursen
/// and Chawla.
fn map_of(scheme: &Scheme, dt: f64) -> StepMap {
    match scheme.get().is_between() {
        true => LaursenChawla {}.step_map(dt),
        false => scheme.get().step_map(dt),
    }
}

fn refuse(scheme: &Scheme, map: &StepMap, laws: &[Law]) -> PyResult<()> {
    let scheme = scheme.get();
    if scheme.stages().len() > 1 {
        return Err(wrong(format!(
            "the scheme {} solves each step in stages, and the step of matrices has one",
            scheme.name()
        )));
    }
    for law in laws {
        let level = law.get().level();
        let projected = law.projects() && !map.balances_at_the_end();
        if !scheme.takes(level) || projected {
            let (law, scheme) = (law.get().name(), scheme.name());
            let with = if projected { " with projection" } else { "" };
            return Err(wrong(format!(
                "the law {law}{with} cannot hold in the scheme {scheme}"
            )));
        }
    }
    Ok(())
}

impl MatrixRun {
    /// The acceleration in balance with a motion and a load.
    fn balance(&mut self, load: &[f64]) -> PyResult<()> {
        if !self.scheme.get().keeps_acceleration() {
            return Ok(());
        }
        let Motion { u, v, a, .. } = &mut self.motion;
        a.copy_from_slice(load);
        let parts = [(Some(&self.stiffness), &*u), (self.damping.as_ref(), &*v)];
        for (matrix, vector) in parts {
            let Some(matrix) = matrix else { continue };
            matrix.multiply(vector, &mut self.room.work);
            for (a, f) in a.iter_mut().zip(&self.room.work) {
                *a -= f;
            }
        }
        match &mut self.of_mass {
            Some(of_mass) => of_mass.solve(a),
            None => {
                let groups: Vec<u32> = (0..a.len() as u32).collect();
                let mass = Cholesky::new(&self.mass, &groups);
                mass.map_err(|error| failed(&error))?.solve(a);
            }
        }
        Ok(())
    }
}

#[pymethods]
impl MatrixRun {
    #[new]
    fn new(
        py: Python<'_>,
        matrices: (usize, GivenMatrix, Option<GivenMatrix>, GivenMatrix),
        contacts: GivenContacts,
        scheme: (String, f64),
        start: (Vec<f64>, Vec<f64>, Vec<f64>),
    ) -> PyResult<MatrixRun> {
        let (n, mass, damping, stiffness) = matrices;
        let ((rows, gaps, laws, friction), (scheme, dt)) = (contacts, scheme);
        let (u, v, load) = start;
        if [&u, &v, &load].iter().any(|vector| vector.len() != n) {
            return Err(wrong(format!(
                "u, v or load of a wrong length; accepted: {n}"
            )));
        }
        let scheme = read_scheme(&scheme)?;
        let laws = laws.iter().map(|law| read_law(law));
        let laws = laws.collect::<PyResult<Vec<_>>>()?;
        let friction = friction.iter().map(|friction| read_friction(friction));
        let friction = friction.collect::<PyResult<Vec<_>>>()?;
        let map = map_of(&scheme, dt);
        refuse(&scheme, &map, &laws)?;
        let rows = Rows::new(rows, gaps.len(), n)?;
        let mass = read(n, &mass)?;
        let stiffness = read(n, &stiffness)?;
        let damping = damping.map(|damping| read(n, &damping)).transpose()?;
        let rate = damping_rate(&map);
        let mut parts = vec![(map.inertia.x, &mass), (map.force.x, &stiffness)];
        parts.extend(damping.as_ref().map(|damping| (rate.x, damping)));
        let matrix = sum(n, &parts);
        let groups: Vec<u32> = (0..n as u32).collect();
        let made = py.detach(|| Cholesky::new(&matrix, &groups));
        let mut factor = made.map_err(|error| failed(&error))?;
        let columns = rows.columns(&mut factor);
        let staged = map.uses_contact_acceleration()
            || scheme.get().projects_predictor()
            || scheme.get().restores_contact_work()
            || laws.iter().any(Law::projects);
        let of_mass = staged.then(|| OfMass::new(&mass, &rows)).transpose()?;
        let point = |((law, gap), friction): ((&Law, f64), Friction)| Point {
            law: *law,
            gap,
            friction,
            last: PointForces::default(),
            carried: 0.0,
            crush: 0.0,
        };
        let zeros = || vec![0.0; n];
        let memory = |vector: &Vec<f64>| match map.has_memory() {
            true => vector.clone(),
            false => Vec::new(),
        };
        let still = Motion {
            u: zeros(),
            v: zeros(),
            a: zeros(),
            memory: memory(&v),
        };
        let room = Room {
            residual: zeros(),
            x: zeros(),
            push: match map.uses_contact_acceleration() {
                true => zeros(),
                false => Vec::new(),
            },
            work: zeros(),
            next: still.clone(),
        };
        let mut run = MatrixRun {
            whole: rows.compliance(&columns),
            points: laws.iter().zip(gaps).zip(friction).map(point).collect(),
            motion: Motion { u, v, ..still },
            condensed: Condensed::default(),
            step: 0,
            scheme,
            map,
            dt,
            mass,
            damping,
            stiffness,
            rows,
            factor,
            columns,
            of_mass,
            room,
        };
        run.balance(&load)?;
        Ok(run)
    }

    /// Takes steps with constant loads (N), one of each row of `loads`; returns the forces of the points (N) and the displacements (m).
    fn run(&mut self, py: Python<'_>, loads: Vec<Vec<f64>>, tolerance: f64) -> PyResult<History> {
        if loads.iter().any(|load| load.len() != self.motion.u.len()) {
            return Err(wrong(format!(
                "a load of a wrong length; accepted: {}",
                self.motion.u.len()
            )));
        }
        let mut history = History::default();
        for (k, load) in loads.iter().enumerate() {
            if k % 256 == 0 {
                py.check_signals()?;
            }
            self.take_step(load, tolerance)?;
            let (forces, tangential, places) = &mut history;
            forces.push(self.points.iter().map(|point| point.last.normal).collect());
            tangential.push(
                self.points
                    .iter()
                    .map(|point| point.last.tangential)
                    .collect(),
            );
            places.push(self.motion.u.clone());
        }
        Ok(history)
    }

    #[getter]
    fn time(&self) -> f64 {
        self.step as f64 * self.dt
    }

    /// Time after the start of a step at which its load is taken, s.
    #[getter]
    fn instant(&self) -> f64 {
        self.map.instant(self.dt)
    }

    #[getter]
    fn velocity(&self) -> Vec<f64> {
        self.motion.v.clone()
    }

    #[getter]
    fn acceleration(&self) -> Vec<f64> {
        self.motion.a.clone()
    }
}
