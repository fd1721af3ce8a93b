//! Blocks over the unknowns of nodes.

use carom_algebra::csr::Csr;
use carom_algebra::part::Part;
use carom_algebra::pattern::Cliques;
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
    let twice = matrix
        .restricted(&ranges)
        .with_identity(&marks)
        .into_owned();
    assert!((0..40).all(|i| part.row(i) == twice.row(i)));
}

/// Places are remembered by the turn in which they came: another order must not be taken for the same.
#[test]
fn blocks_that_come_again_go_to_the_same_places_in_any_order() {
    let elements: [[u32; 3]; 3] = [[6, 0, 4], [0, 2, 6], [2, 8, 6]];
    let mut cliques = Cliques::new();
    for first in &elements {
        let unknowns: Vec<u32> = first.iter().flat_map(|&i| i..i + 2).collect();
        cliques.push(&unknowns);
    }
    let mut random = Random(13);
    let blocks: Vec<Vec<f64>> = (0..3)
        .map(|_| (0..36).map(|_| random.next()).collect())
        .collect();
    let mut again = Csr::from_cliques(10, &cliques);
    for order in [[0, 1, 2], [0, 1, 2], [2, 0, 1], [1, 1, 0]] {
        again.clear();
        let mut once = Csr::from_cliques(10, &cliques);
        for k in order {
            again.add_nodes(&elements[k], 2, (1.0, &blocks[k]));
            once.add_nodes(&elements[k], 2, (1.0, &blocks[k]));
        }
        assert!((0..10).all(|i| again.row(i) == once.row(i)));
    }
}

#[test]
fn a_part_that_is_taken_again_has_the_new_values() {
    let mut matrix = crate::numbers::random(60, 5, &mut Random(14)).matrix;
    let (ranges, fixed) = ([5..20, 30..55], |i: usize| i % 4 == 1);
    let mut part = Part::new(&matrix, &ranges, fixed);
    matrix.scale(3.0);
    part.renew(&matrix);
    let anew = matrix.part(&ranges, fixed);
    assert!((0..40).all(|i| part.matrix_mut().row(i) == anew.row(i)));
}
