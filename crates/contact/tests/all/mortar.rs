//! Weak gaps: what their forces are, what they cover, and their derivatives.

use carom_contact::{Basis, Contact, Pairing, Plane, Search, Side, Sphere, Target};
use carom_elements::Kind;
use carom_testing::{Random, allocations};

use crate::fixture::{assert_balanced, assert_derivatives, full, matrix, paired};
use crate::pairs::{BASES, KINDS, bent, flat_pairs, grids, lines, over_one_face};

#[test]
fn a_uniform_pressure_gives_the_consistent_forces_of_both_sides() {
    for pair in flat_pairs() {
        for basis in BASES {
            let pairing = pair.pairing(basis);
            let mut forces = vec![0.0; pair.dim * pair.x.len()];
            for point in 0..pairing.len() {
                let force = 3.0 * pairing.areas[point];
                pairing.rows.add_force(point, force, &mut forces);
            }
            let n = pairing.rows.normal(0);
            let (one, other) = (
                pair.consistent(&pair.secondary),
                pair.consistent(&pair.primary),
            );
            for node in 0..pair.x.len() {
                for i in 0..pair.dim {
                    let expected = 3.0 * n[i] * (one[node] - other[node]);
                    let force = forces[pair.dim * node + i];
                    // sums of some hundred numbers below 0.1
                    assert!(
                        (force - expected).abs() < 1e-14,
                        "{node} {force} {expected}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_uniform_gap_is_the_gap_of_every_multiplier_and_areas_add_up() {
    for pair in flat_pairs() {
        for basis in BASES {
            let pairing = pair.pairing(basis);
            let gap = pairing.rows.gap(0);
            for point in 0..pairing.len() {
                assert!((pairing.rows.gap(point) - gap).abs() < 1e-15);
            }
            assert!((pairing.areas.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            let points = pair.contact(basis, 1.0).points;
            for (point, area) in points.iter().zip(&pairing.areas) {
                assert!((point.area - area).abs() < 1e-15);
            }
        }
    }
}

#[test]
fn a_dual_multiplier_holds_one_secondary_node() {
    let linear = |kind| [Kind::Bar2, Kind::Tri3, Kind::Quad4].contains(&kind);
    let pairs = flat_pairs().into_iter();
    for pair in pairs.filter(|pair| linear(pair.secondary[0].kind)) {
        let pairing = pair.pairing(Basis::Dual);
        let contact = pair.contact(Basis::Dual, 1.0);
        for point in 0..pairing.len() {
            let row = full(&pairing, point, pair.dim * pair.x.len());
            let n = pairing.rows.normal(point);
            let secondary = contact.points.iter().map(|point| point.node() as usize);
            for (other, node) in secondary.enumerate() {
                for i in 0..pair.dim {
                    let expected = if other == point { n[i] } else { 0.0 };
                    // the conditioning of a mass matrix of four functions is about ten
                    assert!((row[pair.dim * node + i] - expected).abs() < 1e-14);
                }
            }
        }
    }
}

#[test]
fn what_has_nothing_opposite_is_left_out() {
    // the primary side covers [0.35, 1.3] of a secondary one of [0, 1], in space x [-0.2, 0.7]
    let (one, other) = ([0.0, 0.3, 0.4, 0.8, 1.0], [0.35, 0.5, 1.3]);
    let line = |kind| (lines(&one, &other, 0.1, kind), 0.65);
    let mut pairs = vec![line(Kind::Bar2), line(Kind::Bar3)];
    for kinds in KINDS {
        let pair = grids(kinds, [[4, 3], [2, 3]], [[0.35, 1.3], [-0.2, 0.7]], 0.1);
        pairs.push((pair, 0.65 * 0.7));
    }
    for (pair, area) in pairs {
        for basis in BASES {
            let (pairing, contact) = (pair.pairing(basis), pair.contact(basis, 1.0));
            let mut covered = 0.0;
            let mut forces = vec![0.0; pair.dim * pair.x.len()];
            let mut open = 0;
            for (point, whole) in contact.points.iter().enumerate() {
                let gap = pairing.rows.gap(point);
                if gap.is_infinite() {
                    open += 1;
                    assert_eq!(pairing.areas[point], whole.area);
                    assert!(pair.x[whole.node() as usize][0] < 0.35);
                    continue;
                }
                assert!((gap - 0.1).abs() < 1e-14);
                assert!(pairing.areas[point] < whole.area + 1e-14);
                covered += pairing.areas[point];
                pairing
                    .rows
                    .add_force(point, pairing.areas[point], &mut forces);
            }
            assert!(open > 0);
            assert!((covered - area).abs() < 1e-14, "{covered} {area}");
            // the resultant of a uniform pressure passes through the middle of what is covered
            let last = pair.dim - 1;
            let upper = (0..pair.x.len()).filter(|&node| pair.x[node][last] == 0.1);
            let moment: f64 = upper
                .map(|node| pair.x[node][0] * forces[pair.dim * node + last])
                .sum();
            assert!((moment - area * 0.675).abs() < 1e-14, "{moment}");
        }
    }
}

#[test]
fn slivers_of_any_width_leave_gaps_and_rows_bounded() {
    // the primary side ends a little beyond a node of the secondary one
    for exponent in 1..16 {
        let end = 0.4 + 10.0_f64.powi(-exponent);
        let line = lines(&[0.0, 0.2, 0.4, 1.0], &[-0.3, 0.1, end], 0.1, Kind::Bar2);
        let mut pairs = vec![line];
        for kinds in &KINDS[..4] {
            pairs.push(grids(
                *kinds,
                [[5, 3], [2, 3]],
                [[-0.3, end], [-0.2, 0.7]],
                0.1,
            ));
        }
        for pair in pairs {
            for basis in BASES {
                // dual functions are as large as the pivots of their mass matrix, down to 1e-10, are small
                let rounding = if basis == Basis::Dual { 1e-9 } else { 1e-14 };
                let pairing = pair.pairing(basis);
                for point in 0..pairing.len() {
                    let gap = pairing.rows.gap(point);
                    assert!(
                        gap == f64::INFINITY || (gap - 0.1).abs() < rounding,
                        "{exponent} {gap}"
                    );
                    // extrapolation from a sliver to the far node of its face, of both sides' functions, at most
                    let (_, row) = pairing.rows.row(point);
                    let largest = row.iter().fold(0.0_f64, |largest, n| largest.max(n.abs()));
                    assert!(largest < 10.0, "{exponent} {basis:?} {largest}");
                    assert!(pairing.areas[point] > 0.0);
                }
            }
        }
    }
}

#[test]
fn forces_of_every_multiplier_balance_on_bent_surfaces() {
    let mut random = Random(5);
    for pair in flat_pairs() {
        let pair = bent(pair, &mut random, 0.01);
        let u = vec![0.0; pair.dim * pair.x.len()];
        for basis in BASES {
            let pairing = pair.pairing(basis);
            for point in 0..pairing.len() {
                // a point stands at the rim, where what faces it may be a sliver and the dual functions large
                assert_balanced(&pairing, point, &pair.places(&u), 1e-12);
                let sliding = &pairing.tangents[0];
                let motion: Vec<f64> = (0..u.len())
                    .map(|dof| [0.3, 0.5, -0.4][dof % pair.dim])
                    .collect();
                assert!(sliding.product(point, &motion).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn rows_and_curvature_of_multipliers_are_derivatives_where_pieces_keep() {
    let mut random = Random(9);
    for kind in [Kind::Bar2, Kind::Tri3, Kind::Quad4, Kind::Quad9] {
        let pair = over_one_face(kind, 0.3);
        let pair = bent(pair, &mut random, 0.05);
        let u = vec![0.01; pair.dim * pair.x.len()];
        for basis in BASES {
            let contact = pair.contact(basis, 0.7);
            assert_derivatives(&pair.places(&u), |places| paired(&contact, places));
        }
    }
}

#[test]
fn the_curvature_of_all_points_is_the_sum_of_theirs() {
    let mut random = Random(4);
    for pair in flat_pairs() {
        let pair = bent(pair, &mut random, 0.01);
        let pairing = pair.pairing(Basis::Standard);
        let n = pair.dim * pair.x.len();
        let forces = random.vector(pairing.len());
        let (mut one, mut all) = (matrix(&pairing, n), matrix(&pairing, n));
        for (point, &force) in forces.iter().enumerate() {
            pairing.add_curvature(point, force, 3.0, &mut one);
        }
        let forces = forces.iter().copied().enumerate();
        let mut apart = matrix(&pairing, n);
        pairing.add_curvatures(forces.clone(), 3.0, (&mut Vec::new(), None), &mut all);
        pairing.add_curvatures(forces, 3.0, (&mut Vec::new(), Some(&|_| true)), &mut apart);
        let (mut size, mut kept, mut left) = (0.0_f64, 0, 0);
        for i in 0..n {
            for (a, b) in one.row(i).1.iter().zip(all.row(i).1) {
                // sums of a hundred numbers of the order of the curvature per stencil
                assert!((a - b).abs() < 1e-12, "{a} {b}");
                size = size.max(a.abs());
            }
            for (a, b) in apart.row(i).1.iter().zip(all.row(i).1) {
                // within a side the same bits, between the two nothing
                assert!(a == b || *a == 0.0, "{a} {b}");
                kept += usize::from(*a != 0.0);
                left += usize::from(a != b);
            }
        }
        assert!(size > 1e-2 && kept > 0 && left > 0);
    }
}

#[test]
fn shadows_of_a_bent_surface_cover_another_once() {
    // the primary side is wider, so that shadows along any normal reach every rim
    let line = lines(
        &[0.0, 0.1, 0.5, 0.8, 1.0],
        &[-0.5, 0.1, 0.3, 0.7, 0.9, 1.5],
        0.05,
        Kind::Bar2,
    );
    let wide = [[-0.5, 1.5]; 2];
    let [tri, quad] = [Kind::Tri3, Kind::Quad4]
        .map(|kind| grids([Kind::Tri3, kind], [[4, 3], [5, 6]], wide, 0.05));
    let mut random = Random(8);
    for pair in [line, tri, quad] {
        let pair = bent(pair, &mut random, 0.02);
        let whole: f64 = pair.consistent(&pair.secondary).iter().sum();
        for basis in BASES {
            let pairing = pair.pairing(basis);
            let covered: f64 = pairing.areas.iter().sum();
            assert!((covered - whole).abs() < 1e-13, "{covered} {whole}");
        }
    }
}

#[test]
fn on_distorted_quadrilaterals_forces_are_consistent_to_a_hundred_thousandth() {
    let cells = [[6, 4], [4, 10]];
    let mut pair = grids([Kind::Quad4; 2], cells, [[0.0, 1.0]; 2], 0.1);
    let mut random = Random(8);
    for x in &mut pair.x {
        let inside = |x: f64| x > 1e-9 && x < 1.0 - 1e-9;
        for x in x[..2].iter_mut().filter(|x| inside(**x)) {
            *x += 0.03 * random.next();
        }
    }
    let pairing = pair.pairing(Basis::Standard);
    let mut forces = vec![0.0; 3 * pair.x.len()];
    for point in 0..pairing.len() {
        pairing
            .rows
            .add_force(point, pairing.areas[point], &mut forces);
    }
    let sides = [&pair.secondary, &pair.primary].map(|faces| pair.consistent(faces));
    for node in 0..pair.x.len() {
        let expected = sides[0][node] - sides[1][node];
        let error = (forces[3 * node + 2] - expected).abs();
        // shape functions are quotients of polynomials on such faces: a rule of degree 5 leaves the sixth derivatives
        assert!(error < 3e-5 * expected.abs(), "{node} {error} {expected}");
    }
}

#[test]
fn obstacles_are_integrated_over_whole_faces() {
    for mut pair in flat_pairs() {
        pair.primary.clear();
        let n = pair.pairing_normal();
        let plane = Plane {
            point: [0.0; 3],
            normal: n,
        };
        for basis in BASES {
            let mut contact = pair.contact(basis, 1.0);
            contact.target = Target::Rigid(plane.into());
            let u = vec![0.0; pair.dim * pair.x.len()];
            let pairing = paired(&contact, &pair.places(&u));
            for (point, at) in contact.points.iter().enumerate() {
                let gap = plane.distance(&pair.x[at.node() as usize]).gap;
                assert!((pairing.rows.gap(point) - gap).abs() < 1e-15);
                assert!((pairing.areas[point] - at.area).abs() < 1e-15);
            }
            let sphere = Sphere {
                centre: n.map(|n| -2.0 * n),
                radius: 1.5,
                side: Side::Outside,
            };
            contact.target = Target::Rigid(sphere.into());
            let pairing = paired(&contact, &pair.places(&u));
            assert!((0..pairing.len()).all(|point| pairing.rows.gap(point) > 0.0));
        }
    }
}

#[test]
fn a_pairing_depends_on_nothing_before_it_and_a_second_one_allocates_nothing() {
    for pair in flat_pairs() {
        let contact = pair.contact(Basis::Dual, 1.0);
        let (mut search, mut pairing) = (Search::default(), Pairing::default());
        let u: Vec<f64> = Random(1).vector(pair.dim * pair.x.len());
        let small: Vec<f64> = u.iter().map(|u| 1e-3 * u).collect();
        let rest = vec![0.0; u.len()];
        for u in [&rest, &small] {
            pairing.clear();
            contact.pair_fully(&pair.places(u), &mut search, &mut pairing);
        }
        let fresh = paired(&contact, &pair.places(&small));
        assert_eq!(pairing.rows, fresh.rows);
        assert_eq!(pairing.tangents, fresh.tangents);
        assert_eq!(pairing.areas, fresh.areas);
        let before = allocations();
        pairing.clear();
        contact.pair_fully(&pair.places(&small), &mut search, &mut pairing);
        assert_eq!(allocations() - before, 0);
    }
}

/// Curved edges of three nodes on y = x²/2R over flat ones: they touch in one node, where the dual functions of a face of length
/// h have the mean gap -h²/12R, the exact integral of (2 - 3s) s² h²/2R over s in [0, 1].
#[test]
fn surfaces_that_touch_do_not_penetrate_though_a_dual_mean_is_negative() {
    let (h, radius) = (0.1, 2.0);
    let ends: Vec<f64> = (-4..=4).map(|k| h * f64::from(k)).collect();
    let mut pair = lines(&ends, &[-1.0, -0.45, 0.07, 0.6, 1.0], 0.0, Kind::Bar3);
    let curved: Vec<u32> = pair
        .secondary
        .iter()
        .flat_map(|f| f.corners().to_vec())
        .collect();
    for node in curved {
        let x = &mut pair.x[node as usize];
        x[1] = x[0] * x[0] / (2.0 * radius);
    }
    let u = vec![0.0; 2 * pair.x.len()];
    let slack = 1e-9;
    let least = |contact: &Contact, u: &[f64]| {
        let rows = paired(contact, &pair.places(u)).rows;
        (0..rows.len())
            .map(|k| rows.gap(k))
            .fold(f64::INFINITY, f64::min)
    };
    let mut dual = pair.contact(Basis::Dual, 1.0);
    // normals of the arc lean by h/R: the cubic terms that this leaves are h/R times smaller, squared
    assert!((least(&dual, &u) / (-h * h / (12.0 * radius)) - 1.0).abs() < 1e-2);
    for basis in BASES {
        let contact = pair.contact(basis, 1.0);
        assert_eq!(contact.penetrations(&pair.places(&u), slack), []);
    }
    dual.offset_touching(&pair.places(&u), slack);
    assert!(least(&dual, &u).abs() < 1e-15);
    // and what penetrates is found: the arc moved down by a tenth of its height over a face
    let depth = 0.1 * h * h / (2.0 * radius);
    let mut down = u.clone();
    for face in &pair.secondary {
        for &node in face.corners() {
            down[2 * node as usize + 1] = -depth;
        }
    }
    let mut dual = pair.contact(Basis::Dual, 1.0);
    let found = dual.penetrations(&pair.places(&down), slack);
    assert!(!found.is_empty());
    dual.offset_touching(&pair.places(&down), slack);
    assert_eq!(dual.penetrations(&pair.places(&down), slack), found);
}
