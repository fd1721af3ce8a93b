//! Bodies as an iterated step sees them: forces and tangents at a displacement, history, energies.
//!
//! A body whose law is one of finite strain is total Lagrangian: F = I + ∂u/∂X at the integration points of the reference
//! configuration, f = ∫ P(F) ∂N/∂X dV. A body at small strain answers through the same functions with f = K u.

mod batch;
mod between;
mod body;
mod cell;
mod deletion;
mod dilatation;
mod element;
mod formulation;
mod gradient;
mod hourglass;
mod kernel;
mod linear;
mod looks;
mod mean;
mod passes;
mod path;
mod placement;
mod pressure;
mod solid;
mod sweep;
mod tangents;
mod viscosity;

pub(crate) use body::{Finite, Outcome};
pub(crate) use cell::Shape;
pub use deletion::Deleted;
pub use formulation::Formulation;
pub(crate) use hourglass::{pattern, patterns};
pub use looks::{FrequencyBound, Looks, Seen};
pub use placement::{Placement, Stored};
pub use pressure::FollowerPressure;
pub use viscosity::BulkViscosity;

#[cfg(test)]
mod tests;
