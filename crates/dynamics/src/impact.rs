//! Impacts: what the steps between the first closing of a contact and its last release come to.

use serde::{Deserialize, Serialize};

use crate::sum::Sum;
use crate::system::System;

/// Part of the impulse of an impact that other forces may have while it counts as an impact of its two bodies alone.
const OTHERS: f64 = 0.01;

/// Flight over the impact before it that ends the impact whatever waves do.
const LONG: f64 = 10.0;

/// Steps that a flight takes at least that ends an impact by itself: shorter ones are the chatter of the steps.
const RESOLVED: f64 = 4.0;

/// Magnitude of the sum of the normal impulses of the steps over the sum of their magnitudes, below which the contact has slid over a
/// surface that turns: 0.99 is a force that swings by 8 degrees in the mean square.
const STEADY: f64 = 0.99;

/// Relative difference of two forces up to which the later one is not the larger one: rounding must not choose the instant of the peak.
pub(crate) const TIE: f64 = 1e-12;

/// Part of the largest force so far up to which a force is none: whether what rounding leaves is a force or not must not decide how long a contact was closed.
const NOTHING: f64 = 1e-9;

/// Why the restitution of an impact means nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum NoRestitution {
    /// The contact is closed.
    Unfinished,
    /// The bodies did not approach.
    NoApproach,
    /// The bodies approach still, in the mean of their masses.
    NoParting,
    /// Supports, loads, joints or further contacts gave more than 1 % of the impulse.
    OtherForces,
    /// The direction of the force turned, as where bodies slide over each other.
    TurnedForce,
    /// The obstacle moves.
    MovingObstacle,
    /// A side has several bodies.
    ManyBodies,
}

/// One impact: from the first closing of a contact to the last release before a flight that lasts.
///
/// A flight lasts if it is longer than a wave takes across the longer of the two bodies: a contact that closes again earlier does
/// so by the waves of that impact, or by the chatter of a scheme, and it is the same impact. It lasts too if it is ten times as
/// long as the impact so far, for a body that stands for a mass on a spring, in which waves do not matter. A flight of less than
/// four steps never lasts. A contact with a time of its own ([`ContactPair::merge_within`](carom_system::ContactPair::merge_within)) has that in place of all this.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Impact {
    /// Index of the contact.
    pub contact: u32,
    /// Start of its first step, s.
    pub start: f64,
    /// From there to the last release, s.
    pub duration: f64,
    /// Intervals of steps with a force: more than one where the contact opens and closes within the impact.
    pub intervals: u64,
    /// Largest total force, N.
    pub peak_force: f64,
    /// End of the step of the largest force, s.
    pub peak_time: f64,
    /// Steps of the interval with a force in which the largest one is: the force of a few steps is not resolved.
    pub peak_steps: u64,
    /// Impulse on the secondary body, N s.
    pub impulse: f64,
    /// The part of it, along it, that is in no force of a step, N s: of a projection or another stage after a step.
    pub impulsive: f64,
    /// Speed at which the two bodies (one, on an obstacle) approached along the mean normal, m/s: of the mean velocities of the
    /// masses that no support holds.
    pub approach: f64,
    /// Speed at which they part, m/s; negative if they still approach.
    pub rebound: f64,
    /// Rebound over approach, from the momenta of the bodies before and after the impact. `None` where it means nothing: the
    /// bodies did not approach, or do not part; other forces (of supports, loads, joints, further contacts) gave more than
    /// 1 % of the impulse; the force turned, as where bodies slide over each other; the obstacle moves. A body that is held
    /// and at rest stands for the ground: the speeds are then those of the other one.
    pub restitution: Option<f64>,
    /// Why there is no restitution; `None` where there is one.
    pub no_restitution: Option<NoRestitution>,
    /// Kinetic energy of the approach, ½ m w² with the reduced mass m of what no support holds of the two bodies, J; zero if they
    /// did not approach.
    pub energy_given: f64,
    /// Most energy that the contact has taken up at one time, J: the largest value of minus the work of its forces so far. A stop
    /// stores it, or loses a part of it; an exact law takes what it loses.
    pub energy_taken: f64,
    /// Energy lost in the contact, J: minus the work of its forces.
    pub energy_lost: f64,
    /// The part of it that is lost in crush, J; zero of laws without memory.
    pub energy_crushed: f64,
    /// Energy that friction takes beside it, J: its work on what slides, which wears it off.
    pub friction_loss: f64,
    /// Whether the run ended before the impact did.
    pub unfinished: bool,
}

/// What a step gives to an impact.
pub(crate) struct Given {
    /// Time at its start and end, s.
    pub(crate) span: [f64; 2],
    /// Whether the contact has a force in it.
    pub(crate) active: bool,
    /// Total force, N.
    pub(crate) force: f64,
    /// Impulse on the secondary body, N s.
    pub(crate) impulse: [f64; 3],
    /// The part of it that is in no force, N s.
    pub(crate) impulsive: [f64; 3],
    /// That of the normal forces, as far as its direction goes, N s.
    pub(crate) normal: [f64; 3],
    /// Work of the contact, J.
    pub(crate) work: f64,
    /// Energy lost in crush, J.
    pub(crate) crushed: f64,
    /// Energy lost in friction, J.
    pub(crate) rubbed: f64,
}

/// An impact that has begun, and whose flight after it, if there is one, does not last yet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct OpenImpact {
    start: f64,
    intervals: u64,
    peak_force: f64,
    peak_time: f64,
    /// Steps of the interval that goes on, whether the largest force is in it, and steps of the interval of that force.
    steps: u64,
    holds_peak: bool,
    peak_steps: u64,
    impulse: [Sum; 3],
    impulsive: [Sum; 3],
    /// Sums of the normal impulses of the steps and of their magnitudes, N s.
    normal: [Sum; 3],
    pushed: Sum,
    work: Sum,
    /// Largest value of minus the work so far, J.
    taken: f64,
    crushed: Sum,
    rubbed: Sum,
    /// Mean velocities of the two sides before it, m/s.
    before: [[f64; 3]; 2],
    released: Option<Released>,
}

/// The last release of an impact.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Released {
    /// The impact, if the flight lasts.
    impact: Impact,
    /// Until when it must last, s.
    until: f64,
}

impl OpenImpact {
    /// Adds a step to the impact of a contact that goes on or begins; the impact, once a flight has lasted. `velocities`: at
    /// the start and the end of the step, m/s.
    pub(crate) fn follow(
        open: &mut Option<OpenImpact>,
        (system, contact): (&System, usize),
        given: &Given,
        velocities: [&[f64]; 2],
    ) -> Option<Impact> {
        if given.active {
            open.get_or_insert_with(|| OpenImpact {
                start: given.span[0],
                before: Sides::of(system, contact).velocities(velocities[0]),
                ..OpenImpact::default()
            });
        }
        let going = open.as_mut()?;
        going.add(system, given);
        match (&going.released, given.active) {
            (None, true) if going.intervals == 0 => going.intervals = 1,
            (None, true) => {}
            (Some(_), true) => {
                going.intervals += 1;
                going.released = None;
            }
            (None, false) => {
                going.released = Some(Released {
                    impact: going.impact(system, contact, given.span[1], velocities[1]),
                    until: given.span[1] + lasting(system, contact, (given, going.start)),
                });
            }
            (Some(released), false) if given.span[1] >= released.until => {
                return open.take()?.released.map(|released| released.impact);
            }
            (Some(_), false) => {}
        }
        None
    }

    /// The impact as it was at its last release; `None` while the contact is closed.
    pub(crate) fn released(&self) -> Option<&Impact> {
        self.released.as_ref().map(|released| &released.impact)
    }

    fn add(&mut self, system: &System, given: &Given) {
        let (mut impulse, mut normal) = (given.impulse, given.normal);
        if system.axisymmetric {
            // radial forces of a full turn cancel
            (impulse[0], normal[0]) = (0.0, 0.0);
        }
        let presses = given.active && given.force > NOTHING * self.peak_force;
        self.steps = if presses { self.steps + 1 } else { 0 };
        self.holds_peak &= presses;
        if given.force > self.peak_force * (1.0 + TIE) {
            (self.peak_force, self.peak_time) = (given.force, given.span[1]);
            self.holds_peak = true;
        }
        if self.holds_peak {
            self.peak_steps = self.steps;
        }
        self.work.add(given.work);
        self.taken = self.taken.max(-self.work.get());
        self.crushed.add(given.crushed);
        self.rubbed.add(given.rubbed);
        self.pushed.add(norm(normal));
        for i in 0..3 {
            self.impulse[i].add(impulse[i]);
            self.impulsive[i].add(given.impulsive[i]);
            self.normal[i].add(normal[i]);
        }
    }

    /// The impact up to the time `end` (s), with these velocities (m/s) then.
    pub(crate) fn impact(&self, system: &System, contact: usize, end: f64, v: &[f64]) -> Impact {
        let [impulse, normal] = [&self.impulse, &self.normal].map(|sums| sums.map(|s| s.get()));
        let sides = Sides::of(system, contact);
        let direction = sides.direction(normal);
        let along = Along {
            masses: sides.masses(direction),
            held: sides.held(direction),
            before: self.before.map(|w| dot(w, direction)),
            after: sides.velocities(v).map(|w| dot(w, direction)),
            impulse: dot(impulse, direction),
        };
        let approach = along.before[1] - along.before[0];
        let inverse: f64 = along.masses.iter().map(|m| 1.0 / m).sum();
        let restitution = match norm(normal) >= STEADY * self.pushed.get() {
            _ if system.is_of_many(contact) => Err(NoRestitution::ManyBodies),
            _ if system.contacts[contact].moves() => Err(NoRestitution::MovingObstacle),
            false => Err(NoRestitution::TurnedForce),
            true => along.restitution(),
        };
        Impact {
            contact: contact as u32,
            start: self.start,
            duration: end - self.start,
            intervals: self.intervals,
            peak_force: self.peak_force,
            peak_time: self.peak_time,
            peak_steps: self.peak_steps,
            impulse: norm(impulse),
            impulsive: match norm(impulse) > 0.0 {
                true => dot(
                    self.impulsive.each_ref().map(Sum::get),
                    impulse.map(|part| part / norm(impulse)),
                ),
                false => 0.0,
            },
            approach,
            rebound: along.after[0] - along.after[1],
            restitution: restitution.ok(),
            no_restitution: restitution.err(),
            energy_given: match inverse > 0.0 {
                true => 0.5 * approach.max(0.0).powi(2) / inverse,
                false => 0.0,
            },
            energy_taken: self.taken,
            energy_lost: -self.work.get(),
            energy_crushed: self.crushed.get(),
            friction_loss: self.rubbed.get(),
            unfinished: false,
        }
    }
}

/// Motions of the two sides of a contact along its mean normal, towards the secondary side.
struct Along {
    /// Free masses, kg; infinite of the ground.
    masses: [f64; 2],
    /// Whether supports hold a part of a side.
    held: [bool; 2],
    /// Velocities before and after, m/s.
    before: [f64; 2],
    after: [f64; 2],
    /// The impulse on the secondary side, N s.
    impulse: f64,
}

impl Along {
    fn restitution(&self) -> Result<f64, NoRestitution> {
        let ground = |side: usize| self.masses[side] == f64::INFINITY;
        let sides = match [self.alone(0), self.alone(1)] {
            [true, true] => [1.0, 1.0],
            [true, false] if ground(1) || self.stands(1) => [1.0, 0.0],
            [false, true] if self.stands(0) => [0.0, 1.0],
            _ => return Err(NoRestitution::OtherForces),
        };
        let opening = |v: [f64; 2]| sides[0] * v[0] - sides[1] * v[1];
        let (approach, rebound) = (-opening(self.before), opening(self.after));
        match (approach > 0.0, rebound >= 0.0) {
            (false, _) => Err(NoRestitution::NoApproach),
            (true, false) => Err(NoRestitution::NoParting),
            (true, true) => Ok(rebound / approach),
        }
    }

    /// Whether the contact alone has changed the momentum of a side.
    fn alone(&self, side: usize) -> bool {
        let gained = [1.0, -1.0][side] * self.masses[side] * (self.after[side] - self.before[side]);
        !self.held[side] && (gained - self.impulse).abs() <= OTHERS * self.impulse
    }

    /// Whether a side is held, and was at rest beside the other one.
    fn stands(&self, side: usize) -> bool {
        self.held[side] && self.before[side].abs() <= OTHERS * self.before[1 - side].abs()
    }
}

/// The masses of the two sides of a contact by direction, whole and without what supports hold, kg.
///
/// A side is its body with all that share nodes with it, directly or through others: they move as one. Two sides that are so
/// joined have one body each.
struct Sides<'a> {
    system: &'a System,
    sides: [Side; 2],
    whole: [f64; 2],
    free: [[f64; 3]; 2],
}

/// The bodies of a side.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Nobody,
    Body(usize),
    /// All of a part of the system.
    Part(usize),
}

impl Side {
    fn bodies(self, system: &System) -> impl Iterator<Item = usize> + '_ {
        let all = system.part_of_body.iter().enumerate();
        let own = all.filter(move |&(body, &part)| match self {
            Side::Nobody => false,
            Side::Body(own) => body == own,
            Side::Part(own) => part == own,
        });
        own.map(|(body, _)| body)
    }
}

impl Sides<'_> {
    fn of(system: &System, contact: usize) -> Sides<'_> {
        let pair = &system.contacts[contact];
        let (secondary, primary) = (pair.secondary_body, pair.primary_body);
        let part = |body: usize| system.part_of_body[body];
        let sides = match (primary, system.is_of_many(contact)) {
            // no mass and no motion stands for all of them
            (_, true) => [Side::Nobody; 2],
            (None, false) => [Side::Part(part(secondary)), Side::Nobody],
            (Some(primary), false) if part(primary) == part(secondary) => {
                [secondary, primary].map(Side::Body)
            }
            (Some(primary), false) => [secondary, primary].map(|body| Side::Part(part(body))),
        };
        let mut free = [[0.0; 3]; 2];
        for (side, free) in sides.iter().zip(&mut free) {
            for body in side.bodies(system) {
                match system.bodies[body].as_reduced() {
                    Some(_) if system.bodies[body].balances_itself() => {
                        free.iter_mut().for_each(|m| *m += system.body_mass(body));
                    }
                    Some(_) => {}
                    None => each_free(system, body, |_, i, m| free[i] += m),
                }
            }
        }
        let whole = sides.map(|side| match side {
            Side::Nobody => f64::INFINITY,
            side => side.bodies(system).map(|body| system.body_mass(body)).sum(),
        });
        Sides {
            system,
            sides,
            whole,
            free,
        }
    }

    /// Mean velocities Σ m v / Σ m over what no support holds, m/s.
    fn velocities(&self, v: &[f64]) -> [[f64; 3]; 2] {
        let mut means = [[0.0; 3]; 2];
        for (side, mean) in means.iter_mut().enumerate() {
            for body in self.sides[side].bodies(self.system) {
                each_free(self.system, body, |unknown, i, m| {
                    mean[i] += m / self.free[side][i] * v[unknown];
                });
            }
        }
        means
    }

    /// Masses against a force in a direction, 1 / Σ n_i²/m_i, kg; infinite where nothing is free.
    fn masses(&self, direction: [f64; 3]) -> [f64; 2] {
        [0, 1].map(|side| {
            let moved = (0..3).filter(|&i| direction[i] != 0.0 && self.free[side][i] > 0.0);
            let inverse: f64 = moved
                .map(|i| direction[i].powi(2) / self.free[side][i])
                .sum();
            match inverse > 0.0 {
                true => 1.0 / inverse,
                false => f64::INFINITY,
            }
        })
    }

    /// The unit vector along the sum of the normal impulses; zero without any. What supports hold in a component, as a plane
    /// of symmetry does, has no part in it, unless little else is left.
    fn direction(&self, normal: [f64; 3]) -> [f64; 3] {
        let size = norm(normal);
        if size == 0.0 {
            return [0.0; 3];
        }
        let normal = normal.map(|n| n / size);
        let mut free = normal;
        for (i, n) in free.iter_mut().enumerate() {
            let mut axis = [0.0; 3];
            axis[i] = 1.0;
            if self.held(axis).contains(&true) {
                *n = 0.0;
            }
        }
        let chosen = if dot(free, free) >= 0.5 { free } else { normal };
        chosen.map(|n| n / norm(chosen))
    }

    /// Whether supports hold a part of a side in a direction.
    fn held(&self, direction: [f64; 3]) -> [bool; 2] {
        // a direction is one to the rounding of the sums of forces
        let acts = |i: usize| direction[i].abs() > 1e-6;
        [0, 1].map(|side| {
            let whole = self.whole[side];
            let less = |i: usize| self.free[side][i] < whole * (1.0 - 1e-12);
            self.sides[side] != Side::Nobody && (0..self.system.dim).any(|i| acts(i) && less(i))
        })
    }
}

/// Visits the unknowns of a body that no support holds, with their direction and mass.
fn each_free(system: &System, body: usize, mut visit: impl FnMut(usize, usize, f64)) {
    if let Some(reduced) = system.bodies[body].as_reduced() {
        let axes = if reduced.reduction().is_grounded {
            0
        } else {
            system.dim
        };
        for axis in 0..axes {
            reduced
                .inertia(axis)
                .for_each(|(unknown, m)| visit(unknown, axis, m));
        }
        return;
    }
    for &(node, m) in &system.body_masses[body] {
        for (i, unknown) in system.unknowns.translations_of(node).enumerate() {
            if !system.fixed[unknown] {
                visit(unknown, i, m);
            }
        }
    }
}

/// How long a flight lasts that ends an impact, begun at `start` (s) and last closed before this step, s.
fn lasting(system: &System, contact: usize, (given, start): (&Given, f64)) -> f64 {
    if let Some(time) = system.contacts[contact].merge_within {
        return time;
    }
    let [from, to] = given.span;
    let waves = crossing(system, contact).min(LONG * (to - start));
    waves.max(RESOLVED * (to - from))
}

/// Time that a wave takes across the longer of the two bodies of a contact (the diagonal of its box), s.
fn crossing(system: &System, contact: usize) -> f64 {
    let bodies = system.contacts[contact].bodies.iter();
    let across = bodies.filter_map(|&body| {
        let waves = system.bodies[body].wave_speed()?;
        Some(system.diagonals[body] / waves)
    });
    across.fold(0.0, f64::max)
}

/// |a|, of numbers whose squares are beyond what there is as well.
fn norm(a: [f64; 3]) -> f64 {
    a[0].hypot(a[1]).hypot(a[2])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

#[cfg(test)]
mod tests {
    #[test]
    fn impulses_whose_squares_overflow_have_a_size() {
        let size = super::norm([3e200, 0.0, -4e200]);
        assert!((size / 5e200 - 1.0).abs() < 1e-15, "{size}");
    }
}
