//! Rules of an adaptive step.

use serde::{Deserialize, Serialize};

/// What a contact that closes within a step does to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Closing {
    /// Nothing.
    Pass,
    /// The step is cut before a point in flight closes, so that the closing falls where scheme and law take it best.
    Cut,
}

/// Rules of an adaptive step. The largest one is the step of the model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Adaptive {
    /// No step is cut below this, s: a step that fails here ends the run.
    pub smallest: f64,
    /// What a closing contact does.
    pub closing: Closing,
    /// A step after which the energy that the scheme balances, less the work from outside, exceeds its value at the start by more
    /// than this fraction of the largest energy so far is tried again with half the size.
    pub growth: Option<f64>,
    /// Steps without event after which the size doubles. A point that has carried no force for so many steps of the largest size is
    /// in flight.
    pub patience: u32,
}
