//! An attempt at an outer step: the passes over it, and what it leaves.

use crate::cross_zone::CrossZoneContacts;
use crate::error::Error;
use crate::model::LinkKind;
use crate::passes::{record, sample};
use crate::zones::Zones;
use carom_system::on;

impl Zones {
    /// Computes the outer step, which is not accepted.
    pub(crate) fn attempt(&mut self) -> Result<(), Error> {
        let inner = self.substeps.iter().any(|m| *m > 1);
        if let Some(between) = &mut self.between {
            let steps = (&self.substeps[..], self.dt);
            between.begin(&self.drivers, (self.time, self.dt));
            between.respond(&mut self.drivers, steps, &self.origins)?;
        }
        match self.kind {
            LinkKind::GravouilCombescure if inner && !self.links.is_empty() => {
                self.step_pointwise()
            }
            _ => self.step_ramped(),
        }
    }

    /// Makes what a zone computed its state, with its share of the works.
    fn take(&mut self, k: usize) {
        let driver = &mut self.drivers[k];
        record(
            driver,
            (&self.rows[k], self.turning.is_some()),
            &mut self.mixes[k],
            (&self.links, &mut self.works[0]),
        );
        if let Some(between) = &mut self.between {
            between.record(k, driver);
        }
        driver.take();
        sample(k, driver, &mut self.samples);
    }

    /// Makes the attempt the state.
    pub(crate) fn accept(&mut self) {
        for k in 0..self.drivers.len() {
            if self.substeps[k] == 1 {
                self.take(k);
            }
            let [_, last, before] = &mut self.mixes[k];
            before.copy_from_slice(last);
        }
        let [now, sum] = &mut self.works;
        sum.iter_mut().zip(now).for_each(|(sum, now)| *sum += *now);
        self.time = self.control.instant(self.step, self.time, self.dt);
        if let Some(between) = &mut self.between {
            between.accept(&self.drivers, [self.time, self.dt]);
        }
        if let Some(links) = &mut self.turning {
            links.accept();
        }
        self.step += 1;
        self.sizes = [self.dt, self.sizes[0]];
        self.all_passes += self.passes as u64;
        self.products[0] += self.products[1];
        let [before, first] = &mut self.earlier;
        let [old, new] = &mut self.multipliers;
        std::mem::swap(before, first);
        before.copy_from_slice(old);
        old.copy_from_slice(new);
        self.judge_origins();
        self.judge_solver();
    }

    /// Gives the zones back the states that inner steps have changed, and the forces of links before the outer step.
    pub(crate) fn go_back(&mut self) {
        for [_, last, before] in &mut self.mixes {
            last.copy_from_slice(before);
        }
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            let changes = changes_state((&self.substeps, &self.between), k);
            if changes && let Some(saved) = &self.saved[k] {
                driver.go_back(saved);
            }
        }
    }

    /// Multipliers linear over the outer step, rows that hold at its end.
    fn step_ramped(&mut self) -> Result<(), Error> {
        self.guess();
        if let Some(links) = &mut self.turning {
            links.begin(&self.drivers, self.dt, &mut self.rows);
        }
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            if !changes_state((&self.substeps, &self.between), k) {
                driver.prepare()?;
            }
        }
        self.moves.clear();
        let mut joined = false;
        for pass in 1..=self.most_passes() {
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
            self.add_defects();
            let pressed = match &mut self.between {
                Some(between) => between.corrected((self.step, self.dt), &self.drivers)?,
                None => true,
            };
            joined = self.corrected(1)?;
            if joined && pressed {
                return Ok(());
            }
        }
        match (&self.between, joined) {
            (Some(between), true) => Err(between.unsettled(self.step + 1, self.passes)),
            _ => Err(self.parted()),
        }
    }

    /// Multipliers at the end of the step from those of the last three instants, by a parabola.
    fn guess(&mut self) {
        let ([old, new], [before, first]) = (&mut self.multipliers, &self.earlier);
        let (dt, [one, two]) = (self.dt, self.sizes);
        let equal = one == dt && two == dt;
        for (i, new) in new.iter_mut().enumerate() {
            *new = match equal {
                true => 3.0 * (old[i] - before[i]) + first[i],
                false => {
                    let slopes = [(old[i] - before[i]) / one, (before[i] - first[i]) / two];
                    let bend = (slopes[0] - slopes[1]) / (one + two);
                    old[i] + dt * (slopes[0] + (dt + one) * bend)
                }
            };
        }
    }

    /// Takes the steps of one zone with the multipliers as they stand.
    fn ramp_zone(&mut self, k: usize) -> Result<(), Error> {
        let m = self.substeps[k];
        let changes = changes_state((&self.substeps, &self.between), k);
        if changes
            && let Some(saved) = &self.saved[k]
            && (self.drivers[k].state().step != saved.step || self.passes > 1)
        {
            self.drivers[k].go_back(saved);
        }
        for j in 0..m {
            if m > 1 {
                self.size_inner(k, j + 1 == m);
            }
            let driver = &mut self.drivers[k];
            let [old, new] = &self.multipliers;
            let [_, end] = driver.link_weights();
            let part = (f64::from(j) + end) / f64::from(m);
            let (rows, force) = (&self.rows[k], &mut self.mixes[k][0]);
            if let Some(links) = &self.turning {
                links.forces((k, part), rows, &self.multipliers, force);
                driver.set_link_terms(rows, force);
            } else {
                for (i, mix) in force.iter_mut().enumerate() {
                    *mix = (1.0 - part) * old[i] + part * new[i];
                }
                driver.set_link_force(rows, force);
            }
            if let Some(between) = &mut self.between {
                between.push(k, driver);
                if j == 0 {
                    between.jump(k, driver)?;
                }
            }
            if changes {
                driver.prepare()?;
            }
            driver.complete()?;
            if let Some(between) = &mut self.between {
                between.candidates.look(k, driver, self.dt);
            }
            if m > 1 {
                if j == 0 {
                    self.look_ahead(k);
                }
                self.take(k);
            }
        }
        Ok(())
    }

    /// What the velocities at the end of the pass miss in the rows.
    fn add_defects(&mut self) {
        if let Some(links) = &mut self.turning {
            let ends = (&self.drivers[..], &self.substeps[..], self.dt);
            links.end(ends, (&mut self.rows, &mut self.defect));
        }
        for (k, driver) in self.drivers.iter().enumerate() {
            let v = match self.substeps[k] {
                1 => &driver.ended().motion.v,
                _ => &driver.state().motion.v,
            };
            for (row, terms) in &self.rows[k] {
                self.defect[*row as usize] += on(terms, v);
            }
        }
    }
}

/// Whether a pass changes the state of a zone: by inner steps, or by forces that jump at the start of the outer step.
pub(crate) fn changes_state(
    (substeps, between): (&[u32], &Option<CrossZoneContacts>),
    zone: usize,
) -> bool {
    substeps[zone] > 1 || between.as_ref().is_some_and(|between| between.jumps(zone))
}
