//! Closest point of a quadratic line or face.
//!
//! Along a coordinate line of such a face, and of the six-node triangle along any line, the position is a polynomial of
//! degree two, so that the squared distance to a point is one of degree four: its least value is found for certain.
//! Newton's method does the rest.

use carom_elements::{Element, Kind, MAX_FACE_NODES, map};

use crate::vector::{difference, dot};

/// Bound on the passes of [`on_patch`]; five are usual.
const MAX_PASSES: usize = 50;

/// Closest point of a quadratic line, and where Newton's step from there would go if the line went on.
pub(crate) fn on_curve(
    element: &Element,
    x: &[[f64; 3]],
    point: &[f64; 3],
) -> ([f64; 3], [f64; 3]) {
    let distance = Distance { element, x, point };
    let xi = distance.least_along(&[-1.0, 0.0, 0.0], &[1.0, 0.0, 0.0]);
    let ([t, _], r) = distance.tangents(&xi);
    let [bend, ..] = distance.second(&xi);
    let full = dot(&t, &t) - dot(&r, &bend);
    let slope = if full > 0.0 { full } else { dot(&t, &t) };
    (xi, [xi[0] + dot(&t, &r) / slope, 0.0, 0.0])
}

/// Closest point of a quadratic face, and where Newton's step from there would go if the face went on.
///
/// From the nearest node. Newton's step, drawn back into the cell, is kept if it does not take the point farther away;
/// then the distance is minimised along the lines of two directions (of three, those of the edges, in a triangle): what
/// no longer moves is a minimum, the edges and corners included, since at each of these the directions span all ways into
/// the cell.
pub(crate) fn on_patch(
    element: &Element,
    x: &[[f64; 3]],
    point: &[f64; 3],
) -> ([f64; 3], [f64; 3]) {
    let distance = Distance { element, x, point };
    let is_triangle = element.linear == Kind::Tri3;
    let directions = match is_triangle {
        true => &[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, -1.0, 0.0]][..],
        false => &[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]][..],
    };
    let mut xi = element.reference[nearest(x, point)];
    let mut square = distance.squared(&xi);
    for _ in 0..MAX_PASSES {
        let before = xi;
        let newton = distance.newton(&xi);
        let trial = match is_triangle {
            true => into_triangle(&xi, &newton),
            false => newton.map(|c| c.clamp(-1.0, 1.0)),
        };
        let at_trial = distance.squared(&trial);
        // Round-off in the distance hides the last digits of the minimum, where the step is at its best.
        if at_trial <= square * (1.0 + 1e-14) {
            (xi, square) = (trial, at_trial);
        }
        for direction in directions {
            let (from, to) = chord(is_triangle, &xi, direction);
            let trial = distance.least_along(&from, &to);
            let at_trial = distance.squared(&trial);
            if at_trial < square * (1.0 - 1e-14) {
                (xi, square) = (trial, at_trial);
            }
        }
        if (0..2).all(|i| (xi[i] - before[i]).abs() < 1e-14) {
            break;
        }
    }
    let last = distance.newton(&xi);
    // Near an inner minimum the square of the distance no longer tells which point is better, but the step does.
    let is_close = (0..2).all(|i| (last[i] - xi[i]).abs() < 1e-6);
    if is_close && (element.contains)(&last, 0.0) {
        xi = last;
    }
    (xi, last)
}

/// The nearest node, the first of equals.
fn nearest(x: &[[f64; 3]], point: &[f64; 3]) -> usize {
    let square = |a: usize| {
        let r = difference(point, &x[a]);
        dot(&r, &r)
    };
    (1..x.len()).fold(0, |best, a| if square(a) < square(best) { a } else { best })
}

/// The last point of the unit triangle on the way from one of its points to another.
fn into_triangle(from: &[f64; 3], to: &[f64; 3]) -> [f64; 3] {
    let mut part = 1.0f64;
    let sides = |x: &[f64; 3]| [x[0], x[1], 1.0 - x[0] - x[1]];
    for (start, end) in sides(from).into_iter().zip(sides(to)) {
        if end < 0.0 {
            part = part.min(start.max(0.0) / (start.max(0.0) - end));
        }
    }
    onto_triangle([0, 1, 2].map(|i| from[i] + part * (to[i] - from[i])))
}

/// Drops what round-off leaves outside the unit triangle.
fn onto_triangle(x: [f64; 3]) -> [f64; 3] {
    let x = x.map(|c| c.max(0.0));
    let sum = (x[0] + x[1]).max(1.0);
    x.map(|c| c / sum)
}

/// The ends of the line through a point of the cell.
fn chord(is_triangle: bool, xi: &[f64; 3], direction: &[f64; 3]) -> ([f64; 3], [f64; 3]) {
    if !is_triangle {
        let end = |side: f64| [0, 1, 2].map(|i| if direction[i] == 0.0 { xi[i] } else { side });
        return (end(-1.0), end(1.0));
    }
    let sum = xi[0] + xi[1];
    match (direction[0] != 0.0, direction[1] != 0.0) {
        (true, false) => ([0.0, xi[1], 0.0], [1.0 - xi[1], xi[1], 0.0]),
        (false, true) => ([xi[0], 0.0, 0.0], [xi[0], 1.0 - xi[0], 0.0]),
        _ => ([0.0, sum, 0.0], [sum, 0.0, 0.0]),
    }
}

/// The distance of a point to the points of a face.
struct Distance<'a> {
    element: &'a Element,
    x: &'a [[f64; 3]],
    point: &'a [f64; 3],
}

impl Distance<'_> {
    /// r = x - y(ξ).
    fn to_point(&self, xi: &[f64; 3]) -> [f64; 3] {
        let mut n = [0.0; MAX_FACE_NODES];
        (self.element.shape)(xi, &mut n[..self.x.len()]);
        difference(self.point, &map::point(self.x, &n[..self.x.len()]))
    }

    /// |r|².
    fn squared(&self, xi: &[f64; 3]) -> f64 {
        let r = self.to_point(xi);
        dot(&r, &r)
    }

    /// The tangents t_i = ∂y/∂ξ_i, and r.
    fn tangents(&self, xi: &[f64; 3]) -> ([[f64; 3]; 2], [f64; 3]) {
        let mut dn = [[0.0; 3]; MAX_FACE_NODES];
        (self.element.gradient)(xi, &mut dn[..self.x.len()]);
        let t = [0, 1].map(|i| map::point(self.x, &dn.map(|dn| dn[i])));
        (t, self.to_point(xi))
    }

    /// ∂²y/∂ξ², ∂²y/∂η², ∂²y/∂ξ∂η.
    fn second(&self, xi: &[f64; 3]) -> [[f64; 3]; 3] {
        let mut ddn = [[0.0; 3]; MAX_FACE_NODES];
        map::second_gradient(self.element, xi, &mut ddn[..self.x.len()]);
        [0, 1, 2].map(|i| map::point(self.x, &ddn.map(|ddn| ddn[i])))
    }

    /// Newton's next point, unclamped: ξ - H^-1 ∇f for f = |r|²/2, ∇f_i = -t_i·r, H_ij = t_i·t_j - r·∂²y/∂ξ_i∂ξ_j;
    /// without the second derivatives (Gauss and Newton) where H is not positive definite.
    fn newton(&self, xi: &[f64; 3]) -> [f64; 3] {
        let ([s, t], r) = self.tangents(xi);
        let [y_ss, y_tt, y_st] = self.second(xi).map(|y| dot(&r, &y));
        let gauss = [dot(&s, &s), dot(&t, &t), dot(&s, &t)];
        let full = [gauss[0] - y_ss, gauss[1] - y_tt, gauss[2] - y_st];
        let is_positive = full[0] > 0.0 && full[0] * full[1] > full[2] * full[2];
        let [ss, tt, st] = if is_positive { full } else { gauss };
        let det = ss * tt - st * st;
        let (sr, tr) = (dot(&s, &r), dot(&t, &r));
        [
            xi[0] + (tt * sr - st * tr) / det,
            xi[1] + (ss * tr - st * sr) / det,
            0.0,
        ]
    }

    /// The nearest point on the straight way between two reference points along which y is of degree two.
    fn least_along(&self, from: &[f64; 3], to: &[f64; 3]) -> [f64; 3] {
        let at = |t: f64| [0, 1, 2].map(|i| 0.5 * ((1.0 - t) * from[i] + (1.0 + t) * to[i]));
        let [below, here, above] = [-1.0, 0.0, 1.0].map(|t| self.to_point(&at(t)));
        // r(t) = r + b t + c t², and the derivative of |r(t)|²/2
        let b = [0, 1, 2].map(|i| 0.5 * (above[i] - below[i]));
        let c = [0, 1, 2].map(|i| 0.5 * (above[i] + below[i]) - here[i]);
        let cubic = Cubic([
            dot(&here, &b),
            dot(&b, &b) + 2.0 * dot(&here, &c),
            3.0 * dot(&b, &c),
            2.0 * dot(&c, &c),
        ]);
        let square = |t: f64| {
            let r = [0, 1, 2].map(|i| here[i] + t * (b[i] + t * c[i]));
            dot(&r, &r)
        };
        let mut best = if square(1.0) < square(-1.0) {
            1.0
        } else {
            -1.0
        };
        for root in cubic.rising_roots().into_iter().flatten() {
            if square(root) <= square(best) {
                best = root;
            }
        }
        at(best)
    }
}

/// c₀ + c₁ t + c₂ t² + c₃ t³ on [-1, 1].
struct Cubic([f64; 4]);

impl Cubic {
    fn value(&self, t: f64) -> f64 {
        let [a, b, c, d] = self.0;
        a + t * (b + t * (c + t * d))
    }

    fn slope(&self, t: f64) -> f64 {
        let [_, b, c, d] = self.0;
        b + t * (2.0 * c + t * 3.0 * d)
    }

    /// The roots where the value rises from below to above zero: between the ends of the pieces on which it is monotone.
    fn rising_roots(&self) -> [Option<f64>; 3] {
        let [_, b, c, d] = self.0;
        // roots of the slope, from the sum that does not cancel
        let q = -(c + c.signum() * (c * c - 3.0 * b * d).max(0.0).sqrt());
        let mut turns = [q / (3.0 * d), b / q].map(|t| if t.abs() <= 1.0 { t } else { 1.0 });
        turns.sort_unstable_by(f64::total_cmp);
        let ends = [-1.0, turns[0], turns[1], 1.0];
        [0, 1, 2].map(|k| {
            let (from, to) = (ends[k], ends[k + 1]);
            let rises = self.value(from) <= 0.0 && self.value(to) >= 0.0 && from < to;
            rises.then(|| self.root_between(from, to))
        })
    }

    /// The root in an interval at whose ends the value is below and above zero: Newton's method, or halving where that
    /// leaves the interval.
    fn root_between(&self, mut below: f64, mut above: f64) -> f64 {
        let mut t = 0.5 * (below + above);
        // halving alone would take 53 passes to the last bit
        for _ in 0..60 {
            let value = self.value(t);
            if value < 0.0 {
                below = t;
            } else {
                above = t;
            }
            let newton = t - value / self.slope(t);
            let next = match newton > below && newton < above {
                true => newton,
                false => 0.5 * (below + above),
            };
            if (next - t).abs() <= 1e-16 {
                return next;
            }
            t = next;
        }
        t
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rising_roots_are_those_of_the_factors() {
        // (t - p)(t - q)(t - r) rises at p and at r, falls at q between
        for [p, q, r] in [[-0.7, 0.1, 0.6], [-0.2, 0.0, 0.3], [-3.0, 0.4, 2.0]] {
            let cubic = Cubic([-p * q * r, p * q + q * r + r * p, -(p + q + r), 1.0]);
            let found: Vec<f64> = cubic.rising_roots().into_iter().flatten().collect();
            let expected: Vec<f64> = [p, r].into_iter().filter(|t| t.abs() < 1.0).collect();
            assert_eq!(found.len(), expected.len());
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-14);
            }
        }
        let line = Cubic([-0.5, 2.0, 0.0, 0.0]).rising_roots();
        assert!(line.into_iter().flatten().all(|t| (t - 0.25).abs() < 1e-15));
        assert_eq!(line.into_iter().flatten().count(), 1);
    }
}
