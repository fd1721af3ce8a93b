//! Weak gaps of middles of shells and, in the plane, axes of beams: their surface is at a radius on both sides.

use carom_algebra::unknowns::{NodeKind, Unknowns};
use carom_contact::{Integration, Places, Target};
use carom_elements::Kind;
use carom_mesh::Face;
use carom_testing::Random;

use crate::fixture::{assert_balanced, assert_derivatives, face, paired};
use crate::pairs::{BASES, Pair, bent, flat_pairs, grids, over_one_face};

/// Radii around the faces of the secondary side and of the primary one, m.
const RADII: [f64; 2] = [0.03, 0.02];

/// Which sides are round.
const ROUND: [[bool; 2]; 3] = [[true, true], [true, false], [false, true]];

/// The pair with round sides, whose faces look any way.
fn round(mut pair: Pair, sides: [bool; 2], random: &mut Random) -> Pair {
    let all = [&mut pair.secondary, &mut pair.primary];
    for ((faces, round), radius) in all.into_iter().zip(sides).zip(RADII) {
        for face in faces.iter_mut().filter(|_| round) {
            face.radius = Some(radius);
            if random.next() > 0.0 {
                *face = flipped(face);
            }
        }
    }
    pair
}

/// The same face seen from behind.
fn flipped(of: &Face) -> Face {
    let nodes = of.corners();
    let order: &[usize] = match of.kind {
        Kind::Bar2 => &[1, 0],
        Kind::Bar3 => &[1, 0, 2],
        Kind::Tri3 => &[0, 2, 1],
        Kind::Quad4 => &[0, 3, 2, 1],
        Kind::Tri6 => &[0, 2, 1, 5, 4, 3],
        Kind::Quad8 => &[0, 3, 2, 1, 7, 6, 5, 4],
        _ => &[0, 3, 2, 1, 7, 6, 5, 4, 8],
    };
    let nodes: Vec<u32> = order.iter().map(|&k| nodes[k]).collect();
    Face {
        radius: of.radius,
        ..face(of.kind, &nodes)
    }
}

/// Shells and beams have linear cells; what they touch may have others.
fn can_be(kind: Kind, round: bool) -> bool {
    !round || [Kind::Bar2, Kind::Tri3, Kind::Quad4].contains(&kind)
}

/// The pairs that are 0.1 apart, with all ways in which their sides may be round: surfaces that have passed each other's middles are on the other side of it.
fn round_pairs(random: &mut Random) -> Vec<(Pair, [bool; 2])> {
    let apart = flat_pairs().into_iter().filter(|pair| pair.gap() > 0.0);
    let all = apart.flat_map(|pair| ROUND.map(|sides| (pair.clone(), sides)));
    let can = all.filter(|(pair, sides)| {
        let kinds = [pair.secondary[0].kind, pair.primary[0].kind];
        kinds
            .into_iter()
            .zip(sides)
            .all(|(kind, round)| can_be(kind, *round))
    });
    can.map(|(pair, sides)| (round(pair, sides, random), sides))
        .collect()
}

/// How much nearer the surfaces are than the faces, m.
fn thickness(sides: [bool; 2]) -> f64 {
    let radii = RADII.iter().zip(sides).filter(|(_, round)| *round);
    radii.map(|(radius, _)| radius).sum()
}

#[test]
fn a_uniform_pressure_between_shells_gives_the_consistent_forces_of_both() {
    let mut random = Random(11);
    for (pair, sides) in round_pairs(&mut random) {
        let (one, other) = (
            pair.consistent(&pair.secondary),
            pair.consistent(&pair.primary),
        );
        for basis in BASES {
            let pairing = pair.pairing(basis);
            let normal = pairing.rows.normal(0);
            let mut forces = vec![0.0; pair.dim * pair.x.len()];
            for point in 0..pairing.len() {
                let found = pairing.rows.gap(point);
                assert!((found - (0.1 - thickness(sides))).abs() < 1e-14);
                let force = 3.0 * pairing.areas[point];
                pairing.rows.add_force(point, force, &mut forces);
            }
            assert!((pairing.areas.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            for node in 0..pair.x.len() {
                for i in 0..pair.dim {
                    let expected = 3.0 * normal[i] * (one[node] - other[node]);
                    let force = forces[pair.dim * node + i];
                    // sums of some hundred numbers below 0.1
                    assert!((force - expected).abs() < 1e-14);
                }
            }
        }
    }
}

/// A force of friction acts between the surfaces: with its moments on the rotations of both sides it has neither resultant nor moment. Where
/// feet are inside of flat faces the surfaces are at one place once they touch.
#[test]
fn friction_between_shells_that_touch_has_no_moment() {
    let mut random = Random(12);
    let gap = thickness([true; 2]);
    for kinds in [[Kind::Quad4, Kind::Tri3], [Kind::Tri3, Kind::Quad4]] {
        let pair = grids(kinds, [[3, 2], [2, 5]], [[0.0, 1.0]; 2], gap);
        let mut pair = round(pair, [true; 2], &mut random);
        pair.unknowns = Unknowns::new(3, vec![NodeKind::SmallRotations; pair.x.len()]);
        let u = vec![0.0; pair.unknowns.len()];
        for basis in BASES {
            let places = pair.places(&u);
            let pairing = paired(&pair.contact(basis, 1.0), &places);
            for point in 0..pairing.len() {
                assert!(pairing.rows.gap(point).abs() < 1e-14);
                for tangent in &pairing.tangents {
                    let mut row = vec![0.0; u.len()];
                    tangent.add_force(point, 1.0, &mut row);
                    let [force, moment] = total(&row, &places);
                    assert!(force.iter().chain(&moment).all(|n| n.abs() < 1e-14));
                    let spins = (0..pair.x.len()).map(|k| places.unknowns.spin(k as u32, &row));
                    let turned = spins.flatten().any(|moment| moment.abs() > 1e-4);
                    assert!(turned);
                    // an unknown has one entry
                    let (dofs, _) = tangent.row(point);
                    let mut once = dofs.to_vec();
                    once.sort_unstable();
                    once.dedup();
                    assert_eq!(once.len(), dofs.len());
                }
            }
        }
    }
}

/// Sums of the forces and moments of a row, about the origin.
fn total(row: &[f64], places: &Places) -> [[f64; 3]; 2] {
    let mut sums = [[0.0; 3]; 2];
    for node in 0..places.x.len() as u32 {
        let (x, f) = (places.of(node), places.unknowns.vector(node, row));
        let turn = places.unknowns.spin(node, row);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            sums[0][i] += f[i];
            sums[1][i] += x[j] * f[k] - x[k] * f[j] + turn[i];
        }
    }
    sums
}

#[test]
fn forces_of_every_multiplier_balance_between_bent_shells() {
    let mut random = Random(13);
    for (pair, _) in round_pairs(&mut random) {
        let pair = bent(pair, &mut random, 0.01);
        let u = vec![0.0; pair.dim * pair.x.len()];
        for basis in BASES {
            let pairing = pair.pairing(basis);
            for point in 0..pairing.len() {
                // a point stands at the rim, where what faces it may be a sliver and the dual functions large
                assert_balanced(&pairing, point, &pair.places(&u), 1e-12);
            }
        }
    }
}

#[test]
fn rows_and_curvature_between_shells_are_derivatives_where_pieces_keep() {
    let mut random = Random(14);
    for kind in [Kind::Bar2, Kind::Tri3, Kind::Quad4, Kind::Quad9] {
        for sides in ROUND.into_iter().filter(|sides| can_be(kind, sides[1])) {
            // bent middles do not pass each other
            let pair = over_one_face(kind, 1.1);
            let pair = round(bent(pair, &mut random, 0.05), sides, &mut random);
            let u = vec![0.01; pair.dim * pair.x.len()];
            for basis in BASES {
                let contact = pair.contact(basis, 0.7);
                assert_derivatives(&pair.places(&u), |places| paired(&contact, places));
            }
        }
    }
}

/// A shell over a thin block faces its upper side, under it its lower one; a block faces no shell behind it.
#[test]
fn what_is_behind_a_side_is_not_faced() {
    let (thin, apart) = (0.04, 0.06);
    for (height, block_first) in [(apart, false), (-apart - thin, false), (apart, true)] {
        // the upper and the lower side of a block, and a shell
        let upper = grids([Kind::Quad4; 2], [[3, 2], [2, 5]], [[0.0, 1.0]; 2], height);
        let lower = grids([Kind::Quad4; 2], [[1, 1], [3, 3]], [[0.0, 1.0]; 2], 0.0);
        let first = upper.x.len() as u32;
        let mut pair = upper;
        for face in &mut pair.secondary {
            face.radius = Some(RADII[0]);
        }
        let below = lower.primary.iter().map(|face| {
            let mut face = flipped(face);
            face.nodes
                .iter_mut()
                .for_each(|node| *node = node.saturating_add(first));
            face
        });
        pair.primary.extend(below);
        pair.x
            .extend(lower.x.iter().map(|x| [x[0], x[1], x[2] - thin]));
        pair.unknowns = Unknowns::translations(3, pair.x.len());
        if block_first {
            std::mem::swap(&mut pair.secondary, &mut pair.primary);
        }
        let pairing = pair.pairing(BASES[0]);
        let contact = pair.contact(BASES[0], 1.0);
        for (point, of) in contact.points.iter().enumerate() {
            let behind = block_first && pair.x[of.node() as usize][2] < 0.0;
            let gap = pairing.rows.gap(point);
            match behind {
                true => assert_eq!(gap, f64::INFINITY),
                false => assert!((gap - (apart - RADII[0])).abs() < 1e-14, "{gap}"),
            }
        }
    }
}

/// A contact of nodes and one of weak gaps of the same two flat shells have the same gaps.
#[test]
fn flat_shells_have_the_gaps_of_their_nodes() {
    let mut random = Random(15);
    let pair = grids([Kind::Quad4; 2], [[3, 2], [2, 5]], [[-0.1, 1.1]; 2], 0.1);
    let pair = round(pair, [true; 2], &mut random);
    let u = vec![0.0; 3 * pair.x.len()];
    let weak = pair.pairing(BASES[1]);
    let mut contact = pair.contact(BASES[1], 1.0);
    (contact.integration, contact.mortar) = (Integration::Node, None);
    let nodes = paired(&contact, &pair.places(&u));
    assert!(matches!(contact.target, Target::Surface(_)));
    for point in 0..weak.len() {
        assert!((weak.rows.gap(point) - nodes.rows.gap(point)).abs() < 1e-14);
    }
}
