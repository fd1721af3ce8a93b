//! Where the two models end in the overlap, and the distance to those places.
//!
//! A weight goes from 0 at the border where its model ends to 1 at the border where the other one ends. A border that
//! lies in one plane is extended to all of it: the feet of perpendiculars from a point near the side of a body on an
//! oblique border lie outside the body, and the distance to the border alone would not be affine there.

use std::cell::Cell as Memory;

use carom_mesh::{Bounds, BoxTree};

use crate::cell::norm;
use crate::polytope::{Facet, Plane, cross, dot, sub};

/// One border of one connected part of the overlap.
#[derive(Clone, Debug)]
pub(crate) struct Border {
    /// Its plane, if it lies in one.
    pub plane: Option<Plane>,
    facets: Vec<Facet>,
    tree: BoxTree,
    /// The facet that was nearest last: its distance bounds the next search.
    last: Memory<usize>,
}

impl Border {
    /// The border made of some facets; `None` without any. `length`: that of a cell, to judge flatness by.
    pub fn new(facets: Vec<Facet>, length: f64) -> Option<Border> {
        let first = facets.first()?;
        let plane = Plane::new(&first.vertices[0], &first.normal);
        let flat = facets.iter().all(|facet| {
            let near = |x: &[f64; 3]| plane.distance(x).abs() <= 1e-9 * length;
            dot(&facet.normal, &plane.normal) > 0.5 && facet.vertices.iter().all(near)
        });
        let bounds: Vec<Bounds> = facets.iter().map(|f| Bounds::of(&f.vertices)).collect();
        Some(Border {
            plane: flat.then_some(plane),
            tree: BoxTree::new(&bounds),
            facets,
            last: Memory::new(0),
        })
    }

    /// Distance of a position.
    pub fn distance(&self, x: &[f64; 3]) -> f64 {
        match &self.plane {
            Some(plane) => plane.distance(x).abs(),
            None => norm(&sub(x, &self.nearest(x))),
        }
    }

    /// The nearest point of the border.
    pub fn nearest(&self, x: &[f64; 3]) -> [f64; 3] {
        if let Some(plane) = &self.plane {
            let d = plane.distance(x);
            return [0, 1, 2].map(|i| x[i] - d * plane.normal[i]);
        }
        let mut best = nearest_on(&self.facets[self.last.get()].vertices, x);
        let mut least = norm(&sub(x, &best));
        let mut found = Vec::new();
        self.tree.near(x, least, &mut found);
        for &i in &found {
            let point = nearest_on(&self.facets[i as usize].vertices, x);
            let distance = norm(&sub(x, &point));
            if distance < least {
                (best, least) = (point, distance);
                self.last.set(i as usize);
            }
        }
        best
    }
}

/// The point of a facet (point, segment or convex polygon) nearest to a position.
fn nearest_on(vertices: &[[f64; 3]], x: &[f64; 3]) -> [f64; 3] {
    let n = vertices.len();
    if n > 2
        && let Some(foot) = foot_inside(vertices, x)
    {
        return foot;
    }
    let edges = if n == 2 { 1 } else { n };
    let feet = (0..edges).map(|i| foot_on_segment(&vertices[i], &vertices[(i + 1) % n], x));
    let first = vertices[0];
    feet.fold(first, |best, foot| {
        let nearer = norm(&sub(x, &foot)) < norm(&sub(x, &best));
        if nearer { foot } else { best }
    })
}

/// The foot of the perpendicular on a convex polygon, if it lies in it.
fn foot_inside(vertices: &[[f64; 3]], x: &[f64; 3]) -> Option<[f64; 3]> {
    let plane = Plane::of_face(vertices);
    let d = plane.distance(x);
    let foot = [0, 1, 2].map(|i| x[i] - d * plane.normal[i]);
    let left = |i: usize| {
        let (a, b) = (&vertices[i], &vertices[(i + 1) % vertices.len()]);
        dot(&cross(&sub(b, a), &sub(&foot, a)), &plane.normal) >= 0.0
    };
    (0..vertices.len()).all(left).then_some(foot)
}

fn foot_on_segment(a: &[f64; 3], b: &[f64; 3], x: &[f64; 3]) -> [f64; 3] {
    let along = sub(b, a);
    let t = dot(&sub(x, a), &along) / dot(&along, &along).max(f64::MIN_POSITIVE);
    let t = t.clamp(0.0, 1.0);
    [0, 1, 2].map(|i| a[i] + t * along[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flat_border_is_extended_and_a_bent_one_is_not() {
        let edge = |a: [f64; 2], b: [f64; 2]| Facet {
            vertices: vec![[a[0], a[1], 0.0], [b[0], b[1], 0.0]],
            normal: [b[1] - a[1], a[0] - b[0], 0.0],
            measure: 1.0,
        };
        let flat = Border::new(vec![edge([1.0, 0.0], [1.0, 1.0])], 1.0).unwrap();
        assert_eq!(flat.distance(&[3.0, 7.0, 0.0]), 2.0);
        let bent = vec![edge([1.0, 0.0], [1.0, 1.0]), edge([1.0, 1.0], [0.0, 1.0])];
        let bent = Border::new(bent, 1.0).unwrap();
        assert!(bent.plane.is_none());
        for (x, expected) in [
            ([4.0, 5.0], 5.0),
            ([0.5, 3.0], 2.0),
            ([0.9, 0.2], 0.1),
            ([0.2, 0.9], 0.1),
        ] {
            assert!((bent.distance(&[x[0], x[1], 0.0]) - expected).abs() < 1e-15);
        }
        assert!(Border::new(Vec::new(), 1.0).is_none());
    }

    #[test]
    fn the_nearest_point_of_a_polygon_is_inside_on_an_edge_or_a_corner() {
        let square = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(nearest_on(&square, &[0.5, 0.25, 2.0]), [0.5, 0.25, 0.0]);
        assert_eq!(nearest_on(&square, &[0.5, -1.0, 1.0]), [0.5, 0.0, 0.0]);
        assert_eq!(nearest_on(&square, &[2.0, 3.0, 1.0]), [1.0, 1.0, 0.0]);
    }
}
