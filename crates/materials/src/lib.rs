//! Constitutive laws at one point: numbers in, numbers out. A law sees a strain, never a shape function.

mod elastic;
mod material;

pub use elastic::{Elastic, Plane};
pub use material::{Failure, Law, Material, Response, Tangent, Want};
