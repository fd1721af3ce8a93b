//! Facts about exact solutions that need no other code.

// Helpers of tests panic as the tests themselves do.
#![allow(clippy::unwrap_used)]

mod bounces;
mod closed_forms;
mod hertz;
mod invariants;
mod sets;
