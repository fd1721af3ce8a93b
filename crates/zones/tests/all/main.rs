//! Facts about steps of zones that need no exact solution.

// Helpers of tests panic as the tests themselves do.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod allocation;
mod dense;
mod kinds;
mod monolithic;
mod schemes;
mod schemes_apart;
mod stages;
mod standing;
mod turning;
mod whole;
mod zones_nonlinear;

#[global_allocator]
static COUNTER: carom_testing::Counter = carom_testing::Counter;
