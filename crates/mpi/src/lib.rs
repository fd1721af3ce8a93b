//! Ranks over MPI, with the feature `mpi`, and solves and partitions of PETSc over them, with the feature `petsc`. Empty without features,
//! so that it is built where there is no MPI.
//!
//! Features are here and not in `ranks`: most crates use that one, and all of them would be compiled anew for a program with MPI.

#[cfg(feature = "mpi")]
mod message_passing;
#[cfg(feature = "petsc")]
mod petsc;
#[cfg(feature = "petsc")]
mod scotch;

#[cfg(feature = "mpi")]
pub use message_passing::{Session, begin};
