//! The overlap of a body of beams and a solid, which continue each other.
//!
//! The overlap S is a length of the axis of the beam, with all of the solid around it: from the end of the solid to that of the
//! beam. Sections of both are the same there. Weights depend on the place along the axis alone, linear from one end to the other.
//!
//! The mediator has the kinematics of the beam with rotations of its own, μ = a + b × r, r from the centroid of the section: a and b
//! are linear along the axis between nodes of the beam. So sections of the solid keep the mean translation and the mean
//! rotation of those of the beam, and are free to warp and to contract. The multiplier of pure bending is that of the stress,
//! (-c y, 0, 0): in the space with a free b, but not if b followed the slope of a. The bracket is L2; that with strains would hold the
//! warping.
//!
//! Products are integrated on the cells of the solid cut at the nodes of the beam, at the same points for both models: exactly on
//! affine cells.

mod build;
mod model;
mod overlap;
mod rows;
mod runs;
mod slabs;
mod stations;
mod weights;

pub use model::{BeamCell, BeamModels, SectionMotion};
pub use overlap::BeamOverlap;
