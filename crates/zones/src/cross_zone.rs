//! Contacts between zones that step apart: forces that stand over the outer step.
//!
//! A force that is the same in all steps of the outer one gives both sides the same impulse, DT P, whatever their numbers of
//! steps: zones whose schemes keep an acceleration in their state take it from a jump of the acceleration at the start of the outer step on
//! ([`Driver::jump_link_force`]). Points are paired where the captured configuration of the outer step has them. With v_z what the steps of zone z make of P,
//!
//! * a law in the gap holds at the end of the outer step, `g + Σ_z N_z Δu_z`,
//! * a law with a compliance for the mean of the outer step, `g + ½ Σ_z N_z Δu_z` and `ġ = Σ_z N_z Δu_z / DT`: the spring of a penalty
//!   then keeps its energy,
//! * a law in the rate for `ġ = Σ_z N_z Δu_z / DT` in a point that carried a force in the step before, or that opens at its start: its force
//!   does no work on a contact that lasts,
//! * and in one that strikes, ġ < 0, for `ġ₊ = ġ + (Σ_z N_z Δu_z / DT - ġ)/ϑ`: the rate at the end, as far as the forces make it,
//!   with ϑ the mean over the end of what equal forces in all points do to the rate, ½ of a free mass and 1 where waves take the motion away at once. The work of the
//!   force is then DT P (1 - ϑ) ġ, which is never positive,
//! * friction for the sliding `Σ_z T_z Δu_z / DT`, so that its work `DT t · q` is never positive.
//!
//! With the rate at the end itself, the velocities between would do work with the force, and several inner steps make energy without bound; with
//! it in some points alone, D would have no sign.
//!
//! A pass finds these quantities for the present forces and solves the laws for `q + D Δp`, D that of the linearised zones without their own
//! contacts.

mod candidates;
mod compliance;
mod ended;
mod flights;
mod geometry;
mod solve;

pub(crate) use candidates::Candidates;
use compliance::CrossZoneCompliance;
use geometry::{Geometry, without_forces};

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::model::Zoned;
use carom_dynamics::ContactReport;
use carom_dynamics::Driver;
use carom_dynamics::linearised::Origin;
use carom_dynamics::records::Records;
use carom_dynamics::state::InterfaceState;
use carom_nonsmooth::{CandidateData, ContactSolver};
use carom_schemes::Scheme;
use carom_system::System;

/// What contacts between zones go on from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CrossZoneState {
    /// Forces, statuses and gaps of their points.
    pub interface: InterfaceState,
    /// Their records.
    pub records: Records,
    /// Work of each on both its sides, without and of friction, J.
    pub works: Vec<[f64; 2]>,
    /// By zone, nodal forces of the last outer step, N; empty of zones that take forces as those of a step.
    pub pushed: Vec<Vec<f64>>,
}

/// Contacts between zones.
pub(crate) struct CrossZoneContacts {
    /// All bodies, and these contacts alone.
    pub(crate) system: Arc<System>,
    /// Their numbers in the model.
    pub(crate) contacts: Vec<usize>,
    /// The scheme of the zone of the secondary side of each.
    schemes: Vec<Scheme>,
    pub(crate) geometry: Geometry,
    pub(crate) candidates: Candidates,
    pub(crate) compliance: CrossZoneCompliance,
    described: CandidateData,
    solver: ContactSolver,
    pub(crate) state: CrossZoneState,
    /// What the contacts did in the last outer step.
    pub(crate) reports: Vec<ContactReport>,
    /// Works of the step, J.
    now: Vec<[f64; 2]>,
    /// Largest change of a force in the last pass, N.
    change: f64,
    /// Room for what a pass changes in the forces on a zone, N.
    change_of_forces: Vec<f64>,
}

impl CrossZoneContacts {
    /// Whether a state is of these contacts.
    pub(crate) fn has_state(&self, state: &CrossZoneState) -> bool {
        state.interface.is_of(self.system.points())
            && state.records.are_of(&self.system)
            && state.works.len() == self.state.works.len()
            && (state.pushed.iter().map(Vec::len)).eq(self.state.pushed.iter().map(Vec::len))
    }

    /// `None` where no contact is between zones.
    ///
    /// # Errors
    /// A contact that zones of unequal steps cannot have.
    pub(crate) fn new(
        zoned: &Zoned,
        drivers: &[Driver],
    ) -> Result<Option<CrossZoneContacts>, Error> {
        let contacts = zoned.contacts_across();
        if contacts.is_empty() {
            return Ok(None);
        }
        let mut model = zoned.model.clone();
        let own = contacts
            .iter()
            .map(|&contact| model.contacts[contact].clone());
        model.contacts = own.collect();
        model.constraints = Vec::new();
        let system = System::whole(model)?;
        let count = contacts.len();
        let room = |driver: &Driver| match driver.jumps() {
            true => vec![0.0; driver.system().unknowns()],
            false => Vec::new(),
        };
        let scheme = |&contact: &usize| zoned.zones[zoned.zones_of(contact)[0]].scheme;
        Ok(Some(CrossZoneContacts {
            schemes: contacts.iter().map(scheme).collect(),
            contacts,
            geometry: Geometry::new(&system, (drivers, &zoned.zones)),
            candidates: Candidates::new(drivers.len()),
            compliance: CrossZoneCompliance::new(&system),
            described: CandidateData::default(),
            solver: ContactSolver::default(),
            reports: vec![ContactReport::default(); count],
            state: CrossZoneState {
                interface: without_forces(&system),
                records: Records::of(&system),
                works: vec![[0.0; 2]; count],
                pushed: drivers.iter().map(room).collect(),
            },
            now: vec![[0.0; 2]; count],
            change: 0.0,
            change_of_forces: Vec::new(),
            system,
        }))
    }

    /// Pairs and lists the candidates of an outer step of `dt` from `time` (both s), with the forces of the last one.
    pub(crate) fn begin(&mut self, drivers: &[Driver], (time, dt): (f64, f64)) {
        self.geometry.gather_start(drivers);
        self.geometry
            .pair((&self.system, &self.state.interface), (time, dt));
        self.now.fill([0.0; 2]);
        let rigid = &self.compliance.rigid;
        let of = (&*self.system, &self.geometry, rigid);
        self.candidates.choose(of, &self.state.interface, dt);
        self.change = f64::INFINITY;
    }

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
        let zones = (drivers, origins);
        let (compliance, candidates) = (&mut self.compliance, &self.candidates);
        if compliance.respond(candidates, zones, (substeps, dt))? {
            compliance.soften((candidates, &self.geometry));
            compliance.version += 1;
        }
        Ok(())
    }

    /// Begins a pass.
    pub(crate) fn begin_pass(&mut self) {
        self.candidates.rates.fill(0.0);
        self.now.fill([0.0; 2]);
    }

    /// Whether forces of a zone begin with a jump of its acceleration.
    pub(crate) fn jumps(&self, zone: usize) -> bool {
        !self.state.pushed[zone].is_empty()
    }

    /// Makes the forces of this pass, in place of those of the last outer step, stand on a zone from the start of the outer step on.
    ///
    /// # Errors
    /// A mass that is not positive definite.
    pub(crate) fn jump(&mut self, zone: usize, driver: &mut Driver) -> Result<(), Error> {
        if !self.jumps(zone) {
            return Ok(());
        }
        let mut change = std::mem::take(&mut self.change_of_forces);
        change.resize(self.state.pushed[zone].len(), 0.0);
        self.spread(zone, &mut change);
        let before = self.state.pushed[zone].iter();
        let both = change.iter_mut().zip(before);
        both.for_each(|(change, before)| *change -= before);
        let changes = change.iter().any(|change| *change != 0.0);
        let jumped = match changes {
            true => driver.jump_link_force(&change),
            false => Ok(()),
        };
        self.change_of_forces = change;
        Ok(jumped?)
    }

    /// Keeps the forces that stand on the zones.
    fn keep_pushed(&mut self) {
        let mut pushed = std::mem::take(&mut self.state.pushed);
        for (zone, pushed) in pushed.iter_mut().enumerate() {
            if !pushed.is_empty() {
                self.spread(zone, pushed);
            }
        }
        self.state.pushed = pushed;
    }

    /// Adds the forces of this pass to those on a zone, N.
    pub(crate) fn push(&self, zone: usize, driver: &mut Driver) {
        driver.add_link_rows(&self.candidates.rows[zone], &self.candidates.forces);
    }

    /// Adds the work of the forces in a step of a zone just completed.
    pub(crate) fn record(&mut self, zone: usize, driver: &Driver) {
        for (row, terms) in &self.candidates.rows[zone] {
            let row = *row as usize;
            let force = self.candidates.forces[row];
            if force != 0.0 {
                let (point, tangent) = self.candidates.of_row(row);
                let contact = self.system.contact_of(point);
                self.now[contact][usize::from(tangent.is_some())] +=
                    driver.row_work(terms, force, force);
            }
        }
    }

    /// The error of forces that still change after all passes.
    pub(crate) fn unsettled(&self, step: u64, passes: usize) -> Error {
        let first = self.candidates.points.first();
        let first = first.map_or(0, |point| *point as usize);
        Error::Unsettled {
            step,
            contact: self.system.point(first).0.name.clone(),
            change: self.change,
            passes,
        }
    }
}
