//! Order of convergence of the schemes in the step.
//!
//! Problem: a bar of the set "slow", both ends held, n = 10 elements with lumped mass, no contact, starts with the
//! velocity v_j = v0 sin(π j / n) and without displacement, for a third of a period. Closed solution: that is a mode of
//! the discrete bar too, with ω = (2 c / h) sin(π / (2 n)): u = (v / ω) sin ω t, so that the mesh adds no error. Reference:
//! the formula. The error, of u and v / ω in the mean square, falls as dt to the order that the scheme states. Tolerance:
//! 0.03 of the order between 200 and 400 steps per period, where terms of the next order, ω dt / 2 = 0.016 relative, are
//! smaller.

use carom_bodies::Kinematics;
use carom_dynamics::{Driver, Model, Scheme, march};
use carom_mesh::generate;

use crate::Error;
use crate::bars::SLOW;
use crate::build::{body, newmark, support, theta};
use crate::check::{Check, Row};

const ELEMENTS: usize = 10;

/// ω in rad/s.
fn frequency() -> f64 {
    let n = ELEMENTS as f64;
    let h = SLOW.length / n;
    2.0 * SLOW.wave_speed() / h * (0.5 * std::f64::consts::PI / n).sin()
}

fn model(scheme: Scheme, dt: f64) -> Result<Model, Error> {
    let mesh = generate::line("bar", [0.0; 3], [SLOW.length, 0.0, 0.0], ELEMENTS, 1);
    let bar = body(
        &mesh,
        "bar",
        Kinematics::Bar { area: SLOW.area },
        SLOW.material(),
    )?;
    let held = [true, false, false];
    Ok(Model {
        supports: vec![
            support(&mesh, "bar.left", held)?,
            support(&mesh, "bar.right", held)?,
        ],
        ..Model::new(vec![bar], mesh, scheme, dt)
    })
}

/// Error after a third of a period of `steps` steps, relative.
fn error(scheme: Scheme, steps: usize) -> Result<f64, Error> {
    let omega = frequency();
    let dt = std::f64::consts::TAU / omega / steps as f64;
    let system = crate::witness::system(model(scheme, dt)?)?;
    let mode: Vec<f64> = system
        .x
        .iter()
        .map(|x| (std::f64::consts::PI * x[0] / SLOW.length).sin())
        .collect();
    let velocity: Vec<f64> = mode.iter().map(|mode| SLOW.speed * mode).collect();
    let mut driver = Driver::new(system)?;
    driver.restart(&vec![0.0; mode.len()], &velocity)?;
    march(&mut driver, steps as f64 * dt / 3.0, &mut [], &|| false)?;
    let state = driver.state();
    let (sin, cos) = (omega * state.time).sin_cos();
    let (mut square, mut norm) = (0.0, 0.0);
    for (i, mode) in mode.iter().enumerate() {
        let amplitude = SLOW.speed * mode;
        square += (state.motion.v[i] - amplitude * cos).powi(2)
            + (omega * state.motion.u[i] - amplitude * sin).powi(2);
        norm += amplitude.powi(2);
    }
    Ok((square / norm).sqrt())
}

pub(crate) const CHECK: Check = Check {
    name: "order",
    fact: "every scheme converges in the step with the order that it states",
    run: |_| {
        let mut schemes = Scheme::registered();
        schemes.extend([theta(1.0), newmark(0.5, 0.5)]);
        let mut rows = Vec::new();
        for scheme in schemes {
            let order = (error(scheme, 200)? / error(scheme, 400)?).log2();
            rows.push(Row::near(
                format!("{scheme:?}: order"),
                order,
                f64::from(scheme.get().order()),
                0.03,
            ));
        }
        Ok(rows)
    },
};
