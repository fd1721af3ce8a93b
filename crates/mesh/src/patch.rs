//! Closest point of a bilinear quadrilateral, of one or of several side by side.

use carom_algebra::number::Number;

use crate::bounds::larger;

/// Bound on the passes of [`Patch::closest`]; Newton's method takes about four.
const MAX_PASSES: usize = 100;

/// Step of Newton's method, in reference units, after which what is left is below rounding: it is of the order of its square.
const LAST: f64 = 1e-8;

/// Slopes below this part of what makes them up are rounding.
const ROUNDING: f64 = 1e-14;

/// The most quadrilaterals side by side.
pub(crate) const MOST: usize = 8;

/// A bilinear quadrilateral `y = m + ξ s + η t + ξη w`, m, seen from a place: y leads from there to it.
struct Patch<N> {
    middle: [N; 3],
    sides: [[N; 3]; 2],
    twist: [N; 3],
}

/// What is known at a place of the patch.
struct At<N> {
    xi: [N; 2],
    /// y, m.
    way: [N; 3],
    /// t_i = ∂y/∂ξ_i, m.
    tangents: [[N; 3]; 2],
    /// f = |y|²/2, m².
    half_square: N,
    /// -∂f/∂ξ_i = -t_i·y, m².
    slopes: [N; 2],
    /// t_i·t_i, m².
    squares: [N; 2],
}

/// The closest point of a quadrilateral to a place.
pub(crate) struct Foot<N> {
    /// In reference coordinates.
    pub xi: [N; 2],
    /// Where Newton's step from there would go if the quadrilateral went on.
    pub free: [N; 2],
    /// In space, m.
    pub point: [N; 3],
    /// Unit normal there; zero of a degenerate quadrilateral.
    pub normal: [N; 3],
}

impl<N: Number> Foot<N> {
    /// On the quadrilateral with these corners, m. Each of several side by side has the bits that it has alone.
    #[inline(always)]
    pub fn new(corners: &[[N; 3]; 4], point: &[N; 3]) -> Foot<N> {
        // seen from the point: far from the origin the rounding of places would keep iterations from their end
        let [a, b, c, d] = corners;
        let patch = Patch::new(&[
            difference(a, point),
            difference(b, point),
            difference(c, point),
            difference(d, point),
        ]);
        let (at, free) = patch.closest();
        let ([xi, eta], one) = (at.xi, at.xi[0].like(1.0));
        let [left, right] = [(one - xi).scale(0.25), (one + xi).scale(0.25)];
        let [front, back] = [one - eta, one + eta];
        let shape = [left * front, right * front, right * back, left * back];
        let mut foot = *point;
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

impl<N: Number> Patch<N> {
    /// The patch with these corners, seen from the place.
    #[inline(always)]
    fn new(corners: &[[N; 3]; 4]) -> Patch<N> {
        let [a, b, c, d] = corners;
        let (mut middle, mut twist, mut sides) = (*a, *a, [*a; 2]);
        for i in 0..3 {
            let (even, odd) = (a[i] + c[i], b[i] + d[i]);
            let (back, forth) = (c[i] - a[i], b[i] - d[i]);
            middle[i] = (even + odd).scale(0.25);
            twist[i] = (even - odd).scale(0.25);
            sides[0][i] = (back + forth).scale(0.25);
            sides[1][i] = (back - forth).scale(0.25);
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
    /// The end is where f falls nowhere, or only out of the patch. A patch that is at its end stays there while others beside it go on.
    #[inline(always)]
    fn closest(&self) -> (At<N>, [N; 2]) {
        let zero = self.middle[0].like(0.0);
        let mut at = self.at([zero; 2]);
        let mut ways = Ways::new(zero);
        for _ in 0..MAX_PASSES {
            let next = self.newton(&at);
            if ways.note(&at, &next) {
                return (at, ways.free);
            }
            let inner = ways.inner(&at);
            let trial = self.at(inner);
            at = match ways.judge(&at, &trial) {
                true => trial,
                false => self.at(ways.kept(&at, &trial)),
            };
            if ways.all_end() {
                return (at, ways.free);
            }
            if ways.turns.contains(&true) {
                for axis in 0..2 {
                    at = self.at(ways.along(&at, axis));
                }
            }
        }
        let free = self.newton(&at);
        ways.note(&at, &free);
        (at, ways.free)
    }

    #[inline(always)]
    fn at(&self, xi: [N; 2]) -> At<N> {
        let [s, t] = &self.sides;
        let (mut way, mut tangents) = (self.middle, self.sides);
        for i in 0..3 {
            let along = s[i] + xi[1] * self.twist[i];
            tangents[0][i] = along;
            tangents[1][i] = t[i] + xi[0] * self.twist[i];
            way[i] = self.middle[i] + xi[0] * along + xi[1] * t[i];
        }
        let [s, t] = &tangents;
        At {
            xi,
            half_square: dot(&way, &way).scale(0.5),
            slopes: [-dot(s, &way), -dot(t, &way)],
            squares: [dot(s, s), dot(t, t)],
            way,
            tangents,
        }
    }

    /// Newton's next point, unclamped: ξ - H⁻¹ ∇f with H_ij = t_i·t_j + y·∂²y/∂ξ_i∂ξ_j; without the second derivative (Gauss and
    /// Newton) where H is not positive definite.
    #[inline(always)]
    fn newton(&self, at: &At<N>) -> [N; 2] {
        let [s, t] = &at.tangents;
        // ∂²y/∂ξ∂η of the bilinear map; the other second derivatives are zero
        let ([ss, tt], st) = (at.squares, dot(s, t));
        let full = st + dot(&at.way, &self.twist);
        let mixed = (full * full).if_below(ss * tt, full, st);
        let scale = ss.like(1.0) / (ss * tt - mixed * mixed);
        let [sr, tr] = at.slopes;
        [
            at.xi[0] + (tt * sr - mixed * tr) * scale,
            at.xi[1] + (ss * tr - mixed * sr) * scale,
        ]
    }
}

impl<N: Number> At<N> {
    /// Whether f falls along neither coordinate line in a patch, to rounding. Without branches, as patches side by side want it.
    #[inline(always)]
    fn is_least(&self, k: usize) -> bool {
        let size = 2.0 * self.half_square.lanes()[k];
        let mut least = true;
        for i in 0..2 {
            let [slope, square, xi] =
                [&self.slopes[i], &self.squares[i], &self.xi[i]].map(|n| n.lanes()[k]);
            let outwards = (slope * xi >= 0.0) & (xi.abs() == 1.0);
            least &= outwards | (slope * slope <= ROUNDING * ROUNDING * square * (square + size));
        }
        least
    }

    /// Unit normal; zero of a degenerate patch.
    #[inline(always)]
    fn normal(&self) -> [N; 3] {
        let [s, t] = &self.tangents;
        let normal = [
            s[1] * t[2] - s[2] * t[1],
            s[2] * t[0] - s[0] * t[2],
            s[0] * t[1] - s[1] * t[0],
        ];
        let (size, zero) = (dot(&normal, &normal).sqrt(), self.xi[0].like(0.0));
        let unit = |n: N| zero.if_below(size, n / size, zero);
        [unit(normal[0]), unit(normal[1]), unit(normal[2])]
    }
}

/// The ways of several patches to their closest points, pass by pass.
struct Ways<N> {
    /// The next point of Newton's method, that of the last pass of a patch that is at its end.
    free: [N; 2],
    /// Size of the last step of Newton's method alone.
    last: N,
    ends: [bool; MOST],
    /// Whether the step of the pass raises f.
    raises: [bool; MOST],
    /// Whether f is minimised along the coordinate lines in the pass.
    turns: [bool; MOST],
}

impl<N: Number> Ways<N> {
    #[inline(always)]
    fn new(zero: N) -> Self {
        Ways {
            free: [zero; 2],
            last: zero.like(f64::INFINITY),
            ends: [false; MOST],
            raises: [false; MOST],
            turns: [false; MOST],
        }
    }

    #[inline(always)]
    fn count(&self) -> usize {
        self.last.lanes().len()
    }

    #[inline(always)]
    fn all_end(&self) -> bool {
        self.ends[..self.count()].iter().all(|end| *end)
    }

    /// Takes the next points of Newton's method; whether all are at their end.
    #[inline(always)]
    fn note(&mut self, at: &At<N>, next: &[N; 2]) -> bool {
        for k in 0..self.count() {
            for (free, next) in self.free.iter_mut().zip(next) {
                let free = &mut free.lanes_mut()[k];
                *free = if self.ends[k] { *free } else { next.lanes()[k] };
            }
            self.ends[k] |= at.is_least(k);
        }
        self.all_end()
    }

    /// The next points, in their patches.
    #[inline(always)]
    fn inner(&self, at: &At<N>) -> [N; 2] {
        let mut inner = at.xi;
        for (inner, free) in inner.iter_mut().zip(&self.free) {
            for k in 0..self.count() {
                let (inner, free) = (&mut inner.lanes_mut()[k], free.lanes()[k]);
                let next = free.clamp(-1.0, 1.0);
                *inner = if self.ends[k] { *inner } else { next };
            }
        }
        inner
    }

    /// Decides how each goes on from a trial of its step; whether no step raises f.
    #[inline(always)]
    fn judge(&mut self, at: &At<N>, trial: &At<N>) -> bool {
        for k in 0..self.count() {
            let one = |n: &N| n.lanes()[k];
            // round-off in f hides the last digits of the minimum, where the step is at its best
            let falls = one(&trial.half_square) <= one(&at.half_square) * (1.0 + ROUNDING);
            let step = |i: usize| (one(&trial.xi[i]) - one(&at.xi[i])).abs();
            let (step, last) = (larger(step(0), step(1)), one(&self.last));
            let inside = |i: usize| one(&trial.xi[i]) == one(&self.free[i]);
            let newton = falls & inside(0) & inside(1);
            let (goes_on, halves) = (!self.ends[k], newton & (step <= 0.5 * last));
            let ends = newton & (step <= LAST);
            self.raises[k] = goes_on & !falls;
            self.turns[k] = goes_on & !(ends | halves);
            self.ends[k] |= ends;
            self.last.lanes_mut()[k] = if halves { step } else { last };
        }
        !self.raises[..self.count()].contains(&true)
    }

    /// Where they are if those whose step raises f stay.
    #[inline(always)]
    fn kept(&self, at: &At<N>, trial: &At<N>) -> [N; 2] {
        let mut kept = trial.xi;
        for (kept, xi) in kept.iter_mut().zip(&at.xi) {
            for k in 0..self.count() {
                if self.raises[k] {
                    kept.lanes_mut()[k] = xi.lanes()[k];
                }
            }
        }
        kept
    }

    /// The least f along a coordinate line, of those that turn.
    #[inline(always)]
    fn along(&self, at: &At<N>, axis: usize) -> [N; 2] {
        let mut xi = at.xi;
        let least = xi[axis] + at.slopes[axis] / at.squares[axis];
        for k in 0..self.count() {
            if self.turns[k] {
                xi[axis].lanes_mut()[k] = least.lanes()[k].clamp(-1.0, 1.0);
            }
        }
        xi
    }
}

#[inline(always)]
fn difference<N: Number>(a: &[N; 3], b: &[N; 3]) -> [N; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot<N: Number>(a: &[N; 3], b: &[N; 3]) -> N {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
