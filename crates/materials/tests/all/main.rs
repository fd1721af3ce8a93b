//! What every law at finite strain must satisfy, and what single laws are known to do.

// Helpers of the tests may unwrap as the tests do.
#![allow(clippy::unwrap_used)]

mod battery;
mod discrete_gradient;
mod hardening;
mod j2;
mod maxwell;
mod ranges;
mod support;

#[global_allocator]
static COUNTER: carom_testing::Counter = carom_testing::Counter;
