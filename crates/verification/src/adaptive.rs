//! Steps that adapt themselves to events.
//!
//! Problem: a bar of the set "slow", n = 20, flies at a rigid wall through gaps of 3.3 and 3.8 v0 dt and comes back; every
//! registered scheme with every law, closings cut. Closed solution: a cut puts the closing at the same place of a step
//! wherever the bar starts, so that the first forces of both runs are the same; a law in the gap then stops the end of the bar, its gap
//! and its rate zero; the energy identity of each scheme holds whatever the steps are, once the change of the scheme's own
//! energy with the step is counted. Reference: the other run, a second formulation; the ledger's own terms. Tolerance: forces 1e-6 of Z v0 and rates 1e-6 of
//! v0, for the cut aims 1e-11 of the model's length before its place, which is 2e-7 of a way v0 dt; ledgers 1e-11 as for equal
//! steps. The trapezoid with the displacement law makes energy at any step: the run must end there, its last good state kept,
//! and say why. What was cut at an instant and resumed must have the same bytes.

use carom_contact::Law;
use carom_dynamics::{Adaptive, Closing, Driver, Scheme, State};

use crate::Error;
use crate::bars::{Against, Run, SLOW};
use crate::battery::{is_senseless, laws};
use crate::build::{DISPLACEMENT, newmark};
use crate::check::{Check, Row};

const ELEMENTS: usize = 20;

/// Forces of two flights that are compared.
const COMPARED: usize = 5;

fn flying() -> Run {
    let run = Run {
        against: Against::Wall,
        ..Run::slow(ELEMENTS)
    };
    Run {
        gap: 3.3 * run.set.speed * run.dt(),
        ..run
    }
}

fn rules(run: &Run, growth: Option<f64>) -> Adaptive {
    Adaptive {
        smallest: run.dt() / 16.0,
        closing: Closing::Cut,
        growth,
        patience: 10,
    }
}

fn driver(run: &Run, growth: Option<f64>) -> Result<Driver, Error> {
    let mut model = run.model()?;
    model.adaptive = Some(rules(run, growth));
    Ok(Driver::new(crate::witness::system(model)?)?)
}

/// What a flight to the wall gives.
struct Flight {
    /// The first forces, N.
    forces: Vec<f64>,
    /// Gap rate at the end of the first step with a force, over v0.
    rate: f64,
    /// Largest residuals of energy and momentum, relative.
    residuals: [f64; 2],
}

fn fly(run: &Run) -> Result<Flight, Error> {
    let mut driver = driver(run, None)?;
    let mut flight = Flight {
        forces: Vec::new(),
        rate: f64::NAN,
        residuals: [f64::NAN; 2],
    };
    while driver.state().time < 1.2 * run.set.duration() {
        driver.step()?;
        let state = driver.state();
        let force = state.interface.force[0];
        if flight.forces.is_empty() && force != 0.0 {
            flight.rate = -state.motion.v[run.elements] / run.set.speed;
        }
        if flight.forces.len() < COMPARED && (force != 0.0 || !flight.forces.is_empty()) {
            flight.forces.push(force);
        }
    }
    let ledger = &driver.state().ledger;
    flight.residuals = [
        ledger.largest_energy_residual / ledger.largest_energy,
        ledger.largest_momentum_residual / ledger.largest_momentum,
    ];
    Ok(flight)
}

/// Every scheme with every law: the closing, balances.
fn flights() -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for scheme in Scheme::registered() {
        let h = SLOW.length / ELEMENTS as f64;
        for (name, law) in laws(&SLOW.material(), h, SLOW.area)? {
            if is_senseless(scheme, law) {
                continue;
            }
            let run = Run {
                scheme,
                law,
                ..flying()
            };
            let later = Run {
                gap: run.gap * 3.8 / 3.3,
                ..run
            };
            let (one, other) = (fly(&run)?, fly(&later)?);
            let name = format!("{scheme:?}, {name}");
            let pairs = one.forces.iter().zip(&other.forces);
            let difference = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            rows.push(
                Row::at_most(
                    format!("{name}: first forces of two flights, difference / (Z v0)"),
                    difference / run.force(),
                    1e-6,
                )
                .second_formulation(),
            );
            if stops(scheme, law) {
                rows.push(Row::near(
                    format!("{name}: rate after the step that closes / v0"),
                    one.rate,
                    0.0,
                    1e-6,
                ));
            }
            for flight in [one, other] {
                let [energy, momentum] = flight.residuals;
                rows.push(Row::at_most(format!("{name}: energy"), energy, 1e-11));
                rows.push(Row::at_most(format!("{name}: momentum"), momentum, 1e-11));
            }
        }
    }
    Ok(rows)
}

/// Whether the force that makes the gap vanish stops the end of the bar: not where the velocity jumps besides, where the
/// compliances of the mass and of the step are summed, where the predictor is projected, or where the force acts on in the next stage.
fn stops(scheme: Scheme, law: Law) -> bool {
    let other = match scheme {
        _ if scheme.get().stages().len() > 1 => true,
        Scheme::LaursenLove(_) | Scheme::Kane(_) | Scheme::ContactStabilised(_) => true,
        Scheme::PaoliSchatzman(scheme) => scheme.restitution > 0.0,
        _ => false,
    };
    law == DISPLACEMENT && !other
}

/// The trapezoid with the displacement law: the run ends when energy grows.
fn growth() -> Result<Vec<Row>, Error> {
    let run = Run {
        scheme: newmark(0.25, 0.5),
        law: DISPLACEMENT,
        courant: 0.25,
        ..flying()
    };
    let mut driver = driver(&run, Some(0.01))?;
    let (mut named, mut kept) = (false, false);
    while driver.state().time < 3.0 * run.set.duration() {
        let before = driver.state().to_bytes()?;
        if let Err(error) = driver.step() {
            kept = before == driver.state().to_bytes()?;
            named = matches!(error, carom_dynamics::Error::EnergyGrowth { .. });
            break;
        }
    }
    let ledger = &driver.state().ledger;
    Ok(vec![
        Row::count(
            "energy growth: runs that end with that cause",
            named.into(),
            1,
        ),
        Row::count("energy growth: last good states kept", kept.into(), 1),
        Row::at_most(
            "energy growth: energy of the last state / E0 - 1",
            ledger.balance.energy() / ledger.initial.energy() - 1.0,
            0.01,
        ),
    ])
}

/// The bar at rest, under gravity: energy begins with nothing, and falls into motion.
fn falling() -> Result<Row, Error> {
    let run = flying();
    let mut model = run.model()?;
    model.adaptive = Some(rules(&run, Some(0.01)));
    for body in &mut model.bodies {
        body.velocity = [0.0; 3];
    }
    model.gravity = [1.0, 0.0, 0.0];
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    for _ in 0..100 {
        driver.step()?;
    }
    Ok(Row::count(
        "fall from rest: attempts dropped",
        driver.state().control.grown as usize,
        0,
    ))
}

/// A run resumed after a cut.
fn resumed() -> Result<Row, Error> {
    let run = flying();
    let (mut whole, mut different) = (driver(&run, Some(0.01))?, 0);
    let system = {
        let mut model = run.model()?;
        model.adaptive = Some(rules(&run, Some(0.01)));
        crate::witness::system(model)?
    };
    for _ in 0..150 {
        let state = State::from_bytes(&system, &whole.state().to_bytes()?)?;
        let mut other = Driver::resume(system.clone(), state)?;
        whole.step()?;
        other.step()?;
        different += usize::from(whole.state().to_bytes()? != other.state().to_bytes()?);
    }
    Ok(Row::count(
        "steps after a resumption that differ in a byte",
        different,
        0,
    )
    .second_formulation())
}

pub(crate) const CHECK: Check = Check {
    name: "adaptive",
    fact: "steps are cut where contacts close, balances hold with unequal steps, energy that grows ends the run",
    run: |_| {
        let mut rows = flights()?;
        rows.extend(growth()?);
        rows.push(falling()?);
        rows.push(resumed()?);
        Ok(rows)
    },
};
