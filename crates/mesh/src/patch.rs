//! Closest point of a bilinear quadrilateral.

use crate::vector::{difference, dot};

/// Bound on the passes of [`Patch::closest`]; Newton's method takes about four.
const MAX_PASSES: usize = 100;

/// Step of Newton's method, in reference units, after which what is left is below rounding: it is of the order of its square.
const LAST: f64 = 1e-8;

/// Slopes below this part of what makes them up are rounding.
const ROUNDING: f64 = 1e-14;

/// A bilinear quadrilateral `y = m + ξ s + η t + ξη w`, m, seen from a place: y leads from there to it.
struct Patch {
    middle: [f64; 3],
    sides: [[f64; 3]; 2],
    twist: [f64; 3],
}

/// What is known at a place of the patch.
struct At {
    xi: [f64; 2],
    /// y, m.
    way: [f64; 3],
    /// t_i = ∂y/∂ξ_i, m.
    tangents: [[f64; 3]; 2],
    /// f = |y|²/2, m².
    half_square: f64,
    /// -∂f/∂ξ_i = -t_i·y, m².
    slopes: [f64; 2],
    /// t_i·t_i, m².
    squares: [f64; 2],
}

/// The closest point of a quadrilateral to a place.
pub(crate) struct Foot {
    /// In reference coordinates.
    pub xi: [f64; 2],
    /// Where Newton's step from there would go if the quadrilateral went on.
    pub free: [f64; 2],
    /// In space, m.
    pub point: [f64; 3],
    /// Unit normal there; zero of a degenerate quadrilateral.
    pub normal: [f64; 3],
}

impl Foot {
    /// On the quadrilateral with these corners, m.
    pub fn new(corners: &[[f64; 3]; 4], point: &[f64; 3]) -> Foot {
        // seen from the point: far from the origin the rounding of places would keep iterations from their end
        let [a, b, c, d] = corners;
        let patch = Patch::new(&[
            difference(a, point),
            difference(b, point),
            difference(c, point),
            difference(d, point),
        ]);
        let (at, free) = patch.closest();
        let [left, right] = [0.25 * (1.0 - at.xi[0]), 0.25 * (1.0 + at.xi[0])];
        let [front, back] = [1.0 - at.xi[1], 1.0 + at.xi[1]];
        let shape = [left * front, right * front, right * back, left * back];
        let mut foot = [0.0; 3];
        for (i, foot) in foot.iter_mut().enumerate() {
            *foot = shape[0] * a[i] + shape[1] * b[i] + shape[2] * c[i] + shape[3] * d[i];
        }
        Foot {
            xi: at.xi,
            free,
            point: foot,
            normal: at.normal(),
        }
    }
}

impl Patch {
    /// The patch with these corners, seen from the place.
    #[inline]
    fn new(corners: &[[f64; 3]; 4]) -> Patch {
        let [a, b, c, d] = corners;
        let (mut middle, mut twist, mut sides) = ([0.0; 3], [0.0; 3], [[0.0; 3]; 2]);
        for i in 0..3 {
            let (even, odd) = (a[i] + c[i], b[i] + d[i]);
            let (back, forth) = (c[i] - a[i], b[i] - d[i]);
            middle[i] = 0.25 * (even + odd);
            twist[i] = 0.25 * (even - odd);
            sides[0][i] = 0.25 * (back + forth);
            sides[1][i] = 0.25 * (back - forth);
        }
        Patch {
            middle,
            sides,
            twist,
        }
    }

    /// Closest point in reference coordinates, and where Newton's step from there would go if the patch went on.
    ///
    /// f = |y|²/2 is a parabola along each coordinate line. Newton's step is kept if it does not raise f. One that ends in the
    /// patch and is shorter than half the last is followed by the next; otherwise f is minimised along each coordinate line in turn.
    /// The end is where f falls nowhere, or only out of the patch.
    fn closest(&self) -> (At, [f64; 2]) {
        let (mut at, mut last) = (self.at([0.0; 2]), f64::INFINITY);
        for _ in 0..MAX_PASSES {
            let free = self.newton(&at);
            if at.is_least() {
                return (at, free);
            }
            let inner = [free[0].clamp(-1.0, 1.0), free[1].clamp(-1.0, 1.0)];
            let trial = self.at(inner);
            // round-off in f hides the last digits of the minimum, where the step is at its best
            if trial.half_square <= at.half_square * (1.0 + ROUNDING) {
                let step = f64::max((inner[0] - at.xi[0]).abs(), (inner[1] - at.xi[1]).abs());
                at = trial;
                if inner == free && step <= LAST {
                    return (at, free);
                }
                if inner == free && step <= 0.5 * last {
                    last = step;
                    continue;
                }
            }
            for axis in 0..2 {
                let mut xi = at.xi;
                xi[axis] = (xi[axis] + at.slopes[axis] / at.squares[axis]).clamp(-1.0, 1.0);
                at = self.at(xi);
            }
        }
        let free = self.newton(&at);
        (at, free)
    }

    #[inline]
    fn at(&self, xi: [f64; 2]) -> At {
        let [s, t] = &self.sides;
        let (mut way, mut tangents) = ([0.0; 3], [[0.0; 3]; 2]);
        for i in 0..3 {
            let along = s[i] + xi[1] * self.twist[i];
            tangents[0][i] = along;
            tangents[1][i] = t[i] + xi[0] * self.twist[i];
            way[i] = self.middle[i] + xi[0] * along + xi[1] * t[i];
        }
        let [s, t] = &tangents;
        At {
            xi,
            half_square: 0.5 * dot(&way, &way),
            slopes: [-dot(s, &way), -dot(t, &way)],
            squares: [dot(s, s), dot(t, t)],
            way,
            tangents,
        }
    }

    /// Newton's next point, unclamped: ξ - H⁻¹ ∇f with H_ij = t_i·t_j + y·∂²y/∂ξ_i∂ξ_j; without the second derivative (Gauss and
    /// Newton) where H is not positive definite.
    #[inline]
    fn newton(&self, at: &At) -> [f64; 2] {
        let [s, t] = &at.tangents;
        // ∂²y/∂ξ∂η of the bilinear map; the other second derivatives are zero
        let ([ss, tt], st) = (at.squares, dot(s, t));
        let full = st + dot(&at.way, &self.twist);
        let mixed = if ss * tt > full * full { full } else { st };
        let scale = 1.0 / (ss * tt - mixed * mixed);
        let [sr, tr] = at.slopes;
        [
            at.xi[0] + (tt * sr - mixed * tr) * scale,
            at.xi[1] + (ss * tr - mixed * sr) * scale,
        ]
    }
}

impl At {
    /// Whether f falls along neither coordinate line in the patch, to rounding.
    #[inline]
    fn is_least(&self) -> bool {
        let size = 2.0 * self.half_square;
        (0..2).all(|i| {
            let (slope, square) = (self.slopes[i], self.squares[i]);
            let outwards = slope * self.xi[i] >= 0.0 && self.xi[i].abs() == 1.0;
            outwards || slope * slope <= ROUNDING * ROUNDING * square * (square + size)
        })
    }

    /// Unit normal; zero of a degenerate patch.
    #[inline]
    fn normal(&self) -> [f64; 3] {
        let [s, t] = &self.tangents;
        let normal = [
            s[1] * t[2] - s[2] * t[1],
            s[2] * t[0] - s[0] * t[2],
            s[0] * t[1] - s[1] * t[0],
        ];
        let size = dot(&normal, &normal).sqrt();
        if size == 0.0 {
            return [0.0; 3];
        }
        [normal[0] / size, normal[1] / size, normal[2] / size]
    }
}
