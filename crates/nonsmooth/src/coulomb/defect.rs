//! How far forces are from the laws, by code that knows no solver.

use carom_laws::{End, Status};

use super::{FrictionProblem, FrictionSolution, Slip};

/// A row of D p: the sum, the sum of the sizes of its terms, the share of the candidate itself, and the diagonal.
#[derive(Clone, Copy)]
struct Line {
    sum: f64,
    size: f64,
    own: f64,
    diagonal: f64,
}

impl FrictionProblem {
    /// The largest violation of a law by a solution, relative to the terms that should balance in the same candidate.
    ///
    /// Normal: what the relation of the status leaves, the force of an open point, and where the law asks for another
    /// status the same of that one. Friction: the natural map `|t - proj(t - ρ q)|` with the projection on the disc of
    /// radius μ max(P, 0) and ρ the inverse of the tangential compliance; it vanishes for Coulomb's law alone. Tension
    /// that a law cuts off after the solve counts as a violation.
    pub fn defect(&self, solution: &FrictionSolution) -> f64 {
        let width = 1 + self.tangents;
        let mut p = Vec::with_capacity(self.candidates.len() * width);
        for (force, t) in solution.forces.iter().zip(&solution.tangential) {
            p.push(*force);
            p.extend(&t[..self.tangents]);
        }
        let mut largest = 0.0_f64;
        for i in 0..self.candidates.len() {
            let normal = self.normal_defect(solution, i, self.line(&p, i, 0));
            let tangential = self.friction_defect(solution, i, &p);
            for defect in [normal, tangential] {
                if defect.is_nan() || defect > largest {
                    largest = defect;
                }
            }
        }
        largest
    }

    fn line(&self, p: &[f64], i: usize, k: usize) -> Line {
        let width = 1 + self.tangents;
        let row = i * width + k;
        let d = &self.compliance[row * p.len()..(row + 1) * p.len()];
        let term = |j: usize| d[j] * p[j];
        Line {
            sum: (0..p.len()).map(term).sum(),
            size: (0..p.len()).map(|j| term(j).abs()).sum(),
            own: (i * width..(i + 1) * width).map(term).sum(),
            diagonal: d[row],
        }
    }

    fn normal_defect(&self, solution: &FrictionSolution, i: usize, dp: Line) -> f64 {
        let candidate = &self.candidates[i];
        let [s_g, s_v] = candidate.factors([self.factors[0], self.factors[1]]);
        let (law, force) = (candidate.law.get(), solution.forces[i]);
        let end = End {
            gap_released: candidate.local.gap_free + s_g * (dp.sum - dp.own),
            gap: candidate.local.gap_free + s_g * dp.sum,
            rate: candidate.rate_free + s_v * dp.sum,
            force,
        };
        let local = candidate.local.about(end.gap, end.rate);
        let defect = |status: Status| {
            let closed = match status {
                Status::Open => Status::Closed,
                other => other,
            };
            let relation = law.relation(closed, &local);
            let factor = relation.gap * s_g + relation.rate * s_v;
            let free = [
                relation.gap * candidate.local.gap_free,
                relation.rate * candidate.rate_free,
                relation.offset,
                relation.compliance * force,
            ];
            let size = factor * dp.size + free.iter().map(|x| x.abs()).sum::<f64>();
            match status {
                Status::Open => {
                    let force = (factor * dp.diagonal + relation.compliance) * force.abs();
                    relative(force, force + size)
                }
                _ => relative(factor * dp.sum + free.iter().sum::<f64>(), size),
            }
        };
        let status = solution.statuses[i];
        let asked = law.status(status, &end, &candidate.local, 0);
        defect(status).max(defect(asked))
    }

    fn friction_defect(&self, solution: &FrictionSolution, i: usize, p: &[f64]) -> f64 {
        let (point, t) = (&self.friction[i], solution.tangential[i]);
        let lines = [self.line(p, i, 1), self.line(p, i, self.tangents)];
        let rho = self.tangents as f64
            / lines[..self.tangents]
                .iter()
                .map(|line| self.factors[2] * line.diagonal)
                .sum::<f64>();
        let (mut y, mut size) = ([0.0; 2], 0.0);
        for k in 0..self.tangents {
            let q = point.free[k] + self.factors[2] * lines[k].sum;
            y[k] = t[k] - rho * q;
            size += t[k].abs() + rho * (point.free[k].abs() + self.factors[2] * lines[k].size);
        }
        let mu = match (solution.slips[i], point.sliding) {
            (Slip::Slip, Some(mu)) => mu,
            _ => point.mu,
        };
        let (bound, length) = (mu * solution.forces[i].max(0.0), y[0].hypot(y[1]));
        let share = if length > bound { bound / length } else { 1.0 };
        relative((t[0] - share * y[0]).hypot(t[1] - share * y[1]), size)
    }
}

fn relative(defect: f64, size: f64) -> f64 {
    if defect == 0.0 {
        0.0
    } else {
        defect.abs() / size
    }
}
