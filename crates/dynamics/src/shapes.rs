//! What is known of the shapes of elements since their frequencies were last looked at.

use serde::{Deserialize, Serialize};

/// The shapes of the last look at the critical step of an explicit run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Shapes {
    /// Displacement at that look, m; empty where there was none.
    pub(crate) u: Vec<f64>,
    /// Of each body whose elements change; none of others.
    pub(crate) bodies: Vec<Option<Shape>>,
    /// What a compression of rate 1/s adds at most to 2 over the critical step found at that look, by bulk viscosity.
    pub(crate) by_compression: f64,
    /// Bound of the change of any length in an element since that look, relative.
    pub(crate) changed: f64,
}

/// What bounds the change of the lengths in the elements of a body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Shape {
    /// Mean velocity when lengths were last compared, m/s.
    pub(crate) velocity: [f64; 3],
    /// Shortest distance of two nodes of an element at the look, m.
    pub(crate) shortest: f64,
}
