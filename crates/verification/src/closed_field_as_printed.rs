//! Negative control: the closed field (7.d) of the paper, read as it is printed.
//!
//! Problem: two bars of the set "slow", theta ½, CFL 0.5, velocity law with S_d = 1 where the gap is OPEN or just
//! touching. Closed solution: only the first step, where the gap is zero, meets contact; its force F1 takes the
//! momentum F1 dt from one bar of mass m to the other, and the bars pass through each other: restitution
//! -(1 - 2 F1 dt / (m v0)) with F1 / F0 of the first step in closed form. Reference: carom_exact, and -0.997 of the
//! project's table. Tolerance: 1e-11, round-off of some thousand steps.

use carom_contact::Law;
use carom_contact::law::{Capture, Reading, Velocity};
use carom_exact::closed_forms::{Mass, theta_first_force};

use crate::bars::Run;
use crate::check::{Check, Row};
use crate::figures::run;
use crate::kind::Kind;

pub(crate) const CHECK: Check = Check {
    name: "closed-field-as-printed",
    fact: "with (7.d) as printed two bars pass through each other",
    run: |_| {
        let base = Run::slow(200);
        let case = Run {
            law: Law::Velocity(Velocity {
                capture: Capture::Now,
                reading: Reading::AsPrinted,
            }),
            ..base
        };
        let (_, figures) = run(&case)?;
        let first = theta_first_force(Mass::Lumped, 0.5, base.courant) * base.force();
        let mass = base.set.density * base.set.area * base.set.length;
        let expected = -(1.0 - 2.0 * first * base.dt() / (mass * base.set.speed));
        Ok(vec![
            Row::printed(
                Kind::OtherCode,
                "restitution",
                figures.restitution,
                "-0.997",
            ),
            Row::near(
                "restitution, closed form",
                figures.restitution,
                expected,
                1e-11,
            ),
        ])
    },
};
