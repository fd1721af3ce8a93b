//! What holds at all times for any bars: conservation, Signorini's conditions, continuity, the wave equation.

#![allow(
    clippy::unwrap_used,
    reason = "clippy sees only #[test] functions as tests"
)]

use carom_exact::{Bar, Error, FarEnd, Impact, Solution, solve};
use carom_testing::Random;

fn bar(random: &mut Random) -> Bar {
    let bar = Bar::new(
        random.between(0.3, 3.0),
        random.between(0.2, 2.0),
        random.between(0.3, 3.0),
        random.between(0.3, 3.0),
    );
    Bar {
        strain: random.between(-0.1, 0.1),
        velocity: random.between(-1.0, 0.3),
        ..bar
    }
}

fn time(random: &mut Random, solution: &Solution) -> f64 {
    random.between(0.0, solution.end_time())
}

/// Fifty pairs of unequal bars and fifty bars on a wall, ends free or clamped, with gravity or not.
fn random_solutions() -> Vec<(Solution, Random)> {
    let mut random = Random(2003);
    let solutions = (0..100).map(|i| {
        let far_end = |clamped: bool| {
            if clamped {
                FarEnd::Clamped
            } else {
                FarEnd::Free
            }
        };
        let g = if i % 5 == 0 { 0.2 } else { 0.0 };
        let secondary = Bar {
            far_end: far_end(i % 7 == 0),
            ..bar(&mut random)
        }
        .with_gravity(g);
        let primary = Bar {
            far_end: far_end(i % 3 == 0),
            ..bar(&mut random)
        }
        .with_gravity(-g);
        let gap = random.between(0.0, 0.5);
        let impact = match i % 2 {
            0 => Impact::Wall {
                bar: secondary,
                gap,
            },
            _ => Impact::TwoBars {
                secondary,
                primary,
                gap,
            },
        };
        (solve(&impact, 30.0).unwrap(), Random(i))
    });
    solutions.collect()
}

#[test]
fn energy_is_conserved() {
    for (solution, mut random) in random_solutions() {
        let scale = solution.kinetic_energy(0.0) + solution.strain_energy(0.0);
        for _ in 0..20 {
            let t = time(&mut random, &solution);
            let drift = solution.energy(t) - solution.energy(0.0);
            assert!(
                drift.abs() < 1e-10 * scale.max(1.0),
                "{drift} of {scale} at {t}"
            );
        }
    }
}

#[test]
fn momentum_changes_by_the_impulses_at_the_ends_and_the_weight() {
    for (solution, mut random) in random_solutions() {
        for _ in 0..20 {
            let t = time(&mut random, &solution);
            for motion in solution.motions() {
                let bar = motion.bar();
                let ends = motion.impulse(0.0, t) - motion.impulse(bar.length, t);
                let expected = bar.mass() * (bar.velocity + bar.acceleration * t) + ends;
                assert!((motion.momentum(t) - expected).abs() < 1e-11 * bar.mass().max(1.0));
                assert!((motion.impulse(0.0, t) - solution.impulse(t)).abs() < 1e-11);
                if bar.far_end == FarEnd::Free {
                    assert!(motion.impulse(bar.length, t).abs() < 1e-11);
                } else {
                    assert!(motion.velocity(bar.length, t).abs() < 1e-12);
                }
            }
        }
    }
}

#[test]
fn momentum_of_two_free_bars_is_constant() {
    let mut random = Random(7);
    for _ in 0..50 {
        let impact = Impact::TwoBars {
            secondary: bar(&mut random),
            primary: bar(&mut random),
            gap: 0.1,
        };
        let solution = solve(&impact, 20.0).unwrap();
        let t = time(&mut random, &solution);
        assert!((solution.momentum(t) - solution.momentum(0.0)).abs() < 1e-12);
    }
}

#[test]
fn no_penetration_no_tension_and_no_force_across_a_gap() {
    for (solution, mut random) in random_solutions() {
        let force_of_ends = |t: f64| {
            solution
                .motions()
                .iter()
                .map(|m| m.force(0.0, t))
                .collect::<Vec<_>>()
        };
        let opening = |t: f64| {
            solution
                .motions()
                .iter()
                .map(|m| m.velocity(0.0, t))
                .sum::<f64>()
        };
        assert!(
            solution
                .force()
                .polyline()
                .iter()
                .all(|&(_, force)| force >= -1e-12)
        );
        for _ in 0..100 {
            let t = time(&mut random, &solution);
            let (gap, force) = (solution.gap(t), solution.force().value(t));
            assert!(
                gap > -1e-11 && force * gap.abs() < 1e-11,
                "gap {gap}, force {force} at {t}"
            );
            assert!(force_of_ends(t).iter().all(|f| (f - force).abs() < 1e-11));
            assert!((opening(t) - solution.gap_rate().value(t)).abs() < 1e-11);
            let closed = solution
                .contacts()
                .iter()
                .any(|c| c.start <= t && t < c.end);
            assert!(closed || force == 0.0);
        }
    }
}

#[test]
fn the_gap_is_the_distance_of_the_contact_ends() {
    for (solution, mut random) in random_solutions() {
        for _ in 0..20 {
            let t = time(&mut random, &solution);
            let primary = if solution.motions().len() == 2 {
                solution.position(1, 0.0, t)
            } else {
                0.0
            };
            let distance = primary - solution.position(0, 0.0, t);
            assert!((distance - solution.gap(t)).abs() < 1e-11);
        }
    }
}

#[test]
fn displacement_is_continuous_and_has_velocity_and_strain_as_derivatives() {
    for (solution, mut random) in random_solutions() {
        let motion = &solution.motions()[0];
        let length = motion.bar().length;
        for _ in 0..20 {
            let (s, t) = (random.between(0.0, length), time(&mut random, &solution));
            let d = 1e-7;
            let (fast, steep) = (10.0 + t, 10.0 + t);
            let u = |s: f64, t: f64| motion.displacement(s, t);
            assert!((u(s, t + d) - u(s, t)).abs() < fast * d);
            assert!((u(s + d, t) - u(s, t)).abs() < steep * d);
            let near_front = motion.fronts(t).iter().any(|f| (f - s).abs() < 1e-4);
            if !near_front && t > 1e-4 && s > 1e-4 {
                let velocity = (u(s, t + d) - u(s, t - d)) / (2.0 * d);
                let strain = (u(s + d, t) - u(s - d, t)) / (2.0 * d);
                assert!((velocity - motion.velocity(s, t)).abs() < 1e-6);
                assert!((strain - motion.strain(s, t)).abs() < 1e-6);
            }
        }
    }
}

#[test]
fn the_initial_state_is_the_one_asked_for() {
    for (solution, mut random) in random_solutions() {
        for motion in solution.motions() {
            let bar = motion.bar();
            let s = random.between(0.001, 0.999) * bar.length;
            assert!((motion.velocity(s, 0.0) - bar.velocity).abs() < 1e-14);
            assert!((motion.strain(s, 0.0) - bar.strain).abs() < 1e-14);
            assert!((motion.displacement(s, 0.0) - bar.strain * (s - bar.length)).abs() < 1e-14);
        }
    }
}

#[test]
fn a_solution_does_not_depend_on_how_far_it_is_continued() {
    let mut random = Random(11);
    let impact = Impact::TwoBars {
        secondary: bar(&mut random),
        primary: bar(&mut random).clamped(),
        gap: 0.2,
    };
    let (short, long) = (solve(&impact, 10.0).unwrap(), solve(&impact, 25.0).unwrap());
    for _ in 0..100 {
        let t = time(&mut random, &short);
        assert!((short.gap(t) - long.gap(t)).abs() < 1e-12);
        assert!((short.impulse(t) - long.impulse(t)).abs() < 1e-12);
    }
}

#[test]
fn wrong_values_are_named() {
    let bar = Bar::new(1.0, 1.0, 1.0, 1.0);
    let wall = |bar: Bar| solve(&Impact::Wall { bar, gap: 0.0 }, 1.0).err();
    let hollow = Bar {
        density: -1.0,
        ..bar
    };
    assert_eq!(
        wall(hollow),
        Some(Error::NotPositive {
            quantity: "density",
            value: -1.0
        })
    );
    assert!(matches!(
        wall(bar.with_velocity(f64::NAN)),
        Some(Error::NotFinite {
            quantity: "velocity",
            ..
        })
    ));
    assert_eq!(
        solve(&Impact::Wall { bar, gap: -0.1 }, 1.0).err(),
        Some(Error::Penetration { gap: -0.1 })
    );
    let message = Error::Penetration { gap: -0.1 }.to_string();
    assert_eq!(
        message,
        "the gap is -0.1 m at the start, it must be finite and not negative"
    );
}

#[test]
fn a_motion_of_too_many_pieces_is_refused() {
    let bar = Bar::new(1.0, 1.0, 1.0, 1.0).with_strain(-0.5).clamped();
    let endless = solve(&Impact::Wall { bar, gap: 0.5 }, 1e7);
    assert!(matches!(endless.err(), Some(Error::TooManyPieces { time, .. }) if time > 1e5));
}
