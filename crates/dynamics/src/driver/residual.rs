//! The residual of an iteration, and how far it is from nothing.

use carom_algebra::reduce::norm_squared;
use carom_algebra::unknowns::Kind;
use carom_bodies::Body;
use carom_mesh::ElementId;

use super::loads::damping_rate;
use super::owners::{Attempt, Contacts, Links, Parts};
use super::scratch::Squares;
use super::{Configuration, Driver};
use crate::error::{Error, MeshNode};
use crate::system::Assembly;

/// Where an iteration stands. Forces are told by assembly: the imbalance and its rounding are those of the one that is worst.
#[derive(Default)]
pub(super) struct Standing {
    /// Imbalance of the forces, relative.
    pub(super) imbalance: f64,
    /// Largest defect of a contact law, in tolerances.
    pub(super) defect: f64,
    /// What of the imbalance may be rounding, relative.
    pub(super) rounding: f64,
    /// Largest of the forces that balance, N.
    pub(super) scale: f64,
    /// Imbalance of the forces of all, N.
    pub(super) force: f64,
    /// Largest imbalance of a connected part over what its own forces tolerate.
    pub(super) excess: f64,
    /// Whether no assembly has more imbalance than its forces and momentum tolerate, or than may be rounding.
    pub(super) is_rounding: bool,
}

impl Driver {
    /// Loads, inertia, internal and damping forces at x. `first`: those that x does not change too.
    pub(super) fn evaluate(&mut self, first: bool) -> Result<(), Error> {
        match first
            && self.contacts.is_affine(&self.parts)
            && self.attempt.system.nonlinear.follows.is_empty()
        {
            // the first guess has no inertia
            true => self.attempt.vectors.inertia.fill(0.0),
            false => self.attempt.evaluate_inertia(),
        }
        if first || !self.attempt.maps.is_explicit() {
            self.attempt.evaluate_rate();
            self.parts.evaluate_damping(&mut self.attempt);
            let vectors = &mut self.attempt.vectors;
            let (xc, motion) = ([&vectors.x[..], &vectors.push], &self.attempt.state.motion);
            let place = &mut vectors.place;
            self.attempt.maps.whole(|map| map.force, motion, xc, place);
            self.links.turn_rows(&self.attempt);
            let (between, dt) = (self.attempt.between(), self.attempt.dt);
            self.parts.stored =
                self.parts
                    .internal(&mut self.attempt, (Configuration::Place, between), |map| {
                        match between {
                            true => dt,
                            false => map.instant(dt),
                        }
                    })?;
            self.attempt.evaluate_loads_of_step();
        }
        let vectors = &mut self.attempt.vectors;
        let residual = &mut vectors.residual[..];
        let n = residual.len();
        let (fixed, load, inertia) = (
            &self.attempt.system.fixed[..n],
            &vectors.load[..n],
            &vectors.inertia[..n],
        );
        let (internal, damping) = (&vectors.internal[..n], &vectors.damping[..n]);
        for i in 0..n {
            let left = load[i] - inertia[i] - internal[i] - damping[i];
            residual[i] = if fixed[i] { 0.0 } else { left };
        }
        if !self.links.force.is_empty() {
            let vectors = &mut self.attempt.vectors;
            vectors.unlinked.clone_from(&vectors.residual);
            self.links.add_link_force(&mut self.attempt);
        }
        Ok(())
    }

    /// How far forces and contacts are from what they must be. The forces of an assembly, whose bodies may act on each other, are compared with
    /// the largest of those that balance in it, and with its momentum per step: bodies that have nothing to do with it do not make its
    /// equations less accurate. The excess is by connected part, and without momentum, so that a light body is as accurate where a heavy
    /// one strikes it.
    pub(super) fn standing(&mut self) -> Standing {
        self.stages.spread(&self.contacts, &mut self.attempt);
        let mut squares = std::mem::take(&mut self.parts.squares);
        self.links
            .square_forces(&mut self.parts, &self.attempt, &mut squares);
        let tolerance = self.attempt.system.nonlinear.iteration.tolerance;
        let mut standing = Standing {
            is_rounding: true,
            ..Standing::default()
        };
        let (mut left_over, mut force) = (0.0, 0.0);
        for assembly in &self.attempt.system.assemblies.all {
            let parts = || assembly.parts.iter().map(|&part| &squares[part]);
            standing.excess = excess(parts, tolerance).max(standing.excess);
            let own = parts().fold(Squares::default(), Squares::with);
            let scale = own.scale();
            let [imbalance, rounding] =
                [own.imbalance, own.rounding].map(|square| square.sqrt() / scale);
            standing.is_rounding &= imbalance <= tolerance.max(rounding);
            left_over += (scale * tolerance.max(rounding)).powi(2);
            force += own.imbalance;
            standing.scale = standing.scale.max(scale);
            // what is no number is the worst
            if imbalance.is_nan() || imbalance >= standing.imbalance {
                (standing.imbalance, standing.rounding) = (imbalance, rounding);
            }
        }
        self.parts.squares = squares;
        self.parts.left_over = left_over.sqrt();
        standing.force = force.sqrt();
        let of_points = self
            .contacts
            .worst_point(&self.parts, &self.attempt)
            .map_or(0.0, |(_, defect)| defect);
        standing.defect = of_points.max(self.links.worst_row(&self.attempt));
        standing
    }

    /// The same of forces alone, without gaps: those of bodies at small strain are of displacements, and places do not count.
    pub fn rounding_of_forces(&self) -> f64 {
        let finite = self
            .attempt
            .system
            .bodies
            .iter()
            .any(Body::has_finite_motion);
        self.parts
            .rounding_with(&self.attempt, if finite { 1.0 } else { 0.0 })
    }

    /// Norm of the forces that the iterations of the last step may have left unbalanced, N; zero of linear steps.
    pub fn left_over(&self) -> f64 {
        self.parts.left_over
    }
}

impl Attempt {
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

    /// Squares of M v of the motion at the start of the step, by connected part, N² s².
    pub(super) fn squares_of_momentum(&self, mut add: impl FnMut(usize, f64)) {
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
    pub(super) fn worst_unknown(&self) -> usize {
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
    pub(super) fn place_of(&self, unknown: usize) -> (Box<MeshNode>, Box<str>, ElementId) {
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

impl Links {
    /// The residual with the forces of links as they stand.
    pub(super) fn add_link_force(&self, attempt: &mut Attempt) {
        let vectors = &mut attempt.vectors;
        let forces = self.force.iter().zip(&vectors.unlinked);
        for (i, (link, unlinked)) in forces.enumerate() {
            vectors.residual[i] = match attempt.system.fixed[i] {
                true => 0.0,
                false => unlinked + link,
            };
        }
    }

    /// Norm of the largest of the forces that balance in each assembly, N.
    pub(super) fn scale_of_forces(&self, parts: &mut Parts, attempt: &Attempt) -> f64 {
        let mut squares = std::mem::take(&mut parts.squares);
        self.square_forces(parts, attempt, &mut squares);
        let of = |assembly: &Assembly| {
            let parts = assembly.parts.iter().map(|&part| &squares[part]);
            parts.fold(Squares::default(), Squares::with).scale()
        };
        let assemblies = attempt.system.assemblies.all.iter();
        let scale = assemblies.map(|assembly| of(assembly).powi(2)).sum::<f64>();
        parts.squares = squares;
        scale.sqrt()
    }

    /// Squares of the forces of each part.
    pub(super) fn square_forces(
        &self,
        parts: &mut Parts,
        attempt: &Attempt,
        squares: &mut Vec<Squares>,
    ) {
        if !std::mem::replace(&mut parts.pace.is_sized, true) {
            parts.size_of_motion(attempt, squares);
        }
        let factor = attempt.maps.contact();
        let (system, vectors) = (&*attempt.system, &attempt.vectors);
        for own in squares.iter_mut() {
            (own.imbalance, own.forces) = (0.0, [0.0; 5]);
        }
        for (part, unknowns) in system.parts.iter().enumerate() {
            let own = &mut squares[part];
            for i in unknowns.clone() {
                let contact = factor * vectors.contact[i];
                if !system.fixed[i] {
                    own.imbalance += (vectors.residual[i] + contact).powi(2);
                }
                let forces = [
                    contact,
                    vectors.load[i],
                    vectors.internal[i],
                    vectors.inertia[i],
                ];
                for (sum, force) in own.forces.iter_mut().zip(forces) {
                    *sum += force * force;
                }
            }
            if let Some(link) = self.force.get(unknowns.clone()) {
                own.forces[4] += norm_squared(link);
            }
        }
    }
}

impl Parts {
    /// Squares of what the motion at the start of the step says: of the momentum per step, and of what rounding leaves of forces.
    pub(super) fn size_of_motion(&self, attempt: &Attempt, squares: &mut Vec<Squares>) {
        let system = &*attempt.system;
        squares.clear();
        squares.resize(system.parts.len(), Squares::default());
        if !attempt.maps.is_static() {
            let add =
                |part: usize, square: f64| squares[part].momentum += square / attempt.dt.powi(2);
            attempt.squares_of_momentum(add);
        }
        for (span, map) in attempt.maps.spans() {
            for i in span {
                let inertia = map.inertia.x * system.mass.lumped[i] * attempt.vectors.x[i];
                squares[system.part_of(i)].inertia_rounding += (f64::EPSILON * inertia).powi(2);
            }
        }
        let add = |unknown: usize, square: f64| {
            let part = system.part_of(unknown);
            squares[part].rounding += (2.0 * f64::EPSILON).powi(2) * square;
        };
        self.squares_of_places(attempt, 1.0, add);
    }

    /// Norm of what rounding of the positions leaves in the internal forces, N. Displacements cannot be told apart within
    /// ε |u|, which changes the force of each unknown by about ε K_ii |u|, at random. Places count from
    /// [`System::origin`](crate::System).
    pub(super) fn rounding(&self, attempt: &Attempt) -> f64 {
        self.rounding_with(attempt, 1.0)
    }

    /// `places`: factor of the distances from the origin.
    pub(super) fn rounding_with(&self, attempt: &Attempt, places: f64) -> f64 {
        let mut sum = 0.0;
        self.squares_of_places(attempt, places, |_, square| sum += square);
        2.0 * f64::EPSILON * sum.sqrt()
    }

    /// Squares of the stiffness of each unknown times its place, N². `places`: factor of the distances from the origin.
    pub(super) fn squares_of_places(
        &self,
        attempt: &Attempt,
        places: f64,
        add: impl FnMut(usize, f64),
    ) {
        let (system, u) = (&attempt.system, &attempt.state.motion.u);
        let sizes = (0..system.unknowns()).map(|unknown| match system.unknowns.kind(unknown) {
            Kind::Translation(axis) => {
                let x = &system.x[system.unknowns.node(unknown) as usize];
                places * (x[axis] - system.origin[axis]).abs() + u[unknown].abs()
            }
            Kind::Rotation(_) | Kind::Amplitude(_) => u[unknown].abs(),
        });
        self.effective
            .stiffness_squares((system, &attempt.maps), sizes, add);
    }
}

/// Part of the tolerance by which the largest forces of an assembly count in each of its parts: what contacts and links exchange is known to no more digits.
const EXCHANGED: f64 = 1e-3;

/// The same, in roundings.
const ROUNDINGS: f64 = 16.0;

/// Largest imbalance of the parts of an assembly over what is tolerated there: the tolerance times the largest of the forces that balance in the part, rounding
/// of what the assembly exchanges, and of the inertia.
fn excess<'a, I: Iterator<Item = &'a Squares>>(parts: impl Fn() -> I, tolerance: f64) -> f64 {
    let exchanged = parts().fold(0.0, |most, part| part.largest().max(most));
    let floor = (EXCHANGED * tolerance).max(ROUNDINGS * f64::EPSILON) * exchanged;
    let of = |part: &Squares| {
        let rounding = ROUNDINGS * part.inertia_rounding.sqrt();
        let tolerated = (tolerance * part.largest()).max(floor).max(rounding);
        // what is no number is not in balance
        match part.imbalance.sqrt() / tolerated.max(f64::MIN_POSITIVE) {
            excess if excess.is_nan() => f64::INFINITY,
            excess => excess,
        }
    };
    parts().map(of).fold(0.0, f64::max)
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

impl Contacts {
    pub(super) fn no_equilibrium(&self, parts: &Parts, attempt: &Attempt, passes: usize) -> Error {
        let (node, body, cell) = attempt.place_of(attempt.worst_unknown());
        let contact = match self.worst_point(parts, attempt) {
            Some((point, defect)) if defect > 1.0 => {
                format!("; its law is missed most by {}", attempt.name(point))
            }
            _ => String::new(),
        };
        let last = parts.residuals.len().saturating_sub(8);
        let history = parts.residuals[last..].iter().map(|r| format!("{r:.1e}"));
        Error::Equilibrium {
            step: attempt.state.step + 1,
            time: attempt.state.time,
            dt: attempt.dt,
            passes,
            node,
            body,
            cell,
            contact: contact.into(),
            history: history.collect::<Vec<_>>().join(", ").into(),
        }
    }
}
