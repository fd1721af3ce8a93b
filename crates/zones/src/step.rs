//! An outer step: how many inner steps the zones take, the passes over it, and what it leaves.

use crate::error::Error;
use crate::model::LinkKind;
use crate::passes::{MOST_PASSES, record, sample};
use crate::zones::{Kept, Zones};
use carom_system::on;

impl Zones {
    /// Takes one outer step.
    ///
    /// # Errors
    /// A step of a zone that fails, or multipliers that are not found. The state is then the one before the step.
    pub fn step(&mut self) -> Result<(), Error> {
        self.renew_condensed()?;
        self.choose_substeps()?;
        for (k, driver) in self.drivers.iter().enumerate() {
            if self.substeps[k] > 1
                && let Some(saved) = &mut self.saved[k]
            {
                saved.clone_from(driver.state());
            }
        }
        let forced = self
            .forced
            .is_some_and(|every| (self.step + 1).is_multiple_of(every));
        if forced && self.attempt().is_ok() {
            self.go_back();
        }
        match self.attempt() {
            Ok(()) => {
                self.accept();
                Ok(())
            }
            Err(error) => {
                self.go_back();
                Err(error)
            }
        }
    }

    /// Computes the outer step, which is not accepted.
    fn attempt(&mut self) -> Result<(), Error> {
        let inner = self.substeps.iter().any(|m| *m > 1);
        if let Some(between) = &mut self.between {
            between.begin(&self.drivers, (self.step as f64 * self.dt, self.dt));
            between.respond(&mut self.drivers, &self.substeps, &self.origins)?;
        }
        match self.kind {
            LinkKind::GravouilCombescure if inner && !self.links.is_empty() => {
                self.step_pointwise()
            }
            _ => self.step_ramped(),
        }
    }

    /// Takes the inner steps of a shock if a contact may close in the outer step, else those far from it.
    fn choose_substeps(&mut self) -> Result<(), Error> {
        if self.choices[0] == self.choices[1] {
            return Ok(());
        }
        let near = self.drivers.iter().any(|driver| {
            let tolerance = driver.system().tolerance;
            driver.state().may_touch(self.dt, tolerance)
        });
        let between = self.between.as_ref();
        let near = near || between.is_some_and(|between| between.may_touch(self.dt));
        let choice = &self.choices[usize::from(!near)];
        if *choice == self.substeps {
            return Ok(());
        }
        let now = Kept {
            substeps: std::mem::replace(&mut self.substeps, choice.clone()),
            factor: self.factor.take(),
            outer: std::mem::take(&mut self.outer),
        };
        for (driver, m) in self.drivers.iter_mut().zip(&self.substeps) {
            driver.resize(self.dt / f64::from(*m));
        }
        match self
            .kept
            .iter()
            .position(|kept| kept.substeps == self.substeps)
        {
            Some(place) => {
                let kept = self.kept.swap_remove(place);
                (self.factor, self.outer) = (kept.factor, kept.outer);
            }
            None => self.factorise()?,
        }
        self.kept.push(now);
        Ok(())
    }

    fn accept(&mut self) {
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            if self.substeps[k] == 1 {
                record(
                    driver,
                    &self.rows[k],
                    &mut self.mixes[k],
                    (&self.links, &mut self.works[0]),
                );
                if let Some(between) = &mut self.between {
                    between.record(k, driver);
                }
                driver.take();
                sample(k, driver, &mut self.samples);
            }
            let [_, last, before] = &mut self.mixes[k];
            before.copy_from_slice(last);
        }
        let [now, sum] = &mut self.works;
        sum.iter_mut().zip(now).for_each(|(sum, now)| *sum += *now);
        self.step += 1;
        if let Some(between) = &mut self.between {
            between.accept(&self.drivers, (self.step as f64 * self.dt, self.dt));
        }
        self.all_passes += self.passes as u64;
        let [before, first] = &mut self.earlier;
        let [old, new] = &mut self.multipliers;
        std::mem::swap(before, first);
        before.copy_from_slice(old);
        old.copy_from_slice(new);
        self.judge_origins();
    }

    fn go_back(&mut self) {
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            if self.substeps[k] > 1
                && let Some(saved) = &self.saved[k]
            {
                driver.go_back(saved);
            }
        }
    }

    /// Multipliers linear over the outer step, rows that hold at its end.
    fn step_ramped(&mut self) -> Result<(), Error> {
        self.guess();
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            if self.substeps[k] == 1 {
                driver.prepare()?;
            }
        }
        self.moves.clear();
        for pass in 1..=MOST_PASSES {
            self.passes = pass;
            self.samples.clear();
            self.defect.fill(0.0);
            self.works[0].fill(0.0);
            if let Some(between) = &mut self.between {
                between.begin_pass();
            }
            for k in 0..self.drivers.len() {
                let [_, last, before] = &mut self.mixes[k];
                last.copy_from_slice(before);
                self.ramp_zone(k)?;
            }
            let pressed = match &mut self.between {
                Some(between) => between.corrected((self.step, self.dt))?,
                None => true,
            };
            if self.corrected(1)? && pressed {
                return Ok(());
            }
        }
        Err(self.parted())
    }

    /// Multipliers at the end of the step from those of the last three instants, by a parabola.
    fn guess(&mut self) {
        let ([old, new], [before, first]) = (&mut self.multipliers, &self.earlier);
        for (i, new) in new.iter_mut().enumerate() {
            *new = 3.0 * (old[i] - before[i]) + first[i];
        }
    }

    /// Takes the steps of one zone with the multipliers as they stand, and adds its part of the defect.
    fn ramp_zone(&mut self, k: usize) -> Result<(), Error> {
        let m = self.substeps[k];
        let driver = &mut self.drivers[k];
        let [old, new] = &self.multipliers;
        let [_, end] = driver.link_weights();
        if m > 1
            && let Some(saved) = &self.saved[k]
            && driver.state().step != saved.step
        {
            driver.go_back(saved);
        }
        for j in 0..m {
            let part = (f64::from(j) + end) / f64::from(m);
            let mix = &mut self.pointwise[0];
            for (i, mix) in mix.iter_mut().enumerate() {
                *mix = (1.0 - part) * old[i] + part * new[i];
            }
            driver.set_link_force(&self.rows[k], mix);
            self.mixes[k][0].copy_from_slice(mix);
            if let Some(between) = &self.between {
                between.push(k, driver);
            }
            if m == 1 {
                driver.complete()?;
            } else {
                driver.prepare()?;
                driver.complete()?;
                record(
                    driver,
                    &self.rows[k],
                    &mut self.mixes[k],
                    (&self.links, &mut self.works[0]),
                );
                if let Some(between) = &mut self.between {
                    between.record(k, driver);
                }
                driver.take();
                sample(k, driver, &mut self.samples);
            }
        }
        let v = match m {
            1 => driver.next_velocity(),
            _ => &driver.state().motion.v,
        };
        for (row, terms) in &self.rows[k] {
            self.defect[*row as usize] += on(terms, v);
        }
        if let Some(between) = &mut self.between {
            between.look(k, v);
        }
        Ok(())
    }
}
