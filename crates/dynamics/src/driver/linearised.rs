//! A zone without contact, linearised: how the velocities of rows answer to forces on them.

use std::sync::Arc;

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::rotation::Rotation;
use carom_bodies::{Body, Placement};
use serde::{Deserialize, Serialize};

use super::Driver;
use super::attempt::Attempt;
use crate::error::Error;
use crate::operator::{Operators, factored, single};
use crate::scheme::{Scheme, Theta};
use crate::step_map::StepMap;
use crate::system::{LinkRow, Motion, System, on, push_cliques};

/// How forces on rows run over some steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Growth {
    /// They grow linearly from 0 to 1.
    Linear,
    /// They are 1 from the start on, where the acceleration jumps with them ([`Driver::jumps`]).
    Constant,
}

/// Some steps of a zone from rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Steps {
    /// How many.
    pub count: u32,
    /// How the forces run over them.
    pub growth: Growth,
}

/// A zone linearised at an [`Origin`], without contact.
pub struct LinearZone {
    map: StepMap,
    /// Weights of the multipliers at the start and the end of a step.
    weights: [f64; 2],
    way: WayWeights,
    /// Whether a step begins with the acceleration of the one before.
    keeps: bool,
    /// Factors and stiffness; none where the driver has the factors, and its bodies are linear.
    own: Option<(Operators, Csr)>,
    motion: Motion,
    ended: Motion,
    /// Nodal forces, the solve that is begun, x, and nothing, by unknown.
    vectors: [Vec<f64>; 4],
}

/// What forces on rows leave in them.
#[derive(Debug)]
pub struct Answered<'a> {
    /// Velocity of each row at the end, m/s.
    pub ends: &'a mut [f64],
    /// Way of each row, m.
    pub ways: &'a mut [f64],
}

impl Driver {
    /// The zone linearised at an origin, for steps of the present size.
    ///
    /// # Errors
    /// An effective matrix that is not positive definite.
    pub fn linearised(&mut self, origin: &Origin) -> Result<LinearZone, Error> {
        let map = self.attempt.linear_map();
        let weights = (self.link_weights(), self.way_weights());
        let keeps = self.attempt.system.scheme.get().keeps_acceleration();
        self.parts.take_matrices(&mut self.attempt)?;
        let linear = self.attempt.system.bodies.iter().all(Body::is_linear);
        let own = match linear && !self.parts.effective().iterates() {
            true => None,
            false => {
                let stiffness = self.attempt.tangent_at(origin)?;
                let operators = self.attempt.linear_operators(&map, &stiffness)?;
                Some((operators, stiffness))
            }
        };
        Ok(LinearZone::new(
            &self.attempt.system,
            (map, weights, keeps),
            own,
        ))
    }

    /// What forces on rows, `Σ_r c_r λ_r` with multipliers λ by the number of the row, leave in the rows after some steps from rest.
    ///
    /// # Errors
    /// An effective matrix that is not positive definite.
    pub fn answer(
        &mut self,
        zone: &mut LinearZone,
        (rows, multipliers): (&[(u32, LinkRow)], &[f64]),
        steps: Steps,
        out: Answered,
    ) -> Result<(), Error> {
        let system = Arc::clone(&self.attempt.system);
        zone.rest();
        if steps.growth == Growth::Constant && self.jumps() {
            let mut force = vec![0.0; system.unknowns()];
            for (row, terms) in rows {
                for &(dof, c) in terms {
                    force[dof as usize] += c * multipliers[*row as usize];
                }
            }
            let jump = self.links.solve_jump(&system, &force)?;
            zone.motion.a.copy_from_slice(&jump.given);
        }
        if let Some((mut operators, stiffness)) = zone.own.take() {
            let forces = &mut |u: &[f64], f: &mut [f64]| stiffness.multiply(u, f);
            let mut of = Linearised {
                system: &system,
                operators: &mut operators,
                forces,
            };
            of.run(zone, (rows, multipliers), steps, out);
            zone.own = Some((operators, stiffness));
            return Ok(());
        }
        self.parts.take_matrices(&mut self.attempt)?;
        let Some((operators, scratch)) = self.parts.operators_and_scratch() else {
            return Ok(());
        };
        let mut of = Linearised {
            system: &system,
            operators,
            forces: &mut |u, f| {
                f.fill(0.0);
                for (body, scratch) in system.bodies.iter().zip(&mut *scratch) {
                    body.internal_force(u, scratch, f);
                }
            },
        };
        of.run(zone, (rows, multipliers), steps, out);
        Ok(())
    }

    /// Velocities that forces on rows leave in them over some steps, and their ways: dense matrices, row-major over the rows given.
    ///
    /// # Errors
    /// An effective matrix that is not positive definite.
    pub fn answers(
        &mut self,
        zone: &mut LinearZone,
        rows: &[(u32, LinkRow)],
        steps: Steps,
    ) -> Result<[Vec<f64>; 2], Error> {
        let n = rows.len();
        let most = rows.iter().map(|(row, _)| *row as usize + 1).max();
        let mut multipliers = vec![0.0; most.unwrap_or(0)];
        let [mut ends, mut ways] = [vec![0.0; n * n], vec![0.0; n * n]];
        let [mut end, mut way] = [vec![0.0; n], vec![0.0; n]];
        for (column, (row, _)) in rows.iter().enumerate() {
            multipliers[*row as usize] = 1.0;
            let out = Answered {
                ends: &mut end,
                ways: &mut way,
            };
            self.answer(zone, (rows, &multipliers), steps, out)?;
            multipliers[*row as usize] = 0.0;
            for row in 0..n {
                ends[row * n + column] = end[row];
                ways[row * n + column] = way[row];
            }
        }
        Ok([ends, ways])
    }
}

impl LinearZone {
    fn new(
        system: &System,
        (map, (weights, way), keeps): (StepMap, ([f64; 2], WayWeights), bool),
        own: Option<(Operators, Csr)>,
    ) -> LinearZone {
        let zeros = || vec![0.0; system.unknowns()];
        let motion = Motion {
            u: zeros(),
            v: zeros(),
            a: zeros(),
            memory: match map.has_memory() {
                true => zeros(),
                false => Vec::new(),
            },
            ..Motion::default()
        };
        LinearZone {
            map,
            weights,
            way,
            keeps,
            own,
            ended: motion.clone(),
            motion,
            vectors: [zeros(), zeros(), zeros(), zeros()],
        }
    }

    /// Takes the zone to rest at its origin.
    fn rest(&mut self) {
        let Motion {
            u, v, a, memory, ..
        } = &mut self.motion;
        for vector in [u, v, a, memory] {
            vector.fill(0.0);
        }
    }
}

/// Weights in the way of a step, of velocities (s) and accelerations (s²) at its start and its end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WayWeights {
    velocity: [f64; 2],
    acceleration: [f64; 2],
}

impl WayWeights {
    /// Those of a map whose unknown is the acceleration at the end, or changes the velocity there. `keeps`: whether the state keeps the
    /// acceleration from which a step begins.
    pub(super) fn of_map(map: &StepMap, keeps: bool) -> WayWeights {
        let way = map.displacement;
        if keeps && map.acceleration.x == 1.0 {
            return WayWeights {
                velocity: [way.v, 0.0],
                acceleration: [way.a, way.x],
            };
        }
        let end = way.x / map.velocity.x;
        let kept = if keeps {
            way.a - end * map.velocity.a
        } else {
            0.0
        };
        WayWeights {
            velocity: [way.v - end * map.velocity.v, end],
            acceleration: [kept, 0.0],
        }
    }

    /// Way of a row from one motion to the next, m.
    pub(super) fn of(&self, row: &LinkRow, motions: [&Motion; 2]) -> f64 {
        let velocities = self.velocity.iter().zip(motions.map(|motion| &motion.v));
        let accelerations = self
            .acceleration
            .iter()
            .zip(motions.map(|motion| &motion.a));
        let all = velocities.chain(accelerations);
        // most have two of the four
        let terms = all.filter(|(weight, _)| **weight != 0.0);
        terms.map(|(weight, vector)| weight * on(row, vector)).sum()
    }
}

/// The matrices of a linearised zone.
struct Linearised<'a> {
    system: &'a System,
    operators: &'a mut Operators,
    /// K u.
    forces: &'a mut dyn FnMut(&[f64], &mut [f64]),
}

impl Linearised<'_> {
    fn run(
        &mut self,
        zone: &mut LinearZone,
        (rows, multipliers): (&[(u32, LinkRow)], &[f64]),
        steps: Steps,
        out: Answered,
    ) {
        out.ways.fill(0.0);
        let (weights, of_way) = (zone.weights, zone.way);
        for step in 0..steps.count {
            let part = |k: u32| f64::from(k) / f64::from(steps.count);
            let force = match steps.growth {
                Growth::Linear => weights[0] * part(step) + weights[1] * part(step + 1),
                Growth::Constant => 1.0,
            };
            let at_rest = step == 0 && steps.growth == Growth::Linear;
            self.step(zone, at_rest, (rows, multipliers, force));
            for (way, (_, terms)) in out.ways.iter_mut().zip(rows) {
                *way += of_way.of(terms, [&zone.motion, &zone.ended]);
            }
            std::mem::swap(&mut zone.motion, &mut zone.ended);
        }
        for (end, (_, terms)) in out.ends.iter_mut().zip(rows) {
            *end = on(terms, &zone.motion.v);
        }
    }

    /// One step under `factor` times the forces of the rows.
    fn step(
        &mut self,
        zone: &mut LinearZone,
        at_rest: bool,
        (rows, multipliers, factor): (&[(u32, LinkRow)], &[f64], f64),
    ) {
        let [r, half, x, none] = &mut zone.vectors;
        let (map, motion, end) = (&zone.map, &zone.motion, &mut zone.ended);
        r.fill(0.0);
        if !at_rest {
            map.force.known(motion, half);
            (self.forces)(half, r);
            map.inertia.known(motion, half);
            self.system.mass.multiply(half, x);
            for (i, r) in r.iter_mut().enumerate() {
                *r = match self.system.fixed[i] {
                    true => 0.0,
                    false => -*r - x[i],
                };
            }
        }
        for (row, terms) in rows {
            let multiplier = multipliers[*row as usize];
            if multiplier == 0.0 {
                continue;
            }
            for &(dof, c) in terms {
                if !self.system.fixed[dof as usize] {
                    r[dof as usize] += c * (multiplier * factor);
                }
            }
        }
        self.operators.begin(r, half);
        self.operators.end(half, x);
        map.displacement.whole(motion, x, none, &mut end.u);
        map.velocity.whole(motion, x, none, &mut end.v);
        if zone.keeps {
            map.acceleration.whole(motion, x, none, &mut end.a);
        }
        map.memory.whole(motion, x, none, &mut end.memory);
    }
}

/// Where a zone was linearised; empty of a linear zone.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Origin {
    /// Displacement, m.
    pub u: Vec<f64>,
    /// Histories of its materials.
    pub history: Vec<f64>,
    /// Rotations of its nodes.
    pub frames: Vec<Rotation>,
}

impl Origin {
    /// Whether it is of the same zone as another one, in the length of each array.
    pub fn is_like(&self, other: &Origin) -> bool {
        let lengths = |one: &Origin| [one.u.len(), one.history.len(), one.frames.len()];
        lengths(self) == lengths(other)
    }

    /// The present state of a zone.
    pub fn of(driver: &Driver) -> Origin {
        let mut bodies = driver.system().bodies.iter();
        match bodies.all(|body| body.is_linear()) {
            true => Origin::default(),
            false => Origin {
                u: driver.state().motion.u.clone(),
                history: driver.state().motion.history.clone(),
                frames: driver.state().motion.frames.clone(),
            },
        }
    }
}

impl Attempt {
    /// The map of the linearised zone: where forces belong to the way of the step they are those of its middle.
    pub(super) fn linear_map(&self) -> StepMap {
        match self.between() {
            true => Scheme::Theta(Theta { theta: 0.5 }).get().step_map(self.dt),
            false => *self.maps.first(),
        }
    }

    /// The factors of the effective matrix with this stiffness.
    pub(super) fn linear_operators(
        &self,
        map: &StepMap,
        stiffness: &Csr,
    ) -> Result<Operators, Error> {
        let system = &*self.system;
        if map.force.x == 0.0 && system.mass.is_lumped() {
            return Operators::new(system, map.inertia.x, 0.0, "effective matrix");
        }
        let mut a = stiffness.clone();
        a.scale(map.force.x);
        let mut operators = Operators::of(&system.parts, single(system.parts.len()));
        for group in &mut operators.groups {
            let part = group.parts[0].clone();
            system.mass.add_to(map.inertia.x, &part, 0, &mut a);
            let own = a.restricted(&group.parts);
            let fixed = &system.fixed[part.clone()];
            let operator = factored(system, &part, &own, fixed, "effective matrix")?;
            group.operator = Some(operator);
        }
        Ok(operators)
    }

    /// The stiffness at an origin.
    fn tangent_at(&self, origin: &Origin) -> Result<Csr, Error> {
        let system = &*self.system;
        let n = system.unknowns();
        let mut cliques = Cliques::new();
        for body in &system.bodies {
            push_cliques(body, &system.unknowns, &(0..n), &mut cliques);
        }
        let still = vec![0.0; n];
        let mut stiffness = Csr::from_cliques(n, &cliques);
        for (k, body) in system.bodies.iter().enumerate() {
            let at = Placement {
                u: &origin.u,
                v: &still,
                from: None,
                frames: &origin.frames,
                dt: self.dt,
                old: &origin.history[system.nonlinear.histories[k].clone()],
            };
            body.add_tangent(&at, [1.0, 0.0], &mut stiffness)?;
        }
        Ok(stiffness)
    }
}
