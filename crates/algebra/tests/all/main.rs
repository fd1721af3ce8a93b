//! Facts about factorisations, on systems large enough to show them.

// Helpers of the tests may unwrap as the tests do.
#![allow(clippy::unwrap_used)]

mod block;
mod counter;
mod factor;
mod numbers;
mod respond;
