//! Finds the assemblies of a system, and what holds them.

use carom_algebra::unknowns::Kind;
use carom_bodies::Body;
use carom_contact::{Obstacle, Shape, Target};

use crate::assemblies::{Assemblies, Assembly};
use crate::model::ModelLink;
use crate::system::System;

impl Assemblies {
    /// Those of a system.
    pub(crate) fn of(system: &System) -> Assemblies {
        Assemblies::linked(system, &[])
    }

    /// The same with links that the system itself does not have.
    pub(crate) fn linked(system: &System, links: &[ModelLink]) -> Assemblies {
        let mut assemblies = joined(system, links);
        for (number, contact) in system.contacts.iter().enumerate() {
            if let Some(&body) = contact.bodies.first() {
                let assembly = assemblies.of_part[system.part_of_body[body]];
                assemblies.all[assembly].contacts.push(number);
            }
        }
        balance_together(system, &mut assemblies);
        let mut by_axis = [0, 1, 2].map(|_| vec![0.0; system.unknowns()]);
        let mut momentum = vec![0.0; system.unknowns()];
        for (axis, mass) in by_axis.iter_mut().enumerate() {
            let unit: Vec<f64> = (0..system.unknowns())
                .map(|i| f64::from(system.unknowns.kind(i) == Kind::Translation(axis)))
                .collect();
            system.mass.multiply(&unit, mass);
        }
        system
            .mass
            .multiply(&system.initial.velocity, &mut momentum);
        for assembly in &mut assemblies.all {
            let mut sum = [0.0; 3];
            for unknown in assembly
                .parts
                .iter()
                .flat_map(|&part| system.parts[part].clone())
            {
                if let Kind::Translation(axis) = system.unknowns.kind(unknown) {
                    sum[axis] += momentum[unknown];
                    assembly.mass[axis] += by_axis[axis][unknown];
                }
            }
            let mass = assembly.mass;
            let mean = [0, 1, 2].map(|i| if mass[i] > 0.0 { sum[i] / mass[i] } else { 0.0 });
            assembly.velocity = Frame::new(mean).held(&holds(system, assembly));
        }
        assemblies
    }

    /// The assembly of a contact.
    pub fn of_contact(&self, system: &System, contact: usize) -> usize {
        self.of_part[system.part_of_body[system.contacts[contact].secondary_body]]
    }
}

/// Joins what has these numbers to that with the least of them. `first`: the least number of those that each is joined with.
fn join(first: &mut [usize], numbers: &mut dyn Iterator<Item = usize>) {
    let Some(one) = numbers.next() else { return };
    for other in numbers {
        let [one, other] = [first[one], first[other]];
        let (low, high) = (one.min(other), one.max(other));
        if low == high {
            continue;
        }
        for first in &mut *first {
            if *first == high {
                *first = low;
            }
        }
    }
}

/// Finds the assemblies that springs of one name are in. All other bodies are in one part, however many pieces they have.
fn balance_together(system: &System, assemblies: &mut Assemblies) {
    let mut first: Vec<usize> = (0..assemblies.all.len()).collect();
    let is_spring = |body: &&Body| body.as_discrete().is_some() && !body.balances_itself();
    for body in system.bodies.iter().filter(is_spring) {
        let mut own = Vec::new();
        body.each_element(&mut |nodes| {
            let node = system.unknowns.moved_by(nodes[0]);
            let part = system.part_of(system.unknowns.first(node));
            own.push(assemblies.of_part[part]);
        });
        join(&mut first, &mut own.into_iter());
    }
    for (assembly, first) in assemblies.all.iter_mut().zip(first) {
        assembly.balanced_with = first;
    }
}

/// The parts that contacts and links join, without masses and frames.
fn joined(system: &System, links: &[ModelLink]) -> Assemblies {
    let mut first: Vec<usize> = (0..system.parts.len()).collect();
    let mut join = |parts: &mut dyn Iterator<Item = usize>| join(&mut first, parts);
    for contact in &system.contacts {
        join(&mut contact.bodies.iter().map(|&body| system.part_of_body[body]));
    }
    for row in system.links.rows.iter() {
        join(
            &mut row
                .iter()
                .map(|&(unknown, _)| system.part_of(unknown as usize)),
        );
    }
    for row in links.iter().flat_map(|link| &link.rows) {
        join(&mut row.inner.iter().chain(&row.outer).map(|term| {
            let node = system.number[term.node as usize];
            system.part_of(system.unknowns.first(node))
        }));
    }
    let mut assemblies = Assemblies {
        all: Vec::new(),
        of_part: vec![0; first.len()],
    };
    let mut number = vec![0; first.len()];
    for (part, &first) in first.iter().enumerate() {
        if first == part {
            number[part] = assemblies.all.len();
            assemblies.all.push(Assembly::default());
        }
        assemblies.of_part[part] = number[first];
        assemblies.all[number[first]].parts.push(part);
    }
    assemblies
}

/// A direction in which something outside holds an assembly, and the velocity along it of what does, m/s.
struct Hold {
    direction: [f64; 3],
    velocity: f64,
}

/// What holds an assembly at the start.
fn holds(system: &System, assembly: &Assembly) -> Vec<Hold> {
    let mut holds = Vec::new();
    let mut along = |axis: usize, velocity: f64| {
        let mut direction = [0.0; 3];
        direction[axis] = 1.0;
        holds.push(Hold {
            direction,
            velocity,
        });
    };
    let has = |body: &usize| assembly.parts.contains(&system.part_of_body[*body]);
    let bodies = (0..system.bodies.len()).filter(has);
    let grounded = bodies.map(|body| &system.bodies[body]).any(|body| {
        // the momentum of a reduced body is in its amplitudes
        !body.balances_itself() || body.as_reduced().is_some()
    });
    if grounded {
        (0..3).for_each(|axis| along(axis, 0.0));
    }
    if system.axisymmetric {
        along(0, 0.0);
    }
    for part in &assembly.parts {
        let mut known = [false; 3];
        for unknown in system.parts[*part].clone().filter(|&i| system.fixed[i]) {
            if let Kind::Translation(axis) = system.unknowns.kind(unknown)
                && !std::mem::replace(&mut known[axis], true)
            {
                along(axis, velocity_of(system, unknown));
            }
        }
    }
    for contact in &system.contacts {
        if let Target::Rigid(obstacle) = &contact.target
            && contact.bodies.iter().any(&has)
        {
            of_obstacle(obstacle, contact.friction.acts(), &mut holds);
        }
    }
    holds
}

/// Velocity at the start of an unknown that is held, m/s.
fn velocity_of(system: &System, unknown: usize) -> f64 {
    let follows = system.nonlinear.follows.iter();
    let mut follows = follows.filter(|follows| follows.unknown as usize == unknown);
    follows.next().map_or(0.0, |follows| {
        system.nonlinear.amplitudes[follows.amplitude].rate(0.0)
    })
}

/// The directions that an obstacle holds: a plane without friction its normal, any other all.
fn of_obstacle(obstacle: &Obstacle, rubs: bool, holds: &mut Vec<Hold>) {
    let at = match &obstacle.shape {
        Shape::Plane(plane) => plane.point,
        Shape::Sphere(_) | Shape::Cylinder(_) | Shape::Profile(_) | Shape::Surface(_) => [0.0; 3],
    };
    let velocity = obstacle.mean_velocity(&at, 0.0, [0.0, 0.0]);
    let mut along = |direction: [f64; 3]| {
        let velocity = (0..3).map(|i| direction[i] * velocity[i]).sum();
        holds.push(Hold {
            direction,
            velocity,
        });
    };
    match &obstacle.shape {
        Shape::Plane(plane) if !rubs => along(plane.normal),
        _ => (0..3).for_each(|axis| along([0, 1, 2].map(|i| f64::from(i == axis)))),
    }
}

/// A velocity, and the directions along which it is settled.
struct Frame {
    velocity: [f64; 3],
    settled: Vec<[f64; 3]>,
}

/// Part of a direction across the settled ones below which it is one of them.
const PARALLEL: f64 = 1e-6;

impl Frame {
    fn new(velocity: [f64; 3]) -> Frame {
        Frame {
            velocity,
            settled: Vec::new(),
        }
    }

    /// The velocity nearest to this one that is that of each hold along its direction; where two holds differ, the first counts.
    fn held(mut self, holds: &[Hold]) -> [f64; 3] {
        let dot = |a: &[f64; 3], b: &[f64; 3]| -> f64 { (0..3).map(|i| a[i] * b[i]).sum() };
        for hold in holds {
            let mut across = hold.direction;
            for settled in &self.settled {
                let along = dot(&across, settled);
                across = [0, 1, 2].map(|i| across[i] - along * settled[i]);
            }
            let square = dot(&across, &across);
            if square < PARALLEL * PARALLEL {
                continue;
            }
            let more = (hold.velocity - dot(&hold.direction, &self.velocity)) / square;
            self.velocity = [0, 1, 2].map(|i| self.velocity[i] + more * across[i]);
            let length = square.sqrt();
            self.settled.push(across.map(|x| x / length));
        }
        self.velocity
    }
}
