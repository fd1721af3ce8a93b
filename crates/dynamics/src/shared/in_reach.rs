//! Which faces the points of contacts between surfaces may touch before nodes have moved far, and when that has to be found anew.
//!
//! It is found from the places of all nodes of such a contact, which ranks give each other for it, by all of them alike. Points whose faces have
//! no node in common are then of different [families](super::homes), until nodes have moved by what was assumed.

use std::f64::consts::SQRT_2;

use carom_contact::{Contact, Search, Sliding, Target};

use crate::of_contact::OfContact;
use crate::state::State;
use crate::system::System;

/// How far nodes may move, over the distance from which on nothing is looked at.
const PART: f64 = 0.4;

/// Steps of a motion as large as that of the last one that shall fit.
const STEPS: f64 = 4.0;

/// Of each contact the faces in reach of each point; none of contacts that one rank has as a whole.
pub(crate) type Faces = Vec<Option<Vec<Vec<u32>>>>;

/// What is known of the motion of contacts since the faces in reach were found.
#[derive(Debug, Default)]
pub(crate) struct InReach {
    /// None of those that one rank has as a whole.
    contacts: Vec<Option<Followed>>,
    /// How often it was found.
    pub(crate) looks: usize,
}

#[derive(Debug)]
struct Followed {
    search: Search,
    /// Gap up to which points are near, m.
    reach: f64,
    /// How far nodes may move, m.
    motion: f64,
    /// Bound of how far they have, m.
    travelled: f64,
    /// The same of the last step.
    last: f64,
}

impl InReach {
    /// `reaches`: gap up to which points of each contact are near, m; `at_ends`: whether a contact is paired with the ends of steps.
    pub(crate) fn new(
        system: &System,
        reaches: &[f64],
        at_ends: impl Fn(usize) -> bool,
    ) -> InReach {
        let contacts = system.contacts.iter().zip(reaches).enumerate();
        let of = |(number, (contact, &reach)): (usize, (&Contact, &f64))| {
            (follows(contact) && at_ends(number) && reach.is_finite()).then(|| Followed {
                search: Search::default(),
                reach,
                motion: least(reach),
                travelled: f64::INFINITY,
                last: 0.0,
            })
        };
        InReach {
            contacts: contacts.map(of).collect(),
            looks: 0,
        }
    }

    /// Whether a contact is shared out by what its points may touch.
    pub(crate) fn has(&self, contact: usize) -> bool {
        self.contacts[contact].is_some()
    }

    /// Whether the faces in reach are to be found before the next step.
    pub(crate) fn is_due(&self) -> bool {
        let mut contacts = self.contacts.iter().flatten();
        contacts.any(|of| of.travelled + 2.0 * of.last > of.motion)
    }

    /// Takes the motions of a step; whether one was further than was assumed, so that a point may touch a face that was not in reach.
    pub(crate) fn travel(&mut self, contacts: &[OfContact]) -> bool {
        let mut is_left = false;
        let pairs = self.contacts.iter_mut().zip(contacts);
        for (of, step) in pairs.filter_map(|(of, step)| Some((of.as_mut()?, step))) {
            of.last = step.motion;
            of.travelled += step.motion;
            is_left |= of.travelled > of.motion;
        }
        is_left
    }

    /// The faces in reach in a state whose nodes are all known here.
    pub(crate) fn find(&mut self, system: &System, state: &State) -> Faces {
        self.looks += 1;
        let motion = &state.motion;
        let places = system.places(state.time, &motion.u, &motion.frames);
        let gaps = &state.interface.gap;
        let contacts = self.contacts.iter_mut().enumerate();
        let of = |(number, of): (usize, &mut Option<Followed>)| {
            let of = of.as_mut()?;
            of.travelled = 0.0;
            of.motion = least(of.reach).max(STEPS * of.last);
            let first = system.first_point[number];
            let inside = |point: usize| gaps[first + point] < 0.0;
            let reach = [of.reach, of.motion];
            Some(system.contacts[number].in_reach(&places, &mut of.search, reach, inside))
        };
        contacts.map(of).collect()
    }
}

fn least(reach: f64) -> f64 {
    PART * SQRT_2 * reach
}

/// Whether the points of a contact are paired one by one, with the faces that they come to.
fn follows(contact: &Contact) -> bool {
    matches!(contact.target, Target::Surface(_))
        && contact.mortar.is_none()
        && contact.sliding == Sliding::Finite
        && !contact.points.iter().any(|point| point.crosses())
}
