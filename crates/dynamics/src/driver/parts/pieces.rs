//! Pieces: unknowns that move as a rigid body where nothing deforms them.
//!
//! In a static stage they are the parts of the model that only contacts hold, and in a part that springs or constraints join the groups of
//! nodes that only contacts keep from moving against others: two plates with a bolt between them are one part.

use std::ops::Index;

use carom_bodies::Reduced;

use crate::system::System;

/// The piece of an unknown that is in none.
const NONE: u32 = u32::MAX;

/// Unknowns that move as one.
pub(crate) struct Piece {
    /// Its unknowns, ascending.
    pub(crate) unknowns: Vec<usize>,
    /// Its nodes, ascending.
    pub(crate) nodes: Vec<u32>,
    /// Whether it turns by finite angles: a body at small strain does not, and one with supports turns about them.
    pub(crate) spins: bool,
}

/// Pieces, none of which has an unknown of another.
#[derive(Default)]
pub(crate) struct Pieces {
    all: Vec<Piece>,
    /// The piece of each unknown; empty without pieces.
    of: Vec<u32>,
}

impl Index<usize> for Pieces {
    type Output = Piece;

    fn index(&self, piece: usize) -> &Piece {
        &self.all[piece]
    }
}

impl Pieces {
    /// The parts of a system.
    pub(crate) fn of_parts(system: &System) -> Pieces {
        let nodes = system.parts.iter().map(|part| system.nodes_of(part));
        let nodes = nodes.map(|nodes| nodes.map(|node| node as u32).collect());
        Pieces::new(system, nodes.collect())
    }

    /// `nodes`: of each piece, ascending.
    pub(crate) fn new(system: &System, nodes: Vec<Vec<u32>>) -> Pieces {
        if nodes.is_empty() {
            return Pieces::default();
        }
        let mut pieces = Pieces {
            all: Vec::new(),
            of: vec![NONE; system.unknowns()],
        };
        for nodes in nodes {
            let unknowns = nodes.iter().flat_map(|&node| system.unknowns.of(node));
            let unknowns: Vec<usize> = unknowns.collect();
            for &unknown in &unknowns {
                pieces.of[unknown] = pieces.all.len() as u32;
            }
            pieces.all.push(Piece {
                spins: !unknowns.iter().any(|&unknown| system.fixed[unknown]),
                unknowns,
                nodes,
            });
        }
        pieces.stiffen(system);
        pieces
    }

    /// Keeps those with bodies at small strain from turning by finite angles.
    fn stiffen(&mut self, system: &System) {
        for (body, masses) in system.bodies.iter().zip(&system.body_masses) {
            if body.has_finite_motion() {
                continue;
            }
            let own = body.as_reduced().map_or(&[][..], Reduced::nodes);
            for &node in masses.iter().map(|(node, _)| node).chain(own) {
                // nodes that a reduced body has not retained have no unknowns
                let first = system.unknowns.of(node).next();
                if let Some(piece) = first.and_then(|unknown| self.of(unknown)) {
                    self.all[piece].spins = false;
                }
            }
        }
    }

    /// Number of pieces.
    pub(crate) fn len(&self) -> usize {
        self.all.len()
    }

    /// Whether there is none.
    pub(crate) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// All of them.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Piece> {
        self.all.iter()
    }

    /// All their unknowns, piece by piece.
    pub(crate) fn unknowns(&self) -> impl Iterator<Item = usize> + '_ {
        self.all.iter().flat_map(|piece| &piece.unknowns).copied()
    }

    /// The piece of an unknown, if it is in one.
    #[inline]
    pub(crate) fn of(&self, unknown: usize) -> Option<usize> {
        let piece = self.of.get(unknown).copied().unwrap_or(NONE);
        (piece != NONE).then_some(piece as usize)
    }
}
