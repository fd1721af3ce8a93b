//! What the passes of an iteration with bodies alone linearised need.

use super::mixing::Mixing;
use crate::coulomb::Slip;
use crate::state::InterfaceState;

/// What the passes need.
#[derive(Default)]
pub(super) struct Refined {
    pub(super) mixing: Mixing,
    /// x and residual where the iteration begins.
    pub(super) x: Vec<f64>,
    pub(super) residual: Vec<f64>,
    /// d, and K̂ d.
    pub(super) motion: Vec<f64>,
    pub(super) product: Vec<f64>,
    /// What it was before the last pass, and the contacts.
    pub(super) before: Vec<f64>,
    pub(super) interface: InterfaceState,
    pub(super) slips: Vec<Slip>,
    /// Whether the columns of the contact points are those of the iteration, wherever points are.
    pub(super) holds_columns: bool,
}
