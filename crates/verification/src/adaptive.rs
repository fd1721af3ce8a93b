//! Steps that adapt themselves to events.
//!
//! Problem: a bar of the set "slow", n = 20, flies at a rigid wall through a gap of 3.3 v0 dt and comes back; every
//! registered scheme with every law, closings cut. Closed solution: it arrives at gap / v0; the energy identity of each
//! scheme holds whatever the steps are, once the change of the scheme's own energy with the step is counted. Reference: the
//! exact instant; the ledger's own terms. Tolerance: the instant to 1e-6 of itself, for the cut aims at a penetration of
//! 1e-11 of the model's length, 6e-8 of the gap, so that rounding leaves no open gap; ledgers 1e-11 as for equal steps. The trapezoid with the
//! displacement law makes energy at any step: the run must end there, its last good state kept, and say why. What was cut
//! at an instant and resumed must have the same bytes.

use carom_contact::law::Capture;
use carom_dynamics::{Adaptive, Closing, Driver, Scheme, State, System};

use crate::Error;
use crate::bars::{Against, Run, SLOW};
use crate::battery::{is_senseless, laws};
use crate::build::{DISPLACEMENT, newmark, velocity};
use crate::check::{Check, Row};

const ELEMENTS: usize = 20;

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
    Ok(Driver::new(System::new(model)?)?)
}

/// Every scheme with every law: arrival, balances, factors.
fn flights() -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for scheme in Scheme::registered() {
        let h = SLOW.length / ELEMENTS as f64;
        for (name, law) in laws(&SLOW.material(), h, SLOW.area)? {
            // laws that look ahead, and an explicit scheme places points at the end of the step, a clearance, or gaps weighted with
            // those of the step before close elsewhere than where the gap does
            let explicit = scheme.get().is_explicit() && law != velocity(Capture::Now);
            let far = [Capture::Full, Capture::Free].map(velocity).contains(&law);
            let weighted = matches!(scheme, Scheme::PaoliSchatzman(s) if s.restitution > 0.0);
            let ahead = explicit && name != "penalty" || far || weighted || name == "stop";
            if is_senseless(scheme, law) {
                continue;
            }
            let run = Run {
                scheme,
                law,
                ..flying()
            };
            let mut driver = driver(&run, None)?;
            let expected = run.gap / run.set.speed;
            let mut arrival = f64::NAN;
            while driver.state().time < 1.2 * run.set.duration() {
                driver.step()?;
                if arrival.is_nan() && driver.state().interface.gap[0] < 1e-6 * run.gap {
                    arrival = driver.state().time;
                }
            }
            let name = format!("{scheme:?}, {name}");
            let state = driver.state();
            let ledger = &state.ledger;
            let energy = ledger.largest_energy_residual / ledger.largest_energy;
            let momentum = ledger.largest_momentum_residual / ledger.largest_momentum;
            if !ahead {
                let error = arrival / expected - 1.0;
                rows.push(Row::near(
                    format!("{name}: arrival / exact - 1"),
                    error,
                    0.0,
                    1e-6,
                ));
            }
            rows.push(Row::at_most(format!("{name}: energy"), energy, 1e-11));
            rows.push(Row::at_most(format!("{name}: momentum"), momentum, 1e-11));
        }
    }
    Ok(rows)
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
    let error = loop {
        let before = driver.state().to_bytes()?;
        if let Err(error) = driver.step() {
            let kept = before == driver.state().to_bytes()?;
            break (error, kept);
        }
    };
    let ledger = &driver.state().ledger;
    let named = matches!(error.0, carom_dynamics::Error::EnergyGrowth { .. });
    Ok(vec![
        Row::count(
            "energy growth: runs that end with that cause",
            named.into(),
            1,
        ),
        Row::count("energy growth: last good states kept", error.1.into(), 1),
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
    let mut driver = Driver::new(System::new(model)?)?;
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
        System::new(model)?
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
    ))
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
