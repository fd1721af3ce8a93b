//! Supports whose forces are reported: which held unknowns are whose.

use std::ops::Range;

use carom_algebra::unknowns::{Kind, Unknowns};

use crate::model::NamedSupport;

/// A support with the unknowns that it holds or moves.
#[derive(Clone, Debug, PartialEq)]
pub struct ReportedSupport {
    /// Name as in the case file.
    pub name: String,
    /// Mean place of its nodes in the reference configuration, m: moments are about it.
    pub centre: [f64; 3],
    /// Its unknowns. One that several supports hold belongs to the first of them.
    pub held: Vec<HeldUnknown>,
}

/// An unknown with a prescribed value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldUnknown {
    /// Its number.
    pub unknown: u32,
    /// Whether moments are about its undeformed place ([`System::undeformed`](crate::System::undeformed)).
    pub undeformed: bool,
}

impl ReportedSupport {
    /// Those of a model, but for supports with a node of a reduced body that is not retained: no unknown has its force. `number`: system numbers of the mesh nodes; `parts`: unknowns of each part, and whether it is undeformed.
    pub(crate) fn all(
        supports: &[NamedSupport],
        (number, x): (&[u32], &[[f64; 3]]),
        (unknowns, fixed): (&Unknowns, &[bool]),
        parts: &[(Range<usize>, bool)],
    ) -> Vec<ReportedSupport> {
        let mut taken = vec![false; fixed.len()];
        let undeformed = |unknown: usize| {
            let mut parts = parts.iter();
            parts.any(|(part, undeformed)| part.contains(&unknown) && *undeformed)
        };
        let mut one = |support: &NamedSupport| {
            let numbers = support.nodes.iter().map(|&node| number[node as usize]);
            let nodes: Vec<u32> = numbers.filter(|&node| node != u32::MAX).collect();
            let mut held = Vec::new();
            for node in &nodes {
                if unknowns.of(unknowns.moved_by(*node)).is_empty() {
                    return None;
                }
                for unknown in unknowns.of(unknowns.moved_by(*node)) {
                    let holds = match unknowns.kind(unknown) {
                        Kind::Translation(axis) => support.axes[axis],
                        Kind::Rotation(axis) => support.rotations[axis],
                        Kind::Amplitude(_) => false,
                    };
                    if holds && fixed[unknown] && !std::mem::replace(&mut taken[unknown], true) {
                        held.push(HeldUnknown {
                            unknown: unknown as u32,
                            undeformed: undeformed(unknown),
                        });
                    }
                }
            }
            let count = nodes.len().max(1) as f64;
            let sum = nodes.iter().fold([0.0; 3], |sum, node| {
                let place = x[*node as usize];
                [0, 1, 2].map(|i| sum[i] + place[i])
            });
            Some(ReportedSupport {
                name: support.name.clone(),
                centre: sum.map(|s| s / count),
                held,
            })
        };
        supports.iter().filter_map(&mut one).collect()
    }
}
