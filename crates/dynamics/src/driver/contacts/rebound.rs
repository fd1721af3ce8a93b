//! What limits the rebound of rigid bodies: how much of their restitution makes no energy.

use carom_contact::Law;

use super::closings::is_rigid;
use crate::system::System;

/// What limits the rebound of rigid bodies.
pub(crate) struct Rebound {
    /// Whether a contact is one of rigid bodies, and whether there is one with restitution.
    pub(crate) rigid: Vec<bool>,
    any: bool,
    /// By part: the first part of those that the points of the iteration join, and s.
    pub(crate) first: Vec<usize>,
    pub(crate) factor: Vec<f64>,
    /// By first part: energy made, and the sum of the magnitudes of its terms, J.
    pub(crate) made: Vec<[f64; 2]>,
    /// Energy made without rebound, J; infinite where the rebound is not limited.
    least: Vec<f64>,
    /// The interval of s.
    bounds: Vec<[f64; 2]>,
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

    /// Whether the restitution of a contact may make energy.
    pub(crate) fn is_any(&self) -> bool {
        self.any
    }

    /// Begins the search for s where a rebound makes energy; whether it does anywhere.
    pub(crate) fn begin_limits(&mut self, rounding: f64) -> bool {
        let mut any = false;
        for first in 0..self.first.len() {
            let gains = self.gains(first, 0.0, rounding);
            any |= gains;
            self.least[first] = if gains { 0.0 } else { f64::INFINITY };
        }
        self.bounds.fill([0.0, 1.0]);
        any
    }

    /// Takes what is made without rebound for the least.
    pub(crate) fn take_least(&mut self) {
        for (least, made) in self.least.iter_mut().zip(&self.made) {
            *least = least.max(made[0]);
        }
    }

    /// Halves each interval: the lower half where its middle makes energy.
    pub(crate) fn halve(&mut self, rounding: f64) {
        for first in 0..self.first.len() {
            let gains = self.gains(first, self.least[first], rounding);
            let [low, high] = &mut self.bounds[first];
            *(if gains { high } else { low }) = 0.5 * (*low + *high);
        }
    }

    /// Takes an s of the interval where the rebound is limited.
    pub(crate) fn take(&mut self, of: impl Fn([f64; 2]) -> f64) {
        for part in 0..self.first.len() {
            let first = self.first[part];
            self.factor[part] = match self.least[first].is_finite() {
                true => of(self.bounds[first]),
                false => 1.0,
            };
        }
    }

    /// Takes the whole coefficient again.
    pub(crate) fn begin(&mut self) {
        self.factor.fill(1.0);
    }

    /// Whether the bodies that the points join make more energy than `most` of them, beyond this part of the terms.
    fn gains(&self, first: usize, most: f64, rounding: f64) -> bool {
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
