//! When a step is one of central differences with lumped mass, in which nothing is iterated, and what it needs.

use carom_algebra::unknowns::Kind;

use crate::blocks::{Block, blocks};
use crate::groups::{Groups, OfGroup};
use crate::scheme::EnergyIdentity;
use crate::step_map::{Impulse, Row, StepMap};
use crate::system::System;
use crate::update::Sums;

/// What such steps need beside the state.
pub(super) struct Direct {
    /// Mass of each node, kg.
    pub(super) mass: Vec<f64>,
    /// Displacement of the step after the next, m, if that is as long as the one that was taken last.
    pub(super) ahead: Vec<f64>,
    /// With which row it was found in the attempt.
    pub(super) pending: Option<Row>,
    /// The same once the attempt is the state.
    pub(super) ready: Option<Row>,
    pub(super) blocks: Vec<Block>,
    /// Sums of each block.
    pub(super) sums: Vec<Sums>,
    /// Sums of each connected part.
    pub(super) parts: Vec<Sums>,
    /// Whether there are loads that are always the same.
    pub(super) loaded: bool,
    /// Whether neither the state nor the state before it has contact forces, and the unknown of the iterations is zero.
    pub(super) clean: bool,
    /// Whether the motion of the attempt is known to be finite.
    pub(super) finite: bool,
    pub(super) apart: Apart,
}

/// What the contact problem of such steps needs.
pub(super) struct Apart {
    pub(super) groups: Groups,
    /// The candidates, group after group.
    pub(super) points: Vec<u32>,
    /// Acceleration without contact forces of their unknowns, m/s²; other entries have no meaning.
    pub(super) free: Vec<f64>,
    /// D of one group, and a number that no other has.
    pub(super) of_group: OfGroup,
    pub(super) version: u64,
}

impl Default for Apart {
    fn default() -> Apart {
        Apart {
            groups: Groups::default(),
            points: Vec::new(),
            free: Vec::new(),
            of_group: OfGroup::default(),
            // those of kept columns count from zero
            version: 1 << 63,
        }
    }
}

impl Direct {
    /// None where forces or motions of the system are others than those of solids, loads and contacts.
    pub(super) fn of(system: &System) -> Option<Direct> {
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
        let free = system.nonlinear.follows.is_empty()
            && system.link_rows.is_empty()
            && !system.has_damping()
            && system.adaptive.is_none();
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
                loaded: system.load.iter().any(|load| *load != 0.0),
                clean: false,
                finite: false,
                apart: Apart::default(),
            }
        })
    }

    /// The sums of the whole system; leaves those of the parts.
    pub(super) fn gather(&mut self, axisymmetric: bool) -> Sums {
        self.parts.fill(Sums::default());
        for (block, sums) in self.blocks.iter().zip(&self.sums) {
            self.parts[block.part].add(sums);
        }
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
pub(super) fn is_leapfrog(map: &StepMap, identity: &EnergyIdentity) -> bool {
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
