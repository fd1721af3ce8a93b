//! Runs with each feature in which steps are dropped and taken again.
//!
//! Problem: the models of [`crate::features`], which drop no steps by themselves; each third step, of zones with unequal steps each third
//! outer step, is attempted, dropped, and attempted again with the same size. Closed solution: a dropped step leaves nothing behind. Reference: the run without rejections,
//! a second formulation. Tolerance: none, bytes are equal or not.

use carom_zones::Whole;

use crate::Error;
use crate::check::Check;
use crate::features::{Built, Feature};
use crate::repeated::{Pairs, advance, rows, stride};

pub(crate) const CHECK: Check = Check {
    name: "rejections-features",
    fact: "runs with friction, large strain, mortar and the like in which steps are dropped end in the same bytes",
    run: |size| rows(23, (stride(size), 1), rejected),
};

fn rejected(pairs: &mut Pairs, feature: Feature, built: &Built) -> Result<(), Error> {
    if let Built::Zoned(zoned, system) = built {
        let start = || Whole::new(zoned, system.clone());
        let (mut plain, mut twice) = (start()?, start()?);
        advance(&mut plain, feature.steps())?;
        twice.force_rejections(3);
        advance(&mut twice, feature.steps())?;
        return pairs.compare(&plain, &twice);
    }
    let (mut plain, mut twice) = (built.driver()?, built.driver()?);
    advance(&mut plain, feature.steps())?;
    twice.force_rejections(3);
    advance(&mut twice, feature.steps())?;
    pairs.compare(&plain, &twice)
}
