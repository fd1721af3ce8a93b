//! Runs with each feature that are cut and resumed.
//!
//! Problem: the models of [`crate::features`] (friction, finite strain, plasticity, viscoelasticity, mortar, finite sliding, surfaces that face
//! themselves, adaptive steps, zones, static stages, massless nodes, reduced bodies), as `resume` has them of linear bodies. Closed solution: what the next
//! step needs is in the state, so that the bytes of the state, read by a new run, give the same bytes after a step and at the
//! end. Reference: the run that was not cut, a second formulation. Tolerance: none, bytes are equal or not.

use crate::Error;
use crate::check::Check;
use crate::features::{Built, Feature};
use crate::repeated::{Pairs, advance, rows, stride};

pub(crate) const CHECK: Check = Check {
    name: "resume-features",
    fact: "runs with friction, large strain, mortar, zones and the like, cut and resumed from bytes, end in the same bytes",
    run: |size| rows(23, (stride(size), 1), resumed),
};

/// Compares each step of the run with that step taken by a new driver from the bytes before it, and the end with that of a run
/// cut in its middle.
fn resumed(pairs: &mut Pairs, feature: Feature, built: &Built) -> Result<(), Error> {
    let mut whole = built.start()?;
    let mut cut = None;
    while whole.state().step < feature.steps() {
        let mut other = built.resume(&whole.saved()?)?;
        whole.step()?;
        other.step()?;
        pairs.compare_step(whole.as_ref(), other.as_ref())?;
        if whole.state().step == feature.steps() / 2 {
            cut = Some(built.resume(&other.saved()?)?);
        }
    }
    match cut {
        Some(mut cut) => {
            advance(cut.as_mut(), feature.steps())?;
            pairs.compare(whole.as_ref(), cut.as_ref())
        }
        None => Ok(()),
    }
}
