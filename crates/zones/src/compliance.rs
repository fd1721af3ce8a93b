//! D of contacts between zones: rates that unit forces, constant over an outer step, leave at its end and over it.

use carom_contact::Rows;
use carom_dynamics::Driver;
use carom_dynamics::linked::{Growth, Origin};

use crate::cross_zone::CrossZoneContacts;
use crate::error::Error;

impl CrossZoneContacts {
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
        self.soften();
        self.matrix_of.clone_from(&self.lasting);
        self.version += 1;
    }

    /// Lets all points of rigid bodies begin anew where one does: their rows depend on each other, and D of some that last and some that
    /// begin would contradict itself.
    pub(crate) fn let_rigid_begin(&mut self) {
        let rows = &self.pairing.rows;
        let own = self
            .candidates
            .iter()
            .map(|&point| self.is_rigid(rows, point));
        let own: Vec<bool> = own.collect();
        let begins = own
            .iter()
            .zip(&self.lasting)
            .any(|(own, lasts)| *own && !lasts);
        if begins {
            for (lasts, own) in self.lasting.iter_mut().zip(own) {
                *lasts &= !own;
            }
        }
    }

    /// Whether a rigid body has part in a point.
    fn is_rigid(&self, rows: &Rows, point: u32) -> bool {
        let (unknowns, _) = rows.row(point as usize);
        let mut unknowns = unknowns.iter();
        unknowns.any(|unknown| self.rigid.0.get(*unknown as usize) == Some(&true))
    }

    /// D with the own responses of points of rigid bodies a little larger: more than three such points on a plane have dependent rows, and
    /// share their force ([`System::rigid_points`](carom_system::System::rigid_points)).
    fn soften(&mut self) {
        self.softened.clear();
        let rows = &self.pairing.rows;
        let own = |point: &u32| self.is_rigid(rows, *point);
        if !self.candidates.iter().any(own) {
            return;
        }
        let mut softened = std::mem::take(&mut self.softened);
        softened.extend_from_slice(&self.matrix);
        let n = self.candidates.len();
        for (i, point) in self.candidates.iter().enumerate() {
            if self.is_rigid(rows, *point) {
                softened[i * n + i] *= 1.0 + self.rigid.1;
            }
        }
        self.softened = softened;
    }
}
