//! Tests of the reader of MED files, with the feature `hdf5`.
#![cfg(feature = "hdf5")]
// Clippy's exemption for tests covers the test functions, not their helpers.
#![allow(clippy::unwrap_used)]

#[path = "../../mesh/tests/damage.rs"]
mod damage;
mod med;
