//! Runs that are cut and resumed.
//!
//! Problem: two bars of the set "slow", n = 20, and two blocks with meshes that do not match, one coming down sideways on
//! the other and paired at every step; every registered scheme with every law; cuts while the bodies press, when they
//! part, and later. Closed solution: a state written as bytes, read back and gone on with by a new driver ends in the
//! bytes of the run that was not cut. Combinations without meaning are refused, and only they: explicit schemes with
//! the displacement law. Reference: the run that was not cut. Tolerance: none, bytes are equal or not.

use std::sync::Arc;

use carom_contact::Sliding;
use carom_dynamics::{Driver, Scheme, State, System};

use crate::Error;
use crate::bars::{Run, SLOW};
use crate::battery::{Battery, is_senseless, laws};
use crate::blocks::{RUBBER, SMALLEST};
use crate::check::{Check, Row};

/// Steps of the bars' runs, and where they are cut: contact lasts 80 steps.
const BARS: (u64, [u64; 4]) = (120, [1, 30, 60, 90]);
/// The same of the blocks, which press for about 12 steps.
const BLOCKS: (u64, [u64; 4]) = (40, [1, 5, 10, 25]);

pub(crate) const CHECK: Check = Check {
    name: "resume",
    fact: "runs that were cut and resumed from bytes end in the bytes of those that were not",
    run: |_| {
        let (mut bars, mut solids) = (Battery::default(), Battery::default());
        let mut combinations = 0;
        for scheme in Scheme::registered() {
            for (_, law) in laws(&SLOW.material(), SLOW.length / 20.0) {
                combinations += usize::from(!is_senseless(scheme, law));
                let case = Run {
                    scheme,
                    law,
                    ..Run::slow(20)
                };
                if let Some(system) = bars.system(case.model()?)? {
                    cuts(&mut bars, &system, BARS)?;
                }
            }
            for (_, law) in laws(&RUBBER, 0.2) {
                let model = SMALLEST.model(scheme, law, Sliding::Finite)?;
                if let Some(system) = solids.system(model)? {
                    cuts(&mut solids, &system, BLOCKS)?;
                }
            }
        }
        let mut rows: Vec<Row> = bars.rows("bars", 4 * combinations);
        rows.extend(solids.rows("blocks", 4 * combinations));
        Ok(rows)
    },
};

/// Compares the run of so many steps with those cut after so many.
fn cuts(
    battery: &mut Battery,
    system: &Arc<System>,
    (steps, cuts): (u64, [u64; 4]),
) -> Result<(), Error> {
    let mut driver = Driver::new(system.clone())?;
    advance(&mut driver, steps)?;
    let whole = driver.state();
    for cut in cuts {
        let mut driver = Driver::new(system.clone())?;
        advance(&mut driver, cut)?;
        let bytes = driver.state().to_bytes()?;
        let mut driver = Driver::resume(system.clone(), State::from_bytes(system, &bytes)?)?;
        advance(&mut driver, steps)?;
        battery.compare(whole, driver.state())?;
    }
    Ok(())
}

/// Steps until so many have been taken since the start of the run.
pub(crate) fn advance(driver: &mut Driver, steps: u64) -> Result<(), Error> {
    while driver.state().step < steps {
        driver.step()?;
    }
    Ok(())
}
