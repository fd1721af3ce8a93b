//! The mass alone: what contact forces do through M⁻¹, in the stages that some schemes and laws have beside the step.

use carom_algebra::csr::Csr;
use carom_algebra::solver::Cholesky;
use carom_laws::Status;
use carom_nonsmooth::interface::{Candidate, Failure, Interface};
use carom_nonsmooth::{Compliance, impulses_of_work};
use pyo3::prelude::*;

use super::rows::Rows;
use crate::errors::failed;

/// The factor of M, with `M⁻¹ Nᵀ` and `D = N M⁻¹ Nᵀ` of all rows.
pub(super) struct OfMass {
    factor: Cholesky,
    columns: Vec<Vec<f64>>,
    d: Vec<f64>,
    interface: Interface,
    version: u64,
    /// Impulses of the last solve, and whether those of each point are none.
    pub(super) added: Vec<f64>,
    pub(super) active: Vec<bool>,
}

impl OfMass {
    pub(super) fn new(mass: &Csr, rows: &Rows) -> PyResult<OfMass> {
        let groups: Vec<u32> = (0..rows.unknowns() as u32).collect();
        let made = Cholesky::new(mass, &groups);
        let mut factor = made.map_err(|error| failed(&error))?;
        let columns = rows.columns(&mut factor);
        Ok(OfMass {
            d: rows.compliance(&columns),
            factor,
            columns,
            interface: Interface::default(),
            version: 0,
            added: Vec::new(),
            active: Vec::new(),
        })
    }

    /// x ← M⁻¹ x.
    pub(super) fn solve(&mut self, x: &mut [f64]) {
        self.factor.solve(x);
    }

    /// `factor` D over some rows, added to a matrix over these rows.
    pub(super) fn add(&self, factor: f64, rows: &[u32], matrix: &mut [f64]) {
        for (value, d) in matrix.iter_mut().zip(self.over(rows)) {
            *value += factor * d;
        }
    }

    fn over<'a>(&'a self, rows: &'a [u32]) -> impl Iterator<Item = f64> + 'a {
        let all = self.columns.len();
        let row = move |i: usize| rows.iter().map(move |j| self.d[i * all + *j as usize]);
        rows.iter().flat_map(move |i| row(*i as usize))
    }

    /// Adds `M⁻¹ Nᵀ` times the forces of some rows.
    pub(super) fn spread(&self, forces: impl Iterator<Item = (usize, f64)>, out: &mut [f64]) {
        for (row, force) in forces.filter(|(_, force)| *force != 0.0) {
            for (out, c) in out.iter_mut().zip(&self.columns[row]) {
                *out += force * c;
            }
        }
    }

    /// Adds `M⁻¹ Nᵀ` times the impulses of the last solve, of these rows.
    pub(super) fn spread_added(&self, rows: &[u32], out: &mut [f64]) {
        let added = self.added.iter().copied();
        self.spread(rows.iter().map(|row| *row as usize).zip(added), out);
    }

    /// Solves `0 <= q + D ΔI ⟂ I + ΔI >= 0` over some rows. `values`: q of each, infinite where I + ΔI must vanish; `present`: I of each.
    pub(super) fn complement(
        &mut self,
        rows: &[u32],
        values: &[f64],
        present: &[f64],
    ) -> Result<(), Failure> {
        let n = rows.len();
        let d: Vec<f64> = self.over(rows).collect();
        let points = d.chunks_exact(n.max(1)).zip(values);
        let candidates: Vec<Candidate> = points
            .map(|(row, value)| Candidate::beside(*value, row, present))
            .collect();
        self.version += 1;
        let compliance = (Compliance::Dense(&d), self.version);
        self.interface.solve(&candidates, compliance, [1.0, 0.0])?;
        let forces = self.interface.forces.iter().zip(present);
        self.added.clear();
        self.added
            .extend(forces.map(|(force, present)| force - present));
        let statuses = self.interface.statuses.iter();
        self.active.clear();
        self.active
            .extend(statuses.map(|status| *status != Status::Open));
        Ok(())
    }

    /// The impulses of some rows that do these works (J) from these rates (m/s).
    pub(super) fn give_work(&mut self, rows: &[u32], rates: &[f64], works: &[f64]) {
        let d: Vec<f64> = self.over(rows).collect();
        impulses_of_work(&d, rates, works, &mut self.added);
    }
}
