//! The work of obstacles that move.

use carom_contact::Target;

use super::Driver;
use super::owners::{Attempt, Balances, Contacts};
use crate::records::Pushed;

impl Driver {
    /// Work in J of the obstacles in the step: their forces, old and new with these weights by zone, times their way, and the power
    /// of their turn times the step. `pushed`: what [`Driver::pushed`] tells of each.
    pub(super) fn obstacle_work(
        &self,
        weights: &[[f64; 2]],
        pushed: &dyn Fn(usize) -> Pushed,
    ) -> f64 {
        let of = |contact: usize| {
            let weights = weights[self.attempt.system.zone_of(contact)];
            self.attempt
                .work_of_obstacle(contact, weights, pushed(contact))
        };
        let works = (0..self.attempt.system.contacts.len()).filter_map(of);
        self.attempt.contact_factor() * works.sum::<f64>()
    }
}

impl Contacts {
    /// Force of an obstacle that moves, and the power of its turn, in the step that was taken: of the normal and of the
    /// friction forces f of its points f · ẋ with the velocity ẋ of its particle there, less what the translation has of it.
    /// The rate of the rows is the negative of ẋ along them.
    pub(super) fn pushed(&self, attempt: &Attempt, contact: usize) -> Pushed {
        let system = &*attempt.system;
        let Some(way) = attempt.way_of_obstacle(contact) else {
            return Pushed::default();
        };
        let mut pushed = Pushed::default();
        let tangents = &self.pairing.tangents[..system.tangents()];
        for point in self.active.within(system.points_of(contact)) {
            let normal = (&self.pairing.rows, attempt.next.interface.force[point]);
            let friction = attempt.next.interface.friction.get(point);
            let friction = friction.copied().unwrap_or_default();
            let forces = tangents.iter().zip(friction);
            for (rows, f) in std::iter::once(normal).chain(forces) {
                if f == 0.0 {
                    continue;
                }
                pushed.turn -= f * rows.rate(point);
                for (sum, direction) in pushed.force.iter_mut().zip(rows.resultant(point)) {
                    *sum += f * direction;
                }
            }
        }
        pushed.turn = match &system.contacts[contact].target {
            Target::Rigid(obstacle) if obstacle.motion.turn.is_some() => {
                pushed.turn - dot(&pushed.force, &way) / attempt.dt
            }
            _ => 0.0,
        };
        pushed
    }
}

impl Attempt {
    /// How far the translation of an obstacle goes in the step, m; `None` where it does not move.
    pub(super) fn way_of_obstacle(&self, contact: usize) -> Option<[f64; 3]> {
        match &self.system.contacts[contact].target {
            Target::Rigid(obstacle) if obstacle.motion.moves() => {
                let [from, to] = [self.state.time, self.state.time + self.dt];
                let (from, to) = (obstacle.displacement(from), obstacle.displacement(to));
                Some([0, 1, 2].map(|i| to[i] - from[i]))
            }
            Target::Rigid(_) | Target::Surface(_) => None,
        }
    }

    /// That of the obstacle of one contact, without the factor of contact forces; `None` where it does not move.
    pub(super) fn work_of_obstacle(
        &self,
        contact: usize,
        weights: [f64; 2],
        pushed: Pushed,
    ) -> Option<f64> {
        let way = self.way_of_obstacle(contact)?;
        let pushed = [self.state.records.contacts[contact].pushed, pushed];
        let work = |pushed: &Pushed| dot(&pushed.force, &way) + self.dt * pushed.turn;
        Some(weights[0] * work(&pushed[0]) + weights[1] * work(&pushed[1]))
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

impl Balances {
    /// Writes the work of each obstacle in the step, J, of what was reported of the contacts.
    pub(super) fn work_of_obstacles(&mut self, contacts: &Contacts, attempt: &Attempt) {
        let mut works = std::mem::take(&mut self.works.obstacles);
        works.clear();
        for (contact, of) in contacts.sums.iter().enumerate() {
            let impulse = &attempt.maps.all()[attempt.system.zone_of(contact)].contact_impulse;
            let weights = attempt.weights_as_told([impulse.old, impulse.new]);
            let work = attempt.work_of_obstacle(contact, weights, of.pushed);
            works.push(work.map_or(0.0, |work| attempt.contact_factor() * work));
        }
        self.works.obstacles = works;
    }
}
