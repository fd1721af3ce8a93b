//! What limits the rebound of rigid bodies: how much of their restitution makes no energy.

use carom_contact::Law;

use super::closings::is_rigid;
use crate::system::System;

/// What limits the rebound of rigid bodies.
pub(crate) struct Rebound {
    /// Whether a contact is one of rigid bodies, and whether there is one with restitution.
    pub(crate) rigid: Vec<bool>,
    pub(crate) any: bool,
    /// By part: the first part of those that the points of the iteration join, and s.
    pub(crate) first: Vec<usize>,
    pub(crate) factor: Vec<f64>,
    /// By first part: energy made, and the sum of the magnitudes of its terms, J.
    pub(crate) made: Vec<[f64; 2]>,
    /// Energy made without rebound, J; infinite where the rebound is not limited.
    pub(crate) least: Vec<f64>,
    /// The interval of s.
    pub(crate) bounds: Vec<[f64; 2]>,
}

impl Rebound {
    pub(crate) fn of(system: &System) -> Rebound {
        let rebounds = |number: usize| match &system.contacts[number].law {
            Law::Restitution(law) => law.coefficient > 0.0 && is_rigid(system, number),
            _ => false,
        };
        let contacts = 0..system.contacts.len();
        let parts = match contacts.clone().any(rebounds) {
            true => system.parts.len(),
            false => 0,
        };
        Rebound {
            rigid: contacts.map(|number| is_rigid(system, number)).collect(),
            any: parts > 0,
            first: (0..parts).collect(),
            factor: vec![1.0; parts],
            made: vec![[0.0; 2]; parts],
            least: vec![f64::INFINITY; parts],
            bounds: vec![[0.0, 1.0]; parts],
        }
    }

    /// Takes the whole coefficient again.
    pub(crate) fn begin(&mut self) {
        self.factor.fill(1.0);
    }

    /// Whether the bodies that the points join make more energy than `most` of them, beyond this part of the terms.
    pub(crate) fn gains(&self, first: usize, most: f64, rounding: f64) -> bool {
        let [made, size] = self.made[first];
        made > most + rounding * size
    }

    /// Joins two parts.
    pub(crate) fn join(&mut self, one: usize, other: usize) {
        let [one, other] = [self.first[one], self.first[other]];
        let (low, high) = (one.min(other), one.max(other));
        if low < high {
            let highs = self.first.iter_mut().filter(|first| **first == high);
            highs.for_each(|first| *first = low);
        }
    }
}
