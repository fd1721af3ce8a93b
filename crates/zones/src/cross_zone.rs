//! Contacts between zones that step apart: forces that stand over the outer step, laws in the rate at its end.
//!
//! A force that is the same in all steps of the outer one gives both sides the same impulse, DT P, whatever their numbers of
//! steps. Points are paired where the captured configuration of the outer step has them, and law and force obey
//! `ġ(P) = Σ_z N_z v_z(t + DT)`, with v_z what the steps of zone z make of P. Of a point that carried a force in the step before,
//! `ġ = Σ_z N_z Δu_z / DT`: a force that stands over the step then does no work on a contact that lasts. With the rate at the end, the
//! velocities between would do work with it, and several inner steps make energy without bound. A pass finds the rates of the present
//! forces and solves `ġ + D ΔP` with its signs, D that of the linearised zones without their own contacts; between a point that
//! lasts and one that does not, the mean of both responses stands for D, which costs passes and changes no result.

mod ended;
mod flights;

use std::sync::Arc;

use carom_algebra::rotation::Rotation;
use carom_contact::law::{Local, Status};
use carom_contact::{Pairing, Search};
use carom_nonsmooth::Compliance;
use serde::{Deserialize, Serialize};

use crate::ending::{GAIN, TOLERANCE, rounding, speed};
use crate::error::Error;
use crate::model::{ModelZone, Zoned};
use crate::places::Places;
use carom_dynamics::ContactReport;
use carom_dynamics::Driver;
use carom_dynamics::paired::{append, approaches, told};
use carom_dynamics::records::Records;
use carom_dynamics::state::{InterfaceState, empty_state};
use carom_nonsmooth::interface::{Candidate, Interface};
use carom_schemes::Scheme;
use carom_system::{LinkRow, System, on};

/// What contacts between zones go on from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CrossZoneState {
    /// Forces, statuses and gaps of their points.
    pub interface: InterfaceState,
    /// Their records.
    pub records: Records,
    /// Work of each on both its sides, J.
    pub works: Vec<f64>,
}

/// Contacts between zones.
pub(crate) struct CrossZoneContacts {
    /// All bodies, and these contacts alone.
    pub(crate) system: Arc<System>,
    /// Their numbers in the model.
    pub(crate) contacts: Vec<usize>,
    /// The scheme of the zone of the secondary side of each.
    schemes: Vec<Scheme>,
    /// Zone of each unknown of the whole, and its number there.
    homes: Vec<(usize, u32)>,
    places: Vec<Places>,
    search: Vec<Search>,
    initial: Vec<Pairing>,
    pub(crate) pairing: Pairing,
    /// Points that may carry a force in the step.
    pub(crate) candidates: Vec<u32>,
    /// Whether they carried a force in the step before.
    pub(crate) lasting: Vec<bool>,
    /// Their forces in this pass, N.
    forces: Vec<f64>,
    /// Rows of the candidates by zone.
    pub(crate) rows: Vec<Vec<(u32, LinkRow)>>,
    /// Rates at the end of the step and over it that unit forces leave, the rows that they are of, and the sizes of the steps of the
    /// zones; D of the candidates, and which of them lasted in it.
    pub(crate) responses: [Vec<f64>; 2],
    pub(crate) matrix: Vec<f64>,
    pub(crate) matrix_of: Vec<bool>,
    /// D with the own responses of points of rigid bodies a little larger; empty without such candidates.
    pub(crate) softened: Vec<f64>,
    /// Which unknowns are those of rigid bodies, and the part by which the own response of their points grows.
    pub(crate) rigid: (Vec<bool>, f64),
    pub(crate) of: Vec<(Vec<u32>, Vec<f64>)>,
    pub(crate) sizes: Vec<f64>,
    pub(crate) version: u64,
    rates: Vec<f64>,
    interface: Interface,
    data: Vec<Candidate>,
    /// Displacements and velocities of the whole at the start of the step, and at its end.
    start: [Vec<f64>; 2],
    end: [Vec<f64>; 2],
    /// Rotations of the whole at the start of the step.
    frames: Vec<Rotation>,
    place: Vec<f64>,
    /// Room for nodal forces, N.
    nodal: Vec<f64>,
    still: Vec<f64>,
    pub(crate) state: CrossZoneState,
    /// What the contacts did in the last outer step.
    pub(crate) reports: Vec<ContactReport>,
    /// Works of the step, J.
    now: Vec<f64>,
    /// Largest change of a force in the last pass, N.
    change: f64,
}

impl CrossZoneContacts {
    /// Whether a state is of these contacts.
    pub(crate) fn has_state(&self, state: &CrossZoneState) -> bool {
        state.interface.is_of(self.system.points())
            && state.records.are_of(&self.system)
            && state.works.len() == self.state.works.len()
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
        let system = System::whole(model)?;
        let mut taken = vec![false; system.unknowns()];
        let of_zone = |(driver, zone): (&Driver, &ModelZone)| {
            Places::new(driver.system(), (&zone.bodies, &[]), &system, &mut taken)
        };
        let places: Vec<Places> = drivers.iter().zip(&zoned.zones).map(of_zone).collect();
        let mut homes = vec![(0, 0); system.unknowns()];
        for (zone, places) in places.iter().enumerate() {
            for &(own, whole) in &places.own {
                homes[whole as usize] = (zone, own);
            }
        }
        let count = contacts.len();
        let zeros = || vec![0.0; system.unknowns()];
        let scheme = |&contact: &usize| zoned.zones[zoned.zones_of(contact)[0]].scheme;
        Ok(Some(CrossZoneContacts {
            schemes: contacts.iter().map(scheme).collect(),
            contacts,
            homes,
            places,
            search: (0..count).map(|_| Search::default()).collect(),
            initial: vec![Pairing::default(); count],
            pairing: Pairing::default(),
            candidates: Vec::new(),
            lasting: Vec::new(),
            forces: Vec::new(),
            rows: vec![Vec::new(); drivers.len()],
            responses: Default::default(),
            matrix: Vec::new(),
            matrix_of: Vec::new(),
            softened: Vec::new(),
            rigid: system.rigid_points(),
            of: Vec::new(),
            sizes: Vec::new(),
            version: 0,
            rates: Vec::new(),
            interface: Interface::default(),
            data: Vec::new(),
            start: [zeros(), zeros()],
            end: [zeros(), zeros()],
            frames: system.initial.frames.clone(),
            place: zeros(),
            nodal: Vec::new(),
            still: zeros(),
            reports: vec![ContactReport::default(); count],
            state: CrossZoneState {
                interface: empty_state(&system).interface,
                records: Records::of(&system),
                works: vec![0.0; count],
            },
            now: vec![0.0; count],
            change: 0.0,
            system,
        }))
    }

    fn gather_frames(&mut self, drivers: &[Driver]) {
        for (driver, places) in drivers.iter().zip(&self.places) {
            for &(own, whole) in &places.frames {
                self.frames[whole] = driver.state().motion.frames[own];
            }
        }
    }

    /// The way of the points of a contact in the step, of `dt` (s), at which it is paired, as a part of `dt`.
    fn captured(&self, contact: usize) -> f64 {
        self.system.contacts[contact].law.get().capture()
    }

    /// Pairs the points for an outer step of `dt` from `time` (both s); 0 for the present instant.
    fn pair(&mut self, (time, dt): (f64, f64)) {
        let system = Arc::clone(&self.system);
        self.pairing.clear();
        self.pairing.span = [0.0; 2];
        for (k, contact) in system.contacts.iter().enumerate() {
            let part = self.captured(k) * dt;
            let [u, v] = &self.start;
            for (i, place) in self.place.iter_mut().enumerate() {
                *place = u[i] + part * v[i];
            }
            let places = system.places(time + part, &self.place, &self.frames);
            let kept = (&mut self.search[k], &mut self.initial[k]);
            append(contact, &places, &mut self.still, kept, &mut self.pairing);
        }
    }

    /// Pairs and lists the candidates of an outer step of `dt` from `time` (both s), with the forces of the last one.
    pub(crate) fn begin(&mut self, drivers: &[Driver], (time, dt): (f64, f64)) {
        gather(drivers, &self.places, &mut self.start);
        self.gather_frames(drivers);
        self.pair((time, dt));
        let system = Arc::clone(&self.system);
        self.candidates.clear();
        self.now.fill(0.0);
        for point in 0..system.points() {
            let law = &system.point(point).0.law;
            let rows = &self.pairing.rows;
            let captured = (rows.gap(point), rows.product(point, &self.start[1]));
            let tolerance = system.tolerance_at(point);
            let chosen = told(law, captured, dt, tolerance).unwrap_or_else(|| {
                let near = approaches(captured, dt, tolerance);
                near || self.state.interface.force[point] != 0.0
            });
            if chosen {
                self.candidates.push(point as u32);
            }
        }
        let force = |&point: &u32| self.state.interface.force[point as usize];
        self.forces = self.candidates.iter().map(force).collect();
        self.lasting = self.forces.iter().map(|force| *force != 0.0).collect();
        self.let_rigid_begin();
        self.change = f64::INFINITY;
        self.rows.iter_mut().for_each(Vec::clear);
        for (k, &point) in self.candidates.iter().enumerate() {
            let (dofs, coefficients) = self.pairing.rows.row(point as usize);
            for (&dof, &n) in dofs.iter().zip(coefficients) {
                let (zone, own) = self.homes[dof as usize];
                match self.rows[zone].last_mut() {
                    Some((row, terms)) if *row == k as u32 => terms.push((own, n)),
                    _ => self.rows[zone].push((k as u32, vec![(own, n)])),
                }
            }
        }
    }

    /// Begins a pass.
    pub(crate) fn begin_pass(&mut self) {
        self.rates.clear();
        self.rates.resize(self.candidates.len(), 0.0);
        self.now.fill(0.0);
    }

    /// Adds the forces of this pass to those on a zone, N.
    pub(crate) fn push(&self, zone: usize, driver: &mut Driver) {
        driver.add_link_rows(&self.rows[zone], &self.forces);
    }

    /// Adds the work of the forces in a step of a zone just completed.
    pub(crate) fn record(&mut self, zone: usize, driver: &Driver) {
        for (row, terms) in &self.rows[zone] {
            let force = self.forces[*row as usize];
            if force != 0.0 {
                let contact = self
                    .system
                    .contact_of(self.candidates[*row as usize] as usize);
                self.now[contact] += driver.row_work(terms, force, force);
            }
        }
    }

    /// Adds the rates of a step of a zone just completed: over the outer step of `dt` (s), or those at its end if it is the `last`.
    pub(crate) fn look(&mut self, zone: usize, driver: &Driver, (last, dt): (bool, f64)) {
        for (row, terms) in &self.rows[zone] {
            let row = *row as usize;
            match self.lasting[row] {
                true => self.rates[row] += driver.row_way(terms) / dt,
                false if last => self.rates[row] += on(terms, &driver.ended().motion.v),
                false => {}
            }
        }
    }

    /// Whether the forces obey the laws at the rates found, or would after a change by rounding; corrects them if not. `dt`: the outer step, s.
    ///
    /// # Errors
    /// A contact problem without solution.
    pub(crate) fn corrected(
        &mut self,
        (step, dt): (u64, f64),
        drivers: &[Driver],
    ) -> Result<bool, Error> {
        let n = self.candidates.len();
        if n == 0 {
            return Ok(true);
        }
        let system = Arc::clone(&self.system);
        self.data.clear();
        for (i, &point) in self.candidates.iter().enumerate() {
            let point = point as usize;
            let (contact, place) = system.point(point);
            let carrier = &contact.points[place];
            let of_forces = (0..n).map(|j| self.matrix[i * n + j] * self.forces[j]);
            let rows = &self.pairing.rows;
            let gap = rows.gap(point);
            self.data.push(Candidate {
                law: contact.law,
                local: Local {
                    area: carrier.area,
                    share: carrier.share,
                    gap,
                    // what lasts has nothing to give back
                    rate: match self.lasting[i] {
                        true => 0.0,
                        false => rows.product(point, &self.start[1]),
                    },
                    start: 0.0,
                    gap_free: gap,
                    dt,
                    tolerance: system.tolerance_at(point),
                    crush: 0.0,
                    at: [0.0; 2],
                },
                rate_free: self.rates[i] - of_forces.sum::<f64>(),
                status: match self.forces[i] != 0.0 {
                    true => Status::Closed,
                    false => self.state.interface.status[point],
                },
                faces_itself: false,
                instant: [1.0; 2],
            });
        }
        let matrix = match self.softened.is_empty() {
            true => &self.matrix,
            false => &self.softened,
        };
        let problem = (Compliance::Dense(matrix), self.version);
        let solved = self.interface.solve(&self.data, problem, [0.0, 1.0]);
        if let Err(failure) = solved {
            let contact = system.point(self.candidates[0] as usize).0.name.clone();
            return Err(Error::CrossZone {
                step: step + 1,
                contact,
                cause: failure,
            });
        }
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        let changes = self.forces.iter().zip(&self.interface.forces);
        let change = changes.fold(0.0_f64, |m, (old, new)| m.max((old - new).abs()));
        let gains = change < GAIN * self.change;
        self.change = change;
        let held = change <= TOLERANCE * largest(&self.interface.forces)
            || !gains && (change <= rounding(drivers) || self.keeps_rates(speed(drivers)));
        if !held {
            self.forces.clone_from(&self.interface.forces);
        }
        Ok(held)
    }

    /// Whether the forces just found leave the rates what they are, beside the rounding of velocities up to this `speed` (m/s): those of
    /// points of rigid bodies are not unique, and those that a stiff body needs to change its rate by rounding may be large.
    fn keeps_rates(&self, speed: f64) -> bool {
        let n = self.candidates.len();
        let changes = self.interface.forces.iter().zip(&self.forces);
        let changes: Vec<f64> = changes.map(|(new, old)| new - old).collect();
        self.candidates.iter().enumerate().all(|(i, &point)| {
            let of_changes = self.matrix[i * n..(i + 1) * n].iter().zip(&changes);
            let rate: f64 = of_changes.map(|(d, change)| d * change).sum();
            let (_, coefficients) = self.pairing.rows.row(point as usize);
            let size: f64 = coefficients.iter().map(|n| n.abs()).sum();
            rate.abs() <= TOLERANCE * size * speed
        })
    }

    /// The error of forces that still change after all passes.
    pub(crate) fn unsettled(&self, step: u64, passes: usize) -> Error {
        let first = self.candidates.first().map_or(0, |point| *point as usize);
        Error::Unsettled {
            step,
            contact: self.system.point(first).0.name.clone(),
            change: self.change,
            passes,
        }
    }
}

/// Displacements and velocities of the whole from those of the zones at the present instant.
fn gather(drivers: &[Driver], places: &[Places], [u, v]: &mut [Vec<f64>; 2]) {
    for (driver, places) in drivers.iter().zip(places) {
        let motion = &driver.state().motion;
        for &(own, whole) in &places.own {
            u[whole as usize] = motion.u[own as usize];
            v[whole as usize] = motion.v[own as usize];
        }
    }
}
