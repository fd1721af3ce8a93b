//! Where nodal forces act: what their resultant and their moment about the origin need of a node.

use std::ops::Range;

use carom_algebra::basis::Amplitude;
use carom_algebra::unknowns::Unknowns;

/// A node with unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lever {
    /// Its number.
    pub node: u32,
    /// Its first unknown: translations come before rotations.
    pub first: u32,
    /// Whether it has rotations about the axes of coordinates.
    pub bends: bool,
    /// Whether moments are about its undeformed place ([`System::undeformed`](crate::System::undeformed)).
    pub undeformed: bool,
}

/// All that forces act on, or what some of them act on.
#[derive(Clone, Debug, PartialEq)]
pub struct MomentArms {
    /// The nodes with translations, ascending.
    pub nodes: Vec<Lever>,
    /// The amplitudes, each with its unknown.
    pub amplitudes: Vec<(usize, Amplitude)>,
    /// The nodes with finite rotations, each with the place of its frame.
    pub turning: Vec<(usize, u32)>,
}

impl MomentArms {
    /// `parts`: unknowns of each part, and whether it is undeformed.
    pub(crate) fn new<'a>(
        unknowns: &Unknowns,
        parts: impl Iterator<Item = (&'a Range<usize>, &'a bool)>,
    ) -> MomentArms {
        let of_part = |(part, undeformed): (&'a Range<usize>, &'a bool)| {
            let [first, last] = [part.start, part.end - 1].map(|unknown| unknowns.node(unknown));
            let nodes = (first..=last).filter(|node| !unknowns.translations_of(*node).is_empty());
            nodes.map(move |node| Lever {
                node,
                first: unknowns.first(node) as u32,
                bends: !unknowns.rotations_of(node).is_empty() && unknowns.frame(node).is_none(),
                undeformed: *undeformed,
            })
        };
        let amplitudes = unknowns.amplitudes();
        let mut nodes: Vec<_> = parts.flat_map(of_part).collect();
        nodes.shrink_to_fit();
        MomentArms {
            nodes,
            amplitudes: amplitudes.map(|(unknown, of)| (unknown, *of)).collect(),
            turning: unknowns.turning().iter().copied().enumerate().collect(),
        }
    }

    /// Those that have unknowns among the given ones.
    pub(crate) fn among(&self, unknowns: &Unknowns, has: impl Fn(usize) -> bool) -> MomentArms {
        let has_node = |node: u32| unknowns.of(node).any(&has);
        let nodes = self.nodes.iter().filter(|lever| has_node(lever.node));
        let amplitudes = self.amplitudes.iter().filter(|(unknown, _)| has(*unknown));
        let turning = self.turning.iter().filter(|(_, node)| has_node(*node));
        MomentArms {
            nodes: nodes.copied().collect(),
            amplitudes: amplitudes.copied().collect(),
            turning: turning.copied().collect(),
        }
    }
}
