//! Everything from which a system is built.

use std::sync::Arc;

use carom_algebra::unknowns::Kind;
use carom_arlequin::Row;
use carom_bodies::{BodySpec, DiscreteKind, DiscreteSpec, Inertia, MassKind, Reduction, Rotations};
use carom_contact::{Friction, Initial, Integration, Law, Obstacle, Parts, Sliding};
use carom_mesh::{Mesh, Surface};
use carom_schemes::Scheme;

use crate::adaptive::Adaptive;
use crate::modal::ModalDamping;
use crate::nonlinear::Nonlinear;

/// Everything from which a system is built; names are those of the case file.
#[derive(Clone, Debug)]
pub struct Model {
    /// The mesh, in m.
    pub mesh: Mesh,
    /// Bodies.
    pub bodies: Vec<ModelBody>,
    /// Point masses, springs and dashpots. In the system they are bodies as well, after the others.
    pub discrete: Vec<ModelDiscrete>,
    /// Supports.
    pub supports: Vec<Support>,
    /// Supports and motions whose forces are reported, by their names.
    pub named_supports: Vec<NamedSupport>,
    /// Acceleration of gravity, m/s².
    pub gravity: [f64; 3],
    /// Contacts.
    pub contacts: Vec<ModelContact>,
    /// Time scheme.
    pub scheme: Scheme,
    /// Bodies with another scheme.
    pub zones: Vec<ModelScheme>,
    /// Links between velocities of bodies.
    pub links: Vec<ModelLink>,
    /// Linear constraints between unknowns.
    pub constraints: Vec<ModelConstraint>,
    /// Step in s; the largest of an adaptive step.
    pub dt: f64,
    /// Rules of an adaptive step; `None` for equal steps.
    pub adaptive: Option<Adaptive>,
    /// The fraction of the critical step that the step is; see [`System::critical_fraction`](crate::System::critical_fraction).
    pub critical_fraction: Option<f64>,
    /// Loads and motions in time, damping, a static stage, and how the iterations of a step are solved.
    pub nonlinear: Nonlinear,
}

impl Model {
    /// Bodies that nothing holds, loads or touches, in equal steps of `dt` (s).
    pub fn new(bodies: Vec<ModelBody>, mesh: Mesh, scheme: Scheme, dt: f64) -> Model {
        Model {
            mesh,
            bodies,
            discrete: Vec::new(),
            supports: Vec::new(),
            named_supports: Vec::new(),
            gravity: [0.0; 3],
            contacts: Vec::new(),
            scheme,
            zones: Vec::new(),
            links: Vec::new(),
            constraints: Vec::new(),
            dt,
            adaptive: None,
            critical_fraction: None,
            nonlinear: Nonlinear::default(),
        }
    }

    /// The time scheme of a body.
    pub(crate) fn scheme_of(&self, body: usize) -> Scheme {
        let mut zones = self.zones.iter();
        let zone = zones.find(|zone| zone.bodies.contains(&body));
        zone.map_or(self.scheme, |zone| zone.scheme)
    }

    /// Whether bodies have different schemes.
    pub(crate) fn mixes_schemes(&self) -> bool {
        let first = (!self.bodies.is_empty()).then(|| self.scheme_of(0));
        (1..self.bodies.len()).any(|body| Some(self.scheme_of(body)) != first)
    }
}

/// A time scheme of some bodies, which no other body shares nodes with.
#[derive(Clone, Debug)]
pub struct ModelScheme {
    /// Their indices in the model.
    pub bodies: Vec<usize>,
    /// The scheme.
    pub scheme: Scheme,
}

/// Rows `C_c v_c - C_s v_s = 0` between two zones: an overlap, or a common border.
#[derive(Clone, Debug)]
pub struct ModelLink {
    /// Name as in the case file.
    pub name: String,
    /// Zones of the inner and of the outer terms.
    pub zones: [usize; 2],
    /// The rows, on nodes of the mesh.
    pub rows: Vec<Row>,
}

impl ModelLink {
    /// Whether a row joins translations with rotations of nodes that turn by any angle, in a mesh of the dimension `dim`: its coefficients are then
    /// arms, which turn too.
    pub fn has_arms(&self, dim: usize, turns: &dyn Fn(u32) -> bool) -> bool {
        self.rows.iter().any(|row| {
            let all = || row.inner.iter().chain(&row.outer);
            let rotates = |term: &carom_arlequin::Term| term.component as usize >= dim;
            all().any(|term| rotates(term) && turns(term.node)) && !all().all(rotates)
        })
    }
}

/// Linear constraints `Σ c v = 0` between the velocities of unknowns, held by multipliers.
#[derive(Clone, Debug)]
pub struct ModelConstraint {
    /// Name as in the case file.
    pub name: String,
    /// Terms of each row: a node of the mesh, which of its unknowns, and the coefficient c, in m of rotations.
    pub rows: Vec<Vec<(u32, Kind, f64)>>,
}

impl ModelConstraint {
    /// A rigid link: nodes move with another one as parts of a rigid body that turns by small angles,
    /// `u = u₀ + θ₀ × (x - x₀)`, and their rotations, if `turns`, are θ₀. A first node without rotations
    /// (`leads` is false) gives its translation only.
    pub fn rigid_link(
        name: impl Into<String>,
        mesh: &Mesh,
        first: u32,
        nodes: &[(u32, bool)],
        leads: bool,
    ) -> ModelConstraint {
        let (dim, mut rows) = (mesh.dim, Vec::new());
        let axes = if dim == 2 { 2..3 } else { 0..3 };
        for &(node, turns) in nodes {
            let [x, from] = [node, first].map(|node| mesh.nodes[node as usize]);
            let arm = [0, 1, 2].map(|i| x[i] - from[i]);
            for i in 0..dim {
                let mut row = vec![
                    (node, Kind::Translation(i), 1.0),
                    (first, Kind::Translation(i), -1.0),
                ];
                // (θ × r)_i = θ_j r_k - θ_k r_j
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let turned = [(j, -arm[k]), (k, arm[j])].into_iter();
                let turned = turned.filter(|(axis, c)| leads && axes.contains(axis) && *c != 0.0);
                row.extend(turned.map(|(axis, c)| (first, Kind::Rotation(axis), c)));
                rows.push(row);
            }
            for axis in axes.clone().filter(|_| turns && leads) {
                rows.push(vec![
                    (node, Kind::Rotation(axis), 1.0),
                    (first, Kind::Rotation(axis), -1.0),
                ]);
            }
        }
        ModelConstraint {
            name: name.into(),
            rows,
        }
    }
}

impl ModelConstraint {
    /// The rows of a coupling: inner terms less outer ones. `dim`: of the mesh.
    pub fn of_rows(name: impl Into<String>, rows: &[Row], dim: usize) -> ModelConstraint {
        let kind = |component: u32| match component as usize {
            k if k < dim => Kind::Translation(k),
            _ if dim == 2 => Kind::Rotation(2),
            k => Kind::Rotation(k - dim),
        };
        let of = |row: &Row| {
            let inner = row.inner.iter().map(|t| (t, t.coefficient));
            let outer = row.outer.iter().map(|t| (t, -t.coefficient));
            let terms = inner.chain(outer);
            terms.map(|(t, c)| (t.node, kind(t.component), c)).collect()
        };
        ModelConstraint {
            name: name.into(),
            rows: rows.iter().map(of).collect(),
        }
    }
}

impl Model {
    /// The same in its static stage, where it differs there: `waiting` nodes are held, and bolts have no stiffness.
    pub(crate) fn staged(&self, waiting: Vec<u32>) -> Option<Model> {
        self.nonlinear.preload?;
        if waiting.is_empty() && !self.has_bolts() {
            return None;
        }
        let mut model = self.clone();
        model.supports.push(Support {
            nodes: waiting,
            fix: [true; 3],
            fix_rotations: [true; 3],
        });
        let cells = model.bodies.iter_mut();
        for cell in cells.flat_map(|body| &mut body.spec.tightened) {
            cell.tightens = true;
        }
        let layers = model.bodies.iter_mut();
        for layer in layers.flat_map(|body| &mut body.spec.layers) {
            layer.tightens = true;
        }
        for some in &mut model.discrete {
            if let DiscreteKind::Bolt(bolt) = &mut some.spec.kind {
                bolt.tightens = true;
            }
        }
        Some(model)
    }

    /// Whether a static stage tightens bolts.
    fn has_bolts(&self) -> bool {
        let is_bolt = |some: &ModelDiscrete| matches!(some.spec.kind, DiscreteKind::Bolt(_));
        let tightened =
            |body: &ModelBody| !body.spec.tightened.is_empty() || !body.spec.layers.is_empty();
        self.discrete.iter().any(is_bolt) || self.bodies.iter().any(tightened)
    }

    /// The length that absolute tolerances are fractions of, m: the size of the mesh. Of a mesh without extent, such as a single
    /// point mass, the largest of initial displacements and gaps, and of the ways of the first step; 1 where all are zero.
    pub fn length(&self) -> f64 {
        let size = self.mesh.size();
        if size > 0.0 {
            return size;
        }
        let norm = |x: &[f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let gaps = self.contacts.iter().map(|contact| match contact.initial {
            Initial::Gap(gap) | Initial::Further(gap) => gap.abs(),
            _ => 0.0,
        });
        let discrete = self.discrete.iter().flat_map(|some| {
            let velocity = some.velocity.map_or(0.0, |v| self.dt * norm(&v));
            [some.displacement.map_or(0.0, |u| norm(&u)), velocity]
        });
        let falls = self.dt * self.dt * norm(&self.gravity);
        let largest = gaps.chain(discrete).fold(falls, f64::max);
        if largest > 0.0 { largest } else { 1.0 }
    }
}

/// A body and its initial state.
#[derive(Clone, Debug)]
pub struct ModelBody {
    /// Elements, kinematics, material.
    pub spec: BodySpec,
    /// Lumped or consistent mass.
    pub mass: MassKind,
    /// Initial velocity of all its nodes, m/s.
    pub velocity: [f64; 3],
    /// Initial displacement of all its nodes, m.
    pub displacement: [f64; 3],
    /// Initial angular velocity of beams with finite rotations about the axes of coordinates, about the mean place of their nodes,
    /// rad/s.
    pub spin: [f64; 3],
    /// What it is as a rigid body; its cells then only say which nodes it carries.
    pub rigid: Option<ModelRigid>,
    /// What it is reduced to: retained nodes and modes.
    pub reduced: Option<Arc<Reduction>>,
    /// Damping of its modes.
    pub modal: Option<Arc<ModalDamping>>,
}

/// A rigid body and its initial rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelRigid {
    /// Mass, centre of mass, moments of inertia.
    pub inertia: Inertia,
    /// Initial angular velocity about the axes of coordinates, rad/s.
    pub spin: [f64; 3],
}

impl ModelBody {
    /// A body at rest, with lumped mass.
    pub fn new(spec: BodySpec) -> ModelBody {
        ModelBody {
            spec,
            mass: MassKind::Lumped,
            velocity: [0.0; 3],
            displacement: [0.0; 3],
            spin: [0.0; 3],
            rigid: None,
            reduced: None,
            modal: None,
        }
    }
}

/// Discrete elements of one kind, and the initial state of their nodes where it is not that of a body.
#[derive(Clone, Debug)]
pub struct ModelDiscrete {
    /// Cells and kind.
    pub spec: DiscreteSpec,
    /// Initial velocity of the nodes of masses, m/s.
    pub velocity: Option<[f64; 3]>,
    /// Initial displacement of the nodes of masses, m.
    pub displacement: Option<[f64; 3]>,
}

impl ModelDiscrete {
    /// Elements at rest, or with the state of the bodies of their nodes.
    pub fn new(spec: DiscreteSpec) -> ModelDiscrete {
        ModelDiscrete {
            spec,
            velocity: None,
            displacement: None,
        }
    }
}

/// Nodes that cannot move in some directions.
#[derive(Clone, Debug)]
pub struct Support {
    /// Nodes of the mesh.
    pub nodes: Vec<u32>,
    /// Translations held.
    pub fix: [bool; 3],
    /// Rotations held, of nodes that have any.
    pub fix_rotations: [bool; 3],
}

/// What a support of the case holds or moves.
#[derive(Clone, Debug)]
pub struct NamedSupport {
    /// Name as in the case file.
    pub name: String,
    /// Nodes of the mesh.
    pub nodes: Vec<u32>,
    /// Translations that it holds or moves.
    pub axes: [bool; 3],
    /// Rotations that it holds or moves.
    pub rotations: [bool; 3],
}

impl Support {
    /// Whether it holds unknowns of a kind.
    pub(crate) fn holds(&self, kind: Kind) -> bool {
        match kind {
            Kind::Translation(axis) => self.fix[axis],
            Kind::Rotation(axis) => self.fix_rotations[axis],
            Kind::Amplitude(_) => false,
        }
    }
}

/// A contact before numbering.
#[derive(Clone, Debug)]
pub struct ModelContact {
    /// Name as in the case file.
    pub name: String,
    /// Surface whose nodes carry the contact forces.
    pub secondary: Surface,
    /// What it faces.
    pub primary: ModelTarget,
    /// The law.
    pub law: Law,
    /// Extent of the sliding.
    pub sliding: Sliding,
    /// Where the law holds.
    pub integration: Integration,
    /// Whether the nodes of both surfaces give their mass to the other nodes of their bodies.
    pub massless: bool,
    /// Friction.
    pub friction: Friction,
    /// What is done about penetrations at the start.
    pub initial: Initial,
    /// Largest penetration that is a contact, m: points see only faces turned against them and not further away inside than
    /// this ([`Sight`](carom_contact::Sight)). `None`: they see everything, unless the surface faces itself.
    pub depth: Option<f64>,
    /// Whether gaps of points that are far from what they face are not looked for, in implicit steps as in explicit ones.
    pub near_only: bool,
    /// Whether contact is looked for both ways: nodes of the primary surface are points too, and in space sharp edges of solids that cross between
    /// their nodes. Of surfaces of solids, at nodes, with finite sliding; without deletion. Points that would tell what those of the other side tell
    /// leave it to these, and forces count for the secondary side. Of axes of beams and middles of shells against solids axes and sharp edges cross
    /// those of the solids, and nodes of one side are points.
    pub both_ways: bool,
    /// The bodies of the faces where a side has several, and which of them do not touch each other.
    pub parts: Option<Parts>,
    /// Duration of a flight that ends an impact, s; `None`: by waves and steps.
    pub merge_within: Option<f64>,
    /// The point that the moment of its forces is reported about, m; `None`: no moment is.
    pub moment_about: Option<[f64; 3]>,
}

impl ModelContact {
    /// A contact at nodes, of small sliding, without friction, and with penetrations at the start as they are.
    pub fn new(
        name: impl Into<String>,
        secondary: Surface,
        primary: ModelTarget,
        law: Law,
    ) -> ModelContact {
        ModelContact {
            name: name.into(),
            secondary,
            primary,
            law,
            sliding: Sliding::Small,
            integration: Integration::Node,
            massless: false,
            friction: Friction::default(),
            initial: Initial::Keep,
            depth: None,
            near_only: false,
            both_ways: false,
            parts: None,
            moment_about: None,
            merge_within: None,
        }
    }
}

/// What a secondary surface faces.
#[derive(Clone, Debug)]
pub enum ModelTarget {
    /// A surface of deformable bodies.
    Surface(Surface),
    /// A rigid obstacle.
    Rigid(Obstacle),
}

impl ModelTarget {
    /// A rigid obstacle, at rest if it is given by its shape.
    pub fn rigid(obstacle: impl Into<Obstacle>) -> ModelTarget {
        ModelTarget::Rigid(obstacle.into())
    }
}

impl Model {
    /// Whether it has a pressure or traction, a motion in time, damping, a static stage, friction, mortar, a body at finite
    /// strain or with finite rotations, an obstacle that moves, or a scheme with forces between two states: the energy of its steps is then balanced
    /// by works, not by the identity of the scheme, and a step of fixed size that fails is taken in halves.
    pub fn is_nonlinear(&self) -> bool {
        self.nonlinear.asks()
            || self.bodies.iter().any(is_finite)
            || self.bodies.iter().any(damped)
            || self.discrete.iter().any(|some| !some.spec.is_linear())
            || self.scheme.get().is_between()
            || self.scheme.get().energy_identity(self.dt).is_none()
            || self.mixes_schemes()
            || self.contacts.iter().any(needs_newton)
    }
}

/// Whether a body is rigid, at finite strain, or has finite rotations.
pub(crate) fn is_finite(body: &ModelBody) -> bool {
    let turns = body.spec.kinematics.rotations() == Some(Rotations::Finite);
    body.rigid.is_some() || body.spec.material.finite().is_some() || turns
}

pub(crate) fn damped(body: &ModelBody) -> bool {
    let reduced = body.reduced.as_ref();
    body.modal.is_some() || reduced.is_some_and(|reduced| reduced.matrices.damping.is_some())
}

pub(crate) fn needs_newton(contact: &ModelContact) -> bool {
    let moves = matches!(&contact.primary, ModelTarget::Rigid(obstacle) if obstacle.motion.moves());
    contact.friction.acts() || moves || matches!(contact.integration, Integration::Mortar { .. })
}
