//! What the tests of several crates share: an allocator that counts, random numbers from a seed, damaged files. A dev-dependency only.

mod allocations;
pub mod damage;
mod random;

pub use allocations::{Counter, allocations, held};
pub use random::Random;
