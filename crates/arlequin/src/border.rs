//! Where the two models end in the overlap, and the distance to those places.
//!
//! A weight goes from 0 at the border where its model ends to 1 at the border where the other one ends. A border that
//! lies in one plane is extended to all of it: the feet of perpendiculars from a point near the side of a body on an
//! oblique border lie outside the body, and the distance to the border alone would not be affine there.

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
        })
    }

    /// Distance of a position.
    pub fn distance(&self, x: &[f64; 3], hint: &mut usize) -> f64 {
        match &self.plane {
            Some(plane) => plane.distance(x).abs(),
            None => norm(&sub(x, &self.nearest(x, hint))),
        }
    }

    /// The nearest point of the border. `hint`: a facet that is probably near, such as that of the last position; it
    /// becomes the nearest one and decides only how long the search takes.
    pub fn nearest(&self, x: &[f64; 3], hint: &mut usize) -> [f64; 3] {
        if let Some(plane) = &self.plane {
            let d = plane.distance(x);
            return [0, 1, 2].map(|i| x[i] - d * plane.normal[i]);
        }
        let foot = |i: usize| {
            let point = nearest_on(&self.facets[i].vertices, x);
            (norm(&sub(x, &point)), point)
        };
        *hint = (*hint).min(self.facets.len() - 1);
        let (mut best, mut found) = (foot(*hint), Vec::new());
        // Whatever is nearer than the hint lies within its distance, which is small if the hint is good.
        self.tree.near(x, best.0, &mut found);
        for &i in &found {
            let other = foot(i as usize);
            if other.0 < best.0 {
                (best, *hint) = (other, i as usize);
            }
        }
        best.1
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
    let distance = |point: &[f64; 3]| norm(&sub(x, point));
    feet.min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .unwrap_or(vertices[0])
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
        assert_eq!(flat.distance(&[3.0, 7.0, 0.0], &mut 0), 2.0);
        let bent = vec![edge([1.0, 0.0], [1.0, 1.0]), edge([1.0, 1.0], [0.0, 1.0])];
        let bent = Border::new(bent, 1.0).unwrap();
        assert!(bent.plane.is_none());
        for (x, expected) in [
            ([4.0, 5.0], 5.0),
            ([0.5, 3.0], 2.0),
            ([0.9, 0.2], 0.1),
            ([0.2, 0.9], 0.1),
        ] {
            for mut hint in [0, 1, 9] {
                let found = bent.distance(&[x[0], x[1], 0.0], &mut hint);
                assert!((found - expected).abs() < 1e-15);
            }
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
