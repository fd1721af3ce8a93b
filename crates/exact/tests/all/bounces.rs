//! Repeated impacts: the clamped bouncing bar, the bar dropped under gravity, the bar that stands on the ground.

#![allow(
    clippy::unwrap_used,
    reason = "clippy sees only #[test] functions as tests"
)]

use carom_exact::{Bar, Impact, solve};

#[test]
fn the_clamped_bouncing_bar_has_period_three_for_two_hundred_periods() {
    let bar = Bar::new(1.0, 1.0, 1.0, 1.0).with_strain(-0.5).clamped();
    let solution = solve(&Impact::Wall { bar, gap: 0.5 }, 600.0).unwrap();
    assert_eq!(solution.contacts().len(), 200);
    for (i, contact) in solution.contacts().iter().enumerate() {
        let start = 3.0 * i as f64;
        assert_eq!((contact.start, contact.end), (start + 1.0, start + 2.0));
        assert_eq!((contact.peak_force, contact.impulse), (0.5, 0.5));
        assert!((solution.energy(start + 1.7) - 0.125).abs() < 1e-15);
        assert_eq!(solution.gap(start + 0.5), 0.25);
        assert_eq!(solution.motions()[0].displacement(0.0, start + 2.25), 0.125);
    }
    // At mid-contact the fronts from the wall and from the clamp meet: the bar is at rest, half pushed, half pulled.
    for (s, stress) in [(0.1, -0.5), (0.4, -0.5), (0.6, 0.5), (0.9, 0.5)] {
        assert_eq!(solution.motions()[0].displacement(s, 0.0), 0.5 * (1.0 - s));
        assert_eq!(solution.motions()[0].stress(s, 1.5), stress);
        assert_eq!(solution.motions()[0].velocity(s, 1.5), 0.0);
    }
}

fn dropped_bar() -> (Bar, f64) {
    (Bar::new(10.0, 1.0, 900.0, 1.0).with_gravity(10.0), 5.0)
}

#[test]
fn the_dropped_bar_first_touches_and_pushes_as_a_falling_body() {
    let (bar, gap) = dropped_bar();
    let solution = solve(&Impact::Wall { bar, gap }, 4.0).unwrap();
    // sqrt(2 h/g) = 1 s, v = g t = 10 m/s, F = Z (v + g (t - 1)) until the wave comes back after T = 2/3 s.
    let z = bar.impedance();
    assert!((solution.first_contact().unwrap() - 1.0).abs() < 1e-14);
    assert!((solution.force().value(1.2) - z * 12.0).abs() < 1e-11);
    let t = bar.round_trip();
    assert!((solution.contacts()[0].end - 1.0 - t).abs() < 1e-13);
    let impulse = z * (10.0 * t + 5.0 * t * t);
    assert!((solution.contacts()[0].impulse - impulse).abs() < 1e-11 * impulse);
}

#[test]
fn the_dropped_bar_keeps_its_energy_over_eight_bounces() {
    let (bar, gap) = dropped_bar();
    let solution = solve(&Impact::Wall { bar, gap }, 30.0).unwrap();
    assert!(
        solution.contacts().len() >= 8,
        "{} bounces",
        solution.contacts().len()
    );
    let scale = bar.mass() * 10.0 * gap;
    for i in 0..=600 {
        let t = 0.05 * f64::from(i);
        assert!((solution.energy(t) - solution.energy(0.0)).abs() < 1e-11 * scale);
        let momentum = solution.impulse(t) - bar.mass() * 10.0 * t;
        assert!((solution.motions()[0].momentum(t) - momentum).abs() < 1e-10 * bar.mass());
        assert!((solution.motions()[0].impulse(0.0, t) - solution.impulse(t)).abs() < 1e-10);
    }
}

#[test]
fn a_bar_set_down_on_the_ground_pushes_between_zero_and_twice_its_weight() {
    let (bar, _) = dropped_bar();
    let solution = solve(&Impact::Wall { bar, gap: 0.0 }, 40.0).unwrap();
    let weight = bar.mass() * 10.0;
    assert_eq!(solution.contacts().len(), 1);
    assert!((solution.contacts()[0].peak_force - 2.0 * weight).abs() < 1e-10 * weight);
    let whole_cycles = 20.0 * 2.0 * bar.round_trip();
    assert!((solution.force().mean(0.0, whole_cycles) - weight).abs() < 1e-10 * weight);
}

#[test]
fn a_clamped_bar_released_under_its_weight_swings_about_its_static_sag() {
    let (bar, _) = dropped_bar();
    let solution = solve(
        &Impact::Wall {
            bar: bar.clamped(),
            gap: 10.0,
        },
        40.0,
    )
    .unwrap();
    assert!(solution.contacts().is_empty());
    let period = 2.0 * bar.round_trip();
    let support = -solution.motions()[0].impulse(bar.length, 10.0 * period) / (10.0 * period);
    assert!((support - bar.mass() * 10.0).abs() < 1e-10 * support);
    let lowest = solution.motions()[0].displacement(0.0, 0.5 * period);
    let static_sag = bar.density * 10.0 * bar.length.powi(2) / (2.0 * bar.modulus);
    assert!((lowest + 2.0 * static_sag).abs() < 1e-12);
}

#[test]
fn bars_that_never_meet_have_no_contact() {
    let bar = Bar::new(1.0, 1.0, 1.0, 1.0);
    let apart = Impact::TwoBars {
        secondary: bar,
        primary: bar.with_velocity(0.1),
        gap: 0.0,
    };
    let solution = solve(&apart, 10.0).unwrap();
    assert_eq!(solution.first_contact(), None);
    assert_eq!(solution.impulse(10.0), 0.0);
    assert!((solution.gap(10.0) - 1.0).abs() < 1e-14);
}

#[test]
fn a_bar_falls_through_a_thousand_million_round_trips_at_once() {
    // c = 10⁹ m/s, a round trip of 2 ns, and a fall of √2 s onto the ground: the events are the landing and what follows
    let bar = Bar::new(1.0, 1.0, 1e18, 1.0).with_gravity(1.0);
    let end = 2f64.sqrt() + 1e-8;
    let solution = solve(&Impact::Wall { bar, gap: 1.0 }, end).unwrap();
    let contact = solution.contacts()[0];
    // the tolerance of times is four units of rounding of the end time
    assert!((contact.start - 2f64.sqrt()).abs() < 2e-15 * end);
    // a rigid motion until then: F = Z v = ρ c A g t
    assert!((contact.peak_force / (1e9 * 2f64.sqrt()) - 1.0).abs() < 1e-8);
    assert!((contact.end - contact.start - 2e-9).abs() < 4e-15);
}

#[test]
fn a_thousand_million_round_trips_after_an_impact_change_nothing() {
    let bar = Bar::new(1.0, 1.0, 1.0, 1.0);
    let impact = Impact::TwoBars {
        secondary: bar.with_velocity(-1.0),
        primary: bar,
        gap: 0.5,
    };
    let (short, long) = (solve(&impact, 10.0).unwrap(), solve(&impact, 2e9).unwrap());
    assert_eq!(long.contacts().len(), 1);
    // times to four units of rounding of the end time
    for t in [1.0, 2.0, 3.0, 9.0] {
        assert!((long.gap(t) - short.gap(t)).abs() < 4e-6);
        assert!((long.impulse(t) - short.impulse(t)).abs() < 4e-6);
    }
    // the target moves at 1 m/s from 2.5 s on, the striker rests
    assert!((long.gap(2e9) - (2e9 - 2.5)).abs() < 1e-5);
}
