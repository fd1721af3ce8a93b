//! What the points of a contact did in a step.

use crate::records::Pushed;
use crate::report::ContactReport;
use crate::small::Largest;

/// What the points of one contact did in a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct ContactSums {
    /// Whether any was looked at.
    pub(crate) near: bool,
    /// Where several processes may have its points: the most that a node of this one has moved in the step, m; infinite otherwise.
    pub(crate) motion: f64,
    pub(crate) report: ContactReport,
    /// Work of the forces and impulses, J.
    pub(crate) work: f64,
    /// Energy lost in crush, J.
    pub(crate) crushed: f64,
    pub(crate) pushed: Pushed,
    /// The record with the step.
    pub(crate) passing: Largest,
    /// Points that have passed what they face without a force.
    pub(crate) passed: u64,
    /// See [`Step::jump`](crate::records::Step::jump).
    pub(crate) jump: [(f64, [f64; 3]); 2],
}
