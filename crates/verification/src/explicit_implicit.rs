//! The explicit and the implicit stepper at the same small step.
//!
//! Problem: a neo-Hookean bar of four hexahedra, held at one end, begins with the velocity of its first mode, at 1 % of strain, for a
//! quarter of the period T of that mode; central differences, and Newmark's trapezoid with iterations. Fact: both are of second order, and with
//! ω dt = 2.5e-4 their periods differ by (ω dt)²/12 + (ω dt)²/24, after a quarter of a period the motion by (ω dt)²/8 π/2 = 1.2e-8 of the
//! amplitude in the first mode. The fastest mode has ten times its frequency, and a part of the order of the strain.
//! Tolerance: 1e-6 of the amplitude, as it is asked for: fifty times the difference of the first mode. The energies of both balance to 1e-9.
//! Full integration, mean dilatation and one point.

use carom_bodies::{BodySpec, Formulation, Kinematics};
use carom_dynamics::{Driver, Model, ModelBody, Scheme, State};
use carom_materials::{Elastic, Law, NeoHooke, Plane};
use carom_mesh::generate;

use crate::Error;
use crate::build::{CENTRAL, group, newmark, support};
use crate::check::{Check, Row};

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e7,
    poisson: 0.3,
};
const LENGTH: f64 = 0.4;
const STRAIN: f64 = 0.01;
/// ω dt of the first mode.
const PHASE: f64 = 2.5e-4;

/// The state after a quarter of the period.
fn state(scheme: Scheme, formulation: Formulation) -> Result<State, Error> {
    let mesh = generate::box_("bar", [0.0; 3], [LENGTH, 0.1, 0.1], [4, 1, 1], false);
    let cells = group(&mesh, "bar")?.elements.clone();
    let law = Law::NeoHooke(NeoHooke { initial: RUBBER });
    let spec = BodySpec {
        formulation,
        ..BodySpec::new("bar", cells, Kinematics::Solid, law)
    };
    let number = std::f64::consts::FRAC_PI_2 / LENGTH;
    let speed = RUBBER.wave_speed(Plane::Uniaxial);
    let rate = number * speed;
    let supports = vec![support(&mesh, "bar.left", [true; 3])?];
    let mut model = Model {
        supports,
        ..Model::new(vec![ModelBody::new(spec)], mesh, scheme, PHASE / rate)
    };
    model.nonlinear.iteration.tolerance = 1e-13;
    let system = crate::witness::system(model)?;
    let velocity = |x: &[f64; 3]| [STRAIN * speed * (number * x[0]).sin(), 0.0, 0.0];
    let velocity: Vec<f64> = system.x.iter().flat_map(velocity).collect();
    let mut driver = Driver::new(system)?;
    driver.restart(&vec![0.0; velocity.len()], &velocity)?;
    let steps = (std::f64::consts::FRAC_PI_2 / PHASE).round() as usize;
    for _ in 0..steps {
        driver.step()?;
    }
    Ok(driver.state().clone())
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most, value| most.max(value.abs()))
}

fn rows(name: &str, formulation: Formulation) -> Result<Vec<Row>, Error> {
    let explicit = state(CENTRAL, formulation)?;
    let implicit = state(newmark(0.25, 0.5), formulation)?;
    let amplitude = largest(explicit.motion.u.iter().copied());
    let pairs = explicit.motion.u.iter().zip(&implicit.motion.u);
    let difference = largest(pairs.map(|(one, other)| one - other));
    let residual =
        |state: &State| state.ledger.largest_energy_residual / state.ledger.largest_energy;
    let row = |what: &str| format!("{name}: {what}");
    Ok(vec![
        Row::at_least(
            row("amplitude over that of a linear bar"),
            amplitude / (STRAIN / (std::f64::consts::FRAC_PI_2 / LENGTH)),
            0.9,
        ),
        Row::at_most(
            row("difference of the motions over the amplitude"),
            difference / amplitude,
            1e-6,
        ),
        Row::at_most(row("energy residual, explicit"), residual(&explicit), 1e-9),
        Row::at_most(row("energy residual, implicit"), residual(&implicit), 1e-9),
    ])
}

pub(crate) const CHECK: Check = Check {
    name: "explicit-implicit",
    fact: "at a small step the explicit and the implicit stepper give the same motion of an elastic bar, to 1e-6",
    run: |_| {
        let mut all = rows("full integration", Formulation::Full)?;
        all.extend(rows("mean dilatation", Formulation::BBar)?);
        all.extend(rows("one point", Formulation::Reduced { hourglass: 0.1 })?);
        Ok(all)
    },
};
