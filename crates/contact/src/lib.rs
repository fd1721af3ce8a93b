//! Unilateral contact between surfaces.
//!
//! surfaces → pairing → rows (gap, normal, derivative of the gap) → law with sign fields → relation between gap, rate
//! and force at the end of a step. The crate knows places and unknowns, never bodies: the time scheme and the
//! interface problem, which solve for the forces, live in `carom-dynamics`.
//!
//! Signs: gap positive when open, gap rate positive when opening, force and pressure positive in compression.

mod contact;
pub mod law;
mod pairing;
mod plane;
mod point;
mod rows;
mod sphere;
mod weak;

pub use contact::{Contact, Integration, Places, Search, Sliding, Target};
pub use law::Law;
pub use pairing::{Basis, Mortar, Pairing};
pub use plane::Plane;
pub use point::Point;
pub use rows::Rows;
pub use sphere::Sphere;
pub use weak::Weak;
