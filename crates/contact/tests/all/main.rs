//! Facts about gaps, rows and curvature that hold for every kind of face and every integration.

// Helpers of tests panic as the tests themselves do.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod again;
mod carried;
mod certificate;
mod cores;
mod derivatives;
mod edges;
mod fixture;
mod middles;
mod mortar;
mod moving;
mod nearest;
mod pairs;
mod rims;
mod round;
mod round_mortar;
mod search;
mod sides;
mod sight;
mod steep;
mod through;

#[global_allocator]
static COUNTER: carom_testing::Counter = carom_testing::Counter;
