//! What the first rank is given of the others, where somebody looks.

use std::ops::Range;

use carom_ranks::{Message, Ranks};

use super::halo::{Halo, Parts, With, by_rank, contact_nodes, pack, unpack};
use crate::system::{Motion, System};

/// Who gives what: on the first rank lists by rank, on another its own.
#[derive(Debug, Default)]
pub(super) struct Whole {
    /// Nodes whose motion the first rank has after each step.
    watched: Vec<With>,
    /// Nodes of contacts that it does not have itself.
    touched: Vec<With>,
    /// All nodes that it does not have itself.
    all: Vec<With>,
    /// Where the histories of the elements are among those of all bodies.
    histories: Vec<(usize, Vec<Range<usize>>)>,
    room: Vec<Message>,
}

impl Whole {
    pub(super) fn new(system: &System, parts: &Parts, rank: usize) -> Whole {
        Whole {
            histories: histories(system, parts, rank),
            ..Whole::default()
        }
    }

    /// Takes the nodes of ranks as they are now.
    pub(super) fn take(&mut self, system: &System, (halo, rank): (&Halo, usize), watched: &[u32]) {
        let lists = |nodes: &mut dyn Iterator<Item = u32>| {
            let away = nodes.filter(|node| !halo.is_on_first(*node as usize));
            by_rank(away.map(|node| (node, halo.owner[node as usize])), rank)
        };
        self.watched = lists(&mut watched.iter().copied());
        self.touched = lists(&mut contact_nodes(system, |_| true).into_iter());
        self.all = lists(&mut (0..system.x.len() as u32));
    }
}

/// Where the histories of elements are, by rank on the first one, and on another its own; only of ranks with some.
fn histories(system: &System, parts: &Parts, rank: usize) -> Vec<(usize, Vec<Range<usize>>)> {
    let mut lists: Vec<(usize, Vec<Range<usize>>)> = Vec::new();
    for ((body, parts), range) in system
        .bodies
        .iter()
        .zip(parts)
        .zip(&system.nonlinear.histories)
    {
        let Some(solid) = body.as_solid().filter(|_| !range.is_empty()) else {
            continue;
        };
        let mut at = range.start;
        for (kept, &part) in solid.kept_of_elements().zip(parts) {
            let own = at..at + kept;
            at = own.end;
            let part = part as usize;
            if part == 0 || rank != 0 && part != rank {
                continue;
            }
            let with = if rank == 0 { part } else { 0 };
            let known = lists.iter().position(|(list, _)| *list == with);
            let place = known.unwrap_or_else(|| {
                lists.push((with, Vec::new()));
                lists.len() - 1
            });
            let ranges = &mut lists[place].1;
            match ranges.last_mut() {
                Some(last) if last.end == own.start => last.end = own.end,
                _ => ranges.push(own),
            }
        }
    }
    lists.sort_by_key(|(list, _)| *list);
    lists
}

impl Whole {
    /// Brings the motion of the watched nodes to the first rank.
    pub(super) fn watch(&mut self, ranks: &Ranks, dim: usize, motion: &mut Motion) {
        let vectors = &mut [&mut motion.u[..], &mut motion.v, &mut motion.a];
        let Whole { watched, room, .. } = self;
        collect(ranks, (watched, room), dim, vectors);
    }

    /// Brings the displacements of the nodes of contacts to the first rank.
    pub(super) fn gather_touched(&mut self, ranks: &Ranks, dim: usize, motion: &mut Motion) {
        let Whole { touched, room, .. } = self;
        collect(ranks, (touched, room), dim, &mut [&mut motion.u]);
    }

    /// Brings the velocities of all nodes at the start and the end of a step to the first rank.
    pub(super) fn gather_velocities(
        &mut self,
        ranks: &Ranks,
        dim: usize,
        velocities: [&mut [f64]; 2],
    ) {
        let Whole { all, room, .. } = self;
        collect(ranks, (all, room), dim, &mut { velocities });
    }

    /// Brings the motion of all nodes and the histories of all elements to the first rank.
    pub(super) fn gather(&mut self, ranks: &Ranks, dim: usize, motion: &mut Motion) {
        let Whole {
            all,
            histories,
            room,
            ..
        } = self;
        let Motion {
            u,
            v,
            a,
            internal_force,
            contact_force,
            history,
            ..
        } = motion;
        let vectors = &mut [&mut u[..], v, a, internal_force, contact_force];
        collect(ranks, (all, room), dim, vectors);
        let message = |(with, ranges): &(usize, Vec<Range<usize>>)| Message {
            with: *with,
            values: vec![0.0; ranges.iter().map(ExactSizeIterator::len).sum()],
        };
        let mut messages: Vec<Message> = histories.iter().map(message).collect();
        let is_first = ranks.is_first();
        let mut each = |messages: &mut [Message]| {
            for (message, (_, ranges)) in messages.iter_mut().zip(&*histories) {
                let mut values = &mut message.values[..];
                for range in ranges {
                    let (own, rest) = std::mem::take(&mut values).split_at_mut(range.len());
                    values = rest;
                    match is_first {
                        true => history[range.clone()].copy_from_slice(own),
                        false => own.copy_from_slice(&history[range.clone()]),
                    }
                }
            }
        };
        if is_first {
            ranks.exchange(&[], &mut messages, || ());
            each(&mut messages);
        } else {
            each(&mut messages);
            ranks.exchange(&messages, &mut [], || ());
        }
    }
}

/// Brings the entries of nodes in system vectors to the first rank.
fn collect(
    ranks: &Ranks,
    (lists, room): (&[With], &mut Vec<Message>),
    dim: usize,
    vectors: &mut [&mut [f64]],
) {
    room.resize_with(lists.len(), Message::default);
    for (message, list) in room.iter_mut().zip(lists) {
        message.with = list.rank;
        message
            .values
            .resize(vectors.len() * dim * list.nodes.len(), 0.0);
    }
    let is_first = ranks.is_first();
    let mut each = |room: &mut [Message]| {
        for (message, list) in room.iter_mut().zip(lists) {
            let length = (dim * list.nodes.len()).max(1);
            let pieces = message.values.chunks_exact_mut(length);
            for (values, vector) in pieces.zip(vectors.iter_mut()) {
                match is_first {
                    true => unpack(&list.nodes, dim, values, vector),
                    false => pack(&list.nodes, dim, vector, values),
                }
            }
        }
    };
    if is_first {
        ranks.exchange(&[], room, || ());
        each(room);
    } else {
        each(room);
        ranks.exchange(room, &mut [], || ());
    }
}
