//! The interface problem by itself.

use carom_laws::Status;
use carom_nonsmooth::coulomb::{FrictionProblem, Slip, Tangential};
use carom_nonsmooth::interface::{Candidate, InterfaceProblem};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::errors::failed;

/// Forces p of `0 <= q + D p, p >= 0, p (q + D p) = 0`, whether each point is closed, and the number of passes.
#[pyfunction]
pub(crate) fn solve_normal(
    py: Python<'_>,
    d: PyReadonlyArray2<'_, f64>,
    q: PyReadonlyArray1<'_, f64>,
) -> PyResult<(Vec<f64>, Vec<bool>, usize)> {
    let problem = InterfaceProblem {
        step: 0,
        names: Vec::new(),
        candidates: q
            .as_slice()?
            .iter()
            .copied()
            .map(Candidate::unilateral)
            .collect(),
        compliance: d.as_slice()?.to_vec(),
        factors: [1.0, 0.0],
    };
    let solution = py.detach(|| problem.solve());
    let solution = solution.map_err(|error| failed(&error))?;
    let closed = solution.statuses.iter().map(|s| *s != Status::Open);
    Ok((solution.forces, closed.collect(), solution.passes))
}

/// Forces of all rows, statuses of the points, passes and sweeps.
type WithFriction = (Vec<f64>, Vec<u8>, (usize, usize));

/// Normal and tangential forces with friction; each point has its normal row and then its tangents. Statuses: 0 open, 1 sticks, 2 slips.
#[pyfunction]
pub(crate) fn solve_friction(
    py: Python<'_>,
    d: PyReadonlyArray2<'_, f64>,
    q: PyReadonlyArray1<'_, f64>,
    mu: Vec<f64>,
    rules: (usize, f64),
) -> PyResult<WithFriction> {
    let (tangents, tolerance) = rules;
    let rows: Vec<&[f64]> = q.as_slice()?.chunks_exact(1 + tangents).collect();
    let friction = rows.iter().zip(&mu).map(|(row, &mu)| {
        let mut free = [0.0; 2];
        free[..tangents].copy_from_slice(&row[1..]);
        Tangential {
            mu,
            free,
            ..Tangential::default()
        }
    });
    let problem = FrictionProblem {
        step: 0,
        names: Vec::new(),
        friction: friction.collect(),
        candidates: rows
            .iter()
            .map(|row| Candidate::unilateral(row[0]))
            .collect(),
        tangents,
        compliance: d.as_slice()?.to_vec(),
        factors: [1.0, 0.0, 1.0],
        tolerance,
    };
    let solution = py.detach(|| problem.solve());
    let solution = solution.map_err(|error| failed(&error))?;
    let mut forces = Vec::with_capacity(problem.candidates.len() * (1 + tangents));
    for (normal, tangential) in solution.forces.iter().zip(&solution.tangential) {
        forces.push(*normal);
        forces.extend(&tangential[..tangents]);
    }
    let both = solution.slips.iter().zip(&solution.statuses);
    let statuses = both.map(|(slip, status)| match (slip, status) {
        (_, Status::Open) | (Slip::Open, _) => 0,
        (Slip::Stick, _) => 1,
        (Slip::Slip, _) => 2,
    });
    Ok((
        forces,
        statuses.collect(),
        (solution.passes, solution.sweeps),
    ))
}
