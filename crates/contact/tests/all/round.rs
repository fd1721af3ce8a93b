//! Surfaces around axes: rows and curvature, crossings, moments of friction.

use carom_algebra::unknowns::{NodeKind, Unknowns};
use carom_contact::{Frames, Pairing, Places, Plane, Point, Target};
use carom_elements::Kind;
use carom_mesh::Face;
use carom_testing::Random;

use crate::fixture::{assert_balanced, assert_derivatives, contact, face, paired};

const RADII: [f64; 2] = [0.1, 0.2];

fn axis(nodes: [u32; 2], radius: f64) -> Face {
    Face {
        radius: Some(radius),
        ..face(Kind::Bar2, &nodes)
    }
}

fn places<'a>(unknowns: &'a Unknowns, x: &'a [[f64; 3]], u: &'a [f64]) -> Places<'a> {
    Places {
        unknowns,
        time: 0.0,
        x,
        u,
        frames: Frames::default(),
    }
}

#[test]
fn derivatives_of_the_gap_between_a_point_and_an_axis_are_right_beside_it_and_beyond_its_end() {
    for (dim, z) in [(2, 0.0), (3, 0.3)] {
        for beyond in [0.4, 1.3] {
            let x = [[0.0; 3], [1.0, 0.2, 0.0], [beyond, 0.5, z]];
            let points = vec![Point::at_node(2, 1.0, 1.0).around(RADII[0])];
            let contact = contact(points, Target::Surface(vec![axis([0, 1], RADII[1])]));
            let unknowns = Unknowns::translations(dim, 3);
            let u = vec![0.01; 3 * dim];
            let places = places(&unknowns, &x, &u);
            assert_derivatives(&places, |places| paired(&contact, places));
            assert_balanced(&paired(&contact, &places), 0, &places, 1e-14);
        }
    }
}

/// Two axes that cross, at an angle, `gap` apart beyond their radii.
fn crossed(gap: f64) -> (Vec<[f64; 3]>, Vec<Point>, Target) {
    let z = gap + RADII[0] + RADII[1];
    let x = vec![
        [-1.0, 0.2, 0.0],
        [1.0, 0.1, 0.0],
        [0.3, -1.0, z],
        [0.2, 1.5, z],
    ];
    let points = vec![
        Point::at_node(0, 1.0, 0.5).around(RADII[0]),
        Point::crossing(&axis([0, 1], RADII[0]), 1.0),
    ];
    (x, points, Target::Surface(vec![axis([2, 3], RADII[1])]))
}

#[test]
fn two_axes_that_cross_meet_between_their_nodes_with_right_derivatives() {
    let (x, points, target) = crossed(-0.01);
    let contact = contact(points, target);
    let unknowns = Unknowns::translations(3, 4);
    let mut random = Random(3);
    let u: Vec<f64> = random.vector(12).iter().map(|u| 0.02 * u).collect();
    let at_rest = paired(&contact, &places(&unknowns, &x, &[0.0; 12]));
    assert!((at_rest.rows.gap(1) + 0.01).abs() < 1e-15);
    assert!((at_rest.rows.normal(1)[2] + 1.0).abs() < 1e-15);
    assert!(at_rest.rows.gap(0) > 0.5);
    let moved = places(&unknowns, &x, &u);
    assert_derivatives(&moved, |places| paired(&contact, places));
    assert_balanced(&paired(&contact, &moved), 1, &moved, 1e-14);
}

/// Axes that are nearly parallel are held at nodes: a crossing between these would hold the same twice.
#[test]
fn axes_along_each_other_do_not_cross() {
    let unknowns = Unknowns::translations(3, 4);
    let crosses = |angle: f64| {
        let (points, target) = (crossed(0.0).1, crossed(0.0).2);
        let x = [
            [-1.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [-1.2, -1.2 * angle, 0.3],
            [1.2, 1.2 * angle, 0.3],
        ];
        let places = places(&unknowns, &x, &[0.0; 12]);
        paired(&contact(points, target), &places)
            .rows
            .gap(1)
            .is_finite()
    };
    // half a metre from the crossing the distance grows by (1 - cos) of the arm: 1e-3 of the radii at an angle of 0.013
    assert!(!crosses(0.0) && !crosses(0.01) && crosses(0.02));
}

/// Moment of a row about the origin: forces at the nodes and moments on their rotations.
fn moment(pairing: &Pairing, tangent: usize, places: &Places, node: u32) -> [[f64; 3]; 2] {
    let mut row = vec![0.0; places.u.len()];
    pairing.tangents[tangent].add_force(0, 1.0, &mut row);
    let (x, f) = (places.of(node), places.unknowns.vector(node, &row));
    let turn = places.unknowns.spin(node, &row);
    let of = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        x[j] * f[k] - x[k] * f[j] + turn[i]
    };
    [f, [0, 1, 2].map(of)]
}

/// A force of friction acts at the surface: on an obstacle at the radius below the node; between two axes that touch the forces on
/// both, with the moments on their rotations, have no moment.
#[test]
fn friction_acts_at_the_surface() {
    let unknowns = Unknowns::new(3, [NodeKind::SmallRotations; 4]);
    let u = vec![0.0; 24];
    let x = [[0.4, 0.7, 0.3]; 4];
    let at = places(&unknowns, &x, &u);
    let floor = Plane {
        point: [0.0; 3],
        normal: [0.0, 0.0, 1.0],
    };
    let points = vec![Point::at_node(0, 1.0, 1.0).around(0.3)];
    let pairing = paired(&contact(points, Target::Rigid(floor.into())), &at);
    assert!(pairing.rows.gap(0).abs() < 1e-15);
    for tangent in 0..2 {
        let [t, total] = moment(&pairing, tangent, &at, 0);
        let surface = [0.4, 0.7, 0.0];
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let expected = surface[j] * t[k] - surface[k] * t[j];
            assert!((total[i] - expected).abs() < 1e-15);
        }
    }
    let (x, points, target) = crossed(0.0);
    let at = places(&unknowns, &x, &u);
    let pairing = paired(&contact(points[1..].to_vec(), target), &at);
    for tangent in 0..2 {
        let all: Vec<_> = (0..4)
            .map(|node| moment(&pairing, tangent, &at, node))
            .collect();
        for i in 0..3 {
            for kind in 0..2 {
                assert!(all.iter().map(|m| m[kind][i]).sum::<f64>().abs() < 1e-15);
            }
        }
    }
}
