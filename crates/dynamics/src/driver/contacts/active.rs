//! The points that an attempt looks at: in explicit steps those that are near what they face, or were so in the step before.

use std::ops::Range;

use crate::shared::{InReach, Own};
use crate::system::System;

/// Gap up to which a point is near, over the mean diagonal of the faces. In a stable step a wave crosses no more than the height of
/// a cell, and sides come closer by far less.
const REACH: f64 = 0.25;

/// The points of an attempt.
#[derive(Default)]
pub(crate) struct Active {
    /// Whether they are all that this process has.
    all: bool,
    /// The points that it has, ascending; none for all.
    own: Option<Vec<u32>>,
    /// The same of each contact.
    own_of: Vec<Own>,
    /// Otherwise these, ascending.
    points: Vec<u32>,
    /// Near points of the step before.
    before: Vec<u32>,
    /// Gap up to which points of each contact are near, m.
    pub(crate) reaches: Vec<f64>,
    /// The same of contacts that several ranks have, where nodes move little; empty without any.
    looks_to: Vec<Option<f64>>,
    /// Whether the last attempt was of this kind, and whether the state is its end.
    offered: bool,
    goes_on: bool,
    /// Whether the attempt under way begins such steps.
    begins: bool,
}

impl Active {
    pub(crate) fn of(system: &System) -> Active {
        let contacts = system.contacts.iter();
        Active {
            all: true,
            own: None,
            own_of: vec![Own::All; system.contacts.len()],
            points: Vec::new(),
            before: Vec::new(),
            reaches: contacts
                .map(|pair| REACH * pair.mean_diagonal(&pair.secondary_faces, &system.x))
                .collect(),
            looks_to: Vec::new(),
            offered: false,
            goes_on: false,
            begins: true,
        }
    }

    /// Lets points of contacts that several ranks have look as far as the faces are known.
    pub(crate) fn look_to(&mut self, in_reach: &InReach) {
        let contacts = 0..self.reaches.len();
        self.looks_to.clear();
        self.looks_to
            .extend(contacts.map(|contact| in_reach.reach(contact)));
    }

    /// Gap up to which points of a contact are looked at, m.
    pub(crate) fn reach(&self, contact: usize) -> f64 {
        let narrower = self.looks_to.get(contact).copied().flatten();
        narrower.unwrap_or(self.reaches[contact])
    }

    /// Leaves the points that this process does not have to others.
    pub(super) fn keep_own(&mut self, system: &System, own_of: Vec<Own>) {
        let mut own = Vec::new();
        for (contact, of) in own_of.iter().enumerate() {
            let points = system.points_of(contact);
            match of {
                Own::All => own.extend(points.map(|point| point as u32)),
                Own::Some(part) => {
                    let first = points.start as u32;
                    own.extend(part.points.iter().map(|point| first + point));
                }
            }
        }
        (self.own, self.own_of) = (Some(own), own_of);
    }

    /// Configuration points of a contact this process has.
    pub(super) fn own_of(&self, contact: usize) -> &Own {
        &self.own_of[contact]
    }

    /// Points that this process has, where others have some.
    pub(crate) fn own_points(&self) -> usize {
        self.own.as_ref().map_or(0, Vec::len)
    }

    /// Whether nothing is known of the step before.
    pub(crate) fn begins(&self) -> bool {
        self.begins
    }

    /// Those of a range, ascending.
    pub(crate) fn within(&self, range: Range<usize>) -> impl Iterator<Item = usize> + Clone + '_ {
        let list = match self.all {
            true => self.own.as_ref(),
            false => Some(&self.points),
        };
        let (all, list) = match list {
            None => (range, &[][..]),
            Some(list) => {
                let place = |end: usize| list.partition_point(|&point| (point as usize) < end);
                (0..0, &list[place(range.start)..place(range.end)])
            }
        };
        all.chain(list.iter().map(|&point| point as usize))
    }

    /// Lets an attempt look at all points.
    pub(crate) fn leave(&mut self) {
        (self.all, self.offered, self.goes_on) = (true, false, false);
    }

    /// Tells that the attempt has become the state.
    pub(crate) fn accept(&mut self) {
        self.goes_on = std::mem::take(&mut self.offered);
    }

    /// Begins an attempt that looks at near points; whether the state is the end of such a step, whose points these still are.
    pub(crate) fn begin(&mut self) -> bool {
        self.offered = true;
        self.begins = !std::mem::take(&mut self.goes_on);
        self.all |= self.begins;
        !self.begins
    }

    /// Takes note of the near points of the step before.
    pub(crate) fn keep(&mut self, near: &[u32]) {
        self.before.clear();
        self.before.extend_from_slice(near);
    }

    /// Makes these the points near now and in the step before.
    pub(crate) fn take(&mut self, near: &[u32]) {
        self.all = false;
        self.points.clear();
        let (mut old, mut new) = (self.before.iter().peekable(), near.iter().peekable());
        loop {
            let least = match (old.peek(), new.peek()) {
                (Some(a), Some(b)) => **a.min(b),
                (Some(one), None) | (None, Some(one)) => **one,
                (None, None) => return,
            };
            self.points.push(least);
            old.next_if(|point| **point == least);
            new.next_if(|point| **point == least);
        }
    }
}
