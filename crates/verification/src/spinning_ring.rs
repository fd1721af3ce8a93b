//! A thin ring that spins, breathes and falls, in explicit steps.
//!
//! Problem: a ring in plane strain, radius R = 1 m, thickness R/50, neo-Hooke with ν = 0.3, begins undeformed with the angular velocity Ω, 2 % of
//! its frequency of breathing ω, under gravity; central differences.
//! Closed solution: with E' = E/(1 - ν²) and ω² = E'/(ρ R²) the radius obeys u'' = Ω² R - (ω² + 3Ω²) u, the angular momentum being
//! kept: it grows by twice Ω² R/(ω² + 3Ω²), with the period 2π/√(ω² + 3Ω²), and the mean hoop stress over a period is that of a ring that spins at rest,
//! ρ Ω² R², over 1 + 3Ω²/ω². The centre of mass falls by g t²/2, which central differences do without error.
//! Tolerance: half a per cent for growth, period and stress: strains of 8e-4 and the square of the thickness over the radius, 4e-4, change
//! them by as much, and a polygon of 96 sides by (π/96)²/2 = 5e-4. Fall, angular momentum and energy: rounding, of two thousand steps: 1e-11.

use std::f64::consts::PI;

use carom_bodies::Kinematics;
use carom_dynamics::{Driver, Model};
use carom_materials::Elastic;
use carom_mesh::generate;

use crate::Error;
use crate::build::{CENTRAL, neo_hooke, welded};
use crate::check::{Check, Row};

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e7,
    poisson: 0.3,
};
const RADIUS: f64 = 1.0;
const THICKNESS: f64 = 0.02;
const SIDES: usize = 96;
/// Ω/ω.
const PART: f64 = 0.02;
const GRAVITY: f64 = 9.81;
const ROUNDING: f64 = 1e-11;

fn driver(spin: f64) -> Result<Driver, Error> {
    let corner = [RADIUS - 0.5 * THICKNESS, 0.0];
    let size = [THICKNESS, 2.0 * PI];
    let mut mesh = generate::rectangle("ring", corner, size, [1, SIDES], false);
    for x in &mut mesh.nodes {
        let [r, angle, _] = *x;
        *x = [r * angle.cos(), r * angle.sin(), 0.0];
    }
    let mesh = welded(mesh);
    let mut body = neo_hooke(
        &mesh,
        "ring",
        Kinematics::PlaneStrain { thickness: 1.0 },
        RUBBER,
    )?;
    body.spin = [0.0, 0.0, spin];
    let mut model = Model {
        gravity: [0.0, -GRAVITY, 0.0],
        ..Model::new(vec![body], mesh, CENTRAL, 1e-6)
    };
    model.dt = 0.5 * crate::witness::system(model.clone())?.critical_step();
    Ok(Driver::new(crate::witness::system(model)?)?)
}

fn rows() -> Result<Vec<Row>, Error> {
    let modulus = RUBBER.young / (1.0 - RUBBER.poisson * RUBBER.poisson);
    let breathing = (modulus / RUBBER.density).sqrt() / RADIUS;
    let spin = PART * breathing;
    let rate = (breathing * breathing + 3.0 * spin * spin).sqrt();
    let period = 2.0 * PI / rate;
    let mut driver = driver(spin)?;
    let system = std::sync::Arc::new(driver.system().x.clone());
    let mass = driver.system().mass.lumped.clone();
    let whole: f64 = mass.iter().step_by(2).sum();
    let centre = |u: &[f64]| {
        let sums = [0, 1].map(|i| (i..u.len()).step_by(2).map(|k| mass[k] * u[k]).sum::<f64>());
        sums.map(|sum| sum / whole)
    };
    // mean growth of the radius
    let growth = |u: &[f64]| {
        let fall = centre(u);
        let of = |(k, x): (usize, &[f64; 3])| {
            let now = (x[0] + u[2 * k] - fall[0]).hypot(x[1] + u[2 * k + 1] - fall[1]);
            now - x[0].hypot(x[1])
        };
        system.iter().enumerate().map(of).sum::<f64>() / system.len() as f64
    };
    let (mut grown, mut stress, mut steps, mut back) = (vec![0.0], 0.0, 0.0, f64::NAN);
    while driver.state().time < 1.2 * period {
        driver.step()?;
        let state = driver.state();
        grown.push(growth(&state.motion.u));
        if state.time <= period {
            let cells = driver.system().bodies[0].stresses(&state.motion.u, &[]);
            let trace = cells.iter().map(|(_, s)| s[(0, 0)] + s[(1, 1)]);
            stress += trace.sum::<f64>() / cells.len() as f64;
            steps += 1.0;
        }
        let n = grown.len();
        if n > 2 && state.time > 0.75 * period && back.is_nan() && grown[n - 1] > grown[n - 2] {
            // the least of a parabola through three values
            let [a, b, c] = [grown[n - 3], grown[n - 2], grown[n - 1]];
            back = state.time - driver.system().dt * (1.0 - 0.5 * (a - c) / (a - 2.0 * b + c));
        }
    }
    let state = driver.state();
    let ledger = &state.ledger;
    let most = grown.iter().fold(0.0_f64, |most, u| most.max(*u));
    let angular = ledger.initial.momentum.angular[2];
    let fall = centre(&state.motion.u)[1];
    Ok(vec![
        Row::relative(
            "angular momentum at the start, N m s",
            angular,
            whole * spin * RADIUS * RADIUS,
            5e-3,
        ),
        Row::relative(
            "largest growth of the radius, m",
            most,
            2.0 * spin * spin * RADIUS / (rate * rate),
            5e-3,
        ),
        Row::relative("period, s", back, period, 5e-3),
        Row::relative(
            "mean hoop stress over a period, Pa",
            stress / steps,
            RUBBER.density * (spin * RADIUS * breathing / rate).powi(2),
            5e-3,
        ),
        Row::relative(
            "fall, m",
            fall,
            -0.5 * GRAVITY * state.time * state.time,
            ROUNDING,
        ),
        Row::near(
            "angular momentum, change relative",
            ledger.balance.momentum.angular[2] / angular - 1.0,
            0.0,
            ROUNDING,
        ),
        Row::at_most(
            "energy residual, relative",
            ledger.largest_energy_residual / ledger.largest_energy,
            ROUNDING,
        ),
    ])
}

pub(crate) const CHECK: Check = Check {
    name: "spinning-ring",
    fact: "a ring that spins grows, breathes and carries the hoop stress of the closed form while it falls, in explicit steps",
    run: |_| rows(),
};
