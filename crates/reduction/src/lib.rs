//! Eigenmodes of the linear parts of a system, and bodies reduced to modes.
//!
//! A part is what the matrices of bodies and the rows of links connect. Contacts are open; bodies at finite strain are taken
//! about their undeformed state. A body is reduced in a model, before its system is built. No step is taken here. Theory: the chapters
//! on modes and reduced bodies of the documentation.

mod condense;
mod damp;
mod error;
mod full;
mod matrices;
mod modes;
mod quality;
mod reduce;
mod retained;
mod saved;
mod statics;

pub use damp::{Ratios, damp};
pub use error::Error;
pub use full::Keep;
pub use matrices::Matrices;
pub use modes::{Modes, Participation, modes};
pub use reduce::{Source, reduce, reduce_from};
