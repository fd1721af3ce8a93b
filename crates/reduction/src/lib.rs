//! Eigenmodes of the linear parts of a system.
//!
//! A part is what the matrices of bodies and the rows of links connect. Contacts are open; bodies at finite strain are taken
//! about their undeformed state. No step is taken here. Theory: the chapter on modes of the documentation.

mod error;
mod matrices;
mod modes;

pub use error::Error;
pub use matrices::Matrices;
pub use modes::{Modes, Participation, modes};
