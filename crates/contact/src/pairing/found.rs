//! What a look at a point has found.

use super::stencil::Stencil;

/// What was found at a point.
#[derive(Clone, Debug)]
pub(super) struct Look {
    /// Its place in the contact.
    pub point: u32,
    /// How far the motion may bring it before it is looked at again, m.
    pub clearance: f64,
    /// What it faces within reach, if anything.
    pub stencil: Option<Stencil>,
}
