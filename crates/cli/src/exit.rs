//! Exit codes other than 0.

/// Exit code of bad input.
pub const BAD_INPUT: u8 = 2;
/// Exit code of a run that failed.
pub const FAILED: u8 = 3;
/// Exit code of a run or a verification with a quantity out of its bound.
pub const BAD: u8 = 4;
/// Exit code of an interrupted run.
pub const INTERRUPTED: u8 = 130;
