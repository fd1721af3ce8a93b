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
        let inner = self.clock.substeps.iter().any(|m| *m > 1);
        if let Some(between) = &mut self.between {
            let steps = (&self.clock.substeps[..], self.clock.dt);
            between.begin(&self.drivers, (self.clock.time, self.clock.dt));
            between.respond(&mut self.drivers, steps, &self.response.origins)?;
        }
        match self.links.kind {
            LinkKind::GravouilCombescure if inner && !self.links.named.is_empty() => {
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
            (&self.links.rows[k], self.links.turning.is_some()),
            &mut self.links.mixes[k],
            (&self.links.named, &mut self.links.works[0]),
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
            if self.clock.substeps[k] == 1 {
                self.take(k);
            }
            let [_, last, before] = &mut self.links.mixes[k];
            before.copy_from_slice(last);
        }
        let [now, sum] = &mut self.links.works;
        sum.iter_mut().zip(now).for_each(|(sum, now)| *sum += *now);
        self.clock.time =
            self.clock
                .control
                .instant(self.clock.step, self.clock.time, self.clock.dt);
        if let Some(between) = &mut self.between {
            between.accept(&self.drivers, [self.clock.time, self.clock.dt]);
        }
        if let Some(links) = &mut self.links.turning {
            links.accept();
        }
        self.clock.step += 1;
        self.clock.sizes = [self.clock.dt, self.clock.sizes[0]];
        self.response.all_passes += self.response.passes as u64;
        self.response.products[0] += self.response.products[1];
        let [before, first] = &mut self.links.earlier;
        let [old, new] = &mut self.links.multipliers;
        std::mem::swap(before, first);
        before.copy_from_slice(old);
        old.copy_from_slice(new);
        self.judge_origins();
        self.judge_solver();
    }

    /// Gives the zones back the states that inner steps have changed, and the forces of links before the outer step.
    pub(crate) fn go_back(&mut self) {
        for [_, last, before] in &mut self.links.mixes {
            last.copy_from_slice(before);
        }
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            let changes = changes_state((&self.clock.substeps, &self.between), k);
            if changes && let Some(saved) = &self.saved[k] {
                driver.go_back(saved);
            }
        }
    }

    /// Multipliers linear over the outer step, rows that hold at its end.
    fn step_ramped(&mut self) -> Result<(), Error> {
        self.guess();
        if let Some(links) = &mut self.links.turning {
            links.begin(&self.drivers, self.clock.dt, &mut self.links.rows);
        }
        for (k, driver) in self.drivers.iter_mut().enumerate() {
            if !changes_state((&self.clock.substeps, &self.between), k) {
                driver.prepare()?;
            }
        }
        self.links.moves.clear();
        let mut joined = false;
        for pass in 1..=self.most_passes() {
            self.response.passes = pass;
            self.samples.clear();
            self.links.defect.fill(0.0);
            self.links.works[0].fill(0.0);
            if let Some(between) = &mut self.between {
                between.begin_pass();
            }
            for k in 0..self.drivers.len() {
                let [_, last, before] = &mut self.links.mixes[k];
                last.copy_from_slice(before);
                self.ramp_zone(k)?;
            }
            self.add_defects();
            let pressed = match &mut self.between {
                Some(between) => {
                    between.corrected((self.clock.step, self.clock.dt), &self.drivers)?
                }
                None => true,
            };
            joined = self.corrected(1)?;
            if joined && pressed {
                return Ok(());
            }
        }
        match (&self.between, joined) {
            (Some(between), true) => {
                Err(between.unsettled(self.clock.step + 1, self.response.passes))
            }
            _ => Err(self.parted()),
        }
    }

    /// Multipliers at the end of the step from those of the last three instants, by a parabola.
    fn guess(&mut self) {
        let ([old, new], [before, first]) = (&mut self.links.multipliers, &self.links.earlier);
        let (dt, [one, two]) = (self.clock.dt, self.clock.sizes);
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
        let m = self.clock.substeps[k];
        let changes = changes_state((&self.clock.substeps, &self.between), k);
        if changes
            && let Some(saved) = &self.saved[k]
            && (self.drivers[k].state().step != saved.step || self.response.passes > 1)
        {
            self.drivers[k].go_back(saved);
        }
        for j in 0..m {
            if m > 1 {
                self.size_inner(k, j + 1 == m);
            }
            let driver = &mut self.drivers[k];
            let [old, new] = &self.links.multipliers;
            let [_, end] = driver.link_weights();
            let part = (f64::from(j) + end) / f64::from(m);
            let (rows, force) = (&self.links.rows[k], &mut self.links.mixes[k][0]);
            if let Some(links) = &self.links.turning {
                links.forces((k, part), rows, &self.links.multipliers, force);
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
                between.candidates.look(k, driver, self.clock.dt);
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
        if let Some(links) = &mut self.links.turning {
            let ends = (&self.drivers[..], &self.clock.substeps[..], self.clock.dt);
            links.end(ends, (&mut self.links.rows, &mut self.links.defect));
        }
        for (k, driver) in self.drivers.iter().enumerate() {
            let v = match self.clock.substeps[k] {
                1 => &driver.ended().motion.v,
                _ => &driver.state().motion.v,
            };
            for (row, terms) in &self.links.rows[k] {
                self.links.defect[*row as usize] += on(terms, v);
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
