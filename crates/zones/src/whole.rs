//! The zones of a model as one: a state and a report of all bodies and contacts at outer instants, for all that looks at
//! runs.
//!
//! Nothing here influences the steps. The largest terms of the balance are those of the sum over the zones, which no
//! zone knows: they are saved beside the state of the zones.

mod gathered;
mod stage;

use std::sync::Arc;

use carom_algebra::Interrupt;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::model::Zoned;
use crate::places::Places;
use crate::stage::Stage;
use crate::zones::{Zones, ZonesState};
use carom_dynamics::Certificate;
use carom_dynamics::Costs;
use carom_dynamics::records::Records;
use carom_dynamics::state::{State, empty_state};
use carom_dynamics::{AssemblyEnergies, Balance, Impact, Ledger, Told, Tolerated};
use carom_dynamics::{ContactReport, ContactSample, Notices, StepReport};
use carom_dynamics::{FailedProblem, Stepper};
use carom_system::System;
use gathered::{
    add_forces, assemblies_of_links, assemblies_of_zones, forces_mut, take_motion, take_points,
};

/// Zones with the model as one.
pub struct Whole {
    zones: Zones,
    /// The static stage under way, and what it cost once it is over.
    stage: (Option<Box<Stage>>, Costs),
    system: Arc<System>,
    names: Vec<String>,
    links: Vec<[usize; 2]>,
    /// The assembly of the model to which each one of each zone belongs, and that of the rows of each link and constraint.
    of_assembly: Vec<Vec<usize>>,
    of_link: Vec<usize>,
    /// Work so far of contacts and links by assembly, J.
    assembly_works: Vec<f64>,
    /// Bodies of each zone.
    bodies: Vec<Vec<usize>>,
    places: Vec<Places>,
    /// Impacts of each zone that the records hold.
    impacts: Vec<usize>,
    /// Those of contacts between zones.
    impacts_between: usize,
    /// Samples of each zone placed so far in a step.
    placed: Vec<usize>,
    state: State,
    report: StepReport,
    /// Who looks at whether bodies pass through each other; none before the first step.
    certificate: Option<Certificate>,
    /// What was told until the step before, for its room.
    told: Option<Told>,
}

/// What a run in zones goes on from.
#[derive(Serialize, Deserialize)]
struct Saved {
    /// Of a static stage under way.
    stage: Option<State>,
    zones: ZonesState,
    ledger: Ledger,
    /// Energies of the assemblies of the model.
    assemblies: AssemblyEnergies,
    /// Impacts of all zones in the order in which they were told.
    impacts: Vec<Impact>,
    /// What passed through each other.
    crossings: Option<Told>,
}

impl Whole {
    /// Starts the zones of a model. `system`: [`Zoned::whole`] of the same model.
    ///
    /// # Errors
    /// As [`Zones::new`].
    pub fn new(zoned: &Zoned, system: Arc<System>) -> Result<Whole, Error> {
        let stage = Stage::new(zoned, &system)?;
        let mut whole = Whole::around(Zones::new(zoned)?, zoned, system);
        match stage {
            Some(stage) => whole.gather_stage(Box::new(stage)),
            None => whole.gather(),
        }
        Ok(whole)
    }

    /// Goes on from the bytes of [`Stepper::saved`].
    ///
    /// # Errors
    /// As [`Whole::new`]; bytes that are no state, or one of another model.
    pub fn resume(zoned: &Zoned, system: Arc<System>, bytes: &[u8]) -> Result<Whole, Error> {
        let refused = |cause: String| Error::from(carom_dynamics::Error::State { cause });
        let saved: Saved = postcard::from_bytes(bytes).map_err(|e| refused(e.to_string()))?;
        let mut zones = Zones::new(zoned)?;
        let (found, expected) = (saved.zones.zones.len(), zones.drivers.len());
        let rows = [saved.zones.multipliers.len(), zones.multipliers().len()];
        if found != expected || rows[0] != rows[1] {
            return Err(refused(format!(
                "it has {found} zones and {} rows of links, the model {expected} and {}",
                rows[0], rows[1]
            )));
        }
        let contacts = system.contacts.len();
        let mut impacts = saved.impacts.iter();
        if !zones.has_state(&saved.zones) || !impacts.all(|i| (i.contact as usize) < contacts) {
            return Err(refused("it belongs to another model".to_owned()));
        }
        for (state, driver) in saved.zones.zones.iter().zip(&zones.drivers) {
            state.check(driver.system())?;
        }
        let mut told = saved.crossings.iter();
        if !told.all(|told| told.is_of(&system)) {
            return Err(refused("it belongs to another model".to_owned()));
        }
        let stage = match (&saved.stage, Stage::new(zoned, &system)?) {
            (Some(state), Some(stage)) => Some(stage.resume(state)?),
            (None, _) => None,
            (Some(_), None) => return Err(refused("it belongs to another model".to_owned())),
        };
        zones.resume(&saved.zones);
        let mut whole = Whole::around(zones, zoned, system);
        whole.state.ledger = saved.ledger;
        whole.state.assemblies = saved.assemblies;
        whole.state.records.impacts = saved.impacts;
        whole.state.crossings = saved.crossings;
        let drivers = whole.zones.drivers.iter();
        whole.impacts = drivers.map(|d| d.state().records.impacts.len()).collect();
        let between = whole.zones.between();
        whole.impacts_between = between.map_or(0, |(_, own)| own.records.impacts.len());
        match stage {
            Some(stage) => whole.gather_stage(Box::new(stage)),
            None => whole.gather(),
        }
        whole.certificate = Certificate::of(&whole.system, &whole.state);
        Ok(whole)
    }

    fn around(zones: Zones, zoned: &Zoned, system: Arc<System>) -> Whole {
        let mut taken = vec![false; system.unknowns()];
        let drivers = zones.drivers.iter().zip(&zoned.zones).zip(&zones.contacts);
        let places = drivers.map(|((driver, zone), contacts)| {
            let parts = (&zone.bodies[..], &contacts[..]);
            Places::new(driver.system(), parts, &system, &mut taken)
        });
        let places: Vec<Places> = places.collect();
        let mut state = empty_state(&system);
        state.motion.link_force = vec![0.0; system.unknowns()];
        state.records = Records::of(&system);
        state.assemblies.of_whole_alone = zones.drivers.iter().any(|driver| {
            let own = driver.system();
            let identity = own.scheme.get().energy_identity(own.dt);
            identity.is_none_or(|identity| identity.lag != 0.0 || identity.memory != 0.0)
        });
        Whole {
            of_assembly: assemblies_of_zones(&zones, (&places, &system)),
            of_link: assemblies_of_links(&zones, (&places, &system)),
            assembly_works: Vec::new(),
            names: zoned.zones.iter().map(|zone| zone.name.clone()).collect(),
            links: zoned.zones_of_rows(),
            bodies: zoned.zones.iter().map(|zone| zone.bodies.clone()).collect(),
            places,
            impacts: vec![0; zones.drivers.len()],
            impacts_between: 0,
            placed: vec![0; zones.drivers.len()],
            state,
            report: StepReport {
                contacts: vec![ContactReport::default(); system.contacts.len()],
                ..StepReport::default()
            },
            zones,
            certificate: None,
            told: None,
            stage: (None, Costs::default()),
            system,
        }
    }

    /// Counts what each zone cost before this run went on with it.
    pub fn add_earlier(&mut self, costs: &Costs) {
        for (driver, own) in self.zones.drivers.iter_mut().zip(&costs.zones) {
            driver.add_earlier(own);
        }
        self.zones.response.link_time += costs.phases.links;
    }

    /// The zones.
    pub fn zones(&self) -> &Zones {
        &self.zones
    }

    /// Takes every `every`-th outer step once more after dropping it, which must change no bit of the results: for tests.
    pub fn force_rejections(&mut self, every: u64) {
        self.zones.clock.forced = Some(every);
    }

    /// Names of the zones.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Name, zones and number of rows of each link.
    pub fn links(&self) -> impl Iterator<Item = (&str, [usize; 2], usize)> {
        let links = self.zones.links().iter().zip(&self.links);
        links.map(|((name, rows), zones)| (name.as_str(), *zones, rows.len()))
    }

    /// State and report from those of the zones. Needs memory only where the number of parts of a step
    /// grows.
    fn gather(&mut self) {
        self.state.step = self.zones.clock.step;
        self.state.time = self.zones.time();
        self.state.control = self.zones.clock.control;
        self.gather_motion();
        self.gather_interface();
        self.gather_records();
        let sum = |of: fn(&Ledger) -> &Balance| {
            let drivers = self.zones.drivers.iter();
            drivers
                .map(|driver| of(&driver.state().ledger))
                .fold(Balance::default(), |sum, one| sum.plus(one))
        };
        let (initial, mut balance) = (sum(|l| &l.initial), sum(|l| &l.balance));
        if let Some((_, between)) = self.zones.between() {
            // the zones take forces between them for those of links
            let [work, of_friction] =
                [0, 1].map(|k| between.works.iter().map(|w| w[k]).sum::<f64>());
            balance.work_links -= work + of_friction;
            balance.work_contact += work;
            balance.dissipation_friction -= of_friction;
        }
        let mut left = [Tolerated::default(); 2];
        for driver in &self.zones.drivers {
            let ledger = &driver.state().ledger;
            left[0].add(&ledger.tolerated);
            left[1].add(&ledger.rounding);
        }
        self.state.ledger.gather(initial, balance, left);
        self.gather_assemblies();
        let zones = self.zones.drivers.iter();
        let exchange = &mut self.state.exchange;
        exchange.gather(zones.map(|driver| &driver.state().exchange));
        self.tell();
    }

    /// Energies of the assemblies of the model from those of the zones.
    pub(super) fn gather_assemblies(&mut self) {
        let (system, assemblies) = (&*self.system, &self.system.assemblies);
        let works = &mut self.assembly_works;
        works.resize(assemblies.all.len(), 0.0);
        for (assembly, works) in assemblies.all.iter().zip(&mut *works) {
            let contacts = assembly.contacts.iter();
            let records = &self.state.records.contacts;
            *works = contacts.map(|&k| records[k].work_with_friction()).sum();
        }
        for (link, work) in self.zones.link_works().iter().enumerate() {
            works[self.of_link[link]] += work;
        }
        let zones = self.zones.drivers.iter().zip(&self.of_assembly);
        let zones = zones.flat_map(|(driver, of)| {
            let energies = driver.state().assemblies.all.iter();
            of.iter().copied().zip(energies)
        });
        self.state.assemblies.gather(system, zones, works);
    }

    /// Motion from the first zone that has a node, forces from all.
    fn gather_motion(&mut self) {
        let whole = &mut self.state.motion;
        for force in forces_mut(whole) {
            force.fill(0.0);
        }
        for (driver, places) in self.zones.drivers.iter().zip(&self.places) {
            let motion = &driver.state().motion;
            take_motion(whole, (motion, places));
            add_forces(whole, (motion, places));
        }
    }

    fn gather_interface(&mut self) {
        let whole = &mut self.state.interface;
        for (driver, places) in self.zones.drivers.iter().zip(&self.places) {
            take_points(whole, (&driver.state().interface, places));
        }
        let Some((contacts, between)) = self.zones.between() else {
            return;
        };
        let points = contacts
            .iter()
            .flat_map(|&contact| self.system.points_of(contact));
        if !between.interface.friction.is_empty() {
            whole.friction.resize(whole.force.len(), [0.0; 2]);
        }
        for (own, point) in points.enumerate() {
            whole.take_point(point, (&between.interface, own));
        }
    }

    /// Records by contact of the model; impacts in the order of their end, then of the zones.
    fn gather_records(&mut self) {
        let whole = &mut self.state.records;
        let before = whole.impacts.len();
        for (k, driver) in self.zones.drivers.iter().enumerate() {
            let records = &driver.state().records;
            let contacts = &self.zones.contacts[k];
            for (record, contact) in records.contacts.iter().zip(contacts) {
                whole.contacts[*contact].clone_from(record);
            }
            let numbers = (&self.bodies[k][..], &contacts[..]);
            whole.small.gather(&records.small, numbers);
            for impact in &records.impacts[self.impacts[k]..] {
                let mut impact = impact.clone();
                impact.contact = contacts[impact.contact as usize] as u32;
                whole.impacts.push(impact);
            }
            self.impacts[k] = records.impacts.len();
        }
        if let Some((contacts, between)) = self.zones.between() {
            for (record, &contact) in between.records.contacts.iter().zip(contacts) {
                whole.contacts[contact].clone_from(record);
            }
            let impacts = &between.records.impacts;
            for impact in &impacts[self.impacts_between..] {
                let mut impact = impact.clone();
                impact.contact = contacts[impact.contact as usize] as u32;
                whole.impacts.push(impact);
            }
            self.impacts_between = impacts.len();
        }
        whole.impacts[before..]
            .sort_by(|a, b| (a.start + a.duration).total_cmp(&(b.start + b.duration)));
    }

    fn take_step(&mut self) -> Result<(), carom_dynamics::Error> {
        if let Some(mut stage) = self.stage.0.take() {
            if stage.is_over() {
                self.leave_stage(*stage)?;
            } else {
                let outcome = stage.driver.step();
                self.gather_stage(stage);
                return outcome;
            }
        }
        self.zones.step()?;
        self.gather();
        self.report.notices = Notices::default();
        for driver in &self.zones.drivers {
            self.report.notices.join(&driver.report().notices);
        }
        Ok(())
    }

    fn tell(&mut self) {
        let report = &mut self.report;
        report.step = self.state.step;
        report.time = self.state.time;
        report.balance = self.state.ledger.balance;
        report.passes = self.zones.response.passes;
        if report.step == 0 {
            report.dt = 0.0;
            for (driver, contacts) in self.zones.drivers.iter().zip(&self.zones.contacts) {
                for (own, contact) in driver.report().contacts.iter().zip(contacts) {
                    report.contacts[*contact].clone_from(own);
                }
            }
            self.tell_between();
            return;
        }
        report.dt = self.zones.clock.dt;
        report.attempts = self.zones.clock.attempts;
        self.place_samples();
        let report = &mut self.report;
        report.join_parts();
        for sample in self.zones.samples() {
            let zone = sample.zone;
            if self.zones.clock.substeps[zone] == 1 {
                for (own, contact) in sample.contacts.iter().zip(&self.zones.contacts[zone]) {
                    report.contacts[*contact].clone_from(own);
                }
            }
        }
        self.tell_between();
    }

    /// What contacts between zones did, in all parts of the step alike.
    fn tell_between(&mut self) {
        let Some((contacts, _)) = self.zones.between() else {
            return;
        };
        for &contact in contacts {
            if let Some(own) = self.zones.report_between(contact) {
                self.report.contacts[contact].clone_from(own);
                for part in &mut self.report.samples {
                    part.contacts[contact].clone_from(own);
                }
            }
        }
    }

    /// The samples of the zones, contact by contact in the parts of the step, of which each step of a zone has a whole number; none where no zone
    /// has inner steps.
    fn place_samples(&mut self) {
        let parts = common_multiple(&self.zones.clock.substeps) as usize;
        let samples = &mut self.report.samples;
        if parts == 1 {
            samples.clear();
            return;
        }
        let (dt, start) = (self.zones.clock.dt, self.zones.time() - self.zones.clock.dt);
        samples.resize_with(parts, || ContactSample {
            contacts: vec![ContactReport::default(); self.system.contacts.len()],
            ..ContactSample::default()
        });
        for (part, number) in samples.iter_mut().zip(1..) {
            part.dt = dt / parts as f64;
            part.time = start + dt * (f64::from(number) / parts as f64);
        }
        self.placed.fill(0);
        for sample in self.zones.samples() {
            let zone = sample.zone;
            let of_step = parts / self.zones.clock.substeps[zone] as usize;
            let first = self.placed[zone] * of_step;
            let range = first..first + of_step;
            self.placed[zone] += 1;
            let of_part = range.len() == 1;
            for part in &mut samples[range] {
                if of_part {
                    (part.time, part.dt) = (sample.time, sample.dt);
                }
                for (own, contact) in sample.contacts.iter().zip(&self.zones.contacts[zone]) {
                    part.contacts[*contact].clone_from(own);
                }
            }
        }
    }
}

/// Parts of an outer step of which the steps of all zones are whole numbers.
fn common_multiple(steps: &[u32]) -> u32 {
    steps.iter().fold(1, |all, &own| {
        let (mut a, mut b) = (all, own);
        while b != 0 {
            (a, b) = (b, a % b);
        }
        all / a * own
    })
}

impl Stepper for Whole {
    /// One outer step, or one of the static stage.
    fn step(&mut self) -> Result<(), carom_dynamics::Error> {
        if self.certificate.is_none() {
            self.certificate = Certificate::of(&self.system, &self.state);
            let findings = |of: &Certificate| of.findings(&self.state).told;
            // both rooms from here on
            self.told = self.certificate.as_ref().map(findings);
            self.state.crossings.clone_from(&self.told);
        }
        let before = self.state.time;
        let outcome = self.take_step();
        if let (Ok(()), Some(certificate)) = (&outcome, &mut self.certificate) {
            let mut next = self.told.take().unwrap_or_default();
            let from = (self.state.crossings.as_ref(), before);
            let end = (self.state.time, &self.state);
            certificate.look_at(&self.system, from, end, &mut next);
            certificate.accept();
            self.told = self.state.crossings.replace(next);
        }
        outcome
    }

    fn system(&self) -> &System {
        &self.system
    }

    fn state(&self) -> &State {
        &self.state
    }

    fn report(&self) -> &StepReport {
        &self.report
    }

    fn saved(&self) -> Result<Vec<u8>, carom_dynamics::Error> {
        let saved = Saved {
            stage: (self.stage.0.as_ref()).map(|stage| stage.driver.state().clone()),
            zones: self.zones.state(),
            ledger: self.state.ledger.clone(),
            assemblies: self.state.assemblies.clone(),
            impacts: self.state.records.impacts.clone(),
            crossings: self.state.crossings.clone(),
        };
        postcard::to_stdvec(&saved).map_err(|cause| carom_dynamics::Error::State {
            cause: cause.to_string(),
        })
    }

    /// Those of all zones.
    fn costs(&self) -> Costs {
        let mut costs = match &self.stage {
            (Some(stage), _) => stage.driver.costs(),
            (None, over) => over.clone(),
        };
        costs.phases.links += self.zones.response.link_time;
        for driver in &self.zones.drivers {
            let own = driver.costs();
            costs.add(&own);
            costs.zones.push(own);
        }
        costs
    }

    fn heed(&mut self, interrupt: &Interrupt) {
        if let Some(stage) = &mut self.stage.0 {
            stage.driver.heed(interrupt);
        }
        for driver in &mut self.zones.drivers {
            driver.heed(interrupt);
        }
    }

    fn certificate(&self) -> Option<&Certificate> {
        self.certificate.as_ref()
    }

    fn failed_problem(&self) -> Option<FailedProblem<'_>> {
        self.zones.drivers.iter().find_map(Stepper::failed_problem)
    }
}
