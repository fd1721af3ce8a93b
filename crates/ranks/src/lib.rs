//! Processes that compute one run together, their *ranks*: who has which elements, and the messages between them.
//!
//! [`Ranks`] is what the rest of the program sees, in one process too. Its messages go over MPI with the feature `mpi`, or between the
//! threads of one process ([`threads`]), as tests do without MPI.

mod engine;
mod link;
#[cfg(feature = "mpi")]
mod message_passing;
#[cfg(not(feature = "petsc"))]
mod no_engine;
mod partition;
#[cfg(feature = "petsc")]
mod petsc;
#[cfg(feature = "petsc")]
mod scotch;
mod threads;

pub use engine::{Graph, OwnRows, Unsolved};
pub use link::{Message, Ranks};
pub use partition::partition;
pub use threads::threads;

#[cfg(not(feature = "petsc"))]
pub use no_engine::Engine;
#[cfg(feature = "petsc")]
pub use petsc::Engine;

#[cfg(feature = "mpi")]
pub use message_passing::{Session, begin};
