//! What the contacts of a system are made from.

use std::collections::BTreeMap;

use carom_algebra::unknowns::Unknowns;
use carom_bodies::Body;
use carom_mesh::ElementId;

use crate::model::Model;
use crate::moment_arms::MomentArms;

/// What the contacts of a model are made from.
pub(crate) struct Made<'a> {
    pub(crate) model: &'a Model,
    /// The body of each cell at a contact.
    pub(crate) owners: &'a BTreeMap<ElementId, usize>,
    pub(crate) bodies: &'a [Body],
    pub(crate) part_of_body: &'a [usize],
    /// System number of each mesh node.
    pub(crate) number: &'a [u32],
    /// Whether bodies are axisymmetric.
    pub(crate) axisymmetric: bool,
    pub(crate) unknowns: &'a Unknowns,
    pub(crate) arms: &'a MomentArms,
}
