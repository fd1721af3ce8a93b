//! The part of a system that one of several ranks has: its own elements, with their nodes and those of all contacts.
//!
//! Nodes, elements and contact points stay in the order of the whole, so that lists of them that several ranks make are in one order. What is known
//! of a body or a contact as a whole stays as it is: names, bodies and points of contacts, sizes, the mesh.

use std::ops::Range;
use std::sync::Arc;

use carom_algebra::unknowns::Unknowns;
use carom_bodies::Body;

use crate::levers::{Lever, Levers};
use crate::mass::Mass;
use crate::moments::MomentAbout;
use crate::numbered::NumberedNonlinear;
use crate::numbered_loads::{NumberedForce, NumberedLoad};
use crate::reported::{HeldUnknown, ReportedSupport};
use crate::system::System;
use crate::turning::TurningRows;

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

    fn levers(&self, levers: &Levers) -> Levers {
        let nodes = levers.nodes.iter().filter_map(|lever| {
            let node = self.find(lever.node)?;
            Some(Lever {
                node,
                first: self.dim as u32 * node,
                ..*lever
            })
        });
        Levers {
            nodes: nodes.collect(),
            amplitudes: Vec::new(),
            turning: Vec::new(),
        }
    }
}

impl System {
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
        let faces = self.secondary_faces.iter();
        let nodes = || kept.nodes.iter().map(|node| *node as usize);
        System {
            mesh: Arc::clone(&self.mesh),
            dim: self.dim,
            origin: self.origin,
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
            levers: to.levers(&self.levers),
            supports: self
                .supports
                .iter()
                .map(|of| of_support(of, &to))
                .collect(),
            nonlinear: of_nonlinear(&self.nonlinear, &bodies, &to),
            bodies,
            has_springs: self.has_springs,
            has_dashpots: self.has_dashpots,
            nodes_of_whole: self.nodes_of_whole,
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
                .map(|contact| contact.renumbered(number))
                .collect(),
            secondary_faces: faces
                .map(|faces| faces.iter().map(|face| face.renumbered(number)).collect())
                .collect(),
            sides: self.sides.clone(),
            touching: self.touching.clone(),
            of_many: self.of_many.clone(),
            first_point: self.first_point.clone(),
            tolerance: self.tolerance,
            scheme: self.scheme,
            schemes: self.schemes.clone(),
            zone_of_body: self.zone_of_body.clone(),
            links: Vec::new(),
            link_rows: Arc::default(),
            turning_rows: TurningRows::default(),
            inner_terms: Vec::new(),
            spans: self
                .spans
                .iter()
                .map(|(span, zone)| (to.range(span), *zone))
                .collect(),
            dt: self.dt,
            adaptive: self.adaptive,
            critical_fraction: self.critical_fraction,
            friction: self.friction.clone(),
            merge_within: self.merge_within.clone(),
            moments: self
                .moments
                .iter()
                .map(|of| {
                    let MomentAbout { point, levers } = of.as_ref()?;
                    Some(MomentAbout {
                        point: *point,
                        levers: to.levers(levers),
                    })
                })
                .collect(),
            initial_frames: Vec::new(),
            initial_displacement: to.pick(&self.initial_displacement),
            initial_velocity: to.pick(&self.initial_velocity),
            unknowns,
        }
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
