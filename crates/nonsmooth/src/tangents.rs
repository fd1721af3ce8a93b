//! Laws that are not linear: the relations of their points, renewed about the ends to which they lead until these stand.
//!
//! A relation that is the tangent of a law about gap and rate is as good as the law where it leads back to them. The solvers pose and
//! solve a problem of linear relations; this is the loop around them, Newton's method. Where a pass does not bring the ends nearer to
//! the laws, the next ones go half as far.

use carom_laws::Status;

use crate::interface::Candidate;

/// Largest force that is missing, over the largest of the terms that it is a difference of, at which relations stand: rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The same where rounding, or what solvers leave over, lets it fall no further.
const NEAR: f64 = 1e-9;

/// Part of the defect before above which a whole pass brings nothing more than rounding.
const GAIN: f64 = 0.5;

/// The least part of the way to the end of a pass.
const LEAST: f64 = 1.0 / 64.0;

/// Passes at most; some five are usual.
pub(crate) const MOST: usize = 200;

/// End of a point of a pass.
#[derive(Clone, Copy)]
pub(crate) struct Reached {
    /// Gap, m, and rate, m/s.
    pub(crate) at: [f64; 2],
    /// Force, N.
    pub(crate) force: f64,
    /// Status.
    pub(crate) status: Status,
}

/// Candidates with the relations of a pass.
#[derive(Default)]
pub(crate) struct Tangents {
    /// The candidates, each with the gap and the rate of its relation.
    pub(crate) candidates: Vec<Candidate>,
    /// The candidate that its law is furthest from, and by how much.
    pub(crate) worst: (f64, usize),
    /// Defect of the pass before, and the part of the way that a pass goes.
    before: f64,
    part: f64,
}

/// Whether all candidates have linear laws, so that one problem is all.
pub(crate) fn are_linear(candidates: &[Candidate]) -> bool {
    candidates.iter().all(|of| of.law.get().is_linear())
}

impl Tangents {
    /// Begins with the relations of the candidates as they are.
    pub(crate) fn begin(&mut self, candidates: &[Candidate]) {
        self.candidates.clear();
        self.candidates.extend_from_slice(candidates);
        (self.worst, self.before, self.part) = ((0.0, 0), f64::INFINITY, 1.0);
    }

    /// Takes the end of each candidate; whether the relations stand, otherwise they are renewed. `near`: the part of the largest force
    /// that the solver leaves over.
    pub(crate) fn stand(
        &mut self,
        near: f64,
        reached: impl Fn(&Candidate, usize) -> Reached,
    ) -> bool {
        let mut largest = 0.0_f64;
        self.worst = (0.0, 0);
        for (i, candidate) in self.candidates.iter().enumerate() {
            if candidate.law.get().is_linear() {
                continue;
            }
            let end = reached(candidate, i);
            let (missing, size) = missing(candidate, &end);
            largest = largest.max(size);
            if missing > self.worst.0 || missing.is_nan() {
                self.worst = (missing, i);
            }
        }
        if self.worst.0 == 0.0 {
            return true;
        }
        let defect = self.worst.0 / largest;
        self.worst.0 = defect;
        let stalls = self.part == 1.0 && defect > GAIN * self.before;
        if defect <= ROUNDING || stalls && defect <= near.max(NEAR) {
            return true;
        }
        self.part = match defect < self.before {
            true => f64::min(1.0, 2.0 * self.part),
            false => f64::max(LEAST, 0.5 * self.part),
        };
        self.before = defect;
        self.renew(reached);
        false
    }

    fn renew(&mut self, reached: impl Fn(&Candidate, usize) -> Reached) {
        let part = self.part;
        for (i, candidate) in self.candidates.iter_mut().enumerate() {
            let end = reached(candidate, i);
            for (at, end) in candidate.local.at.iter_mut().zip(end.at) {
                *at += part * (end - *at);
            }
            candidate.status = end.status;
        }
    }
}

/// Force (N) by which the end of a point is off its law, and the size of the terms that it is a difference of.
fn missing(candidate: &Candidate, end: &Reached) -> (f64, f64) {
    let (law, local) = (candidate.law.get(), &candidate.local);
    if end.status == Status::Open {
        return (0.0, 0.0);
    }
    let [gap, rate] = end.at;
    let relation = law.relation(end.status, &local.about(gap, rate));
    let left = relation.gap * gap
        + relation.rate * rate
        + relation.compliance * end.force
        + relation.offset;
    let of_gap = relation.gap * (gap.abs() + local.gap_free.abs());
    let of_rate = relation.rate * (rate.abs() + candidate.rate_free.abs());
    let size = of_gap + of_rate + end.force.abs();
    (left.abs(), size)
}
