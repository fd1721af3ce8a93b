//! Newton's restitution.
//!
//! Problem: bars of one element at c dt / L = 1e4, which do not deform within a step, theta ½: one on a wall and two equal
//! ones, met at a third of a step; and e = 0 in bars of set "slow", n = 20, under every registered scheme. Closed
//! solution: the separation of the bodies is e times their approach, the energy lost (1 - e²) of that of the approach
//! (in the centre of mass), and with e = 0 the law is the velocity law. Reference: the formulas; for e = 0 the run
//! with the velocity law, a second formulation. Tolerance: 1e-6 of speed and energy, for the vibration left, (L / (c dt))² = 1e-8 to
//! within a factor; energy never grows from step to step (theta ½ <= 1 / (1 + e)) by more than 1e-5 of its first value, the work
//! on points that vibrate while they are pressed; bytes of the states for e = 0.

use carom_contact::Law;
use carom_contact::law::{Capture, Restitution};
use carom_dynamics::Scheme;

use crate::Error;
use crate::bars::{Against, Run};
use crate::battery::is_senseless;
use crate::build::velocity;
use crate::check::{Check, Row};
use crate::figures::{drive, run};

const COEFFICIENTS: [f64; 4] = [0.0, 0.3, 0.7, 1.0];

fn law(coefficient: f64, capture: Capture) -> Law {
    Law::Restitution(Restitution {
        coefficient,
        capture,
    })
}

/// Rows of an impact of bodies that are rigid at the scale of the step.
fn rigid(coefficient: f64, against: Against) -> Result<[Row; 3], Error> {
    let courant = 1e4;
    let mut case = Run {
        courant,
        against,
        law: law(coefficient, Capture::Half),
        end: 4.0 * courant,
        ..Run::slow(1)
    };
    case.gap = case.set.speed * case.dt() / 3.0;
    let (history, figures) = run(&case)?;
    // in the centre of mass the two bars have half of the striker's energy
    let (name, part) = match against {
        Against::Wall => ("wall", 1.0),
        Against::Bar => ("bars", 0.5),
    };
    let name = format!("{name}, e = {coefficient}");
    let lost = part * (1.0 - coefficient * coefficient);
    let mut last = history.energy[0];
    let mut growth: f64 = 0.0;
    for &energy in &history.energy {
        growth = growth.max((energy - last) / history.energy[0]);
        last = energy;
    }
    Ok([
        Row::near(
            format!("{name}: separation / approach"),
            figures.restitution,
            coefficient,
            1e-6,
        ),
        Row::near(
            format!("{name}: energy lost / E0"),
            -figures.energy_change,
            lost,
            1e-6,
        ),
        Row::at_most(
            format!("{name}: largest growth of energy in a step / E0"),
            growth,
            1e-5,
        ),
    ])
}

/// How many runs with e = 0 differ in a byte from those with the velocity law.
fn differing() -> Result<usize, Error> {
    let mut count = 0;
    for scheme in Scheme::registered() {
        if is_senseless(scheme, law(0.0, Capture::Now)) {
            continue;
        }
        for capture in [Capture::Now, Capture::Half, Capture::Full, Capture::Free] {
            let end = |law| -> Result<Vec<u8>, Error> {
                let case = Run {
                    scheme,
                    law,
                    ..Run::slow(20)
                };
                Ok(drive(&case)?.0.state().to_bytes()?)
            };
            count += usize::from(end(law(0.0, capture))? != end(velocity(capture))?);
        }
    }
    Ok(count)
}

pub(crate) const CHECK: Check = Check {
    name: "restitution",
    fact: "bodies that are rigid in a step separate at e times their approach; e = 0 is the velocity law",
    run: |_| {
        let mut rows = vec![
            Row::count(
                "runs with e = 0 that differ in a byte from the velocity law",
                differing()?,
                0,
            )
            .second_formulation(),
        ];
        for coefficient in COEFFICIENTS {
            for against in [Against::Wall, Against::Bar] {
                rows.extend(rigid(coefficient, against)?);
            }
        }
        Ok(rows)
    },
};
