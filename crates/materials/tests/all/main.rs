//! What every law at finite strain must satisfy, and what single laws are known to do.

// Helpers of the tests may unwrap as the tests do.
#![allow(clippy::unwrap_used)]

mod battery;
mod discrete_gradient;
mod support;
