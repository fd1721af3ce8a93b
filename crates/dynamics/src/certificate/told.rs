//! What a certificate has found.

use serde::{Deserialize, Serialize};

use crate::system::System;

type Vec3 = [f64; 3];

/// What a certificate has found, and what it goes on from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Told {
    pub(super) pairs: Vec<Pair>,
    /// What any two may move relative to each other until pairs are chosen anew, m.
    pub(super) left: f64,
    /// Pairs that met.
    pub crossings: Vec<Crossing>,
    /// Pairs whose cores meet at the start, ascending.
    pub(super) overlapping: Vec<[u32; 2]>,
    /// Pairs of nodes, edges and triangles that were looked at.
    pub tested: u64,
}

/// A pair that is followed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Pair {
    pub(super) of: [u32; 2],
    /// What both may still move towards each other, m.
    pub(super) left: f64,
}

/// Two that met, for the first time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Crossing {
    /// Their numbers ([`names`](crate::Findings::names)).
    pub of: [u32; 2],
    /// The contact that is between them, if there is one.
    pub contact: Option<usize>,
    /// Whether that has a force at the end of the step: how deep it lets them go is told by its records.
    pub held: bool,
    /// When, s.
    pub time: f64,
    /// Where, m.
    pub place: Vec3,
}

impl Told {
    /// Becomes a copy, in the memory that it has.
    pub(super) fn follow(&mut self, other: &Told) {
        self.pairs.clone_from(&other.pairs);
        self.left = other.left;
        self.crossings.clone_from(&other.crossings);
        self.overlapping.clone_from(&other.overlapping);
        self.tested = other.tested;
    }

    /// Whether it is of a system.
    pub fn is_of(&self, system: &System) -> bool {
        let (cores, contacts) = (system.cores().len(), system.contacts.len());
        let known = |of: &[u32; 2]| of.iter().all(|number| (*number as usize) < cores);
        self.pairs.iter().all(|pair| known(&pair.of))
            && self.overlapping.iter().all(known)
            && self.crossings.iter().all(|crossing| {
                known(&crossing.of) && crossing.contact.is_none_or(|contact| contact < contacts)
            })
    }

    /// Those that passed through each other and are of some kind.
    pub fn those(&self, is: impl Fn(&Crossing) -> bool) -> Vec<&Crossing> {
        let all = self.crossings.iter();
        all.filter(|crossing| is(crossing)).collect()
    }
}
