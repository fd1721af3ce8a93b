//! Points under plane stress, one by one and side by side.

/// Place of ε_p in the history.
pub(crate) const PLASTIC: usize = 3;

/// Iterations on the strain across, at most; three to five are usual.
pub(crate) const ITERATIONS: usize = 50;

/// Stress across that is rounding, over the trial stress.
pub(crate) const ROUNDING: f64 = 1e-14;

/// Points side by side.
pub const SIDE: usize = 8;

/// Numbers that a law under plane stress keeps of a point, at most.
pub const MAX_KEPT_IN_PLANE: usize = PLASTIC + 2;

/// One number of each of the points.
pub type EachPoint = [f64; SIDE];

/// Points side by side, at the start of a step and at its end.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct PlaneStressPoints {
    /// Strain ε₁₁, ε₂₂, 2ε₁₂ at the end.
    pub strain: [EachPoint; 3],
    /// History at the start, of which a law uses the first ones.
    pub old: [EachPoint; MAX_KEPT_IN_PLANE],
    /// History at the end.
    pub new: [EachPoint; MAX_KEPT_IN_PLANE],
    /// σ₁₁, σ₂₂, σ₁₂ at the end, Pa.
    pub stress: [EachPoint; 3],
    /// Energies stored by elastic strain, stored by hardening, and dissipated since the start, J/m³.
    pub energies: [EachPoint; 3],
}

impl Default for PlaneStressPoints {
    /// At rest.
    fn default() -> PlaneStressPoints {
        let none = [0.0; SIDE];
        PlaneStressPoints {
            strain: [none; 3],
            old: [none; MAX_KEPT_IN_PLANE],
            new: [none; MAX_KEPT_IN_PLANE],
            stress: [none; 3],
            energies: [none; 3],
        }
    }
}
