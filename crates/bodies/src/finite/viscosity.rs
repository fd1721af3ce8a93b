//! Bulk viscosity: a pressure against fast changes of volume. It spreads a shock front over some elements and damps the fastest
//! vibrations, those of single elements, which no mesh resolves.

use carom_algebra::number::Number;
use carom_materials::tensor::{Tensor, cofactor, determinant_less_1, plus_unit};
use carom_materials::{Elastic, Plane};

/// A pressure against the rate ε̇ of the volumetric strain ln J: the Kirchhoff stress is
///
/// τ = q I,   q = ρ l (b₁ c ε̇ + b₂² l |ε̇| min(ε̇, 0)),   ε̇ = (ln J - ln J_0)/dt,
///
/// with the density ρ, the speed c of compression waves and the size l of the undeformed element, and ln J_0 at the start of the
/// step. The power q ε̇ is never negative. ε̇ is that of the way to the displacement of the forces, half a step before it: the step of an
/// explicit scheme is then stable for ω² dt² + 2 γ dt ≤ 4, with γ a bound of the damping against the mass.
///
/// von Neumann and Richtmyer (1950), the quadratic part; Landshoff (1955), the linear one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BulkViscosity {
    /// b₁, without unit.
    pub linear: f64,
    /// b₂, without unit; acts in compression alone.
    pub quadratic: f64,
}

impl BulkViscosity {
    /// ρ l b₁ c (Pa s) and ρ l² b₂² (Pa s²) of an element of this size (m) whose mass is `scaled` times that of its material.
    pub(crate) fn coefficients(&self, material: &Elastic, size: f64, scaled: f64) -> [f64; 2] {
        let density = scaled * material.density;
        let speed = material.wave_speed(Plane::Full) / scaled.sqrt();
        [
            density * size * self.linear * speed,
            density * (size * self.quadratic).powi(2),
        ]
    }
}

/// What the viscosity does at a point.
#[derive(Clone, Copy, Default)]
pub(super) struct Damped<T> {
    /// q, Pa.
    pub(super) pressure: T,
    /// Work of q since the start of the step per reference volume, J/m³, not negative.
    pub(super) work: T,
    /// -ε̇ where the volume shrinks, 1/s.
    pub(super) compression: T,
    /// ln J.
    pub(super) logarithm: T,
}

/// The viscosity at F = I + `h`, a time `dt` (s) after the logarithm `before`; nothing without time. `coefficients` as those of
/// [`BulkViscosity::coefficients`].
#[inline(always)]
pub(super) fn damp<T: Number>(
    h: &Tensor<T>,
    coefficients: [T; 2],
    (before, dt): (T, f64),
) -> Damped<T> {
    let (zero, inverse) = (before.like(0.0), if dt > 0.0 { 1.0 / dt } else { 0.0 });
    let logarithm = determinant_less_1(h).ln_1p();
    let change = logarithm - before;
    let rate = change.scale(inverse);
    let compression = zero.most(-rate);
    let pressure = coefficients[1].mul_add(compression, coefficients[0]) * rate;
    Damped {
        pressure,
        work: pressure * change,
        compression,
        logarithm,
    }
}

/// P = q F⁻ᵀ of F = I + `h` added to a stress.
#[inline(always)]
pub(super) fn add_pressure<T: Number>(stress: &mut Tensor<T>, h: &Tensor<T>, pressure: T) {
    let one = pressure.like(1.0);
    let cofactors = cofactor(&plus_unit(h, one));
    let factor = pressure / (determinant_less_1(h) + one);
    for i in 0..3 {
        for j in 0..3 {
            stress[i][j] = cofactors[i][j].mul_add(factor, stress[i][j]);
        }
    }
}
