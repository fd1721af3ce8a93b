//! Conjugate gradients with the inverse of the diagonal blocks of nodes as preconditioner (Saad 2003, section 9.2).
//!
//! In a dynamic step the mass term bounds the condition number by about 1 + (c Δt/h)², with c the speed of waves and h the size of an
//! element, whatever the number of unknowns: iterations do not grow with the mesh at a given Courant number. No factor, no memory
//! beyond half of the matrix and some vectors.

use std::ops::Range;

use carom_ranks::{Engine, OwnRows};
use rayon::prelude::*;

use super::response::SparseRow;
use super::shared_rows::SharedRows;
use super::symmetric_blocks::SymmetricBlocks;
use crate::dense::DenseCholesky;
use crate::reduce::dot;
use crate::{Error, csr::Csr};

/// Iterations without a smaller residual, near the tolerance, after which rounding lets it fall no further.
const PATIENCE: usize = 60;

/// Iterations without a smaller residual elsewhere: of matrices with a large condition number it rises for long.
const PATIENCE_AFAR: usize = 600;

/// Factor of the tolerance up to which a residual that falls no further is a solution.
const NEAR: f64 = 1e3;

/// Columns that an engine solves for together.
const TOGETHER: usize = 64;

/// Numbers of each unknown that an iteration reads or writes beside the product and the blocks of the preconditioner.
const VECTORS: usize = 16;

/// A symmetric positive definite matrix that is solved with by iterations.
pub struct Iterative {
    n: usize,
    /// Unknowns of a block.
    size: usize,
    matrix: SymmetricBlocks,
    /// Inverses of the blocks on the diagonal, row-major, one after the other.
    inverses: Vec<f64>,
    residual: Vec<f64>,
    preconditioned: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
    best: Vec<f64>,
    /// Products with the matrix so far.
    products: usize,
    /// Who shares the rows of products, and the first unknown of each rank.
    rows: SharedRows,
    starts: Vec<usize>,
    /// Places of the own nodes, m, where an engine may have the rows.
    nodes: Option<Vec<[f64; 3]>>,
    /// What solves without contacts in place of the iterations here, of ranks that have it.
    engine: Option<Box<dyn Engine>>,
}

impl Iterative {
    /// `group_of[i]`: node of unknown i; those of a node follow each other. The blocks of the preconditioner are those of [`SharedRows::alone`].
    ///
    /// # Errors
    /// A block on the diagonal that is not positive definite or not finite; `group_of` of the wrong length.
    pub fn new(matrix: &Csr, group_of: &[u32]) -> Result<Self, Error> {
        Iterative::on(matrix, SharedRows::alone(group_of))
    }

    /// Of ranks that share rows: each multiplies its own and is given the others. Of `matrix` the rows that this rank
    /// [needs](SharedRows::needed) are read. All ranks call each function together.
    ///
    /// # Errors
    /// As [`Iterative::new`], on all ranks.
    pub fn on(matrix: &Csr, rows: SharedRows) -> Result<Self, Error> {
        if rows.n != matrix.n {
            return Err(Error::WrongLength {
                what: "groups of unknowns",
                expected: matrix.n,
                found: rows.n,
            });
        }
        let blocks = SymmetricBlocks::new(matrix, &rows);
        let vector = || vec![0.0; matrix.n];
        let mut solver = Self {
            n: matrix.n,
            size: rows.size,
            inverses: vec![0.0; matrix.n * rows.size],
            residual: vector(),
            preconditioned: vector(),
            direction: vector(),
            image: vector(),
            best: vector(),
            products: 0,
            starts: rows.unknown_starts(),
            nodes: None,
            engine: None,
            matrix: blocks,
            rows,
        };
        solver.invert(matrix)?;
        Ok(solver)
    }

    /// Gives the own rows to the engine of ranks that have one ([`Ranks::has_engine`](carom_ranks::Ranks::has_engine)), which solves from then
    /// on. `place`: of the node of an unknown, m.
    ///
    /// # Errors
    /// [`Error::Engine`].
    pub fn engaged(
        mut self,
        (matrix, place): (&Csr, impl Fn(usize) -> [f64; 3]),
    ) -> Result<Self, Error> {
        if self.rows.are_shared() {
            let own = self.rows.engine_rows();
            self.nodes = Some(own.step_by(self.size).map(place).collect());
        }
        self.take_engine(matrix)?;
        Ok(self)
    }

    /// Gives the own rows to the engine, if there is one.
    fn take_engine(&mut self, matrix: &Csr) -> Result<(), Error> {
        let Some(nodes) = &self.nodes else {
            return Ok(());
        };
        if !self.rows.ranks().has_engine() {
            return Ok(());
        }
        // its solver before goes first, of which memory may have no room for two
        self.engine = None;
        let rows = own_rows(matrix, &self.rows, nodes);
        let engine = self.rows.ranks().engine(&rows);
        self.engine = engine.map_err(|cause| Error::Engine { cause })?;
        Ok(())
    }

    /// Inverses of the blocks on the diagonal: each rank inverts those of its own rows.
    fn invert(&mut self, matrix: &Csr) -> Result<(), Error> {
        let (size, ranks) = (self.size, self.rows.ranks());
        let own = self.rows.unknowns(&self.rows.own());
        let inverses = &mut self.inverses[size * own.start..size * own.end];
        let refused = invert_blocks(matrix, (size, own.start), inverses);
        // the first unknown of all ranks that is refused, with its diagonal
        let mut first = [refused.map_or(f64::NEG_INFINITY, |unknown| -(unknown as f64))];
        ranks.reduce(&mut [], &mut first);
        if first[0] > f64::NEG_INFINITY {
            let unknown = -first[0] as usize;
            let mut diagonal = [0.0];
            if own.contains(&unknown) {
                diagonal[0] = matrix.get(unknown, unknown);
            }
            ranks.reduce(&mut diagonal, &mut []);
            let [diagonal] = diagonal;
            return Err(Error::NotPositiveDefinite { unknown, diagonal });
        }
        let starts = self.starts.iter().map(|start| start * size);
        ranks.gather(&mut self.inverses, &starts.collect::<Vec<_>>());
        Ok(())
    }

    /// Takes another matrix with the same unknowns.
    ///
    /// # Errors
    /// A block on the diagonal that is not positive definite or not finite; [`Error::Engine`].
    pub fn renew(&mut self, matrix: &Csr) -> Result<(), Error> {
        self.invert(matrix)?;
        self.matrix.renew(matrix);
        self.take_engine(matrix)
    }

    /// Whether an engine solves with a factor.
    pub fn is_factored(&self) -> bool {
        self.engine
            .as_ref()
            .is_some_and(|engine| engine.is_factor())
    }

    /// A⁻¹ nᵀ of each row n at some unknowns, one row after the other, by the factor of an engine; whole on all ranks.
    ///
    /// # Errors
    /// [`Error::Engine`], without an engine too.
    pub fn columns(&mut self, rows: &[SparseRow], at: &[u32]) -> Result<Vec<f64>, Error> {
        let Some(engine) = &mut self.engine else {
            let cause = "there is none that has a factor".to_owned();
            return Err(Error::Engine { cause });
        };
        let mut columns = vec![0.0; rows.len() * at.len()];
        let own = self.rows.engine_rows();
        let mut solved = Ok(());
        let mut loads = Vec::new();
        let batches = columns.chunks_mut((TOGETHER * at.len()).max(1));
        for (rows, columns) in rows.chunks(TOGETHER).zip(batches) {
            loads.clear();
            loads.resize(rows.len() * own.len(), 0.0);
            for (k, row) in rows.iter().enumerate() {
                for (&unknown, n) in row.dofs.iter().zip(&row.coefficients) {
                    if own.contains(&(unknown as usize)) {
                        loads[k * own.len() + unknown as usize - own.start] += n;
                    }
                }
            }
            solved = solved.and(engine.sweep(&mut loads, rows.len()));
            for (k, column) in columns.chunks_mut(at.len().max(1)).enumerate() {
                for (entry, &unknown) in column.iter_mut().zip(at) {
                    if own.contains(&(unknown as usize)) {
                        *entry = loads[k * own.len() + unknown as usize - own.start];
                    }
                }
            }
            self.rows.ranks().reduce(columns, &mut []);
        }
        solved.map_err(|cause| Error::Engine { cause })?;
        Ok(columns)
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.n
    }

    /// Bytes that an iteration reads and writes, on all ranks together as many as in one process. All ranks call it together.
    pub fn bytes(&self) -> usize {
        let mut of_blocks = [self.matrix.bytes(self.rows.own()) as f64];
        self.rows.ranks().reduce(&mut of_blocks, &mut []);
        of_blocks[0] as usize + 8 * (self.inverses.len() + VECTORS * self.n)
    }

    /// Entries of the matrix that this rank keeps.
    pub fn entries(&self) -> usize {
        self.matrix.entries()
    }

    /// y = A x. Threads and ranks share the rows; an entry has the same bits on any number of them.
    pub fn multiply(&mut self, x: &[f64], y: &mut [f64]) {
        self.products += 1;
        self.matrix.multiply(self.rows.own(), x, y);
        self.rows.ranks().gather(&mut y[..self.n], &self.starts);
    }

    /// z = G⁻¹ r, with G the blocks on the diagonal.
    pub fn precondition(&self, r: &[f64], z: &mut [f64]) {
        let length = self.matrix.length();
        let blocks = self.inverses.par_chunks(length * self.size);
        let parts = z.par_chunks_mut(length).zip(r.par_chunks(length));
        let parts = parts.zip(blocks);
        parts.for_each(|((z, r), blocks)| multiply_blocks(self.size, blocks, r, z));
    }

    /// Goes a step along the direction p, with q = A p: x += `step` p and r -= `step` q; z = G⁻¹ r.
    pub(super) fn advance(&self, step: f64, [p, q]: [&[f64]; 2], [x, r, z]: [&mut [f64]; 3]) {
        let length = self.matrix.length();
        let blocks = self.inverses.par_chunks(length * self.size);
        let moved = x.par_chunks_mut(length).zip(p.par_chunks(length));
        let left = r.par_chunks_mut(length).zip(q.par_chunks(length));
        let parts = moved.zip(left).zip(z.par_chunks_mut(length)).zip(blocks);
        parts.for_each(|((((x, p), (r, q)), z), blocks)| {
            add_scaled(step, p, x);
            add_scaled(-step, q, r);
            multiply_blocks(self.size, blocks, r, z);
        });
    }

    /// The next direction: p = z + `share` p.
    pub(super) fn turn(&self, share: f64, z: &[f64], p: &mut [f64]) {
        let length = self.matrix.length();
        let parts = p.par_chunks_mut(length).zip(z.par_chunks(length));
        parts.for_each(|(p, z)| {
            for (p, z) in p.iter_mut().zip(z) {
                *p = z + share * *p;
            }
        });
    }

    /// Entries of G⁻¹ in the row of an unknown: the first unknown of its block, and the entries from there on.
    pub fn inverse_row(&self, unknown: usize) -> (usize, &[f64]) {
        let place = unknown * self.size;
        let row = &self.inverses[place..place + self.size];
        (unknown - unknown % self.size, row)
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
            let moved = [&mut x[..], &mut residual[..], &mut preconditioned];
            self.advance(now / slope, [&direction, &image], moved);
            let next = dot(&residual, &preconditioned);
            if descent.take(next) {
                self.best.copy_from_slice(x);
            }
            self.turn(next / now, &preconditioned, &mut direction);
            now = next;
        }
        if descent.least < first && descent.is_near() {
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

/// The rows that a rank has for an engine, and the places of their nodes.
fn own_rows<'a>(matrix: &'a Csr, rows: &'a SharedRows, nodes: &[[f64; 3]]) -> OwnRows<'a> {
    let dim = rows.size;
    // two or three displacements at each node
    let alike = (2..=3).contains(&dim);
    let own = rows.engine_rows();
    let (columns, values) = matrix.entries(own.clone());
    let mut offsets = vec![0];
    for i in own {
        let before = offsets[offsets.len() - 1];
        offsets.push(before + matrix.row(i).0.len() as i32);
    }
    let mut own = OwnRows {
        starts: &rows.engine,
        offsets,
        columns: columns.iter().map(|j| *j as i32).collect(),
        values,
        block: if alike { dim } else { 1 },
        places: Vec::new(),
    };
    if alike {
        own.places = nodes.iter().flat_map(|x| x[..dim].to_vec()).collect();
    }
    own
}

/// Inverts blocks on the diagonal, from that of the unknown `first` on; the first unknown of one that is not positive definite.
fn invert_blocks(
    matrix: &Csr,
    (size, first): (usize, usize),
    inverses: &mut [f64],
) -> Option<usize> {
    inverses.fill(0.0);
    let mut block = Vec::new();
    for (place, inverse) in inverses.chunks_exact_mut(size * size).enumerate() {
        let start = first + place * size;
        let own: Range<usize> = start..start + size;
        block.clear();
        for i in own.clone() {
            block.extend(own.clone().map(|j| matrix.get(i, j)));
        }
        let Ok(factor) = DenseCholesky::new(size, &block) else {
            return Some(start);
        };
        for (k, column) in inverse.chunks_exact_mut(size).enumerate() {
            column[k] = 1.0;
            factor.solve(column);
        }
    }
    None
}

/// z = B r, with B square blocks of so many rows on the diagonal.
fn multiply_blocks(size: usize, blocks: &[f64], r: &[f64], z: &mut [f64]) {
    match size {
        6 => multiply_blocks_of::<6>(blocks, r, z),
        3 => multiply_blocks_of::<3>(blocks, r, z),
        2 => multiply_blocks_of::<2>(blocks, r, z),
        _ => multiply_blocks_of::<1>(blocks, r, z),
    }
}

fn multiply_blocks_of<const D: usize>(blocks: &[f64], r: &[f64], z: &mut [f64]) {
    let (rows, _) = blocks.as_chunks::<D>();
    let (blocks, _) = rows.as_chunks::<D>();
    let (r, _) = r.as_chunks::<D>();
    let (z, _) = z.as_chunks_mut::<D>();
    for ((block, r), z) in blocks.iter().zip(r).zip(z) {
        for i in 0..D {
            z[i] = (0..D).map(|j| block[i][j] * r[j]).sum();
        }
    }
}

/// When iterations end: at the tolerance, or where rounding lets the residual fall no further.
pub(super) struct Descent {
    /// Square of the residual at first and at least.
    first: f64,
    pub(super) least: f64,
    tolerance: f64,
    /// Iterations since the least.
    since: usize,
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
            since: 0,
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
        let patience = if self.is_near() {
            PATIENCE
        } else {
            PATIENCE_AFAR
        };
        let left = self.least > self.tolerance.powi(2) * self.first;
        !self.broken && left && self.since < patience
    }

    /// Counts an iteration with this square of the residual; whether it is the least, and near enough to the tolerance to be a solution.
    pub(super) fn take(&mut self, square: f64) -> bool {
        self.iterations += 1;
        let better = square < self.least;
        // a slow fall is a fall
        self.since = match square < 0.99 * self.least {
            true => 0,
            false => self.since + usize::from(!better),
        };
        self.least = self.least.min(square);
        better && self.is_near()
    }

    /// Whether the least residual is near enough to the tolerance to be that of a solution.
    pub(super) fn is_near(&self) -> bool {
        self.least <= (NEAR * self.tolerance).powi(2) * self.first
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
        match self.is_near() && !self.broken {
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
