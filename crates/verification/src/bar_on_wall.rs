//! A bar on a rigid wall.
//!
//! Problem: set "sdnv100" of the public tests: L = 0.2 m, A = 4e-4 m², E = 2e11 Pa, ρ = 8000 kg/m³, c = 5000 m/s, 100 m/s
//! towards a rigid plane 2 mm away; theta ½, velocity law, CFL 0.5, lumped mass. Closed solution: F = Z v0 = 1.6e6 N from
//! gap / v0 = 2e-5 s for 2 L / c to 1e-4 s, impulse 2 m v0 = 128 N s; the scheme loses √(μ + θ² CFL²)/n of the energy in
//! the impact step and nothing else. Reference: carom_exact. Tolerance: the closing within a step (the law captures it
//! half a step ahead); the impulse 1 % at n = 100, 0.5 % at n = 400, and the release 2 % and 0.5 % of the duration,
//! for the spread front (see the convergence of two bars); the mean force in contact without its last tenth, where the front
//! comes back, 1 %; the loss 1e-10, round-off of its small difference.

use carom_exact::closed_forms::{Mass, theta_impact_loss_on_wall};

use crate::bars::{Against, Run, Set};
use crate::check::{Check, Row, Size};
use crate::figures::drive;

/// The set "sdnv100".
const SDNV100: Set = Set {
    length: 0.2,
    area: 4e-4,
    young: 2e11,
    density: 8000.0,
    speed: 100.0,
};

pub(crate) const CHECK: Check = Check {
    name: "bar-on-wall",
    fact: "a bar leaves a rigid wall with the impulse, the times and the loss of the exact solution",
    run: |size| {
        let (elements, impulse, release) = match size {
            Size::Quick => (100, 0.01, 0.02),
            Size::Full => (400, 0.005, 0.005),
        };
        let case = Run {
            set: SDNV100,
            elements,
            against: Against::Wall,
            gap: 2e-3,
            end: 2.0,
            ..Run::slow(elements)
        };
        let (driver, history) = drive(&case)?;
        let exact = case.exact(case.end * case.set.duration())?;
        let contact = exact.contacts()[0];
        let state = driver.state();
        let record = &state.records.contacts[0];
        let closing = record.first_closing.unwrap_or(f64::NAN);
        let opening = record.last_force.unwrap_or(f64::NAN);
        let duration = contact.end - contact.start;
        let steady: Vec<f64> = history
            .time
            .iter()
            .zip(&history.force)
            .filter(|(end, _)| **end > contact.start && **end < contact.start + 0.9 * duration)
            .map(|(_, force)| *force)
            .collect();
        let mean = steady.iter().sum::<f64>() / steady.len() as f64;
        let (start, end) = (&state.ledger.initial, &state.ledger.balance);
        let loss = 1.0 - end.energy() / start.energy();
        let expected = theta_impact_loss_on_wall(Mass::Lumped, 0.5, case.courant, elements);
        Ok(vec![
            Row::near("closing, s", closing, 2e-5, case.dt()),
            Row::near("release, s", opening, 1e-4, release * duration),
            Row::relative("impulse, N s", record.impulse(), 128.0, impulse),
            Row::relative(
                "impulse of the exact solution, N s",
                contact.impulse,
                128.0,
                1e-12,
            ),
            Row::relative("mean force in contact, N", mean, case.force(), 0.01),
            Row::near("energy lost / E0", loss, expected, 1e-10),
            Row::count("impacts in the table", state.records.ended().count(), 1),
            Row::relative(
                "approach velocity of the impact, m/s",
                state
                    .records
                    .ended()
                    .next()
                    .map_or(f64::NAN, |impact| impact.approach),
                case.set.speed,
                1e-11,
            ),
        ])
    },
};
