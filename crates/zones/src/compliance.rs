//! D of contacts between zones: rates that unit forces, constant over an outer step, leave at its end and over it.

use carom_dynamics::Driver;
use carom_dynamics::linked::{Growth, Origin};
use carom_nonsmooth::Compliance;
use carom_nonsmooth::interface::Failure;

use crate::between::Between;
use crate::error::Error;

/// Most that the own response of a point of a rigid body grows by.
const MOST: f64 = 1e-3;

impl Between {
    /// D of the candidates for an outer step of `dt` (s), where their rows or the sizes of steps have changed.
    ///
    /// # Errors
    /// An effective matrix that is not positive definite.
    pub(crate) fn respond(
        &mut self,
        drivers: &mut [Driver],
        (substeps, dt): (&[u32], f64),
        origins: &[Origin],
    ) -> Result<(), Error> {
        let row = |&point: &u32| {
            let (dofs, coefficients) = self.pairing.rows.row(point as usize);
            (dofs.to_vec(), coefficients.to_vec())
        };
        let of: Vec<_> = self.candidates.iter().map(row).collect();
        let sizes = substeps.iter().map(|m| dt / f64::from(*m)).collect();
        if of != self.of || sizes != self.sizes {
            let n = self.candidates.len();
            let mut responses = [vec![0.0; n * n], vec![0.0; n * n]];
            for (zone, driver) in drivers.iter_mut().enumerate() {
                let rows = &self.rows[zone];
                if rows.is_empty() {
                    continue;
                }
                let steps = (substeps[zone], Growth::Constant);
                let [ends, ways] = driver.ramp((rows, steps), &origins[zone])?;
                for (own, (all, over)) in
                    [ends, ways].iter().zip(responses.iter_mut().zip([1.0, dt]))
                {
                    for (i, (row, _)) in rows.iter().enumerate() {
                        for (j, (column, _)) in rows.iter().enumerate() {
                            let mean = 0.5 * (own[i * rows.len() + j] + own[j * rows.len() + i]);
                            all[*row as usize * n + *column as usize] += mean / over;
                        }
                    }
                }
            }
            (self.responses, self.of, self.sizes) = (responses, of, sizes);
            self.matrix_of.clear();
        }
        self.combine();
        Ok(())
    }

    /// D of the candidates from the responses at the end of the step and over it.
    fn combine(&mut self) {
        if self.matrix_of == self.lasting {
            return;
        }
        let n = self.candidates.len();
        let [ends, means] = &self.responses;
        self.matrix.clear();
        for i in 0..n {
            for j in 0..n {
                let [end, mean] = [ends[i * n + j], means[i * n + j]];
                self.matrix.push(match (self.lasting[i], self.lasting[j]) {
                    (true, true) => mean,
                    (false, false) => end,
                    _ => 0.5 * (end + mean),
                });
            }
        }
        self.soften(1.0);
        self.matrix_of.clone_from(&self.lasting);
        self.version += 1;
    }

    /// Solves the contact problem with D softened. Where rows of rigid bodies depend on each other and D mixes means and ends it may not be
    /// positive definite; then the means stand for all of it. The forces are those of D all the same: it is the rates found in the zones
    /// that end the passes.
    ///
    /// # Errors
    /// A contact problem without solution.
    pub(crate) fn solve_softened(&mut self) -> Result<(), Failure> {
        let mut times = 1.0;
        loop {
            let matrix = match self.softened.is_empty() {
                true => &self.matrix,
                false => &self.softened,
            };
            let problem = (Compliance::Dense(matrix), self.version);
            match self.interface.solve(&self.data, problem, [0.0, 1.0]) {
                Err(Failure::Singular { .. })
                    if !self.softened.is_empty() && times * self.rigid.1 < MOST =>
                {
                    times *= 10.0;
                    self.soften(times);
                    self.version += 1;
                }
                solved => return solved.map(|_| ()),
            }
        }
    }

    /// D with the own responses of points of rigid bodies a little larger: more than three such points on a plane have dependent rows, and
    /// share their force ([`System::rigid_points`](carom_system::System::rigid_points)). `times`: how often that part.
    fn soften(&mut self, times: f64) {
        let (rigid, part) = (&self.rigid.0, times * self.rigid.1);
        let rows = &self.pairing.rows;
        let is_rigid = |point: &u32| {
            let (unknowns, _) = rows.row(*point as usize);
            let mut unknowns = unknowns.iter();
            unknowns.any(|unknown| rigid.get(*unknown as usize) == Some(&true))
        };
        self.softened.clear();
        if !self.candidates.iter().any(is_rigid) {
            return;
        }
        self.softened.extend_from_slice(match times > 1.0 {
            true => &self.responses[1],
            false => &self.matrix,
        });
        let n = self.candidates.len();
        for (i, point) in self.candidates.iter().enumerate() {
            if is_rigid(point) {
                self.softened[i * n + i] *= 1.0 + part;
            }
        }
    }
}
