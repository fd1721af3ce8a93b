//! A bar on a spring: the penalty law and the stop.
//!
//! Problem: a bar of the set "slow", lumped mass, CFL 0.5, meets a rigid plane through a penalty k, with or without a
//! damper, or a stop with a clearance and a curve of two pieces. Closed solution: until the front comes back, at 2 L / c, the
//! bar is an impedance Z. Each stiffness K gives F' = K (v0 - F / Z), so that Z v0 - F falls as exp(-K t / Z) within a
//! piece, and with a damper C F = Z v0 (1 - (Z / (Z + C)) exp(-K t / (Z + C))). Reference: the formulas, as the mean over each
//! step with theta and over the time half a step later with the others, whose force stands at the end of the step;
//! Z / K = 0.05 of the contact, a third of that in the second piece of the stop, which begins at half of Z v0; C = Z. The
//! relative L2 error of the force falls like n^-2, for laws in the gap hold where the scheme takes internal forces; with a damper,
//! where the force itself jumps within a step, like n^-1/2. Three quarters of these exponents are asked for. Energy and momentum
//! balances to round-off. Sizes: quick n = 100 and 200, full 100 and 400.

use carom_contact::Law;
use carom_contact::law::{Adhesion, Crush, Curve, Damped, Penalty, Stop};
use carom_dynamics::Scheme;

use crate::Error;
use crate::bars::{Against, Run};
use crate::build::{CENTRAL, newmark, theta};
use crate::check::{Check, Row, Size};
use crate::figures::run;

/// What the bar meets, with stiffness K in N/m and damping C in N s/m of the contact as a whole.
#[derive(Clone, Copy)]
enum Spring {
    Penalty,
    PenaltyWithDamper,
    Stop,
}

/// Stiffness of the first piece, N/m: the time constant Z / K is 0.05 of the contact.
fn stiffness(case: &Run) -> f64 {
    10.0 * case.set.impedance() / (0.5 * case.set.duration())
}

impl Spring {
    fn name(self) -> &'static str {
        match self {
            Spring::Penalty => "penalty",
            Spring::PenaltyWithDamper => "penalty with damper",
            Spring::Stop => "stop",
        }
    }

    /// C in units of Z.
    fn damping(self) -> f64 {
        match self {
            Spring::PenaltyWithDamper => 1.0,
            Spring::Penalty | Spring::Stop => 0.0,
        }
    }

    fn law(self, case: &Run) -> Result<Law, Error> {
        let (k, area, z) = (stiffness(case), case.set.area, case.set.impedance());
        let half = 0.5 * z * case.set.speed;
        Ok(match self {
            Spring::Penalty | Spring::PenaltyWithDamper => Law::Penalty(Penalty(Damped {
                stiffness: k / area,
                damping: self.damping() * z / area,
                adhesion: Adhesion::AsPrinted,
            })),
            Spring::Stop => Law::Stop(Stop {
                clearance: 7.3 * case.set.speed * case.dt(),
                curve: Curve::new(&[[half / k, half], [4.0 / 3.0 * half / k, 2.0 * half]])?,
                crush: Crush::Recovered,
                damping: 0.0,
                adhesion: Adhesion::AsPrinted,
            }),
        })
    }

    /// ∫ F dt from the contact to a time after it in s, N s.
    fn impulse(self, case: &Run, time: f64) -> f64 {
        let (z, k) = (case.set.impedance(), stiffness(case));
        let full = z * case.set.speed;
        // Z v0 - F = rest exp(-t / tau) from a time on
        let piece = |rest: f64, tau: f64, t: f64| full * t - rest * tau * (1.0 - (-t / tau).exp());
        let c = self.damping() * z;
        let (rest, tau) = (full * z / (z + c), (z + c) / k);
        // the second piece of the stop, three times as stiff
        let kink = match self {
            Spring::Stop => tau * 2.0_f64.ln(),
            Spring::Penalty | Spring::PenaltyWithDamper => f64::INFINITY,
        };
        if time <= 0.0 {
            0.0
        } else if time <= kink {
            piece(rest, tau, time)
        } else {
            piece(rest, tau, kink) + piece(0.5 * full, tau / 3.0, time - kink)
        }
    }
}

/// Relative L2 error of the force until just before the front is back, with the balances. `shift`: what is added to the
/// span of a step to find that of its force, in steps.
fn run_on(
    spring: Spring,
    (scheme, shift): (Scheme, f64),
    elements: usize,
) -> Result<(f64, [Row; 2]), Error> {
    let base = Run {
        scheme,
        against: Against::Wall,
        ..Run::slow(elements)
    };
    let law = spring.law(&base)?;
    let case = Run { law, ..base };
    let start = match law {
        Law::Stop(stop) => stop.clearance / case.set.speed,
        _ => 0.0,
    };
    let (history, figures) = run(&case)?;
    let (mut error, mut norm) = (0.0, 0.0);
    for (&end, force) in history.time.iter().zip(&history.force) {
        let after = end + shift * case.dt() - start;
        if after < 0.95 * case.set.duration() {
            let mean = (spring.impulse(&case, after) - spring.impulse(&case, after - case.dt()))
                / case.dt();
            error += (force - mean).powi(2);
            norm += mean * mean;
        }
    }
    let name = format!("{}, {}, n = {elements}", spring.name(), scheme.get().name());
    Ok(((error / norm).sqrt(), figures.balances(&name)))
}

fn rows(spring: Spring, scheme: (Scheme, f64), size: Size) -> Result<Vec<Row>, Error> {
    let (coarse, fine) = match size {
        Size::Quick => (100, 200),
        Size::Full => (100, 400),
    };
    let order = if spring.damping() > 0.0 { 0.5 } else { 2.0 };
    let (before, balances) = run_on(spring, scheme, coarse)?;
    let mut rows = balances.to_vec();
    let (after, balances) = run_on(spring, scheme, fine)?;
    rows.extend(balances);
    let name = format!("{}, {}: force error", spring.name(), scheme.0.get().name());
    let bound = (coarse as f64 / fine as f64).powf(0.75 * order);
    rows.extend([
        Row::shown(format!("{name}, n = {fine}"), after),
        Row::at_most(
            format!("{name}, n = {fine} / n = {coarse}"),
            after / before,
            bound,
        ),
    ]);
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "bar-on-stop",
    fact: "a bar on a spring, on a spring with a damper, on a stop with a curve, presses as in the closed form",
    run: |size| {
        let mut all = Vec::new();
        for spring in [Spring::Penalty, Spring::PenaltyWithDamper, Spring::Stop] {
            for scheme in [(theta(0.5), 0.0), (newmark(0.25, 0.5), 0.5), (CENTRAL, 0.5)] {
                all.extend(rows(spring, scheme, size)?);
            }
        }
        Ok(all)
    },
};
