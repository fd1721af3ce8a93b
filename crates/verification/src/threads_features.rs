//! Runs with each feature on one thread and on two.
//!
//! Problem: the models of [`crate::features`], nine times as fine, so that each block has more than the 256 elements that one chunk of a sum
//! has; the hairpin four times as fine. Closed solution: sums have a fixed order, so the number of threads changes no bit.
//! Reference: the run on one thread, a second formulation. Tolerance: none, bytes are equal or not.
//! Sizes: quick 6 steps of every fifth model without hairpin, full 8 of every third, and the hairpin until its prongs have met.

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::Error;
use crate::check::{Check, Size};
use crate::features::{Built, Feature};
use crate::repeated::{End, Pairs, advance, end, rows};

pub(crate) const CHECK: Check = Check {
    name: "threads-features",
    fact: "runs with friction, large strain, mortar, zones and the like on one thread and on two end in the same bytes",
    run: |size| {
        let pools = [pool(1)?, pool(2)?];
        let of_pin = |feature| feature == Feature::SelfContact;
        let (steps, stride) = match size {
            Size::Quick => (6, 5),
            Size::Full => (8, 3),
        };
        let blocks = |pairs: &mut Pairs, feature: Feature, built: &Built| match of_pin(feature) {
            true => Ok(()),
            false => compared(pairs, &pools, built, steps),
        };
        let mut all = rows(22, (stride, 9), blocks)?;
        if size == Size::Full {
            all.extend(rows(1, (8, 4), |pairs, feature, built| {
                match of_pin(feature) {
                    true => compared(pairs, &pools, built, 110),
                    false => Ok(()),
                }
            })?);
        }
        Ok(all)
    },
};

fn compared(
    pairs: &mut Pairs,
    pools: &[ThreadPool; 2],
    built: &Built,
    steps: u64,
) -> Result<(), Error> {
    let run = |pool: &ThreadPool| -> Result<End, Error> {
        pool.install(|| {
            let mut run = built.start()?;
            advance(run.as_mut(), steps)?;
            end(run.as_ref())
        })
    };
    pairs.compare_ends(&run(&pools[0])?, &run(&pools[1])?);
    Ok(())
}

fn pool(threads: usize) -> Result<ThreadPool, Error> {
    Ok(ThreadPoolBuilder::new().num_threads(threads).build()?)
}
