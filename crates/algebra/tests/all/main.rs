//! Facts about factorisations, on systems large enough to show them.

// Helpers of the tests may unwrap as the tests do.
#![allow(clippy::unwrap_used)]

mod block;
mod factor;
mod iterations;
mod nodes;
mod numbers;
mod respond;

#[global_allocator]
static COUNTER: carom_testing::Counter = carom_testing::Counter;
