//! Whether surfaces pass through each other in a step.

mod core;
mod look;
mod pair;

pub use core::Core;
pub use look::{Look, Meeting, Moved, Room, look, overlap};
pub use pair::{Moving, meeting};
