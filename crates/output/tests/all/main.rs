//! What the files say, read back by code that shares nothing with the writers.

// The lint takes helper functions for library code.
#![allow(clippy::unwrap_used)]

mod figures;
mod files;
mod grids;
mod large;
mod models;
mod page;
mod pages;
mod runs;
mod tables;
mod windows;
mod zones;
