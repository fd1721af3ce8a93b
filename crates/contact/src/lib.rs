//! Unilateral contact between surfaces.
//!
//! surfaces → pairing → rows (gap, normal, derivative of the gap) → law with sign fields → relation between gap, rate
//! and force at the end of a step. The crate knows places and unknowns, never bodies. Laws are those of `carom-laws`;
//! the problems that solve for the forces are those of `carom-nonsmooth`.
//!
//! Signs: gap positive when open, gap rate positive when opening, force and pressure positive in compression.

pub mod certificate;
mod contact;
mod crossing;
mod edge_pairs;
mod edges;
mod faced;
mod initial;
mod mortar;
mod nearest;
mod obstacle;
mod pairing;
mod passage;
mod passed;
mod places;
mod point;
mod rest;
mod reversed;
mod rows;
mod search;
mod sight;

pub use carom_laws as law;
pub use carom_laws::{Friction, Law};
pub use contact::{Contact, Integration, Sliding, Target};
pub use edges::Edges;
pub use faced::Faced;
pub use initial::{Initial, Penetration};
pub use mortar::{Basis, Mortar};
pub use obstacle::{
    Cylinder, Distance, Motion, Obstacle, Placed, Plane, Profile, RigidSurface, Shape, Side,
    Sphere, Translation, Turn,
};
pub use pairing::{InReach, Near, OwnPart, Pairing, Step, Tie};
pub use places::{Balance, Frames, Places};
pub use point::Point;
pub use rows::Rows;
pub use search::{Held, Search};
pub use sight::{Part, Parts, Sight};
