//! What an attempt knows of its contact points: laws, names, times.

use std::ops::Range;
use std::sync::Arc;

use carom_algebra::reduce::norm_squared;
use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::Vec3;
use carom_algebra::unknowns::Kind;
use carom_contact::law::Level;

use super::Attempt;
use crate::driver::paired::{instant, looks_ahead};
use crate::driver::parts::floating::body_of;
use crate::driver::parts::pieces::Pieces;
use crate::driver::parts::rigid::Rigid;
use crate::error::Error;
use crate::step_map::{Row, StepMap};

impl Attempt {
    pub(crate) fn unheld(&self, rigid: &Rigid, c: &[f64]) -> Error {
        let (piece, motion) = rigid.name(c);
        Error::Unheld {
            step: self.state.step + 1,
            time: self.state.time + self.dt,
            body: body_of(&self.system, piece),
            motion: motion.to_string(),
        }
    }

    /// Displacement of the nodes at the x of the iteration, m.
    pub(crate) fn places(&self) -> Vec<f64> {
        let mut places = vec![0.0; self.vectors.x.len()];
        let (motion, x) = (&self.state.motion, &self.vectors.x);
        self.maps.whole(
            |map| map.displacement,
            motion,
            [x, &self.vectors.push],
            &mut places,
        );
        places
    }

    /// Points that carry a force.
    pub(crate) fn carrying(&self) -> impl Iterator<Item = usize> + '_ {
        let forces = self.next.interface.force.iter().enumerate();
        forces
            .filter(|(_, force)| **force != 0.0)
            .map(|(point, _)| point)
    }

    /// Gap and rate that the law of a contact constrains, in the map of its secondary side, and their factors of x over those of
    /// the map.
    pub(crate) fn constrained(&self, number: usize) -> ([Row; 2], [f64; 2]) {
        let law = self.law(&self.system.contacts[number]);
        instant(self.map_of(number), law)
    }

    /// What a motion of the unknown along the row of a point adds to the gap and the rate that its law constrains.
    pub(crate) fn added(&self, point: usize, step: f64) -> [f64; 2] {
        let [gap, rate] = self.constrained(self.system.contact_of(point)).0;
        [gap.x * step, rate.x * step]
    }

    /// Time over which the points move with the rate that a law constrains, s.
    pub(crate) fn moves(&self, point: usize) -> f64 {
        match self.map_of(self.system.contact_of(point)).moves {
            0.0 => self.dt,
            moves => moves,
        }
    }

    /// Gap of a contact that counts as none where a step ends, m.
    pub(crate) fn gap_tolerance(&self, contact: usize) -> f64 {
        100.0 * self.system.contacts[contact].tolerance
    }

    /// Whether a contact is paired where the step is predicted to lead.
    pub(crate) fn looks_ahead(&self, contact: usize) -> bool {
        let map = self.map_of(contact);
        let contact = &self.system.contacts[contact];
        !self.between() && looks_ahead(map, contact, self.law(contact))
    }

    /// Factors of x in gap and rate that the law of a contact constrains, over those of the problem: of the first map.
    pub(crate) fn factors(&self, contact: usize) -> [f64; 2] {
        let (map, [gap, rate]) = (self.map_of(contact), self.constrained(contact).1);
        if self.maps.only().is_some() {
            return [gap, rate];
        }
        let first = self.maps.first();
        let over = |own: f64, first: f64| if first == 0.0 { 1.0 } else { own / first };
        [
            gap * over(map.gap.x, first.gap.x),
            rate * over(map.rate.x, first.rate.x),
        ]
    }

    /// A stiffness of the size of what the model has where it has none that is known, N/m: the loads would move it by a thousandth of itself.
    pub(crate) fn stiffness_by_load(&self) -> f64 {
        let (load, size) = (
            norm_squared(&self.vectors.load).sqrt(),
            self.system.mesh.size(),
        );
        match load > 0.0 && size > 0.0 {
            true => load / (DEFLECTION * size),
            false => 1.0,
        }
    }

    /// Begins with the motion of no acceleration, or with the one before it; motions that are prescribed come as a jump in
    /// the first iteration, so that the inside of the body goes along.
    pub(crate) fn predict(&mut self) {
        let system = Arc::clone(&self.system);
        let motion = &self.state.motion;
        let vectors = &mut self.vectors;
        if self.maps.is_static() {
            vectors.x.fill(0.0);
        } else {
            self.maps.known(|map| map.inertia, motion, &mut vectors.x);
            for (span, map) in self.maps.spans() {
                for x in &mut vectors.x[span] {
                    *x *= -1.0 / map.inertia.x;
                }
            }
        }
        vectors.jump.fill(0.0);
        vectors.jumps = false;
        if self.maps.all().iter().all(|map| map.displacement.x == 0.0) {
            return;
        }
        let place = &mut vectors.place;
        self.maps.known(|map| map.displacement, motion, place);
        vectors.work.fill(0.0);
        let time = [self.state.time, self.state.time + self.dt];
        system.nonlinear.prescribe(time, &mut vectors.work);
        let maps = &self.maps;
        let held = |(span, map): (Range<usize>, &StepMap)| {
            let x = map.displacement.x;
            let fixed = &system.fixed;
            let held = span.filter(move |&i| x != 0.0 && fixed[i]);
            held.map(move |i| (i, x))
        };
        for (i, x) in maps.spans().flat_map(held) {
            vectors.x[i] = (motion.u[i] - vectors.place[i]) / x;
            vectors.jump[i] = (vectors.work[i] - motion.u[i]) / x;
            vectors.jumps |= vectors.jump[i] != 0.0;
        }
    }

    /// Leaves this part of the jump of the supports to the iterations to come.
    pub(crate) fn shorten_jump(&mut self, rest: f64) {
        let vectors = &mut self.vectors;
        for jump in &mut vectors.jump {
            *jump *= rest;
        }
        vectors.jumps = vectors.jump.iter().any(|jump| *jump != 0.0);
    }

    /// Begins with the rigid motion of each part that is nearest to its velocity. The motion of no acceleration may turn elements
    /// inside out where velocities alternate from step to step, as a trapezoidal rule leaves them in stiff modes: the
    /// displacements of these modes stay what they are.
    pub(crate) fn predict_rigidly(&mut self) {
        let system = Arc::clone(&self.system);
        let motion = &self.state.motion;
        // explicit zones have their place already
        let factor = |i: usize| self.maps.of(i).displacement.x;
        let parts = Pieces::of_parts(&system);
        let rigid = Rigid::new(&system, &parts, (&motion.u, None));
        let mut c = rigid.nearest(&motion.v);
        c.iter_mut().for_each(|c| *c *= self.dt);
        let vectors = &mut self.vectors;
        let place = &mut vectors.place;
        self.maps.known(|map| map.displacement, motion, place);
        let moved = |i: usize| !system.fixed[i] && factor(i) != 0.0;
        for i in (0..motion.u.len()).filter(|&i| moved(i)) {
            vectors.x[i] = (motion.u[i] - vectors.place[i]) / factor(i);
        }
        for (i, u) in rigid.motion(&c).chain(rigid.arc(&c)) {
            if moved(i) {
                vectors.x[i] += u / factor(i);
            }
        }
        for (node, angle) in rigid.turns(&c).filter(|(node, _)| system.bends_at(*node)) {
            let frame = system.unknowns.frame(node);
            let start = frame.map_or(Rotation::IDENTITY, |frame| motion.frames[frame]);
            let turn = start.matrix().tr_mul(&Vec3::from(angle));
            for i in system.unknowns.rotations_of(node).filter(|&i| moved(i)) {
                if let Kind::Rotation(axis) = system.unknowns.kind(i) {
                    vectors.x[i] += turn[axis] / factor(i);
                }
            }
        }
    }

    /// Whether sliding is a velocity at the end of the step, or the way in it. In explicit steps no force changes the way, and
    /// a point could not stick by it.
    pub(crate) fn slides_by_rate(&self) -> bool {
        let system = &*self.system;
        let of_rate = |k: usize| system.contacts[k].law.get().level() == Level::Rate;
        let mut rubbing =
            (0..system.contacts.len()).filter(|&k| system.contacts[k].friction.acts());
        let way_is_known = self.maps.all().iter().all(|map| map.displacement.x == 0.0);
        !self.maps.is_static() && (way_is_known || rubbing.all(of_rate))
    }
}

/// Motion over the size of the model by which loads say what stiffness a model has.
const DEFLECTION: f64 = 1e-3;
