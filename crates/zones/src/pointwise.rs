//! An outer step whose multipliers hold the rows at every inner instant (Gravouil, Combescure 2001).

use crate::error::Error;
use crate::passes::{MOST_PASSES, record, sample};
use crate::zones::Zones;
use carom_system::on;

impl Zones {
    /// Rows that hold at every inner instant, with the free velocities of the outer zones interpolated between their start
    /// and their end: `Σ_c C v_j + s_j + H_s L_j = 0`, `s_j = (1 - j/m) (C v - H_s L_0) + (j/m) C v_f`.
    pub(crate) fn step_pointwise(&mut self) -> Result<(), Error> {
        let n = self.norms.len();
        let [start, end] = &mut self.free;
        start.fill(0.0);
        end.fill(0.0);
        self.samples.clear();
        self.works[0].fill(0.0);
        self.passes = 0;
        let old = self.multipliers[0].clone();
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            if self.substeps[k] != 1 {
                continue;
            }
            let weights = driver.link_weights();
            driver.prepare()?;
            self.pointwise[0].copy_from_slice(&old);
            self.pointwise[0].iter_mut().for_each(|l| *l *= weights[0]);
            driver.set_link_force(&self.rows[k], &self.pointwise[0]);
            driver.complete()?;
            for (row, terms) in &self.rows[k] {
                start[*row as usize] += on(terms, &driver.state().motion.v);
                end[*row as usize] += on(terms, &driver.ended().motion.v);
            }
        }
        let mut start = std::mem::take(&mut self.free[0]);
        self.add_outer_response(&old, (-1.0, &mut start))?;
        self.free[0] = start;
        let [old, new] = &mut self.multipliers;
        new.copy_from_slice(old);
        let m = self.substeps.iter().copied().max().unwrap_or(1);
        for j in 1..=m {
            for k in 0..self.drivers.len() {
                if self.substeps[k] > 1 {
                    self.size_inner(k, j == m);
                }
            }
            self.inner_instant((j, m))?;
        }
        let [old, new] = &self.multipliers;
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            if self.substeps[k] == 1 {
                let weights = driver.link_weights();
                for i in 0..n {
                    self.pointwise[0][i] = weights[0] * old[i] + weights[1] * new[i];
                }
                driver.set_link_force(&self.rows[k], &self.pointwise[0]);
                self.mixes[k][0].copy_from_slice(&self.pointwise[0]);
                driver.complete()?;
            }
        }
        Ok(())
    }

    /// One step of the inner zones, whose pointwise multipliers start from those in `multipliers[1]` and end there.
    fn inner_instant(&mut self, (j, m): (u32, u32)) -> Result<(), Error> {
        let part = f64::from(j) / f64::from(m);
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            if self.substeps[k] > 1 {
                driver.prepare()?;
            }
        }
        self.pointwise[1].copy_from_slice(&self.multipliers[1]);
        self.moves.clear();
        for pass in 1..=MOST_PASSES {
            self.passes += 1;
            for i in 0..self.defect.len() {
                self.defect[i] = (1.0 - part) * self.free[0][i] + part * self.free[1][i];
            }
            let mut defect = std::mem::take(&mut self.defect);
            self.add_outer_response(&self.pointwise[1].clone(), (1.0, &mut defect))?;
            self.defect = defect;
            for (k, driver) in self.drivers.iter_mut().enumerate() {
                if self.substeps[k] == 1 {
                    continue;
                }
                let weights = driver.link_weights();
                let [mix, now] = &mut self.pointwise;
                for (i, mix) in mix.iter_mut().enumerate() {
                    *mix = weights[0] * self.multipliers[1][i] + weights[1] * now[i];
                }
                driver.set_link_force(&self.rows[k], mix);
                self.mixes[k][0].copy_from_slice(mix);
                driver.complete()?;
                for (row, terms) in &self.rows[k] {
                    self.defect[*row as usize] += on(terms, &driver.ended().motion.v);
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
            if self.substeps[k] > 1 {
                self.look_ahead(k);
            }
        }
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            if self.substeps[k] > 1 {
                record(
                    driver,
                    (&self.rows[k], false),
                    &mut self.mixes[k],
                    (&self.links, &mut self.works[0]),
                );
                driver.take();
                sample(k, driver, &mut self.samples);
            }
        }
        self.multipliers[1].copy_from_slice(&self.pointwise[1]);
        Ok(())
    }
}
