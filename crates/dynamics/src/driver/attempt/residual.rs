//! The residual of an iteration: loads, inertia, damping, and what the step imposes.

use carom_bodies::Body;
use carom_mesh::ElementId;

use super::Attempt;
use crate::driver::loads::damping_rate;
use crate::error::{Error, MeshNode};

impl Attempt {
    /// Velocity at the instant of the internal forces, where forces depend on it.
    pub(crate) fn evaluate_rate(&mut self) {
        let system = &*self.system;
        let linear = system.bodies.iter().all(Body::is_linear);
        if linear && !system.has_damping() {
            return;
        }
        let vectors = &mut self.vectors;
        let (xc, motion) = ([&vectors.x[..], &vectors.push], &self.state.motion);
        let rate = &mut vectors.rate;
        self.maps.whole(damping_rate, motion, xc, rate);
    }

    /// Inertia forces at x, N.
    pub(crate) fn evaluate_inertia(&mut self) {
        let vectors = &mut self.vectors;
        let (x, push, place) = (&vectors.x, &vectors.push, &mut vectors.place);
        self.maps
            .whole(|map| map.inertia, &self.state.motion, [x, push], place);
        self.system.mass.multiply(place, &mut vectors.inertia);
    }

    /// Squares of M v of the motion at the start of the step, by connected part, N² s².
    pub(crate) fn squares_of_momentum(&self, mut add: impl FnMut(usize, f64)) {
        let (system, v) = (&*self.system, &self.state.motion.v);
        let unknowns = &system.unknowns;
        for (body, masses) in system.body_masses.iter().enumerate() {
            let of = |&(node, m): &(u32, f64)| {
                let v = &v[unknowns.translations_of(node)];
                m * m * v.iter().map(|v| v * v).sum::<f64>()
            };
            add(system.part_of_body[body], masses.iter().map(of).sum());
        }
        for &node in unknowns.turning() {
            for unknown in unknowns.rotations_of(node) {
                let spin = system.mass.lumped[unknown] * v[unknown];
                add(system.part_of(unknown), spin * spin);
            }
        }
        for (body, part) in system.bodies.iter().zip(&system.part_of_body) {
            let Some(body) = body.as_reduced() else {
                continue;
            };
            for axis in 0..3 {
                let momentum = body.inertia(axis).map(|(i, m)| m * v[i]).sum::<f64>();
                add(*part, momentum * momentum);
            }
        }
    }

    /// The unknown whose forces are least in balance.
    pub(crate) fn worst_unknown(&self) -> usize {
        let (system, vectors) = (&*self.system, &self.vectors);
        let imbalance = |i: usize| match system.fixed[i] {
            true => 0.0,
            false => (vectors.residual[i] + self.maps.contact() * vectors.contact[i]).abs(),
        };
        let larger = |best: usize, i: usize| match imbalance(i) > imbalance(best) {
            true => i,
            false => best,
        };
        (0..system.unknowns()).fold(0, larger)
    }

    /// Where forces are least in balance, in words.
    pub(crate) fn place_of_imbalance(&self) -> String {
        let (node, body, _) = self.place_of(self.worst_unknown());
        format!("{node}, in body `{body}`")
    }

    /// Node of the mesh of an unknown, its body, and the first cell of the body at the node.
    pub(crate) fn place_of(&self, unknown: usize) -> (Box<MeshNode>, Box<str>, ElementId) {
        let system = &*self.system;
        let node = system.unknowns.node(unknown);
        let owns = |masses: &Vec<(u32, f64)>| masses.iter().any(|(n, _)| *n == node);
        let body = system.body_masses.iter().position(owns).unwrap_or(0);
        let body = &system.bodies[body];
        let cell = first_cell(body, node);
        (MeshNode::of(system, node), body.name().into(), cell)
    }

    /// # Errors
    /// A vector of the motion at the end of the attempt with an entry that is no number.
    pub(crate) fn check_finite(&self) -> Result<(), Error> {
        let Some((quantity, unknown)) = self.next.motion.not_finite() else {
            return Ok(());
        };
        let (node, body, cell) = self.place_of(unknown);
        Err(Error::NotFinite {
            step: self.state.step + 1,
            time: self.state.time,
            quantity,
            node,
            body,
            cell,
        })
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
