//! The mediator of a shell and a solid: whose shape functions are added up, and about which axes it turns.

use std::collections::BTreeMap;

use super::model::{Prisms, ShellModels};
use crate::cell::norm;
use crate::edge::across;
use crate::error::{Error, Model};
use crate::overlap::Overlap;
use crate::polytope::sub;

/// Part of the support of a function that lies in S, below which its node gets none of its own.
const SLIVER: f64 = 0.02;
/// Least distance of nodes of the mediator, in sizes of the cells of the solid.
const APART: f64 = 0.9;

/// A function of the mediator.
pub(super) struct Function {
    /// Its node.
    pub node: u32,
    /// The director there.
    pub director: [f64; 3],
    /// Axes of the rotations, across the director: in its order each is near one of those of coordinates, whose number it has.
    pub axes: [(usize, [f64; 3]); 2],
    /// Square root of h²/12, m.
    pub gyration: f64,
}

/// The functions, and of which each node of the shell is a part.
pub(super) struct Mediator {
    pub functions: Vec<Function>,
    pub of_node: BTreeMap<u32, usize>,
}

impl Mediator {
    /// `solid`: size of its cells along the middle surface, m.
    ///
    /// Errors: no node with enough of its support in S.
    pub fn new(
        models: &ShellModels,
        prisms: &Prisms,
        overlap: &Overlap,
        solid: f64,
    ) -> Result<Mediator, Error> {
        let mut supports: BTreeMap<u32, Support> = BTreeMap::new();
        let side = overlap.side(Model::Outer);
        for (place, &id) in side.ids.iter().enumerate() {
            let Some(element) = prisms.element(id) else {
                continue;
            };
            let shell = &models.shell[element];
            let inside = overlap.measure_in(Model::Outer, place);
            for (a, &node) in models.nodes(shell).iter().enumerate() {
                let own = supports.entry(node).or_insert(Support {
                    x: shell.x[a],
                    director: shell.directors[a],
                    gyration: shell.thickness / 12.0_f64.sqrt(),
                    inside: 0.0,
                    whole: 0.0,
                });
                own.inside += inside;
                own.whole += side.measures[place];
            }
        }
        supports.retain(|_, own| own.inside > 0.0);
        let mut centres: Vec<(u32, &Support)> = Vec::new();
        for (&node, own) in &supports {
            let near = |(_, other): &(u32, &Support)| own.distance(other) < APART * solid;
            if own.inside >= SLIVER * own.whole && !centres.iter().any(near) {
                centres.push((node, own));
            }
        }
        if centres.is_empty() {
            return Err(Error::NoMediator);
        }
        let nearest = |own: &Support| {
            let mut all = centres.iter().enumerate();
            let first = all.next().map_or(0.0, |(_, (_, c))| own.distance(c));
            let least = all.fold((0, first), |best, (k, (_, centre))| {
                let distance = own.distance(centre);
                if distance < best.1 {
                    (k, distance)
                } else {
                    best
                }
            });
            least.0
        };
        Ok(Mediator {
            of_node: supports
                .iter()
                .map(|(&node, own)| (node, nearest(own)))
                .collect(),
            functions: centres
                .iter()
                .map(|(node, own)| own.function(*node))
                .collect(),
        })
    }
}

struct Support {
    x: [f64; 3],
    director: [f64; 3],
    gyration: f64,
    /// Of the elements around, that in S and all, m³.
    inside: f64,
    whole: f64,
}

impl Support {
    fn distance(&self, other: &Support) -> f64 {
        norm(&sub(&self.x, &other.x))
    }

    fn function(&self, node: u32) -> Function {
        Function {
            node,
            director: self.director,
            axes: across(&self.director),
            gyration: self.gyration,
        }
    }
}
