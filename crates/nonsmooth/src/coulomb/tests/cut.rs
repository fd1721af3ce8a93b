//! Tension that laws cut off.

use super::*;

/// Laws with dampers in points of which some are pressed in while they open: those pull.
fn opening(n: usize, tangents: usize, random: &mut Random) -> FrictionProblem {
    let rows = n * (1 + tangents);
    let d = compliance(rows, rows, 1.0, random);
    let mut problem = problem(n, tangents, d, random);
    for candidate in &mut problem.candidates {
        candidate.law = Law::Damped(Damped {
            stiffness: 2.0,
            damping: 0.5,
            adhesion: Adhesion::Clip,
        });
        candidate.status = Status::Closed;
        candidate.rate_free = random.between(-1.0, 6.0);
    }
    problem.factors = [0.5, 1.0, 1.0];
    problem
}

/// Whether the law of a point asks for a force that presses where it has none: R(g₊, ġ₊) < 0. `rows`: D p along the normal.
fn presses(problem: &FrictionProblem, i: usize, product: f64) -> bool {
    let candidate = &problem.candidates[i];
    let gap = candidate.local.gap_free + problem.factors[0] * product;
    let rate = candidate.rate_free + problem.factors[1] * product;
    gap < 0.0 && 2.0 * gap + 0.5 * rate < -1e-9
}

/// A point that would pull has no force, along no direction; the others obey their laws and Coulomb's as if it were not there, and it does not press.
#[test]
fn points_that_would_pull_act_on_no_other() {
    let (mut random, mut cut) = (Random(23), 0);
    for trial in 0..200 {
        let (n, tangents) = (2 + trial % 12, 1 + trial % 2);
        let mut problem = opening(n, tangents, &mut random);
        if trial % 3 == 0 {
            problem.friction.iter_mut().for_each(|point| point.mu = 0.0);
        }
        let solution = problem.solve().unwrap();
        let width = 1 + tangents;
        let is_cut =
            |i: &usize| solution.statuses[*i] == Status::Closed && solution.forces[*i] == 0.0;
        let kept: Vec<usize> = (0..n).filter(|i| !is_cut(i)).collect();
        let rows = || {
            let of = |&i: &usize| i * width..(i + 1) * width;
            kept.iter().flat_map(of)
        };
        let entry = |row: usize, column: usize| problem.compliance[row * n * width + column];
        let mut forces = vec![0.0; n * width];
        for i in 0..n {
            let t = &solution.tangential[i][..tangents];
            forces[i * width] = solution.forces[i];
            forces[i * width + 1..(i + 1) * width].copy_from_slice(t);
            assert!(solution.forces[i] >= 0.0, "{trial}: {}", solution.forces[i]);
        }
        for i in (0..n).filter(is_cut) {
            cut += 1;
            assert_eq!(solution.tangential[i], [0.0; 2]);
            let along = |(column, p): (usize, &f64)| entry(i * width, column) * p;
            let product = forces.iter().enumerate().map(along).sum();
            assert!(!presses(&problem, i, product), "{trial}: {i}");
        }
        let of = |list: &[f64]| kept.iter().map(|&i| list[i]).collect::<Vec<_>>();
        let own = FrictionProblem {
            candidates: kept.iter().map(|&i| problem.candidates[i]).collect(),
            friction: kept.iter().map(|&i| problem.friction[i]).collect(),
            compliance: rows()
                .flat_map(|row| rows().map(move |column| entry(row, column)))
                .collect(),
            ..problem.clone()
        };
        let found = FrictionSolution {
            forces: of(&solution.forces),
            tangential: kept.iter().map(|&i| solution.tangential[i]).collect(),
            statuses: kept.iter().map(|&i| solution.statuses[i]).collect(),
            slips: kept.iter().map(|&i| solution.slips[i]).collect(),
            ..solution.clone()
        };
        // solved to 1e-12 in each equation; the map sums up to three of them
        let defect = own.defect(&found);
        assert!(defect < 1e-11, "{trial}: {defect:e}");
    }
    assert!(cut > 100, "{cut} points pull");
}
