//! Runs on one thread and on two.
//!
//! Problem: two blocks with meshes that do not match, one coming down sideways on the other and paired at every step, of
//! 261 and 260 elements in long columns: forces are summed in chunks of 256, and columns of the compliance computed in groups, which
//! threads share. Every registered scheme with every kind of law. Closed solution: sums have a fixed order, so the number of
//! threads changes no bit. Reference: the run on one thread, a second formulation. Tolerance: none, bytes are equal
//! or not.
//! Sizes: quick 3 steps with one law of each kind, full 60 steps with all.

use std::sync::Arc;

use carom_contact::Sliding;
use carom_dynamics::{Driver, Scheme, State, System};
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::Error;
use crate::battery::{Battery, is_senseless, laws};
use crate::blocks::{Blocks, FACE, RUBBER, SMALLEST};
use crate::check::{Check, Size};
use crate::resume::advance;

const BLOCKS: Blocks = Blocks {
    elements: [[3, 3, 29], [2, 2, 65]],
    ..SMALLEST
};

pub(crate) const CHECK: Check = Check {
    name: "threads",
    fact: "runs on one thread and on two end in the same bytes",
    run: |size| {
        let (steps, parameters) = match size {
            Size::Quick => (3, 1),
            Size::Full => (60, usize::MAX),
        };
        let [one, two] = [pool(1)?, pool(2)?];
        let mut battery = Battery::default();
        let mut combinations = 0;
        for scheme in Scheme::registered() {
            let mut kinds = Vec::new();
            for (_, law) in laws(&RUBBER, 0.4 / 29.0, FACE)? {
                let kind = law.get().name();
                kinds.push(kind);
                if kinds.iter().filter(|other| **other == kind).count() > parameters {
                    continue;
                }
                combinations += usize::from(!is_senseless(scheme, law));
                let model = BLOCKS.model(scheme, law, Sliding::Finite)?;
                let again = model.clone();
                if let Some(system) = one.install(|| battery.system(model))? {
                    let second = two.install(|| crate::witness::system(again))?;
                    let states = [run(&one, &system, steps)?, run(&two, &second, steps)?];
                    battery.compare(&states[0], &states[1])?;
                }
            }
        }
        Ok(battery.rows("one and two threads", combinations))
    },
};

pub(crate) fn pool(threads: usize) -> Result<ThreadPool, Error> {
    Ok(ThreadPoolBuilder::new().num_threads(threads).build()?)
}

pub(crate) fn run(pool: &ThreadPool, system: &Arc<System>, steps: u64) -> Result<State, Error> {
    pool.install(|| {
        let mut driver = Driver::new(system.clone())?;
        advance(&mut driver, steps)?;
        Ok(driver.state().clone())
    })
}
