//! Laws of points with friction: compliant ones, and coefficients of sliding below those of sticking.

use super::*;

#[test]
fn points_stick_up_to_the_larger_coefficient_and_slide_with_the_lower_one() {
    // pressed with 2 N: it sticks up to 0.9 N, and slides with 0.4 N
    let pulled = |pull: f64| {
        let mut problem = single(0.45, -2.0, [pull, 0.0], 1, 0.0);
        problem.friction[0].sliding = Some(0.2);
        let solution = problem.solve().unwrap();
        assert!(problem.defect(&solution) < 1e-14);
        (solution.tangential[0][0], solution.slips[0])
    };
    for (pull, t, slip) in [
        (0.3, -0.3, Slip::Stick),
        (0.8, -0.8, Slip::Stick),
        (1.2, -0.4, Slip::Slip),
    ] {
        let found = pulled(pull);
        assert!((found.0 - t).abs() < 1e-14 && found.1 == slip, "{found:?}");
    }
}

#[test]
fn random_problems_with_a_lower_coefficient_of_sliding_are_solved() {
    let mut random = Random(11);
    let mut counts = [0; 3];
    for trial in 0..200 {
        let (n, tangents) = (1 + trial % 20, 1 + trial % 2);
        let mut problem = random_problem(n, tangents, &mut random);
        for point in &mut problem.friction {
            point.sliding = Some(0.6 * point.mu);
        }
        let solution = problem.solve().unwrap();
        // the natural map with the coefficient of the status of each point, and of sticking with the larger one
        assert!(problem.defect(&solution) < 1e-11);
        for (i, t) in solution.tangential.iter().enumerate() {
            let (slip, point) = (solution.slips[i], &problem.friction[i]);
            counts[slip as usize] += 1;
            let size = t[0].hypot(t[1]);
            let lower = 0.6 * point.mu * solution.forces[i].max(0.0);
            assert!(slip != Slip::Slip || size <= lower * (1.0 + 1e-9));
        }
    }
    assert!(counts.iter().all(|count| *count > 100), "{counts:?}");
}

#[test]
fn compliant_laws_take_friction() {
    // 2 g₊ + P = 0 with g₊ = -1 + 0.5 P: P = 1; slip with t = -μ P
    let mut problem = single(0.25, -1.0, [5.0, 0.0], 1, 0.0);
    problem.candidates[0].law = soft();
    problem.factors = [0.5, 1.0, 1.0];
    let solution = problem.solve().unwrap();
    assert!((solution.forces[0] - 1.0).abs() < 1e-14);
    assert!((solution.tangential[0][0] + 0.25).abs() < 1e-14);
    assert!(problem.defect(&solution) < 1e-14);
}
