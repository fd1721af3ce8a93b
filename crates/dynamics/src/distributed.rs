//! A factor that an engine has over all ranks.

use carom_algebra::Error as AlgebraError;
use carom_algebra::csr::Csr;
use carom_algebra::solver::{FactorStats, Iterative, SparseRow};

/// A matrix whose factor an engine has over all ranks. It gives the motion of a whole load and no half of a solve, so that a step with contact
/// costs two solves, of its load and of its contact forces, and each row one more when it is met, many together. All ranks call each solve.
pub(crate) struct Distributed {
    solver: Box<Iterative>,
    tolerance: f64,
    /// Size of a factor in one process, and use of that of the engine.
    stats: FactorStats,
    /// Why the first solve since `begin` that did not end has not.
    failed: Option<AlgebraError>,
    /// Unknowns of the rows met so far, as they were met, and the place of each unknown among them.
    met: Vec<u32>,
    places: Vec<u32>,
    /// Contact forces of the begun solve, and whether there are any.
    load: Vec<f64>,
    loaded: bool,
    motion: Vec<f64>,
}

impl Distributed {
    /// `tolerance`: residual over the load at which solves end; `stats`: size of a factor, not made yet.
    pub(crate) fn new(
        solver: Box<Iterative>,
        (tolerance, mut stats): (f64, FactorStats),
    ) -> Distributed {
        let n = solver.unknowns();
        (stats.unknowns, stats.factorisations) = (n, 1);
        Distributed {
            solver,
            tolerance,
            stats,
            failed: None,
            met: Vec::new(),
            places: vec![u32::MAX; n],
            load: vec![0.0; n],
            loaded: false,
            motion: vec![0.0; n],
        }
    }

    /// Takes another matrix with the same unknowns.
    ///
    /// # Errors
    /// What the engine says.
    pub(crate) fn renew(&mut self, matrix: &Csr) -> Result<(), AlgebraError> {
        self.stats.factorisations += 1;
        self.solver.renew(matrix)
    }

    /// y = A⁻¹ r.
    pub(crate) fn begin(&mut self, r: &[f64], y: &mut [f64]) {
        let solved = self.solver.solve(r, y, self.tolerance);
        self.failed = self.count(solved).err();
        self.unload();
    }

    /// The rows, each with A⁻¹ Nᵀ at the unknowns of all rows met so far.
    pub(crate) fn respond(&mut self, rows: Vec<SparseRow>) -> Vec<(SparseRow, Vec<f64>)> {
        for &unknown in rows.iter().flat_map(|row| &row.dofs) {
            let place = &mut self.places[unknown as usize];
            if *place == u32::MAX {
                *place = self.met.len() as u32;
                self.met.push(unknown);
            }
        }
        self.stats.responses += rows.len();
        let motions = self.solver.columns(&rows, &self.met);
        let motions = motions.unwrap_or_else(|cause| {
            self.failed.get_or_insert(cause);
            // whoever meets such a column again fails too
            vec![f64::NAN; rows.len() * self.met.len()]
        });
        let motions = motions.chunks(self.met.len().max(1));
        let columns = rows.into_iter().zip(motions);
        columns
            .map(|(row, motion)| (row, motion.to_vec()))
            .collect()
    }

    /// N A⁻¹ Nᵀ of two columns: the row of the one that was met first, along the motion of the other.
    pub(crate) fn dot(&self, one: (&SparseRow, &[f64]), other: (&SparseRow, &[f64])) -> f64 {
        let (row, motion) = match one.1.len() > other.1.len() {
            true => (other.0, one.1),
            false => (one.0, other.1),
        };
        let entries = row.dofs.iter().zip(&row.coefficients);
        let places =
            entries.map(|(&unknown, n)| n * motion[self.places[unknown as usize] as usize]);
        places.sum()
    }

    /// Adds the force of a row to those of the begun solve.
    pub(crate) fn push(&mut self, row: &SparseRow, force: f64) {
        for (&unknown, n) in row.dofs.iter().zip(&row.coefficients) {
            self.load[unknown as usize] += force * n;
        }
        self.loaded = true;
    }

    /// x = y and the motion of the forces.
    pub(crate) fn end(&mut self, y: &[f64], x: &mut [f64]) {
        x.copy_from_slice(y);
        if !self.loaded {
            return;
        }
        let solved = self
            .solver
            .solve(&self.load, &mut self.motion, self.tolerance);
        if let Err(cause) = self.count(solved) {
            self.failed.get_or_insert(cause);
        }
        for (x, motion) in x.iter_mut().zip(&self.motion) {
            *x += motion;
        }
        self.unload();
    }

    fn unload(&mut self) {
        if self.loaded {
            self.load.fill(0.0);
            self.loaded = false;
        }
    }

    /// Why a solve since the last `begin` did not end.
    pub(crate) fn failure(&mut self) -> Option<AlgebraError> {
        self.failed.take()
    }

    /// Size and use of the factor.
    pub(crate) fn stats(&self) -> &FactorStats {
        &self.stats
    }

    /// Counts the sweeps of a solve that ended with so many iterations: two for each, and for the residual before.
    fn count(&mut self, solved: Result<usize, AlgebraError>) -> Result<(), AlgebraError> {
        let iterations = solved?;
        self.stats.sweeps += 2 * (iterations + 1);
        Ok(())
    }
}
