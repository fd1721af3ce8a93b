//! Integration tests of the crate, one binary for all.

// Clippy's exemption for tests covers the test functions, not their helpers.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod bars;
mod beam;
mod corner;
mod patch;
mod products;
mod refusals;
mod support;
mod trace;
mod weights;
