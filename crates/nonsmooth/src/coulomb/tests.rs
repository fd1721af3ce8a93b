use carom_laws::{Adhesion, Damped, Displacement, Law, Local, Status};
use carom_testing::Random;

use super::*;
use crate::interface::{Candidate, Interface};
use crate::{Compliance, Lumped, Unknown};
mod cut;
mod of_laws;
mod together;

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
        faces_itself: false,
        instant: [1.0; 2],
    }
}

const RIGID: Law = Law::Displacement(Displacement { projection: false });

fn soft() -> Law {
    Law::Damped(Damped {
        stiffness: 2.0,
        damping: 0.0,
        adhesion: Adhesion::Clip,
    })
}

/// D = B Bᵀ + `diagonal` I of random B with `columns` columns.
fn compliance(rows: usize, columns: usize, diagonal: f64, random: &mut Random) -> Vec<f64> {
    let b = random.vector(rows * columns);
    let mut d = vec![0.0; rows * rows];
    for i in 0..rows {
        for j in 0..rows {
            let (a, b) = (&b[i * columns..], &b[j * columns..]);
            let dot: f64 = a.iter().zip(b).take(columns).map(|(a, b)| a * b).sum();
            d[i * rows + j] = dot + if i == j { diagonal } else { 0.0 };
        }
    }
    d
}

fn problem(n: usize, tangents: usize, d: Vec<f64>, random: &mut Random) -> FrictionProblem {
    let second = |random: &mut Random| match tangents {
        2 => random.next(),
        _ => 0.0,
    };
    FrictionProblem {
        step: 0,
        names: Vec::new(),
        candidates: (0..n)
            .map(|_| candidate(RIGID, random.between(-1.5, 0.5)))
            .collect(),
        friction: (0..n)
            .map(|_| Tangential {
                mu: random.between(0.1, 1.0),
                free: [random.next(), second(random)],
                ..Tangential::default()
            })
            .collect(),
        tangents,
        compliance: d,
        factors: [1.0, 0.0, 1.0],
        tolerance: 0.0,
    }
}

fn random_problem(n: usize, tangents: usize, random: &mut Random) -> FrictionProblem {
    let rows = n * (1 + tangents);
    let d = compliance(rows, rows, 1e-3, random);
    problem(n, tangents, d, random)
}

/// One point on a body of unit mobility, with the coupling `c` of the normal and the first tangent.
fn single(mu: f64, gap_free: f64, free: [f64; 2], tangents: usize, c: f64) -> FrictionProblem {
    let d = match tangents {
        1 => vec![1.0, c, c, 1.0],
        _ => vec![1.0, c, 0.0, c, 1.0, 0.0, 0.0, 0.0, 1.0],
    };
    FrictionProblem {
        step: 0,
        names: Vec::new(),
        candidates: vec![candidate(RIGID, gap_free)],
        friction: vec![Tangential {
            mu,
            free,
            ..Tangential::default()
        }],
        tangents,
        compliance: d,
        factors: [1.0, 0.0, 1.0],
        tolerance: 0.0,
    }
}

/// q of all candidates.
fn sliding(problem: &FrictionProblem, solution: &FrictionSolution) -> Vec<[f64; 2]> {
    let width = 1 + problem.tangents;
    let mut p = Vec::new();
    for (force, t) in solution.forces.iter().zip(&solution.tangential) {
        p.push(*force);
        p.extend(&t[..problem.tangents]);
    }
    let row = |row: usize| {
        let d = &problem.compliance[row * p.len()..(row + 1) * p.len()];
        d.iter().zip(&p).map(|(d, p)| d * p).sum::<f64>()
    };
    let mut all = Vec::new();
    for (i, point) in problem.friction.iter().enumerate() {
        let mut q = point.free;
        for k in 0..problem.tangents {
            q[k] += problem.factors[2] * row(i * width + 1 + k);
        }
        all.push(q);
    }
    all
}

#[test]
fn random_problems_are_solved_and_slip_opposes_sliding() {
    let mut random = Random(5);
    let (mut counts, mut passes, trials) = ([0; 3], 0, 300);
    for trial in 0..trials {
        let problem = random_problem(1 + trial % 40, 1 + trial % 2, &mut random);
        let solution = problem.solve().unwrap();
        passes += solution.passes;
        // solved to 1e-12 in each equation; the map sums up to three of them
        assert!(problem.defect(&solution) < 1e-11);
        for (i, q) in sliding(&problem, &solution).into_iter().enumerate() {
            let (t, force) = (solution.tangential[i], solution.forces[i]);
            let (power, size) = (t[0] * q[0] + t[1] * q[1], q[0].hypot(q[1]));
            let bound = problem.friction[i].mu * force;
            let forces = solution.forces.iter().fold(1.0, |m: f64, p| m.max(*p));
            assert!(force > -1e-10 * forces && t[0].hypot(t[1]) < bound + 1e-9 * forces);
            // the dissipation of slip is μ P |q|, that of stick none
            assert!((power + bound * size).abs() < 1e-8 * forces * forces);
            counts[solution.slips[i] as usize] += 1;
        }
    }
    // all statuses occur, and a solve is a handful of passes
    assert!(counts.iter().all(|count| *count > 500), "{counts:?}");
    assert!(passes < 8 * trials, "{passes}");
}

#[test]
fn without_friction_the_forces_are_those_of_the_interface_problem() {
    let mut random = Random(3);
    for trial in 0..100 {
        let (n, tangents) = (1 + trial % 20, 1 + trial % 2);
        let width = 1 + tangents;
        let rows = n * width;
        let d = compliance(rows, rows, 1.0, &mut random);
        let mut problem = problem(n, tangents, d, &mut random);
        for (i, point) in problem.friction.iter_mut().enumerate() {
            point.mu = 0.0;
            if i % 3 == 1 {
                problem.candidates[i].law = soft();
            }
        }
        problem.factors = [0.5, 1.0, 1.0];
        let solution = problem.solve().unwrap();
        let normal: Vec<f64> = (0..n * n)
            .map(|k| problem.compliance[(k / n * rows + k % n) * width])
            .collect();
        let mut interface = Interface::default();
        interface
            .solve(
                &problem.candidates,
                (Compliance::Dense(&normal), 0),
                [0.5, 1.0],
            )
            .unwrap();
        assert_eq!(solution.statuses, interface.statuses);
        let size = interface.forces.iter().fold(1.0, |m: f64, p| m.max(*p));
        for (p, expected) in solution.forces.iter().zip(&interface.forces) {
            assert!((p - expected).abs() < 1e-12 * size);
        }
        assert!(solution.tangential.iter().all(|t| *t == [0.0; 2]));
    }
}

#[test]
fn a_mass_on_a_plane_sticks_below_its_bound_and_slips_above() {
    // P = 2; without friction the pull would move the mass by q_f, sticking takes t = -q_f
    for (pull, expected, slip) in [(0.5, -0.5, Slip::Stick), (-0.7, 0.6, Slip::Slip)] {
        let solution = single(0.3, -2.0, [pull, 0.0], 1, 0.0).solve().unwrap();
        assert!((solution.forces[0] - 2.0).abs() < 1e-14);
        assert!((solution.tangential[0][0] - expected).abs() < 1e-14);
        assert_eq!(solution.slips, [slip]);
    }
    // in space: against the pull, not along an axis
    let solution = single(0.3, -2.0, [3.0, -4.0], 2, 0.0).solve().unwrap();
    let t = solution.tangential[0];
    assert!((t[0] + 0.36).abs() < 1e-12 && (t[1] - 0.48).abs() < 1e-12);
}

#[test]
fn sliding_changes_the_normal_force_through_the_coupling() {
    // P + c t = 1, q = q_f + c P + t, slip to the positive side: t = -μ P, so P = 1/(1 - μ c)
    for (mu, c) in [(0.4, 0.5), (0.4, -0.5), (1.0, 0.8)] {
        let solution = single(mu, -1.0, [9.0, 0.0], 1, c).solve().unwrap();
        let expected = 1.0 / (1.0 - mu * c);
        assert!((solution.forces[0] - expected).abs() < 1e-13 * expected);
        assert_eq!(solution.slips, [Slip::Slip]);
    }
}

#[test]
fn the_walls_of_a_wedge_take_the_push_whatever_the_friction() {
    // A unit mass between two walls that close by the angle 2 a downwards, pushed down by the impulse 1. The four rows act
    // on two freedoms, so that with friction the split of the forces is not unique; their sum is.
    let a = 0.2_f64;
    let (sin, cos) = a.sin_cos();
    let rows = [[cos, sin], [sin, -cos], [-cos, sin], [-sin, -cos]];
    let d: Vec<f64> = rows
        .iter()
        .flat_map(|x| rows.map(|y| x[0] * y[0] + x[1] * y[1]))
        .collect();
    for mu in [0.0, 0.1, 0.5] {
        let mut problem = single(mu, 0.0, [0.0; 2], 1, 0.0);
        problem.compliance = d.clone();
        problem.candidates = vec![candidate(RIGID, -sin); 2];
        problem.friction = vec![
            Tangential {
                mu,
                free: [cos, 0.0],
                ..Tangential::default()
            };
            2
        ];
        let solution = problem.solve().unwrap();
        assert!(problem.defect(&solution) < 1e-11);
        // balance of the mass: the walls take the push
        let push: f64 = (0..2)
            .map(|i| sin * solution.forces[i] - cos * solution.tangential[i][0])
            .sum();
        assert!((push - 1.0).abs() < 1e-10, "{push}");
        if mu == 0.0 {
            assert!((solution.forces[0] - 0.5 / sin).abs() < 1e-9);
        }
    }
}

#[test]
fn the_cone_is_round_forces_do_not_depend_on_the_tangential_basis() {
    let mut random = Random(8);
    for n in [1, 5, 20] {
        let rows = 3 * n;
        // large enough a diagonal for the solution to be unique
        let d = compliance(rows, rows, 30.0, &mut random);
        let plain = problem(n, 2, d, &mut random);
        let mut turned = plain.clone();
        let angles: Vec<(f64, f64)> = (0..n).map(|_| (3.0 * random.next()).sin_cos()).collect();
        let turn = |x: [f64; 2], (sin, cos): (f64, f64)| {
            [cos * x[0] + sin * x[1], -sin * x[0] + cos * x[1]]
        };
        let d = &mut turned.compliance;
        for i in 0..n {
            let (first, second) = (3 * i + 1, 3 * i + 2);
            for j in 0..rows {
                let x = [d[first * rows + j], d[second * rows + j]];
                [d[first * rows + j], d[second * rows + j]] = turn(x, angles[i]);
            }
            for j in 0..rows {
                let x = [d[j * rows + first], d[j * rows + second]];
                [d[j * rows + first], d[j * rows + second]] = turn(x, angles[i]);
            }
            turned.friction[i].free = turn(plain.friction[i].free, angles[i]);
        }
        let (one, other) = (plain.solve().unwrap(), turned.solve().unwrap());
        for i in 0..n {
            let expected = turn(one.tangential[i], angles[i]);
            assert!((one.forces[i] - other.forces[i]).abs() < 1e-11);
            for k in 0..2 {
                assert!((other.tangential[i][k] - expected[k]).abs() < 1e-11);
            }
        }
    }
}

#[test]
fn points_that_repeat_each_other_share_the_force_of_one() {
    let mut random = Random(4);
    for trial in 0..40 {
        let (n, tangents) = (1 + trial % 10, 1 + trial % 2);
        let width = 1 + tangents;
        let rows = n * width;
        let d = compliance(rows, rows, 30.0, &mut random);
        let once = problem(n, tangents, d, &mut random);
        let mut twice = once.clone();
        twice.candidates.extend(once.candidates.clone());
        twice.friction.extend(once.friction.clone());
        twice.compliance = (0..4 * rows * rows)
            .map(|k| once.compliance[k / (2 * rows) % rows * rows + k % rows])
            .collect();
        let (one, two) = (once.solve().unwrap(), twice.solve().unwrap());
        assert!(twice.defect(&two) < 1e-11);
        for i in 0..n {
            // the shift leaves the factor 1e-11 beside the pivots, which rounding fills to 1e-16/1e-11 at most
            assert!((one.forces[i] - two.forces[i] - two.forces[i + n]).abs() < 1e-9);
            for k in 0..tangents {
                let sum = two.tangential[i][k] + two.tangential[i + n][k];
                assert!((one.tangential[i][k] - sum).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn points_on_a_body_with_six_freedoms_are_solved_though_their_forces_are_not_unique() {
    let mut random = Random(11);
    for trial in 0..60 {
        let (n, tangents) = (4 + trial % 5, 1 + trial % 2);
        let rows = n * (1 + tangents);
        // q = H u of a motion u, so that the motion that undoes it is admissible
        let (h, u) = (random.vector(rows * 6), random.vector(6));
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let d = (0..rows * rows)
            .map(|k| dot(&h[k / rows * 6..][..6], &h[k % rows * 6..][..6]))
            .collect();
        let mut problem = problem(n, tangents, d, &mut random);
        for i in 0..n {
            let q = |k: usize| dot(&h[(i * (1 + tangents) + k) * 6..][..6], &u);
            problem.candidates[i].local.gap_free = q(0) + random.between(0.0, 0.5);
            problem.friction[i].mu = 0.3;
            problem.friction[i].free = [q(1), if tangents == 2 { q(2) } else { 0.0 }];
        }
        let solution = problem.solve().unwrap();
        assert!(problem.defect(&solution) < 1e-11);
    }
}

#[test]
fn a_solved_problem_starts_the_next_one_near_its_end() {
    let mut random = Random(6);
    let (mut cold, mut warm) = (0, 0);
    for _ in 0..40 {
        let mut problem = random_problem(20, 2, &mut random);
        let first = problem.solve().unwrap();
        for i in 0..20 {
            problem.candidates[i].status = first.statuses[i];
            problem.friction[i].slip = first.slips[i];
            problem.friction[i].force = first.tangential[i];
        }
        let second = problem.solve().unwrap();
        assert!(problem.defect(&second) < 1e-11);
        (cold, warm) = (cold + first.passes, warm + second.passes);
    }
    assert!(warm <= 3 * 40 && warm < cold / 2, "{warm} {cold}");
}

#[test]
fn the_measure_of_the_error_sees_each_violation() {
    let problem = single(0.3, -2.0, [0.5, 0.0], 1, 0.0);
    let right = problem.solve().unwrap();
    let defect = |change: &dyn Fn(&mut FrictionSolution)| {
        let mut wrong = right.clone();
        change(&mut wrong);
        problem.defect(&wrong)
    };
    assert!(defect(&|_| ()) < 1e-15); // two terms, each rounded once
    assert!(defect(&|s| s.forces[0] = 2.1) > 0.01);
    assert!(defect(&|s| s.statuses[0] = Status::Open) > 0.1);
    assert!(defect(&|s| s.tangential[0][0] = -0.4) > 0.01);
    assert!(defect(&|s| s.tangential[0][0] = f64::NAN).is_nan());
}

/// Points of which every second one is on a plane of symmetry: a support holds them across it, but for the part `leak` that
/// rounding of places leaves. Their normals are not quite in the plane.
fn on_a_plane_of_symmetry(n: usize, leak: f64, random: &mut Random) -> FrictionProblem {
    let rows = 3 * n;
    let of_places = compliance(rows, rows, 3.0, random);
    let held = |row: usize| match row % 6 {
        1 => leak,
        _ => 1.0,
    };
    let frames: Vec<[[f64; 3]; 3]> = (0..n).map(|_| frame(random)).collect();
    let mut problem = problem(n, 2, vec![0.0; rows * rows], random);
    for row in 0..rows {
        for column in 0..rows {
            let (a, b) = (&frames[row / 3][row % 3], &frames[column / 3][column % 3]);
            for k in 0..9 {
                let (i, j) = (row / 3 * 3 + k / 3, column / 3 * 3 + k % 3);
                problem.compliance[row * rows + column] +=
                    a[k / 3] * b[k % 3] * of_places[i * rows + j] * held(i) * held(j);
            }
        }
    }
    for (i, frame) in frames.iter().enumerate() {
        let free = [random.next(), random.next() * held(3 * i + 1), -3.0];
        let q = frame.map(|e| (0..3).map(|k| e[k] * free[k]).sum::<f64>());
        problem.candidates[i].local.gap_free = q[0];
        problem.friction[i].free = [q[1], q[2]];
    }
    problem
}

/// Normal near the third axis, and two tangents.
fn frame(random: &mut Random) -> [[f64; 3]; 3] {
    let (a, b, c) = (0.05 * random.next(), 0.01 * random.next(), random.next());
    let ((sa, ca), (sb, cb), (sc, cc)) = (a.sin_cos(), b.sin_cos(), c.sin_cos());
    let normal = [sa * cb, sb, ca * cb];
    let (first, second) = ([ca, 0.0, -sa], [-sa * sb, cb, -ca * sb]);
    let turned = |x: f64, y: f64| [0, 1, 2].map(|k| x * first[k] + y * second[k]);
    [normal, turned(cc, sc), turned(-sc, cc)]
}

#[test]
fn what_a_support_takes_across_a_plane_of_symmetry_does_not_keep_friction_from_its_solution() {
    let mut random = Random(12);
    for trial in 0..60 {
        let leak = [0.0, 1e-6, 5e-6][trial % 3];
        let problem = on_a_plane_of_symmetry(2 + trial % 30, leak, &mut random);
        let solution = problem.solve().unwrap();
        assert!(solution.passes <= 30 && solution.sweeps == 0, "{trial}");
        // what is left is the sliding across the plane: the leak, times the sum of some ten motions of about one
        assert!(problem.defect(&solution) < 1e-11 + 100.0 * leak);
        for (i, frame) in solution.tangential.iter().enumerate().step_by(2) {
            assert!(
                frame[0].hypot(frame[1])
                    <= problem.friction[i].mu * solution.forces[i] * (1.0 + 1e-9)
            );
        }
    }
}

#[test]
fn forces_within_the_tolerance_that_was_asked_for_are_taken_where_no_nearer_ones_are() {
    // Beside a mass with a force of 2 N lies a candidate whose mobility has the wrong sign: 0 <= -1e-11 - 1e-3 P with P >= 0
    // has no solution. With no force 1e-11 is missing, which is 5e-12 of the largest force.
    let mut problem = single(0.3, -2.0, [0.5, 0.0], 1, 0.0);
    let alone = problem.solve().unwrap();
    problem.candidates.push(candidate(RIGID, -1e-11));
    problem.friction.push(Tangential {
        mu: 0.3,
        ..Tangential::default()
    });
    problem.compliance = vec![
        1.0, 0.0, 0.0, 0.0, //
        0.0, 1.0, 0.0, 0.0, //
        0.0, 0.0, -1e-3, 0.0, //
        0.0, 0.0, 0.0, 1.0,
    ];
    problem.tolerance = 1e-9;
    let taken = problem.solve().unwrap();
    assert!((taken.forces[0] - alone.forces[0]).abs() <= 1e-9 * alone.forces[0]);
    assert_eq!(taken.tangential[0], alone.tangential[0]);
    // Asked for more, there is none, and the error names the candidate.
    problem.tolerance = 1e-12;
    assert_eq!(problem.solve().unwrap_err().candidate, 1);
}

/// A disc of radius 1 and mass 1 in a corner: contacts at its sides, with the motions x and y of its centre and its turn. The
/// four rows are dependent: n₁ + n₂ = t₁ + t₂.
fn disc_in_a_corner(mu: f64, free: [f64; 3], offsets: [f64; 2]) -> FrictionProblem {
    let rows = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, -1.0],
        [0.0, 1.0, 0.0],
        [1.0, 0.0, 1.0],
    ];
    let inverse_mass = [1.0, 1.0, 2.0];
    let dot =
        |a: &[f64; 3], b: &[f64; 3]| -> f64 { (0..3).map(|k| a[k] * inverse_mass[k] * b[k]).sum() };
    let along = |row: &[f64; 3]| -> f64 { (0..3).map(|k| row[k] * free[k]).sum() };
    let entries = rows
        .iter()
        .flat_map(|a| rows.iter().map(move |b| dot(a, b)));
    let contact = |k: usize| {
        let mut candidate = candidate(RIGID, along(&rows[2 * k]) + offsets[k]);
        candidate.status = Status::Closed;
        candidate
    };
    let sliding = |k: usize| Tangential {
        mu,
        free: [along(&rows[2 * k + 1]), 0.0],
        slip: Slip::Stick,
        force: [0.0; 2],
        pressed: 0.0,
        sliding: None,
    };
    FrictionProblem {
        step: 0,
        names: Vec::new(),
        candidates: (0..2).map(contact).collect(),
        friction: (0..2).map(sliding).collect(),
        tangents: 1,
        compliance: entries.collect(),
        factors: [1.0, 1.0, 1.0],
        tolerance: 1e-12,
    }
}

/// Both points stick without an offset. With one, as of points that rebound, the equations of both contradict each other by that
/// offset, however small; a solution exists all the same, with one point at its bound. Sweeps move the forces that D does not see
/// by the offset each time, and Newton passes by the offset over their shift.
#[test]
fn points_whose_stick_is_contradictory_are_solved_by_the_slip_of_one() {
    let mut random = Random(11);
    let (mut stuck, mut passes) = (0, 0);
    for trial in 0..200 {
        let push = [
            random.between(-2.0, -0.5),
            random.between(-2.0, -0.5),
            random.between(-0.2, 0.2),
        ];
        let mu = random.between(0.2, 1.0);
        let level = disc_in_a_corner(mu, push, [0.0; 2]).solve().unwrap();
        let both = level.slips == [Slip::Stick; 2];
        stuck += usize::from(both);
        for offset in [1e-10, 1e-7, 1e-3] {
            let problem = disc_in_a_corner(mu, push, [offset, 0.0]);
            let solution = problem.solve().unwrap();
            assert!(problem.defect(&solution) < 1e-11, "{trial} {offset}");
            assert!(solution.slips != [Slip::Stick; 2], "{trial} {offset}");
            passes += solution.passes;
        }
    }
    assert!(stuck > 50, "{stuck}");
    assert!(passes < 30 * 600, "{passes}");
}

/// Two rows of `n` nodes of mass one, shifted by part of a cell, all nodes of both being points before the segments of the other: every
/// contact is told twice.
fn two_rows(n: usize, shift: f64) -> Lumped {
    let mut d = Lumped::default();
    d.clear(3);
    let alike = |unknown: u32| Unknown {
        first: unknown - unknown % 3,
        inverse: 1.0,
    };
    for (own, sign) in [(0, 1.0), (1, -1.0)] {
        for i in 0..n {
            let place = (i as f64 + sign * shift).clamp(0.0, (n - 1) as f64);
            let first = (place as usize).min(n - 2);
            let (share, other) = (place - first as f64, (1 - own) * n + first);
            let nodes = [own * n + i, other, other + 1];
            // the normal is the third axis, and that of the other side is turned
            let rows = [2, 0, 1].map(|axis| nodes.map(|node| (3 * node + axis) as u32));
            let entries = [1.0, share - 1.0, -share].map(|c| sign * c);
            d.push(rows.iter().map(|row| (&row[..], &entries[..])), alike);
        }
    }
    d.finish();
    d
}

/// Plain sweeps hardly damp what both sides cancel; of an error that they damp by 1 - ε, mixing needs some 1/√ε sweeps.
#[test]
fn contacts_told_from_both_sides_are_solved_in_few_sweeps() {
    let mut random = Random(13);
    for n in [20, 80] {
        let d = two_rows(n, 0.3);
        let mut entries = Vec::new();
        d.dense(&mut entries);
        let mut problem = problem(2 * n, 2, entries, &mut random);
        for candidate in &mut problem.candidates {
            candidate.local.gap_free = random.between(-2.0, -1.0);
        }
        let mut coulomb = Coulomb::default();
        let posed = Posed {
            d: Compliance::Lumped(&d),
            ..problem.posed()
        };
        coulomb.solve(&posed).unwrap();
        // plain sweeps take some 450
        assert!(
            coulomb.passes == 0 && coulomb.sweeps < 150,
            "{n}: {}",
            coulomb.sweeps
        );
        let solution = FrictionSolution {
            forces: coulomb.forces,
            tangential: coulomb.tangential,
            statuses: coulomb.statuses,
            slips: coulomb.slips,
            passes: coulomb.passes,
            sweeps: coulomb.sweeps,
        };
        // solved to 1e-12 in each equation; the map sums up to three of them
        assert!(problem.defect(&solution) < 1e-11);
    }
}
