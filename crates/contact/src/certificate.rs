//! Whether surfaces pass through each other in a step.

mod pair;

pub use pair::{Moving, meeting};
