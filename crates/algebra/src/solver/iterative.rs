//! Conjugate gradients with the inverse of the diagonal blocks of nodes as preconditioner (Saad 2003, section 9.2).
//!
//! In a dynamic step the mass term bounds the condition number by about 1 + (c Δt/h)², with c the speed of waves and h the size of an
//! element, whatever the number of unknowns: iterations do not grow with the mesh at a given Courant number. No factor, no memory
//! beyond the matrix and some vectors.

use carom_ranks::{Engine, OwnRows, Ranks};
use rayon::prelude::*;

use crate::dense::DenseCholesky;
use crate::reduce::dot;
use crate::{Error, csr::Csr};

/// Rows that one thread multiplies at a time.
const CHUNK: usize = 4096;

/// Iterations without a smaller residual after which rounding lets it fall no further.
const PATIENCE: usize = 60;

/// Factor of the tolerance up to which a residual that falls no further is a solution.
const NEAR: f64 = 1e3;

/// A symmetric positive definite matrix that is solved with by iterations.
pub struct Iterative {
    matrix: Csr,
    /// First unknown of each block, and an end.
    starts: Vec<u32>,
    /// Inverses of the blocks, row-major, one after the other.
    inverses: Vec<f64>,
    /// Where each begins.
    places: Vec<usize>,
    residual: Vec<f64>,
    preconditioned: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
    best: Vec<f64>,
    /// Products with the matrix so far.
    products: usize,
    /// Who shares the rows of products, and where the parts of each begin.
    ranks: Ranks,
    parts: Vec<usize>,
    /// Place of the node of each block, m; empty in one process.
    nodes: Vec<[f64; 3]>,
    /// What solves without contacts in place of the iterations here, of ranks that have it.
    engine: Option<Box<dyn Engine>>,
}

impl Iterative {
    /// `group_of[i]`: node of unknown i; those of a node follow each other.
    ///
    /// # Errors
    /// A block on the diagonal that is not positive definite or not finite; `group_of` of the wrong length.
    pub fn new(matrix: Csr, group_of: &[u32]) -> Result<Self, Error> {
        if group_of.len() != matrix.n {
            return Err(Error::WrongLength {
                what: "groups of unknowns",
                expected: matrix.n,
                found: group_of.len(),
            });
        }
        let begins = |&i: &usize| i == 0 || group_of[i] != group_of[i - 1];
        let starts = (0..matrix.n).filter(begins).chain([matrix.n]);
        let mut solver = Self {
            starts: starts.map(|i| i as u32).collect(),
            inverses: Vec::new(),
            places: Vec::new(),
            residual: vec![0.0; matrix.n],
            preconditioned: vec![0.0; matrix.n],
            direction: vec![0.0; matrix.n],
            image: vec![0.0; matrix.n],
            best: vec![0.0; matrix.n],
            products: 0,
            ranks: Ranks::alone(),
            parts: vec![0, matrix.n],
            nodes: Vec::new(),
            engine: None,
            matrix,
        };
        solver.invert()?;
        Ok(solver)
    }

    /// Shares the rows of products with other ranks, which all have the matrix: each multiplies its own and is given the others. Ranks that
    /// have an engine ([`Ranks::has_engine`]) solve with it. `place`: of the node of an unknown, m.
    ///
    /// # Errors
    /// [`Error::Engine`].
    pub fn on(mut self, ranks: &Ranks, place: impl Fn(usize) -> [f64; 3]) -> Result<Self, Error> {
        if ranks.count() == 1 {
            return Ok(self);
        }
        let blocks = self.starts.len() - 1;
        let begins = ranks.starts(blocks).into_iter();
        self.parts = begins.map(|block| self.starts[block] as usize).collect();
        let firsts = self.starts[..blocks].iter();
        self.nodes = firsts.map(|&first| place(first as usize)).collect();
        self.ranks = ranks.clone();
        self.take_engine()?;
        Ok(self)
    }

    /// Gives the own rows to the engine, if there is one.
    fn take_engine(&mut self) -> Result<(), Error> {
        if !self.ranks.has_engine() {
            return Ok(());
        }
        // its solver before goes first, of which memory may have no room for two
        self.engine = None;
        let rows = self.own_rows();
        self.engine = self
            .ranks
            .engine(&rows)
            .map_err(|cause| Error::Engine { cause })?;
        Ok(())
    }

    fn own_rows(&self) -> OwnRows<'_> {
        let rank = self.ranks.rank();
        let own = self.parts[rank]..self.parts[rank + 1];
        let sizes = self.starts.windows(2).map(|pair| pair[1] - pair[0]);
        let block = sizes.clone().next().unwrap_or(1);
        // two or three displacements at each node
        let alike = (2..=3).contains(&block) && sizes.clone().all(|size| size == block);
        let mut rows = OwnRows {
            starts: &self.parts,
            offsets: vec![0],
            columns: Vec::new(),
            values: Vec::new(),
            block: if alike { block as usize } else { 1 },
            places: Vec::new(),
        };
        for i in own.clone() {
            let (columns, values) = self.matrix.row(i);
            rows.columns.extend(columns.iter().map(|j| *j as i32));
            rows.values.extend_from_slice(values);
            rows.offsets.push(rows.values.len() as i32);
        }
        if alike {
            let dim = block as usize;
            let places = &self.nodes[own.start / dim..own.end / dim];
            rows.places = places.iter().flat_map(|x| x[..dim].to_vec()).collect();
        }
        rows
    }

    /// Takes another matrix with the same unknowns.
    ///
    /// # Errors
    /// A block on the diagonal that is not positive definite or not finite; [`Error::Engine`].
    pub fn renew(&mut self, matrix: Csr) -> Result<(), Error> {
        self.matrix = matrix;
        self.invert()?;
        self.take_engine()
    }

    /// Inverts the blocks on the diagonal.
    fn invert(&mut self) -> Result<(), Error> {
        self.inverses.clear();
        self.places.clear();
        let mut block = Vec::new();
        for pair in self.starts.windows(2) {
            let (first, n) = (pair[0] as usize, (pair[1] - pair[0]) as usize);
            block.clear();
            for i in first..first + n {
                block.extend((first..first + n).map(|j| self.matrix.get(i, j)));
            }
            let refused = |_| Error::NotPositiveDefinite {
                unknown: first,
                diagonal: self.matrix.get(first, first),
            };
            let factor = DenseCholesky::new(n, &block).map_err(refused)?;
            let place = self.inverses.len();
            self.places.push(place);
            self.inverses.resize(place + n * n, 0.0);
            for k in 0..n {
                let column = &mut self.inverses[place + k * n..place + (k + 1) * n];
                column[k] = 1.0;
                factor.solve(column);
            }
        }
        Ok(())
    }

    /// The matrix.
    pub fn matrix(&self) -> &Csr {
        &self.matrix
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.matrix.n
    }

    /// y = A x. Threads and ranks share the rows; an entry has the same bits on any number of them.
    pub fn multiply(&mut self, x: &[f64], y: &mut [f64]) {
        self.products += 1;
        let matrix = &self.matrix;
        let rank = self.ranks.rank();
        let [first, end] = [self.parts[rank], self.parts[rank + 1]];
        let chunks = y[first..end].par_chunks_mut(CHUNK).enumerate();
        chunks.for_each(|(k, chunk)| {
            for (i, y) in chunk.iter_mut().enumerate() {
                let (columns, values) = matrix.row(first + k * CHUNK + i);
                let mut sum = 0.0;
                for (&j, a) in columns.iter().zip(values) {
                    sum += a * x[j as usize];
                }
                *y = sum;
            }
        });
        self.ranks.gather(&mut y[..matrix.n], &self.parts);
    }

    /// z = G⁻¹ r, with G the blocks on the diagonal.
    pub fn precondition(&self, r: &[f64], z: &mut [f64]) {
        for (block, pair) in self.starts.windows(2).enumerate() {
            let range = pair[0] as usize..pair[1] as usize;
            let n = range.len();
            let inverse = &self.inverses[self.places[block]..];
            let r = &r[range.clone()];
            for (row, z) in inverse.chunks_exact(n).zip(&mut z[range]) {
                *z = row.iter().zip(r).map(|(a, r)| a * r).sum();
            }
        }
    }

    /// Entries of G⁻¹ in the row of an unknown: the first unknown of its block, and the entries from there on.
    pub fn inverse_row(&self, unknown: usize) -> (usize, &[f64]) {
        let block = self
            .starts
            .partition_point(|&start| start as usize <= unknown)
            - 1;
        let first = self.starts[block] as usize;
        let n = self.starts[block + 1] as usize - first;
        let place = self.places[block] + (unknown - first) * n;
        (first, &self.inverses[place..place + n])
    }

    /// x of A x = b, from x = 0, and the number of iterations. They end where |b - A x| falls below `tolerance` |b|, in the norm of G⁻¹.
    ///
    /// # Errors
    /// A direction along which the matrix is not positive; iterations that do not end.
    pub fn solve(&mut self, b: &[f64], x: &mut [f64], tolerance: f64) -> Result<usize, Error> {
        self.solve_within(b, x, (tolerance, usize::MAX))
    }

    /// As [`Iterative::solve`], in `most` iterations; an engine ([`Iterative::on`]) makes as many as it needs.
    ///
    /// # Errors
    /// Those of [`Iterative::solve`], and more iterations.
    pub fn solve_within(
        &mut self,
        b: &[f64],
        x: &mut [f64],
        (tolerance, most): (f64, usize),
    ) -> Result<usize, Error> {
        if let Some(engine) = &mut self.engine {
            let solved = engine.solve(b, x, tolerance);
            let iterations = *solved.as_ref().unwrap_or_else(|failed| &failed.iterations);
            self.products += iterations;
            return solved.map_err(|failed| Error::Engine {
                cause: format!(
                    "{} after {iterations} iterations, residual {:e}",
                    failed.cause, failed.residual
                ),
            });
        }
        x.fill(0.0);
        let mut residual = std::mem::take(&mut self.residual);
        let mut preconditioned = std::mem::take(&mut self.preconditioned);
        let mut direction = std::mem::take(&mut self.direction);
        let mut image = std::mem::take(&mut self.image);
        residual.copy_from_slice(b);
        self.precondition(&residual, &mut preconditioned);
        direction.copy_from_slice(&preconditioned);
        let first = dot(&residual, &preconditioned);
        let mut descent = Descent::new(first, tolerance);
        let mut now = first;
        while descent.goes_on() && descent.iterations < most {
            self.multiply(&direction, &mut image);
            let slope = dot(&direction, &image);
            if slope.is_nan() || slope <= 0.0 {
                descent.stop();
                break;
            }
            let step = now / slope;
            add_scaled(step, &direction, x);
            add_scaled(-step, &image, &mut residual);
            self.precondition(&residual, &mut preconditioned);
            let next = dot(&residual, &preconditioned);
            if descent.take(next) {
                self.best.copy_from_slice(x);
            }
            let share = next / now;
            for (p, z) in direction.iter_mut().zip(&preconditioned) {
                *p = z + share * *p;
            }
            now = next;
        }
        if descent.least < first {
            x.copy_from_slice(&self.best);
        }
        let worst = largest(&residual);
        (self.residual, self.preconditioned) = (residual, preconditioned);
        (self.direction, self.image) = (direction, image);
        descent.end(worst)
    }

    /// Products with the matrix so far.
    pub fn products(&self) -> usize {
        self.products
    }
}

/// When iterations end: at the tolerance, or where rounding lets the residual fall no further.
pub(super) struct Descent {
    /// Square of the residual at first and at least.
    first: f64,
    pub(super) least: f64,
    tolerance: f64,
    patience: usize,
    iterations: usize,
    broken: bool,
}

impl Descent {
    /// `first`: square of the residual that counts as one.
    pub(super) fn new(first: f64, tolerance: f64) -> Descent {
        Descent {
            first,
            least: first,
            tolerance,
            patience: PATIENCE,
            iterations: 0,
            broken: false,
        }
    }

    /// Begins with a residual of this square.
    pub(super) fn at(mut self, square: f64) -> Descent {
        self.least = square;
        self
    }

    pub(super) fn goes_on(&self) -> bool {
        !self.broken && self.least > self.tolerance.powi(2) * self.first && self.patience > 0
    }

    /// Counts an iteration with this square of the residual; whether it is the least.
    pub(super) fn take(&mut self, square: f64) -> bool {
        self.iterations += 1;
        let better = square < self.least;
        match better {
            true => {
                // a slow fall is a fall
                if square < 0.99 * self.least {
                    self.patience = PATIENCE;
                }
                self.least = square;
            }
            false => self.patience -= 1,
        }
        better
    }

    /// Ends the iterations: the matrix is not positive definite.
    pub(super) fn stop(&mut self) {
        self.broken = self.first > 0.0;
    }

    /// The number of iterations. `unknown`: the one with the largest residual.
    ///
    /// # Errors
    /// The residual is not near the tolerance.
    pub(super) fn end(&self, unknown: usize) -> Result<usize, Error> {
        let near = self.least <= (NEAR * self.tolerance).powi(2) * self.first;
        match near && !self.broken {
            true => Ok(self.iterations),
            false => Err(Error::Iterations {
                iterations: self.iterations,
                residual: (self.least / self.first).sqrt(),
                unknown,
            }),
        }
    }
}

/// y += a x.
pub(super) fn add_scaled(a: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += a * x;
    }
}

/// Place of the entry with the largest magnitude.
pub(super) fn largest(x: &[f64]) -> usize {
    let larger = |most: usize, i: usize| match x[i].abs() > x[most].abs() {
        true => i,
        false => most,
    };
    (0..x.len()).fold(0, larger)
}
