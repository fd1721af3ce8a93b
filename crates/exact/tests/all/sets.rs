//! The public bar sets: their exact figures, asserted to the digits in which they are known.

#![allow(
    clippy::unwrap_used,
    reason = "clippy sees only #[test] functions as tests"
)]

use carom_exact::{Bar, Impact, Solution, closed_forms, constrained_modulus, solve};

fn close(value: f64, exact: f64, relative: f64) {
    assert!(
        (value - exact).abs() <= relative * exact.abs(),
        "{value} is not {exact} to {relative}"
    );
}

fn equal_bars(bar: Bar, v0: f64) -> (Solution, f64) {
    let impact = Impact::TwoBars {
        secondary: bar.with_velocity(-v0),
        primary: bar,
        gap: 0.0,
    };
    let t = bar.round_trip();
    (solve(&impact, 1.5 * t).unwrap(), t)
}

fn sdnl111(modulus: f64) -> (Solution, Bar) {
    let bar = Bar::new(1.0, 4e-4, modulus, 7800.0);
    let impact = Impact::TwoBars {
        secondary: bar.with_velocity(-1.0),
        primary: bar.clamped(),
        gap: 1e-5,
    };
    (solve(&impact, 2e-3).unwrap(), bar)
}

#[test]
fn slow_and_classic_push_with_half_the_impedance_for_one_round_trip() {
    let slow = (
        Bar::new(10.0, 6.45e-4, 2.1e11, 7800.0),
        10.0,
        1.305e5,
        3.854e-3,
    );
    let classic = (
        Bar::new(0.254, 6.45e-4, 2.07e11, 7844.0),
        5.1359,
        6.674e4,
        9.889e-5,
    );
    for (bar, v0, f0, round_trip) in [slow, classic] {
        let (solution, t) = equal_bars(bar, v0);
        close(t, round_trip, 2e-4);
        close(solution.force().value(0.3 * t), f0, 2e-4);
        close(
            solution.force().value(0.3 * t),
            0.5 * bar.impedance() * v0,
            1e-15,
        );
        assert_eq!(solution.first_contact(), Some(0.0));
        assert_eq!(solution.contacts().len(), 1);
        close(solution.contacts()[0].end, t, 1e-14);
        close(solution.contacts()[0].impulse, bar.mass() * v0, 1e-14);
    }
}

#[test]
fn equal_free_bars_exchange_their_velocities_without_strain() {
    let v0 = 10.0;
    let (solution, t) = equal_bars(Bar::new(10.0, 6.45e-4, 2.1e11, 7800.0), v0);
    let [striker, target] = solution.motions() else {
        panic!("two bars")
    };
    for s in [0.0, 1.3, 5.0, 9.9, 10.0] {
        close(striker.velocity(0.0, 0.5 * t), -0.5 * v0, 1e-14);
        close(target.velocity(0.0, 0.5 * t), 0.5 * v0, 1e-14);
        assert!(striker.velocity(s, 1.2 * t).abs() < 1e-13 * v0);
        close(target.velocity(s, 1.2 * t), v0, 1e-14);
        assert!(striker.force(s, 1.2 * t).abs() < 1e-13 * solution.contacts()[0].peak_force);
        assert!(target.force(s, 1.2 * t).abs() < 1e-13 * solution.contacts()[0].peak_force);
    }
}

#[test]
fn sdnl111_displacements_of_the_striker() {
    let (solution, bar) = sdnl111(constrained_modulus(2e11, 0.3));
    let references = [
        (2e-4, -1.05e-4, 5e-9),
        (4e-4, -1.55420e-4, 5e-10),
        (6e-4, -5.54199e-5, 5e-11),
        (8e-4, 9.91602e-5, 5e-11),
        (1e-3, 2.99160e-4, 5e-10),
    ];
    for (t, displacement, rounding) in references {
        let found = solution.motions()[0].displacement(0.0, t);
        assert!(
            (found - displacement).abs() <= rounding,
            "t = {t}: {found:e}, not {displacement:e}"
        );
    }
    let impact = solution.first_contact().unwrap();
    close(impact, 1e-5, 1e-14);
    assert!((solution.force().value(1.5 * impact) - 9165.2).abs() < 0.05);
    close(
        solution.contacts()[0].end - impact,
        2.0 * bar.round_trip(),
        1e-13,
    );
}

#[test]
fn sdnl111_striker_leaves_at_its_speed_and_the_target_rests() {
    let (solution, bar) = sdnl111(2e11);
    let [contact] = solution.contacts() else {
        panic!("one contact")
    };
    close(contact.peak_force, 7899.4, 5e-6);
    close(
        contact.impulse,
        contact.peak_force * 2.0 * bar.round_trip(),
        1e-13,
    );
    close(
        solution.force().mean(contact.start, contact.end),
        contact.peak_force,
        1e-13,
    );
    for s in [0.0, 0.25, 1.0] {
        let t = contact.end + 0.3 * bar.round_trip();
        close(solution.motions()[0].velocity(s, t), 1.0, 1e-13);
        assert!(solution.motions()[1].velocity(s, t).abs() < 1e-13);
        assert!(solution.motions()[1].stress(s, t).abs() < 1e-6);
    }
}

#[test]
fn sdnv100_bar_on_a_wall() {
    let bar = Bar::new(0.2, 4e-4, 2e11, 8000.0).with_velocity(-100.0);
    let solution = solve(&Impact::Wall { bar, gap: 2e-3 }, 2e-4).unwrap();
    let [contact] = solution.contacts() else {
        panic!("one contact")
    };
    close(contact.start, 2e-5, 1e-13);
    close(contact.end, 1e-4, 1e-13);
    close(contact.peak_force, 1.6e6, 1e-14);
    close(contact.impulse, 128.0, 1e-13);
    assert_eq!(solution.releases().collect::<Vec<_>>(), [contact.end]);
    close(solution.impulse(6e-5), 64.0, 1e-13);
    assert!((solution.position(0, 0.0, 0.0) + 2e-3).abs() < 1e-18);
    close(solution.position(0, 0.2, 6e-5), -0.2 + 0.004, 1e-13);
}

#[test]
fn first_forces_agree_with_the_closed_form_for_unequal_bars() {
    let striker = Bar::new(1.0, 2e-4, 7e10, 2700.0).with_velocity(-3.0);
    let target = Bar::new(0.7, 5e-4, 2e11, 7800.0).with_velocity(-1.0);
    let z = [striker.impedance(), target.impedance()];
    let impact = Impact::TwoBars {
        secondary: striker,
        primary: target,
        gap: 0.0,
    };
    let solution = solve(&impact, 1e-5).unwrap();
    // Along the common axis the striker runs at +3 m/s and the target at -1 m/s.
    close(
        solution.force().value(0.0),
        closed_forms::impact_force(z, 4.0),
        1e-14,
    );
    let interface = closed_forms::interface_velocity(z, [3.0, -1.0]);
    close(solution.motions()[1].velocity(0.0, 0.0), interface, 1e-14);
    close(solution.motions()[0].velocity(0.0, 0.0), -interface, 1e-14);
}

/// A steel bar of 0.4 m and 6 cm² at 5 m/s, 12.3 µm from an aluminium bar of 0.6 m and 4 cm² at rest.
#[test]
fn unequal_bars_push_in_two_steps() {
    let steel = Bar::new(0.4, 6e-4, 2.1e11, 7800.0);
    let aluminium = Bar::new(0.6, 4e-4, 7e10, 2700.0);
    let impact = Impact::TwoBars {
        secondary: steel.with_velocity(-5.0),
        primary: aluminium,
        gap: 12.3e-6,
    };
    let solution = solve(&impact, 400e-6).unwrap();
    let (z, other) = (steel.impedance(), aluminium.impedance());
    let closing = 12.3e-6 / 5.0;
    let [contact] = solution.contacts() else {
        panic!("one contact");
    };
    close(contact.start, closing, 1e-12);
    // The wave comes back from the free end of the steel first, whose end it slows by twice F/Z: the force falls by the factor
    // (Z - Z')/(Z + Z'), and at the return from the end of the aluminium the bars part.
    let first = z * other / (z + other) * 5.0;
    let second = first * (z - other) / (z + other);
    let [early, late] = [steel, aluminium].map(|bar| closing + bar.round_trip());
    close(solution.force().value(closing + 1e-6), first, 1e-13);
    close(solution.force().value(early - 1e-7), first, 1e-13);
    close(solution.force().value(early + 1e-7), second, 1e-13);
    close(solution.force().value(late - 1e-7), second, 1e-13);
    close(contact.end, late, 1e-12);
    let impulse =
        first * steel.round_trip() + second * (aluminium.round_trip() - steel.round_trip());
    close(contact.impulse, impulse, 1e-12);
    let velocities = [0, 1].map(|k| {
        let motion = &solution.motions()[k];
        [-1.0, 1.0][k] * motion.momentum(399e-6) / motion.bar().mass()
    });
    close(velocities[0], 5.0 - impulse / steel.mass(), 1e-12);
    close(velocities[1], impulse / aluminium.mass(), 1e-12);
    // another implementation, to the digits that it prints
    close(first, 22418.6, 5e-6);
    close(second, 14139.8, 5e-6);
    close(contact.end - contact.start, 235.68e-6, 3e-5);
    close(impulse, 4.60883, 2e-6);
    close((velocities[1] - velocities[0]) / 5.0, 0.9149, 6e-5);
    close(velocities[0], 2.538, 2e-4);
    close(velocities[1], 7.112, 1e-4);
}
