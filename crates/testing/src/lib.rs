//! What the tests of several crates share: an allocator that counts, random numbers from a seed. A dev-dependency only.

mod allocations;
mod random;

pub use allocations::{Counter, allocations, held};
pub use random::Random;
