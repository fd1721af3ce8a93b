//! Blocks over the unknowns of nodes.

use carom_algebra::{csr::Csr, pattern::Cliques};
use carom_testing::Random;

/// Nodes of three unknowns each, one of which is coupled by itself: the rows of that node differ.
#[test]
fn blocks_of_nodes_go_where_their_unknowns_do() {
    let elements: [[u32; 3]; 2] = [[6, 0, 12], [0, 3, 6]];
    let mut cliques = Cliques::new();
    let unknowns =
        |first: &[u32; 3]| -> Vec<u32> { first.iter().flat_map(|&i| i..i + 3).collect() };
    for first in &elements {
        cliques.push(&unknowns(first));
    }
    cliques.push(&[1, 9, 13]);
    let (mut by_nodes, mut by_unknowns) = (
        Csr::from_cliques(15, &cliques),
        Csr::from_cliques(15, &cliques),
    );
    let mut random = Random(11);
    for first in &elements {
        let block: Vec<f64> = (0..81).map(|_| random.next()).collect();
        by_nodes.add_nodes(first, 3, (0.5, &block));
        let half: Vec<f64> = block.iter().map(|entry| 0.5 * entry).collect();
        by_unknowns.add_block(&unknowns(first), &half);
    }
    assert!((0..15).all(|i| by_nodes.row(i) == by_unknowns.row(i)));
}

#[test]
fn a_part_is_a_restriction_with_the_identity_of_what_is_fixed() {
    let matrix = crate::numbers::random(60, 5, &mut Random(12)).matrix;
    let (ranges, fixed) = ([5..20, 30..55], |i: usize| i % 4 == 1);
    let part = matrix.part(&ranges, fixed);
    let marks: Vec<bool> = ranges.iter().cloned().flatten().map(fixed).collect();
    let twice = matrix.restricted(&ranges).with_identity(&marks);
    assert!((0..40).all(|i| part.row(i) == twice.row(i)));
}
