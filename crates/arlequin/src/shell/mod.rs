//! The overlap of a shell and a solid, which continue each other.
//!
//! The overlap S is a part of the middle surface of the shell with all of the solid around it, half the thickness to either side: from the
//! line where the solid ends to that where the shell ends. The elements of the shell are extruded along their directors to wedges and hexahedra, and
//! these overlap with the solid like two [solids](crate::Overlap): the common refinement, the borders and the weights are those. Weights do not vary
//! along the directors.
//!
//! The mediator has the kinematics of the shell with rotations of its own, μ = a + b × z d, z along the director d: a has three components, b two
//! across the director, both with the shape functions of the shell, those of nodes closer than a cell of the solid added up. So normals of the
//! solid keep the mean translation and the mean rotation of those of the shell and are free to warp and to contract. The multiplier of pure bending is that of
//! the stress, linear in z: in the space with a free b, but not if b followed the slope of a. The bracket is L2; that with strains would hold the warping.
//!
//! The deflection of the shell in the products is quadratic in an element: that of its rotations without shear, whose shear strains are those of
//! the element. It has the deflection of constant curvatures exactly.

mod mediator;
mod model;
mod motion;
mod overlap;
mod rows;
mod section;

pub use model::{ShellCell, ShellModels};
pub use overlap::ShellOverlap;
