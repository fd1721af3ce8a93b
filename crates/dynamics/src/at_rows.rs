//! The elements that give the rows of a matrix which one of several ranks needs.

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::solver::SharedRows;
use carom_bodies::{Body, Solid};
use carom_ranks::Ranks;

use crate::error::Error;
use crate::system::System;

/// Of each body the elements at some rows of a matrix. What such elements couple is whole in these rows, in the order of all elements, so that
/// entries have the bits of one process.
#[derive(Default)]
pub(crate) struct AtRows {
    /// Rows of the system that are needed; empty where all are.
    needed: Vec<bool>,
    /// The same as ranges, group by group.
    of: Vec<Range<usize>>,
    /// Unknowns of the system whose rows are this rank's own.
    own: Vec<Range<usize>>,
    /// Elements of each body as a body, with the places of their histories in that of all; none where all are taken.
    some: Vec<Option<(Body, Vec<Range<usize>>)>>,
    ranks: Ranks,
}

impl AtRows {
    /// All elements, of the matrices of one process.
    pub(crate) fn all() -> AtRows {
        AtRows::default()
    }

    /// Those of some groups of parts, whose unknowns are numbered one part after the other.
    pub(crate) fn new(system: &System, groups: &[(&[Range<usize>], &SharedRows)]) -> AtRows {
        let mut at = AtRows {
            needed: vec![false; system.unknowns()],
            of: ranges(groups),
            ..AtRows::default()
        };
        for range in &at.of {
            at.needed[range.clone()].fill(true);
        }
        for (parts, rows) in groups {
            let starts = rows.unknown_starts();
            let rank = rows.ranks().rank();
            at.own
                .extend(inside(parts, &(starts[rank]..starts[rank + 1])));
            at.ranks = rows.ranks().clone();
        }
        let some = |body: &Body| {
            let solid = body
                .as_solid()
                .filter(|solid| solid.not_shared().is_none())?;
            Some(solid.share(at.elements(system, solid)).into_body())
        };
        at.some = system.bodies.iter().map(some).collect();
        at
    }

    /// Whether these are the elements for some groups.
    pub(crate) fn are_of(&self, groups: &[(&[Range<usize>], &SharedRows)]) -> bool {
        self.are_some() && self.of == ranges(groups)
    }

    /// Places of the elements of a solid with any of the rows.
    fn elements(&self, system: &System, solid: &Solid) -> Vec<u32> {
        let (mut places, mut place) = (Vec::new(), 0);
        let needed = |&node: &u32| system.unknowns.of(node).any(|unknown| self.needed[unknown]);
        solid.each_element(&mut |nodes| {
            if nodes.iter().any(needed) {
                places.push(place);
            }
            place += 1;
        });
        places
    }

    /// Whether other ranks have rows that this one has not.
    pub(crate) fn are_some(&self) -> bool {
        !self.needed.is_empty()
    }

    /// A body with these elements.
    pub(crate) fn body<'a>(&'a self, system: &'a System, number: usize) -> &'a Body {
        match self.some.get(number) {
            Some(Some((body, _))) => body,
            _ => &system.bodies[number],
        }
    }

    /// The histories of these elements of a body, of that of all.
    pub(crate) fn history<'a>(
        &self,
        number: usize,
        of_all: &'a [f64],
        own: &'a mut Vec<f64>,
    ) -> &'a [f64] {
        let Some(Some((_, places))) = self.some.get(number) else {
            return of_all;
        };
        own.clear();
        for range in places {
            own.extend_from_slice(&of_all[range.clone()]);
        }
        own
    }

    /// Matrix of zeros with the rows of some unknowns of the system, from what is coupled in them.
    pub(crate) fn matrix(&self, unknowns: &Range<usize>, cliques: &Cliques) -> Csr {
        match self.are_some() {
            true => {
                let kept = self.needed[unknowns.clone()].to_vec();
                Csr::of_rows(kept, cliques)
            }
            false => Csr::from_cliques(unknowns.len(), cliques),
        }
    }

    /// y = A x with a matrix over all unknowns: each rank multiplies its own rows.
    pub(crate) fn multiply(&self, matrix: &Csr, x: &[f64], y: &mut [f64]) {
        if !self.are_some() {
            return matrix.multiply(x, y);
        }
        y.fill(0.0);
        for rows in &self.own {
            matrix.multiply_rows(rows.clone(), x, y);
        }
        self.ranks.reduce(y, &mut []);
    }

    /// Gives numbers that each rank has of its own rows to all, in the range of a part; `y` has those of all unknowns.
    pub(crate) fn complete(&self, part: &Range<usize>, y: &mut [f64]) {
        if !self.are_some() {
            return;
        }
        for unknown in part.clone() {
            if !self.own.iter().any(|rows| rows.contains(&unknown)) {
                y[unknown] = 0.0;
            }
        }
        self.ranks.reduce(&mut y[part.clone()], &mut []);
    }

    /// That no rank has an error; the same on all.
    ///
    /// # Errors
    /// [`Error::OnRank`]; the own one in one process.
    pub(crate) fn agree(&self, own: Result<(), Error>) -> Result<(), Error> {
        if !self.are_some() {
            return own;
        }
        let text = own.err().map(|error| error.to_string());
        match self.ranks.first_text(text.as_deref()) {
            None => Ok(()),
            Some((rank, cause)) => Err(Error::OnRank { rank, cause }),
        }
    }
}

/// The nodes of some parts, the pattern of their graph, and how many unknowns of each are not held.
pub(crate) fn graph_of_nodes(system: &System, parts: &[Range<usize>]) -> (Vec<u32>, Csr, Vec<u32>) {
    let all = system.unknowns.node_of_each();
    let mut nodes: Vec<u32> = Vec::new();
    let (mut weights, mut number) = (Vec::new(), vec![u32::MAX; system.x.len()]);
    for unknown in parts.iter().cloned().flatten() {
        if nodes.last() != Some(&all[unknown]) {
            number[all[unknown] as usize] = nodes.len() as u32;
            nodes.push(all[unknown]);
            weights.push(0);
        }
        if let Some(weight) = weights.last_mut() {
            *weight += u32::from(!system.fixed[unknown]);
        }
    }
    let mut cliques = Cliques::new();
    for body in &system.bodies {
        body.each_element(&mut |of_element| {
            let own = of_element.iter().map(|&node| number[node as usize]);
            let free = |&node: &u32| node != u32::MAX && weights[node as usize] > 0;
            let own: Vec<u32> = own.filter(free).collect();
            cliques.push(&own);
        });
    }
    let pattern = Csr::from_cliques(nodes.len(), &cliques);
    (nodes, pattern, weights)
}

/// How ranks share the rows of a matrix over the unknowns of some parts, numbered one part after the other. `coupled`: unknowns of the system that are
/// coupled besides those of elements.
pub(crate) fn shared_rows(
    system: &System,
    parts: &[Range<usize>],
    coupled: &[Vec<u32>],
    ranks: &Ranks,
) -> SharedRows {
    let all = system.unknowns.node_of_each();
    let unknowns = parts.iter().cloned().flatten();
    let nodes: Vec<u32> = unknowns.map(|unknown| all[unknown]).collect();
    SharedRows::new(&groups(&nodes), ranks, |own| {
        let mut first = own.start;
        let mut couple = |unknowns: &mut dyn Iterator<Item = usize>| {
            let places: Vec<usize> = unknowns.filter_map(|i| place(parts, i)).collect();
            if places.iter().any(|place| own.contains(place)) {
                first = places.into_iter().fold(first, usize::min);
            }
        };
        for body in &system.bodies {
            body.each_element(&mut |nodes| {
                couple(&mut nodes.iter().flat_map(|&node| system.unknowns.of(node)));
            });
        }
        for unknowns in coupled {
            couple(&mut unknowns.iter().map(|&unknown| unknown as usize));
        }
        first
    })
}

/// Numbers without gaps of the nodes of unknowns, nodes ascending.
pub(crate) fn groups(nodes: &[u32]) -> Vec<u32> {
    let mut number = 0;
    let mut last = nodes.first().copied();
    let group = |&node: &u32| {
        if last != Some(node) {
            (last, number) = (Some(node), number + 1);
        }
        number
    };
    nodes.iter().map(group).collect()
}

/// Place of an unknown of the system among those of some parts.
fn place(parts: &[Range<usize>], unknown: usize) -> Option<usize> {
    let mut begin = 0;
    for part in parts {
        if part.contains(&unknown) {
            return Some(begin + unknown - part.start);
        }
        begin += part.len();
    }
    None
}

/// The unknowns of the system whose rows are needed of some groups.
fn ranges(groups: &[(&[Range<usize>], &SharedRows)]) -> Vec<Range<usize>> {
    let of_group = |(parts, rows): &(&[Range<usize>], &SharedRows)| {
        inside(parts, &rows.needed()).collect::<Vec<_>>()
    };
    groups.iter().flat_map(of_group).collect()
}

/// The unknowns of the system at a range of places among those of some parts.
fn inside<'a>(
    parts: &'a [Range<usize>],
    places: &'a Range<usize>,
) -> impl Iterator<Item = Range<usize>> + 'a {
    let mut begin = 0;
    parts.iter().filter_map(move |part| {
        let first = places.start.max(begin);
        let last = places.end.min(begin + part.len());
        let range = (first < last).then(|| part.start + first - begin..part.start + last - begin);
        begin += part.len();
        range
    })
}

#[cfg(test)]
mod tests;
