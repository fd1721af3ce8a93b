//! When a step is one of central differences with lumped mass, in which nothing is iterated, and what it needs.

use carom_algebra::unknowns::Kind;

use crate::blocks::{Block, blocks};
use crate::driver::contacts::span::Span;
use crate::driver::links::direct_links::DirectLinks;
use crate::groups::Groups;
use crate::scheme::EnergyIdentity;
use crate::step_map::{Impulse, Row, StepMap};
use crate::system::System;
use crate::update::Sums;

/// What such steps need beside the state.
pub(crate) struct Direct {
    /// Mass of each node, kg.
    pub(crate) mass: Vec<f64>,
    /// Displacement of the step after the next, m, if that is as long as the one that was taken last.
    pub(crate) ahead: Vec<f64>,
    /// With which row it was found in the attempt.
    pub(crate) pending: Option<Row>,
    /// The same once the attempt is the state.
    pub(crate) ready: Option<Row>,
    pub(crate) blocks: Vec<Block>,
    /// The block of the node that was last told to be touched.
    last: usize,
    /// Sums of each block.
    pub(crate) sums: Vec<Sums>,
    /// Sums of each connected part.
    pub(crate) parts: Vec<Sums>,
    /// Whether there are loads that are always the same.
    pub(crate) loaded: bool,
    /// Whether it is known which blocks have contact forces, and the unknown of the iterations is zero.
    pub(crate) clean: bool,
    /// Whether the motion of the attempt is known to be finite.
    pub(crate) finite: bool,
    pub(crate) apart: Apart,
    pub(crate) links: DirectLinks,
}

/// What the contact problem of such steps needs.
#[derive(Default)]
pub(crate) struct Apart {
    pub(crate) groups: Groups,
    /// The candidates, group after group.
    pub(crate) points: Vec<u32>,
    /// Acceleration without contact forces of their unknowns, m/s²; other entries have no meaning.
    pub(crate) free: Vec<f64>,
    /// The groups in as many parts as there are threads, or fewer.
    pub(crate) spans: Vec<Span>,
}

/// Candidates that are worth a thread.
const WORTH: usize = 128;

impl Apart {
    /// Bytes of the largest D so far.
    pub(crate) fn bytes(&self) -> usize {
        self.spans.iter().map(Span::bytes).max().unwrap_or(0)
    }

    /// Shares the groups out: to each thread some that follow each other, with about as many candidates. What is found does not depend on
    /// who solves it.
    pub(crate) fn share(&mut self) {
        let candidates = self.groups.order().len();
        let most = rayon::current_num_threads().min(candidates / WORTH).max(1);
        self.spans.resize_with(most, Span::default);
        for span in &mut self.spans {
            span.groups.clear();
        }
        for group in self.groups.ranges() {
            let span = group.start * most / candidates.max(1);
            self.spans[span.min(most - 1)].groups.push(group);
        }
    }
}

impl Direct {
    /// None where forces or motions of the system are others than those of solids, their damping, loads, contacts, and links that meet no
    /// contact.
    pub(crate) fn of(system: &System) -> Option<Direct> {
        let (dim, unknowns) = (system.dim, &system.unknowns);
        let moves = |i: usize| matches!(unknowns.kind(i), Kind::Translation(_));
        let plain = unknowns.len() == dim * unknowns.nodes()
            && (0..unknowns.nodes()).all(|node| unknowns.first(node as u32) == dim * node)
            && (0..unknowns.len()).all(moves);
        let solids = system.bodies.iter().all(|body| body.as_solid().is_some());
        let lumped = &system.mass.lumped;
        let even = |mass: &[f64]| mass.iter().all(|own| *own == mass[0]);
        let mass =
            system.mass.is_lumped() && system.massless.is_empty() && lumped.chunks(dim).all(even);
        let free = system.nonlinear.follows.is_empty() && system.adaptive.is_none();
        let links = DirectLinks::of(system)?;
        (plain && solids && mass && free).then(|| {
            let blocks = blocks(system);
            Direct {
                mass: lumped.iter().step_by(dim).copied().collect(),
                ahead: vec![0.0; unknowns.len()],
                pending: None,
                ready: None,
                sums: vec![Sums::default(); blocks.len()],
                parts: vec![Sums::default(); system.parts.len()],
                blocks,
                last: 0,
                loaded: system.load.iter().any(|load| *load != 0.0),
                clean: false,
                finite: false,
                apart: Apart::default(),
                links,
            }
        })
    }

    /// Leaves no contact forces at the end of the step, `forces`, where there may be some of an earlier one. `known`: whether the blocks tell
    /// where.
    pub(crate) fn clear(&mut self, known: bool, dim: usize, forces: &mut [f64]) {
        for block in &mut self.blocks {
            if !known {
                block.touched = [true; 2];
            }
            if std::mem::take(&mut block.touched[1]) {
                block.nodes.clear(dim, forces);
            }
        }
    }

    /// Tells that there is a contact force on a node at the end of the step.
    pub(crate) fn touch(&mut self, node: usize) {
        let holds = |block: &Block| block.nodes.contain(node);
        if !self.blocks.get(self.last).is_some_and(holds) {
            // those whose sums count are ascending, and the others behind them
            let counted = self.blocks.partition_point(|block| block.counts);
            let (own, others) = self.blocks.split_at(counted);
            let of = |blocks: &[Block]| blocks.partition_point(|block| block.nodes.first() <= node);
            self.last = of(own).saturating_sub(1);
            if !own.get(self.last).is_some_and(holds) {
                self.last = counted + of(others).saturating_sub(1);
            }
        }
        if let Some(block) = self.blocks.get_mut(self.last) {
            block.touched[1] = true;
        }
    }

    /// Makes the end of the step the start of the next, whose end has the room of the start before.
    pub(crate) fn go_on(&mut self) {
        self.ready = self.pending.take();
        for block in &mut self.blocks {
            block.touched.swap(0, 1);
        }
    }

    /// Sums of the parts from those of the blocks.
    pub(crate) fn sum_parts(&mut self) {
        self.parts.fill(Sums::default());
        let blocks = self.blocks.iter().zip(&self.sums);
        for (block, sums) in blocks.filter(|(block, _)| block.counts) {
            self.parts[block.part].add(sums);
        }
    }

    /// The sums of the whole system from those of the parts.
    pub(crate) fn total(&self, axisymmetric: bool) -> Sums {
        let mut all = Sums::default();
        for part in &self.parts {
            all.add(part);
        }
        if axisymmetric {
            all.of_axisymmetric();
        }
        all
    }
}

/// Whether a step of this map is one of central differences, whose balance of energy has this identity.
pub(crate) fn is_leapfrog(map: &StepMap, identity: &EnergyIdentity) -> bool {
    let Impulse { old, new, .. } = map.impulse;
    let own = EnergyIdentity {
        inertia: identity.inertia,
        old,
        new,
        ..EnergyIdentity::default()
    };
    let known = |row: &Row| row.x == 0.0 && row.m == 0.0 && row.c == 0.0;
    known(&map.displacement)
        && map.displacement.u == 1.0
        && map.force == map.displacement
        && map.inertia == Row::UNKNOWN
        && map.acceleration == Row::UNKNOWN
        && (map.velocity.u, map.velocity.m) == (0.0, 0.0)
        && map.force_fraction == Some(1.0)
        && map.contact == 1.0
        && map.impulse == Impulse::weights(old, new)
        && map.contact_impulse == map.impulse
        && !map.has_memory()
        && !map.uses_contact_acceleration()
        && *identity == own
}
