//! A trial of the forces: statuses that it asks for, and what is missing to the solution.

use carom_laws::Status;

use super::posed::Alone;
use super::{Posed, Slip};
use crate::Compliance;

/// Forces, the statuses that they ask for, and the defects of the equations of these statuses, N.
///
/// The equations are written in newtons. With the relation of the law divided by its slope, R, in a closed point and the
/// force P in an open one; and with the weight ρ,
/// ```text
/// stick, |t - ρ q| <= b:   ρ q = 0
/// slip,  |t - ρ q| > b:    t - b e = 0,   e = (t - ρ q)/|t - ρ q|,   b = μ (P - R)
/// ```
/// of which the second is t less the projection of t - ρ q on the disc of radius b. Where supports hold a tangent
/// ([`Posed::mobile`]), t - ρ q is its part along the others. For laws that are complementarity of
/// the force and one quantity the defects are continuous in the forces.
#[derive(Default)]
pub(super) struct Trial {
    /// Forces of all rows, N.
    pub(super) p: Vec<f64>,
    /// D p.
    pub(super) product: Vec<f64>,
    /// What is known of each candidate by itself.
    pub(super) alone: Vec<Alone>,
    /// Σ |D_ij p_j|, or a bound of it.
    sizes: Vec<f64>,
    /// Scratch.
    motion: Vec<f64>,
    /// Normal statuses.
    pub(super) statuses: Vec<Status>,
    /// Tangential statuses.
    pub(super) slips: Vec<Slip>,
    /// e of the points that slip.
    pub(super) directions: Vec<[f64; 2]>,
    /// b/|t - ρ q| of the points that slip; 0 where the direction is given.
    pub(super) curvatures: Vec<f64>,
    /// Defects of all rows, N.
    pub(super) defects: Vec<f64>,
    /// The largest defect over the size of the terms that should balance, and its candidate.
    pub(super) worst: (f64, usize),
    /// Sum of the squared defects, N².
    pub(super) merit: f64,
}

impl Trial {
    /// Becomes like another one, in the room that it has.
    pub(super) fn copy_from(&mut self, other: &Trial) {
        let numbers = [
            (&mut self.p, &other.p),
            (&mut self.product, &other.product),
            (&mut self.sizes, &other.sizes),
            (&mut self.curvatures, &other.curvatures),
            (&mut self.defects, &other.defects),
        ];
        for (own, of_other) in numbers {
            own.clone_from(of_other);
        }
        self.alone.clone_from(&other.alone);
        self.statuses.clone_from(&other.statuses);
        self.slips.clone_from(&other.slips);
        self.directions.clone_from(&other.directions);
        (self.worst, self.merit) = (other.worst, other.merit);
    }

    /// The trial of no force, with the statuses at the end of the last step.
    pub(super) fn start(&mut self, problem: &Posed) {
        let (n, rows) = (problem.len(), problem.rows());
        // nothing is measured yet, and the worst candidate of another problem may be none of this one
        self.worst = (f64::INFINITY, 0);
        for values in [&mut self.p, &mut self.product, &mut self.defects] {
            values.clear();
            values.resize(rows, 0.0);
        }
        self.alone.clear();
        self.alone.extend((0..n).map(|i| problem.alone(i)));
        self.statuses.clear();
        // a corner is found anew in each step, from a closed point that opens
        let last = problem.candidates.iter().map(|c| match c.status {
            Status::Corner => Status::Closed,
            other => other,
        });
        self.statuses.extend(last);
        self.slips.clear();
        self.slips.resize(n, Slip::Open);
        self.directions.clear();
        self.directions.resize(n, [0.0; 2]);
        self.curvatures.clear();
        self.curvatures.resize(n, 0.0);
        for (i, point) in problem.friction.iter().enumerate() {
            let size = point.force[0].hypot(point.force[1]);
            if self.statuses[i] == Status::Open {
                continue;
            }
            self.slips[i] = Slip::Stick;
            if point.slip == Slip::Slip && size > 0.0 {
                self.slips[i] = Slip::Slip;
                self.directions[i] = point.force.map(|force| force / size);
            }
            let row = problem.normal(i);
            self.defects[row] = self.relation_defect(problem, i, &mut 0.0);
            let (weight, mobile) = (problem.weight(i), self.alone[i].mobile);
            for k in 0..problem.tangents {
                let slid = mobile[k][0] * point.free[0] + mobile[k][1] * point.free[1];
                self.defects[row + 1 + k] = weight * slid;
            }
        }
    }

    /// Takes the forces of the last step.
    pub(super) fn go_on_from_last(&mut self, problem: &Posed) {
        for (i, point) in problem.friction.iter().enumerate() {
            if self.statuses[i] == Status::Open {
                continue;
            }
            let row = problem.normal(i);
            self.p[row] = point.pressed;
            self.p[row + 1..=row + problem.tangents]
                .copy_from_slice(&point.force[..problem.tangents]);
        }
    }

    /// Takes the statuses that the forces ask for, and measures what is missing. `reversals` counts, in each candidate,
    /// how often its normal status has turned within the step.
    pub(super) fn measure(&mut self, problem: &Posed, reversals: &[u32]) {
        self.worst = (0.0, 0);
        self.merit = 0.0;
        self.multiply(problem);
        for i in 0..problem.len() {
            let mut sizes = [0.0; 3];
            let row = problem.normal(i);
            let width = 1 + problem.tangents;
            sizes[..width].copy_from_slice(&self.sizes[row..row + width]);
            let pressed = self.measure_normal(problem, i, reversals[i], &mut sizes[0]);
            self.measure_tangential(problem, i, pressed, &mut sizes[1..]);
            let size: f64 = sizes.iter().sum();
            for k in 0..=problem.tangents {
                let defect = self.defects[row + k];
                self.merit += defect * defect;
                let relative = if defect == 0.0 {
                    0.0
                } else {
                    defect.abs() / size
                };
                if relative.is_nan() || relative > self.worst.0 {
                    self.worst = (relative, i);
                }
            }
        }
    }

    /// The least share beyond `least` of a change of the forces at which a point closes, opens, begins to slip or to stick;
    /// infinite without any.
    ///
    /// P - R and t - ρ q are linear in the share, so that the changes are roots of linear and quadratic equations.
    pub(super) fn first_change(
        &self,
        problem: &Posed,
        (d, change): (&[f64], &[f64]),
        least: f64,
    ) -> f64 {
        let mut first = f64::INFINITY;
        let mut take = |share: f64| {
            if share > least {
                first = first.min(share);
            }
        };
        for i in 0..problem.len() {
            let (row, point) = (problem.normal(i), &problem.friction[i]);
            let moved = |row: usize| -> f64 {
                let d = &d[row * change.len()..(row + 1) * change.len()];
                d.iter().zip(change).map(|(d, change)| d * change).sum()
            };
            let relation = problem.relation(i, self.statuses[i]);
            let (factor, slope) = (problem.factor(i, &relation), problem.slope(i, &relation));
            let along = (factor * moved(row) + relation.compliance * change[row]) / slope;
            let pressed = self.p[row] - self.relation_defect(problem, i, &mut 0.0);
            let pressing = change[row] - along;
            take(-pressed / pressing);
            if self.statuses[i] == Status::Open || point.mu == 0.0 {
                continue;
            }
            let weight = problem.weight(i);
            let (mut y, mut turn) = ([0.0; 2], [0.0; 2]);
            for k in 0..problem.tangents {
                let row = row + 1 + k;
                let slid = point.free[k] + problem.s[2] * self.product[row];
                y[k] = self.p[row] - weight * slid;
                turn[k] = change[row] - weight * problem.s[2] * moved(row);
            }
            let mobile = self.alone[i].mobile;
            let [y, turn] = [y, turn].map(|y| mobile.map(|row| row[0] * y[0] + row[1] * y[1]));
            let (bound, growth) = (point.mu * pressed, point.mu * pressing);
            let a = turn[0].powi(2) + turn[1].powi(2) - growth.powi(2);
            let half = y[0] * turn[0] + y[1] * turn[1] - bound * growth;
            let c = y[0].powi(2) + y[1].powi(2) - bound.powi(2);
            let root = (half * half - a * c).sqrt();
            // without cancellation; no root is not a number, which is not beyond anything
            let larger = -half - root.copysign(half);
            take(larger / a);
            take(c / larger);
        }
        first
    }

    /// D p, and the sizes of its terms.
    pub(super) fn multiply(&mut self, problem: &Posed) {
        match problem.d {
            Compliance::Dense(d) => {
                self.sizes.resize(problem.rows(), 0.0);
                for (row, d) in d.chunks_exact(problem.rows()).enumerate() {
                    let (mut sum, mut absolute) = (0.0, 0.0);
                    for term in d.iter().zip(&self.p).map(|(d, p)| d * p) {
                        sum += term;
                        absolute += f64::abs(term);
                    }
                    (self.product[row], self.sizes[row]) = (sum, absolute);
                }
            }
            Compliance::Iterated(d) => {
                let d = d.borrow();
                for (row, product) in self.product.iter_mut().enumerate() {
                    *product = d.along(row);
                }
                self.sizes.clear();
                self.sizes
                    .extend(self.product.iter().map(|product| product.abs()));
            }
            Compliance::Lumped(d) => {
                d.sizes(&self.p, &mut self.motion, &mut self.sizes);
                d.gather(&self.p, &mut self.motion);
                for (row, product) in self.product.iter_mut().enumerate() {
                    *product = d.along(row, &self.motion);
                }
            }
        }
    }

    /// Whether no defect is larger than the tolerance that was asked for, of the largest force. A candidate that hardly
    /// carries anything may be far from its laws in its own measure, and no step is the better for more.
    pub(super) fn is_near(&self, problem: &Posed) -> bool {
        self.worst.0.is_finite() && largest(&self.defects) <= problem.tolerance * largest(&self.p)
    }

    /// The largest defect over the largest force; zero without any.
    pub(super) fn largest_defect(&self) -> f64 {
        match largest(&self.defects) {
            0.0 => 0.0,
            defect => defect / largest(&self.p),
        }
    }

    /// Whether a candidate has the statuses that it has in another trial.
    pub(super) fn has_statuses_of(&self, i: usize, other: &Trial) -> bool {
        self.statuses[i] == other.statuses[i] && self.slips[i] == other.slips[i]
    }

    /// Takes what another trial says of the statuses of a candidate.
    pub(super) fn keep_status(&mut self, i: usize, other: &Trial) {
        self.statuses[i] = other.statuses[i];
        self.slips[i] = other.slips[i];
        self.directions[i] = other.directions[i];
    }

    /// Status and defect of the normal; P - R, zero in an open point.
    fn measure_normal(&mut self, problem: &Posed, i: usize, reversals: u32, size: &mut f64) -> f64 {
        let row = problem.normal(i);
        let candidate = &problem.candidates[i];
        let (force, product) = (self.p[row], self.product[row]);
        let others = product - problem.own((i, &self.alone[i]), 0, &self.p);
        // The signs are those of P - R, whichever status the point has: of the force where R = 0, of the gap or rate
        // where P = 0.
        let end = match self.statuses[i] {
            Status::Open => problem.end(i, 0.0, product - problem.entry(i, 0, 0) * force, others),
            _ => {
                let pressed = force - self.relation_defect(problem, i, &mut 0.0);
                problem.end(i, pressed, product, others)
            }
        };
        let law = candidate.law.get();
        self.statuses[i] = law.status(self.statuses[i], &end, &candidate.local, reversals);
        let defect = self.relation_defect(problem, i, size);
        if self.statuses[i] == Status::Open {
            self.defects[row] = force;
            return 0.0;
        }
        self.defects[row] = defect;
        force - defect
    }

    /// What the relation of the status is short of, N. `size` is the sum of |D p| at entry, the size of the terms in N
    /// at the end.
    fn relation_defect(&self, problem: &Posed, i: usize, size: &mut f64) -> f64 {
        let row = problem.normal(i);
        let relation = problem.relation(i, self.statuses[i]);
        let (factor, slope) = (problem.factor(i, &relation), problem.slope(i, &relation));
        let free = problem.free(i, &relation);
        *size = self.p[row].abs() + (factor * *size + free.abs()) / slope;
        (factor * self.product[row] + relation.compliance * self.p[row] + free) / slope
    }

    fn measure_tangential(&mut self, problem: &Posed, i: usize, pressed: f64, sizes: &mut [f64]) {
        let point = &problem.friction[i];
        let (row, weight) = (problem.normal(i) + 1, problem.weight(i));
        let (mut t, mut y) = ([0.0; 2], [0.0; 2]);
        for k in 0..problem.tangents {
            t[k] = self.p[row + k];
            y[k] = t[k] - weight * (point.free[k] + problem.s[2] * self.product[row + k]);
            sizes[k] = t[k].abs() + weight * (point.free[k].abs() + problem.s[2] * sizes[k]);
        }
        let y = self.alone[i]
            .mobile
            .map(|row| row[0] * y[0] + row[1] * y[1]);
        let (bound, size) = (point.mu * pressed.max(0.0), y[0].hypot(y[1]));
        self.curvatures[i] = 0.0;
        self.slips[i] = if self.statuses[i] == Status::Open {
            Slip::Open
        } else if size <= bound {
            Slip::Stick
        } else {
            self.directions[i] = y.map(|y| y / size);
            self.curvatures[i] = bound / size;
            Slip::Slip
        };
        for k in 0..problem.tangents {
            self.defects[row + k] = match self.slips[i] {
                Slip::Open => t[k],
                Slip::Stick => t[k] - y[k],
                Slip::Slip => t[k] - bound * self.directions[i][k],
            };
        }
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, x| most.max(x.abs()))
}
