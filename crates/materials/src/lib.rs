//! Constitutive laws at one point: numbers in, numbers out. A law sees a strain, never a shape function.

mod elastic;

pub use elastic::{Elastic, Plane};
