//! Runs that are cut and resumed.
//!
//! Problem: two bars of the set "slow", n = 8, and two blocks with meshes that do not match, one coming down sideways on
//! the other and paired at every step; every registered scheme with every law; cuts while the bodies press, when they
//! part, and later, gone on with to the end, and a cut before every step, gone on with for that step. Closed solution: a state written as bytes, read back and gone on with by a new driver ends in the
//! bytes of the run that was not cut. Combinations without meaning are refused, and only they: explicit schemes with
//! the displacement law. Reference: the run that was not cut, a second formulation. Tolerance: none, bytes are equal or not.

use std::sync::Arc;

use carom_contact::Sliding;
use carom_dynamics::{Driver, Scheme, State, System};

use crate::Error;
use crate::bars::{Run, SLOW};
use crate::battery::{Battery, is_senseless, laws};
use crate::blocks::{FACE, FINER, RUBBER, SMALLEST};
use crate::build::{DISPLACEMENT, newmark};
use crate::check::{Check, Row};

/// Elements of each bar.
const ELEMENTS: usize = 8;
/// Steps of the bars' runs, and where they are cut: contact lasts 32 steps.
const BARS: (u64, [u64; 4]) = (40, [1, 12, 24, 36]);
/// The same of the blocks, which press for about 12 steps.
const BLOCKS: (u64, [u64; 4]) = (16, [1, 5, 10, 14]);

pub(crate) const CHECK: Check = Check {
    name: "resume",
    fact: "runs that were cut and resumed from bytes end in the bytes of those that were not",
    run: |_| {
        let (mut bars, mut solids) = (Battery::default(), Battery::default());
        let mut combinations = 0;
        for scheme in Scheme::registered() {
            for (_, law) in laws(&SLOW.material(), SLOW.length / ELEMENTS as f64, SLOW.area)? {
                combinations += usize::from(!is_senseless(scheme, law));
                let case = Run {
                    scheme,
                    law,
                    ..Run::slow(ELEMENTS)
                };
                if let Some(system) = bars.system(case.model()?)? {
                    cuts(&mut bars, &system, BARS)?;
                }
            }
            for (_, law) in laws(&RUBBER, 0.2, FACE)? {
                let model = SMALLEST.model(scheme, law, Sliding::Finite)?;
                if let Some(system) = solids.system(model)? {
                    cuts(&mut solids, &system, BLOCKS)?;
                }
            }
        }
        combinations += 1;
        let massless = Run {
            scheme: newmark(0.25, 0.5),
            law: DISPLACEMENT,
            massless: true,
            ..Run::slow(ELEMENTS)
        };
        cuts(&mut bars, &crate::witness::system(massless.model()?)?, BARS)?;
        let mut model = FINER.model(massless.scheme, DISPLACEMENT, Sliding::Finite)?;
        model.contacts[0].massless = true;
        cuts(&mut solids, &crate::witness::system(model)?, BLOCKS)?;
        let mut rows: Vec<Row> = bars.rows("bars", 4 * combinations);
        rows.extend(solids.rows("blocks", 4 * combinations));
        Ok(rows)
    },
};

/// Compares the run of so many steps with those cut after so many, and each of its steps with that step taken by a new
/// driver.
pub(crate) fn cuts(
    battery: &mut Battery,
    system: &Arc<System>,
    (steps, cuts): (u64, [u64; 4]),
) -> Result<(), Error> {
    let mut whole = Driver::new(system.clone())?;
    let mut resumed = Vec::new();
    while whole.state().step < steps {
        let mut driver = renewed(system, &whole)?;
        whole.step()?;
        driver.step()?;
        if cuts.contains(&driver.state().step) {
            resumed.push(renewed(system, &driver)?);
        }
        battery.compare_step(whole.state(), driver.state())?;
    }
    for mut driver in resumed {
        advance(&mut driver, steps)?;
        battery.compare(whole.state(), driver.state())?;
    }
    Ok(())
}

/// A new driver that goes on from the bytes of the state of another.
fn renewed(system: &Arc<System>, driver: &Driver) -> Result<Driver, Error> {
    let bytes = driver.state().to_bytes()?;
    Ok(Driver::resume(
        system.clone(),
        State::from_bytes(system, &bytes)?,
    )?)
}

/// Steps until so many have been taken since the start of the run.
pub(crate) fn advance(driver: &mut Driver, steps: u64) -> Result<(), Error> {
    while driver.state().step < steps {
        driver.step()?;
    }
    Ok(())
}
