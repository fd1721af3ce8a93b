//! Rigid bodies in a system: their nodes, what these carry, and how they begin.

use std::collections::BTreeSet;

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::Vec3;
use carom_algebra::unknowns::{Carrier, Kind, NodeKind, Unknowns};
use carom_bodies::{Body, DiscreteKind, Kinematics, Rotations};
use carom_contact::{Frames, Places, Sliding};

use crate::contact_pair::ContactPair;
use crate::error::Error;
use crate::mid_surfaces::Carried;
use crate::model::{Model, ModelBody, ModelDiscrete};
use crate::motion::Motion;
use crate::refused::Refused;
use crate::system::System;

/// Which derivative of a place by time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// The place less the reference place.
    Displacement,
    /// The first.
    Velocity,
    /// The second.
    Acceleration,
}

impl Order {
    /// All three.
    pub const ALL: [Order; 3] = [Order::Displacement, Order::Velocity, Order::Acceleration];
}

/// Adds the centre of mass of each rigid or reduced body to the nodes of the mesh, for its unknowns; their numbers, by body.
pub(crate) fn add_centres(model: &mut Model) -> Vec<Option<u32>> {
    let nodes = &mut model.mesh.nodes;
    let mut add = |body: &ModelBody| {
        let of_rigid = body.rigid.map(|rigid| rigid.inertia.centre);
        let of_reduced = body.reduced.as_ref().map(|reduced| reduced.centre);
        nodes.push(of_rigid.or(of_reduced)?);
        Some(nodes.len() as u32 - 1)
    };
    model.bodies.iter().map(&mut add).collect()
}

/// The unknowns of all nodes, and the rotations of those that have any.
///
/// # Errors
/// A node that a rigid body shares with another body.
pub(crate) fn unknowns(
    model: &Model,
    (centres, carried): (&[Option<u32>], &[Carried]),
    number: &[u32],
    mesh_node: &[u32],
) -> Result<(Unknowns, Vec<Rotation>), Error> {
    let mut kinds = vec![NodeKind::Translations; mesh_node.len()];
    let mut frames = Vec::new();
    for rotations in [Rotations::Small, Rotations::Finite] {
        for body in &model.bodies {
            if body.spec.kinematics.rotations() != Some(rotations) {
                continue;
            }
            for node in nodes_of(model, body) {
                let kind = &mut kinds[number[node as usize] as usize];
                match (rotations, *kind) {
                    (Rotations::Small, _) => *kind = NodeKind::SmallRotations,
                    (Rotations::Finite, NodeKind::Turning) => {}
                    (Rotations::Finite, NodeKind::Translations) => {
                        *kind = NodeKind::Turning;
                        frames.push((number[node as usize], Rotation::IDENTITY));
                    }
                    (Rotations::Finite, _) => {
                        return Err(Error::Nonlinear {
                            what: Refused::FiniteRotations(body.spec.name.clone()),
                            why: "it shares a node with beams or shells of small rotations; give both finite ones",
                        });
                    }
                }
            }
        }
    }
    for node in turned_by_masses(model) {
        kinds[number[node as usize] as usize] = NodeKind::SmallRotations;
    }
    for (body, centre) in model.bodies.iter().zip(centres) {
        let (Some(reduced), Some(centre)) = (&body.reduced, *centre) else {
            continue;
        };
        for node in nodes_of(model, body) {
            if reduced.retained.binary_search(&node).is_err() {
                kinds[number[node as usize] as usize] = NodeKind::Recovered;
            }
        }
        let amplitudes = NodeKind::Amplitudes(reduced.amplitudes.len());
        kinds[number[centre as usize] as usize] = amplitudes;
    }
    for (body, centre) in model.bodies.iter().zip(centres) {
        let (Some(rigid), Some(centre)) = (body.rigid, *centre) else {
            continue;
        };
        let own = number[centre as usize];
        kinds[own as usize] = NodeKind::Turning;
        frames.push((own, rigid.inertia.axes));
        let (axes, nodes) = (rigid.inertia.axes.matrix(), nodes_of(model, body));
        if let Some(node) = shared(model, body, &nodes) {
            return Err(Error::Nonlinear {
                what: Refused::Rigid(body.spec.name.clone()),
                why: node,
            });
        }
        for node in nodes {
            let place = Vec3::from(model.mesh.nodes[node as usize]);
            let arm = axes.tr_mul(&(place - Vec3::from(rigid.inertia.centre)));
            kinds[number[node as usize] as usize] = NodeKind::Carried(Carrier {
                node: own,
                arm: arm.into(),
            });
        }
    }
    // nodes of shells have the axes of coordinates at the start
    for own in carried {
        let [place, of_carrier] =
            [own.node, own.by].map(|node| Vec3::from(model.mesh.nodes[node as usize]));
        kinds[number[own.node as usize] as usize] = NodeKind::Carried(Carrier {
            node: number[own.by as usize],
            arm: (place - of_carrier).into(),
        });
    }
    frames.sort_unstable_by_key(|(node, _)| *node);
    let frames = frames.into_iter().map(|(_, frame)| frame).collect();
    Ok((Unknowns::new(model.mesh.dim, kinds), frames))
}

/// Nodes of point masses with moments of inertia that no body has: their rotations are theirs alone.
fn turned_by_masses(model: &Model) -> BTreeSet<u32> {
    let has_inertia = |some: &&ModelDiscrete| match &some.spec.kind {
        DiscreteKind::Mass(point) => point.inertia != [0.0; 3],
        DiscreteKind::Spring(_)
        | DiscreteKind::Dashpot(_)
        | DiscreteKind::Fluid(_)
        | DiscreteKind::Bolt(_) => false,
    };
    let masses = model.discrete.iter().filter(has_inertia);
    let cells = masses.flat_map(|some| &some.spec.cells);
    let nodes: BTreeSet<u32> = cells
        .flat_map(|&cell| model.mesh.element_nodes(cell))
        .copied()
        .collect();
    if nodes.is_empty() {
        return nodes;
    }
    let of_bodies = model.bodies.iter().flat_map(|body| nodes_of(model, body));
    nodes.difference(&of_bodies.collect()).copied().collect()
}

fn nodes_of(model: &Model, body: &ModelBody) -> BTreeSet<u32> {
    let cells = body.spec.cells.iter();
    cells
        .flat_map(|&cell| model.mesh.element_nodes(cell))
        .copied()
        .collect()
}

/// Why another body must not have some of these nodes, if one does.
fn shared(model: &Model, body: &ModelBody, nodes: &BTreeSet<u32>) -> Option<&'static str> {
    let others = model
        .bodies
        .iter()
        .filter(|other| !std::ptr::eq(*other, body));
    let discrete = model.discrete.iter().flat_map(|some| &some.spec.cells);
    let mut cells = others.flat_map(|other| &other.spec.cells).chain(discrete);
    let shares = cells.any(|&cell| {
        let own = model.mesh.element_nodes(cell);
        own.iter().any(|node| nodes.contains(node))
    });
    shares.then_some("it has nodes in common with another body or a discrete element; give each its own nodes and let bodies touch by a contact")
}

/// Holds what a rigid body of revolution cannot do: it moves along the axis.
pub(crate) fn hold_axisymmetric(
    model: &Model,
    (bodies, unknowns): (&[Body], &Unknowns),
    fixed: &mut [bool],
) {
    for (body, given) in bodies.iter().zip(&model.bodies) {
        let Some(rigid) = body.as_rigid() else {
            continue;
        };
        if given.spec.kinematics == Kinematics::Axisymmetric {
            for unknown in unknowns.of(rigid.node()) {
                fixed[unknown] |= unknowns.kind(unknown) != Kind::Translation(1);
            }
        }
    }
}

/// Writes the initial angular velocities, about the axes of the frames. `masses`: nodes of each body.
pub(crate) fn spin(
    model: &Model,
    masses: &[Vec<(u32, f64)>],
    (unknowns, frames, x): (&Unknowns, &[Rotation], &[[f64; 3]]),
    v: &mut [f64],
) {
    for (body, masses) in model.bodies.iter().zip(masses) {
        if body.spin == [0.0; 3] {
            continue;
        }
        let whole: f64 = masses.iter().map(|(_, m)| m).sum();
        let mut centre = Vec3::zeros();
        for &(node, m) in masses {
            centre += Vec3::from(x[node as usize]) * (m / whole);
        }
        let spin = Vec3::from(body.spin);
        for &(node, _) in masses {
            let moved = spin.cross(&(Vec3::from(x[node as usize]) - centre));
            for unknown in unknowns.of(node) {
                match unknowns.kind(unknown) {
                    Kind::Translation(axis) => v[unknown] = body.velocity[axis] + moved[axis],
                    Kind::Rotation(axis) => v[unknown] = spin[axis],
                    Kind::Amplitude(_) => {}
                }
            }
        }
    }
    for (body, masses) in model.bodies.iter().zip(masses) {
        let (Some(rigid), Some(&(node, _))) = (body.rigid, masses.first()) else {
            continue;
        };
        let Some(frame) = unknowns.frame(node) else {
            continue;
        };
        let spin = frames[frame].matrix().tr_mul(&Vec3::from(rigid.spin));
        for unknown in unknowns.rotations_of(node) {
            if let Kind::Rotation(axis) = unknowns.kind(unknown) {
                v[unknown] = spin[axis];
            }
        }
    }
}

impl System {
    /// Where nodes are at a time (s) and a displacement, from these rotations on; those of the start are
    /// [`System::initial`].
    pub fn places<'a>(&'a self, time: f64, u: &'a [f64], frames: &'a [Rotation]) -> Places<'a> {
        Places {
            unknowns: &self.unknowns,
            time,
            x: &self.x,
            u,
            frames: Frames {
                start: frames,
                ..Frames::default()
            },
        }
    }

    /// Displacement (m), velocity (m/s) or acceleration (m/s²) of a node: of a carried one with the arm r and the angular
    /// velocity ω of its carrier `v + ω × r` and `a + ω̇ × r + ω × (ω × r)`.
    pub fn of_node(&self, node: u32, motion: &Motion, order: Order) -> [f64; 3] {
        let values = match order {
            Order::Displacement => &motion.u,
            Order::Velocity => &motion.v,
            Order::Acceleration => &motion.a,
        };
        let Some(carrier) = self.unknowns.carrier(node) else {
            return self.unknowns.vector(node, values);
        };
        let places = self.places(0.0, &motion.u, &motion.frames);
        let [place, centre] = [node, carrier.node].map(|node| Vec3::from(places.of(node)));
        let of_centre = Vec3::from(self.unknowns.vector(carrier.node, values));
        let start = self.x[node as usize];
        // small rotations are linear
        let arm = match self.unknowns.frame(carrier.node) {
            Some(_) => place - centre,
            None => Vec3::from(carrier.arm),
        };
        let turned = |values: &[f64]| -> Vec3 {
            let spin = Vec3::from(self.unknowns.spin(carrier.node, values));
            let Some(frame) = self.unknowns.frame(carrier.node) else {
                return spin;
            };
            let increment = self.unknowns.spin(carrier.node, &motion.u).into();
            let now = motion.frames.get(frame).copied().unwrap_or_default();
            now.then(&Rotation::cayley(&increment)).matrix() * spin
        };
        let moved = match order {
            Order::Displacement => place - Vec3::from(start),
            Order::Velocity => of_centre + turned(&motion.v).cross(&arm),
            Order::Acceleration if self.unknowns.frame(carrier.node).is_none() => {
                of_centre + turned(&motion.a).cross(&arm)
            }
            Order::Acceleration => {
                let spin = turned(&motion.v);
                of_centre + turned(&motion.a).cross(&arm) + spin.cross(&spin.cross(&arm))
            }
        };
        moved.into()
    }

    /// Whether a node is one of beams or shells with finite rotations.
    pub fn bends_at(&self, node: u32) -> bool {
        let bodies = self.bodies.iter().zip(&self.body_masses);
        let mut large = bodies.filter(|(body, _)| body.bends_finitely());
        large.any(|(_, masses)| masses.binary_search_by_key(&node, |(own, _)| *own).is_ok())
    }

    /// Whether an unknown is one of a node with a frame, empty without any, and the part by which the own response of points of such
    /// nodes grows.
    ///
    /// More than three such points on a plane have dependent rows: their compliance is singular, and their forces are not unique. The
    /// part makes them share their force, and leaves that part of the rates that they stop: far below the tolerance of the laws, and
    /// far above rounding, or with friction above what its solver leaves.
    pub fn rigid_points(&self) -> (Vec<bool>, f64) {
        const SMOOTH: f64 = 1e-11;
        const ROUGH: f64 = 1e-8;
        let turning = self.unknowns.turning();
        let count = if turning.is_empty() {
            0
        } else {
            self.unknowns.len()
        };
        let mut rigid = vec![false; count];
        for &node in turning.iter().filter(|&&node| !self.bends_at(node)) {
            rigid[self.unknowns.of(node)].fill(true);
        }
        (rigid, if self.tangents() > 0 { ROUGH } else { SMOOTH })
    }

    /// Refuses what nodes with finite rotations do not take.
    pub(crate) fn check_rotations(&self) -> Result<(), Error> {
        let large = |body: &&Body| matches!(body, Body::LargeBeam(_));
        let explicit = self.schemes.iter().any(|scheme| scheme.get().is_explicit());
        match self.bodies.iter().find(large) {
            Some(body) if explicit => Err(Error::Nonlinear {
                what: Refused::FiniteRotations(body.name().to_owned()),
                why: "an explicit step would take the moment W × J W at the velocity before it and keep neither energy nor \
                      angular momentum; take energy-momentum, theta, newmark, generalised-alpha or hht",
            }),
            _ => self.check_turning_rows().and_then(|()| self.check_rigid()),
        }
    }

    /// Refuses what rows that turn do not take.
    fn check_turning_rows(&self) -> Result<(), Error> {
        let Some(row) = self.links.turning.first() else {
            return Ok(());
        };
        let mut links = self.links.named.iter();
        let link = links.find(|(_, rows)| rows.contains(&row));
        let refuse = |why| {
            let name = link.map_or(String::new(), |(name, _)| name.clone());
            let what = Refused::TurningLink(name);
            Err(Error::Nonlinear { what, why })
        };
        let scheme = self.scheme.get();
        let staged = scheme.projects_predictor()
            || scheme.restores_contact_work()
            || scheme.step_map(self.dt).uses_contact_acceleration();
        let projects = |contact: &ContactPair| contact.law.projects();
        // rows of several schemes are those of the end of the step; moments must balance about the same axes
        let ends = |zone: usize| {
            let map = self.schemes[zone].get().step_map(self.dt);
            (map.instant(self.dt) - self.dt).abs() < 1e-12 * self.dt
        };
        let bodies = self.bodies.iter().zip(&self.zone_of_body);
        let mut turning = bodies.filter(|(body, _)| body.bends_finitely());
        if self.schemes.len() > 1 && !turning.all(|(_, zone)| ends(*zone)) {
            return refuse(
                "beside another scheme the body that turns needs one whose forces balance at the end of the step: newmark, or theta = 1",
            );
        }
        if scheme.step_map(self.dt).displacement.x == 0.0 {
            return refuse(
                "the rows hold places at the end of the step, which an explicit scheme knows before the forces; take energy-momentum, theta, \
                 newmark, hht or generalised-alpha",
            );
        }
        if staged || self.contacts.iter().any(projects) {
            return refuse(
                "stages of the step that use the mass alone take rows as they are at the start; take energy-momentum, theta, newmark, hht or \
                 generalised-alpha, and laws without projection",
            );
        }
        let linked = self.links.rows.iter().flatten();
        let mut parts = linked.map(|(unknown, _)| self.part_of(*unknown as usize));
        match parts.any(|part| self.undeformed[part]) {
            true => {
                refuse("a body at small strain does not turn; give it a material at finite strain")
            }
            false => Ok(()),
        }
    }

    /// Refuses what rigid bodies do not take.
    fn check_rigid(&self) -> Result<(), Error> {
        let Some(body) = self.bodies.iter().find_map(Body::as_rigid) else {
            return Ok(());
        };
        let why = |contact: &ContactPair| {
            let carried = |node: u32| self.unknowns.carrier(node).is_some();
            let mut own = contact.points.iter().flat_map(|point| point.carriers());
            let faces = match &contact.target {
                carom_contact::Target::Surface(faces) => &faces[..],
                carom_contact::Target::Rigid(_) => &[],
            };
            let mut nodes = faces.iter().flat_map(|face| face.corners());
            let rigid = own.any(|(node, _)| carried(node)) || nodes.any(|&node| carried(node));
            rigid && contact.sliding == Sliding::Small
        };
        let refuse = |why| {
            let what = Refused::Rigid(body.name().to_owned());
            Err(Error::Nonlinear { what, why })
        };
        if self.schemes.iter().any(|scheme| scheme.get().is_explicit()) {
            return refuse(
                "an explicit step would take the moment W × J W at the velocity before it and keep neither energy nor angular \
                 momentum; take theta, energy-momentum, newmark, generalised-alpha or hht",
            );
        }
        match self.contacts.iter().any(why) {
            true => refuse("its contacts turn with it; give them sliding = \"finite\""),
            false => Ok(()),
        }
    }
}
