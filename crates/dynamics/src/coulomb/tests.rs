use carom_contact::Law;
use carom_contact::law::{Adhesion, Damped, Displacement, Local};
use carom_testing::Random;

use super::*;

fn candidate(law: Law, gap_free: f64) -> Candidate {
    Candidate {
        law,
        local: Local {
            area: 1.0,
            share: 1.0,
            gap_free,
            ..Local::default()
        },
        rate_free: 0.0,
        status: Status::Open,
    }
}

const RIGID: Law = Law::Displacement(Displacement { projection: false });

/// D = B Bᵀ + `diagonal` I of random B with `columns` columns.
fn compliance(rows: usize, columns: usize, diagonal: f64, random: &mut Random) -> Vec<f64> {
    let b = random.vector(rows * columns);
    let mut d = vec![0.0; rows * rows];
    for i in 0..rows {
        for j in 0..rows {
            let dot: f64 = (0..columns)
                .map(|k| b[i * columns + k] * b[j * columns + k])
                .sum();
            d[i * rows + j] = dot + if i == j { diagonal } else { 0.0 };
        }
    }
    d
}

fn problem(
    n: usize,
    tangents: usize,
    compliance: Vec<f64>,
    random: &mut Random,
) -> FrictionProblem {
    FrictionProblem {
        step: 0,
        names: Vec::new(),
        candidates: (0..n)
            .map(|_| candidate(RIGID, random.between(-1.5, 0.5)))
            .collect(),
        friction: (0..n)
            .map(|_| Tangential {
                mu: random.between(0.1, 1.0),
                free: [
                    random.next(),
                    if tangents == 2 { random.next() } else { 0.0 },
                ],
                ..Tangential::default()
            })
            .collect(),
        tangents,
        compliance,
        factors: [1.0, 0.0, 1.0],
    }
}

#[test]
fn statistics() {
    let mut random = Random(5);
    for tangents in [1, 2] {
        for diagonal in [1e-3, 0.1, 1.0] {
            let (mut failed, mut swept, mut passes, mut most, mut worst, mut sweeps) =
                (0, 0, 0, 0, 0.0_f64, 0);
            let mut counts = [0; 3];
            let now = std::time::Instant::now();
            for trial in 0..400 {
                let n = 1 + trial % 40;
                let rows = n * (1 + tangents);
                let d = compliance(rows, rows, diagonal, &mut random);
                let p = problem(n, tangents, d, &mut random);
                match p.solve() {
                    Ok(s) => {
                        passes += s.passes;
                        most = most.max(s.passes);
                        sweeps = sweeps.max(s.sweeps);
                        swept += usize::from(s.sweeps > 0);
                        worst = worst.max(p.defect(&s));
                        for s in &s.slips {
                            counts[*s as usize] += 1;
                        }
                    }
                    Err(e) => {
                        failed += 1;
                        if failed < 4 {
                            println!("n {n}: {e}");
                        }
                    }
                }
            }
            println!(
                "tangents {tangents} diag {diagonal}: failed {failed} swept {swept} (most {sweeps}) mean passes {} most {most} worst {worst:e} {counts:?} {:?}",
                passes as f64 / 400.0,
                now.elapsed()
            );
        }
    }
}

fn multi(h: &[f64], rows: usize, dofs: usize, m: &[f64]) -> Vec<f64> {
    let mut d = vec![0.0; rows * rows];
    for i in 0..rows {
        for j in 0..rows {
            d[i * rows + j] = (0..dofs)
                .map(|k| h[i * dofs + k] * h[j * dofs + k] / m[k])
                .sum();
        }
    }
    d
}

fn report(name: &str, problems: impl Iterator<Item = FrictionProblem>) {
    let (mut failed, mut swept, mut passes, mut most, mut worst, mut sweeps, mut total) =
        (0, 0, 0, 0, 0.0_f64, 0, 0);
    let mut counts = [0; 3];
    let mut time = std::time::Duration::ZERO;
    for p in problems {
        total += 1;
        let now = std::time::Instant::now();
        let r = p.solve();
        time += now.elapsed();
        match r {
            Ok(s) => {
                passes += s.passes;
                most = most.max(s.passes);
                sweeps = sweeps.max(s.sweeps);
                swept += usize::from(s.sweeps > 0);
                worst = worst.max(p.defect(&s));
                for s in &s.slips {
                    counts[*s as usize] += 1;
                }
            }
            Err(e) => {
                failed += 1;
                if failed < 4 {
                    println!("n {}: {e}", p.candidates.len());
                }
            }
        }
    }
    println!(
        "{name}: of {total} failed {failed} swept {swept} (most {sweeps}) mean passes {} most {most} worst {worst:e} {counts:?} {time:?}",
        passes as f64 / total as f64
    );
}

#[test]
fn statistics_hard() {
    let mut random = Random(9);
    for tangents in [1, 2] {
        for mu in [0.3, 1.0, 2.0] {
            for kind in 0..3 {
                let mut r = random;
                let ps = (0..50).map(|trial| {
                    let n = 1 + 3 * trial % 40;
                    let rows = n * (1 + tangents);
                    let dofs = match kind {
                        0 => rows / 2 + 1,
                        1 => 6,
                        2 => rows,
                        _ => rows * 2,
                    };
                    let mut h = r.vector(rows * dofs);
                    if kind == 3 {
                        // sparse: neighbours
                        for i in 0..rows {
                            for k in 0..dofs {
                                if (2 * i).abs_diff(k) > 6 {
                                    h[i * dofs + k] = 0.0;
                                }
                            }
                        }
                    }
                    let m: Vec<f64> = (0..dofs).map(|_| (10.0_f64).powf(2.0 * r.next())).collect();
                    let u = r.vector(dofs);
                    let d = multi(&h, rows, dofs, &m);
                    let mut p = problem(n, tangents, d, &mut r);
                    for i in 0..n {
                        let q = |k: usize| {
                            (0..dofs)
                                .map(|j| h[(i * (1 + tangents) + k) * dofs + j] * u[j])
                                .sum::<f64>()
                        };
                        p.candidates[i].local.gap_free = q(0)
                            + if trial % 2 == 0 {
                                0.0
                            } else {
                                r.between(0.0, 0.5)
                            };
                        p.friction[i].free = [q(1), if tangents == 2 { q(2) } else { 0.0 }];
                        p.friction[i].mu = mu * r.between(0.5, 1.0);
                    }
                    p
                });
                report(&format!("tangents {tangents} mu {mu} kind {kind}"), ps);
                random.next();
            }
        }
    }
}
