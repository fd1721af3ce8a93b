//! What metals differ in: how their yield stress grows.

use carom_algebra::number::Number;

use crate::Elastic;

/// How the yield stress grows.
pub(crate) trait Hardening {
    /// The law at small elastic strain.
    fn elastic(&self) -> &Elastic;

    /// Numbers of the history beyond ε_p.
    fn further(&self) -> usize {
        0
    }

    /// Δε_p ≥ 0 of a step of `dt` (s) with the trial stress `q`, with q - k Δε_p = σ_y(Δε_p) where it is positive, and the slope
    /// dσ_y/dΔε_p there. `stiffness`: k in Pa, 3μ of a general stress, E of a uniaxial one. `old`: the history from ε_p on.
    fn slip<T: Number>(&self, q: T, stiffness: f64, old: &[T], dt: f64) -> [T; 2];

    /// Energy that hardening stores at the end of the step and energy dissipated in it, J/m³, with the stress `q` at its end; writes
    /// the history beyond ε_p. Both histories from ε_p on.
    fn spent<T: Number>(&self, slip: T, q: T, history: (&[T], &mut [T])) -> [T; 2];
}
