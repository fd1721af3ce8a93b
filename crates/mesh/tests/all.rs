//! Integration tests of the crate, one binary for all.

// Clippy's exemption for tests covers the test functions, not their helpers.
#![allow(clippy::unwrap_used)]

mod damage;
mod gmsh;
mod inp;
mod vtu;
