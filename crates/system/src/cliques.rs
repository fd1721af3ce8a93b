//! The unknowns that the elements of a body couple.

use std::ops::Range;

use carom_algebra::pattern::Cliques;
use carom_algebra::unknowns::Unknowns;
use carom_bodies::Body;

/// Adds the unknowns that a body couples, of those in a part, counted from the first of the part.
pub fn push_cliques(body: &Body, map: &Unknowns, part: &Range<usize>, cliques: &mut Cliques) {
    let mut unknowns = Vec::new();
    body.each_clique(&mut |nodes| {
        if part.contains(&map.first(nodes[0])) {
            let of_node = |&node: &u32| map.of(node).map(|i| (i - part.start) as u32);
            unknowns.clear();
            unknowns.extend(nodes.iter().flat_map(of_node));
            cliques.push(&unknowns);
        }
    });
}
