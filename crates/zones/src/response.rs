//! H: the velocity that multipliers leave in the rows of the links, without contact and of the linearised zones.
//!
//! H of few rows is made, column by column, and factored. Of more rows nothing is made that grows with their square: where each zone
//! takes one step with a multiplier, the rows join the matrices of the implicit zones ([`Joined`]); where zones take several steps, H
//! times a vector is what these steps make of it, and `H ΔL = r` is solved by conjugate gradients ([`IteratedLinks`]).

use std::time::Instant;

use carom_algebra::dense::DenseCholesky;

use crate::error::Error;
use crate::iterated::IteratedLinks;
use crate::joined::{answer, hold_empty_rows};
use crate::link_solver::{LinkSolver, OuterResponse};
use crate::model::LinkKind;
use crate::zones::Zones;
use carom_dynamics::condensed::{Answer, Condensed, DENSE, Joined};
use carom_dynamics::linearised::{Answered, Growth, Steps};

/// Rows above which H of unequal steps is not made at once. A column costs as much as a product with H, and iterations take some ten of these in
/// each outer step. H of more rows, up to [`DENSE`], is made once as many products were: no run then costs more than twice what the
/// better choice would have.
const FEW: usize = 300;

impl Zones {
    /// Solves `H ΔL = r` from now on as with many rows, without H: to compare the two.
    ///
    /// # Errors
    /// Redundant rows, an effective matrix that is not positive definite.
    pub fn solve_without_matrix(&mut self) -> Result<(), Error> {
        let equal = self.clock.substeps.iter().all(|m| *m == 1);
        if !equal && self.links.kind == LinkKind::PrakashHjelmstad {
            let zones = (&mut self.drivers[..], &self.response.origins[..]);
            let links = (&self.links.rows, self.links.norms.len());
            let iterated = IteratedLinks::new(zones, links, (&self.clock.substeps, self.clock.dt))?;
            self.response.solver = Some(LinkSolver::Iterated(Box::new(iterated)));
            return Ok(());
        }
        if !equal {
            let zones = self.drivers.iter_mut().zip(&self.response.origins);
            let outer = zones
                .zip(&self.clock.substeps)
                .map(|((driver, origin), m)| {
                    let zone = (*m == 1).then(|| driver.linearised(origin));
                    zone.transpose()
                });
            self.response.outer = OuterResponse::Steps(outer.collect::<Result<_, _>>()?);
        }
        self.response.solver = Some(LinkSolver::Factor(self.joined()?));
        Ok(())
    }

    fn joined(&self) -> Result<Condensed, Error> {
        let zones = self.drivers.iter().zip(&self.links.rows);
        let answers: Vec<Answer> = zones
            .map(|(driver, rows)| {
                let (mass, stiffness, velocity) = driver.effective();
                let scale = velocity * driver.link_weights()[1];
                answer((driver.system(), rows), [mass, stiffness], scale)
            })
            .collect();
        let joined = Joined::new(&answers, self.links.norms.len())?;
        Ok(Condensed::Joined(Box::new(joined)))
    }

    /// Makes and factors H of the multipliers that a pass looks for.
    pub(crate) fn factorise(&mut self) -> Result<(), Error> {
        let begin = Instant::now();
        let made = self.make_solver();
        self.response.link_time += begin.elapsed();
        made
    }

    fn make_solver(&mut self) -> Result<(), Error> {
        if let Some(links) = &mut self.links.turning {
            links.at_origins(&self.response.origins, &mut self.links.rows);
        }
        let n = self.links.norms.len();
        let equal = self.clock.substeps.iter().all(|m| *m == 1);
        let few = match equal || self.response.products[0] >= n as u64 {
            true => DENSE,
            false => FEW,
        };
        match (n, n > few) {
            (0, _) => Ok(()),
            (_, false) => self.factorise_dense(),
            (_, true) => self.solve_without_matrix(),
        }
    }

    fn factorise_dense(&mut self) -> Result<(), Error> {
        let n = self.links.norms.len();
        let (mut h, mut outer) = (vec![0.0; n * n], vec![0.0; n * n]);
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            let rows = &self.links.rows[k];
            let steps = Steps {
                count: match self.links.kind {
                    LinkKind::GravouilCombescure => 1,
                    LinkKind::PrakashHjelmstad => self.clock.substeps[k],
                },
                growth: Growth::Linear,
            };
            let mut zone = driver.linearised(&self.response.origins[k])?;
            let [own, _] = driver.answers(&mut zone, rows, steps)?;
            for (i, (row, _)) in rows.iter().enumerate() {
                for (j, (column, _)) in rows.iter().enumerate() {
                    let place = *row as usize * n + *column as usize;
                    let entry = 0.5 * (own[i * rows.len() + j] + own[j * rows.len() + i]);
                    h[place] += entry;
                    if self.clock.substeps[k] == 1 {
                        outer[place] += entry;
                    }
                }
            }
        }
        self.response.outer = OuterResponse::Matrix(outer);
        hold_empty_rows(n, &mut h);
        let factor = DenseCholesky::new(n, &h);
        let factor = factor.map_err(|cause| carom_dynamics::Error::Redundant { rows: n, cause })?;
        self.response.solver = Some(LinkSolver::Factor(Condensed::Dense(factor)));
        Ok(())
    }

    /// Makes H from the next step on where as many products were made as it has columns.
    pub(crate) fn judge_solver(&mut self) {
        let n = self.links.norms.len();
        let iterates = matches!(self.response.solver, Some(LinkSolver::Iterated(_)));
        if iterates && n <= DENSE && self.response.products[0] >= n as u64 {
            self.response.stale = true;
        }
    }

    /// ΔL of what the rows miss, in place.
    ///
    /// # Errors
    /// Iterations that do not end.
    pub(crate) fn solve_links(&mut self, goal: f64) -> Result<(), Error> {
        let begin = Instant::now();
        let solved = match &mut self.response.solver {
            None => Ok(()),
            Some(LinkSolver::Factor(factor)) => {
                factor.solve(&mut self.links.defect);
                Ok(())
            }
            Some(LinkSolver::Iterated(iterated)) => {
                let zones = (&mut self.drivers[..], &self.links.rows);
                let solved =
                    iterated.solve(zones, (&mut self.links.defect, &self.links.norms), goal);
                solved.map(|products| self.response.products[1] += products)
            }
        };
        self.response.link_time += begin.elapsed();
        solved
    }

    /// Adds to `out` the velocities that multipliers leave in the rows over one step of the zones with one step.
    pub(crate) fn add_outer_response(
        &mut self,
        multipliers: &[f64],
        (factor, out): (f64, &mut [f64]),
    ) -> Result<(), Error> {
        match &mut self.response.outer {
            OuterResponse::None => {}
            OuterResponse::Matrix(matrix) => {
                for (i, out) in out.iter_mut().enumerate() {
                    *out += factor * dot_row(matrix, i, multipliers);
                }
            }
            OuterResponse::Steps(zones) => {
                for ((zone, driver), rows) in zones
                    .iter_mut()
                    .zip(&mut self.drivers)
                    .zip(&self.links.rows)
                {
                    let Some(zone) = zone else { continue };
                    let steps = Steps {
                        count: 1,
                        growth: Growth::Linear,
                    };
                    let [mut ends, mut ways] = [vec![0.0; rows.len()], vec![0.0; rows.len()]];
                    let answered = Answered {
                        ends: &mut ends,
                        ways: &mut ways,
                    };
                    driver.answer(zone, (rows, multipliers), steps, answered)?;
                    for ((row, _), end) in rows.iter().zip(ends) {
                        out[*row as usize] += factor * end;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Row of a square matrix, row-major, times a vector.
fn dot_row(matrix: &[f64], row: usize, x: &[f64]) -> f64 {
    let n = x.len();
    let entries = matrix[row * n..(row + 1) * n].iter().zip(x);
    entries.map(|(a, x)| a * x).sum()
}
