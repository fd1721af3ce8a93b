//! Where the points of contacts between zones are.

use carom_algebra::rotation::Rotation;
use carom_contact::{Pairing, Search};

use crate::model::ModelZone;
use crate::places::Places;
use carom_dynamics::Driver;
use carom_dynamics::paired::append;
use carom_dynamics::state::{InterfaceState, empty_state};
use carom_system::{Motion, System};

/// Where the points of contacts between zones are paired.
pub(crate) struct Geometry {
    /// Zone of each unknown of the whole, and its number there.
    pub(crate) homes: Vec<(usize, u32)>,
    pub(super) places: Vec<Places>,
    search: Vec<Search>,
    initial: Vec<Pairing>,
    pub(crate) pairing: Pairing,
    /// Displacements and velocities of the whole at the start of the step, and at its end.
    pub(super) start: [Vec<f64>; 2],
    pub(super) end: [Vec<f64>; 2],
    /// Rotations of the whole at the start of the step.
    pub(super) frames: Vec<Rotation>,
    place: Vec<f64>,
    still: Vec<f64>,
    /// Room for nodal forces, N.
    pub(super) nodal: Vec<f64>,
}

impl Geometry {
    pub(super) fn new(system: &System, (drivers, zones): (&[Driver], &[ModelZone])) -> Geometry {
        let mut taken = vec![false; system.unknowns()];
        let of_zone = |(driver, zone): (&Driver, &ModelZone)| {
            Places::new(driver.system(), (&zone.bodies, &[]), system, &mut taken)
        };
        let places: Vec<Places> = drivers.iter().zip(zones).map(of_zone).collect();
        let mut homes = vec![(0, 0); system.unknowns()];
        for (zone, places) in places.iter().enumerate() {
            for &(own, whole) in &places.own {
                homes[whole as usize] = (zone, own);
            }
        }
        let count = system.contacts.len();
        let zeros = || vec![0.0; system.unknowns()];
        Geometry {
            homes,
            places,
            search: (0..count).map(|_| Search::default()).collect(),
            initial: vec![Pairing::default(); count],
            pairing: Pairing::default(),
            start: [zeros(), zeros()],
            end: [zeros(), zeros()],
            frames: system.initial.frames.clone(),
            place: zeros(),
            still: zeros(),
            nodal: Vec::new(),
        }
    }

    /// Takes the motion of the zones for that at the start of the step.
    pub(super) fn gather_start(&mut self, drivers: &[Driver]) {
        gather(drivers, &self.places, &mut self.start);
        for (driver, places) in drivers.iter().zip(&self.places) {
            for &(own, whole) in &places.frames {
                self.frames[whole] = driver.state().motion.frames[own];
            }
        }
    }

    /// Pairs the points for an outer step of `dt` from `time` (both s); 0 for the present instant.
    pub(super) fn pair(
        &mut self,
        (system, interface): (&System, &InterfaceState),
        (time, dt): (f64, f64),
    ) {
        self.pairing.clear();
        self.pairing.span = [0.0; 2];
        for (k, contact) in system.contacts.iter().enumerate() {
            let part = contact.law.get().capture() * dt;
            let [u, v] = &self.start;
            for (i, place) in self.place.iter_mut().enumerate() {
                *place = u[i] + part * v[i];
            }
            let places = system.places(time + part, &self.place, &self.frames);
            self.search[k].remember(interface.faced_of(system.points_of(k)));
            let kept = (&mut self.search[k], &mut self.initial[k]);
            append(contact, &places, &mut self.still, kept, &mut self.pairing);
        }
    }
}

/// Displacements and velocities of the whole from those of the zones at the present instant.
pub(super) fn gather(drivers: &[Driver], places: &[Places], [u, v]: &mut [Vec<f64>; 2]) {
    for (driver, places) in drivers.iter().zip(places) {
        let motion: &Motion = &driver.state().motion;
        for &(own, whole) in &places.own {
            u[whole as usize] = motion.u[own as usize];
            v[whole as usize] = motion.v[own as usize];
        }
    }
}

/// Which unknowns are those of rigid bodies, and the part by which the own response of their points grows.
pub(crate) struct RigidUnknowns {
    are: Vec<bool>,
    pub(super) growth: f64,
}

impl RigidUnknowns {
    pub(super) fn of(system: &System) -> RigidUnknowns {
        let (are, growth) = system.rigid_points();
        RigidUnknowns { are, growth }
    }

    /// Whether a rigid body has part in a point.
    pub(crate) fn have(&self, geometry: &Geometry, point: u32) -> bool {
        let (unknowns, _) = geometry.pairing.rows.row(point as usize);
        let mut unknowns = unknowns.iter();
        unknowns.any(|unknown| self.are.get(*unknown as usize) == Some(&true))
    }
}

/// Points that carry nothing.
pub(super) fn without_forces(system: &System) -> InterfaceState {
    let mut interface = empty_state(system).interface;
    if system.tangents() > 0 {
        interface.friction.resize(system.points(), [0.0; 2]);
    }
    interface
}
