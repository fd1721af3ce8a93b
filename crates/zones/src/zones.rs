//! The drivers of all zones and the links between them: what they hold, their state.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::cross_zone::{CrossZoneContacts, CrossZoneState};
use crate::link_solver::{LinkSolver, OuterResponse};
use crate::model::LinkKind;
use crate::moves::Moves;
use crate::turning::{ByZone, TurningLinks};
use carom_dynamics::Balance;
use carom_dynamics::ContactReport;
use carom_dynamics::linearised::Origin;
use carom_dynamics::state::State;
use carom_dynamics::{Control, Driver};
use carom_system::Adaptive;

/// The condensed problem of an outer step of some size with some numbers of inner steps.
pub(crate) struct Kept {
    pub(crate) substeps: Vec<u32>,
    pub(crate) dt: f64,
    pub(crate) solver: Option<LinkSolver>,
    pub(crate) outer: OuterResponse,
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
    /// Step control.
    pub control: Control,
    /// Sizes of the last outer step and the one before it, s.
    pub sizes: [f64; 2],
    /// Multipliers of the rows, N per unit of the row.
    pub multipliers: Vec<f64>,
    /// The same one and two steps before.
    pub earlier: [Vec<f64>; 2],
    /// Λ of each zone in its last step; where links turn, the forces of their terms, N.
    pub forces: Vec<Vec<f64>>,
    /// Of links that turn, the running mean of what places miss in the rows, m times the unit of the row.
    pub missed: Vec<f64>,
    /// Work of each link on both its sides, J.
    pub link_works: Vec<f64>,
    /// Where each zone was linearised last.
    pub origins: Vec<Origin>,
    /// Contacts between zones, if there are any.
    pub between: Option<CrossZoneState>,
    /// By zone.
    pub zones: Vec<State>,
    /// Passes over all outer steps, for the results.
    pub passes: u64,
    /// Products with H in all outer steps.
    pub products: u64,
}

/// The outer steps: when and how large they are, and how many inner steps the zones take in them.
pub(crate) struct OuterSteps {
    /// Inner steps of each zone to the outer step that is taken.
    pub(crate) substeps: Vec<u32>,
    /// The same where contacts may close, and where they cannot.
    pub(crate) choices: [Vec<u32>; 2],
    /// Rules of adaptive outer steps, the largest of them in s, and what their control remembers.
    pub(crate) rules: Option<Adaptive>,
    pub(crate) largest: f64,
    pub(crate) control: Control,
    /// Attempts at the last outer step.
    pub(crate) attempts: u32,
    /// When zones with inner steps would end the attempt for the first of their points in flight, after its start, s.
    pub(crate) first_cut: f64,
    /// Size of the outer step under way and of the one planned after it, s.
    pub(crate) dt: f64,
    pub(crate) next: f64,
    /// Sizes of the last outer step and the one before it, s.
    pub(crate) sizes: [f64; 2],
    pub(crate) step: u64,
    /// Time, s.
    pub(crate) time: f64,
    /// Test hook: drops the first attempt of every n-th outer step.
    pub(crate) forced: Option<u64>,
}

/// The rows of the links between zones, and their multipliers.
pub(crate) struct ZoneLinks {
    /// Range of the rows of each link.
    pub(crate) named: Vec<(String, std::ops::Range<usize>)>,
    pub(crate) kind: LinkKind,
    /// By zone, number of the row and its terms there.
    pub(crate) rows: ByZone,
    /// Links among them that turn.
    pub(crate) turning: Option<TurningLinks>,
    /// Σ |c| of each row.
    pub(crate) norms: Vec<f64>,
    /// L at the start and at the end of the step.
    pub(crate) multipliers: [Vec<f64>; 2],
    /// L one and two outer steps before the start of the step.
    pub(crate) earlier: [Vec<f64>; 2],
    /// Λ of each zone in the step that it takes, in its last one, and in its last one before the outer step; where links turn, the
    /// forces of their terms.
    pub(crate) mixes: Vec<[Vec<f64>; 3]>,
    /// Work of each link on both its sides in the outer step, and before it, J.
    pub(crate) works: [Vec<f64>; 2],
    /// Of pointwise multipliers: what the free velocities of zones with one step leave in the rows at its start and end, and the multipliers of
    /// an instant.
    pub(crate) free: [Vec<f64>; 2],
    pub(crate) pointwise: [Vec<f64>; 2],
    /// What the velocities miss in the rows, m/s.
    pub(crate) defect: Vec<f64>,
    /// Largest defect of a row after the last pass, m/s.
    pub(crate) worst: f64,
    /// The row that has it.
    pub(crate) worst_row: usize,
    /// Moves of the multipliers in the passes so far.
    pub(crate) moves: Moves,
}

/// How zones answer to the multipliers: the condensed problem H of a pass, and what passes cost.
pub(crate) struct LinkResponse {
    /// H of the multipliers that a pass looks for.
    pub(crate) solver: Option<LinkSolver>,
    /// Where the zones were linearised for H, and whether H is to be made anew.
    pub(crate) origins: Vec<Origin>,
    pub(crate) stale: bool,
    /// Part of H of the zones with one step: for pointwise multipliers.
    pub(crate) outer: OuterResponse,
    /// Both for other sizes and numbers of inner steps.
    pub(crate) kept: Vec<Kept>,
    /// Passes of the last step, and over all steps.
    pub(crate) passes: usize,
    pub(crate) all_passes: u64,
    /// Products with H in all steps, and in the one under way.
    pub(crate) products: [u64; 2],
    /// Time spent on making and solving the problem of the multipliers.
    pub(crate) link_time: Duration,
}

/// The drivers of all zones, and the links between them.
pub struct Zones {
    pub(crate) drivers: Vec<Driver>,
    /// States at the start of the outer step of zones whose state it changes.
    pub(crate) saved: Vec<Option<State>>,
    /// Contacts of the model by zone.
    pub(crate) contacts: Vec<Vec<usize>>,
    /// Contacts between zones.
    pub(crate) between: Option<CrossZoneContacts>,
    pub(crate) clock: OuterSteps,
    pub(crate) links: ZoneLinks,
    pub(crate) response: LinkResponse,
    /// What the contacts of the zones did at the instants of the outer step.
    pub(crate) samples: Vec<Sample>,
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
        &self.links.multipliers[0]
    }

    /// What the contacts of the zones did at the instants of the last outer step.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// Outer steps taken.
    pub fn outer_step(&self) -> u64 {
        self.clock.step
    }

    /// Time, s.
    pub fn time(&self) -> f64 {
        self.clock.time
    }

    /// Passes of the last outer step.
    pub fn passes(&self) -> usize {
        self.response.passes
    }

    /// Passes over all outer steps.
    pub fn all_passes(&self) -> u64 {
        self.response.all_passes
    }

    /// Products with the condensed problem of the links in all outer steps, where it is solved by iterations.
    pub fn link_products(&self) -> u64 {
        self.response.products[0]
    }

    /// Bytes held for the condensed problem of the links.
    pub fn condensed_bytes(&self) -> usize {
        let rows = self.links.norms.len();
        self.response
            .solver
            .as_ref()
            .map_or(0, |solver| solver.bytes(rows))
    }

    /// Work of each link on both its sides since the start, J: what it makes (positive) or takes.
    pub fn link_works(&self) -> &[f64] {
        &self.links.works[1]
    }

    /// The balance of all zones together.
    pub fn balance(&self) -> Balance {
        let balances = self.drivers.iter().map(|d| &d.state().ledger.balance);
        balances.fold(Balance::default(), |sum, one| sum.plus(one))
    }

    /// The state of all zones.
    pub fn state(&self) -> ZonesState {
        ZonesState {
            step: self.clock.step,
            time: self.clock.time,
            control: self.clock.control,
            sizes: self.clock.sizes,
            multipliers: self.links.multipliers[0].clone(),
            earlier: self.links.earlier.clone(),
            forces: self
                .links
                .mixes
                .iter()
                .map(|[_, last, _]| last.clone())
                .collect(),
            missed: (self.links.turning.as_ref())
                .map_or(Vec::new(), |links| links.missed().to_vec()),
            link_works: self.links.works[1].clone(),
            origins: self.response.origins.clone(),
            between: self.between.as_ref().map(|between| between.state.clone()),
            zones: self.drivers.iter().map(|d| d.state().clone()).collect(),
            passes: self.response.all_passes,
            products: self.response.products[0],
        }
    }

    /// Whether a state is of these zones, in the length of each array.
    pub(crate) fn has_state(&self, state: &ZonesState) -> bool {
        let own = self.state();
        let lengths = |state: &ZonesState| {
            let earlier = state.earlier.iter().map(Vec::len);
            let forces = state.forces.iter().map(Vec::len);
            let all: Vec<usize> = earlier.chain(forces).collect();
            let others = [
                state.multipliers.len(),
                state.missed.len(),
                state.link_works.len(),
                state.zones.len(),
            ];
            (all, others)
        };
        let origins = state.origins.iter().zip(&own.origins);
        let between = match (&state.between, &self.between) {
            (Some(state), Some(own)) => own.has_state(state),
            (None, None) => true,
            _ => false,
        };
        lengths(state) == lengths(&own)
            && state.time.is_finite()
            && state.time >= 0.0
            && state.origins.len() == own.origins.len()
            && origins.into_iter().all(|(one, other)| one.is_like(other))
            && between
    }

    /// Goes on from a state, which must be of the same zones.
    pub fn resume(&mut self, state: &ZonesState) {
        (self.clock.step, self.clock.time, self.response.all_passes) =
            (state.step, state.time, state.passes);
        self.response.products[0] = state.products;
        self.judge_solver();
        (self.clock.control, self.clock.sizes) = (state.control, state.sizes);
        self.links.multipliers[0].clone_from(&state.multipliers);
        self.links.earlier.clone_from(&state.earlier);
        for ([_, last, before], force) in self.links.mixes.iter_mut().zip(&state.forces) {
            last.clone_from(force);
            before.clone_from(force);
        }
        self.links.works[1].clone_from(&state.link_works);
        if let Some(links) = &mut self.links.turning {
            links.resume(&state.missed);
        }
        if state.origins != self.response.origins {
            self.start_from(state.origins.clone());
        }
        for (driver, state) in self.drivers.iter_mut().zip(&state.zones) {
            driver.go_back(state);
        }
        if let (Some(between), Some(state)) = (&mut self.between, &state.between) {
            between.state.clone_from(state);
        }
    }

    /// Name of each link and the range of its rows among the multipliers.
    pub fn links(&self) -> &[(String, std::ops::Range<usize>)] {
        &self.links.named
    }

    /// Contacts between zones, and what they go on from; none where all contacts are inside zones.
    pub fn between(&self) -> Option<(&[usize], &CrossZoneState)> {
        let between = self.between.as_ref()?;
        Some((&between.contacts, &between.state))
    }

    /// What a contact between zones did in the last outer step.
    pub fn report_between(&self, contact: usize) -> Option<&ContactReport> {
        let between = self.between.as_ref()?;
        let place = between.contacts.iter().position(|own| *own == contact)?;
        Some(&between.reports[place])
    }
}

impl ZonesState {
    /// The state of one zone.
    pub fn zone(&self, zone: usize) -> &State {
        &self.zones[zone]
    }
}
