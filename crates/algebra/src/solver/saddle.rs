//! Constrained motions by iterations: forces P of some rows N with `N A⁻¹ Nᵀ P + K P = b`, without a column of A⁻¹ Nᵀ.
//!
//! Motion x = A⁻¹ (r + Nᵀ P) and forces are found together, from
//!
//! `[A, Nᵀ; N, -K] [x; -P] = [r; b]`, preconditioned by `[G, Nᵀ; N, -K]`
//!
//! with G the blocks of nodes on the diagonal of A and K a diagonal of compliances. All iterates obey the second row, and on them the
//! iteration is one of conjugate gradients (Dollar, Gould, Schilders and Wathen 2006): it costs a product with A, like that of a motion without
//! constraints, and a solve with N G⁻¹ Nᵀ + K, which couples only rows that share a node.

use std::mem;

use super::cholesky::Cholesky;
use super::iterative::{Descent, Iterative, add_scaled, largest};
use super::response::SparseRow;
use crate::pattern::Cliques;
use crate::reduce::dot;
use crate::{Error, csr::Csr};

/// Rows, the matrices that they act on, and memory.
#[derive(Default)]
pub struct Saddle {
    /// Matrices one after the other, and the first unknown of each.
    operators: Vec<(usize, Box<Iterative>)>,
    rows: Vec<SparseRow>,
    /// G⁻¹ Nᵀ, by row.
    lifted: Vec<SparseRow>,
    /// r, and its square in the norm of G⁻¹.
    load: Vec<f64>,
    /// Forces of rows that are in it.
    loaded: Vec<f64>,
    square: f64,
    /// Motion of forces that were given, and of those that were found, with that of the load.
    given: Vec<f64>,
    found: Vec<f64>,
    /// -P of all rows.
    multipliers: Vec<f64>,
    /// Rows and compliances of the factor, and the factor of N G⁻¹ Nᵀ + K.
    factor_of: (Vec<u32>, Vec<f64>),
    factor: Option<Cholesky>,
    /// Rows, compliances and b of the iterations that have ended, which go on where nothing of it changes.
    of: (Vec<u32>, Vec<f64>, Vec<f64>),
    /// Forces of these rows, and the square of the residual; none where iterations cannot go on.
    lambda: Vec<f64>,
    now: Option<f64>,
    residual: Vec<f64>,
    /// Whether the residual is r - A x of the motion found, without forces of rows.
    free: bool,
    preconditioned: [Vec<f64>; 2],
    direction: [Vec<f64>; 2],
    image: Vec<f64>,
    best: [Vec<f64>; 2],
    /// Residual over that of no motion at which iterations end.
    tolerance: f64,
}

impl Saddle {
    /// Begins with these matrices, the first unknown of each, and rows over all their unknowns. Nothing moves. Iterations will end where the
    /// residual falls below `tolerance` times that of no motion, in the norm of G⁻¹. `load`: fills in r, which is zero where it does not.
    pub fn begin(
        &mut self,
        operators: Vec<(usize, Box<Iterative>)>,
        rows: impl Iterator<Item = SparseRow>,
        (tolerance, load): (f64, impl FnOnce(&mut [f64])),
    ) {
        self.tolerance = tolerance;
        let n = operators
            .iter()
            .map(|(first, of)| first + of.unknowns())
            .max()
            .unwrap_or(0);
        self.operators = operators;
        self.rows.clear();
        self.rows.extend(rows);
        let mut lifted = mem::take(&mut self.lifted);
        lifted.clear();
        lifted.extend(self.rows.iter().map(|row| self.lift(row)));
        self.lifted = lifted;
        let [one, two] = &mut self.preconditioned;
        for vector in [
            &mut self.load,
            &mut self.given,
            &mut self.found,
            &mut self.residual,
            one,
            &mut self.direction[0],
            &mut self.image,
            &mut self.best[0],
        ] {
            vector.clear();
            vector.resize(n, 0.0);
        }
        two.clear();
        self.multipliers.clear();
        self.multipliers.resize(self.rows.len(), 0.0);
        (self.factor, self.now, self.free) = (None, None, false);
        load(&mut self.load);
        self.loaded.clear();
        self.measure_load();
    }

    fn measure_load(&mut self) {
        for (first, operator) in &self.operators {
            let range = *first..*first + operator.unknowns();
            let z = &mut self.preconditioned[0][range.clone()];
            operator.precondition(&self.load[range], z);
        }
        self.square = dot(&self.load, &self.preconditioned[0]);
    }

    /// Adds forces of the first rows to the load of the begin, in place of others that were added before.
    pub fn load_with(&mut self, forces: &[f64]) {
        let zeros = |forces: &[f64]| forces.iter().all(|force| *force == 0.0);
        if self.loaded == forces || self.loaded.is_empty() && zeros(forces) {
            return;
        }
        let now = self.now.take();
        self.loaded.resize(forces.len(), 0.0);
        for (row, (force, before)) in self.rows.iter().zip(forces.iter().zip(&self.loaded)) {
            if force != before {
                add_row(row, force - before, &mut self.load);
                add_row(row, force - before, &mut self.residual);
            }
        }
        self.loaded.copy_from_slice(forces);
        self.measure_load();
        if now.is_some() {
            self.now = Some(self.turn_anew());
        }
    }

    /// Adds a row along a direction between two others; its number.
    pub fn add_row_along(&mut self, rows: [u32; 2], direction: [f64; 2]) -> u32 {
        let mut row = SparseRow::default();
        for (&of, share) in rows.iter().zip(direction) {
            let of = &self.rows[of as usize];
            row.dofs.extend_from_slice(&of.dofs);
            let own = of.coefficients.iter().map(|n| share * n);
            row.coefficients.extend(own);
        }
        self.lifted.push(self.lift(&row));
        self.rows.push(row);
        self.multipliers.push(0.0);
        self.rows.len() as u32 - 1
    }

    /// Forgets all rows but the first `count`.
    pub fn keep_rows(&mut self, count: usize) {
        if count < self.rows.len() {
            self.release();
            self.rows.truncate(count);
            self.lifted.truncate(count);
            self.multipliers.truncate(count);
        }
    }

    /// Takes the forces of rows out of the residual, which then stands whatever rows are next.
    fn release(&mut self) {
        if self.now.take().is_some() {
            for (&row, lambda) in self.of.0.iter().zip(&self.lambda) {
                add_row(&self.rows[row as usize], *lambda, &mut self.residual);
            }
            self.free = true;
        }
    }

    /// Gives the matrices back.
    pub fn end(&mut self) -> Vec<(usize, Box<Iterative>)> {
        mem::take(&mut self.operators)
    }

    /// N G⁻¹ Nᵀ of a row: zero where no force moves it.
    pub fn diagonal(&self, row: usize) -> f64 {
        self.entry(row, row)
    }

    /// N G⁻¹ Nᵀ of two rows.
    pub fn entry(&self, row: usize, other: usize) -> f64 {
        product(&self.rows[row], &self.lifted[other])
    }

    /// N x of a row.
    pub fn along(&self, row: usize) -> f64 {
        self.along_given(row) + sparse_dot(&self.rows[row], &self.found)
    }

    /// N x of a row, of the motion that was given.
    pub fn along_given(&self, row: usize) -> f64 {
        sparse_dot(&self.rows[row], &self.given)
    }

    /// Adds the motion of the load and of all forces, times a factor, to a vector over all unknowns.
    pub fn add_motion(&self, factor: f64, y: &mut [f64]) {
        add_scaled(factor, &self.given, y);
        add_scaled(factor, &self.found, y);
    }

    /// Takes the motion of some forces of all rows as given, and says whether it is one; forgets the one found if it is.
    ///
    /// # Errors
    /// Iterations that do not end.
    pub fn give(&mut self, forces: &[f64]) -> Result<bool, Error> {
        self.given.fill(0.0);
        if forces.iter().all(|force| *force == 0.0) {
            return Ok(false);
        }
        self.rest();
        let mut load = vec![0.0; self.given.len()];
        for (row, force) in self.rows.iter().zip(forces) {
            add_row(row, *force, &mut load);
        }
        for (first, operator) in &mut self.operators {
            let range = *first..*first + operator.unknowns();
            let (load, motion) = (&load[range.clone()], &mut self.given[range]);
            operator.solve(load, motion, self.tolerance)?;
        }
        Ok(true)
    }

    /// Forgets the motion found.
    fn rest(&mut self) {
        self.found.fill(0.0);
        self.multipliers.fill(0.0);
        (self.now, self.free) = (None, false);
    }

    /// b ← P of some rows, ascending, with `N x + K P = b`; the other rows have no force. `own`: K of these rows, not negative. Iterations begin with
    /// the motion found last, and go on where they have ended for the same rows and b. They end at `tolerance` where that is larger than the one
    /// that they have begun with, and then wherever rounding lets them.
    ///
    /// # Errors
    /// Rows that depend on each other, of which none has a compliance; iterations that do not end.
    pub fn solve(
        &mut self,
        (points, own): (&[u32], &[f64]),
        tolerance: f64,
        b: &mut [f64],
    ) -> Result<(), Error> {
        self.factorise(points, own)?;
        let mut cold = b.to_vec();
        self.of_factor(&mut cold);
        let first = self.square + dot(b, &cold);
        let (of, compliances, target) = &self.of;
        let same = of == points && compliances == own && target == b;
        let now = match self.now.filter(|_| same) {
            Some(now) => now,
            None => self.start((points, own), b),
        };
        let rough = tolerance > self.tolerance;
        let descent = Descent::new(first, tolerance.max(self.tolerance)).at(now);
        let ended = self.descend((points, own), (descent, now), rough);
        self.multipliers.fill(0.0);
        for ((&k, lambda), force) in points.iter().zip(&self.lambda).zip(b) {
            self.multipliers[k as usize] = *lambda;
            *force = -lambda;
        }
        match rough {
            true => Ok(()),
            false => ended,
        }
    }

    /// Begins iterations for some rows at the motion found last; the square of the residual.
    fn start(&mut self, (points, own): (&[u32], &[f64]), b: &[f64]) -> f64 {
        self.release();
        self.of = (points.to_vec(), own.to_vec(), b.to_vec());
        let mut lambda = mem::take(&mut self.lambda);
        lambda.clear();
        lambda.extend(points.iter().map(|&k| self.multipliers[k as usize]));
        self.obey((points, own), b, &mut lambda);
        self.lambda = lambda;
        self.turn_anew()
    }

    /// Makes the direction that of the residual; the square of this.
    fn turn_anew(&mut self) -> f64 {
        let points = mem::take(&mut self.of.0);
        self.precondition(&points, None);
        self.of.0 = points;
        let [z, y] = &self.preconditioned;
        self.direction[0].clone_from(z);
        self.direction[1].clone_from(y);
        dot(&self.residual, z)
    }

    /// The iterations, from the square of the residual `now`. Of rough ones the last iterate is taken, of others the best.
    fn descend(
        &mut self,
        (points, own): (&[u32], &[f64]),
        (mut descent, mut now): (Descent, f64),
        rough: bool,
    ) -> Result<(), Error> {
        let mut last_is_best = true;
        if !rough {
            self.keep();
        }
        while descent.goes_on() {
            let curvature = self.apply(points, own);
            if curvature.is_nan() || curvature <= 0.0 {
                descent.stop();
                last_is_best = false;
                break;
            }
            self.advance(now / curvature);
            self.restrain(points, None);
            let next = dot(&self.residual, &self.preconditioned[0]);
            last_is_best = descent.take(next) || rough;
            if last_is_best && !rough {
                self.keep();
            }
            self.turn(next / now);
            now = next;
        }
        self.now = last_is_best.then_some(now);
        if !rough {
            self.found.copy_from_slice(&self.best[0]);
            self.lambda.clone_from(&self.best[1]);
        }
        descent.end(largest(&self.residual)).map(|_| ())
    }

    /// Goes a step along the direction, and divides the residual by G.
    fn advance(&mut self, step: f64) {
        let [p, q] = &self.direction;
        for (first, operator) in &self.operators {
            let range = *first..*first + operator.unknowns();
            let moved = [
                &mut self.found[range.clone()],
                &mut self.residual[range.clone()],
                &mut self.preconditioned[0][range.clone()],
            ];
            operator.advance(step, [&p[range.clone()], &self.image[range]], moved);
        }
        add_scaled(step, q, &mut self.lambda);
    }

    /// The next direction: what is preconditioned, and a `share` of the direction before.
    fn turn(&mut self, share: f64) {
        let ([z, y], [p, q]) = (&self.preconditioned, &mut self.direction);
        for (first, operator) in &self.operators {
            let range = *first..*first + operator.unknowns();
            operator.turn(share, &z[range.clone()], &mut p[range]);
        }
        for (q, y) in q.iter_mut().zip(y) {
            *q = y + share * *q;
        }
    }

    /// Keeps the iterate as the best.
    fn keep(&mut self) {
        self.best[0].copy_from_slice(&self.found);
        self.best[1].clone_from(&self.lambda);
    }

    /// Moves an iterate to one that obeys N x - K λ = b, and finds its residual.
    fn obey(&mut self, (points, own): (&[u32], &[f64]), b: &[f64], lambda: &mut [f64]) {
        if !mem::take(&mut self.free) {
            self.residual.copy_from_slice(&self.load);
            if self.found.iter().any(|x| *x != 0.0) {
                self.direction[0].copy_from_slice(&self.found);
                self.direction[1].clear();
                self.apply(&[], &[]);
                add_scaled(-1.0, &self.image, &mut self.residual);
            }
        }
        let mut second = b.to_vec();
        for (k, (left, &row)) in second.iter_mut().zip(points).enumerate() {
            let row = &self.rows[row as usize];
            add_row(row, -lambda[k], &mut self.residual);
            *left += own[k] * lambda[k] - sparse_dot(row, &self.found);
        }
        self.precondition(points, Some(&second));
        self.direction[0].copy_from_slice(&self.preconditioned[0]);
        self.direction[1].clone_from(&self.preconditioned[1]);
        self.apply(points, own);
        add_scaled(1.0, &self.direction[0], &mut self.found);
        add_scaled(1.0, &self.direction[1], lambda);
        add_scaled(-1.0, &self.image, &mut self.residual);
    }

    /// image = A p + Nᵀ q of the direction [p; q]; returns pᵀ A p + qᵀ K q.
    fn apply(&mut self, points: &[u32], own: &[f64]) -> f64 {
        let [p, q] = &self.direction;
        for (first, operator) in &mut self.operators {
            let range = *first..*first + operator.unknowns();
            operator.multiply(&p[range.clone()], &mut self.image[range]);
        }
        let of_motion = dot(p, &self.image);
        for (&row, q) in points.iter().zip(q) {
            add_row(&self.rows[row as usize], *q, &mut self.image);
        }
        of_motion + own.iter().zip(q).map(|(own, q)| own * q * q).sum::<f64>()
    }

    /// [z; y] of G z + Nᵀ y = r and N z - K y = s, with r the residual and s zero unless given.
    fn precondition(&mut self, points: &[u32], second: Option<&[f64]>) {
        let z = &mut self.preconditioned[0];
        for (first, operator) in &self.operators {
            let range = *first..*first + operator.unknowns();
            operator.precondition(&self.residual[range.clone()], &mut z[range]);
        }
        self.restrain(points, second);
    }

    /// The same where z is G⁻¹ r already.
    fn restrain(&mut self, points: &[u32], second: Option<&[f64]>) {
        let [mut z, mut y] = mem::take(&mut self.preconditioned);
        y.clear();
        y.extend(
            points
                .iter()
                .map(|&row| sparse_dot(&self.rows[row as usize], &z)),
        );
        if let Some(second) = second {
            add_scaled(-1.0, second, &mut y);
        }
        self.of_factor(&mut y);
        for (&row, y) in points.iter().zip(&y) {
            add_row(&self.lifted[row as usize], -y, &mut z);
        }
        self.preconditioned = [z, y];
    }

    /// y ← (N G⁻¹ Nᵀ + K)⁻¹ y.
    fn of_factor(&mut self, y: &mut [f64]) {
        if let Some(factor) = &mut self.factor {
            factor.solve(y);
        }
    }

    /// Brings the factor of N G⁻¹ Nᵀ + K up to date for some rows.
    fn factorise(&mut self, points: &[u32], own: &[f64]) -> Result<(), Error> {
        let (of, compliances) = &self.factor_of;
        if self.factor.is_some() && of == points && compliances == own {
            return Ok(());
        }
        if points.is_empty() {
            self.factor = None;
            return Ok(());
        }
        let matrix = self.schur(points, own);
        let numbers: Vec<u32> = (0..points.len() as u32).collect();
        self.factor = Some(Cholesky::new(&matrix, &numbers)?);
        self.factor_of = (points.to_vec(), own.to_vec());
        Ok(())
    }

    /// N G⁻¹ Nᵀ + K of some rows.
    fn schur(&self, points: &[u32], own: &[f64]) -> Csr {
        let rows = || {
            points
                .iter()
                .map(|&row| &self.rows[row as usize])
                .enumerate()
        };
        let mut touched: Vec<(u32, u32, f64)> = rows()
            .flat_map(|(k, row)| {
                let terms = row.dofs.iter().zip(&row.coefficients);
                terms.map(move |(&i, &n)| (i, k as u32, n))
            })
            .collect();
        touched.sort_unstable_by_key(|&(i, k, _)| (i, k));
        let of_unknown = |i: u32| {
            let begin = touched.partition_point(|other| other.0 < i);
            touched[begin..]
                .iter()
                .take_while(move |other| other.0 == i)
        };
        let mut cliques = Cliques::new();
        let mut list = Vec::new();
        for k in 0..points.len() {
            list.clear();
            list.push(k as u32);
            let lifted = &self.lifted[points[k] as usize];
            let others = lifted.dofs.iter().flat_map(|&i| of_unknown(i));
            list.extend(others.map(|&(_, other, _)| other));
            list.sort_unstable();
            list.dedup();
            for &other in list.iter().filter(|&&other| other > k as u32) {
                cliques.push(&[k as u32, other]);
            }
        }
        let mut matrix = Csr::from_cliques(points.len(), &cliques);
        for (k, &row) in points.iter().enumerate() {
            matrix.add(k, k, own[k]);
            let lifted = &self.lifted[row as usize];
            for (&i, g) in lifted.dofs.iter().zip(&lifted.coefficients) {
                for &(_, other, n) in of_unknown(i).filter(|other| other.1 as usize >= k) {
                    matrix.add(k, other as usize, g * n);
                    if other as usize > k {
                        matrix.add(other as usize, k, g * n);
                    }
                }
            }
        }
        matrix
    }

    /// G⁻¹ Nᵀ of a row.
    fn lift(&self, row: &SparseRow) -> SparseRow {
        let mut terms: Vec<(u32, f64)> = Vec::new();
        for (&unknown, n) in row.dofs.iter().zip(&row.coefficients) {
            let after = self
                .operators
                .partition_point(|(first, _)| *first <= unknown as usize);
            let (first, operator) = &self.operators[after - 1];
            let (begin, entries) = operator.inverse_row(unknown as usize - first);
            let entries = entries.iter().enumerate();
            terms.extend(entries.map(|(k, g)| ((first + begin + k) as u32, g * n)));
        }
        terms.sort_by_key(|term| term.0);
        let mut lifted = SparseRow::default();
        for (unknown, term) in terms {
            match (lifted.dofs.last(), lifted.coefficients.last_mut()) {
                (Some(&last), Some(sum)) if last == unknown => *sum += term,
                _ => {
                    lifted.dofs.push(unknown);
                    lifted.coefficients.push(term);
                }
            }
        }
        lifted
    }
}

/// Product of a row with one whose unknowns ascend.
fn product(row: &SparseRow, lifted: &SparseRow) -> f64 {
    let of = |i: &u32| {
        lifted
            .dofs
            .binary_search(i)
            .map_or(0.0, |k| lifted.coefficients[k])
    };
    row.dofs
        .iter()
        .zip(&row.coefficients)
        .map(|(i, n)| n * of(i))
        .sum()
}

/// N x.
fn sparse_dot(row: &SparseRow, x: &[f64]) -> f64 {
    row.dofs
        .iter()
        .zip(&row.coefficients)
        .map(|(&i, n)| n * x[i as usize])
        .sum()
}

/// y += a Nᵀ.
fn add_row(row: &SparseRow, a: f64, y: &mut [f64]) {
    for (&i, n) in row.dofs.iter().zip(&row.coefficients) {
        y[i as usize] += a * n;
    }
}
