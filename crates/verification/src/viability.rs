//! How deep the velocity law lets bodies penetrate, for impacts at any instant of a step.
//!
//! Problem: two bars of the set "slow", n = 20, at CFL 0.5 and 0.25, met at 20 instants spread over a step, each capture,
//! theta ½, ¾ and 1, until half of the contact. Closed solution: no penetration beyond (2 - θ) v0 dt with capture "now",
//! (3/2 - θ) v0 dt with "half", (1 - θ) v0 dt where the gap at the end of the step decides ("free", "gap-target"): the
//! approach of the part of the step that comes before the captured instant, and of the part (1 - θ) that the theta scheme
//! moves with the old rate. "Full" closes too early, then predicts that a point at rest stays there and lets go of it: up to
//! v0 dt whatever θ. Reference: the formulas. Tolerance: 1e-9 of v0 dt, round-off; the largest penetration
//! over the instants at least 0.9 of the bound where the first step of contact makes it (20 instants come within a
//! fiftieth of a twentieth of the worst one), so that it halves with dt. The schemes that
//! are theta ½ without their damping, nonsmooth generalised-alpha and Krenk, have no bound of their own: by how much they pass that of
//! theta ½ at ρ∞ = 0.8 is a regression, to 1e-4 of v0 dt.

use carom_contact::law::Capture;
use carom_dynamics::Scheme;
use carom_dynamics::scheme::{Krenk, NonsmoothAlpha};

use crate::Error;
use crate::bars::Run;
use crate::build::{theta, velocity};
use crate::check::{Check, Row};
use crate::figures::drive;

const INSTANTS: usize = 20;

/// Captures with a and b of their bound (a - b θ) v0 dt, and whether the first step of contact reaches it.
const CAPTURES: [(&str, Capture, [f64; 2], bool); 5] = [
    ("now", Capture::Now, [2.0, 1.0], true),
    ("half", Capture::Half, [1.5, 1.0], true),
    ("full", Capture::Full, [1.0, 0.0], false),
    ("free", Capture::Free, [1.0, 1.0], true),
    ("gap-target", Capture::GapTarget, [1.0, 1.0], true),
];

/// Largest penetration over the instants, in v0 dt.
fn deepest(capture: Capture, scheme: Scheme, courant: f64) -> Result<f64, Error> {
    let mut deepest: f64 = 0.0;
    for instant in 0..INSTANTS {
        let mut case = Run {
            scheme,
            law: velocity(capture),
            courant,
            end: 0.5,
            ..Run::slow(20)
        };
        let step = case.set.speed * case.dt();
        case.gap = (3.0 + (instant as f64 + 0.02) / INSTANTS as f64) * step;
        let (driver, _) = drive(&case)?;
        deepest = deepest.max(driver.state().records.contacts[0].penetration / step);
    }
    Ok(deepest)
}

pub(crate) const CHECK: Check = Check {
    name: "viability",
    fact: "penetration keeps the bound of each capture at every instant of impact, and halves with the step",
    run: |_| {
        let mut rows = Vec::new();
        for (name, capture, [a, b], reached) in CAPTURES {
            for value in [0.5, 0.75, 1.0] {
                let bound = a - b * value;
                for courant in [0.5, 0.25] {
                    let name =
                        format!("{name}, theta {value}, CFL {courant}: penetration / (v0 dt)");
                    let found = deepest(capture, theta(value), courant)?;
                    rows.push(Row::at_most(&name, found, bound + 1e-9));
                    if reached {
                        rows.push(Row::at_least(name, found, 0.9 * bound));
                    }
                }
            }
        }
        for (scheme, own) in [
            (
                Scheme::NonsmoothAlpha(NonsmoothAlpha { rho_inf: 0.8 }),
                0.00239,
            ),
            (Scheme::Krenk(Krenk { rho_inf: 0.8 }), 0.00221),
        ] {
            let mut excess = f64::NEG_INFINITY;
            for (_, capture, [a, b], _) in CAPTURES {
                for courant in [0.5, 0.25] {
                    let found = deepest(capture, scheme, courant)?;
                    excess = excess.max(found - (a - 0.5 * b));
                }
            }
            let name = format!("{scheme:?}: penetration / (v0 dt) beyond the bound of theta 0.5");
            rows.push(Row::near(name, excess, own, 1e-4).regression());
        }
        Ok(rows)
    },
};
