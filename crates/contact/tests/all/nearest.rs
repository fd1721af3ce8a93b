//! Balls and cylinders that meet lines and faces between their nodes.

use carom_algebra::unknowns::Unknowns;
use carom_contact::{
    Contact, Cylinder, Frames, Obstacle, Places, Point, Shape, Side, Sphere, Target,
};
use carom_testing::Random;

use crate::fixture::{assert_derivatives, contact, paired};

const RADIUS: f64 = 0.1;

/// A slightly warped quadrilateral over the obstacles, and a node further on beside each of two edges.
const NODES: [[f64; 3]; 6] = [
    [-0.5, -0.4, 0.21],
    [0.6, -0.5, 0.18],
    [0.5, 0.5, 0.2],
    [-0.6, 0.4, 0.19],
    [0.0, -1.5, 0.6],
    [0.0, 1.5, 0.7],
];

fn ball() -> Obstacle {
    Shape::Sphere(Sphere {
        centre: [0.03, -0.05, 0.0],
        radius: RADIUS,
        side: Side::Outside,
    })
    .into()
}

/// Square to the second axis, a little turned.
fn cylinder() -> Obstacle {
    Shape::Cylinder(Cylinder {
        point: [0.05, 0.0, 0.0],
        axis: [0.28, 0.96, 0.0],
        radius: RADIUS,
        side: Side::Outside,
    })
    .into()
}

fn point(nodes: &[u32], beside: &[u32], around: f64) -> Point {
    Point::near_round(nodes, beside, (around, 1.0, 1.0))
}

fn places<'a>(unknowns: &'a Unknowns, u: &'a [f64], x: &'a [[f64; 3]]) -> Places<'a> {
    Places {
        unknowns,
        time: 0.0,
        x,
        u,
        frames: Frames::default(),
    }
}

/// The gap is the least distance over the line or the face, tried all over, less the radii.
#[test]
fn the_gap_is_the_least_over_the_face() {
    let unknowns = Unknowns::translations(3, NODES.len());
    let still = vec![0.0; unknowns.len()];
    let places = places(&unknowns, &still, &NODES);
    for (obstacle, nodes) in [
        (ball(), &[0, 1, 2, 3][..]),
        (ball(), &[0, 1, 2]),
        (ball(), &[0, 1]),
        (cylinder(), &[0, 1]),
    ] {
        let point = point(nodes, &[], 0.01);
        let contact = contact(vec![point], Target::Rigid(obstacle.clone()));
        let gap = paired(&contact, &places).rows.gap(0);
        let least = least(&obstacle, nodes) - 0.01;
        // steps of 1/400 of lengths of a metre, about a place that is stationary: their square over the distance
        assert!(gap <= least + 1e-12 && least - gap < 1e-4, "{gap} {least}");
    }
}

fn least(obstacle: &Obstacle, nodes: &[u32]) -> f64 {
    const STEPS: usize = 400;
    let x: Vec<[f64; 3]> = nodes.iter().map(|&node| NODES[node as usize]).collect();
    let mut least = f64::INFINITY;
    for i in 0..=STEPS {
        for j in 0..=STEPS {
            let (s, t) = (i as f64 / STEPS as f64, j as f64 / STEPS as f64);
            let shape = match nodes.len() {
                2 => vec![1.0 - s, s],
                3 if s + t <= 1.0 => vec![1.0 - s - t, s, t],
                3 => continue,
                _ => vec![(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t],
            };
            let place = [0, 1, 2].map(|k| x.iter().zip(&shape).map(|(x, n)| n * x[k]).sum::<f64>());
            least = least.min(obstacle.at(0.0).distance(&place).gap);
        }
    }
    least
}

/// Rows and second derivatives where the place moves over lines and faces, in random configurations.
#[test]
fn rows_and_curvature_are_derivatives_while_the_place_moves() {
    let unknowns = Unknowns::translations(3, NODES.len());
    let mut random = Random(3);
    for _ in 0..4 {
        let bend = random.vector(unknowns.len());
        let u: Vec<f64> = bend.iter().map(|u| 0.03 * u).collect();
        let places = places(&unknowns, &u, &NODES);
        for (obstacle, nodes) in [
            (ball(), &[0, 1, 2, 3][..]),
            (ball(), &[0, 1, 2]),
            (ball(), &[3, 1]),
            (cylinder(), &[3, 2]),
        ] {
            let point = point(nodes, &[], 0.01);
            let contact = contact(vec![point], Target::Rigid(obstacle));
            assert!(paired(&contact, &places).rows.gap(0).is_finite());
            assert_derivatives(&places, |places| paired(&contact, places));
        }
    }
}

/// Nodes hold what is nearest at an end, and faces what is nearest inside of them: an edge counts only where both faces beside it lead away.
#[test]
fn what_is_nearest_is_told_once() {
    let unknowns = Unknowns::translations(3, NODES.len());
    let still = vec![0.0; unknowns.len()];
    let gap = |of: Contact, x: &[[f64; 3]]| paired(&of, &places(&unknowns, &still, x)).rows.gap(0);
    let of =
        |point: Point, obstacle: &Obstacle| contact(vec![point], Target::Rigid(obstacle.clone()));
    // the face 0 1 2 3 is over the ball: its edge 0 1 is not where the surface is nearest
    assert!(gap(of(point(&[0, 1], &[3, 4], 0.0), &ball()), &NODES).is_infinite());
    assert!(gap(of(point(&[0, 1, 2, 3], &[], 0.0), &ball()), &NODES).is_finite());
    // a roof over it whose ridge is turned down: both faces lead away
    let mut roof = NODES;
    (roof[0], roof[1]) = ([-0.5, -0.05, 0.15], [0.6, -0.05, 0.15]);
    assert!(gap(of(point(&[0, 1], &[3, 4], 0.0), &ball()), &roof).is_finite());
    assert!(gap(of(point(&[0, 1, 2, 3], &[], 0.0), &ball()), &roof).is_infinite());
    // a line that ends before the ball, and one along the cylinder
    let mut ends = NODES;
    (ends[0], ends[1]) = ([0.4, 0.0, 0.0], [0.8, 0.0, 0.0]);
    assert!(gap(of(point(&[0, 1], &[], 0.0), &ball()), &ends).is_infinite());
    (ends[0], ends[1]) = ([0.3, -0.96, 0.0], [0.86, 0.96, 0.0]);
    assert!(gap(of(point(&[0, 1], &[], 0.0), &cylinder()), &ends).is_infinite());
}
