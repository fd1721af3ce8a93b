//! Newton's iterations of one attempt at a step.

use std::sync::Arc;
use std::time::Instant;

use carom_algebra::unknowns::Kind;
use carom_bodies::Body;
use carom_contact::Search;
use carom_mesh::ElementId;

use super::effective::{At, Turning};
use super::floating::{GROWTH as HEAVIER, LARGEST};
use super::loads::damping_rate;
use super::{Newton, Which};
use crate::error::Error;
use crate::step_map::StepMap;

/// Residual before and after an iteration beyond which the motion of the iteration is halved.
const GROWTH: f64 = 4.0;

/// Halvings of the motion of one iteration.
const SHORTENINGS: u32 = 5;

/// Imbalance over that one iteration ago up to which the iteration was a gain.
const GAIN: f64 = 0.5;

/// Iterations that a fresh factor is counted to need.
const FRESH: f64 = 2.0;

/// Cost of a new tangent beside its factorisation, in iterations with the old one.
const TANGENT: f64 = 3.0;

/// Largest number of iterations of a step in which parts move on along motions that nothing holds, over that of others.
const MOVES: usize = 10;

/// Imbalance over what may be rounding from which on iterations are mixed: below, their changes are noise.
const NOISY: f64 = 10.0;

/// How fast the iterations go.
#[derive(Default)]
pub(super) struct Pace {
    /// Iterations of this attempt with the factor at hand.
    pub(super) age: usize,
    /// The iteration in which it was made.
    pub(super) made: usize,
    /// Contraction with a factor made within the iterations of a step, between two states; zero while unknown.
    pub(super) fresh: f64,
}

/// Where an iteration stands.
struct Standing {
    /// Imbalance of the forces, relative.
    imbalance: f64,
    /// Largest defect of a contact law, in tolerances.
    defect: f64,
    /// What of the imbalance may be rounding, relative.
    rounding: f64,
    /// Largest of the forces that balance, N.
    scale: f64,
}

impl Newton {
    /// The map of the step of this size from the present state.
    pub(crate) fn size(&mut self, dt: f64) {
        self.dt = dt;
        self.map = match self.is_static() {
            true => StepMap::equilibrium(),
            false => self.system.scheme.get().step_map(dt),
        };
    }

    /// Finds x and the contact forces of the step.
    ///
    /// # Errors
    /// No equilibrium, an element or a matrix that fails.
    pub(super) fn solve(&mut self) -> Result<(), Error> {
        let solved = self.iterate(false);
        match solved {
            // elements inside out: once more from another guess
            Err(Error::Body(_)) if self.map.inertia.x != 0.0 => self.iterate(true),
            other => other,
        }
    }

    /// The iterations from the motion of no acceleration, or from the rigid one.
    fn iterate(&mut self, rigidly: bool) -> Result<(), Error> {
        let passes = self.system.nonlinear.iteration.passes;
        let (mut limit, most) = (passes, MOVES * passes);
        self.residuals.clear();
        (self.pace.age, self.pace.fresh) = (0, self.state.control.pace);
        self.floating.begin();
        self.mixing.clear();
        self.predict();
        if rigidly {
            self.predict_rigidly();
        }
        let interface = &mut self.next.interface;
        interface.clone_from(&self.state.interface);
        self.guess_slips();
        self.take_weak();
        self.evaluate(true)?;
        self.vectors.ahead.clear();
        self.search.iter_mut().for_each(Search::begin_step);
        self.pair(true);
        if self.system.contacts.iter().any(|c| self.looks_ahead(c)) {
            self.look_ahead()?;
            self.pair(true);
        }
        let mut standing = self.standing();
        let mut pass = 0;
        while pass < limit {
            let jumps = self.vectors.jump.iter().any(|jump| *jump != 0.0);
            let before = self.residuals.last().copied();
            self.residuals.push(standing.imbalance);
            if pass > 0 && !jumps && self.is_solved(&standing, before) {
                return self.check_held(pass);
            }
            if self.floats() && !jumps && self.approach(standing.scale)? {
                self.mixing.clear();
                standing = self.standing();
            }
            if self.wants_factor(pass) {
                self.renew()?;
                (self.pace.age, self.pace.made) = (0, pass);
            }
            self.pace.age += 1;
            self.keep_forces();
            self.motion_of_iteration()?;
            // a motion that contacts hardly hold is far above the noise of the forces
            if !jumps && (self.floats() || standing.imbalance > NOISY * standing.rounding) {
                self.mix();
            }
            if self.floats() && !jumps && self.restrain() {
                // the part has moved on: iterations begin anew
                limit = most.min(pass + passes);
            }
            standing = self.go(&standing, jumps)?;
            if self.is_affine() {
                return Ok(());
            }
            pass += 1;
        }
        let before = self.residuals.last().copied();
        if self.is_solved(&standing, before) {
            return self.check_held(limit);
        }
        Err(self.unbalanced(limit, standing.imbalance * standing.scale))
    }

    /// Whether iterations may end. `before`: the imbalance one iteration ago. Within what rounding leaves they end where they
    /// gain no more, not where they get there: what is left would be of one sign step after step, and add up. Not so under the
    /// forces of links, whose passes need answers that are smooth in them.
    fn is_solved(&self, standing: &Standing, before: Option<f64>) -> bool {
        let Standing {
            imbalance,
            rounding,
            defect,
            ..
        } = *standing;
        let gains = before.is_none_or(|before| imbalance < GAIN * before);
        let gains = gains && self.link_force.is_empty();
        let tolerance = self.system.nonlinear.iteration.tolerance;
        (imbalance <= tolerance || imbalance <= rounding && !gains) && defect <= 1.0
    }

    /// Whether all is linear in the unknown, so that one iteration is all.
    fn is_affine(&self) -> bool {
        let system = &*self.system;
        let bodies = self.map.force.x == 0.0 || system.bodies.iter().all(|body| body.is_linear());
        let contacts = system.contacts.iter().all(|c| self.turning(c) == 0.0);
        bodies && contacts && !system.nonlinear.has_followers() && !self.floats()
    }

    /// Begins with the motion of no acceleration, or with the one before it; motions that are prescribed come as a jump in
    /// the first iteration, so that the inside of the body goes along.
    fn predict(&mut self) {
        let system = Arc::clone(&self.system);
        let (map, motion) = (&self.map, &self.state.motion);
        let vectors = &mut self.vectors;
        let inertia = &map.inertia;
        if inertia.x == 0.0 {
            vectors.x.fill(0.0);
        } else {
            inertia.known(motion, &mut vectors.x);
            for x in vectors.x.iter_mut() {
                *x *= -1.0 / inertia.x;
            }
        }
        vectors.jump.fill(0.0);
        let end = &map.displacement;
        if end.x == 0.0 {
            return;
        }
        end.known(motion, &mut vectors.place);
        vectors.work.fill(0.0);
        system
            .nonlinear
            .prescribe(self.state.time + self.dt, &mut vectors.work);
        for i in (0..system.unknowns()).filter(|&i| system.fixed[i]) {
            vectors.x[i] = (motion.u[i] - vectors.place[i]) / end.x;
            vectors.jump[i] = (vectors.work[i] - motion.u[i]) / end.x;
        }
    }

    /// Loads, inertia, internal and damping forces at x. `first`: those that x does not change too.
    pub(super) fn evaluate(&mut self, first: bool) -> Result<(), Error> {
        let map = self.map;
        let motion = &self.state.motion;
        let vectors = &mut self.vectors;
        map.inertia
            .whole(motion, &vectors.x, &[], &mut vectors.place);
        self.system
            .mass
            .multiply(&vectors.place, &mut vectors.inertia);
        if first || map.force.x != 0.0 {
            let rate = damping_rate(&map);
            rate.whole(motion, &vectors.x, &[], &mut vectors.rate);
            self.evaluate_damping();
            let vectors = &mut self.vectors;
            map.force
                .whole(&self.state.motion, &vectors.x, &[], &mut vectors.place);
            let dt = match self.between() {
                true => self.dt,
                false => map.force_fraction.unwrap_or(1.0) * self.dt,
            };
            self.stored = self.internal((Which::Place, self.between()), dt)?;
            self.evaluate_loads(self.instant());
        }
        let vectors = &mut self.vectors;
        for i in 0..vectors.residual.len() {
            vectors.residual[i] = match self.system.fixed[i] {
                true => 0.0,
                false => {
                    vectors.load[i] + self.link_force.get(i).unwrap_or(&0.0)
                        - vectors.inertia[i]
                        - vectors.internal[i]
                        - vectors.damping[i]
                }
            };
        }
        Ok(())
    }

    /// How far forces and contacts are from what they must be. Forces are compared with the largest of those that balance,
    /// and with the momentum per step.
    fn standing(&mut self) -> Standing {
        self.spread();
        let factor = self.map.contact;
        let vectors = &self.vectors;
        let norm = |f: &[f64]| f.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (mut imbalance, mut contact) = (0.0, 0.0);
        for (i, (r, c)) in vectors.residual.iter().zip(&vectors.contact).enumerate() {
            if !self.system.fixed[i] {
                imbalance += (r + factor * c).powi(2);
            }
            contact += (factor * c).powi(2);
        }
        let mut scale = f64::max(contact.sqrt(), norm(&vectors.load)).max(norm(&self.link_force));
        scale = scale
            .max(norm(&vectors.internal))
            .max(norm(&vectors.inertia));
        if self.map.inertia.x != 0.0 {
            scale = scale.max(self.momentum_scale());
        }
        let scale = scale.max(f64::MIN_POSITIVE);
        let [imbalance, rounding] = [imbalance.sqrt(), self.rounding()].map(|force| force / scale);
        self.left_over = scale * f64::max(self.system.nonlinear.iteration.tolerance, rounding);
        Standing {
            imbalance,
            rounding,
            defect: self.worst_point().map_or(0.0, |(_, defect)| defect),
            scale,
        }
    }

    /// |M v|/dt of the motion at the start of the step, N.
    fn momentum_scale(&self) -> f64 {
        let masses = self.system.body_masses.iter().flatten();
        let unknowns = &self.system.unknowns;
        let squares = masses.map(|&(node, m)| {
            let v = &self.state.motion.v[unknowns.translations_of(node)];
            m * m * v.iter().map(|v| v * v).sum::<f64>()
        });
        squares.sum::<f64>().sqrt() / self.dt
    }

    /// Norm of what rounding of the positions leaves in the internal forces, N. Displacements cannot be told apart within
    /// ε |u|, which changes the force of each unknown by about ε K_ii |u|, at random. Places count from
    /// [`System::origin`](crate::System).
    pub(super) fn rounding(&self) -> f64 {
        let (system, u) = (&self.system, &self.state.motion.u);
        let sizes = (0..system.unknowns()).map(|unknown| match system.unknowns.kind(unknown) {
            Kind::Translation(axis) => {
                let x = &system.x[system.unknowns.node(unknown) as usize];
                (x[axis] - system.origin[axis]).abs() + u[unknown].abs()
            }
            Kind::Rotation(_) => u[unknown].abs(),
        });
        2.0 * f64::EPSILON
            * self
                .effective
                .stiffness_norm(&self.system, &self.map, sizes)
    }

    /// Whether this iteration needs a new factor.
    fn wants_factor(&mut self, pass: usize) -> bool {
        if let Some(key) = self.constant_key() {
            return !self.effective.stands(key);
        }
        let (Some(&now), Some(price)) = (self.residuals.last(), self.effective.price()) else {
            return true;
        };
        let Some(ratio) = self.contraction() else {
            return self.pace.age == 0;
        };
        let least = if self.between() { 1.0 } else { 0.5 };
        if ratio.is_nan() || ratio >= least {
            return true;
        }
        let left = (self.system.nonlinear.iteration.tolerance / now).ln();
        let needed = left / ratio.ln();
        if self.between() && self.pace.age == 2 && self.pace.made > 0 {
            self.pace.fresh = ratio;
        }
        let fresh = match self.pace.fresh > 0.0 {
            true => (left / self.pace.fresh.ln()).max(FRESH),
            false => FRESH,
        };
        let keeps = needed <= fresh + TANGENT + price;
        tracing::debug!(
            "step {}, iteration {pass}: residual {now:e}, {} times the one before; the factor is {}: \
             {needed:.1} iterations with it against {fresh:.1} with a new one that costs {:.1}",
            self.state.step + 1,
            ratio,
            if keeps { "kept" } else { "renewed" },
            TANGENT + price,
        );
        !keeps
    }

    /// Factor by which an iteration with the factor at hand shrinks the residual, if that is known. The matrix of forces
    /// between two states is the symmetric part of their derivative, with which residuals fall by turns fast and slowly:
    /// two iterations are looked at.
    fn contraction(&self) -> Option<f64> {
        match (&self.residuals[..], self.pace.age) {
            (_, 0) => None,
            ([.., before, now], 1) if !self.between() => Some(now / before),
            (_, 1) => None,
            ([.., before, _, now], _) if self.between() => Some((now / before).sqrt()),
            ([.., before, now], _) => Some(now / before),
            _ => None,
        }
    }

    /// What a matrix that does not change in the run depends on; none where it changes.
    pub(super) fn constant_key(&self) -> Option<[f64; 4]> {
        let system = &*self.system;
        let linear = system.bodies.iter().all(|body| body.is_linear()) || self.map.force.x == 0.0;
        let turns = system
            .contacts
            .iter()
            .any(|contact| self.turning(contact) != 0.0);
        let map = &self.map;
        let key = [map.inertia.x, map.force.x, self.dt, map.contact];
        (linear && !turns && !system.nonlinear.has_followers()).then_some(key)
    }

    /// Makes the effective matrix at x. Where it is not positive definite with the turning contact forces, it is made
    /// without them, then in the configuration at the start of the step, or with more of the proximal term: the iterations take
    /// longer, and the answer is the same. A first guess that compresses what is nearly incompressible has pressures of many
    /// times the shear modulus, whose stiffness is negative across them; the step itself has nothing of them.
    pub(super) fn renew(&mut self) -> Result<(), Error> {
        let begin = Instant::now();
        let system = Arc::clone(&self.system);
        let constant = self.constant_key();
        let motion = &self.state.motion;
        self.map
            .force
            .whole(motion, &self.vectors.x, &[], &mut self.vectors.place);
        let floats: &[_] = match self.floats() {
            true => &self.floating.parts,
            false => &[],
        };
        let mut at = At {
            map: &self.map,
            dt: match self.between() {
                true => self.dt,
                false => self.map.force_fraction.unwrap_or(1.0) * self.dt,
            },
            time: self.instant(),
            u: &self.vectors.place,
            v: &self.vectors.rate,
            from: self.between().then_some(&motion.u[..]),
            history: &motion.history,
            proximal: (floats, self.floating.weight),
        };
        let forces = self.next.interface.force.iter().enumerate();
        let turned = forces.map(|(point, force)| force * self.turning(system.point(point).0));
        let mut turning = Turning {
            forces: turned.collect(),
            pairing: &self.pairing,
            factor: self.map.contact,
        };
        let mut made = self.effective.renew(&system, &at, &mut turning, constant);
        if made.is_err() && turning.forces.iter().any(|force| *force != 0.0) {
            turning.forces.fill(0.0);
            made = self.effective.renew(&system, &at, &mut turning, constant);
        }
        if made.is_err() && self.map.inertia.x != 0.0 {
            at.u = &motion.u;
            made = self.effective.renew(&system, &at, &mut turning, constant);
        }
        while made.is_err() && !floats.is_empty() && at.proximal.1 < LARGEST {
            at.proximal.1 *= HEAVIER;
            made = self.effective.renew(&system, &at, &mut turning, constant);
        }
        self.floating.weight = at.proximal.1;
        self.phases.factorisation += begin.elapsed();
        made
    }

    /// The motion `dx` of the iteration and the contact forces after it.
    fn motion_of_iteration(&mut self) -> Result<(), Error> {
        let vectors = &mut self.vectors;
        vectors.work.copy_from_slice(&vectors.residual);
        self.free_motion();
        self.solve_interface()
    }

    /// The motion `dx` that the forces in `work` and the jump of the supports give, and its begun solve.
    pub(super) fn free_motion(&mut self) {
        let begin = Instant::now();
        let vectors = &mut self.vectors;
        if vectors.jump.iter().any(|jump| *jump != 0.0) {
            self.effective.load_of(&vectors.jump, &mut vectors.place);
            for (i, (r, k)) in vectors.work.iter_mut().zip(&vectors.place).enumerate() {
                *r = if self.system.fixed[i] { 0.0 } else { *r - k };
            }
        }
        let Some((operators, _)) = self.effective.both() else {
            return;
        };
        operators.begin(&vectors.work, &mut vectors.half);
        vectors.work.copy_from_slice(&vectors.half);
        operators.end(&mut vectors.work, &mut vectors.dx);
        for (dx, jump) in vectors.dx.iter_mut().zip(&vectors.jump) {
            *dx += jump;
        }
        self.phases.sweeps += begin.elapsed();
    }

    /// Goes the way of the iteration, or as much of it as does not make things much worse.
    fn go(&mut self, before: &Standing, jumps: bool) -> Result<Standing, Error> {
        self.vectors.before.copy_from_slice(&self.vectors.x);
        let mut share = 1.0;
        let mut last = None;
        for shortening in 0..=SHORTENINGS {
            let vectors = &mut self.vectors;
            for (i, x) in vectors.x.iter_mut().enumerate() {
                *x = vectors.before[i] + share * vectors.dx[i];
            }
            if self.floats() {
                self.turn(share);
            }
            match self.evaluate(false) {
                Ok(()) => {
                    self.pair(false);
                    let standing = self.standing();
                    let grows = standing.imbalance > GROWTH * before.imbalance.max(1e-6);
                    if jumps || !grows || self.is_affine() {
                        last = Some(Ok(standing));
                        break;
                    }
                    last = Some(Ok(standing));
                }
                Err(error) => last = Some(Err(error)),
            }
            if shortening < SHORTENINGS {
                share *= 0.5;
                self.halve_forces();
            }
        }
        let mut rest = 0.0;
        if jumps && share < 1.0 {
            rest = 1.0 - share;
        }
        for jump in self.vectors.jump.iter_mut() {
            *jump *= rest;
        }
        match last {
            Some(Ok(standing)) => {
                // a part that rolls far in one iteration deforms until the next: what is known of the way it rolls is as
                // good as before
                if share < 1.0 {
                    self.mixing.clear();
                } else if standing.imbalance > before.imbalance && !self.floats() {
                    self.mixing.keep_last();
                }
                Ok(standing)
            }
            Some(outcome) => outcome,
            None => Err(self.no_equilibrium(0)),
        }
    }

    pub(super) fn no_equilibrium(&self, passes: usize) -> Error {
        let system = &*self.system;
        let vectors = &self.vectors;
        let imbalance = |i: usize| match system.fixed[i] {
            true => 0.0,
            false => (vectors.residual[i] + self.map.contact * vectors.contact[i]).abs(),
        };
        let larger = |best: usize, i: usize| match imbalance(i) > imbalance(best) {
            true => i,
            false => best,
        };
        let worst = (0..system.unknowns()).fold(0, larger);
        let node = system.unknowns.node(worst) as usize;
        let owns = |masses: &Vec<(u32, f64)>| masses.iter().any(|(n, _)| *n as usize == node);
        let body = system.body_masses.iter().position(owns).unwrap_or(0);
        let contact = match self.worst_point() {
            Some((point, defect)) if defect > 1.0 => {
                format!("; its law is missed most by {}", self.name(point))
            }
            _ => String::new(),
        };
        let last = self.residuals.len().saturating_sub(8);
        let history = self.residuals[last..].iter().map(|r| format!("{r:.1e}"));
        Error::Equilibrium {
            step: self.state.step + 1,
            time: self.state.time,
            dt: self.dt,
            passes,
            node: system.mesh_node[node],
            body: system.bodies[body].name().into(),
            cell: first_cell(&system.bodies[body], node as u32),
            contact: contact.into(),
            history: history.collect::<Vec<_>>().join(", ").into(),
        }
    }
}

/// The first cell of a body that has this node (system number).
fn first_cell(body: &Body, node: u32) -> ElementId {
    let (mut place, mut first) = (0, None);
    body.each_element(&mut |nodes| {
        if nodes.contains(&node) {
            first.get_or_insert(place);
        }
        place += 1;
    });
    body.cells()[first.unwrap_or(0)]
}
