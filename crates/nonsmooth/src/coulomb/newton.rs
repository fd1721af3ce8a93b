//! One pass of the semi-smooth Newton method: the equations of frozen statuses, linearised and solved.

use carom_algebra::Error;
use carom_algebra::dense::DenseLu;
use carom_laws::Status;

use super::trial::Trial;
use super::{Posed, Slip};

/// What is added to the diagonal of the equations, which is about one: where D is singular the forces that nothing
/// decides stay as they are. Refinement takes its effect on all others away.
pub(super) const SHIFT: f64 = 1e-11;
/// Refinements of the solution of the linear system.
const REFINEMENTS: usize = 6;

/// The change of the forces that solves the linearised equations of the trial. `d`: all entries of D, row-major.
///
/// Points that are open lose their forces at once. In a point that slips, with Π = I - e eᵀ and c = b/|t - ρ q|,
/// ```text
/// δt - μ e δP - c Π M (δt - ρ s_t D_t δp) = -(t - μ e P)
/// ```
/// with M the projector on the tangents that no support holds, where b = μ (P - R) is replaced by the μ P to which it is equal once R = 0.
pub(super) fn step(
    (problem, d): (&Posed, &[f64]),
    trial: &Trial,
    shift: f64,
    dp: &mut [f64],
) -> Result<(), Error> {
    let rows = active(problem, trial);
    let mut free = vec![true; problem.rows()];
    for &row in &rows {
        free[row] = false;
    }
    for (row, dp) in dp.iter_mut().enumerate() {
        *dp = if free[row] { -trial.p[row] } else { 0.0 };
    }
    let m = rows.len();
    let (mut matrix, mut rhs) = (vec![0.0; m * m], vec![0.0; m]);
    let mut line = vec![0.0; problem.rows()];
    for (k, &row) in rows.iter().enumerate() {
        rhs[k] = -equation((problem, d), trial, row, &mut line);
        for (column, dp) in dp.iter().enumerate().filter(|(_, dp)| **dp != 0.0) {
            rhs[k] -= line[column] * dp;
        }
        for (l, &column) in rows.iter().enumerate() {
            matrix[l * m + k] = line[column];
        }
    }
    if m > 0 {
        for (&row, change) in rows.iter().zip(refined(&matrix, &rhs, shift)?) {
            dp[row] = change;
        }
    }
    Ok(())
}

/// The rows that may carry a force.
fn active(problem: &Posed, trial: &Trial) -> Vec<usize> {
    let mut rows = Vec::new();
    for i in 0..problem.len() {
        let row = problem.normal(i);
        if trial.statuses[i] != Status::Open {
            rows.push(row);
        }
        if trial.slips[i] != Slip::Open && problem.friction[i].mu > 0.0 {
            rows.extend(row + 1..=row + problem.tangents);
        }
    }
    rows
}

/// One linearised equation: its defect, and in `line` its derivative with respect to all forces.
fn equation((problem, d): (&Posed, &[f64]), trial: &Trial, row: usize, line: &mut [f64]) -> f64 {
    let d = |row: usize| &d[row * problem.rows()..(row + 1) * problem.rows()];
    let (i, k) = (row / (1 + problem.tangents), row % (1 + problem.tangents));
    if k == 0 {
        let relation = problem.relation(i, trial.statuses[i]);
        let slope = problem.slope(i, &relation);
        let factor = problem.factor(i, &relation) / slope;
        set(line, factor, d(row));
        line[row] += relation.compliance / slope;
        return trial.defects[row];
    }
    let factor = problem.weight(i) * problem.s[2];
    let (normal, mobile) = (problem.normal(i), trial.alone[i].mobile);
    let (e, mu) = (trial.directions[i], problem.friction[i].mu);
    let sticks = trial.slips[i] == Slip::Stick;
    line.fill(0.0);
    for l in 1..=problem.tangents {
        let unit = if l == k { 1.0 } else { 0.0 };
        let along = e[0] * mobile[0][l - 1] + e[1] * mobile[1][l - 1];
        let projection = match sticks {
            true => mobile[k - 1][l - 1],
            false => trial.curvatures[i] * (mobile[k - 1][l - 1] - e[k - 1] * along),
        };
        if projection != 0.0 {
            for (line, d) in line.iter_mut().zip(d(normal + l)) {
                *line += projection * factor * d;
            }
        }
        line[normal + l] += unit - projection;
    }
    if sticks {
        return trial.defects[row];
    }
    line[normal] -= mu * e[k - 1];
    trial.p[row] - mu * e[k - 1] * trial.p[normal]
}

fn set(line: &mut [f64], factor: f64, d: &[f64]) {
    for (line, d) in line.iter_mut().zip(d) {
        *line = factor * d;
    }
}

/// Solution of a column-major system by its shifted matrix and refinement.
fn refined(matrix: &[f64], rhs: &[f64], shift: f64) -> Result<Vec<f64>, Error> {
    let m = rhs.len();
    let mut shifted = matrix.to_vec();
    for k in 0..m {
        shifted[k * m + k] += shift;
    }
    let factor = DenseLu::new(m, shifted)?;
    let (mut x, mut rest) = (vec![0.0; m], rhs.to_vec());
    let mut before = f64::INFINITY;
    for _ in 0..if shift > SHIFT { 1 } else { REFINEMENTS } {
        let change = factor.solve(&rest);
        for (x, change) in x.iter_mut().zip(&change) {
            *x += change;
        }
        rest.copy_from_slice(rhs);
        for (column, x) in matrix.chunks_exact(m).zip(&x) {
            for (rest, a) in rest.iter_mut().zip(column) {
                *rest -= a * x;
            }
        }
        let size = rest.iter().fold(0.0_f64, |size, r| size.max(r.abs()));
        if size == 0.0 || size > 0.5 * before {
            break;
        }
        before = size;
    }
    Ok(x)
}
