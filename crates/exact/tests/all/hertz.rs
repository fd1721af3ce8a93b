//! Hertz's formulas against the equations that they solve: the half-space under a pressure, the equation of motion.

use std::f64::consts::PI;

use carom_exact::hertz::{Pair, Solid, reduced_mass};

/// Relative difference that round-off leaves in a few operations.
const ROUND_OFF: f64 = 1e-13;

fn close(value: f64, exact: f64, tolerance: f64) {
    assert!(
        (value - exact).abs() <= tolerance * exact.abs(),
        "{value} is not {exact}"
    );
}

/// Two equal balls of the public test SSNV104: R = 50 mm, E = 20 GPa, nu = 0.3.
fn balls() -> Pair {
    let ball = Solid {
        radius: 0.05,
        young: 2e10,
        poisson: 0.3,
    };
    Pair::new(ball, ball)
}

/// A steel ball and one of another size and material.
fn unequal() -> Pair {
    let steel = Solid {
        radius: 0.02,
        young: 2.1e11,
        poisson: 0.3,
    };
    let bronze = Solid {
        radius: 0.07,
        young: 1.1e11,
        poisson: 0.34,
    };
    Pair::new(steel, bronze)
}

/// ∫0^1 f by Simpson's rule on 2000 intervals.
fn integral(f: impl Fn(f64) -> f64) -> f64 {
    let h = 1.0 / 2000.0;
    let weight = |i: usize| match i {
        0 | 2000 => 1.0,
        i => 2.0 + 2.0 * (i % 2) as f64,
    };
    let sum: f64 = (0..=2000).map(|i| weight(i) * f(h * i as f64)).sum();
    sum * h / 3.0
}

#[test]
fn two_spheres_of_the_public_test() {
    // Published with five digits: half a unit of the last.
    let near = balls().spot(0.04e-3);
    close(near.force, 586.08, 1e-5);
    close(near.peak, 279.83e6, 2e-5);
    close(near.radius, 1e-3, ROUND_OFF);
    let far = balls().spot(4e-3);
    close(far.force, 586.08e3, 1e-5);
    close(far.peak, 2798.33e6, 2e-6);
    close(far.radius, 10e-3, ROUND_OFF);
}

#[test]
fn force_and_approach_are_inverse_and_nothing_presses_apart() {
    let pair = unequal();
    for approach in [1e-7, 1e-5, 1e-3] {
        let spot = pair.spot(approach);
        close(pair.spot_under(spot.force).approach, approach, ROUND_OFF);
    }
    let apart = pair.spot(-1e-6);
    assert_eq!((apart.force, apart.radius, apart.peak), (0.0, 0.0, 0.0));
}

#[test]
fn the_pressure_carries_the_force() {
    // r = a sin t, and then x = b sin t, makes the integrand smooth: Simpson's rule is exact to round-off.
    let spot = unequal().spot(1e-5);
    let a = spot.radius;
    let force = integral(|s| {
        let t = s * PI / 2.0;
        let r = a * t.sin();
        spot.pressure(r) * 2.0 * PI * r * a * t.cos() * PI / 2.0
    });
    close(force, spot.force, 1e-12);
    let strip = unequal().strip(1e6);
    let b = strip.half_width;
    let force = integral(|s| {
        let t = (s - 0.5) * PI;
        strip.pressure(b * t.sin()) * b * t.cos() * PI
    });
    close(force, strip.force, 1e-12);
}

/// Boussinesq: a pressure p on both half-spaces brings their surfaces together by 1/(pi E*) ∫∫ p dA/s, s the distance.
/// In the contact that is delta - r²/(2 R).
#[test]
fn the_pressure_of_spheres_closes_the_gap_between_them() {
    let pair = unequal();
    let spot = pair.spot(1e-5);
    let a = spot.radius;
    for r in [0.0, 0.3 * a, 0.7 * a, 0.99 * a] {
        // Chords through the point under all directions; on each, t from its middle.
        let closed = integral(|turn| {
            let foot = r * (turn * PI).sin();
            let half = (a * a - foot * foot).sqrt();
            integral(|s| {
                let angle = (s - 0.5) * PI;
                let t = half * angle.sin();
                spot.pressure(foot.hypot(t)) * half * angle.cos() * PI
            })
        }) / pair.modulus;
        // Pressure near the rim loses digits in 1 - r²/a².
        close(closed, spot.approach - r * r / (2.0 * pair.radius), 1e-9);
    }
}

/// Flamant: the slope of the gap closed by a pressure on both half-planes is -2/(pi E*) ∫ p(s)/(x - s) ds, the principal
/// value; in the contact that is -x/R.
#[test]
fn the_pressure_of_cylinders_closes_the_gap_between_them() {
    let pair = unequal();
    let strip = pair.strip(1e6);
    let b = strip.half_width;
    // Gauss-Chebyshev rule of the second kind: exact for the principal value half-way between its points.
    let n = 40;
    let step = PI / (n + 1) as f64;
    for k in [1, 7, 20, 33] {
        let x = b * ((k as f64 - 0.5) * step).cos();
        let value: f64 = (1..=n)
            .map(|i| {
                let angle = i as f64 * step;
                let s = b * angle.cos();
                strip.pressure(s) * b * angle.sin() * step / (x - s)
            })
            .sum();
        close(2.0 / (PI * pair.modulus) * value, x / pair.radius, 1e-11);
    }
}

/// 2.9433 belongs to delta1/v, 2.8683 to (m*²/(R E*² v))^(1/5).
#[test]
fn the_constants_of_the_duration() {
    // x = 1 - s² takes the root out of the integrand.
    let quarter = integral(|s| {
        let rest = 1.0 - (1.0 - s * s).powf(2.5);
        match s {
            0.0 => 2.0 / 2.5_f64.sqrt(),
            _ => 2.0 * s / rest.sqrt(),
        }
    });
    let (pair, mass, speed) = (unequal(), 0.3, 0.7);
    let collision = pair.collision(mass, speed);
    let group = (mass * mass / (pair.radius * pair.modulus * pair.modulus * speed)).powf(0.2);
    // Of the integrand the second derivative is bounded, the third is not: Simpson's error is h^3.5 = 3e-12.
    close(
        collision.duration * speed / collision.largest.approach,
        2.0 * quarter,
        1e-10,
    );
    close(
        collision.duration / group,
        2.0 * quarter * (15.0 / 16.0_f64).powf(0.4),
        1e-10,
    );
    // As printed, to half a unit of the last digit.
    close(2.0 * quarter, 2.9433, 1.7e-5);
    close(collision.duration / group, 2.868, 1.8e-4);
}

#[test]
fn a_collision_solves_the_equation_of_motion() {
    let (pair, speed) = (unequal(), 1.3);
    let mass = reduced_mass([0.26, f64::INFINITY]);
    assert_eq!(mass, 0.26);
    let collision = pair.collision(mass, speed);
    // Leapfrog to the middle of the collision: there the approach is the largest, by time and by energy.
    let steps = 20_000;
    let dt = 0.5 * collision.duration / steps as f64;
    let (mut x, mut v) = (0.0, speed);
    for _ in 0..steps {
        x += 0.5 * dt * v;
        v -= dt * pair.spot(x).force / mass;
        x += 0.5 * dt * v;
    }
    // Error of the rule: dt² beside the duration.
    assert!(v.abs() < 1e-7 * speed, "{v}");
    close(x, collision.largest.approach, 1e-8);
    // At the largest approach the energy is all in the contact: 2/5 F delta.
    let largest = collision.largest;
    let stored = 0.4 * largest.force * largest.approach;
    close(stored, 0.5 * mass * speed * speed, ROUND_OFF);
}

#[test]
fn a_rigid_plane_and_the_mirror_image_are_the_same() {
    // Two equal balls meet in a plane that stays plane: one of them on a rigid plane, with half the approach.
    let ball = Solid {
        radius: 0.05,
        young: 2e10,
        poisson: 0.3,
    };
    let (both, one) = (balls().spot(0.04e-3), Pair::new(ball, Solid::RIGID_PLANE));
    let one = one.spot(0.02e-3);
    close(one.force, both.force, ROUND_OFF);
    close(one.radius, both.radius, ROUND_OFF);
    close(one.peak, both.peak, ROUND_OFF);
}
