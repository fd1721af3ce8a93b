//! Small tensors, sparse matrices and linear solvers.
//!
//! The crate knows numbers and unknowns, never meshes or mechanics. It is the only one that names the libraries behind the
//! sparse factorisation, so that none of them appears in a signature of another crate. Results never depend on the number
//! of threads; they depend on the instruction set of the processor, which is chosen once at run time.

pub mod arrowhead;
pub mod basis;
pub mod csr;
pub mod dense;
pub mod dense_eigen;
pub mod eigen;
mod error;
pub mod fingerprint;
mod functions;
mod interrupt;
pub mod lanes;
pub mod number;
mod ordering;
pub mod packed;
pub mod part;
pub mod pattern;
pub mod reduce;
pub mod rotation;
pub mod solver;
pub mod tensor;
pub mod unknowns;

pub use error::Error;
pub use interrupt::Interrupt;
