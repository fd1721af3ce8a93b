//! What a solution of the contact problem gives to a point.

use carom_laws::Status;

use crate::coulomb::Slip;

/// Forces and statuses of one candidate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointForces {
    /// Normal force, N, compressive positive.
    pub normal: f64,
    /// Friction force along the tangents, N.
    pub tangential: [f64; 2],
    /// Status of the law.
    pub status: Status,
    /// Status of friction.
    pub slip: Slip,
}
