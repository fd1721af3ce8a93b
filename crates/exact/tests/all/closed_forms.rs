//! The closed forms against a direct computation: one contact step of long meshes, solved by elimination.

use carom_exact::closed_forms::{
    Mass, compliance_loss, compliance_loss_on_wall, compliance_ratio, contact_impedance,
    impact_force, newmark_first_force, penetration_bound_half, penetration_bound_now,
    theta_first_force, theta_impact_loss, theta_impact_loss_on_wall,
};

/// Elements of a bar with c = h = A = E = 1, so that dt = CFL and Z = 1.
const ELEMENTS: usize = 400;

/// Response x = (M + factor K)^-1 e_0 of a free bar to a unit load on its end node (Thomas elimination).
fn end_response(mass: Mass, factor: f64) -> Vec<f64> {
    let (diagonal, off) = match mass {
        Mass::Lumped => (1.0, 0.0),
        Mass::Consistent => (2.0 / 3.0, 1.0 / 6.0),
    };
    let (d, o) = (diagonal + 2.0 * factor, off - factor);
    // Elimination from the far end to the loaded one, then substitution back.
    let mut pivots = vec![0.5 * d];
    for i in 1..=ELEMENTS {
        let own = if i == ELEMENTS { 0.5 * d } else { d };
        pivots.push(own - o * o / pivots[i - 1]);
    }
    let mut x = vec![1.0 / pivots[ELEMENTS]];
    for i in 0..ELEMENTS {
        x.push(-o * x[i] / pivots[ELEMENTS - 1 - i]);
    }
    x
}

fn close(value: f64, exact: f64) {
    assert!(
        (value - exact).abs() < 1e-11 * exact,
        "{value} is not {exact}"
    );
}

const CFL: [f64; 4] = [0.25, 0.5, 1.0, 4.0];

#[test]
fn first_force_of_newmark() {
    for mass in [Mass::Lumped, Mass::Consistent] {
        for beta in [0.25, 0.49, 0.5] {
            for dt in CFL {
                // beta dt² (M/(beta dt²) + K) Δu = beta dt² F, gap of both ends: v0 dt = 2 Δu; F0 = v0/2.
                let compliance = beta * dt * dt * end_response(mass, beta * dt * dt)[0];
                let v0 = 3.0;
                let force = v0 * dt / (2.0 * compliance);
                close(
                    force / impact_force([1.0, 1.0], v0),
                    newmark_first_force(mass, beta, dt),
                );
            }
        }
    }
    assert!((newmark_first_force(Mass::Lumped, 0.25, 1.0) - 8f64.sqrt()).abs() < 1e-15);
}

#[test]
fn first_force_and_loss_of_theta() {
    for mass in [Mass::Lumped, Mass::Consistent] {
        for theta in [0.5, 0.75, 1.0] {
            for dt in CFL {
                let a = end_response(mass, (theta * dt).powi(2))[0];
                let v0 = 3.0;
                let impulse = v0 / (2.0 * a);
                close(
                    impulse / dt / impact_force([1.0, 1.0], v0),
                    theta_first_force(mass, theta, dt),
                );
                // Both free steps are rigid, so the loss is the work of the impulse on the mean rate: dt P v0/2.
                let initial = 0.5 * ELEMENTS as f64 * v0 * v0;
                let loss = 0.5 * impulse * v0 / initial;
                close(loss, theta_impact_loss(mass, theta, dt, ELEMENTS));
                close(
                    2.0 * loss,
                    theta_impact_loss_on_wall(mass, theta, dt, ELEMENTS),
                );
            }
        }
    }
}

#[test]
fn loss_of_theta_is_the_energy_difference_of_the_step() {
    // Wall, v+ = v - P x with x = A^-1 e_0, u = 0: energy from the definition, not from an identity.
    let (theta, dt, v0) = (0.75, 0.5, 1.0);
    let x = end_response(Mass::Lumped, (theta * dt) * (theta * dt));
    let velocity: Vec<f64> = x.iter().map(|xi| -v0 + v0 / x[0] * xi).collect();
    let node_mass = |i: usize| if i == 0 || i == ELEMENTS { 0.5 } else { 1.0 };
    let kinetic: f64 = velocity
        .iter()
        .enumerate()
        .map(|(i, v)| 0.5 * node_mass(i) * v * v)
        .sum();
    let moved: Vec<f64> = velocity
        .iter()
        .map(|v| dt * (theta * v - (1.0 - theta) * v0))
        .collect();
    let strain: f64 = moved.windows(2).map(|u| 0.5 * (u[1] - u[0]).powi(2)).sum();
    let initial = 0.5 * ELEMENTS as f64 * v0 * v0;
    let loss = (initial - kinetic - strain) / initial;
    assert!((loss - theta_impact_loss_on_wall(Mass::Lumped, theta, dt, ELEMENTS)).abs() < 1e-13);
}

#[test]
fn the_compliance_in_velocity_balances_force_and_lost_energy() {
    let z = 1.7;
    for damping in [0.1, 1.0, 10.0, 100.0] {
        // Equal bars, v0 = 1: P = C_n (v0 - P/(Z/2)); after T the velocities are v0 (1 - phi) and v0 phi.
        let seen = contact_impedance([z, z]);
        let phi = compliance_ratio(damping, seen);
        let force = phi * impact_force([z, z], 1.0);
        close(force, damping * (1.0 - force / seen));
        assert!((compliance_loss(phi) - (1.0 - (1.0 - phi).powi(2) - phi * phi)).abs() < 1e-15);
        // Wall: the bar leaves at v0 (2 phi - 1).
        let wall = contact_impedance([z, f64::INFINITY]);
        assert_eq!(wall, z);
        let phi = compliance_ratio(damping, wall);
        assert!((compliance_loss_on_wall(phi) - (1.0 - (2.0 * phi - 1.0).powi(2))).abs() < 1e-15);
    }
    assert_eq!(compliance_loss_on_wall(compliance_ratio(z, z)), 1.0);
}

#[test]
fn compliance_losses_of_the_reference_table() {
    // C_n = 10 Z: 9.07 % between equal bars, 33.06 % on the wall; a 1 % loss needs about 100 Z and 400 Z.
    assert!((compliance_loss(compliance_ratio(10.0, 0.5)) - 0.0907).abs() < 5e-5);
    assert!((compliance_loss_on_wall(compliance_ratio(10.0, 1.0)) - 0.3306).abs() < 5e-5);
    assert!((compliance_loss(compliance_ratio(100.0, 0.5)) - 0.01).abs() < 2e-4);
    assert!((compliance_loss_on_wall(compliance_ratio(400.0, 1.0)) - 0.01).abs() < 2e-4);
}

#[test]
fn capture_at_half_step_penetrates_half_a_step_less() {
    let (v0, dt) = (10.0, 1e-5);
    for theta in [0.5, 0.75, 1.0] {
        let less = penetration_bound_now(theta, v0, dt) - penetration_bound_half(theta, v0, dt);
        assert!((less - 0.5 * v0 * dt).abs() < 1e-18);
    }
}
