//! The program as a user meets it.

// Helpers of tests panic as the tests themselves do.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod bad_input;
mod before;
mod commands;
mod compare;
mod expectations;
mod folders;
mod inputs;
mod resume;
mod run;
mod streams;
mod thin_cases;
