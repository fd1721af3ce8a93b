//! Zones: groups of bodies with their own scheme and step, which meet only in the multipliers of their links.
//!
//! A link gives rows `Σ C v = 0` between velocities of zones at the same instant, and its multipliers L act as `Cᵀ L`. The
//! condensed problem of an outer step is `H ΔL = Σ C v`, with H the velocity that multipliers leave in the rows when
//! nothing touches: made and factored once. Contact makes the answer of a zone nonlinear; the passes over the step with the
//! same H end when the rows hold to rounding, in few passes where contacts are some elements away from the links.
//!
//! Sources: Gravouil, Combescure (2001); Prakash, Hjelmstad (2004); Ben Dhia et al. (2003), equations (11)-(12). The form
//! for any pair of schemes with weights of the multipliers in time is this project's.

mod between;
mod model;
mod moves;
mod origin;
mod pointwise;
mod start;
mod tie;
mod together;
mod whole;

use serde::{Deserialize, Serialize};

use crate::driver::Driver;
use crate::error::Error;
use crate::ledger::Balance;
use crate::state::{ContactReport, State};
use crate::system::{LinkRow, on};

use crate::condensed::Condensed;
use between::Between;
pub use between::BetweenState;
pub use model::{LinkKind, ModelZone, Zoned};
use moves::Moves;
pub use origin::Origin;
pub use tie::mortar_rows;
pub use whole::Whole;

/// Defect of a row at which it holds, as a part of the largest velocity.
const TOLERANCE: f64 = 1e-12;

/// Most passes over an outer step.
const MOST_PASSES: usize = 30;

/// The condensed problem of some numbers of inner steps.
struct Kept {
    substeps: Vec<u32>,
    factor: Option<Condensed>,
    outer: Vec<f64>,
}

/// What the contacts of a zone did at one of its instants.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sample {
    /// Zone.
    pub zone: usize,
    /// Time at the end of its step, s.
    pub time: f64,
    /// Size of its step, s.
    pub dt: f64,
    /// By contact of the zone.
    pub contacts: Vec<ContactReport>,
}

/// State of all zones at an outer instant: what a run goes on from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ZonesState {
    /// Outer steps taken.
    pub step: u64,
    /// Time, s.
    pub time: f64,
    /// Multipliers of the rows, N per unit of the row.
    pub multipliers: Vec<f64>,
    /// The same one and two steps before.
    pub earlier: [Vec<f64>; 2],
    /// Λ of each zone in its last step.
    pub forces: Vec<Vec<f64>>,
    /// Work of each link on both its sides, J.
    pub link_works: Vec<f64>,
    /// Where each zone was linearised last.
    pub origins: Vec<Origin>,
    /// Contacts between zones, if there are any.
    pub between: Option<BetweenState>,
    /// By zone.
    pub zones: Vec<State>,
}

/// The drivers of all zones, and the links between them.
pub struct Zones {
    drivers: Vec<Driver>,
    /// Inner steps of each zone to the outer step that is taken.
    substeps: Vec<u32>,
    /// The same where contacts may close, and where they cannot.
    choices: [Vec<u32>; 2],
    /// Contacts of the model by zone.
    contacts: Vec<Vec<usize>>,
    /// By zone, number of the row and its terms there.
    rows: Vec<Vec<(u32, LinkRow)>>,
    /// Contacts between zones.
    between: Option<Between>,
    /// Σ |c| of each row.
    norms: Vec<f64>,
    /// Range of the rows of each link.
    links: Vec<(String, std::ops::Range<usize>)>,
    kind: LinkKind,
    dt: f64,
    step: u64,
    /// L at the start and at the end of the step.
    multipliers: [Vec<f64>; 2],
    /// L one and two outer steps before the start of the step.
    earlier: [Vec<f64>; 2],
    /// H of the multipliers that a pass looks for.
    factor: Option<Condensed>,
    /// Where the zones were linearised for H, and whether H is to be made anew.
    origins: Vec<Origin>,
    stale: bool,
    /// Part of H of the zones with one step, row-major: for pointwise multipliers.
    outer: Vec<f64>,
    /// Both for other numbers of inner steps.
    kept: Vec<Kept>,
    saved: Vec<Option<State>>,
    samples: Vec<Sample>,
    /// Passes of the last step, over all steps, and factorisations of H.
    passes: usize,
    all_passes: u64,
    defect: Vec<f64>,
    free: [Vec<f64>; 2],
    pointwise: [Vec<f64>; 2],
    /// Λ of each zone in the step that it takes, in its last one, and in its last one before the outer step.
    mixes: Vec<[Vec<f64>; 3]>,
    /// Moves of the multipliers in the passes so far.
    moves: Moves,
    /// Work of each link on both its sides in the outer step, and before it, J.
    works: [Vec<f64>; 2],
    /// Every which outer step is dropped once, in tests.
    forced: Option<u64>,
}

impl Zones {
    /// Drivers of the zones, in the order of the model.
    pub fn drivers(&self) -> &[Driver] {
        &self.drivers
    }

    /// Contacts of the model in each zone.
    pub fn contacts(&self) -> &[Vec<usize>] {
        &self.contacts
    }

    /// Multipliers of the rows at the last instant.
    pub fn multipliers(&self) -> &[f64] {
        &self.multipliers[0]
    }

    /// What the contacts of the zones did at the instants of the last outer step.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// Outer steps taken.
    pub fn outer_step(&self) -> u64 {
        self.step
    }

    /// Time, s.
    pub fn time(&self) -> f64 {
        self.step as f64 * self.dt
    }

    /// Passes of the last outer step.
    pub fn passes(&self) -> usize {
        self.passes
    }

    /// Passes over all outer steps.
    pub fn all_passes(&self) -> u64 {
        self.all_passes
    }

    /// Bytes held for the condensed problem of the links.
    pub fn condensed_bytes(&self) -> usize {
        let rows = self.norms.len();
        self.factor.as_ref().map_or(0, |factor| factor.bytes(rows))
    }

    /// Work of each link on both its sides since the start, J: what it makes (positive) or takes.
    pub fn link_works(&self) -> &[f64] {
        &self.works[1]
    }

    /// The balance of all zones together.
    pub fn balance(&self) -> Balance {
        let balances = self.drivers.iter().map(|d| &d.state().ledger.balance);
        balances.fold(Balance::default(), |sum, one| sum.plus(one))
    }

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

    /// Whether the rows hold, or would after a change of the multipliers by rounding; corrects the multipliers `which`
    /// (0 pointwise, 1 of the outer step) if not.
    fn corrected(&mut self, which: usize) -> Result<bool, Error> {
        let speed = self.speed();
        let rows = self.defect.iter().zip(&self.norms);
        let worst = rows.fold(0.0, |worst: f64, (d, n)| worst.max(d.abs() / n));
        if worst <= TOLERANCE * speed {
            return Ok(true);
        }
        let Some(factor) = &mut self.factor else {
            return Ok(true);
        };
        factor.solve(&mut self.defect);
        let [old, new] = &mut self.multipliers;
        let target = match which {
            0 => &mut self.pointwise[1],
            _ => new,
        };
        // at rest all velocities are rounding; then the forces tell what is small
        let forces = largest(old).max(largest(target));
        if largest(&self.defect) <= TOLERANCE * forces {
            return Ok(true);
        }
        self.moves.next(&mut self.defect);
        for (l, move_) in target.iter_mut().zip(&self.defect) {
            *l += move_;
        }
        Ok(false)
    }

    /// Largest velocity of all zones, at the end of the step or at its start.
    fn speed(&self) -> f64 {
        let of = |driver: &Driver| {
            largest(driver.next_velocity()).max(largest(&driver.state().motion.v))
        };
        self.drivers.iter().map(of).fold(0.0, f64::max)
    }

    fn parted(&self) -> Error {
        let rows = self.defect.iter().zip(&self.norms);
        Error::Link {
            step: self.step + 1,
            passes: self.passes,
            defect: rows.fold(0.0, |worst: f64, (d, n)| worst.max(d.abs() / n)),
        }
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// Adds the work of the links in the step of a zone just completed.
fn record(
    driver: &Driver,
    rows: &[(u32, LinkRow)],
    [now, last, _]: &mut [Vec<f64>; 3],
    (links, works): (&[(String, std::ops::Range<usize>)], &mut [f64]),
) {
    for (row, terms) in rows {
        let row = *row as usize;
        let link = links.partition_point(|(_, range)| range.end <= row);
        works[link] += driver.row_work(terms, last[row], now[row]);
    }
    last.copy_from_slice(now);
}

fn sample(zone: usize, driver: &Driver, samples: &mut Vec<Sample>) {
    let report = driver.report();
    samples.push(Sample {
        zone,
        time: report.time,
        dt: report.dt,
        contacts: report.contacts.clone(),
    });
}
