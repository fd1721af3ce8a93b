//! Rigid obstacles as triangles and lines, near the contact that they belong to: planes and cylinders have no ends.

use std::f64::consts::{PI, TAU};

use carom_contact::{Obstacle, RigidSurface, Shape, Sphere};
use carom_elements::Kind;

use crate::results::outlines::{along, ring};

/// Pieces around a full turn, and squares along a side of the grid on which curves in the plane are found.
const PIECES: usize = 48;
const SQUARES: usize = 120;

/// Triangles and ends of lines, places in m.
#[derive(Debug, Default)]
pub(crate) struct Drawn {
    pub(crate) triangles: Vec<[f64; 3]>,
    pub(crate) lines: Vec<[f64; 3]>,
}

/// A box of which an obstacle is drawn near: lowest and highest corner, m.
pub(crate) type Near = [[f64; 3]; 2];

/// An obstacle at time 0, as far as it is near a box.
pub(crate) fn drawn(obstacle: &Obstacle, dim: usize, near: &Near) -> Drawn {
    let [low, high] = near;
    let centre = [0, 1, 2].map(|i| 0.5 * (low[i] + high[i]));
    let reach = 0.5 * distance(low, high);
    match (&obstacle.shape, dim) {
        (Shape::Surface(surface), _) => of_faces(surface),
        (_, 1) => Drawn::default(),
        (_, 2) => in_plane(obstacle, near),
        (Shape::Plane(plane), _) => {
            let foot = foot(&plane.point, &plane.normal, &centre);
            let [a, b] = across(&plane.normal);
            let corner = |s: f64, t: f64| add(&add(&foot, &a, s * reach), &b, t * reach);
            sheet(&|s, t| corner(2.0 * s - 1.0, 2.0 * t - 1.0), [6, 6])
        }
        (Shape::Sphere(sphere), _) => cap(sphere, &centre, reach),
        (Shape::Cylinder(cylinder), _) => {
            let middle = along_axis(&cylinder.point, &cylinder.axis, &centre);
            let [a, b] = across(&cylinder.axis);
            let place = |s: f64, t: f64| {
                let (sin, cos) = (TAU * s).sin_cos();
                let end = add(&middle, &cylinder.axis, (2.0 * t - 1.0) * reach);
                add(
                    &add(&end, &a, cylinder.radius * cos),
                    &b,
                    cylinder.radius * sin,
                )
            };
            sheet(&place, [PIECES, 1])
        }
        (Shape::Profile(profile), _) => {
            let (curve, axis) = profile.outline();
            let offset = dot(&axis, &sub(&centre, &curve[0]));
            let place = |s: f64, t: f64| {
                let k = (s * (curve.len() - 1) as f64).round() as usize;
                add(&curve[k], &axis, offset + (2.0 * t - 1.0) * reach)
            };
            sheet(&place, [curve.len() - 1, 1])
        }
    }
}

/// The rows of the matrix that brings an obstacle from time 0 to a time in s.
pub(crate) fn pose(obstacle: &Obstacle, time: f64) -> [f64; 12] {
    let origin = obstacle.moved(&[0.0; 3], time);
    let column = |i: usize| {
        let mut unit = [0.0; 3];
        unit[i] = 1.0;
        sub(&obstacle.moved(&unit, time), &origin)
    };
    let columns = [column(0), column(1), column(2), origin];
    std::array::from_fn(|k| columns[k % 4][k / 4])
}

/// Part of a sphere around its place nearest to a centre: all of it if it is no larger than the reach.
fn cap(sphere: &Sphere, centre: &[f64; 3], reach: f64) -> Drawn {
    let way = sub(centre, &sphere.centre);
    let length = dot(&way, &way).sqrt();
    let pole = match length > 1e-9 * sphere.radius {
        true => way.map(|w| w / length),
        false => [0.0, 0.0, 1.0],
    };
    let widest = (1.2 * reach / sphere.radius).min(PI);
    let [a, b] = across(&pole);
    let place = |s: f64, t: f64| {
        let ((sin, cos), (up, height)) = ((TAU * s).sin_cos(), (widest * t).sin_cos());
        let ring = add(&add(&[0.0; 3], &a, up * cos), &b, up * sin);
        add(
            &add(&sphere.centre, &ring, sphere.radius),
            &pole,
            sphere.radius * height,
        )
    };
    sheet(&place, [PIECES, PIECES / 3])
}

/// A sheet over two parameters from 0 to 1 in so many pieces, with lines along its rim.
fn sheet(place: &dyn Fn(f64, f64) -> [f64; 3], [n, m]: [usize; 2]) -> Drawn {
    let at = |i: usize, j: usize| place(i as f64 / n as f64, j as f64 / m as f64);
    let mut drawn = Drawn::default();
    for i in 0..n {
        for j in 0..m {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            drawn.triangles.extend([a, b, c, a, c, d]);
        }
        drawn.lines.extend([at(i, 0), at(i + 1, 0)]);
        drawn.lines.extend([at(i, m), at(i + 1, m)]);
    }
    drawn
}

/// The curve of an obstacle in the plane: where the gap changes sign on a grid, straight inside of its squares.
fn in_plane(obstacle: &Obstacle, [low, high]: &Near) -> Drawn {
    let placed = obstacle.at(0.0);
    let step = [0, 1].map(|i| (high[i] - low[i]) / SQUARES as f64);
    let at = |i: usize, j: usize| {
        [
            low[0] + i as f64 * step[0],
            low[1] + j as f64 * step[1],
            0.0,
        ]
    };
    let gap = |i: usize, j: usize| placed.distance(&at(i, j)).gap;
    let mut below: Vec<f64> = (0..=SQUARES).map(|i| gap(i, 0)).collect();
    let mut drawn = Drawn::default();
    for j in 0..SQUARES {
        let above: Vec<f64> = (0..=SQUARES).map(|i| gap(i, j + 1)).collect();
        for i in 0..SQUARES {
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let gaps = [below[i], below[i + 1], above[i + 1], above[i]];
            let mut crossed = Vec::new();
            for k in 0..4 {
                let (a, b) = (gaps[k], gaps[(k + 1) % 4]);
                if (a > 0.0) != (b > 0.0) && a.is_finite() && b.is_finite() {
                    let (p, q) = (corners[k], corners[(k + 1) % 4]);
                    let (p, q) = (at(p.0, p.1), at(q.0, q.1));
                    crossed.push(add(&p, &sub(&q, &p), a / (a - b)));
                }
            }
            if let [one, other, ..] = crossed[..] {
                drawn.lines.extend([one, other]);
            }
        }
        below = above;
    }
    drawn
}

fn of_faces(surface: &RigidSurface) -> Drawn {
    let (faces, x) = surface.faces();
    let mut drawn = Drawn::default();
    for face in faces {
        let around = around(face.kind, face.corners());
        let places: Vec<[f64; 3]> = around.iter().map(|node| x[*node as usize]).collect();
        match face.kind.table().dim {
            2 => {
                for k in 2..places.len() {
                    drawn
                        .triangles
                        .extend([places[0], places[k - 1], places[k]]);
                }
            }
            _ => {
                let pairs = places.windows(2);
                drawn
                    .lines
                    .extend(pairs.flat_map(|pair| [pair[0], pair[1]]));
            }
        }
    }
    drawn
}

/// The nodes of a face in turn.
pub(crate) fn around(kind: Kind, nodes: &[u32]) -> Vec<u32> {
    let table = kind.table();
    match table.dim {
        2 => ring(table.faces.iter().map(|face| face.nodes), nodes),
        _ => along(nodes),
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn sub(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn add(a: &[f64; 3], b: &[f64; 3], factor: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] + factor * b[i])
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let way = sub(a, b);
    dot(&way, &way).sqrt()
}

/// Foot of a place on the plane through a point across a unit normal.
fn foot(point: &[f64; 3], normal: &[f64; 3], place: &[f64; 3]) -> [f64; 3] {
    add(place, normal, -dot(normal, &sub(place, point)))
}

/// Foot of a place on the line through a point along a unit axis.
fn along_axis(point: &[f64; 3], axis: &[f64; 3], place: &[f64; 3]) -> [f64; 3] {
    add(point, axis, dot(axis, &sub(place, point)))
}

/// Two unit vectors across a unit vector and each other.
fn across(n: &[f64; 3]) -> [[f64; 3]; 2] {
    let least = (0..3).fold(
        0,
        |best, i| if n[i].abs() < n[best].abs() { i } else { best },
    );
    let mut a = [0.0; 3];
    a[least] = 1.0;
    let a = foot(&[0.0; 3], n, &a);
    let length = dot(&a, &a).sqrt();
    let a = a.map(|c| c / length);
    let b = [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        n[j] * a[k] - n[k] * a[j]
    });
    [a, b]
}

#[cfg(test)]
mod tests {
    use carom_contact::{Cylinder, Motion, Plane, Side, Translation, Turn};

    use super::*;

    const NEAR: Near = [[-1.0, -2.0, -1.0], [2.0, 1.0, 1.5]];

    /// Every place drawn lies on the obstacle: its gap is zero.
    fn lie_on(obstacle: Obstacle, dim: usize, tolerance: f64) {
        let drawn = drawn(&obstacle, dim, &NEAR);
        let places = drawn.triangles.iter().chain(&drawn.lines);
        assert!(places.clone().count() > 0);
        for place in places {
            let gap = obstacle.at(0.0).distance(place).gap;
            assert!(gap.abs() < tolerance, "{place:?} {gap}");
        }
    }

    #[test]
    fn corners_of_what_is_drawn_lie_on_the_obstacle() {
        let point = [0.1, 0.2, 0.3];
        let (normal, side) = ([0.6, 0.0, 0.8], Side::Outside);
        lie_on(Plane { point, normal }.into(), 3, 1e-12);
        for radius in [0.5, 300.0] {
            let sphere = Sphere {
                centre: point,
                radius,
                side,
            };
            lie_on(sphere.into(), 3, 1e-11);
            let axis = [0.0, 0.0, 1.0];
            lie_on(
                Cylinder {
                    point,
                    axis,
                    radius,
                    side,
                }
                .into(),
                3,
                1e-11,
            );
        }
        // a chord of a circle of radius r across squares of size h is off by h²/8r at most
        let circle = Cylinder {
            point,
            axis: [0.0, 0.0, 1.0],
            radius: 0.7,
            side,
        };
        let h: f64 = 3.0 / 120.0;
        lie_on(circle.into(), 2, 2.0 * h * h / (8.0 * 0.7));
    }

    #[test]
    fn the_matrix_of_a_pose_moves_as_the_obstacle_does() {
        let axis = [0.6, 0.0, 0.8];
        let obstacle = Obstacle {
            shape: Shape::Plane(Plane {
                point: [0.0; 3],
                normal: axis,
            }),
            motion: Motion {
                translation: Some(Translation::Velocity([1.0, -2.0, 0.5])),
                turn: Some(Turn {
                    point: [0.3, 0.2, 0.1],
                    axis,
                    rate: 2.0,
                }),
            },
        };
        let matrix = pose(&obstacle, 0.7);
        let x = [0.4, -1.0, 2.0];
        let moved = obstacle.moved(&x, 0.7);
        for i in 0..3 {
            let row = &matrix[4 * i..4 * i + 4];
            let found = dot(&[row[0], row[1], row[2]], &x) + row[3];
            assert!((found - moved[i]).abs() < 1e-14);
        }
    }
}
