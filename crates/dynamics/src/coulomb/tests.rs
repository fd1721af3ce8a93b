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

fn problem(n: usize, tangents: usize, compliance: Vec<f64>, random: &mut Random) -> FrictionProblem {
    FrictionProblem {
        step: 0,
        names: Vec::new(),
        candidates: (0..n).map(|_| candidate(RIGID, random.between(-1.5, 0.5))).collect(),
        friction: (0..n)
            .map(|_| Tangential {
                mu: random.between(0.1, 1.0),
                free: [random.next(), if tangents == 2 { random.next() } else { 0.0 }],
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
            let (mut failed, mut swept, mut passes, mut most, mut worst, mut sweeps) = (0, 0, 0, 0, 0.0_f64, 0);
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
                        for s in &s.slips { counts[*s as usize] += 1; }
                    }
                    Err(e) => { failed += 1; if failed < 4 { println!("n {n}: {e}"); } }
                }
            }
            println!("tangents {tangents} diag {diagonal}: failed {failed} swept {swept} (most {sweeps}) mean passes {} most {most} worst {worst:e} {counts:?} {:?}", passes as f64 / 400.0, now.elapsed());
        }
    }
}
