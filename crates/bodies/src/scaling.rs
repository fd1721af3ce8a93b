//! Mass scaling: mass added to elements so that explicit steps may be larger.

/// Mass that elements have beyond that of their material. It is mass in every respect: gravity acts on it, and momentum and
/// kinetic energy count it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MassScaling {
    /// All elements have so many times their mass; at least 1.
    Factor(f64),
    /// Elements whose critical step is below this one (s) over [`MARGIN`] have as much mass as it needs.
    Step(f64),
}

/// Part of the critical step of an element that a wanted step may be: below what steps at finite strain may have, 0.9, so that elements
/// may shorten a little before steps are halved.
pub const MARGIN: f64 = 0.85;

impl MassScaling {
    /// The mass over that of the material of an element with this bound of its frequencies (rad/s), bulk viscosity included:
    /// f = (dt ω/2)², since f makes all times of an element longer by its root.
    pub(crate) fn factor(&self, frequency: f64) -> f64 {
        match *self {
            MassScaling::Factor(factor) => factor,
            MassScaling::Step(step) => (step * frequency / (2.0 * MARGIN)).powi(2).max(1.0),
        }
    }
}
