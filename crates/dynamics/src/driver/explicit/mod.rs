//! Explicit steps in one pass over the lumped mass.

pub(crate) mod leapfrog;

use crate::shapes::Rates;
use leapfrog::Direct;

/// Explicit steps in one pass over the lumped mass.
pub(crate) struct Explicit {
    /// For steps whose matrix is the lumped mass; none where there are no such steps.
    pub(crate) direct: Option<Direct>,
    pub(crate) rates: Rates,
}
