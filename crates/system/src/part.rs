//! The part of a system that one of several ranks has: its own elements, with their nodes and those of all contacts.
//!
//! Nodes, elements and contact points stay in the order of the whole, so that lists of them that several ranks make are in one order. What is known
//! of a body or a contact as a whole stays as it is: names, bodies and points of contacts, sizes, the mesh.

use std::ops::Range;
use std::sync::Arc;

use carom_algebra::unknowns::Unknowns;
use carom_bodies::{Body, Solid, by_kind};
use carom_mesh::ElementId;

use crate::build::Nodes;
use crate::contact_pair::ContactPair;
use crate::error::Error;
use crate::links::Links;
use crate::mass::Mass;
use crate::model::{Model, ModelTarget};
use crate::moment_arms::{Lever, MomentArms};
use crate::moments::MomentAbout;
use crate::numbered::NumberedNonlinear;
use crate::numbered_loads::{NumberedForce, NumberedLoad};
use crate::reported::{HeldUnknown, ReportedSupport};
use crate::system::{InitialMotion, System};

/// Nodes of the mesh that elements of a rank have, and those of all contacts; and the first face of each load, whose body gives its thickness.
fn near(model: &Model, (cells, ranks): (&[Vec<ElementId>], &[Vec<u32>]), rank: u32) -> Vec<bool> {
    let mesh = &model.mesh;
    let mut near = vec![false; mesh.nodes.len()];
    let mut mark = |nodes: &[u32]| nodes.iter().for_each(|node| near[*node as usize] = true);
    for (cells, ranks) in cells.iter().zip(ranks) {
        let own = cells.iter().zip(ranks).filter(|(_, of)| **of == rank);
        own.for_each(|(cell, _)| mark(mesh.element_nodes(*cell)));
    }
    for contact in &model.contacts {
        mark(&contact.secondary.nodes);
        contact
            .secondary
            .faces
            .iter()
            .for_each(|face| mark(face.corners()));
        if let ModelTarget::Surface(primary) = &contact.primary {
            primary.faces.iter().for_each(|face| mark(face.corners()));
        }
    }
    let loads = model.nonlinear.loads.iter();
    let faces = loads.filter_map(|load| load.surface.faces.first());
    faces.for_each(|face| mark(mesh.element_nodes(face.parent)));
    near
}

/// What a rank keeps of a system, by its numbers there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Kept {
    /// Nodes, ascending: those of the elements and of all contacts among them.
    pub nodes: Vec<u32>,
    /// Elements of each body by their places, ascending.
    pub elements: Vec<Vec<u32>>,
}

/// The numbers of the whole in a part.
struct Renumbering<'a> {
    kept: &'a [u32],
    /// Number of each node of the whole; `u32::MAX` of one that is not kept.
    number: Vec<u32>,
    dim: usize,
}

impl<'a> Renumbering<'a> {
    fn new(system: &System, kept: &'a [u32]) -> Renumbering<'a> {
        let mut number = vec![u32::MAX; system.x.len()];
        for (&node, own) in kept.iter().zip(0..) {
            number[node as usize] = own;
        }
        Renumbering {
            kept,
            number,
            dim: system.dim,
        }
    }

    fn of(&self, node: u32) -> u32 {
        self.number[node as usize]
    }

    /// Its number, if the node is kept.
    fn find(&self, node: u32) -> Option<u32> {
        Some(self.of(node)).filter(|node| *node != u32::MAX)
    }

    /// The number of an unknown, if its node is kept.
    fn unknown(&self, unknown: u32) -> Option<u32> {
        let dim = self.dim as u32;
        Some(dim * self.find(unknown / dim)? + unknown % dim)
    }

    /// Entries of the kept nodes, one of each unknown.
    fn pick<T: Copy>(&self, vector: &[T]) -> Vec<T> {
        let of_node = |&node: &u32| &vector[self.dim * node as usize..][..self.dim];
        self.kept.iter().flat_map(of_node).copied().collect()
    }

    /// Unknowns among those of some nodes that follow each other.
    fn range(&self, unknowns: &Range<usize>) -> Range<usize> {
        let before = |end: usize| {
            let node = end.div_ceil(self.dim);
            self.dim * self.kept.partition_point(|&own| (own as usize) < node)
        };
        before(unknowns.start)..before(unknowns.end)
    }

    fn arms(&self, arms: &MomentArms) -> MomentArms {
        let nodes = arms.nodes.iter().filter_map(|lever| {
            let node = self.find(lever.node)?;
            Some(Lever {
                node,
                first: self.dim as u32 * node,
                ..*lever
            })
        });
        MomentArms {
            nodes: nodes.collect(),
            amplitudes: Vec::new(),
            turning: Vec::new(),
        }
    }
}

impl System {
    /// Of a model whose whole another rank has, the elements of a rank, with those that share a node with them or with a contact: so that
    /// masses and loads of the nodes of the rank and of all contacts are those of the whole. `ranks`: of the elements of each body, solids in the
    /// order of [`Solid::cells`](carom_bodies::Solid::cells). With them come the places of the elements of each body in that order.
    ///
    /// # Errors
    /// As [`System::new`], but for what is asked of schemes and masses.
    pub fn around(
        mut model: Model,
        ranks: &[Vec<u32>],
        rank: u32,
    ) -> Result<(System, Vec<Vec<u32>>), Error> {
        let mut nodes = Nodes::of(&mut model)?;
        let mesh = &model.mesh;
        let cells = model
            .bodies
            .iter()
            .map(|body| by_kind(mesh, &body.spec.cells));
        let cells: Vec<Vec<ElementId>> = cells.collect();
        let near = near(&model, (&cells, ranks), rank);
        let (mut has, mut places) = (vec![false; mesh.nodes.len()], Vec::new());
        for (body, cells) in model.bodies.iter_mut().zip(cells) {
            let nodes_of = |place: usize| mesh.element_nodes(cells[place]);
            let is_near = |place: usize| nodes_of(place).iter().any(|node| near[*node as usize]);
            // no body is without any
            let own = (0..cells.len()).filter(|place| *place == 0 || is_near(*place));
            let own: Vec<usize> = own.collect();
            for node in own.iter().flat_map(|place| nodes_of(*place)) {
                has[*node as usize] = true;
            }
            body.spec.cells = own.iter().map(|place| cells[*place]).collect();
            places.push(own.into_iter().map(|place| place as u32).collect());
        }
        nodes.numbering.keep(&has);
        let (system, ..) = System::assemble_on(model, nodes)?;
        Ok((system, places))
    }

    /// What its parts are to know of the whole ([`System::know_whole`]), as numbers.
    pub fn facts_of_whole(&self) -> Vec<f64> {
        let mut facts = vec![self.nodes_of_whole as f64];
        facts.extend(self.origin);
        facts.extend(self.about);
        for (body, diagonal) in self.bodies.iter().zip(&self.diagonals) {
            let most_nodes = body.as_solid().map_or(1, Solid::most_nodes);
            facts.extend([body.smallest_size(), most_nodes as f64, *diagonal]);
        }
        facts.extend(self.supports.iter().flat_map(|support| support.centre));
        facts
    }

    /// Takes what the whole told of itself ([`System::facts_of_whole`]).
    pub fn know_whole(&mut self, facts: &[f64]) {
        let mut facts = facts.iter().copied();
        let mut next = || facts.next().unwrap_or_default();
        self.nodes_of_whole = next() as usize;
        self.origin = [0; 3].map(|_| next());
        self.about = [0; 3].map(|_| next());
        for (body, diagonal) in self.bodies.iter_mut().zip(&mut self.diagonals) {
            let sizes = (next(), next() as usize);
            if let Body::Solid(solid) = body {
                solid.know_whole(sizes);
            }
            *diagonal = next();
        }
        for support in &mut self.supports {
            support.centre = [0; 3].map(|_| next());
        }
    }

    /// The part of it that a rank has: of solids whose nodes have translations alone, with lumped mass, without links, damping and unknowns that
    /// follow a function.
    pub fn part(&self, kept: &Kept) -> System {
        let to = Renumbering::new(self, &kept.nodes);
        let unknowns = Unknowns::translations(self.dim, kept.nodes.len());
        let number = |node: u32| to.of(node);
        let bodies = self.bodies.iter().zip(&kept.elements);
        let bodies = bodies.filter_map(|(body, places)| {
            let solid = body.as_solid()?;
            Some(Body::Solid(solid.part(places.clone(), number, &unknowns)))
        });
        let bodies: Vec<Body> = bodies.collect();
        let of_body = |masses: &Vec<(u32, f64)>| {
            let own = masses.iter();
            own.filter_map(|&(node, mass)| Some((to.find(node)?, mass)))
                .collect()
        };
        let nodes = || kept.nodes.iter().map(|node| *node as usize);
        System {
            mesh: Arc::clone(&self.mesh),
            dim: self.dim,
            origin: self.origin,
            about: self.about,
            axisymmetric: self.axisymmetric,
            x: nodes().map(|node| self.x[node]).collect(),
            mesh_node: nodes().map(|node| self.mesh_node[node]).collect(),
            number: self
                .number
                .iter()
                .map(|&node| match node {
                    u32::MAX => node,
                    node => to.of(node),
                })
                .collect(),
            parts: self.parts.iter().map(|part| to.range(part)).collect(),
            part_of_body: self.part_of_body.clone(),
            undeformed: self.undeformed.clone(),
            arms: to.arms(&self.arms),
            supports: self.supports.iter().map(|of| of_support(of, &to)).collect(),
            nonlinear: of_nonlinear(&self.nonlinear, &bodies, &to),
            bodies,
            has_springs: self.has_springs,
            has_bolts: self.has_bolts,
            has_dashpots: self.has_dashpots,
            nodes_of_whole: self.nodes_of_whole,
            assemblies: self.assemblies.clone(),
            diagonals: self.diagonals.clone(),
            body_masses: self.body_masses.iter().map(of_body).collect(),
            mass: Mass::of_diagonal(to.pick(&self.mass.lumped)),
            modal: Vec::new(),
            damping_mass: None,
            massless: Vec::new(),
            fixed: to.pick(&self.fixed),
            load: to.pick(&self.load),
            contacts: self
                .contacts
                .iter()
                .map(|contact| of_contact(contact, &to))
                .collect(),
            sharp: self.sharp.clone(),
            tolerance: self.tolerance,
            scheme: self.scheme,
            schemes: self.schemes.clone(),
            zone_of_body: self.zone_of_body.clone(),
            links: Links::default(),
            spans: self
                .spans
                .iter()
                .map(|(span, zone)| (to.range(span), *zone))
                .collect(),
            dt: self.dt,
            adaptive: self.adaptive,
            critical_fraction: self.critical_fraction,
            initial: InitialMotion {
                displacement: to.pick(&self.initial.displacement),
                velocity: to.pick(&self.initial.velocity),
                frames: Vec::new(),
            },
            staged: None,
            unknowns,
        }
    }
}

fn of_contact(pair: &ContactPair, to: &Renumbering) -> ContactPair {
    let number = |node: u32| to.of(node);
    let faces = pair.secondary_faces.iter();
    let moment = pair.moment.as_ref();
    ContactPair {
        contact: pair.contact.renumbered(number),
        secondary_faces: faces.map(|face| face.renumbered(number)).collect(),
        moment: moment.map(|moment| MomentAbout {
            point: moment.point,
            arms: to.arms(&moment.arms),
        }),
        ..pair.clone()
    }
}

fn of_support(support: &ReportedSupport, to: &Renumbering) -> ReportedSupport {
    let held = support.held.iter().filter_map(|held| {
        Some(HeldUnknown {
            unknown: to.unknown(held.unknown)?,
            ..*held
        })
    });
    ReportedSupport {
        held: held.collect(),
        ..support.clone()
    }
}

fn of_nonlinear(given: &NumberedNonlinear, bodies: &[Body], to: &Renumbering) -> NumberedNonlinear {
    let mut first = 0;
    let histories = bodies.iter().map(|body| {
        let start = first;
        first += body.history_len();
        start..first
    });
    NumberedNonlinear {
        loads: given
            .loads
            .iter()
            .filter_map(|load| of_load(load, to))
            .collect(),
        load_names: given.load_names.clone(),
        base: given.base.clone(),
        amplitudes: given.amplitudes.clone(),
        follows: Vec::new(),
        damping: given.damping.clone(),
        preload: given.preload,
        iteration: given.iteration,
        histories: histories.collect(),
        needed: given.needed,
    }
}

/// A load on the kept nodes; none of one that follows its surface.
fn of_load(load: &NumberedLoad, to: &Renumbering) -> Option<NumberedLoad> {
    let NumberedForce::Dead(forces) = &load.force else {
        return None;
    };
    let own = forces.iter();
    let own = own.filter_map(|&(unknown, force)| Some((to.unknown(unknown)?, force)));
    Some(NumberedLoad {
        named: load.named,
        amplitude: load.amplitude.clone(),
        force: NumberedForce::Dead(own.collect()),
        bodies: load.bodies.clone(),
    })
}
