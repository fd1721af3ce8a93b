//! The cells of the solid in S, cut at places along the axis, with quadrature points.
//!
//! A cell between two cuts is integrated on its own reference cell. One that is cut is taken with straight edges: cells that are not
//! affine then leave gaps of second order in their curvature.

use super::model::NOTHING;
use super::overlap::{BeamOverlap, Part};
use super::runs::Run;
use crate::cell::Cell;
use crate::error::Error;
use crate::polytope::{Plane, Polytope, dot};
use crate::refine::simplex_points;
use crate::rule::Rule;

/// By how much the degree of the quadrature is raised where shape functions are no polynomials of the position.
const RAISED: usize = 4;

/// A quadrature point in a cell of the solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// Reference coordinates.
    pub xi: [f64; 3],
    /// Weight times Jacobian, in length^dim.
    pub weight: f64,
    /// Place along the axis.
    pub s: f64,
    /// From the centroid of the section.
    pub r: [f64; 3],
    /// Interval between two cuts.
    pub interval: usize,
}

/// Integrals of a part of the solid between two cuts.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moments {
    /// ∫ dV times the thickness.
    pub area: f64,
    /// ∫ r dV times the thickness.
    pub first: [f64; 3],
    /// The diagonal of ∫ r ⊗ r dV times the thickness.
    pub second: [f64; 3],
}

/// The ends of a range and the places within it, ascending and apart.
pub(super) fn cuts(range: [f64; 2], places: impl Iterator<Item = f64>) -> Vec<f64> {
    let near = NOTHING * (range[1] - range[0]);
    let inside = places.filter(|&s| s > range[0] + near && s < range[1] - near);
    let mut cuts: Vec<f64> = range.into_iter().chain(inside).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|next, kept| *next - *kept <= near);
    cuts
}

/// Quadrature rules of one degree and of the raised one, made when they are needed.
pub(super) struct Rules {
    degree: usize,
    made: Vec<(carom_elements::Kind, bool, Rule)>,
}

impl Rules {
    /// `degree`: total degree of what is integrated.
    pub fn new(degree: usize) -> Rules {
        let made = Vec::new();
        Rules { degree, made }
    }

    fn of(&mut self, corners: carom_elements::Kind, affine: bool) -> &Rule {
        let found = self
            .made
            .iter()
            .position(|m| m.0 == corners && m.1 == affine);
        let place = found.unwrap_or_else(|| {
            let degree = self.degree + if affine { 0 } else { RAISED };
            self.made.push((corners, affine, Rule::of(corners, degree)));
            self.made.len() - 1
        });
        &self.made[place].2
    }
}

impl BeamOverlap<'_> {
    /// Quadrature points of a cell between the first and the last cut, into `points`, which is cleared first.
    ///
    /// Errors: a distorted cell cannot be inverted at a point.
    pub(super) fn points(
        &self,
        (place, run): (usize, &Run),
        cuts: &[f64],
        rules: &mut Rules,
        points: &mut Vec<Point>,
    ) -> Result<(), Error> {
        points.clear();
        let cell = self.solid(place);
        let straight = cell.straight();
        let affine = cell.is_affine();
        let along = straight.x().iter().map(|x| run.place(x));
        let [low, high] = along.fold([f64::MAX, f64::MIN], |[l, u], s| [l.min(s), u.max(s)]);
        let near = NOTHING * (high - low);
        let point = |x: &[f64; 3], xi, weight, interval| {
            let s = run.place(x);
            let r = [0, 1, 2].map(|i| x[i] - run.origin[i] - s * run.direction[i]);
            Point {
                xi,
                weight,
                s,
                r,
                interval,
            }
        };
        for (interval, between) in cuts.windows(2).enumerate() {
            if between[1] <= low + near || between[0] >= high - near {
                continue;
            }
            if between[0] <= low + near && between[1] >= high - near {
                let rule = rules.of(straight.kind, affine);
                for (xi, weight) in cell.points(rule) {
                    points.push(point(&cell.point(&xi), xi, weight, interval));
                }
                continue;
            }
            let rule = rules.of(simplex(self.models.mesh.dim), affine);
            for (x, weight) in
                simplex_points(&slab(&straight, run, between), rule, self.models.mesh.dim)
            {
                let xi = cell.reference(&x).ok_or(Error::InverseMap {
                    cell: self.models.solid[place],
                })?;
                points.push(point(&x, xi, weight, interval));
            }
        }
        Ok(())
    }

    /// Moments of the solid in a part between the cuts.
    pub(super) fn moments(&self, part: &Part, cuts: &[f64]) -> Result<Vec<Moments>, Error> {
        let run = &self.runs[part.run];
        let mut sums = vec![Moments::default(); cuts.len() - 1];
        let (mut points, mut rules) = (Vec::new(), Rules::new(2));
        for &place in &part.solid {
            self.points((place, run), cuts, &mut rules, &mut points)?;
            for point in &points {
                let sum = &mut sums[point.interval];
                let weight = point.weight * self.models.thickness;
                sum.area += weight;
                for i in 0..3 {
                    sum.first[i] += weight * point.r[i];
                    sum.second[i] += weight * point.r[i] * point.r[i];
                }
            }
        }
        Ok(sums)
    }
}

fn simplex(dim: usize) -> carom_elements::Kind {
    match dim {
        2 => carom_elements::Kind::Tri3,
        _ => carom_elements::Kind::Tet4,
    }
}

/// The part of a cell between two places along the axis.
fn slab(cell: &Cell, run: &Run, between: &[f64]) -> Vec<Polytope> {
    let at = dot(&run.origin, &run.direction);
    let side = |sign: f64, s: f64| Plane {
        normal: run.direction.map(|d| sign * d),
        offset: sign * (at + s),
    };
    let largest = cell
        .x()
        .iter()
        .flatten()
        .fold(0.0, |m: f64, x| m.max(x.abs()));
    let tolerance = 1e-12 * cell.size + 1e-15 * largest;
    let clip = |shape: Polytope| {
        shape
            .clip(&side(-1.0, between[0]), tolerance)?
            .clip(&side(1.0, between[1]), tolerance)
    };
    let parts = cell.parts().into_iter();
    parts.filter_map(|part| clip(part.shape)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cuts_are_apart_and_inside() {
        let found = cuts([1.0, 3.0], [2.0, 0.5, 3.0, 2.0 + 1e-12, 1.5].into_iter());
        assert_eq!(found, [1.0, 1.5, 2.0, 3.0]);
    }
}
