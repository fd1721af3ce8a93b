//! The problem that is to be solved, as the solver and the measure of its error see it.

use carom_laws::{End, Relation, Status};

use super::Tangential;
use crate::Compliance;
use crate::interface::Candidate;

/// Mobility over that of the whole candidate up to which a direction counts as held, and the square of the part of the
/// sliding that may be along it.
const HELD: f64 = 1e-9;

/// Entries of the block of a candidate, over the smaller of those on the diagonal, that are rounding.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A problem with friction over n candidates. Row `i w` of D belongs to the normal of candidate i, the `tangents` rows
/// after it to its tangents, w = 1 + `tangents`.
#[derive(Clone, Copy)]
pub struct Posed<'a> {
    /// The candidates.
    pub candidates: &'a [Candidate],
    /// What friction adds to each.
    pub friction: &'a [Tangential],
    /// Tangents of a candidate: 1 in the plane, 2 in space.
    pub tangents: usize,
    /// D over all rows.
    pub d: Compliance<'a>,
    /// [s_g, s_v, s_t], the factors of D p in the gap, in the rate, and in the sliding quantity.
    pub s: [f64; 3],
    /// Defect over the largest force with which forces are taken where no nearer ones are found.
    pub tolerance: f64,
}

/// What a problem says of a candidate by itself.
#[derive(Clone, Copy)]
pub(super) struct Alone {
    /// Projector on the tangents along which its forces move it; see [`Posed::mobile`].
    pub(super) mobile: [[f64; 2]; 2],
    /// Where its block of D is diagonal.
    pub(super) diagonal: Option<Diagonal>,
}

/// A candidate whose block of D is diagonal, with equal tangents.
#[derive(Clone, Copy)]
pub(super) struct Diagonal {
    /// Entries of its normal and its tangents.
    pub(super) own: [f64; 2],
    /// In the relation of its closure the factor of D p, that of its own force, and what it says before the forces.
    pub(super) factor: f64,
    pub(super) slope: f64,
    pub(super) free: f64,
}

impl Alone {
    /// Of two tangents the one direction along which the candidate moves; none if it moves along both or neither.
    pub(super) fn only_direction(&self, tangents: usize) -> Option<[f64; 2]> {
        let [[xx, xy], [_, yy]] = self.mobile;
        // of a projector on a line the longer column is the longer part of its direction
        let one = (xx + yy - 1.0).abs() < 0.5;
        let column = if xx > yy { [xx, xy] } else { [xy, yy] };
        let size = column[0].hypot(column[1]);
        (tangents == 2 && one).then(|| column.map(|x| x / size))
    }
}

impl<'a> Posed<'a> {
    /// Candidates.
    pub(super) fn len(&self) -> usize {
        self.candidates.len()
    }

    /// Rows of D.
    pub(super) fn rows(&self) -> usize {
        self.len() * (1 + self.tangents)
    }

    /// The row of the normal of candidate `i`.
    pub(super) fn normal(&self, i: usize) -> usize {
        i * (1 + self.tangents)
    }

    /// Entry of D over the rows of candidate `i`, 0 its normal.
    pub(super) fn entry(&self, i: usize, k: usize, l: usize) -> f64 {
        match self.d {
            Compliance::Dense(d) => d[(self.normal(i) + k) * self.rows() + self.normal(i) + l],
            Compliance::Lumped(d) => d.block(i, k, l),
            Compliance::Iterated(d) => {
                let first = self.normal(i);
                d.borrow().entry(first + k, first + l)
            }
        }
    }

    /// The relation of a candidate; of an open one, that of its closure.
    pub(super) fn relation(&self, i: usize, status: Status) -> Relation {
        let candidate = &self.candidates[i];
        let status = match status {
            Status::Open => Status::Closed,
            other => other,
        };
        candidate.law.get().relation(status, &candidate.local)
    }

    /// Factor of D p in a relation of candidate `i`.
    pub(super) fn factor(&self, i: usize, relation: &Relation) -> f64 {
        let [gap, rate] = self.factors(i);
        relation.gap * gap + relation.rate * rate
    }

    /// Factors of D p in gap and rate of candidate `i`.
    fn factors(&self, i: usize) -> [f64; 2] {
        self.candidates[i].factors([self.s[0], self.s[1]])
    }

    /// What a relation says before the forces of the step.
    pub(super) fn free(&self, i: usize, relation: &Relation) -> f64 {
        let candidate = &self.candidates[i];
        relation.gap * candidate.local.gap_free
            + relation.rate * candidate.rate_free
            + relation.offset
    }

    /// Derivative of a relation with respect to the force of its own candidate: it turns what the relation says into
    /// newtons.
    pub(super) fn slope(&self, i: usize, relation: &Relation) -> f64 {
        let slope = self.factor(i, relation) * self.entry(i, 0, 0) + relation.compliance;
        if slope > 0.0 { slope } else { 1.0 }
    }

    /// Force per sliding, N over the unit of q, that makes both comparable in candidate `i`.
    pub(super) fn weight(&self, i: usize) -> f64 {
        let own: f64 = (1..=self.tangents).map(|k| self.entry(i, k, k)).sum();
        let slope = self.s[2] * own / self.tangents as f64;
        if slope > 0.0 { 1.0 / slope } else { 1.0 }
    }

    /// What the problem says of candidate `i` by itself.
    pub(super) fn alone(&self, i: usize) -> Alone {
        let Some(own) = self.diagonal(i) else {
            return Alone {
                mobile: self.mobile(i),
                diagonal: None,
            };
        };
        let relation = self.relation(i, Status::Closed);
        let factor = self.factor(i, &relation);
        let slope = factor * own[0] + relation.compliance;
        Alone {
            mobile: [[1.0, 0.0], [0.0, 1.0]],
            diagonal: (slope > 0.0).then(|| Diagonal {
                own,
                factor,
                slope,
                free: self.free(i, &relation),
            }),
        }
    }

    /// Projector on the tangents along which forces of candidate `i` move it while its normal relation holds.
    ///
    /// A node on a plane of symmetry moves in that plane alone. Its rows of D are then dependent, but for what rounding of
    /// places leaves, and tangential forces across the plane, which the support takes, are not decided by anything. They
    /// are zero here. With S the tangential block of D less what the normal force takes back,
    /// `S = D_tt - f D_tn D_nt / (f D_nn + compliance)`, held are eigenvectors of S of (nearly) no mobility along which
    /// there is no sliding either: a surface whose motion is prescribed slides, and has friction.
    fn mobile(&self, i: usize) -> [[f64; 2]; 2] {
        let relation = self.relation(i, Status::Closed);
        let back = self.factor(i, &relation) / self.slope(i, &relation);
        let pressed = self.s[2] * self.free(i, &relation) / self.slope(i, &relation);
        let (mut s, mut sliding, mut size, mut trace) = ([[0.0; 2]; 2], [0.0; 2], 0.0, 0.0);
        for k in 0..self.tangents {
            let across = self.entry(i, k + 1, 0);
            for l in 0..self.tangents {
                s[k][l] = self.entry(i, k + 1, l + 1) - back * across * self.entry(i, 0, l + 1);
            }
            let free = self.friction[i].free[k];
            sliding[k] = free - pressed * across;
            size += free.powi(2) + (pressed * across).powi(2);
            trace += self.entry(i, k + 1, k + 1);
        }
        if let Compliance::Iterated(_) = self.d {
            // the motion without forces is not in what slides: of a point at rest that is rounding
            size += (self.s[2] * trace * self.friction[i].pressed).powi(2);
        }
        let least = HELD * (trace + self.entry(i, 0, 0));
        let slides = |along: f64| along.powi(2) > HELD * size;
        let mut mobile = [[1.0, 0.0], [0.0, 1.0]];
        if least == 0.0 {
            return mobile;
        }
        for (value, vector) in eigen(&s, self.tangents) {
            let along = vector[0] * sliding[0] + vector[1] * sliding[1];
            if value > least || slides(along) {
                continue;
            }
            for k in 0..2 {
                for l in 0..2 {
                    mobile[k][l] -= vector[k] * vector[l];
                }
            }
        }
        mobile
    }

    /// Entries of the block of D of candidate `i` along its normal and its tangents, where it is diagonal with equal tangents but for
    /// rounding and supports hold nothing of it: that of a node with equal masses in all directions.
    fn diagonal(&self, i: usize) -> Option<[f64; 2]> {
        let entry = |k: usize, l: usize| self.entry(i, k, l);
        let own = [entry(0, 0), entry(1, 1)];
        let least = ROUNDING * own[0].min(own[1]);
        let mut apart = entry(0, 1).abs().max(entry(1, 0).abs());
        if self.tangents == 2 {
            let across = [(0, 2), (2, 0), (1, 2), (2, 1)].map(|(k, l)| entry(k, l).abs());
            apart = across.into_iter().fold(apart, f64::max);
            apart = apart.max((entry(2, 2) - own[1]).abs());
        }
        let is_mobile = self.s[2] > 0.0 && own[1] > HELD * (own[0] + self.tangents as f64 * own[1]);
        (least > 0.0 && apart <= least && is_mobile).then_some(own)
    }

    /// End of the step in candidate `i` with the force `force`, with (D p)_n in all, and without its own forces.
    pub(super) fn end(&self, i: usize, force: f64, product: f64, others: f64) -> End {
        let candidate = &self.candidates[i];
        let [gap, rate] = self.factors(i);
        End {
            gap_released: candidate.local.gap_free + gap * others,
            gap: candidate.local.gap_free + gap * product,
            rate: candidate.rate_free + rate * product,
            force,
        }
    }

    /// (D p)_k of the forces of candidate `i` alone, k one of its rows, 0 its normal.
    pub(super) fn own(&self, (i, alone): (usize, &Alone), k: usize, p: &[f64]) -> f64 {
        let first = self.normal(i);
        if let Some(Diagonal { own, .. }) = &alone.diagonal {
            return own[k.min(1)] * p[first + k];
        }
        (0..=self.tangents)
            .map(|l| self.entry(i, k, l) * p[first + l])
            .sum()
    }
}

/// Eigenvalues and unit eigenvectors of a symmetric matrix of `n` rows, one or two.
fn eigen(s: &[[f64; 2]; 2], n: usize) -> impl Iterator<Item = (f64, [f64; 2])> {
    let (mean, half) = (0.5 * (s[0][0] + s[1][1]), 0.5 * (s[0][0] - s[1][1]));
    let radius = half.hypot(s[0][1]);
    let angle = 0.5 * s[0][1].atan2(half);
    let pairs = match n {
        1 => [(s[0][0], [1.0, 0.0]), (f64::INFINITY, [0.0; 2])],
        _ => [
            (mean + radius, [angle.cos(), angle.sin()]),
            (mean - radius, [-angle.sin(), angle.cos()]),
        ],
    };
    pairs.into_iter()
}
