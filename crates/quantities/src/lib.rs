//! Quantities of input files: numbers with units, their dimensions and ranges.
//!
//! A parameter struct has a field of type `f64` in SI units, and names its quantity for the reader of the file and for the
//! schema:
//!
//! ```text
//! /// Young's modulus, Pa.
//! #[serde(deserialize_with = "Modulus::si")]
//! #[schemars(with = "Modulus")]
//! pub young: f64,
//! ```

mod nearest;
mod quantity;
pub mod units;

pub use nearest::nearest;
pub use quantity::{
    Acceleration, Angle, AngularVelocity, Area, Clearance, Coordinate, Damping, Delay, Density,
    Duration, Energy, Force, Frequency, Length, LineMass, Modulus, MomentOfInertia, Rate,
    SecondMoment, SignedForce, SignedMoment, SignedStress, Speed, Stiffness, Stress,
    SurfaceDamping, SurfaceStiffness, Vector, Velocity, Weight,
};
