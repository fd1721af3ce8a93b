//! A linear model given by its matrices, with contact rows: M ü + C u̇ + K u = p + Nᵀ P, gaps g = g₀ + N u.
//!
//! The step is that of the crates: the map of the scheme says how everything depends on the unknown x,
//! `A = inertia.x M + rate.x C + force.x K` is factorised once, `D = N A⁻¹ Nᵀ` condensed once, and the interface problem solved in each step
//! with the exact signs of the laws.

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::solver::Cholesky;
use carom_dynamics::paired::told;
use carom_laws::{Law, Level, Local, Status};
use carom_nonsmooth::Compliance;
use carom_nonsmooth::interface::{Candidate, Interface};
use carom_schemes::{Known, Row, Scheme, StepMap};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::failed;
use crate::schemes::{read_law, read_scheme};

/// Pointers, columns and values of a matrix by rows.
type GivenMatrix = (Vec<usize>, Vec<u32>, Vec<f64>);

/// Rows with their unknowns and coefficients, gaps, and laws.
type GivenContacts = (Vec<Vec<(usize, f64)>>, Vec<f64>, Vec<String>);

/// Forces of the rows and displacements, step by step.
type History = (Vec<Vec<f64>>, Vec<Vec<f64>>);

/// A run of a model given by its matrices.
#[pyclass(module = "carom")]
pub(crate) struct MatrixRun {
    mass: Csr,
    damping: Option<Csr>,
    stiffness: Csr,
    rows: Vec<Vec<(usize, f64)>>,
    /// g₀, m.
    gaps: Vec<f64>,
    laws: Vec<Law>,
    map: StepMap,
    dt: f64,
    factor: Cholesky,
    /// A⁻¹ Nᵀ, one column for each row of N.
    columns: Vec<Vec<f64>>,
    /// D over all rows, and over the candidates.
    whole: Vec<f64>,
    condensed: Vec<f64>,
    candidates: Vec<u32>,
    data: Vec<Candidate>,
    interface: Interface,
    version: u64,
    status: Vec<Status>,
    crush: Vec<f64>,
    force: Vec<f64>,
    u: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    memory: Vec<f64>,
    step: u64,
    /// Room: the residual, x, a product, and the next vectors.
    residual: Vec<f64>,
    x: Vec<f64>,
    work: Vec<f64>,
    next: [Vec<f64>; 4],
}

fn wrong(message: impl Into<String>) -> PyErr {
    PyValueError::new_err(message.into())
}

/// The matrix; `n`: its size.
fn read(n: usize, (pointers, columns, values): &GivenMatrix) -> PyResult<Csr> {
    let sound = pointers.len() == n + 1
        && pointers.windows(2).all(|pair| pair[0] <= pair[1])
        && pointers.last() == Some(&columns.len())
        && columns.len() == values.len()
        && columns.iter().all(|column| (*column as usize) < n);
    if !sound {
        return Err(wrong(format!(
            "not a square matrix of {n} rows in the format CSR"
        )));
    }
    let mut pairs = Cliques::new();
    let entries = |i: usize| (pointers[i]..pointers[i + 1]).map(|k| (columns[k], values[k]));
    for i in 0..n {
        for (j, _) in entries(i) {
            pairs.push(&[i as u32, j]);
        }
    }
    let mut matrix = Csr::from_cliques(n, &pairs);
    for i in 0..n {
        for (j, value) in entries(i) {
            matrix.add(i, j as usize, value);
        }
    }
    Ok(matrix)
}

/// Σ factor matrix.
fn sum(n: usize, parts: &[(f64, &Csr)]) -> Csr {
    let mut pairs = Cliques::new();
    let used = || parts.iter().filter(|(factor, _)| *factor != 0.0);
    for (_, part) in used() {
        for i in 0..n {
            for &j in part.row(i).0 {
                pairs.push(&[i as u32, j]);
            }
        }
    }
    let mut sum = Csr::from_cliques(n, &pairs);
    for (factor, part) in used() {
        for i in 0..n {
            let (columns, values) = part.row(i);
            for (&j, value) in columns.iter().zip(values) {
                sum.add(i, j as usize, factor * value);
            }
        }
    }
    sum
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

/// Gap and rate that a law constrains.
fn constrained(map: &StepMap, law: &Law) -> [Row; 2] {
    match law.get().level() {
        Level::GapAndRate => map.compliant(),
        Level::Gap | Level::Rate => [map.gap, map.rate],
    }
}

fn refuse(scheme: &Scheme, map: &StepMap, laws: &[Law]) -> PyResult<()> {
    let scheme = scheme.get();
    let stages =
        scheme.is_between() || scheme.projects_predictor() || scheme.restores_contact_work();
    if stages || map.uses_contact_acceleration() {
        return Err(wrong(format!(
            "scheme {}: its steps with contact have further stages, which a model of matrices has not",
            scheme.name()
        )));
    }
    for law in laws {
        if !scheme.takes(law.get().level()) || law.projects() {
            return Err(wrong(format!(
                "the law {} cannot hold in the scheme {}",
                law.get().name(),
                scheme.name()
            )));
        }
    }
    Ok(())
}

impl MatrixRun {
    fn known(&self) -> Known<'_> {
        Known {
            u: &self.u,
            v: &self.v,
            a: &self.a,
            memory: &self.memory,
        }
    }

    fn along(&self, row: usize, vector: &[f64]) -> f64 {
        self.rows[row].iter().map(|&(i, c)| c * vector[i]).sum()
    }

    /// N times what a row of the map says; `with_x`: with the unknown as it stands, that of the motion without contact forces.
    fn quantity(&self, row: usize, of: &Row, with_x: bool) -> f64 {
        let terms = [
            (of.u, &self.u),
            (of.v, &self.v),
            (of.a, &self.a),
            (of.x * f64::from(u8::from(with_x)), &self.x),
        ];
        let terms = terms.iter().filter(|(factor, _)| *factor != 0.0);
        let mut sum: f64 = terms
            .map(|(factor, vector)| factor * self.along(row, vector))
            .sum();
        if of.m != 0.0 {
            sum += of.m * self.along(row, &self.memory);
        }
        sum
    }

    /// r = p - M ẍ_known - C u̇_known - K u_known.
    fn evaluate_residual(&mut self, load: &[f64]) {
        let rate = damping_rate(&self.map);
        let mut residual = std::mem::take(&mut self.residual);
        let mut work = std::mem::take(&mut self.work);
        let mut product = std::mem::take(&mut self.x);
        residual.copy_from_slice(load);
        let parts = [
            (&self.map.inertia, Some(&self.mass)),
            (&rate, self.damping.as_ref()),
            (&self.map.force, Some(&self.stiffness)),
        ];
        for (row, matrix) in parts {
            let Some(matrix) = matrix else { continue };
            row.known(self.known(), &mut work);
            matrix.multiply(&work, &mut product);
            for (r, p) in residual.iter_mut().zip(&product) {
                *r -= p;
            }
        }
        (self.residual, self.work, self.x) = (residual, work, product);
    }

    fn choose(&mut self, tolerance: f64) {
        self.candidates.clear();
        self.data.clear();
        let map = self.map;
        for row in 0..self.rows.len() {
            let law = &self.laws[row];
            let placed = self.gaps[row] + self.quantity(row, &map.placed, false);
            let moving = self.along(row, &self.v);
            if told(law, (placed, moving), map.moves, tolerance) == Some(false) {
                (self.status[row], self.force[row]) = (Status::Open, 0.0);
                continue;
            }
            let [gap, rate] = constrained(&map, law);
            self.candidates.push(row as u32);
            self.data.push(Candidate {
                law: *law,
                local: Local {
                    area: 1.0,
                    share: 1.0,
                    gap: placed,
                    rate: moving,
                    start: map.start_in_way() * moving,
                    gap_free: self.gaps[row] + self.quantity(row, &gap, true),
                    dt: map.moves,
                    tolerance,
                    crush: self.crush[row],
                },
                rate_free: self.quantity(row, &rate, true),
                status: self.status[row],
                faces_itself: false,
                instant: match law.get().level() {
                    Level::GapAndRate => map.compliant_factors(),
                    Level::Gap | Level::Rate => [1.0; 2],
                },
            });
        }
    }

    /// One step with the load (N) at its instant.
    fn take_step(&mut self, load: &[f64], tolerance: f64) -> PyResult<()> {
        self.evaluate_residual(load);
        self.x.copy_from_slice(&self.residual);
        self.factor.solve(&mut self.x);
        let before = self.candidates.clone();
        self.choose(tolerance);
        let m = self.rows.len();
        if before != self.candidates || self.version == 0 {
            self.version += 1;
            self.condensed.clear();
            for &i in &self.candidates {
                let row = &self.whole[i as usize * m..(i as usize + 1) * m];
                self.condensed
                    .extend(self.candidates.iter().map(|j| row[*j as usize]));
            }
        }
        let factor = self.map.contact;
        let compliance = (Compliance::Dense(&self.condensed), self.version);
        let factors = [self.map.gap.x * factor, self.map.rate.x * factor];
        let solved = self.interface.solve(&self.data, compliance, factors);
        solved.map_err(|error| failed(&error))?;
        for (k, &row) in self.candidates.iter().enumerate() {
            let (row, force) = (row as usize, self.interface.forces[k]);
            self.force[row] = force;
            self.status[row] = self.interface.statuses[k];
            if force != 0.0 {
                for (x, c) in self.x.iter_mut().zip(&self.columns[row]) {
                    *x += factor * force * c;
                }
            }
        }
        let mut next = std::mem::take(&mut self.next);
        let map = &self.map;
        let ends = [map.displacement, map.velocity, map.acceleration, map.memory];
        for (row, out) in ends.iter().zip(&mut next) {
            row.whole(self.known(), &self.x, &[], out);
        }
        let [u, v, a, memory] = &mut next;
        std::mem::swap(&mut self.u, u);
        std::mem::swap(&mut self.v, v);
        std::mem::swap(&mut self.a, a);
        std::mem::swap(&mut self.memory, memory);
        self.next = next;
        for row in 0..m {
            if self.force[row] != 0.0 {
                let gap = self.gaps[row] + self.along(row, &self.u);
                self.crush[row] = self.laws[row].crushed(self.crush[row], gap);
            }
        }
        self.step += 1;
        if self.u.iter().all(|u| u.is_finite()) {
            Ok(())
        } else {
            Err(wrong(format!(
                "step {}: the motion is not finite",
                self.step
            )))
        }
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
        let ((rows, gaps, laws), (scheme, dt), (u, v, load)) = (contacts, scheme, start);
        let scheme = read_scheme(&scheme)?;
        let laws = laws
            .iter()
            .map(|law| read_law(law))
            .collect::<PyResult<Vec<_>>>()?;
        let map = scheme.get().step_map(dt);
        refuse(&scheme, &map, &laws)?;
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
        let column = |row: &Vec<(usize, f64)>| {
            let mut column = vec![0.0; n];
            row.iter().for_each(|&(i, c)| column[i] += c);
            factor.solve(&mut column);
            column
        };
        let columns: Vec<Vec<f64>> = rows.iter().map(column).collect();
        let entry = |row: &Vec<(usize, f64)>, column: &Vec<f64>| -> f64 {
            row.iter().map(|&(i, c)| c * column[i]).sum()
        };
        let whole = rows
            .iter()
            .flat_map(|row| columns.iter().map(move |c| entry(row, c)));
        let whole = whole.collect();
        let (m, zeros) = (rows.len(), || vec![0.0; n]);
        let mut run = MatrixRun {
            mass,
            damping,
            stiffness,
            rows,
            gaps,
            laws,
            map,
            dt,
            factor,
            columns,
            whole,
            condensed: Vec::new(),
            candidates: Vec::new(),
            data: Vec::new(),
            interface: Interface::default(),
            version: 0,
            status: vec![Status::Open; m],
            crush: vec![0.0; m],
            force: vec![0.0; m],
            memory: match map.has_memory() {
                true => v.clone(),
                false => Vec::new(),
            },
            next: [
                zeros(),
                zeros(),
                zeros(),
                match map.has_memory() {
                    true => zeros(),
                    false => Vec::new(),
                },
            ],
            u,
            v,
            a: zeros(),
            step: 0,
            residual: zeros(),
            x: zeros(),
            work: zeros(),
        };
        if scheme.get().keeps_acceleration() {
            run.residual.copy_from_slice(&load);
            let mut product = zeros();
            run.stiffness.multiply(&run.u, &mut product);
            for (r, p) in run.residual.iter_mut().zip(&product) {
                *r -= p;
            }
            if let Some(damping) = &run.damping {
                damping.multiply(&run.v, &mut product);
                for (r, p) in run.residual.iter_mut().zip(&product) {
                    *r -= p;
                }
            }
            let mass = Cholesky::new(&run.mass, &groups);
            let mut mass = mass.map_err(|error| failed(&error))?;
            run.a.copy_from_slice(&run.residual);
            mass.solve(&mut run.a);
        }
        Ok(run)
    }

    /// Takes steps with constant loads (N), one of each row of `loads`; returns the forces of the rows (N) and the displacements (m).
    fn run(&mut self, py: Python<'_>, loads: Vec<Vec<f64>>, tolerance: f64) -> PyResult<History> {
        if loads.iter().any(|load| load.len() != self.u.len()) {
            return Err(wrong(format!(
                "a load of a wrong length; accepted: {}",
                self.u.len()
            )));
        }
        let (mut forces, mut places) = (Vec::new(), Vec::new());
        for (k, load) in loads.iter().enumerate() {
            if k % 256 == 0 {
                py.check_signals()?;
            }
            self.take_step(load, tolerance)?;
            forces.push(self.force.clone());
            places.push(self.u.clone());
        }
        Ok((forces, places))
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
        self.v.clone()
    }

    #[getter]
    fn acceleration(&self) -> Vec<f64> {
        self.a.clone()
    }
}
