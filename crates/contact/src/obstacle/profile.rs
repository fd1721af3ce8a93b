//! A rigid obstacle whose section across an axis is a closed curve: a bore that is not round, a grid cell, a cam.

use super::distance::{Distance, Side};

/// Prismatic obstacle without ends: a closed curve r(θ) in polar coordinates across an axis.
///
/// The curve goes through given points with angles that ascend once around the axis, either straight between them or as
/// `r(θ)` by the periodic cubic spline, which has continuous curvature; the spline of equal radii is the circle.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    point: [f64; 3],
    /// Unit vectors of angle zero and of a quarter turn.
    axes: [[f64; 3]; 2],
    /// Angle in rad and radius in m of each point.
    points: Vec<[f64; 2]>,
    /// r'' of the spline at the points, m; empty where the curve is straight between them.
    bends: Vec<f64>,
    side: Side,
}

/// Samples of a piece of the spline among which the closest place is sought first.
const SAMPLES: usize = 4;

/// Halvings or Newton passes that end the search for the closest place: halvings alone reach rounding.
const PASSES: usize = 60;

/// Place, first and second derivative of a curve by its angle, in its plane, m.
type Jet = [[f64; 2]; 3];

impl Profile {
    /// The obstacle. `point`: of the axis, m; `axes`: unit vectors of angle zero and of a quarter turn, square to each other and
    /// to the axis; `points`: angle in rad and radius in m, three at least, angles ascending within one turn. `smooth`: whether
    /// a spline joins them.
    pub fn new(
        point: [f64; 3],
        axes: [[f64; 3]; 2],
        points: Vec<[f64; 2]>,
        (smooth, side): (bool, Side),
    ) -> Profile {
        let bends = if smooth { bends(&points) } else { Vec::new() };
        Profile {
            point,
            axes,
            points,
            bends,
            side,
        }
    }

    /// Where the material must stay.
    pub(crate) fn side(&self) -> Side {
        self.side
    }

    /// The least distance of its points from the axis, m.
    pub(crate) fn least_radius(&self) -> f64 {
        let radii = self.points.iter().map(|[_, radius]| *radius);
        radii.fold(f64::INFINITY, f64::min)
    }

    /// Gap, normal and Hessian at a place x in m: those of the distance to the closest place of the curve (the first of
    /// equals). `∂²g/∂x² = -κ / (1 - κ g) t ⊗ t` with the curvature κ of the curve towards the normal and its tangent t.
    pub fn distance(&self, x: &[f64; 3]) -> Distance {
        let d = [0, 1, 2].map(|i| x[i] - self.point[i]);
        let x = self.axes.map(|e| (0..3).map(|i| e[i] * d[i]).sum());
        let (gap, normal, bend) = match self.bends.is_empty() {
            true => self.straight(x),
            false => self.smooth(x),
        };
        let in_space = |v: [f64; 2]| {
            let [a, b] = self.axes;
            [0, 1, 2].map(|i| v[0] * a[i] + v[1] * b[i])
        };
        let t = in_space([-normal[1], normal[0]]);
        Distance {
            gap,
            normal: in_space(normal),
            hessian: [0, 1, 2].map(|i| [0, 1, 2].map(|j| bend * t[i] * t[j])),
        }
    }

    /// Places along the curve in its own plane, closed by the first one, m, and the unit vector along the axis: to draw it.
    pub fn outline(&self) -> (Vec<[f64; 3]>, [f64; 3]) {
        let n = self.points.len();
        let [a, b] = self.axes;
        let place = |c: [f64; 2]| [0, 1, 2].map(|i| self.point[i] + c[0] * a[i] + c[1] * b[i]);
        let samples = match self.bends.is_empty() {
            true => 1,
            false => 2 * SAMPLES,
        };
        let along = |sample: usize| {
            let (k, part) = (sample / samples % n, sample % samples);
            match part {
                0 => self.corner(k),
                _ => {
                    let angle = self.width(k) * part as f64 / samples as f64;
                    self.jet(self.points[k][0] + angle)[0]
                }
            }
        };
        let axis = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            a[j] * b[k] - a[k] * b[j]
        });
        ((0..=n * samples).map(along).map(place).collect(), axis)
    }

    /// The normal on the left of a direction of the curve, which runs anticlockwise, or on the right: towards the material.
    fn normal(&self, along: [f64; 2]) -> [f64; 2] {
        let sign = match self.side {
            Side::Inside => 1.0,
            Side::Outside => -1.0,
        };
        let length = along[0].hypot(along[1]);
        [-sign * along[1] / length, sign * along[0] / length]
    }

    fn corner(&self, k: usize) -> [f64; 2] {
        let [angle, radius] = self.points[k % self.points.len()];
        [radius * angle.cos(), radius * angle.sin()]
    }

    /// Gap, normal and second derivative along the tangent, of the polygon.
    fn straight(&self, x: [f64; 2]) -> (f64, [f64; 2], f64) {
        let n = self.points.len();
        let mut best = (f64::INFINITY, 0, 0.0);
        for k in 0..n {
            let (a, b) = (self.corner(k), self.corner(k + 1));
            let along = [b[0] - a[0], b[1] - a[1]];
            let square = along[0] * along[0] + along[1] * along[1];
            let place = ((x[0] - a[0]) * along[0] + (x[1] - a[1]) * along[1]) / square;
            let place = place.clamp(0.0, 1.0);
            let distance = (x[0] - a[0] - place * along[0]).hypot(x[1] - a[1] - place * along[1]);
            if distance < best.0 {
                best = (distance, k, place);
            }
        }
        let (distance, k, place) = best;
        let normal_of = |k: usize| {
            let (a, b) = (self.corner(k), self.corner(k + 1));
            self.normal([b[0] - a[0], b[1] - a[1]])
        };
        let own = normal_of(k);
        let corner = match place {
            0.0 => k,
            1.0 => k + 1,
            _ => {
                let a = self.corner(k);
                let gap = own[0] * (x[0] - a[0]) + own[1] * (x[1] - a[1]);
                return (gap, own, 0.0);
            }
        };
        // in the sector of a corner the gap is ± the distance from it
        let (before, after) = (normal_of((corner + n - 1) % n), normal_of(corner % n));
        let middle = [before[0] + after[0], before[1] + after[1]];
        let a = self.corner(corner);
        let way = [x[0] - a[0], x[1] - a[1]];
        if distance == 0.0 {
            let length = middle[0].hypot(middle[1]);
            return (0.0, middle.map(|n| n / length), 0.0);
        }
        let sign = (middle[0] * way[0] + middle[1] * way[1]).signum();
        let gap = sign * distance;
        (gap, way.map(|w| w / gap), 1.0 / gap)
    }

    /// Gap, normal and second derivative along the tangent, of the spline.
    fn smooth(&self, x: [f64; 2]) -> (f64, [f64; 2], f64) {
        let n = self.points.len();
        let angle = |sample: usize| {
            let (k, part) = (sample / SAMPLES, sample % SAMPLES);
            let width = self.width(k % n);
            self.points[k % n][0] + width * part as f64 / SAMPLES as f64
        };
        let count = n * SAMPLES;
        let mut best = (f64::INFINITY, 0);
        for sample in 0..count {
            let [c, ..] = self.jet(angle(sample));
            let distance = (x[0] - c[0]).hypot(x[1] - c[1]);
            if distance < best.0 {
                best = (distance, sample);
            }
        }
        let turn = std::f64::consts::TAU;
        let [from, to] = match best.1 {
            0 => [angle(count - 1) - turn, angle(1)],
            last if last + 1 == count => [angle(last - 1), angle(0) + turn],
            sample => [angle(sample - 1), angle(sample + 1)],
        };
        let [c, first, second] = self.jet(self.closest(x, from, to));
        let normal = self.normal(first);
        let gap = normal[0] * (x[0] - c[0]) + normal[1] * (x[1] - c[1]);
        let speed = first[0].hypot(first[1]);
        let curvature = (second[0] * normal[0] + second[1] * normal[1]) / (speed * speed);
        let rest = 1.0 - curvature * gap;
        let bend = if rest == 0.0 { 0.0 } else { -curvature / rest };
        (gap, normal, bend)
    }

    /// The angle between two at which the curve is closest: Newton's method on (c - x) · c', halved where it leaves the bracket.
    fn closest(&self, x: [f64; 2], mut from: f64, mut to: f64) -> f64 {
        let slope = |angle: f64| {
            let [c, first, second] = self.jet(angle);
            let r = [c[0] - x[0], c[1] - x[1]];
            let value = r[0] * first[0] + r[1] * first[1];
            let derivative =
                first[0].powi(2) + first[1].powi(2) + r[0] * second[0] + r[1] * second[1];
            (value, derivative)
        };
        let mut angle = 0.5 * (from + to);
        for _ in 0..PASSES {
            let (value, derivative) = slope(angle);
            if value > 0.0 {
                to = angle;
            } else {
                from = angle;
            }
            let newton = angle - value / derivative;
            let next = match derivative > 0.0 && newton > from && newton < to {
                true => newton,
                false => 0.5 * (from + to),
            };
            if next == angle {
                break;
            }
            angle = next;
        }
        angle
    }

    /// Angle from a point to the next one, rad.
    fn width(&self, k: usize) -> f64 {
        width(&self.points, k)
    }

    /// The spline at an angle in rad.
    fn jet(&self, angle: f64) -> Jet {
        let first = self.points[0][0];
        let angle = first + (angle - first).rem_euclid(std::f64::consts::TAU);
        let k = self.points.partition_point(|[a, _]| *a <= angle).max(1) - 1;
        let n = self.points.len();
        let (h, [a, r0], r1) = (self.width(k), self.points[k], self.points[(k + 1) % n][1]);
        let (b0, b1) = (self.bends[k], self.bends[(k + 1) % n]);
        let (s, t) = ((angle - a) / h, 1.0 - (angle - a) / h);
        let r = t * r0 + s * r1 + h * h / 6.0 * ((t * t * t - t) * b0 + (s * s * s - s) * b1);
        let dr = (r1 - r0) / h + h / 6.0 * ((1.0 - 3.0 * t * t) * b0 + (3.0 * s * s - 1.0) * b1);
        let ddr = t * b0 + s * b1;
        let (sin, cos) = angle.sin_cos();
        [
            [r * cos, r * sin],
            [dr * cos - r * sin, dr * sin + r * cos],
            [
                (ddr - r) * cos - 2.0 * dr * sin,
                (ddr - r) * sin + 2.0 * dr * cos,
            ],
        ]
    }
}

fn width(points: &[[f64; 2]], k: usize) -> f64 {
    match points.get(k + 1) {
        Some([next, _]) => next - points[k][0],
        None => points[0][0] + std::f64::consts::TAU - points[k][0],
    }
}

/// r'' of the periodic cubic spline at its points: `h₋ m₋ + 2 (h₋ + h) m + h m₊ = 6 ((r₊ - r)/h - (r - r₋)/h₋)`, by
/// Gauss-Seidel sweeps, which a diagonal of twice the rest makes converge by a factor of 4 each.
fn bends(points: &[[f64; 2]]) -> Vec<f64> {
    let n = points.len();
    let mut bends = vec![0.0; n];
    for _ in 0..PASSES {
        for k in 0..n {
            let (before, after) = ((k + n - 1) % n, (k + 1) % n);
            let [h0, h1] = [before, k].map(|k| width(points, k));
            let [r0, r, r1] = [before, k, after].map(|k| points[k][1]);
            let right = 6.0 * ((r1 - r) / h1 - (r - r0) / h0);
            bends[k] = (right - h0 * bends[before] - h1 * bends[after]) / (2.0 * (h0 + h1));
        }
    }
    bends
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::Cylinder;
    use crate::obstacle::tests::assert_derivatives;

    const AXES: [[f64; 3]; 2] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    const POINT: [f64; 3] = [0.3, -0.2, 0.1];

    fn circle(n: usize, eccentricity: f64) -> Vec<[f64; 2]> {
        // a circle of radius 1 about (e, 0), seen from the origin
        let radius = |angle: f64| {
            let e = eccentricity;
            e * angle.cos() + (1.0 - (e * angle.sin()).powi(2)).sqrt()
        };
        let angles = (0..n).map(|k| TAU * k as f64 / n as f64 - 1.0);
        angles.map(|angle| [angle, radius(angle)]).collect()
    }

    #[test]
    fn the_spline_of_equal_radii_is_the_cylinder() {
        for side in [Side::Inside, Side::Outside] {
            let profile = Profile::new(POINT, AXES, circle(5, 0.0), (true, side));
            let cylinder = Cylinder {
                point: POINT,
                axis: [1.0, 0.0, 0.0],
                radius: 1.0,
                side,
            };
            for x in [[7.0, 0.1, 0.5], [0.0, -1.3, 0.2], [0.0, -0.2, -1.9]] {
                let (found, exact) = (profile.distance(&x), cylinder.distance(&x));
                assert!((found.gap - exact.gap).abs() < 1e-14);
                for i in 0..3 {
                    assert!((found.normal[i] - exact.normal[i]).abs() < 1e-13);
                    for j in 0..3 {
                        assert!((found.hessian[i][j] - exact.hessian[i][j]).abs() < 1e-12);
                    }
                }
            }
        }
    }

    #[test]
    fn in_an_eccentric_hole_the_gap_is_the_clearance_less_the_eccentricity_to_order_four() {
        // hole of radius 1, rod of radius 0.9 on the axis of the points, the hole off by e
        for n in [16, 32, 64] {
            let profile = Profile::new([0.0; 3], AXES, circle(n, 0.05), (true, Side::Inside));
            let gap = profile.distance(&[0.0; 3]).gap - 0.9;
            // a cubic spline errs by 5/384 h⁴ r at most, and r is e cos θ to the first order of e
            let bound = 1.3 * 5.0 / 384.0 * (TAU / n as f64).powi(4) * 0.05;
            assert!((gap - (0.1 - 0.05)).abs() < bound, "{n}: {gap}");
        }
    }

    #[test]
    fn normal_and_hessian_are_the_derivatives_of_the_gap() {
        let rough: Vec<[f64; 2]> = circle(7, 0.3)
            .into_iter()
            .enumerate()
            .map(|(k, [a, r])| [a, r * (1.0 + 0.1 * (k % 2) as f64)])
            .collect();
        for (smooth, side) in [
            (true, Side::Inside),
            (true, Side::Outside),
            (false, Side::Inside),
            (false, Side::Outside),
        ] {
            let profile = Profile::new(POINT, AXES, rough.clone(), (smooth, side));
            for x in [[0.0, 0.9, 0.3], [0.0, -1.5, 0.4], [0.0, 0.3, -0.5]] {
                assert_derivatives(|x| profile.distance(x), &x);
            }
        }
    }

    #[test]
    fn a_square_cell_has_planes_and_round_corners() {
        let corner = 2.0_f64.sqrt();
        let points = (0..4).map(|k| [TAU * (f64::from(k) + 0.5) / 4.0, corner]);
        let square = Profile::new([0.0; 3], AXES, points.collect(), (false, Side::Inside));
        let inside = square.distance(&[0.0, 0.75, 0.25]);
        assert!((inside.gap - 0.25).abs() < 1e-15 && (inside.normal[1] + 1.0).abs() < 1e-15);
        let beyond = square.distance(&[0.0, 1.3, 1.4]);
        assert!((beyond.gap + 0.5).abs() < 1e-14);
        assert!((beyond.normal[1] + 0.6).abs() < 1e-14 && (beyond.normal[2] + 0.8).abs() < 1e-14);
    }
}
