//! What the contacts of a step did: totals, points that have passed what they face, work of obstacles.

use carom_contact::{Rows, Target};

use super::Contacts;
use super::deletion::as_narrowed;
use crate::driver::attempt::Attempt;
use crate::driver::attempt::balance::dot;
use crate::records::Pushed;
use crate::shared::Own;
use crate::small::Largest;
use crate::state::State;

impl Contacts {
    /// Takes the room for nodal forces, N.
    pub(crate) fn take_nodal(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.nodal)
    }

    /// Keeps that room.
    pub(crate) fn keep_nodal(&mut self, nodal: Vec<f64>) {
        self.nodal = nodal;
    }

    /// Force of an obstacle that moves, and the power of its turn, in the step that was taken: of the normal and of the
    /// friction forces f of its points f · ẋ with the velocity ẋ of its particle there, less what the translation has of it.
    /// The rate of the rows is the negative of ẋ along them.
    pub(crate) fn pushed(&self, attempt: &Attempt, contact: usize) -> Pushed {
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

    /// How many points of a contact have passed what they face in the step, are not seen behind it and have no force.
    pub(crate) fn passed(&self, attempt: &Attempt, number: usize) -> u64 {
        let (system, depth) = (&*attempt.system, self.passage.depths[number]);
        // both sides move
        if depth == f64::INFINITY || 2.0 * self.passage.ways[number] <= depth {
            return 0;
        }
        let contact = as_narrowed(&self.narrowed, system, number);
        let (old, new) = (&attempt.state.motion, &attempt.next.motion);
        let ways = [
            system.places(attempt.state.time, &old.u, &old.frames),
            system.places(attempt.state.time + attempt.dt, &new.u, &new.frames),
        ];
        let ways = [&ways[0], &ways[1]];
        let first = system.contacts[number].range.start;
        let forces = [
            &attempt.state.interface.force,
            &attempt.next.interface.force,
        ];
        // those that leave their contact to others are held by these
        let closed = |k: usize| {
            let forces = || forces.iter().any(|force| force[first + k] != 0.0);
            self.telling.has_left((first + k) as u32) || forces()
        };
        let passed = match self.active.own_of(number) {
            Own::All if 2.0 * contact.way(ways) <= depth => 0,
            Own::All => contact.passed(ways, 0..contact.points.len(), closed),
            // those that others share are paired with the ends of steps, which tells the way
            Own::Some(_) if self.passage.ways[number] == f64::INFINITY => 0,
            Own::Some(part) => {
                let points = part.points.iter().map(|&point| point as usize);
                contact.passed(ways, points, closed)
            }
        };
        passed as u64
    }

    /// The record of [`passing`](crate::records::ContactRecord::passing) with the step.
    pub(crate) fn passing(&self, attempt: &Attempt, number: usize) -> Largest {
        let system = &*attempt.system;
        let mut passing = attempt.state.records.contacts[number].passing;
        let contact = &system.contacts[number];
        if !contact.may_be_passed() {
            return passing;
        }
        let (rows, interface) = (&self.pairing.rows, &attempt.next.interface);
        let [old, new] = [&attempt.state.motion.u, &attempt.next.motion.u];
        for point in self.active.within(system.points_of(number)) {
            let end = interface.gap[point];
            let start = end - (rows.product(point, new) - rows.product(point, old));
            let depth = -end.min(start);
            if depth > passing.value {
                let point = &contact.points[point - system.contacts[number].range.start];
                let node = system.mesh_node[point.node() as usize];
                passing.take(depth, node, attempt.state.time + attempt.dt);
            }
        }
        passing
    }

    /// Work of the normal forces of one contact on the motion of the step, J.
    pub(crate) fn contact_work(&self, attempt: &Attempt, contact: usize) -> f64 {
        let rows = &self.pairing.rows;
        let weights = attempt.weights_of_work(contact);
        let (old, new) = (&attempt.state, &attempt.next);
        let of_point = |point: usize| {
            let force = weights.old * old.interface.carried[point]
                + weights.new * new.interface.force[point];
            if force == 0.0 {
                return 0.0;
            }
            let place = |state: &State| {
                let u = rows.product(point, &state.motion.u);
                match weights.lag == 0.0 {
                    true => u,
                    false => u - weights.lag * rows.product(point, &state.motion.v),
                }
            };
            force * (place(new) - place(old) + attempt.dt * rows.rate(point))
        };
        let points = attempt.system.points_of(contact);
        self.active.within(points).map(of_point).sum()
    }
}

/// Sum of a normal force or impulse over points of a contact, and its resultant on the secondary body.
pub(crate) fn total(
    points: impl Iterator<Item = usize>,
    rows: &Rows,
    of_point: impl Fn(usize) -> f64,
) -> (f64, [f64; 3]) {
    let (mut sum, mut resultant) = (0.0, [0.0; 3]);
    for point in points {
        let value = of_point(point);
        if value == 0.0 {
            continue;
        }
        sum += value;
        for (sum, n) in resultant.iter_mut().zip(rows.resultant(point)) {
            *sum += value * n;
        }
    }
    (sum, resultant)
}
