//! How much of the restitution of rigid bodies makes no energy.

use std::sync::Arc;

use super::Contacts;
use super::rebound::Rebound;
use crate::driver::attempt::Attempt;

impl Contacts {
    /// What limits the rebound of rigid bodies.
    pub(crate) fn rebound(&self) -> &Rebound {
        &self.rebound
    }

    /// The same, to find the limits of an iteration.
    pub(crate) fn rebound_mut(&mut self) -> &mut Rebound {
        &mut self.rebound
    }

    /// The part s of the coefficient of restitution that a point has.
    pub(super) fn rebound_of(&self, attempt: &Attempt, point: usize) -> f64 {
        if !self.rebound.is_any() {
            return 1.0;
        }
        let first = self.pairing.rows.row(point).0.first();
        first.map_or(1.0, |&unknown| {
            self.rebound.factor[attempt.system.part_of(unknown as usize)]
        })
    }

    /// Finds which parts the candidates join.
    pub(crate) fn join_parts(&mut self, attempt: &Attempt) {
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
    pub(crate) fn weigh_impacts(&mut self, attempt: &Attempt) {
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
    fn sliding_rates(&self, attempt: &Attempt, point: usize, tangent: usize) -> [f64; 2] {
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
