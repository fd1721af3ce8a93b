//! What is opposite to a point, and where the axes of two beams, or sharp edges of two shells, come nearest that cross.
//!
//! Nodes see an axis that runs along theirs. One that crosses between two nodes is nearest to a place between them: there is one more
//! point for each line of a secondary axis, at the place that is nearest to the target. It faces something only where the axes are
//! nearer there than at the ends of the line, so that nodes and crossings do not hold the same twice.
//!
//! Edges of shells also cross where plates lie on each other, and are as far apart there as nodes are from faces: a rule of distances would let go what it has pushed away. They face each
//! other wherever their nearest places lie within both and they do not run along each other.

use carom_elements::Kind;
use carom_mesh::{Face, Projection};

use crate::faced::Faced;
use crate::search::faces::FaceTree;
use crate::search::{Search, foot_on};
use crate::sight::View;
use crate::{Places, Point};

/// Square of the sine of the angle of two lines up to which they run along each other, 6°: nodes hold sharp edges of shells that do.
pub(crate) const ALONG: f64 = 1e-2;
/// Distance from the ends of a line, in its reference coordinate, within which nodes hold what crosses there.
pub(crate) const AT_END: f64 = 1e-3;
/// How much nearer than its ends a place of a line must be, as a part of the sum of the radii.
const NEARER: f64 = 1e-3;

/// What is opposite to a point.
pub(crate) struct Opposite<'a> {
    /// The point, at the place that is nearest.
    pub point: Point,
    /// Its closest point.
    pub foot: Projection,
    /// The face of that.
    pub face: &'a Face,
    /// The edge that it is, of a point of an edge.
    pub faced: Option<Faced>,
}

impl Search {
    /// What is opposite to a point, if anything is. `view`: what it sees.
    pub(crate) fn opposite<'a>(
        &mut self,
        places: &Places,
        faces: &'a [Face],
        (point, view): (&Point, Option<View>),
    ) -> Option<Opposite<'a>> {
        if point.crosses() {
            return self.faces.crossed(places, faces, point);
        }
        let (foot, face) = self.facing(places, faces, (point, view))?;
        Some(Opposite {
            point: *point,
            foot,
            face,
            faced: None,
        })
    }
}

impl FaceTree {
    /// The place between the nodes of a point that is nearest to an axis.
    pub(crate) fn crossed<'a>(
        &self,
        places: &Places,
        faces: &'a [Face],
        point: &Point,
    ) -> Option<Opposite<'a>> {
        let ends = [-1.0, 1.0].map(|xi| point.moved_to(xi).place(places));
        let middle = [0, 1, 2].map(|i| 0.5 * (ends[0][i] + ends[1][i]));
        let half = 0.5 * distance(&ends[0], &ends[1]);
        let nearest = |item: u32| {
            let face = &faces[item as usize];
            match face.kind {
                Kind::Bar2 => {
                    let x = places.of_face(face);
                    between(&ends, &[x[0], x[1]])
                }
                // a line over a face is nearest to it at an end of its own, or at an edge of the face
                _ => Nearest {
                    xi: [0.0; 2],
                    distance: f64::INFINITY,
                    angle: 0.0,
                },
            }
        };
        // no place of the line is farther from its middle than its half
        let item = self.nearest(&middle, half, |item| nearest(item).distance)?;
        let found = nearest(item);
        let opposite = || {
            let point = point.moved_to(found.xi[0]);
            let (foot, face) = foot_on(places, faces, item, &point.place(places));
            Opposite {
                point,
                foot,
                face,
                faced: None,
            }
        };
        if faces[0].kind != Kind::Bar2 {
            let within = found.xi.iter().all(|xi| xi.abs() < 1.0 - AT_END);
            let crosses = found.distance < f64::INFINITY && within && found.angle > ALONG;
            return crosses.then(opposite);
        }
        let face = &faces[item as usize];
        let radii = point.radius + face.radius.unwrap_or(0.0);
        let at_end = |end: &[f64; 3]| {
            let measure = |item: u32| foot_on(places, faces, item, end).0.distance;
            self.nearest(end, 0.0, measure)
                .map_or(f64::INFINITY, measure)
        };
        let mut all = ends.iter();
        let nearer = all.all(|end| found.distance < at_end(end) - NEARER * radii);
        nearer.then(opposite)
    }
}

/// The nearest places of two segments.
pub(crate) struct Nearest {
    /// Their reference coordinates.
    pub xi: [f64; 2],
    /// m.
    pub distance: f64,
    /// Square of the sine of the angle of both.
    pub angle: f64,
}

/// Where two segments are nearest to each other. Of parallel segments some place of the nearest.
pub(crate) fn between(one: &[[f64; 3]; 2], other: &[[f64; 3]; 2]) -> Nearest {
    let sub = |a: &[f64; 3], b: &[f64; 3]| [0, 1, 2].map(|i| a[i] - b[i]);
    let dot = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
    let (d, e, r) = (
        sub(&one[1], &one[0]),
        sub(&other[1], &other[0]),
        sub(&one[0], &other[0]),
    );
    let (dd, de, ee, dr, er) = (
        dot(&d, &d),
        dot(&d, &e),
        dot(&e, &e),
        dot(&d, &r),
        dot(&e, &r),
    );
    let det = dd * ee - de * de;
    let free = match det > 1e-14 * dd * ee {
        true => ((de * er - dr * ee) / det).clamp(0.0, 1.0),
        false => 0.5,
    };
    let t = ((de * free + er) / ee).clamp(0.0, 1.0);
    let s = ((de * t - dr) / dd).clamp(0.0, 1.0);
    let way = [0, 1, 2].map(|i| r[i] + s * d[i] - t * e[i]);
    Nearest {
        xi: [s, t].map(|part| 2.0 * part - 1.0),
        distance: dot(&way, &way).sqrt(),
        angle: det / (dd * ee),
    }
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use carom_testing::Random;

    use super::*;

    #[test]
    fn the_nearest_places_of_two_segments_are_those_found_by_trying_all() {
        let mut random = Random(5);
        let mut inside = 0;
        for _ in 0..200 {
            let mut point = || [0; 3].map(|_| random.between(-1.0, 1.0));
            let (one, other) = ([point(), point()], [point(), point()]);
            let Nearest {
                xi,
                distance: found,
                ..
            } = between(&one, &other);
            inside += usize::from(xi[0].abs() < 1.0);
            let on =
                |x: &[[f64; 3]; 2], s: f64| [0, 1, 2].map(|i| x[0][i] + s * (x[1][i] - x[0][i]));
            let mut least = f64::INFINITY;
            for i in 0..=200 {
                for j in 0..=200 {
                    let (s, t) = (f64::from(i) / 200.0, f64::from(j) / 200.0);
                    least = least.min(distance(&on(&one, s), &on(&other, t)));
                }
            }
            // lengths below 3.5, steps of 1/200 and distances that grow at most linearly
            assert!(
                found <= least + 1e-12 && least - found < 0.02,
                "{found} {least}"
            );
        }
        assert!((20..180).contains(&inside), "{inside}");
    }
}
