//! Rigid motions of a part of the model that neither supports nor springs nor constraints hold.
//!
//! Bodies that share nodes move as one. A part may have several such groups, which springs and the rows of constraints join; their
//! motions against each other are asked for as well: no contact of the part as a whole would hold them, and rounding hides the zero pivots
//! that they leave in a matrix.

use std::collections::BTreeMap;
use std::ops::Range;

use carom_algebra::basis::Amplitude;
use carom_algebra::unknowns::Kind;
use carom_bodies::{Body, Reduced};

use super::rigid::{INDEPENDENT, Mode, ROUNDING, held_inside, modes, of_amplitude, turn_of};
use crate::system::System;

/// Nodes that move as one.
pub(crate) struct Group {
    /// Its nodes in the numbering of the system, ascending; those of a rigid body are with its centre.
    pub(crate) nodes: Vec<u32>,
    centre: [f64; 3],
    /// Largest distance of a node from the centre along an axis, m.
    size: f64,
}

/// The groups of a part.
pub(crate) struct Joined<'a> {
    system: &'a System,
    part: Range<usize>,
    pub(crate) groups: Vec<Group>,
    /// The group of each node from the first one of the part.
    group: Vec<usize>,
    first: u32,
    modes: Vec<Mode>,
    /// The amplitudes of the part, by unknown.
    amplitudes: BTreeMap<usize, &'a Amplitude>,
}

impl<'a> Joined<'a> {
    /// A part as one rigid body.
    ///
    /// `carried`: the nodes that each node carries.
    pub(crate) fn whole(
        of: (&'a System, &BTreeMap<u32, Vec<u32>>),
        part: &Range<usize>,
    ) -> Joined<'a> {
        Joined::new(of, part, |leaders| leaders.fill(0))
    }

    /// A part as the groups of nodes that elements join; those of a reduced body are one.
    pub(crate) fn apart(
        (system, carried): (&'a System, &BTreeMap<u32, Vec<u32>>),
        part: &Range<usize>,
    ) -> Joined<'a> {
        let first = system.nodes_of(part).start;
        let inside = |node: u32| part.contains(&system.unknowns.first(node));
        Joined::new((system, carried), part, |leaders| {
            for body in &system.bodies {
                let mut own = false;
                body.each_joining_element(&mut |nodes| {
                    own |= inside(nodes[0]);
                    for &node in nodes.iter().filter(|_| own) {
                        unite(leaders, [nodes[0], node].map(|n| n as usize - first));
                    }
                });
            }
        })
    }

    fn new(
        (system, carried): (&'a System, &BTreeMap<u32, Vec<u32>>),
        part: &Range<usize>,
        join: impl Fn(&mut [usize]),
    ) -> Joined<'a> {
        let nodes = system.nodes_of(part);
        let first = nodes.start as u32;
        let mut leaders: Vec<usize> = (0..nodes.len()).collect();
        join(&mut leaders);
        let mut number = vec![usize::MAX; leaders.len()];
        let mut members: Vec<Vec<u32>> = Vec::new();
        let mut group = vec![usize::MAX; leaders.len()];
        for node in nodes {
            let own = node - first as usize;
            let moved_by = system.unknowns.moved_by(node as u32);
            if system.unknowns.of(moved_by).is_empty() {
                continue;
            }
            let leader = leader(&mut leaders, (moved_by - first) as usize);
            if number[leader] == usize::MAX {
                number[leader] = members.len();
                members.push(Vec::new());
            }
            members[number[leader]].push(node as u32);
            group[own] = number[leader];
        }
        let groups = members.into_iter().map(|mut nodes| {
            let of_rigid = nodes.iter().filter_map(|node| carried.get(node)).flatten();
            nodes.extend(of_rigid.copied().collect::<Vec<u32>>());
            nodes.sort_unstable();
            nodes.dedup();
            let x = |node: &u32| &system.x[*node as usize];
            let centre =
                [0, 1, 2].map(|i| nodes.iter().map(|n| x(n)[i]).sum::<f64>() / nodes.len() as f64);
            let far = |x: &[f64; 3]| (0..3).map(|i| (x[i] - centre[i]).abs()).fold(0.0, f64::max);
            let size = nodes.iter().map(|n| far(x(n))).fold(0.0, f64::max);
            Group {
                nodes,
                centre,
                // the turns of a single node have no length to be measured by
                size: if size > 0.0 { size } else { 1.0 },
            }
        });
        let amplitudes = system.unknowns.amplitudes();
        Joined {
            groups: groups.collect(),
            system,
            amplitudes: amplitudes.filter(|(i, _)| part.contains(i)).collect(),
            part: part.clone(),
            group,
            first,
            modes: modes(system.dim, system.axisymmetric),
        }
    }

    /// What supports, springs and constraints hold of the motions.
    fn held(&self) -> Echelon {
        let mut held = Echelon::new(self.groups.len() * self.modes.len());
        for unknown in self.part.clone().filter(|&i| self.system.fixed[i]) {
            held.add(self.row([(unknown, 1.0)]));
        }
        for body in self.system.bodies.iter().filter_map(Body::as_reduced) {
            for (node, kind) in held_inside(self.system, body) {
                held.add(self.row_inside(body, (node, kind)));
            }
        }
        for body in &self.system.bodies {
            body.each_spring(&mut |row| {
                held.add(self.row(row.iter().copied()));
            });
        }
        for row in self.system.links.rows.iter() {
            held.add(self.row(row.iter().map(|&(unknown, c)| (unknown as usize, c))));
        }
        held
    }

    /// The groups that move in any motion that nothing holds.
    pub(crate) fn loose(&self) -> impl Iterator<Item = &Group> {
        let (held, count) = (self.held(), self.modes.len());
        let groups = self.groups.iter().enumerate();
        let loose = groups.filter(move |(g, group)| {
            let mut motions = self.modes.iter().enumerate();
            motions.any(|(k, mode)| self.moves(group, mode) && !held.holds(g * count + k))
        });
        loose.map(|(_, group)| group)
    }

    /// As many motions as nothing holds, group and name of each: first those that are free by themselves. In a part of several groups
    /// that nothing holds as a whole the motions of the whole are among them.
    pub(crate) fn free(&self) -> Vec<(&Group, &'static str)> {
        let count = self.modes.len();
        let mut held = self.held();
        let mut motions = Vec::new();
        for (g, group) in self.groups.iter().enumerate() {
            let own = self.modes.iter().enumerate();
            let own = own.filter(|(_, mode)| self.moves(group, mode));
            motions.extend(own.map(|(k, mode)| (g * count + k, group, mode.0)));
        }
        // what no row knows is free as it is; a hinge leaves a turn and the translations with it, which is called the turn
        let (known, mut free): (Vec<_>, Vec<_>) = motions
            .into_iter()
            .partition(|&(column, ..)| held.known[column]);
        let turns_first = known.into_iter().rev();
        free.extend(turns_first.filter(|&(column, ..)| held.add(BTreeMap::from([(column, 1.0)]))));
        free.into_iter()
            .map(|(_, group, motion)| (group, motion))
            .collect()
    }

    /// Independent motions that nothing holds, each as the groups that it moves: what constraints and tightened bolts join to a group moves
    /// with it. Of those that begin with a group that is `asked` for.
    pub(crate) fn motions(&self, asked: impl Fn(&Group) -> bool) -> Vec<Vec<&Group>> {
        let (held, count) = (self.held(), self.modes.len());
        let mut motions = Vec::new();
        for (g, group) in self.groups.iter().enumerate() {
            let own = self.modes.iter().enumerate();
            let mut own =
                own.filter(|(k, mode)| held.of[g * count + k].is_none() && self.moves(group, mode));
            let Some(first) = own.next().filter(|_| asked(group)) else {
                continue;
            };
            for (k, _) in std::iter::once(first).chain(own) {
                let mut moved: Vec<usize> = held.motion(g * count + k).collect();
                moved.iter_mut().for_each(|column| *column /= count);
                moved.dedup();
                motions.push(moved.into_iter().map(|g| &self.groups[g]).collect());
            }
        }
        motions
    }

    /// Whether a motion moves any unknown of a group: a single node without rotations has no turn.
    fn moves(&self, group: &Group, mode: &Mode) -> bool {
        let unknowns = &self.system.unknowns;
        let mut own = group.nodes.iter().flat_map(|&node| unknowns.of(node));
        own.any(|unknown| self.value(group, mode, unknown) != 0.0)
    }

    /// Σ f_i r_j(i) by coordinate j of unknowns i of the part and their values f; nothing where all of it is what rounding leaves of its
    /// terms, as of a spring between two nodes of a group.
    fn row(&self, terms: impl IntoIterator<Item = (usize, f64)>) -> BTreeMap<usize, f64> {
        let count = self.modes.len();
        let (mut row, mut size) = (BTreeMap::new(), 0.0_f64);
        for (unknown, f) in terms {
            if !self.part.contains(&unknown) {
                continue;
            }
            let node = self.system.unknowns.node(unknown);
            let g = self.group[(node - self.first) as usize];
            for (k, mode) in self.modes.iter().enumerate() {
                let term = f * self.value(&self.groups[g], mode, unknown);
                *row.entry(g * count + k).or_default() += term;
                size = size.max(term.abs());
            }
        }
        row.retain(|_, sum: &mut f64| sum.abs() > ROUNDING * size);
        row
    }

    /// The group of a node; none of a node of another part.
    fn group_of(&self, node: u32) -> Option<usize> {
        let own = node.checked_sub(self.first)?;
        let group = self.group.get(own as usize)?;
        (*group != usize::MAX).then_some(*group)
    }

    /// By coordinate what a node that a reduced body has not retained does in the motions; nothing of a body of another part.
    fn row_inside(&self, body: &Reduced, of: (u32, Kind)) -> BTreeMap<usize, f64> {
        let group = body.nodes().iter().find_map(|&node| self.group_of(node));
        let Some(g) = group else {
            return BTreeMap::new();
        };
        let modes = self.modes.iter().enumerate();
        let values = modes.map(|(k, mode)| {
            let value = self.value_at(&self.groups[g], mode, of);
            (g * self.modes.len() + k, value)
        });
        values.collect()
    }

    /// The value of a motion at an unknown.
    fn value(&self, group: &Group, mode: &Mode, unknown: usize) -> f64 {
        let unknowns = &self.system.unknowns;
        let node = unknowns.node(unknown);
        match (unknowns.kind(unknown), unknowns.frame(node)) {
            (Kind::Rotation(axis), Some(frame)) => {
                let (matrix, turn) = (self.system.initial.frames[frame].matrix(), turn_of(mode));
                (0..3).map(|i| matrix[(i, axis)] * turn[i]).sum::<f64>() / group.size
            }
            (Kind::Amplitude(_), _) => self.amplitudes.get(&unknown).map_or(0.0, |amplitude| {
                of_amplitude(mode, (&group.centre, group.size), amplitude)
            }),
            (kind, _) => self.value_at(group, mode, (node, kind)),
        }
    }

    /// The same at a translation or a small rotation of a node.
    fn value_at(&self, group: &Group, mode: &Mode, (node, kind): (u32, Kind)) -> f64 {
        let place = &self.system.x[node as usize];
        match kind {
            Kind::Translation(axis) => {
                mode.1(&[0, 1, 2].map(|j| (place[j] - group.centre[j]) / group.size))[axis]
            }
            Kind::Rotation(axis) => turn_of(mode)[axis] / group.size,
            Kind::Amplitude(_) => 0.0,
        }
    }
}

/// Rows by elimination, each with its largest entry as pivot: sparse, since a row joins few groups.
struct Echelon {
    /// Rows with a pivot of one, without entries at the pivots before them.
    rows: Vec<(usize, BTreeMap<usize, f64>)>,
    /// The row with the pivot of each column.
    of: Vec<Option<usize>>,
    /// Whether any row had an entry in the column.
    known: Vec<bool>,
}

impl Echelon {
    fn new(columns: usize) -> Echelon {
        Echelon {
            rows: Vec::new(),
            of: vec![None; columns],
            known: vec![false; columns],
        }
    }

    /// Adds a row; whether it is independent of those before it.
    fn add(&mut self, mut row: BTreeMap<usize, f64>) -> bool {
        let scale = row.values().fold(0.0, |most: f64, v| most.max(v.abs()));
        row.values_mut().for_each(|v| *v /= scale);
        row.retain(|_, v| v.abs() > INDEPENDENT);
        for &column in row.keys() {
            self.known[column] = true;
        }
        let mut row = self.rest(row);
        let largest = row.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let Some((&pivot, &value)) = largest else {
            return false;
        };
        row.values_mut().for_each(|v| *v /= value);
        self.of[pivot] = Some(self.rows.len());
        self.rows.push((pivot, row));
        true
    }

    /// The columns that are not zero where one that is no pivot is 1, and the others of these are 0; ascending.
    fn motion(&self, free: usize) -> impl Iterator<Item = usize> {
        let mut x = BTreeMap::from([(free, 1.0)]);
        // a row knows no pivots of those before it
        for (pivot, row) in self.rows.iter().rev() {
            let others = row.iter().filter(|(column, _)| *column != pivot);
            let terms = others.filter_map(|(column, v)| Some(v * x.get(column)?));
            let value: f64 = -terms.sum::<f64>();
            if value.abs() > INDEPENDENT {
                x.insert(*pivot, value);
            }
        }
        x.into_keys()
    }

    /// Whether a column is zero in all that the rows leave.
    fn holds(&self, column: usize) -> bool {
        self.known[column] && self.rest(BTreeMap::from([(column, 1.0)])).is_empty()
    }

    /// What of a row is independent of those there.
    fn rest(&self, mut row: BTreeMap<usize, f64>) -> BTreeMap<usize, f64> {
        // the earliest pivot first: later rows have nothing there
        while let Some(k) = row.keys().filter_map(|&column| self.of[column]).min() {
            let (pivot, other) = &self.rows[k];
            let factor = row[pivot];
            for (&column, v) in other {
                *row.entry(column).or_default() -= factor * v;
            }
            row.remove(pivot);
            row.retain(|_, v| v.abs() > INDEPENDENT);
        }
        row
    }
}

fn leader(leaders: &mut [usize], mut node: usize) -> usize {
    while leaders[node] != node {
        leaders[node] = leaders[leaders[node]];
        node = leaders[node];
    }
    node
}

fn unite(leaders: &mut [usize], [a, b]: [usize; 2]) {
    let (a, b) = (leader(leaders, a), leader(leaders, b));
    leaders[a.max(b)] = a.min(b);
}
