//! Steps that are dropped and taken again.
//!
//! Problem: two bars of the set "slow", n = 20, and two blocks that slide on each other, every registered scheme with every
//! law; each third step is attempted, dropped, and attempted again with the same size. Closed solution: a dropped step
//! leaves nothing behind, so the end is that of the run without rejections. Reference: that run, a second formulation. Tolerance:
//! none, bytes are equal or not.

use std::sync::Arc;

use carom_contact::Sliding;
use carom_dynamics::{Driver, Scheme, System};

use crate::Error;
use crate::bars::{Run, SLOW};
use crate::battery::{Battery, is_senseless, laws};
use crate::blocks::{FACE, RUBBER, SMALLEST};
use crate::check::{Check, Row};
use crate::resume::advance;

/// Steps of the runs of the bars and of the blocks.
const STEPS: [u64; 2] = [120, 30];

pub(crate) const CHECK: Check = Check {
    name: "rejections",
    fact: "a run in which every third step is dropped once and taken again ends in the bytes of the one without",
    run: |_| {
        let (mut bars, mut solids) = (Battery::default(), Battery::default());
        let mut combinations = 0;
        for scheme in Scheme::registered() {
            for (_, law) in laws(&SLOW.material(), SLOW.length / 20.0, SLOW.area)? {
                combinations += usize::from(!is_senseless(scheme, law));
                let case = Run {
                    scheme,
                    law,
                    ..Run::slow(20)
                };
                if let Some(system) = bars.system(case.model()?)? {
                    rejected(&mut bars, &system, STEPS[0])?;
                }
            }
            for (_, law) in laws(&RUBBER, 0.2, FACE)? {
                let model = SMALLEST.model(scheme, law, Sliding::Finite)?;
                if let Some(system) = solids.system(model)? {
                    rejected(&mut solids, &system, STEPS[1])?;
                }
            }
        }
        let mut rows: Vec<Row> = bars.rows("bars", combinations);
        rows.extend(solids.rows("blocks", combinations));
        Ok(rows)
    },
};

fn rejected(battery: &mut Battery, system: &Arc<System>, steps: u64) -> Result<(), Error> {
    let mut plain = Driver::new(system.clone())?;
    advance(&mut plain, steps)?;
    let mut twice = Driver::new(system.clone())?;
    twice.force_rejections(3);
    advance(&mut twice, steps)?;
    battery.compare(plain.state(), twice.state())
}
