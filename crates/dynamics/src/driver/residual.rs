//! The residual of an iteration, and how far it is from nothing.

use carom_algebra::reduce::norm_squared;
use carom_algebra::unknowns::Kind;
use carom_bodies::{Body, Reduced};
use carom_mesh::ElementId;

use super::loads::damping_rate;
use super::{Driver, Which};
use crate::error::{Error, MeshNode};

/// Where an iteration stands.
pub(super) struct Standing {
    /// Imbalance of the forces, relative.
    pub(super) imbalance: f64,
    /// Largest defect of a contact law, in tolerances.
    pub(super) defect: f64,
    /// What of the imbalance may be rounding, relative.
    pub(super) rounding: f64,
    /// Largest of the forces that balance, N.
    pub(super) scale: f64,
}

impl Driver {
    /// Loads, inertia, internal and damping forces at x. `first`: those that x does not change too.
    pub(super) fn evaluate(&mut self, first: bool) -> Result<(), Error> {
        match first && self.is_affine() && self.system.nonlinear.follows.is_empty() {
            // the first guess has no inertia
            true => self.vectors.inertia.fill(0.0),
            false => self.evaluate_inertia(),
        }
        if first || !self.maps.is_explicit() {
            self.evaluate_rate();
            self.evaluate_damping();
            let vectors = &mut self.vectors;
            let (xc, motion) = ([&vectors.x[..], &vectors.push], &self.state.motion);
            let place = &mut vectors.place;
            self.maps.whole(|map| map.force, motion, xc, place);
            self.turn_rows();
            let (between, dt) = (self.between(), self.dt);
            self.stored = self.internal((Which::Place, between), |map| match between {
                true => dt,
                false => map.instant(dt),
            })?;
            self.evaluate_loads_of_step();
        }
        let vectors = &mut self.vectors;
        let residual = &mut vectors.residual[..];
        let n = residual.len();
        let (fixed, load, inertia) = (
            &self.system.fixed[..n],
            &vectors.load[..n],
            &vectors.inertia[..n],
        );
        let (internal, damping) = (&vectors.internal[..n], &vectors.damping[..n]);
        for i in 0..n {
            let left = load[i] - inertia[i] - internal[i] - damping[i];
            residual[i] = if fixed[i] { 0.0 } else { left };
        }
        if !self.link_force.is_empty() {
            let vectors = &mut self.vectors;
            vectors.unlinked.clone_from(&vectors.residual);
            self.add_link_force();
        }
        Ok(())
    }

    /// Velocity at the instant of the internal forces, where forces depend on it.
    pub(super) fn evaluate_rate(&mut self) {
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
    pub(super) fn evaluate_inertia(&mut self) {
        let vectors = &mut self.vectors;
        let (x, push, place) = (&vectors.x, &vectors.push, &mut vectors.place);
        self.maps
            .whole(|map| map.inertia, &self.state.motion, [x, push], place);
        self.system.mass.multiply(place, &mut vectors.inertia);
    }

    /// The residual with the forces of links as they stand.
    pub(super) fn add_link_force(&mut self) {
        let vectors = &mut self.vectors;
        let forces = self.link_force.iter().zip(&vectors.unlinked);
        for (i, (link, unlinked)) in forces.enumerate() {
            vectors.residual[i] = match self.system.fixed[i] {
                true => 0.0,
                false => unlinked + link,
            };
        }
    }

    /// How far forces and contacts are from what they must be. Forces are compared with the largest of those that balance,
    /// and with the momentum per step.
    pub(super) fn standing(&mut self) -> Standing {
        self.spread();
        let factor = self.maps.contact();
        let vectors = &self.vectors;
        let mut imbalance = 0.0;
        for (i, (r, c)) in vectors.residual.iter().zip(&vectors.contact).enumerate() {
            if !self.system.fixed[i] {
                imbalance += (r + factor * c).powi(2);
            }
        }
        let scale = self.scale_of_forces();
        let rounding = match self.pace.rounding {
            Some(rounding) => rounding,
            None => {
                let rounding = self.rounding();
                *self.pace.rounding.insert(rounding)
            }
        };
        let [imbalance, rounding] = [imbalance.sqrt(), rounding].map(|force| force / scale);
        self.left_over = scale * f64::max(self.system.nonlinear.iteration.tolerance, rounding);
        Standing {
            imbalance,
            rounding,
            defect: self
                .worst_point()
                .map_or(0.0, |(_, defect)| defect)
                .max(self.worst_row()),
            scale,
        }
    }

    /// Largest norm of the forces that balance, N.
    pub(super) fn scale_of_forces(&self) -> f64 {
        let vectors = &self.vectors;
        let norm = |f: &[f64]| norm_squared(f).sqrt();
        let contact = self.maps.contact().abs() * norm(&vectors.contact);
        let forces = [
            &vectors.load,
            &self.link_force,
            &vectors.internal,
            &vectors.inertia,
        ];
        let scale = forces.iter().fold(contact, |most, f| most.max(norm(f)));
        let momentum = match self.maps.is_static() {
            true => 0.0,
            false => self.momentum_scale(),
        };
        scale.max(momentum).max(f64::MIN_POSITIVE)
    }

    /// |M v|/dt of the motion at the start of the step, N.
    fn momentum_scale(&self) -> f64 {
        let masses = self.system.body_masses.iter().flatten();
        let unknowns = &self.system.unknowns;
        let squares = masses.map(|&(node, m)| {
            let v = &self.state.motion.v[unknowns.translations_of(node)];
            m * m * v.iter().map(|v| v * v).sum::<f64>()
        });
        let turning = unknowns.turning().iter();
        let spins = turning.flat_map(|&node| unknowns.rotations_of(node));
        let spins = spins.map(|unknown| {
            (self.system.mass.lumped[unknown] * self.state.motion.v[unknown]).powi(2)
        });
        let reduced = self.system.bodies.iter().filter_map(Body::as_reduced);
        let of_axis = |body: &Reduced, axis: usize| {
            let terms = body.inertia(axis);
            terms.map(|(i, m)| m * self.state.motion.v[i]).sum::<f64>()
        };
        let reduced = reduced.flat_map(|body| [0, 1, 2].map(|axis| of_axis(body, axis).powi(2)));
        (squares.sum::<f64>() + spins.sum::<f64>() + reduced.sum::<f64>()).sqrt() / self.dt
    }

    /// Norm of what rounding of the positions leaves in the internal forces, N. Displacements cannot be told apart within
    /// ε |u|, which changes the force of each unknown by about ε K_ii |u|, at random. Places count from
    /// [`System::origin`](crate::System).
    pub(super) fn rounding(&self) -> f64 {
        self.rounding_with(1.0)
    }

    /// The same of forces alone, without gaps: those of bodies at small strain are of displacements, and places do not count.
    pub fn rounding_of_forces(&self) -> f64 {
        let finite = self.system.bodies.iter().any(Body::has_finite_motion);
        self.rounding_with(if finite { 1.0 } else { 0.0 })
    }

    /// Norm of the forces that the iterations of the last step may have left unbalanced, N; zero of linear steps.
    pub fn left_over(&self) -> f64 {
        self.left_over
    }

    /// `places`: factor of the distances from the origin.
    fn rounding_with(&self, places: f64) -> f64 {
        let (system, u) = (&self.system, &self.state.motion.u);
        let sizes = (0..system.unknowns()).map(|unknown| match system.unknowns.kind(unknown) {
            Kind::Translation(axis) => {
                let x = &system.x[system.unknowns.node(unknown) as usize];
                places * (x[axis] - system.origin[axis]).abs() + u[unknown].abs()
            }
            Kind::Rotation(_) | Kind::Amplitude(_) => u[unknown].abs(),
        });
        2.0 * f64::EPSILON
            * self
                .effective
                .stiffness_norm(&self.system, &self.maps, sizes)
    }

    pub(super) fn no_equilibrium(&self, passes: usize) -> Error {
        let (node, body, cell) = self.place_of(self.worst_unknown());
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
            node,
            body,
            cell,
            contact: contact.into(),
            history: history.collect::<Vec<_>>().join(", ").into(),
        }
    }

    /// The unknown whose forces are least in balance.
    fn worst_unknown(&self) -> usize {
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
    pub(super) fn place_of_imbalance(&self) -> String {
        let (node, body, _) = self.place_of(self.worst_unknown());
        format!("{node}, in body `{body}`")
    }

    /// Node of the mesh of an unknown, its body, and the first cell of the body at the node.
    fn place_of(&self, unknown: usize) -> (Box<MeshNode>, Box<str>, ElementId) {
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
    pub(super) fn check_finite(&self) -> Result<(), Error> {
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
