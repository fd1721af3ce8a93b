//! What never changes during a run: bodies, numbering, masses, supports, loads, contacts, scheme.

use std::ops::Range;
use std::sync::Arc;

use carom_algebra::rotation::Rotation;
use carom_algebra::unknowns::Unknowns;
use carom_bodies::{Body, height};
use carom_contact::law::Level;
use carom_contact::{Contact, Integration, Target};
use carom_mesh::{Face, Mesh};
use carom_schemes::Scheme;

use crate::adaptive::Adaptive;
use crate::assemblies::Assemblies;
use crate::contact_pair::ContactPair;
use crate::links::Links;
use crate::mass::Mass;
use crate::modal::NumberedModal;
use crate::moment_arms::MomentArms;
use crate::numbered::NumberedNonlinear;
use crate::reported::ReportedSupport;

/// The immutable side of a run.
#[derive(Debug)]
pub struct System {
    /// The mesh, in m; of a part that a rank has, that of the whole model.
    pub mesh: Arc<Mesh>,
    /// Dimension of space.
    pub dim: usize,
    /// Which unknowns each node has, and where.
    pub unknowns: Unknowns,
    /// Where places count from in what rounding leaves in forces, m: zero, since gaps are differences of places; without
    /// contacts the corner of the mesh nearest to it, since bodies and links do not see where they lie.
    pub origin: [f64; 3],
    /// The point that moments and angular momenta are about, m: the point of the box around the mesh that is nearest to the origin of
    /// coordinates, which is that itself where the box holds it. Arms are then no longer than the model is large, wherever it lies.
    pub about: [f64; 3],
    /// Whether bodies are axisymmetric: x is then a radius.
    pub axisymmetric: bool,
    /// Reference coordinates by system number, m.
    pub x: Vec<[f64; 3]>,
    /// Mesh node of each system node. Nodes of one connected part follow each other.
    pub mesh_node: Vec<u32>,
    /// System number of each mesh node; `u32::MAX` where no body uses it.
    pub number: Vec<u32>,
    /// Unknowns of each connected part: bodies that touch only by contact are different parts.
    pub parts: Vec<Range<usize>>,
    /// The part of each body.
    pub part_of_body: Vec<usize>,
    /// The parts that may act on each other, and the frames in which their energies are told.
    pub assemblies: Assemblies,
    /// Whether moments of the forces on the nodes of each part are about their undeformed places: those of parts whose bodies all
    /// have small displacements, point masses and springs aside. Their internal forces have no moment about these.
    pub undeformed: Vec<bool>,
    /// What forces act on.
    pub arms: MomentArms,
    /// Supports whose forces are reported.
    pub supports: Vec<ReportedSupport>,
    /// Bodies.
    pub bodies: Vec<Body>,
    /// Whether there are springs: their forces may have a resultant.
    pub has_springs: bool,
    /// Whether a static stage tightens bolts.
    pub has_bolts: bool,
    /// Whether there are dashpots.
    pub has_dashpots: bool,
    /// Number of nodes of the whole model.
    pub nodes_of_whole: usize,
    /// Diagonal of the box around the largest connected piece of each body in the reference configuration, m, with what shares nodes with it; zero without extent.
    pub diagonals: Vec<f64>,
    /// Lumped masses of the nodes of each body (system number, kg), for mean velocities.
    pub body_masses: Vec<Vec<(u32, f64)>>,
    /// Mass matrix.
    pub mass: Mass,
    /// Damping of modes.
    pub modal: Vec<NumberedModal>,
    /// Σ α M over the bodies with the factors α of Rayleigh's damping, kg/s.
    pub damping_mass: Option<Mass>,
    /// Unknowns of contact nodes without mass, ascending: they follow their equilibrium.
    pub massless: Vec<u32>,
    /// Whether an unknown is held at zero.
    pub fixed: Vec<bool>,
    /// Dead load, N.
    pub load: Vec<f64>,
    /// Contacts.
    pub contacts: Vec<ContactPair>,
    /// Whether each contact point is at a sharp edge or corner of its surface.
    pub sharp: Vec<bool>,
    /// Length of the model that counts as none, m: 1e-12 of its length ([`Model::length`](crate::Model::length)), or the
    /// rounding of its coordinates ([`Mesh::rounding`](carom_mesh::Mesh::rounding)) where that is larger.
    pub tolerance: f64,
    /// Time scheme; of several the first one.
    pub scheme: Scheme,
    /// The time schemes, each once.
    pub schemes: Vec<Scheme>,
    /// Which of them each body has.
    pub zone_of_body: Vec<usize>,
    /// Links and constraints.
    pub links: Links,
    /// Unknowns that follow each other and have one scheme, and its number; ascending.
    pub spans: Vec<(Range<usize>, usize)>,
    /// Step, s; the largest of an adaptive step.
    pub dt: f64,
    /// Rules of an adaptive step; `None` for equal steps.
    pub adaptive: Option<Adaptive>,
    /// The fraction of the critical step that explicit steps at finite strain are to be at most, as elements deform; none where the size
    /// is that of the model as long as it is stable.
    pub critical_fraction: Option<f64>,
    /// Loads and motions in time, damping, the static stage, and the rules of the iterations.
    pub nonlinear: NumberedNonlinear,
    /// The motion at the start.
    pub initial: InitialMotion,
    /// The same in its static stage, where bodies that wait for the dynamics are held and bolts have no stiffness; none without both.
    pub staged: Option<Arc<System>>,
}

/// The motion of a system at the start.
#[derive(Clone, Debug, Default)]
pub struct InitialMotion {
    /// Displacement, m.
    pub displacement: Vec<f64>,
    /// Velocity, m/s; zero where an unknown is held.
    pub velocity: Vec<f64>,
    /// Rotations of the nodes that have any.
    pub frames: Vec<Rotation>,
}

impl System {
    /// Smallest size of an element normal to the surfaces of a contact, of both its sides, m. Of a shell or a beam that others touch half the way to its
    /// middle, a quarter of its thickness: a point that has crossed that is on the other side, and is seen as one that never was inside. Not so where
    /// solids and shells see each other: solids tell on which side they are.
    pub fn depth_of_elements(&self, contact: usize) -> f64 {
        let primary = match &self.contacts[contact].target {
            Target::Surface(faces) => &faces[..],
            Target::Rigid(_) => &[],
        };
        let faces = self.contacts[contact]
            .secondary_faces
            .iter()
            .map(|face| (face, false));
        let faces = faces.chain(primary.iter().map(|face| (face, true)));
        let both = self.contacts[contact].looks_both_ways();
        let turns = !both || primary.iter().all(Face::is_round);
        let sizes = faces.map(|(face, touched)| {
            if touched && turns && face.is_round() {
                return 0.5 * face.radius.unwrap_or(0.0);
            }
            if let Some(radius) = face.radius.filter(|radius| *radius > 0.0) {
                return 2.0 * radius;
            }
            let nodes = face.corners().iter();
            let nodes: Vec<u32> = nodes.map(|&node| self.mesh_node[node as usize]).collect();
            height(&self.mesh, face.parent, face.kind, &nodes)
        });
        sizes.fold(f64::INFINITY, f64::min)
    }

    /// Whether steps may end with impulses of a contact that are in no force.
    pub fn has_impulses(&self, contact: usize) -> bool {
        self.contacts[contact].law.projects() || self.scheme.get().restores_contact_work()
    }

    /// Whether a side of a contact has several bodies that move apart: what two bodies do to each other is then not told apart.
    pub fn is_of_many(&self, contact: usize) -> bool {
        self.contacts[contact].is_of_many
    }

    /// Tangents of a contact point in problems with friction: none where no contact has any.
    pub fn tangents(&self) -> usize {
        match self.contacts.iter().any(|contact| contact.friction.acts()) {
            true => self.dim.saturating_sub(1),
            false => 0,
        }
    }

    /// Whether a contact of finite sliding is paired where the iterations of a dynamic step are: the geometry of bodies at small strain
    /// without friction is that in which the step captures it. A stop or another law with a compliance on an obstacle is no such
    /// contact: its force belongs to the instant of the internal forces, and with the normal of another instant a mass in orbit in a
    /// bore would gain or lose angular momentum in each step, in proportion to the step.
    pub fn pairs_anew(&self, contact: usize) -> bool {
        let mut bodies = self.contacts[contact].bodies.iter();
        let finite = bodies.any(|&body| self.bodies[body].has_finite_motion());
        let contact = &self.contacts[contact];
        let mortar = matches!(contact.integration, Integration::Mortar { .. });
        let compliant = contact.law.get().level() == Level::GapAndRate;
        let round = matches!(contact.target, Target::Rigid(_)) && contact.turns();
        finite || mortar || contact.moves() || contact.friction.acts() || compliant && round
    }

    /// The number of the scheme of the secondary side of a contact.
    pub fn zone_of(&self, contact: usize) -> usize {
        self.zone_of_body[self.contacts[contact].secondary_body]
    }

    /// The number of the scheme of an unknown.
    pub fn zone_at(&self, unknown: usize) -> usize {
        let span = self.spans.partition_point(|(span, _)| span.end <= unknown);
        self.spans[span].1
    }

    /// Steps of the static stage before the dynamics; 0 without one. Time is no time in them: it says what loads and motions are.
    pub fn static_steps(&self) -> u64 {
        self.nonlinear.preload.map_or(0, |preload| preload.steps)
    }

    /// Number of unknowns, held ones included.
    pub fn unknowns(&self) -> usize {
        self.fixed.len()
    }

    /// The connected part of an unknown.
    pub fn part_of(&self, unknown: usize) -> usize {
        part_of(&self.parts, unknown)
    }

    /// Number of contact points over all contacts.
    pub fn points(&self) -> usize {
        self.contacts.last().map_or(0, |contact| contact.range.end)
    }

    /// Contact points of a contact in the arrays over all points.
    pub fn points_of(&self, contact: usize) -> Range<usize> {
        self.contacts[contact].range.clone()
    }

    /// Index of the contact of a contact point.
    pub fn contact_of(&self, point: usize) -> usize {
        self.contacts
            .partition_point(|contact| contact.range.end <= point)
    }

    /// Gap below which a point counts as closed, m.
    pub fn tolerance_at(&self, point: usize) -> f64 {
        self.contacts[self.contact_of(point)].tolerance
    }

    /// The contact and the place in it of a contact point.
    pub fn point(&self, point: usize) -> (&Contact, usize) {
        let contact = self.contact_of(point);
        (
            &self.contacts[contact],
            point - self.contacts[contact].range.start,
        )
    }

    /// Mean velocity of a body, Σ m v / Σ m over its nodes, m/s.
    pub fn mean_velocity(&self, body: usize, v: &[f64]) -> [f64; 3] {
        if let Body::Reduced(reduced) = &self.bodies[body] {
            let momentum = |axis| reduced.inertia(axis).map(|(i, m)| m * v[i]).sum::<f64>();
            return [0, 1, 2].map(|axis| momentum(axis) / self.body_mass(body));
        }
        let (mut momentum, mut total) = ([0.0; 3], 0.0);
        for &(node, m) in &self.body_masses[body] {
            total += m;
            let v = self.unknowns.vector(node, v);
            for i in 0..3 {
                momentum[i] += m * v[i];
            }
        }
        momentum.map(|p| p / total)
    }

    /// Nodes of a range of unknowns that has all of theirs.
    pub fn nodes_of(&self, unknowns: &Range<usize>) -> Range<usize> {
        let [first, last] = [unknowns.start, unknowns.end - 1];
        self.unknowns.node(first) as usize..self.unknowns.node(last) as usize + 1
    }

    /// Mass of a body, kg.
    pub fn body_mass(&self, body: usize) -> f64 {
        self.body_masses[body].iter().map(|(_, m)| m).sum()
    }

    /// Acceleration of the frame of coordinates at a time in s, m/s².
    pub fn base_acceleration(&self, time: f64) -> [f64; 3] {
        let base = &self.nonlinear.base;
        [0, 1, 2].map(|i| base[i].as_ref().map_or(0.0, |a| a.at(time)))
    }

    /// Acceleration of the frame at the instant to which the accelerations of a step belong that ends at `time` and lasts `dt`
    /// (both s): the end, or of schemes whose state has no acceleration the instant of their balance. The sum of both is the
    /// absolute acceleration, m/s².
    pub fn frame_acceleration(&self, time: f64, dt: f64) -> [f64; 3] {
        self.base_acceleration(instant(&self.scheme, time, dt))
    }

    /// The instant to which the acceleration of an unknown belongs after such a step, s.
    pub fn instant_of(&self, unknown: usize, time: f64, dt: f64) -> f64 {
        let span = self.spans.partition_point(|(span, _)| span.end <= unknown);
        let zone = self.spans.get(span).map_or(0, |(_, zone)| *zone);
        instant(self.schemes.get(zone).unwrap_or(&self.scheme), time, dt)
    }

    /// As [`Model::is_nonlinear`](crate::Model::is_nonlinear).
    pub fn is_nonlinear(&self) -> bool {
        self.nonlinear.needed
    }

    /// Whether the residual of the balance of energy tells what is not balanced: by the identity of the scheme, or where all works are known.
    pub fn closes_energy(&self) -> bool {
        self.is_nonlinear() || self.scheme.get().energy_identity(self.dt).is_some()
    }

    /// Whether a step of any scheme has several stages.
    pub fn has_stages(&self) -> bool {
        let staged = |scheme: &Scheme| scheme.get().stages().len() > 1;
        self.schemes.iter().any(staged)
    }

    /// Whether any force is one of damping: of dashpots, of Rayleigh's damping or of that of modes.
    pub fn has_damping(&self) -> bool {
        let none = crate::nonlinear::Damping::default();
        let damped = self.nonlinear.damping.iter().any(|body| *body != none);
        self.has_dashpots || damped || !self.modal.is_empty()
    }

    /// The part of the histories of all bodies ([`Motion::history`](crate::Motion::history)) that is a body's; empty of a law
    /// without.
    pub fn history<'a>(&self, body: usize, histories: &'a [f64]) -> &'a [f64] {
        let range = self.nonlinear.histories.get(body).cloned();
        range.and_then(|range| histories.get(range)).unwrap_or(&[])
    }

    /// Histories of all materials where nothing has happened.
    pub fn start_histories(&self) -> Vec<f64> {
        let ranges = &self.nonlinear.histories;
        let mut histories = vec![0.0; ranges.last().map_or(0, |range| range.end)];
        for (body, range) in self.bodies.iter().zip(ranges) {
            body.start_history(&mut histories[range.clone()]);
        }
        histories
    }
}

/// The connected part of an unknown.
pub(crate) fn part_of(parts: &[Range<usize>], unknown: usize) -> usize {
    parts.partition_point(|part| part.end <= unknown)
}

/// The instant to which the accelerations of this scheme belong after a step of `dt` that ends at `time`, s.
fn instant(scheme: &Scheme, time: f64, dt: f64) -> f64 {
    let scheme = scheme.get();
    match scheme.keeps_acceleration() || dt == 0.0 {
        true => time,
        false => time - dt + scheme.step_map(dt).instant(dt),
    }
}
