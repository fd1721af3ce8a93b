//! What elements are made on.

use carom_algebra::unknowns::Unknowns;

/// What elements are made on.
pub(crate) struct Nodes<'a> {
    /// System numbers of the nodes of each element, flat.
    pub(crate) elements: &'a [u32],
    /// Coordinates by system number, m.
    pub(crate) x: &'a [[f64; 3]],
    /// Unknowns of the nodes of the system.
    pub(crate) unknowns: &'a Unknowns,
}
