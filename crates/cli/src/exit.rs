//! Exit codes other than 0.

/// Exit code of bad input.
pub const BAD_INPUT: u8 = 2;
/// Exit code of a run that failed.
pub const FAILED: u8 = 3;
/// Exit code of a run or a verification with a quantity out of its bound.
pub const BAD: u8 = 4;
/// Exit code of an interrupted run, whichever signal asked for it. A program that SIGTERM kills has 143: this one is not killed, it ends in
/// order and leaves a checkpoint and a summary, which scripts find by one code; and `ctrlc` does not tell which signal came.
pub const INTERRUPTED: u8 = 130;
