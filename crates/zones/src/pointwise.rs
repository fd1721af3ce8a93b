//! An outer step whose multipliers hold the rows at every inner instant (Gravouil, Combescure 2001).

use crate::error::Error;
use crate::passes::{MOST_PASSES, record, sample};
use crate::zones::Zones;
use carom_system::on;

impl Zones {
    /// Rows that hold at every inner instant, with the free velocities of the outer zones interpolated between their start
    /// and their end: `Σ_c C v_j + s_j + H_s L_j = 0`, `s_j = (1 - j/m) (C v - H_s L_0) + (j/m) C v_f`.
    pub(crate) fn step_pointwise(&mut self) -> Result<(), Error> {
        let n = self.links.norms.len();
        let [start, end] = &mut self.links.free;
        start.fill(0.0);
        end.fill(0.0);
        self.samples.clear();
        self.links.works[0].fill(0.0);
        self.response.passes = 0;
        let old = self.links.multipliers[0].clone();
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            if self.clock.substeps[k] != 1 {
                continue;
            }
            let weights = driver.link_weights();
            driver.prepare()?;
            self.links.pointwise[0].copy_from_slice(&old);
            self.links.pointwise[0]
                .iter_mut()
                .for_each(|l| *l *= weights[0]);
            driver.set_link_force(&self.links.rows[k], &self.links.pointwise[0]);
            driver.complete()?;
            for (row, terms) in &self.links.rows[k] {
                start[*row as usize] += on(terms, &driver.state().motion.v);
                end[*row as usize] += on(terms, &driver.ended().motion.v);
            }
        }
        let mut start = std::mem::take(&mut self.links.free[0]);
        self.add_outer_response(&old, (-1.0, &mut start))?;
        self.links.free[0] = start;
        let [old, new] = &mut self.links.multipliers;
        new.copy_from_slice(old);
        let m = self.clock.substeps.iter().copied().max().unwrap_or(1);
        for j in 1..=m {
            for k in 0..self.drivers.len() {
                if self.clock.substeps[k] > 1 {
                    self.size_inner(k, j == m);
                }
            }
            self.inner_instant((j, m))?;
        }
        let [old, new] = &self.links.multipliers;
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            if self.clock.substeps[k] == 1 {
                let weights = driver.link_weights();
                for i in 0..n {
                    self.links.pointwise[0][i] = weights[0] * old[i] + weights[1] * new[i];
                }
                driver.set_link_force(&self.links.rows[k], &self.links.pointwise[0]);
                self.links.mixes[k][0].copy_from_slice(&self.links.pointwise[0]);
                driver.complete()?;
            }
        }
        Ok(())
    }

    /// One step of the inner zones, whose pointwise multipliers start from those in `multipliers[1]` and end there.
    fn inner_instant(&mut self, (j, m): (u32, u32)) -> Result<(), Error> {
        let part = f64::from(j) / f64::from(m);
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            if self.clock.substeps[k] > 1 {
                driver.prepare()?;
            }
        }
        self.links.pointwise[1].copy_from_slice(&self.links.multipliers[1]);
        self.links.moves.clear();
        for pass in 1..=MOST_PASSES {
            self.response.passes += 1;
            for i in 0..self.links.defect.len() {
                self.links.defect[i] =
                    (1.0 - part) * self.links.free[0][i] + part * self.links.free[1][i];
            }
            let mut defect = std::mem::take(&mut self.links.defect);
            self.add_outer_response(&self.links.pointwise[1].clone(), (1.0, &mut defect))?;
            self.links.defect = defect;
            for (k, driver) in self.drivers.iter_mut().enumerate() {
                if self.clock.substeps[k] == 1 {
                    continue;
                }
                let weights = driver.link_weights();
                let [mix, now] = &mut self.links.pointwise;
                for (i, mix) in mix.iter_mut().enumerate() {
                    *mix = weights[0] * self.links.multipliers[1][i] + weights[1] * now[i];
                }
                driver.set_link_force(&self.links.rows[k], mix);
                self.links.mixes[k][0].copy_from_slice(mix);
                driver.complete()?;
                for (row, terms) in &self.links.rows[k] {
                    self.links.defect[*row as usize] += on(terms, &driver.ended().motion.v);
                }
            }
            if self.corrected(0)? {
                break;
            }
            if pass == MOST_PASSES {
                return Err(self.parted());
            }
        }
        for k in (0..self.drivers.len()).filter(|_| j == 1) {
            if self.clock.substeps[k] > 1 {
                self.look_ahead(k);
            }
        }
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            if self.clock.substeps[k] > 1 {
                record(
                    driver,
                    (&self.links.rows[k], false),
                    &mut self.links.mixes[k],
                    (&self.links.named, &mut self.links.works[0]),
                );
                driver.take();
                sample(k, driver, &mut self.samples);
            }
        }
        self.links.multipliers[1].copy_from_slice(&self.links.pointwise[1]);
        Ok(())
    }
}
