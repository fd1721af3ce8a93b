//! Meshes, named groups, surfaces and spatial search.
//!
//! A [`Mesh`] is nodes, blocks of elements and named groups; it carries no physics. Readers and [`generate`] make
//! one. A [`Surface`] is a group of facets, each matched to the cell that it bounds.

pub mod mesh;
pub mod read;

mod error;

pub use error::Error;
pub use mesh::{Block, Defect, ElementId, Group, Mesh, gather};
