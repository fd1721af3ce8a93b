//! Sparse Cholesky factorisation A = Pᵀ L Lᵀ P of a symmetric positive definite matrix.
//!
//! The order of elimination is ours (`ordering.rs`), supernodes and dense kernels are faer's; fronts (`fronts.rs`) and sweeps
//! (`sweep.rs`) are ours. The bits depend on the matrix and the processor alone, not on the number of threads. Unknowns without neighbours (fixed ones)
//! never reach the factor: they are divided by their diagonal.

use super::fronts::Fronts;
use super::panel::{LANES, Lanes};
use super::response::{Response, SparseRow};
use super::supernodal::analyse;
use super::sweep::{Backward, Forward, ForwardLanes, Panels};
use crate::ordering::{self, Ordering, Place, counted};
use crate::{Error, csr::Csr};
use carom_ranks::memory::room_for;
use pulp::Arch;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Size and use of a factor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FactorStats {
    /// Number of unknowns.
    pub unknowns: usize,
    /// Stored entries of L, diagonal included.
    pub nnz_factor: usize,
    /// Additions and multiplications of one factorisation.
    pub flops: f64,
    /// Bytes held by the factor, its indices and its scratch.
    pub bytes: usize,
    /// Method that gave the order of elimination: `minimum degree`, `nested dissection` or `nested dissection by planes`.
    pub ordering: String,
    /// Factorisations computed so far.
    pub factorisations: usize,
    /// Dense sweeps so far, forward and backward counted alike (a solve is two).
    pub sweeps: usize,
    /// Sparse columns computed so far by `respond`.
    pub responses: usize,
}

impl FactorStats {
    /// Of a factor that others make and keep, before it is made, every node taken as dense, without held unknowns. Of the matrix `nodes` the pattern is that of the nodes.
    /// `weights`: unknowns of each node that are not held, none of one without neighbours; `place`: of a node, m.
    ///
    /// # Errors
    /// The analysis fails.
    pub fn counted(nodes: &Csr, weights: &[u32], place: &Place) -> Result<FactorStats, Error> {
        let (ordering, [entries, flops]) = counted(nodes, weights, place)?;
        Ok(FactorStats {
            unknowns: weights.iter().sum::<u32>() as usize,
            nnz_factor: entries as usize,
            flops,
            bytes: size_of::<f64>() * entries as usize,
            ordering: ordering.into(),
            factorisations: 0,
            sweeps: 0,
            responses: 0,
        })
    }
}

/// Factor of a symmetric positive definite matrix.
pub struct Cholesky {
    /// Position in the factor to unknown: `connected` unknowns of the factor, then those without neighbours.
    permutation: Vec<u32>,
    /// Unknown to position.
    position: Vec<u32>,
    connected: usize,
    /// Fingerprint of the analysed pattern.
    pattern: Pattern,
    panels: Panels,
    fronts: Fronts,
    /// Panels of L, column-major.
    values: Vec<f64>,
    /// Square roots of the diagonal entries of the unknowns without neighbours.
    isolated: Vec<f64>,
    /// One right-hand side in the factor's order, for whole solves.
    y: Vec<f64>,
    scratch: Vec<f64>,
    stats: FactorStats,
}

impl Cholesky {
    /// Analyses and factorises `matrix`, which must be symmetric: one entry of each symmetric pair is read.
    ///
    /// `group_of[i]`: node of unknown i; unknowns of one node are eliminated together (without nodes, `group_of[i] = i`).
    /// Errors: the matrix is not positive definite or not finite; `group_of` has the wrong length; memory is short.
    pub fn new(matrix: &Csr, group_of: &[u32]) -> Result<Self, Error> {
        if group_of.len() != matrix.n {
            return Err(Error::WrongLength {
                what: "groups of unknowns",
                expected: matrix.n,
                found: group_of.len(),
            });
        }
        Self::ordered(matrix, Ordering::new(matrix, group_of, None)?)
    }

    /// Factorises `matrix` in an order that was chosen for its pattern. Errors are those of [`Cholesky::new`].
    pub fn ordered(matrix: &Csr, order: Ordering) -> Result<Self, Error> {
        let position = ordering::inverse(matrix.n, &order.permutation);
        let symbolic = analyse(matrix, &order.permutation[..order.connected], &position)?;
        let panels = Panels::new(&symbolic);
        let connected = &order.permutation[..order.connected];
        let fronts = Fronts::new(&panels, matrix, connected, &position);
        let (entries, flops) = panels.work();
        let needed = 8 * (symbolic.len_val() + fronts.most_in_use(&panels)) as u64;
        room_for(format_args!("the factor of {} unknowns", matrix.n), needed)?;
        let isolated = matrix.n - order.connected;
        let mut factor = Self {
            values: vec![0.0; symbolic.len_val()],
            isolated: vec![0.0; isolated],
            y: vec![0.0; matrix.n],
            scratch: vec![0.0; panels.tallest()],
            pattern: Pattern::of(matrix),
            stats: FactorStats {
                unknowns: matrix.n,
                nnz_factor: entries + isolated,
                flops,
                bytes: 0,
                ordering: order.name.into(),
                factorisations: 0,
                sweeps: 0,
                responses: 0,
            },
            connected: order.connected,
            permutation: order.permutation,
            position,
            panels,
            fronts,
        };
        factor.stats.bytes = factor.bytes();
        factor.refactor(matrix)?;
        Ok(factor)
    }

    /// Factorises a matrix of the same pattern with other values. After an error the factor must not be used before another
    /// `refactor` succeeds.
    pub fn refactor(&mut self, matrix: &Csr) -> Result<(), Error> {
        if Pattern::of(matrix) != self.pattern {
            return Err(Error::PatternChanged {
                expected: self.pattern.entries,
                found: matrix.nnz(),
            });
        }
        self.stats.factorisations += 1;
        let (connected, isolated) = self.permutation.split_at(self.connected);
        for (root, &i) in self.isolated.iter_mut().zip(isolated) {
            *root = isolated_root(matrix, i as usize)?;
        }
        self.fronts
            .factorise(&self.panels, (matrix, connected), &mut self.values)
            .map_err(|failure| failure.of(matrix, connected))
    }

    /// x ← A⁻¹ x: one forward and one backward sweep, no allocation.
    pub fn solve(&mut self, x: &mut [f64]) {
        let mut y = std::mem::take(&mut self.y);
        self.forward(x, &mut y);
        self.backward(&mut y, x);
        self.y = y;
    }

    /// y = L⁻¹ P r, in the factor's own order; no allocation. Both have one entry per unknown.
    pub fn forward(&mut self, r: &[f64], y: &mut [f64]) {
        self.stats.sweeps += 1;
        for (y, &i) in y.iter_mut().zip(&self.permutation) {
            *y = r[i as usize];
        }
        let (y, alone) = y.split_at_mut(self.connected);
        for (y, root) in alone.iter_mut().zip(&self.isolated) {
            *y /= root;
        }
        let Self {
            panels,
            values,
            scratch,
            ..
        } = self;
        Arch::new().dispatch(Forward {
            panels,
            values,
            y,
            scratch,
        });
    }

    /// x = Pᵀ L⁻ᵀ y; no allocation. Both have one entry per unknown; `y` is scratch afterwards.
    pub fn backward(&mut self, y: &mut [f64], x: &mut [f64]) {
        self.stats.sweeps += 1;
        let (connected, alone) = y.split_at_mut(self.connected);
        for (y, root) in alone.iter_mut().zip(&self.isolated) {
            *y /= root;
        }
        let Self {
            panels,
            values,
            scratch,
            ..
        } = self;
        Arch::new().dispatch(Backward {
            panels,
            values,
            y: connected,
            scratch,
        });
        for (y, &i) in y.iter().zip(&self.permutation) {
            x[i as usize] = *y;
        }
    }

    /// Columns Y = L⁻¹ P Nᵀ of the given rows of N, in their order.
    ///
    /// Each column visits only the elimination-tree paths of its unknowns. Columns with neighbouring paths are computed
    /// together, but the bits of a column depend on the factor and its own row alone: neither on its company nor on the
    /// number of threads. Memory: [`Response::bytes`] each, plus 128 bytes per unknown and thread while it runs.
    pub fn respond(&mut self, rows: &[SparseRow]) -> Vec<Response> {
        self.stats.responses += rows.len();
        let this = &*self;
        // Rows that start on the same path share most of it: then little of a group's work is on zeros.
        let mut order: Vec<usize> = (0..rows.len()).collect();
        let start = |k: usize| {
            rows[k]
                .dofs
                .iter()
                .map(|&i| this.position[i as usize])
                .min()
        };
        order.sort_by_key(|&k| (start(k), k));
        let groups: Vec<Vec<Response>> = order
            .par_chunks(LANES)
            .map_init(
                || Columns::new(this),
                |columns, group| columns.solve(group.iter().map(|&k| &rows[k])),
            )
            .collect();
        let mut responses = vec![Response::default(); rows.len()];
        for (k, response) in order.into_iter().zip(groups.into_iter().flatten()) {
            responses[k] = response;
        }
        responses
    }

    /// Size and use of the factor.
    pub fn stats(&self) -> &FactorStats {
        &self.stats
    }

    fn bytes(&self) -> usize {
        size_of_val(&*self.permutation)
            + size_of_val(&*self.position)
            + size_of_val(&*self.values)
            + size_of_val(&*self.isolated)
            + size_of_val(&*self.y)
            + size_of_val(&*self.scratch)
            + self.panels.bytes()
            + self.fronts.bytes()
    }
}

/// Scratch of one group of sparse right-hand sides.
struct Columns<'a> {
    factor: &'a Cholesky,
    /// Zero between two groups.
    y: Vec<Lanes>,
    scratch: Vec<Lanes>,
    /// All false between two groups.
    mark: Vec<bool>,
}

impl<'a> Columns<'a> {
    fn new(factor: &'a Cholesky) -> Self {
        Self {
            factor,
            y: vec![[0.0; LANES]; factor.permutation.len()],
            scratch: vec![[0.0; LANES]; factor.panels.tallest()],
            mark: vec![false; factor.panels.len()],
        }
    }

    /// Responses of at most [`LANES`] rows.
    fn solve<'r>(&mut self, rows: impl Iterator<Item = &'r SparseRow> + Clone) -> Vec<Response> {
        let Cholesky {
            panels,
            values,
            position,
            ..
        } = self.factor;
        for (lane, row) in rows.clone().enumerate() {
            for (&i, coefficient) in row.dofs.iter().zip(&row.coefficients) {
                self.y[position[i as usize] as usize][lane] += coefficient;
            }
        }
        let path = self.path(rows.clone().flat_map(|row| &row.dofs));
        let (y, scratch) = (&mut self.y[..], &mut self.scratch[..]);
        Arch::new().dispatch(ForwardLanes {
            panels,
            values,
            path: &path,
            y,
            scratch,
        });
        let responses = rows
            .clone()
            .enumerate()
            .map(|(lane, row)| self.collect(lane, row))
            .collect();
        for &s in &path {
            self.y[panels.columns(s)].fill([0.0; LANES]);
        }
        for &i in rows.flat_map(|row| &row.dofs) {
            self.y[position[i as usize] as usize] = [0.0; LANES];
        }
        responses
    }

    /// Panels on the tree paths from some unknowns to the roots, ascending.
    fn path<'r>(&mut self, unknowns: impl Iterator<Item = &'r u32>) -> Vec<u32> {
        let factor = self.factor;
        let positions = unknowns
            .map(|&i| factor.position[i as usize] as usize)
            .filter(|&k| k < factor.connected);
        let mut path = vec![];
        factor.panels.climb(positions, &mut self.mark, &mut path);
        path.sort_unstable();
        for &s in &path {
            self.mark[s as usize] = false;
        }
        path
    }

    /// Takes one lane out as a response: its own path, and its unknowns without neighbours.
    fn collect(&mut self, lane: usize, row: &SparseRow) -> Response {
        let path = self.path(row.dofs.iter());
        let Cholesky {
            panels,
            position,
            connected,
            isolated,
            ..
        } = self.factor;
        let mut alone: Vec<usize> = row
            .dofs
            .iter()
            .map(|&i| position[i as usize] as usize)
            .filter(|k| k >= connected)
            .collect();
        alone.sort_unstable();
        alone.dedup();
        let ranges = path
            .iter()
            .map(|&s| panels.columns(s))
            .chain(alone.into_iter().map(|k| k..k + 1));
        Response::collect(ranges, |k| match k.checked_sub(*connected) {
            Some(single) => self.y[k][lane] / isolated[single],
            None => self.y[k][lane],
        })
    }
}

/// What a pattern is recognised by.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pattern {
    unknowns: usize,
    entries: usize,
    /// FNV-1a over the columns of all rows and the row lengths.
    hash: u64,
}

impl Pattern {
    fn of(matrix: &Csr) -> Self {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        let mut add = |word: u32| hash = (hash ^ u64::from(word)).wrapping_mul(0x0100_0000_01b3);
        for i in 0..matrix.n {
            let columns = matrix.row(i).0;
            add(columns.len() as u32);
            columns.iter().copied().for_each(&mut add);
        }
        Self {
            unknowns: matrix.n,
            entries: matrix.nnz(),
            hash,
        }
    }
}

/// Square root of the diagonal entry of an unknown without neighbours.
fn isolated_root(matrix: &Csr, i: usize) -> Result<f64, Error> {
    let diagonal = matrix.get(i, i);
    match diagonal {
        _ if !diagonal.is_finite() => Err(Error::NotFinite {
            row: i,
            column: i,
            value: diagonal,
        }),
        _ if diagonal > 0.0 => Ok(diagonal.sqrt()),
        _ => Err(Error::NotPositiveDefinite {
            unknown: i,
            diagonal,
        }),
    }
}
