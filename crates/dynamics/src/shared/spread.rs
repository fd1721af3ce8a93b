//! What all ranks are given of contacts where some are shared out by what their points may touch.

use std::ops::Range;

use carom_ranks::Ranks;

use super::contacts::{WHOLE, of_point};
use super::halo::{Halo, contact_nodes};
use super::homes::Homes;
use super::in_reach::InReach;
use crate::state::State;
use crate::system::{Motion, System};

/// Who is shown the numbers of a node or a point, and may change them.
type Visit<'a> = dyn FnMut(&mut f64) + 'a;

/// Vectors of a motion that a rank has to have where it begins to compute a node.
const VECTORS: usize = 5;

/// The nodes and points of all contacts, those of the first rank first; none where no contact is shared out so.
#[derive(Debug, Default)]
pub(super) struct Spread {
    nodes: Vec<u32>,
    /// Where those of each rank begin, and their end.
    of_nodes: Vec<usize>,
    points: Vec<u32>,
    of_points: Vec<usize>,
}

impl Spread {
    pub(super) fn new(system: &System, in_reach: &InReach, halo: &Halo, ranks: usize) -> Spread {
        let contacts = 0..system.contacts.len();
        if !contacts.clone().any(|contact| in_reach.has(contact)) {
            return Spread::default();
        }
        // those of other contacts go with the nodes that they share
        let mut nodes = contact_nodes(system, |_| true);
        let mut points: Vec<u32> = (0..system.points() as u32).collect();
        let of_nodes = by_rank(&mut nodes, &halo.owner, ranks);
        let of_points = by_rank(&mut points, &halo.homes.of_point, ranks);
        Spread {
            nodes,
            of_nodes,
            points,
            of_points,
        }
    }

    /// Gives all ranks the places of these nodes and the gaps of these points.
    pub(super) fn give_places(&self, ranks: &Ranks, dim: usize, state: &mut State) {
        let u = &mut state.motion.u;
        let of_nodes = (&self.nodes[..], &self.of_nodes[..], dim);
        give(ranks, of_nodes, &mut |node, visit| {
            u[dim * node..][..dim].iter_mut().for_each(visit);
        });
        let gaps = &mut state.interface.gap;
        let of_points = (&self.points[..], &self.of_points[..], 1);
        give(ranks, of_points, &mut |point, visit| {
            visit(&mut gaps[point])
        });
    }

    /// Gives all ranks the motion of the nodes and the states of the points that have other homes in `next`.
    pub(super) fn give(
        &self,
        (ranks, dim): (&Ranks, usize),
        [last, next]: [&Homes; 2],
        state: &mut State,
    ) {
        let moves = |node: u32| last.of_node(node as usize) != next.of_node(node as usize);
        let (nodes, starts) = some((&self.nodes, &self.of_nodes), moves);
        let motion = &mut state.motion;
        give(
            ranks,
            (&nodes, &starts, VECTORS * dim),
            &mut |node, visit| of_node(motion, dim, node, visit),
        );
        let moves = |point: u32| last.of_point[point as usize] != next.of_point[point as usize];
        let (points, starts) = some((&self.points, &self.of_points), moves);
        give(ranks, (&points, &starts, WHOLE), &mut |point, visit| {
            of_point(state, point, true, visit)
        });
    }
}

/// Some of the things of ranks, with where those of each begin.
fn some(
    (things, starts): (&[u32], &[usize]),
    which: impl Fn(u32) -> bool,
) -> (Vec<u32>, Vec<usize>) {
    let (mut some, mut of_some) = (Vec::new(), vec![0]);
    for ends in starts.windows(2) {
        let own = things[ends[0]..ends[1]].iter().copied();
        some.extend(own.filter(|&thing| which(thing)));
        of_some.push(some.len());
    }
    (some, of_some)
}

/// Gives all ranks `count` numbers of each of these things.
fn give(
    ranks: &Ranks,
    (things, starts, count): (&[u32], &[usize], usize),
    each: &mut dyn FnMut(usize, &mut Visit),
) {
    let mut values = vec![0.0; count * things.len()];
    let own = starts[ranks.rank()]..starts[ranks.rank() + 1];
    let mut visit = |range: Range<usize>, values: &mut [f64], gives: bool| {
        let mut values = values[count * range.start..count * range.end].iter_mut();
        for &thing in &things[range] {
            each(thing as usize, &mut |number| {
                if let Some(value) = values.next() {
                    match gives {
                        true => *value = *number,
                        false => *number = *value,
                    }
                }
            });
        }
    };
    visit(own.clone(), &mut values, true);
    let starts: Vec<usize> = starts.iter().map(|start| count * start).collect();
    ranks.gather(&mut values, &starts);
    visit(0..own.start, &mut values, false);
    visit(own.end..things.len(), &mut values, false);
}

/// Visits what a motion has of a node.
fn of_node(motion: &mut Motion, dim: usize, node: usize, visit: &mut Visit) {
    let Motion {
        u,
        v,
        a,
        internal_force,
        contact_force,
        ..
    } = motion;
    for vector in [u, v, a, internal_force, contact_force] {
        let entries = &mut vector[dim * node..][..dim];
        entries.iter_mut().for_each(&mut *visit);
    }
}

/// Orders things by their rank; where those of each rank begin, and their end.
fn by_rank(things: &mut [u32], rank: &[u32], ranks: usize) -> Vec<usize> {
    things.sort_by_key(|&thing| rank[thing as usize]);
    let starts = 0..=ranks as u32;
    let before = |first: u32| things.partition_point(|&thing| rank[thing as usize] < first);
    starts.map(before).collect()
}
