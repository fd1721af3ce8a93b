//! Constitutive laws at one point: numbers in, numbers out. A law sees a strain, never a shape function.

mod elastic;
mod hyperelastic;
mod lagrange;
mod material;
mod neo_hooke;
mod st_venant_kirchhoff;

pub use elastic::{Elastic, Plane};
pub use material::{Failure, Law, Material, Response, Tangent, Want};
pub use neo_hooke::NeoHooke;
pub use st_venant_kirchhoff::StVenantKirchhoff;
