//! The contacts of an explicit step: points that are far from what they face cost nothing.
//!
//! A point is near if its gap is within eight times the largest motion of a node in the step, more than two sides come closer by in two
//! steps, and within a quarter of the mean diagonal of the faces of its contact, or four times that motion where that is more. Others face nothing in such a step. Vectors over all points change at points alone that are near, or were so in the step
//! before.

use std::sync::Arc;

use carom_contact::{Near, OwnPart, Pairing, Places, Sliding, Step};

use super::Contacts;
use super::deletion::as_narrowed;
use super::tangents::first_thought;
use crate::driver::attempt::Attempt;
use crate::shared::Own;
use crate::step_map::Row;

impl Contacts {
    /// Takes the contact of the state before into that of the end.
    pub(crate) fn follow_interface(&mut self, attempt: &mut Attempt) {
        let points = 0..attempt.system.points();
        let (before, next) = (&attempt.state.interface, &mut attempt.next.interface);
        if !self.active.begin() {
            next.follow(before);
            self.guess_slips(attempt);
        } else {
            next.follow_at(before, self.active.within(points.clone()));
            if attempt.system.tangents() > 0 {
                for point in self.active.within(points.clone()) {
                    self.slips[point] = first_thought(&next.friction[point]);
                }
            }
        }
        self.take_weak(attempt);
    }

    /// Pairs the near points, in the configurations that are known.
    pub(crate) fn pair_near(&mut self, attempt: &mut Attempt) {
        let system = Arc::clone(&attempt.system);
        let mut pairing = std::mem::take(&mut self.pairing);
        self.rows_stand = false;
        self.remember(attempt);
        let begins = self.active.begins();
        if begins {
            let contacts = system.contacts.iter().map(|pair| &pair.contact);
            pairing.open_all(contacts, system.dim);
        } else {
            self.active.keep(pairing.near());
            pairing.reopen();
        }
        let mut placed = None;
        for number in 0..system.contacts.len() {
            pairing.span = self.span(attempt, number);
            self.pair_near_of(attempt, number, &mut placed, &mut pairing);
        }
        if !begins {
            self.active.take(pairing.near());
        }
        self.pairing = pairing;
    }

    /// `placed`: configuration of the contact before.
    fn pair_near_of(
        &mut self,
        attempt: &mut Attempt,
        number: usize,
        placed: &mut Option<Row>,
        pairing: &mut Pairing,
    ) {
        let system = Arc::clone(&attempt.system);
        let (contact, first) = (
            as_narrowed(&self.narrowed, &system, number),
            system.contacts[number].range.start,
        );
        let own = match self.active.own_of(number) {
            Own::All => None,
            Own::Some(part) if part.nodes.is_empty() => return,
            Own::Some(part) => Some(OwnPart {
                points: &part.looked,
                nodes: &part.nodes,
            }),
        };
        let time = attempt.state.time + self.paired_after(attempt, number);
        let (row, map) = (
            self.paired_at(number).row(attempt.maps.first()),
            attempt.maps.first(),
        );
        if row != map.displacement {
            let xc = [&attempt.vectors.x[..], &attempt.vectors.push];
            let place = &mut attempt.vectors.place;
            place.resize(system.unknowns(), 0.0);
            attempt
                .maps
                .whole(|_| row, &attempt.state.motion, xc, place);
        }
        let u = match row == map.displacement {
            true => &attempt.next.motion.u,
            false => &attempt.vectors.place,
        };
        let places = system.places(time, u, &attempt.state.motion.frames);
        let (search, initial) = (&mut self.search[number], &mut self.initial[number]);
        if placed.replace(row) != Some(row) {
            self.far.forget_places();
        }
        let reach = self.active.reach(number);
        let start = system.places(
            attempt.state.time,
            &attempt.state.motion.u,
            &attempt.state.motion.frames,
        );
        let is_end = row == map.displacement;
        let far = &mut self.far;
        if far.are_apart(number, reach, (&places, Some(&start))) {
            if let (true, Some(way)) = (is_end, far.way(number)) {
                self.passage.know(number, way);
            }
            return search.rest_anew();
        }
        if contact.sliding == Sliding::Small && (initial.is_empty() || contact.moves()) {
            initial.clear();
            initial.span = pairing.span;
            attempt.vectors.work.clear();
            attempt.vectors.work.resize(system.unknowns(), 0.0);
            let reference = Places {
                u: &attempt.vectors.work,
                ..places
            };
            contact.pair_fully(&reference, search, initial);
        }
        let gaps = &attempt.state.interface.gap;
        // motions of steps bound what can touch where points are paired with their ends
        let step = Step {
            begins: self.active.begins(),
            at_end: is_end,
        };
        let near = Near {
            first,
            reach,
            step: Some(step),
            start: Some(&start),
            inside: &|point| gaps[first + point] < 0.0,
            initial,
            own,
        };
        contact.pair_near(&places, search, &near, pairing);
        if is_end && !contact.moves() {
            self.passage.know(number, search.motion());
        }
    }
}
