//! A pulse that runs from a fine mesh into a coarse one and comes back in part.
//!
//! Problem: a bar with elements of h_s / 4 over 40 h_s and of h_s beyond, overlap 4 h_s; theta ½ inside, central differences
//! outside, one step of 0.5 h_s / c, gc. The pulse v = exp(-((x - x0)/w)²) begins 4.5 w before the overlap and is looked at
//! when it has come back as far, after 9 w + 4 h_s: the amplitude is the root of the energy of (v + c u')/2 in the fine
//! zone outside the overlap over that of the pulse. Closed solution: nothing comes back.
//!
//! Reference: the project's table of bars, from an independent implementation, which does not say where a pulse starts and
//! when it is looked at. Pulses of w <= h_s hold waves that the coarse mesh cannot carry, and which arrive late since the
//! fine mesh with this step slows them: for them the amplitude grows with the time. The start and the end above are the
//! ones of simple form that give all twelve numbers.
//! Tolerance: one unit of the printed digit, or 2 % of the number where that is more.

use carom_arlequin::{Coupling, Mediator, Model as Side, Profile, Weighting};
use carom_dynamics::Zones;

use crate::Error;
use crate::check::{Check, Row};
use crate::glued_bar::{GluedBar, characteristics, motion, pulse};

pub(crate) const CHECK: Check = Check {
    name: "arlequin-pulse",
    fact: "a pulse that runs from the fine mesh into the coarse one comes back as little as the table says",
    run: |_| {
        let fine = Coupling {
            mediator: Mediator::Of(Side::Inner),
            ..Coupling::default()
        };
        let constant = Weighting {
            inertia: Profile::Constant(0.5),
            stiffness: Profile::Constant(0.5),
            floor: 0.0,
        };
        let (linear, coarse) = (Weighting::default(), Coupling::default());
        let cases = [
            (
                "linear weights, coarse mediator",
                linear,
                coarse,
                ["0.0023", "0.0037", "0.035", "0.097"],
            ),
            (
                "linear weights, fine mediator",
                linear,
                fine,
                ["0.0024", "0.0091", "0.071", "0.344"],
            ),
            (
                "constant weights, coarse mediator",
                constant,
                coarse,
                ["0.010", "0.029", "0.073", "0.148"],
            ),
        ];
        let mut rows = Vec::new();
        for (name, weighting, coupling, table) in cases {
            let bar = GluedBar {
                weighting,
                coupling,
                ..GluedBar::usual(100)
            };
            for (width, printed) in [4.0, 2.0, 1.0, 0.5].into_iter().zip(table) {
                let quantity = format!("{name}, w = {width} h: amplitude that comes back");
                rows.push(Row::printed_or(
                    quantity,
                    reflected(&bar, width)?,
                    printed,
                    0.02,
                ));
            }
        }
        Ok(rows)
    },
};

/// Amplitude of what comes back of a pulse of this width over the pulse's.
fn reflected(bar: &GluedBar, width: f64) -> Result<f64, Error> {
    let mut zones = Zones::new(&bar.zoned()?)?;
    let border = (bar.zone - bar.overlap) as f64;
    let before = 4.5 * width;
    let start = motion(&zones, pulse(border - before, width));
    zones.restart(&start)?;
    let [_, all] = characteristics(&zones.drivers()[0], 0.0, border);
    while zones.time() < 2.0 * before + bar.overlap as f64 - 1e-9 {
        zones.step()?;
    }
    let [back, _] = characteristics(&zones.drivers()[0], 0.0, border);
    Ok((back / all).sqrt())
}
