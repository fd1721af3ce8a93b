//! The README's two commands, word for word: in `xtask`, in `.ci/run`, and in the README.

/// The main job.
pub const RUN: &str = "cargo run --release -- run cases/two-bars/case.toml";

/// The tests.
pub const TEST: &str = "cargo test --release --workspace";
