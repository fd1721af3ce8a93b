//! Rows and curvature of a point against one face or an obstacle.

use carom_algebra::unknowns::Unknowns;
use carom_contact::{Contact, Frames, Places, Plane, Point, Rows, Search, Side, Sphere, Target};
use carom_elements::Kind;
use carom_testing::Random;

use crate::fixture::{assert_balanced, assert_derivatives, contact, face, full, paired};

const FACES: [Kind; 7] = [
    Kind::Bar2,
    Kind::Bar3,
    Kind::Tri3,
    Kind::Tri6,
    Kind::Quad4,
    Kind::Quad8,
    Kind::Quad9,
];

/// A face near its reference cell, shaken and turned, and a secondary face of two or three nodes over it.
fn places(kind: Kind, random: &mut Random, spread: f64) -> Vec<[f64; 3]> {
    let space = kind.table().dim == 2;
    // so that no point comes near the centre of curvature of a parabola
    let shake = if kind.table().nodes > 4 || kind == Kind::Bar3 {
        0.03
    } else {
        0.08
    };
    let mut x: Vec<[f64; 3]> = kind.table().reference.to_vec();
    for x in &mut x {
        for x in &mut x[..if space { 3 } else { 2 }] {
            *x += shake * random.next();
        }
    }
    let middle = [spread * random.next(), spread * random.next()];
    for _ in 0..if space { 3 } else { 2 } {
        let (a, b) = (0.1 * random.next(), 0.1 * random.next());
        let height = random.between(0.35, 0.6);
        x.push(match space {
            true => [middle[0] + a, middle[1] + b, height],
            // the normal of an edge from left to right points down
            false => [middle[0] + a, -height, 0.0],
        });
    }
    x
}

/// Points over both sides, edges and corners of the middle of a shell.
#[test]
fn rows_and_curvature_around_plane_cells_are_derivatives() {
    let mut random = Random(19);
    for kind in [Kind::Tri3, Kind::Quad4] {
        for case in 0..80 {
            let spread = if case % 2 == 0 { 0.3 } else { 1.6 };
            let mut x = places(kind, &mut random, spread);
            let count = kind.table().nodes;
            if case % 4 < 2 {
                x[count][2] *= -1.0;
            }
            let u: Vec<f64> = random
                .vector(3 * x.len())
                .iter()
                .map(|u| 0.02 * u)
                .collect();
            let places = Places {
                unknowns: &Unknowns::translations(3, x.len()),
                time: 0.0,
                x: &x,
                u: &u,
                frames: Frames::default(),
            };
            let mut around = face(kind, &(0..count as u32).collect::<Vec<_>>());
            around.radius = Some(0.05);
            let points = vec![Point::at_node(count as u32, 1.0, 1.0)];
            let contact = contact(points, Target::Surface(vec![around]));
            let pairing = paired(&contact, &places);
            let gap = pairing.rows.gap(0);
            assert!(
                gap > 0.0 && gap.is_finite(),
                "on both sides a point is outside"
            );
            assert_derivatives(&places, |places| paired(&contact, places));
        }
    }
}

fn over_a_face(kind: Kind, x: &[[f64; 3]], whole: bool) -> Contact {
    let nodes: Vec<u32> = (0..x.len() as u32).collect();
    let (primary, secondary) = nodes.split_at(kind.table().nodes);
    let target = Target::Surface(vec![face(kind, primary)]);
    let points = match whole {
        true => {
            let kind = if secondary.len() == 3 {
                Kind::Tri3
            } else {
                Kind::Bar2
            };
            Point::of_faces(&[face(kind, secondary)], x, |_| 1.0)
        }
        false => vec![Point::at_node(secondary[0], 1.0, 1.0)],
    };
    contact(points, target)
}

#[test]
fn rows_and_curvature_are_derivatives_inside_faces_on_edges_and_in_corners() {
    let mut random = Random(7);
    for kind in FACES {
        let dim = kind.table().dim + 1;
        let (mut free, mut held) = (0, 0);
        for case in 0..80 {
            let spread = if case % 2 == 0 { 0.3 } else { 1.4 };
            let x = places(kind, &mut random, spread);
            let u: Vec<f64> = random
                .vector(dim * x.len())
                .iter()
                .map(|u| 0.02 * u)
                .collect();
            let places = Places {
                unknowns: &Unknowns::translations(dim, x.len()),
                time: 0.0,
                x: &x,
                u: &u,
                frames: Frames::default(),
            };
            let contact = over_a_face(kind, &x, case % 3 == 0);
            let pairing = paired(&contact, &places);
            if (0..pairing.len()).any(|i| pairing.rows.gap(i).is_infinite()) {
                continue;
            }
            let mut rows = Rows::default();
            rows.clear();
            contact.pair(&places, &mut Search::default(), &mut rows);
            for point in 0..pairing.len() {
                assert_eq!(pairing.rows.gap(point), rows.gap(point));
                match pairing.rows.row(point) == rows.row(point) {
                    true => free += 1,
                    false => held += 1,
                }
                // sums of about ten numbers of order one
                assert_balanced(&pairing, point, &places, 1e-13);
            }
            assert_derivatives(&places, |places| paired(&contact, places));
        }
        assert!(free > 10 && held > 5, "{kind:?} {free} {held}");
    }
}

#[test]
fn gaps_to_obstacles_have_their_curvature() {
    let x = [[0.9, 0.8, 0.6], [0.3, 1.2, 0.7], [-0.4, 0.8, 0.9]];
    let sphere = Sphere {
        centre: [0.1, -0.2, 0.0],
        radius: 0.7,
        side: Side::Outside,
    };
    let plane = Plane {
        point: [0.0; 3],
        normal: [0.6, 0.0, 0.8],
    };
    for target in [Target::Rigid(sphere.into()), Target::Rigid(plane.into())] {
        for dim in [2, 3] {
            let kind = if dim == 3 { Kind::Tri3 } else { Kind::Bar2 };
            let flat = x.map(|x| if dim == 3 { x } else { [x[0], x[1], 0.0] });
            let nodes = &[0, 1, 2][..dim];
            let points = Point::of_faces(&[face(kind, nodes)], &flat, |_| 1.0);
            let contact = contact(points, target.clone());
            let u = vec![0.01; 3 * dim];
            let places = Places {
                unknowns: &Unknowns::translations(dim, x.len()),
                time: 0.0,
                x: &flat,
                u: &u,
                frames: Frames::default(),
            };
            assert_derivatives(&places, |places| paired(&contact, places));
        }
    }
}

#[test]
fn tangents_are_square_to_the_normal_and_measure_sliding() {
    let mut random = Random(3);
    for kind in FACES {
        let x = places(kind, &mut random, 0.3);
        let dim = kind.table().dim + 1;
        let u = vec![0.0; dim * x.len()];
        let places = Places {
            unknowns: &Unknowns::translations(dim, x.len()),
            time: 0.0,
            x: &x,
            u: &u,
            frames: Frames::default(),
        };
        let contact = over_a_face(kind, &x, true);
        let pairing = paired(&contact, &places);
        let n = pairing.rows.normal(0);
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
        for (i, tangent) in pairing.tangents[..dim - 1].iter().enumerate() {
            let t = tangent.normal(0);
            assert!(dot(t, n).abs() < 1e-15 && (dot(t, t) - 1.0).abs() < 1e-15);
            if dim == 3 {
                assert!(dot(t, pairing.tangents[1 - i].normal(0)).abs() < 1e-15);
            }
            // the secondary body moves by w, the primary stands: T v = t·w; both move by w: nothing
            let w = [0.3, -0.8, 0.5];
            let mut v = vec![0.0; u.len()];
            for (dof, v) in v.iter_mut().enumerate().skip(dim * kind.table().nodes) {
                *v = w[dof % dim];
            }
            let w_in = [w[0], w[1], if dim == 3 { w[2] } else { 0.0 }];
            assert!((tangent.product(0, &v) - dot(t, w_in)).abs() < 1e-14);
            let both: Vec<f64> = (0..u.len()).map(|dof| w[dof % dim]).collect();
            assert!(tangent.product(0, &both).abs() < 1e-14);
        }
        assert_eq!(
            pairing.tangents[1].len(),
            if dim == 3 { pairing.len() } else { 0 }
        );
        assert!(full(&pairing, 0, u.len()).iter().any(|n| *n != 0.0));
    }
}

#[test]
fn tangents_turn_little_with_the_normal_about_every_axis() {
    // walls and floors of either sign, and noise on them: no jump of the tangents
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let frame = |noise: f64| {
                let mut normal = [noise; 3];
                normal[axis] = sign * (1.0 - 2.0 * noise * noise).sqrt();
                let target = Target::Rigid(
                    Plane {
                        point: [0.0; 3],
                        normal,
                    }
                    .into(),
                );
                let contact = contact(vec![Point::at_node(0, 1.0, 1.0)], target);
                let places = Places {
                    unknowns: &Unknowns::translations(3, 1),
                    time: 0.0,
                    x: &[[0.0; 3]],
                    u: &[0.0; 3],
                    frames: Frames::default(),
                };
                let pairing = paired(&contact, &places);
                pairing.tangents.map(|tangent| tangent.normal(0))
            };
            let (one, other) = (frame(1e-8), frame(-1e-8));
            for (a, b) in one.iter().flatten().zip(other.iter().flatten()) {
                // the frame turns at most by 1/(1 + n·e) times the angle, e at 18 to 73 degrees from the axes
                assert!((a - b).abs() < 1e-6, "{one:?} {other:?}");
            }
        }
    }
}
