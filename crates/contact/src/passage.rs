//! Points that a step carries through what they face, so that nothing after it tells of the contact.
//!
//! A point that ends a step behind a face is found there, and its law pushes it back. It is not found where it has gone so far that another
//! face is closer, on the far side of a body or of a rigid ball, or deeper than it may see. Whether one has done so is told by its way in the
//! step, against that of each face, taken as straight.

use carom_elements::Kind;
use carom_mesh::{Bounds, Face};

use crate::passed::passed_face;
use crate::search::faces::FaceTree;
use crate::{Contact, Obstacle, Places, Point, Search, Shape, Side, Sliding, Target};

/// Part of the radius of a round obstacle by which a look along the way of a point goes on at least: of what it passes over, no chord is longer.
const CHORD: f64 = 1e-2;

impl Contact {
    /// Depth up to which a point that has come behind what it faces is seen there whatever the target looks like from behind, m; infinite
    /// where it always is. `element`: the least size of the elements normal to both surfaces, m.
    pub fn depth_of_sight(&self, element: f64) -> f64 {
        match &self.target {
            _ if self.sliding == Sliding::Small => f64::INFINITY,
            // past what turns a place that stands goes round
            Target::Rigid(obstacle) if obstacle.motion.turn.is_some() => f64::INFINITY,
            Target::Rigid(obstacle) => half_of(&obstacle.shape),
            Target::Surface(faces) if !faces.iter().any(may_be_passed) => f64::INFINITY,
            Target::Surface(_) => {
                let deep = self.sight.as_ref().map(|sight| sight.least_depth());
                (0.5 * element).min(deep.unwrap_or(f64::INFINITY))
            }
        }
    }

    /// The most that a node of either side moves against the target's own motion from one configuration to another, m: that of an obstacle at
    /// the places of the points.
    pub fn way(&self, ways: [&Places; 2]) -> f64 {
        let [start, end] = ways;
        let nodes = self.points.iter().flat_map(Point::carriers);
        let own = nodes.map(|(node, _)| {
            let [from, to] = [start, end].map(|places| match &self.target {
                Target::Rigid(obstacle) => obstacle.at(places.time).back(&places.of(node)),
                Target::Surface(_) => places.of(node),
            });
            squared(&from, &to)
        });
        let other = match &self.target {
            Target::Surface(faces) => most(faces, ways),
            Target::Rigid(_) => 0.0,
        };
        own.fold(0.0, f64::max).sqrt().max(other)
    }

    /// How many of some points, by number, that are not `closed` have passed what they face from one configuration to another, and are not
    /// seen behind it. Points that are thick, or whose gaps count from elsewhere, are left out, and so are round faces.
    pub fn passed(
        &self,
        ways: [&Places; 2],
        points: impl Iterator<Item = usize>,
        closed: impl Fn(usize) -> bool,
    ) -> usize {
        let [_, end] = ways;
        let plain = |k: &usize| {
            let point = &self.points[*k];
            !point.crosses() && point.radius == 0.0 && self.offset(*k) == 0.0 && !closed(*k)
        };
        let points = points.filter(plain);
        match &self.target {
            Target::Rigid(obstacle) => points
                .filter(|&k| is_through(obstacle, &self.points[k], ways))
                .count(),
            Target::Surface(faces) => {
                let (mut search, mut room) = (Search::default(), Vec::new());
                self.renew(end, &mut search);
                let moved = most(faces, ways);
                let given = (faces.as_slice(), moved);
                let passes = |&k: &usize| {
                    let view = self.view(k);
                    let faces_it = |item: u32| !view.is_some_and(|view| view.is_beside(item));
                    let of = (&self.points[k], faces_it);
                    let entered = entered(of, given, ways, (&search.faces, &mut room));
                    entered.is_some_and(|normal| {
                        let of = (&self.points[k], self.view(k));
                        let found = search.facing(end, faces, of);
                        !found.is_some_and(|(foot, _)| {
                            foot.gap < 0.0 && dot(&foot.normal, &normal) > 0.0
                        })
                    })
                };
                points.filter(passes).count()
            }
        }
    }
}

/// Whether a face has a side that a point can pass.
fn may_be_passed(face: &Face) -> bool {
    face.kind != Kind::Point1 && face.radius.is_none()
}

/// Half the least thickness of an obstacle, m: a place as deep is as near to its far side. Infinite of what has none.
fn half_of(shape: &Shape) -> f64 {
    match shape {
        Shape::Plane(_) => f64::INFINITY,
        Shape::Sphere(sphere) => outside(sphere.side, sphere.radius),
        Shape::Cylinder(cylinder) => outside(cylinder.side, cylinder.radius),
        Shape::Profile(profile) => outside(profile.side(), profile.least_radius()),
        Shape::Surface(surface) => 0.5 * surface.least_size(),
    }
}

/// Half the thickness of a round shape, that of a hollow being infinite, m.
fn outside(side: Side, radius: f64) -> f64 {
    match side {
        Side::Outside => 0.5 * radius,
        Side::Inside => f64::INFINITY,
    }
}

/// The most that a node of some faces moves, m.
fn most(faces: &[Face], [start, end]: [&Places; 2]) -> f64 {
    let nodes = faces.iter().flat_map(Face::corners);
    let ways = nodes.map(|&node| squared(&start.of(node), &end.of(node)));
    ways.fold(0.0, f64::max).sqrt()
}

/// The normal of a face that a point has passed from before it to behind it, of those that it faces, by number.
fn entered(
    (point, faces_it): (&Point, impl Fn(u32) -> bool),
    (faces, moved): (&[Face], f64),
    [start, end]: [&Places; 2],
    (tree, room): (&FaceTree, &mut Vec<u32>),
) -> Option<[f64; 3]> {
    let [from, to] = [start, end].map(|places| point.place(places));
    let around = Bounds::of(&[from, to]).widened(moved);
    tree.overlapping((end, faces), &around, room);
    room.iter().find_map(|&item| {
        let face = &faces[item as usize];
        if !may_be_passed(face) || !faces_it(item) {
            return None;
        }
        let [before, now] = [start, end].map(|places| places.of_face(face));
        let n = face.corners().len();
        let way = |i: usize| (0..n).map(|a| now[a][i] - before[a][i]).sum::<f64>() / n as f64;
        let from = [0, 1, 2].map(|i| from[i] + way(i));
        passed_face((face, &now[..n]), [&from, &to])
    })
}

/// Whether a point has passed an obstacle and is not behind the side on which it came.
fn is_through(obstacle: &Obstacle, point: &Point, [start, end]: [&Places; 2]) -> bool {
    // where both would be if the obstacle had not moved
    let [from, to] = [start, end].map(|places| obstacle.at(places.time).back(&point.place(places)));
    let shape = &obstacle.shape;
    let came = match shape {
        Shape::Plane(_) => None,
        Shape::Surface(surface) => surface.passed(&from, &to),
        Shape::Sphere(_) | Shape::Cylinder(_) | Shape::Profile(_) => met(shape, [&from, &to]),
    };
    let last = shape.distance(&to);
    came.is_some_and(|normal| !(last.gap < 0.0 && dot(&last.normal, &normal) > 0.0))
}

/// The normal where the straight way between two places meets a round obstacle from outside, if it does: nothing is nearer than the gap.
fn met(shape: &Shape, [from, to]: [&[f64; 3]; 2]) -> Option<[f64; 3]> {
    let length = squared(from, to).sqrt();
    let least = CHORD * half_of(shape);
    let (mut gone, mut normal) = (0.0, None);
    while gone < length {
        let part = gone / length;
        let here = shape.distance(&[0, 1, 2].map(|i| from[i] + part * (to[i] - from[i])));
        if here.gap < 0.0 {
            return normal;
        }
        normal = Some(here.normal);
        gone += here.gap.max(least);
    }
    // what is behind its end is seen there
    (shape.distance(to).gap < 0.0).then_some(normal)?
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn squared(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum()
}
