//! Nonsmooth Gauss-Seidel: one candidate after the other, each solved exactly while the others stand.

use carom_laws::{Relation, Status};

use super::Posed;
use super::posed::{Alone, Diagonal};
use super::trial::Trial;
use crate::Lumped;

/// Most steps towards the slip; some eight are usual.
const STEPS: usize = 60;
/// What is left of |t| - μ P, over its terms, where the slip is found.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Passes of the status of one candidate.
const TURNS: u32 = 12;

/// The products with D that a sweep keeps up to date.
pub(super) trait Product {
    /// Makes what is kept for these forces.
    fn gather(&self, p: &[f64], kept: &mut Vec<f64>);
    /// Entries of D p in the `width` rows of a candidate, from what is kept.
    fn at(&self, candidate: usize, width: usize, kept: &[f64]) -> [f64; 3];
    /// What is kept when these entries of p change.
    fn change(&self, candidate: usize, width: usize, changes: &[f64; 3], kept: &mut [f64]);
}

/// All entries of D, row-major; D p is kept.
impl Product for [f64] {
    fn gather(&self, p: &[f64], kept: &mut Vec<f64>) {
        kept.clear();
        let of_row = |d: &[f64]| d.iter().zip(p).map(|(d, p)| d * p).sum::<f64>();
        kept.extend(self.chunks_exact(p.len()).map(of_row));
    }

    fn at(&self, candidate: usize, width: usize, kept: &[f64]) -> [f64; 3] {
        let mut products = [0.0; 3];
        products[..width].copy_from_slice(&kept[candidate * width..][..width]);
        products
    }

    fn change(&self, candidate: usize, width: usize, changes: &[f64; 3], kept: &mut [f64]) {
        for (k, change) in changes[..width]
            .iter()
            .enumerate()
            .filter(|of| *of.1 != 0.0)
        {
            // D is symmetric: its row is its column
            let row = candidate * width + k;
            let d = &self[row * kept.len()..(row + 1) * kept.len()];
            for (kept, d) in kept.iter_mut().zip(d) {
                *kept += change * d;
            }
        }
    }
}

/// D is the product of sparse rows, and Bᵀ p is kept.
impl Product for Lumped {
    fn gather(&self, p: &[f64], kept: &mut Vec<f64>) {
        Lumped::gather(self, p, kept);
    }

    fn at(&self, candidate: usize, _: usize, kept: &[f64]) -> [f64; 3] {
        self.along_all(candidate, kept)
    }

    fn change(&self, candidate: usize, _: usize, changes: &[f64; 3], kept: &mut [f64]) {
        self.add_all(candidate, changes, kept);
    }
}

/// One sweep over all candidates; forces and statuses of the trial change, its defects do not. Returns the largest change of a force
/// over the largest force.
pub(super) fn sweep<D: Product + ?Sized>(
    (problem, d): (&Posed, &D),
    trial: &mut Trial,
    kept: &mut [f64],
) -> f64 {
    let (mut change, mut largest) = (0.0_f64, 0.0_f64);
    for i in 0..problem.len() {
        let (row, width) = (problem.normal(i), 1 + problem.tangents);
        let mut others = d.at(i, width, kept);
        for (k, others) in others.iter_mut().enumerate().take(width) {
            *others -= problem.own((i, &trial.alone[i]), k, &trial.p);
        }
        let of = (problem, &trial.alone[i]);
        let forces = solve(of, i, &mut trial.statuses[i], &others);
        let mut changes = [0.0; 3];
        for k in 0..width {
            changes[k] = forces[k] - trial.p[row + k];
            trial.p[row + k] = forces[k];
            change = change.max(changes[k].abs());
            largest = largest.max(forces[k].abs());
        }
        if changes != [0.0; 3] {
            d.change(i, width, &changes, kept);
        }
    }
    if change == 0.0 { 0.0 } else { change / largest }
}

/// The forces [P, t] of one candidate, with `others` = D p of all other candidates in its rows.
fn solve(
    (problem, alone): (&Posed, &Alone),
    i: usize,
    status: &mut Status,
    others: &[f64; 3],
) -> [f64; 3] {
    let candidate = &problem.candidates[i];
    let law = candidate.law.get();
    let mut forces = [0.0; 3];
    for turn in 0..TURNS {
        forces = match (*status, &alone.diagonal) {
            (Status::Open, _) => [0.0; 3],
            (Status::Closed, Some(diagonal)) => uncoupled((problem, i), diagonal, others),
            (status, _) => closed((problem, alone), i, &problem.relation(i, status), others),
        };
        let row = |k: usize| problem.entry(i, 0, k) * forces[k];
        let own = match &alone.diagonal {
            Some(Diagonal { own, .. }) => own[0] * forces[0],
            None => (0..=problem.tangents).map(row).sum::<f64>(),
        };
        let product = others[0] + own;
        let end = problem.end(i, forces[0], product, others[0]);
        let asked = law.status(*status, &end, &candidate.local, turn);
        if asked == *status {
            break;
        }
        *status = asked;
    }
    forces
}

/// The forces of a closed candidate: those that stick, if the bound lets them, else those of the slip q = -λ t with the
/// λ > 0 at which |t| = μ P. The equations are linear for a given λ; λ = 0 sticks, λ → ∞ is frictionless.
fn closed(
    (problem, alone): (&Posed, &Alone),
    i: usize,
    relation: &Relation,
    others: &[f64; 3],
) -> [f64; 3] {
    let point = &problem.friction[i];
    let factor = problem.factor(i, relation);
    let scale = 1.0 / problem.weight(i);
    let mut a = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut rhs = [0.0; 3];
    for k in 0..=problem.tangents {
        let s = if k == 0 { factor } else { problem.s[2] };
        for l in 0..=problem.tangents {
            a[k][l] = s * problem.entry(i, k, l);
        }
        rhs[k] = -s * others[k]
            - match k {
                0 => problem.free(i, relation),
                _ => point.free[k - 1],
            };
    }
    hold(&alone.mobile, scale, (&mut a, &mut rhs));
    a[0][0] += relation.compliance;
    let frictionless = [rhs[0] / problem.slope(i, relation), 0.0, 0.0];
    if point.mu == 0.0 {
        return frictionless;
    }
    let at = |lambda: f64| {
        let mut a = a;
        for (k, a) in a.iter_mut().enumerate().skip(1).take(problem.tangents) {
            a[k] += lambda;
        }
        gauss(a, rhs)
    };
    let excess = |x: &[f64; 3]| (x[1] * x[1] + x[2] * x[2]).sqrt() - point.mu * x[0];
    // the share of rounding keeps two equal rows apart
    let stuck = at(f64::EPSILON * scale);
    let most = excess(&stuck);
    if most <= 0.0 {
        return stuck;
    }
    if frictionless[0] <= 0.0 {
        return frictionless;
    }
    // λ = scale (1 - x)/x, x from 0 (frictionless) to 1 (stick)
    let at = |x: f64| at(scale * (1.0 - x) / x);
    let (mut low, mut high) = ((0.0, excess(&frictionless)), (1.0, most));
    let mut slipping = frictionless;
    for step in 0..STEPS {
        // false position (Illinois), and bisection where that is outside or slow
        let secant = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        let inside = secant > low.0 && secant < high.0 && step % 4 != 3;
        let x = if inside {
            secant
        } else {
            0.5 * (low.0 + high.0)
        };
        let trial = at(x);
        let left = excess(&trial);
        let solved = left.abs() <= ROUNDING * point.mu * trial[0].abs();
        if left <= 0.0 || solved {
            slipping = trial;
        }
        if solved || high.0 - low.0 <= f64::EPSILON * high.0 {
            break;
        }
        match left > 0.0 {
            true => (high, low.1) = ((x, left), 0.5 * low.1),
            false => (low, high.1) = ((x, left), 0.5 * high.1),
        }
    }
    slipping
}

/// The forces of a closed candidate whose block of D is diagonal, with equal tangents: the slip is along the tangential force that
/// sticks, and the normal force does not depend on it.
fn uncoupled((problem, i): (&Posed, usize), of: &Diagonal, others: &[f64; 3]) -> [f64; 3] {
    let point = &problem.friction[i];
    let pressed = -(of.factor * others[0] + of.free) / of.slope;
    let mut forces = [pressed, 0.0, 0.0];
    let slope = problem.s[2] * of.own[1];
    for k in 0..problem.tangents {
        forces[k + 1] = -(problem.s[2] * others[k + 1] + point.free[k]) / slope;
    }
    let square = forces[1] * forces[1] + forces[2] * forces[2];
    let bound = point.mu * pressed.max(0.0);
    if square > bound * bound {
        let share = bound / square.sqrt();
        (forces[1], forces[2]) = (share * forces[1], share * forces[2]);
    }
    forces
}

/// Replaces the equations of tangents that supports hold by those of no force there.
fn hold(mobile: &[[f64; 2]; 2], scale: f64, (a, rhs): (&mut [[f64; 3]; 3], &mut [f64; 3])) {
    let (full, right) = (*a, *rhs);
    for k in 0..2 {
        let [first, second] = mobile[k];
        for l in 0..3 {
            let unit = if l == k + 1 { 1.0 } else { 0.0 };
            let held = if l == 0 { 0.0 } else { unit - mobile[k][l - 1] };
            a[k + 1][l] = first * full[1][l] + second * full[2][l] + scale * held;
        }
        rhs[k + 1] = first * right[1] + second * right[2];
    }
}

/// Solution of three equations whose diagonal blocks are positive (semi-)definite, pivots by size.
fn gauss(mut a: [[f64; 3]; 3], mut b: [f64; 3]) -> [f64; 3] {
    for k in 0..3 {
        let pivot = (k..3).fold(k, |best, row| {
            if a[row][k].abs() > a[best][k].abs() {
                row
            } else {
                best
            }
        });
        a.swap(k, pivot);
        b.swap(k, pivot);
        for row in k + 1..3 {
            let share = a[row][k] / a[k][k];
            for column in k..3 {
                a[row][column] -= share * a[k][column];
            }
            b[row] -= share * b[k];
        }
    }
    for k in (0..3).rev() {
        let known: f64 = (k + 1..3).map(|column| a[k][column] * b[column]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    b
}
