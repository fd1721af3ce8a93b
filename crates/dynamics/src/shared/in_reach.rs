//! Which faces the points of contacts between surfaces may touch before nodes have moved far, and when that has to be found anew.
//!
//! It is found from the places of all nodes of such a contact, which ranks give each other for it, by each rank for some of the points. Points whose
//! faces have no node in common are then of different [families](super::homes), until nodes have moved by what was assumed.

use std::f64::consts::SQRT_2;

use carom_contact::{Contact, Places, Search, Sliding, Target};
use carom_ranks::Ranks;

use crate::contact_sums::ContactSums;
use crate::state::State;
use crate::system::System;
use carom_system::ContactPair;

/// How far nodes may move before faces are looked for again, over the largest distance at which anything is looked at: with more, points before edges of
/// walls are near the other side of the edge.
const PART: f64 = 0.13;

/// How far they may move before the faces are in reach that homes are found with, over that: homes stay for some looks.
const AHEAD: f64 = 1.5;

/// Steps of a motion as large as that of the last one that shall fit.
const STEPS: f64 = 4.0;

/// Motions that a step may have, over that of the last one: the least, and the one that is assumed.
const LEAST: f64 = 2.0;
const ASSUMED: f64 = 4.0;

/// Of each contact the faces in reach of each point; none of contacts that one rank has as a whole.
pub(crate) type Faces = Vec<Option<Vec<Vec<u32>>>>;

/// What the points of contacts may touch until nodes have moved far.
#[derive(Debug, Default)]
pub(crate) struct InReach {
    /// None of those that one rank has as a whole.
    contacts: Vec<Option<Followed>>,
    /// All that points may touch, with faces of before as long as no other comes up: so that homes stay.
    pub(crate) faces: Faces,
}

#[derive(Debug)]
struct Followed {
    search: Search,
    /// Gap up to which points are near, m, and the largest that this may be.
    reach: f64,
    most: f64,
    /// How far nodes may move, m.
    motion: f64,
    /// Bounds of how far they have, when faces were looked for and since, and in the last step, m.
    before: f64,
    since: f64,
    last: f64,
    /// Of each point the faces that were found last, those that it may touch before the next look as they are and others by their complement,
    /// and the bound of the motion up to which it touches nothing without any, m.
    found: Vec<Vec<i32>>,
    wakes: Vec<f64>,
}

impl InReach {
    /// `reaches`: gap up to which points of each contact are near, m; `at_ends`: whether a contact is paired with the ends of steps.
    pub(crate) fn new(
        system: &System,
        reaches: &[f64],
        at_ends: impl Fn(usize) -> bool,
    ) -> InReach {
        let contacts = system.contacts.iter().zip(reaches).enumerate();
        let of = |(number, (contact, &most)): (usize, (&ContactPair, &f64))| {
            let points = contact.points.len();
            (follows(contact) && at_ends(number) && most.is_finite()).then(|| Followed {
                search: Search::default(),
                reach: 0.0,
                most,
                motion: 0.0,
                before: 0.0,
                since: 0.0,
                last: 0.0,
                found: vec![Vec::new(); points],
                wakes: vec![f64::NEG_INFINITY; points],
            })
        };
        InReach {
            contacts: contacts.map(of).collect(),
            faces: Vec::new(),
        }
    }

    /// Whether a contact is shared out by what its points may touch.
    pub(crate) fn has(&self, contact: usize) -> bool {
        self.contacts[contact].is_some()
    }

    /// Gap up to which points of a contact are looked at, m; none of contacts that one rank has as a whole.
    pub(crate) fn reach(&self, contact: usize) -> Option<f64> {
        self.contacts[contact].as_ref().map(|of| of.reach)
    }

    /// Whether faces are to be looked for before the next step.
    pub(crate) fn is_due(&self, system: &System) -> bool {
        let mut contacts = self.contacts.iter().zip(&system.contacts);
        contacts.any(|(of, contact)| {
            let due = |of: &Followed| {
                let reach = contact.reach(LEAST * of.last, of.most);
                of.since + LEAST * of.last > of.motion || reach > of.reach
            };
            of.as_ref().is_some_and(due)
        })
    }

    /// Takes the motions of a step; whether one was further than was assumed, so that a point may touch a face that was not in reach.
    pub(crate) fn travel(&mut self, system: &System, steps: &[ContactSums]) -> bool {
        let mut is_left = false;
        let contacts = self.contacts.iter_mut().zip(&system.contacts).zip(steps);
        for ((of, contact), step) in contacts {
            let Some(of) = of else { continue };
            of.last = step.motion;
            of.since += step.motion;
            let reach = contact.reach(step.motion, of.most);
            is_left |= of.since > of.motion || reach > of.reach;
        }
        is_left
    }

    /// Looks for faces in a state the places of whose contacts are known here, each rank for some of the points; whether any face has come into
    /// reach. All ranks ask together.
    pub(crate) fn look(&mut self, system: &System, state: &State, ranks: &Ranks) -> bool {
        let (motion, gaps) = (&state.motion, &state.interface.gap);
        let places = system.places(state.time, &motion.u, &motion.frames);
        let mut told = Vec::new();
        for (number, of) in self.contacts.iter_mut().enumerate() {
            if let Some(of) = of {
                let first = told.len();
                let gaps = &gaps[system.points_of(number)];
                let contact = &system.contacts[number];
                of.look(contact, &places, (gaps, ranks), &mut told);
                let count = told.len() - first;
                told.splice(first..first, [number as f64, count as f64]);
            }
        }
        let all = ranks.gather_all(&told);
        let mut changes = self.faces.is_empty();
        let mut rest = &all[..];
        while let [number, count, behind @ ..] = rest {
            let (lists, behind) = behind.split_at(*count as usize);
            rest = behind;
            let number = *number as usize;
            if let Some(of) = &mut self.contacts[number] {
                let known = self.faces.get(number).and_then(Option::as_ref);
                changes |= of.take(lists, known);
            }
        }
        if changes {
            let found = |of: &Option<Followed>| Some(of.as_ref()?.faces());
            self.faces = self.contacts.iter().map(found).collect();
        }
        changes
    }
}

impl Followed {
    /// Looks for the faces of the points of this rank, and tells of those where others than before are found.
    fn look(
        &mut self,
        contact: &Contact,
        places: &Places,
        (gaps, ranks): (&[f64], &Ranks),
        told: &mut Vec<f64>,
    ) {
        self.before += self.since;
        self.since = 0.0;
        self.motion = (PART * SQRT_2 * self.most).max(STEPS * self.last);
        let reaches = [LEAST, ASSUMED].map(|part| contact.reach(part * self.last, self.most));
        let [least, reach] = reaches;
        if !(least..=ASSUMED * reach).contains(&self.reach) {
            if reach > self.reach {
                self.wakes.fill(f64::NEG_INFINITY);
            }
            self.reach = reach;
        }
        let until = self.before + self.motion;
        // neighbours are with all ranks, so that each has as much to look for
        let own = (0..contact.points.len()).skip(ranks.rank());
        let own = own.step_by(ranks.count());
        let due = own.filter(|&point| self.wakes[point] <= until);
        let due: Vec<u32> = due.map(|point| point as u32).collect();
        let inside = |point: usize| gaps[point] < 0.0;
        let reach = [self.reach, self.most, AHEAD * self.motion];
        let at = (places, self.before);
        let found = contact.in_reach(at, &mut self.search, reach, (&due, inside));
        for (point, found) in due.into_iter().zip(found) {
            let at = point as usize;
            self.wakes[at] = match found.faces.is_empty() {
                true => self.before + found.clearance,
                false => f64::NEG_INFINITY,
            };
            let faces = found.faces.iter();
            let faces = faces.map(|&(face, rest)| match rest < self.motion {
                true => face as i32,
                false => !(face as i32),
            });
            if !faces.clone().eq(self.found[at].iter().copied()) {
                told.extend([f64::from(point), found.faces.len() as f64]);
                told.extend(faces.map(f64::from));
            }
        }
    }

    /// The faces of each point.
    fn faces(&self) -> Vec<Vec<u32>> {
        let number = |face: &i32| face.max(&!*face).unsigned_abs();
        let of = |found: &Vec<i32>| found.iter().map(number).collect();
        self.found.iter().map(of).collect()
    }

    /// Takes what a rank has told of; whether any face may be touched before the next look that is not `known`.
    fn take(&mut self, mut told: &[f64], known: Option<&Vec<Vec<u32>>>) -> bool {
        let mut changes = false;
        while let [point, count, rest @ ..] = told {
            let (faces, rest) = rest.split_at(*count as usize);
            told = rest;
            let (point, found) = (*point as usize, faces.iter().map(|face| *face as i32));
            self.found[point].clear();
            self.found[point].extend(found);
            let known = known.map_or(&[][..], |known| &known[point]);
            let mut soon = self.found[point].iter().filter(|face| **face >= 0);
            changes |= soon.any(|face| !known.contains(&(*face as u32)));
        }
        changes
    }
}

/// Whether the points of a contact are paired one by one, with the faces that they come to.
fn follows(contact: &Contact) -> bool {
    matches!(contact.target, Target::Surface(_))
        && contact.mortar.is_none()
        && contact.sliding == Sliding::Finite
        && !contact
            .points
            .iter()
            .any(|point| point.crosses() && !point.is_at_edge())
}
