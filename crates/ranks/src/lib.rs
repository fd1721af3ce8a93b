//! Processes that compute one run together, their *ranks*: who has which elements, and the messages between them.
//!
//! [`Ranks`] is what the rest of the program sees, in one process too. A [`Link`] carries the messages: the crate `mpi` has that of MPI,
//! and [`threads`] the one between the threads of one process, for tests without MPI.

mod engine;
mod link;
pub mod memory;
mod partition;
mod threads;

pub use engine::{Engine, Graph, OwnRows, Unsolved};
pub use link::{Link, Message, Ranks};
pub use partition::partition;
pub use threads::threads;
