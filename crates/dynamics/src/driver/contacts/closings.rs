//! Configuration contacts of rigid bodies close out of flight in the step under way, and when.

use carom_contact::{Law, Pairing};

use crate::system::System;

/// Closings of contacts of rigid bodies.
pub(crate) struct Closings {
    /// Whether a contact is one between two rigid bodies, or of one with an obstacle, under a law that stops rates.
    pub(crate) rigid: Vec<bool>,
    /// By contact, in the step under way: when it closes out of flight, over the time by which points move; none of others.
    pub(crate) instant: Vec<Option<f64>>,
    /// Room for the pairing of one contact.
    pub(crate) room: Pairing,
}

impl Closings {
    pub(crate) fn of(system: &System) -> Closings {
        let rigid = |number: usize| {
            let law = &system.contacts[number].law;
            let stops = matches!(law, Law::Velocity(_) | Law::Restitution(_));
            let tests = law.get().watches(-1.0, 0.0) == Some(true);
            stops && tests && !system.is_of_many(number) && is_rigid(system, number)
        };
        let contacts = 0..system.contacts.len();
        Closings {
            instant: vec![None; contacts.len()],
            rigid: contacts.map(rigid).collect(),
            room: Pairing::default(),
        }
    }

    /// When a contact closes out of flight.
    pub(crate) fn instant(&self, contact: usize) -> Option<f64> {
        self.instant[contact]
    }
}

/// Whether all bodies of a contact are rigid.
pub(crate) fn is_rigid(system: &System, contact: usize) -> bool {
    let mut bodies = system.contacts[contact].bodies.iter();
    bodies.all(|&body| system.bodies[body].as_rigid().is_some())
}
