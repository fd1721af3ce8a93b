//! What a run may leave unbalanced.

use serde::{Deserialize, Serialize};

/// What the iterations of a run may leave unbalanced at the tolerance that was asked for: the work and the impulse of a force
/// of that size in every step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tolerated {
    /// Σ r |Δu|, J, with r the Euclidean norm of the nodal forces that may be left over in the step.
    pub energy: f64,
    /// Σ dt r √n, N s, with n the number of nodes: a component of the sum of forces of that norm is no larger.
    pub momentum: f64,
}

impl Tolerated {
    /// Adds another.
    pub fn add(&mut self, other: &Tolerated) {
        self.energy += other.energy;
        self.momentum += other.momentum;
    }
}
