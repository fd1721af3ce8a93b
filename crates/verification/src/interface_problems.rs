//! Random interface problems.
//!
//! Problem: 0 <= q + D P ⟂ P >= 0 for random q and symmetric positive definite D, of 5 to 500 contacts, of three kinds:
//! well posed; nearly singular (the compliance of contacts that nearly repeat each other); and with bilateral rows
//! eliminated, D - D_c D_cc⁻¹ D_cᵀ. Each is solved as a step would solve it. Closed solution: none, but the conditions
//! themselves, checked by code that knows no solver: the error of a contact is |min(P_i / P, (q + D P)_i / q)|, with P and q the
//! largest force and gap. Tolerance 1e-10 (issue of the laboratory): rounding times the condition that is left.

use carom_dynamics::{Candidate, InterfaceProblem};

use crate::Error;
use crate::check::{Check, Row, Size};

/// Problems of each kind and size.
const TRIALS: usize = 75;

pub(crate) const CHECK: Check = Check {
    name: "interface-problems",
    fact: "random contact problems are solved, whatever their size and condition, and none goes in circles for ever",
    run: |size| {
        let sizes: &[usize] = match size {
            Size::Quick => &[5, 20, 60],
            Size::Full => &[5, 20, 60, 500],
        };
        let mut random = Random(7);
        let mut rows = Vec::new();
        for &n in sizes {
            for kind in [Kind::Posed, Kind::NearlySingular, Kind::Bilateral] {
                rows.extend(trials(n, kind, &mut random)?);
            }
        }
        Ok(rows)
    },
};

#[derive(Clone, Copy, Debug)]
enum Kind {
    Posed,
    NearlySingular,
    Bilateral,
}

fn trials(n: usize, kind: Kind, random: &mut Random) -> Result<[Row; 2], Error> {
    let (mut largest, mut unsolved) = (0.0_f64, 0);
    for _ in 0..TRIALS {
        let (d, q) = problem(n, kind, random);
        let problem = InterfaceProblem {
            step: 0,
            names: Vec::new(),
            candidates: q.iter().copied().map(Candidate::unilateral).collect(),
            compliance: d,
            factors: [1.0, 0.0],
        };
        match problem.solve() {
            Ok(solution) => largest = largest.max(error(&problem.compliance, &q, &solution.forces)),
            Err(_) => unsolved += 1,
        }
    }
    Ok([
        Row::count(
            format!("{n} contacts, {kind:?}: problems not solved"),
            unsolved,
            0,
        ),
        Row::at_most(
            format!("{n} contacts, {kind:?}: largest error"),
            largest,
            1e-10,
        ),
    ])
}

/// Largest |min(P_i / P, w_i / q)| with w = q + D P.
fn error(d: &[f64], q: &[f64], forces: &[f64]) -> f64 {
    let n = q.len();
    let size = |values: &[f64]| values.iter().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
    let (force, gap) = (size(forces), size(q));
    let w = |i: usize| {
        q[i] + d[i * n..(i + 1) * n]
            .iter()
            .zip(forces)
            .map(|(d, p)| d * p)
            .sum::<f64>()
    };
    (0..n)
        .map(|i| (forces[i] / force).min(w(i) / gap).abs())
        .fold(0.0, f64::max)
}

/// D with correlation exp(-|x_i - x_j| / length) over random places and random scales: positive definite, and the nearer
/// to singular the longer the correlation.
fn problem(n: usize, kind: Kind, random: &mut Random) -> (Vec<f64>, Vec<f64>) {
    let fixed = if matches!(kind, Kind::Bilateral) {
        1 + n / 5
    } else {
        0
    };
    let total = n + fixed;
    let length = if matches!(kind, Kind::NearlySingular) {
        1e5
    } else {
        0.3
    };
    let places: Vec<f64> = (0..total).map(|_| random.next()).collect();
    let scales: Vec<f64> = (0..total).map(|_| 1.1 + random.next()).collect();
    let mut d = vec![0.0; total * total];
    for i in 0..total {
        for j in 0..total {
            d[i * total + j] =
                scales[i] * scales[j] * (-(places[i] - places[j]).abs() / length).exp();
        }
    }
    // bilateral rows are the last: Schur complement, one row after the other
    for k in (n..total).rev() {
        for i in 0..k {
            let factor = d[i * total + k] / d[k * total + k];
            for j in 0..k {
                d[i * total + j] -= factor * d[k * total + j];
            }
        }
    }
    let reduced = (0..n * n).map(|at| d[at / n * total + at % n]).collect();
    (reduced, (0..n).map(|_| random.next()).collect())
}

/// Numbers in [-1, 1[ from a linear congruential generator (Knuth's MMIX).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
