//! Unilateral contact between surfaces.
//!
//! surfaces → pairing → rows (gap, normal, derivative of the gap) → law with sign fields → relation between gap, rate
//! and force at the end of a step. The crate knows places and unknowns, never bodies: the time scheme and the
//! interface problem, which solve for the forces, live in `carom-dynamics`.
//!
//! Signs: gap positive when open, gap rate positive when opening, force and pressure positive in compression.

mod contact;
mod initial;
pub mod law;
mod obstacle;
mod pairing;
mod point;
mod rows;
mod search;
mod sight;
mod weak;

pub use contact::{Contact, Integration, Places, Sliding, Target};
pub use initial::{Initial, Penetration};
pub use law::Law;
pub use obstacle::{
    Cylinder, Distance, Motion, Obstacle, Placed, Plane, RigidSurface, Shape, Side, Sphere,
    Translation, Turn,
};
pub use pairing::{Basis, Mortar, Pairing, Tie};
pub use point::Point;
pub use rows::Rows;
pub use search::{Held, Search};
pub use sight::Sight;
pub use weak::Weak;
