//! Constitutive laws at one point: numbers in, numbers out. A law sees a strain, never a shape function.

mod elastic;
mod hyperelastic;
mod j2_plasticity;
mod lagrange;
mod list;
mod material;
mod maxwell;
mod mooney_rivlin;
mod neo_hooke;
mod range;
mod spectral;
mod st_venant_kirchhoff;

pub use elastic::{Elastic, Plane};
pub use j2_plasticity::J2Plasticity;
pub use list::Law;
pub use material::{Conserving, Failure, Material, Response, Tangent, Want};
pub use maxwell::{Branch, MAX_BRANCHES, Maxwell};
pub use mooney_rivlin::MooneyRivlin;
pub use neo_hooke::NeoHooke;
pub use range::OutOfRange;
pub use st_venant_kirchhoff::StVenantKirchhoff;
