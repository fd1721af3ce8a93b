//! Which elements are whose.

use carom_ranks::partition;

use crate::shared::halo::contact_nodes;
use crate::system::System;

/// What an element at finite strain costs over one at small strain, about.
const FINITE: f64 = 3.0;

/// The rank of each element of each body, the same in every process. Of the parts of equal cost the one with most nodes of contacts is that of the
/// first rank, which has the contacts.
pub(crate) fn parts(system: &System, ranks: usize) -> Vec<Vec<u32>> {
    let (mut centres, mut weights, mut counts) = (Vec::new(), Vec::new(), Vec::new());
    let touched = contact_nodes(system);
    let mut touches = Vec::new();
    for body in &system.bodies {
        let before = centres.len();
        let cost = if body.is_linear() { 1.0 } else { FINITE };
        body.each_element(&mut |nodes| {
            let mut centre = [0.0; 3];
            for &node in nodes {
                for (sum, x) in centre.iter_mut().zip(system.x[node as usize]) {
                    *sum += x / nodes.len() as f64;
                }
            }
            centres.push(centre);
            weights.push(cost * nodes.len() as f64);
            let own = nodes
                .iter()
                .filter(|node| touched.binary_search(node).is_ok());
            touches.push(own.count());
        });
        counts.push(centres.len() - before);
    }
    let mut parts = partition(&centres, &weights, ranks);
    let mut touched_of = vec![0; ranks];
    for (&part, count) in parts.iter().zip(&touches) {
        touched_of[part as usize] += count;
    }
    let first = (0..ranks).rev().max_by_key(|&rank| touched_of[rank]);
    let first = first.unwrap_or(0) as u32;
    for part in &mut parts {
        *part = match *part {
            0 => first,
            part if part == first => 0,
            part => part,
        };
    }
    let mut rest = &parts[..];
    let own = counts.iter().map(|&count| {
        let (own, others) = rest.split_at(count);
        rest = others;
        own.to_vec()
    });
    own.collect()
}
