//! What a law takes from its surroundings where the case file leaves it out.

use crate::Capture;

/// Defaults of a law.
#[derive(Clone, Copy, Debug, Default)]
pub struct Defaults {
    /// What the scheme needs to close without a false start.
    pub capture: Capture,
    /// The softer deformable side.
    pub softer: Side,
}

/// One side of a contact.
#[derive(Clone, Copy, Debug, Default)]
pub struct Side {
    /// Young's modulus, Pa.
    pub young: f64,
    /// Impedance per area ρc, Pa s/m.
    pub impedance: f64,
    /// Wave speed, m/s.
    pub wave_speed: f64,
    /// Element size normal to it, m.
    pub size: f64,
}
