//! Facts about the weak form on faces of meshes.

// Helpers of tests panic as the tests themselves do.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod curved;
mod lumped;
mod weak_form;
