//! Meshes, named groups, surfaces and spatial search.
//!
//! A [`Mesh`] is nodes, blocks of elements and named groups; it carries no physics. Readers and [`generate`] make
//! one. A [`Surface`] is a group of facets, each matched to the cell that it bounds. [`project()`] finds the gap of a
//! point over one face, [`BoxTree`] the faces worth asking.

mod axes;
mod bare;
mod beside;
mod bounds;
mod curved;
mod element_id;
mod free;
pub mod generate;
mod halve;
pub mod inside;
mod mesh;
mod parts;
mod patch;
mod place;
pub mod project;
pub mod raise;
pub mod read;
pub mod refine;
mod rim;
mod rims;
pub mod search;
mod sharp;
pub mod surface;
mod vector;

mod error;
mod face;
#[cfg(test)]
mod random;

pub use beside::CellsByNode;
pub use bounds::Bounds;
pub use element_id::ElementId;
pub use error::Error;
pub use face::{Face, face_nodes};
pub use halve::halve_bars;
pub use mesh::{Block, Defect, Group, Mesh, gather};
pub use parts::Parts;
pub use place::Placement;
pub use project::{Projection, QUADS, project, project_quads};
pub use raise::raise;
pub use refine::{is_refinable, refine};
pub use rim::{Rim, is_on};
pub use rims::across;
pub use search::BoxTree;
pub use sharp::SharpEdge;
pub use surface::Surface;
