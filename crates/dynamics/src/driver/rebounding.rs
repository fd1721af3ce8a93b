//! Restitution that makes no energy.
//!
//! Newton's law, `N v₊ = -e N v` in the points that press, gives the bodies the energy `½ I · (q + q₊)`, with the impulses I and the
//! rates q of normals and tangents before and after. In one point without friction that is `-(1 - e²) (N v)²/(2 D)`. With friction
//! (Kane 1984), or where a point that parts is pressed by the rebound of another one, it may be positive: a square that
//! strikes with a corner can leave faster than it came. Without rebound it never is.
//!
//! Among the rigid bodies that points of an iteration join, the coefficient is therefore e s with the largest s up to 1 that makes no
//! energy, found by halving.

use std::sync::Arc;

use super::Driver;
use super::owners::{Attempt, Contacts};
use super::rebound::Rebound;
use crate::error::Error;

/// Halvings of the interval of s.
const HALVINGS: u32 = 40;

/// Energy made over the sum of the magnitudes of its terms that is rounding.
const ROUNDING: f64 = 1e-12;

impl Driver {
    /// Takes as much of the rebounds of the iteration as makes no energy.
    ///
    /// # Errors
    /// A contact problem without solution.
    pub(super) fn limit_rebound(&mut self) -> Result<(), Error> {
        if !self.contacts.rebound.any
            || self.attempt.maps.is_static()
            || self.attempt.maps.first().rate.c != 0.0
        {
            return Ok(());
        }
        let rounding = ROUNDING.max(self.attempt.system.nonlinear.iteration.tolerance);
        self.contacts.join_parts(&self.attempt);
        self.contacts.weigh_impacts(&self.attempt);
        let parts = 0..self.contacts.rebound.first.len();
        let gains =
            |driver: &Driver, first: usize| driver.contacts.rebound.gains(first, 0.0, rounding);
        if !parts.clone().any(|first| gains(self, first)) {
            return Ok(());
        }
        let Rebound { least, bounds, .. } = &mut self.contacts.rebound;
        least.fill(f64::INFINITY);
        bounds.fill([0.0, 1.0]);
        for first in parts.clone() {
            if gains(self, first) {
                self.contacts.rebound.least[first] = 0.0;
            }
        }
        self.rebound_by(|_| 0.0)?;
        // friction at the velocity of the end may give what is of the order of a step, with or without rebound
        for first in parts.clone() {
            let rebound = &mut self.contacts.rebound;
            rebound.least[first] = rebound.least[first].max(rebound.made[first][0]);
        }
        for _ in 0..HALVINGS {
            self.rebound_by(|[low, high]| 0.5 * (low + high))?;
            for first in parts.clone() {
                let most = self.contacts.rebound.least[first];
                let gains = self.contacts.rebound.gains(first, most, rounding);
                let [low, high] = &mut self.contacts.rebound.bounds[first];
                *(if gains { high } else { low }) = 0.5 * (*low + *high);
            }
        }
        self.rebound_by(|[low, _]| low)
    }

    /// Solves the problem of the iteration with an s of the interval where the rebound is limited, and weighs what it makes.
    fn rebound_by(&mut self, of: impl Fn([f64; 2]) -> f64) -> Result<(), Error> {
        let rebound = &mut self.contacts.rebound;
        for part in 0..rebound.first.len() {
            let first = rebound.first[part];
            rebound.factor[part] = match rebound.least[first].is_finite() {
                true => of(rebound.bounds[first]),
                false => 1.0,
            };
        }
        self.begin_forces()?;
        self.find_forces()?;
        self.contacts.weigh_impacts(&self.attempt);
        Ok(())
    }
}

impl Contacts {
    /// The part s of the coefficient of restitution that a point has.
    pub(super) fn rebound_of(&self, attempt: &Attempt, point: usize) -> f64 {
        if !self.rebound.any {
            return 1.0;
        }
        let first = self.pairing.rows.row(point).0.first();
        first.map_or(1.0, |&unknown| {
            self.rebound.factor[attempt.system.part_of(unknown as usize)]
        })
    }

    /// Finds which parts the candidates join.
    pub(super) fn join_parts(&mut self, attempt: &Attempt) {
        let system = Arc::clone(&attempt.system);
        for (part, first) in self.rebound.first.iter_mut().enumerate() {
            *first = part;
        }
        for &point in &self.candidates {
            let (unknowns, _) = self.pairing.rows.row(point as usize);
            let mut parts = unknowns.iter().map(|&i| system.part_of(i as usize));
            let Some(first) = parts.next() else { continue };
            for part in parts {
                self.rebound.join(first, part);
            }
        }
    }

    /// The energy that the points of rigid bodies give to them in the motion of the iteration.
    pub(super) fn weigh_impacts(&mut self, attempt: &Attempt) {
        let impulse = attempt.maps.contact() * attempt.dt;
        let mut made = std::mem::take(&mut self.rebound.made);
        made.fill([0.0; 2]);
        for &point in &self.candidates {
            let (point, number) = (point as usize, attempt.system.contact_of(point as usize));
            let (unknowns, _) = self.pairing.rows.row(point);
            let (true, Some(&unknown)) = (self.rebound.rigid[number], unknowns.first()) else {
                continue;
            };
            let first = self.rebound.first[attempt.system.part_of(unknown as usize)];
            let mut add = |force: f64, rates: [f64; 2]| {
                let [before, after] = rates.map(|rate| 0.5 * impulse * force * rate);
                made[first][0] += before + after;
                made[first][1] += before.abs() + after.abs();
            };
            let along = self.pairing.rows.product(point, &attempt.vectors.dx);
            let end = self.now(attempt, point, false).1 + attempt.added(point, along)[1];
            let force = attempt.next.interface.force[point];
            add(force, [self.rate_at_start(attempt, point), end]);
            let friction = attempt.next.interface.friction.get(point);
            for (k, &t) in friction.into_iter().flatten().enumerate() {
                if t != 0.0 {
                    add(t, self.sliding_rates(attempt, point, k));
                }
            }
        }
        self.rebound.made = made;
    }

    /// Rates along a tangent at the start of the step and at its end, m/s; twice their mean half each where the way is what counts.
    pub(super) fn sliding_rates(
        &self,
        attempt: &Attempt,
        point: usize,
        tangent: usize,
    ) -> [f64; 2] {
        let (row, time) = self.sliding(attempt);
        let rows = &self.pairing.tangents[tangent];
        let map = attempt.map_of(attempt.system.contact_of(point));
        let slid = self.slid(attempt, point, tangent, (row, time))
            + row(map).x * rows.product(point, &attempt.vectors.dx);
        match self.by_rate {
            true => {
                let start = rows.product(point, &attempt.state.motion.v) + rows.rate(point);
                [start, slid]
            }
            false => [slid / time; 2],
        }
    }
}
