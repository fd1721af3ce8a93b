//! D of contacts between zones: mean rates over an outer step that unit forces leave which stand over it.

use carom_dynamics::Driver;
use carom_dynamics::linearised::{Growth, Origin, Steps};
use carom_system::{LinkRow, System};

use super::candidates::Candidates;
use super::geometry::{Geometry, RigidUnknowns};
use crate::error::Error;

/// D of the candidates.
pub(crate) struct CrossZoneCompliance {
    /// D.
    pub(crate) responses: Vec<f64>,
    /// By row, the mean rate over the step and the rate at its end that a unit force in each candidate leaves.
    sums: Vec<[f64; 2]>,
    /// D with the own responses of points of rigid bodies a little larger; empty without such candidates.
    softened: Vec<f64>,
    /// Rows by zone and sizes of the steps of the zones that D is of.
    of: (Vec<Vec<(u32, LinkRow)>>, Vec<f64>),
    pub(crate) rigid: RigidUnknowns,
    /// Changes with D.
    pub(crate) version: u64,
}

impl CrossZoneCompliance {
    pub(crate) fn new(system: &System) -> CrossZoneCompliance {
        CrossZoneCompliance {
            responses: Vec::new(),
            sums: Vec::new(),
            softened: Vec::new(),
            of: Default::default(),
            rigid: RigidUnknowns::of(system),
            version: 0,
        }
    }

    /// ϑ of a row: the part of the change of its rate over the step under forces that stand which its mean has, ½ of a free mass, 1 where waves
    /// take the motion away at once.
    pub(crate) fn part(&self, row: usize) -> f64 {
        let [mean, end] = self.sums[row];
        match 0.0 < mean && mean < end {
            true => (mean / end).max(0.5),
            false => 1.0,
        }
    }

    /// D that is solved with.
    pub(crate) fn matrix(&self) -> &[f64] {
        match self.softened.is_empty() {
            true => &self.responses,
            false => &self.softened,
        }
    }

    /// Makes D where the rows or the sizes of steps have changed; whether they have.
    pub(super) fn respond(
        &mut self,
        candidates: &Candidates,
        (drivers, origins): (&mut [Driver], &[Origin]),
        (substeps, dt): (&[u32], f64),
    ) -> Result<bool, Error> {
        let sizes: Vec<f64> = substeps.iter().map(|m| dt / f64::from(*m)).collect();
        if candidates.rows == self.of.0 && sizes == self.of.1 {
            return Ok(false);
        }
        let n = candidates.forces.len();
        self.responses.clear();
        self.responses.resize(n * n, 0.0);
        self.sums.clear();
        self.sums.resize(n, [0.0; 2]);
        for (zone, driver) in drivers.iter_mut().enumerate() {
            let rows = &candidates.rows[zone];
            if rows.is_empty() {
                continue;
            }
            let steps = Steps {
                count: substeps[zone],
                growth: Growth::Constant,
            };
            let mut linear = driver.linearised(&origins[zone])?;
            let [ends, ways] = driver.answers(&mut linear, rows, steps)?;
            let (n_zone, width) = (rows.len(), candidates.width());
            for (i, (row, _)) in rows.iter().enumerate() {
                for (j, (column, _)) in rows.iter().enumerate() {
                    let mean = 0.5 * (ways[i * n_zone + j] + ways[j * n_zone + i]) / dt;
                    self.responses[*row as usize * n + *column as usize] += mean;
                    if (*column as usize).is_multiple_of(width) {
                        let sums = &mut self.sums[*row as usize];
                        sums[0] += mean;
                        sums[1] += ends[i * n_zone + j];
                    }
                }
            }
        }
        self.of = (candidates.rows.clone(), sizes);
        Ok(true)
    }

    /// D with the own responses of points of rigid bodies a little larger: more than three such points on a plane have dependent rows, and
    /// share their force ([`System::rigid_points`](carom_system::System::rigid_points)).
    pub(super) fn soften(&mut self, (candidates, geometry): (&Candidates, &Geometry)) {
        self.softened.clear();
        let of_point = |point: &u32| self.rigid.have(geometry, *point);
        let own: Vec<bool> = candidates.points.iter().map(of_point).collect();
        if !own.contains(&true) {
            return;
        }
        self.softened.extend_from_slice(&self.responses);
        let n = candidates.forces.len();
        for row in (0..n).filter(|row| own[row / candidates.width()]) {
            self.softened[row * n + row] *= 1.0 + self.rigid.growth;
        }
    }
}
