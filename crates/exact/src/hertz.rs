//! Hertz's contact of elastic spheres, of parallel cylinders, and the collision of spheres.
//!
//! Two half-spaces pressed together, without friction, whose surfaces are paraboloids (cylinders): valid while the
//! contact is small beside the radii. Whole spheres whose equators come together by the approach answer with more
//! force. Lengths, moduli and masses come in pairs, and every formula holds for the values OF THE PAIR:
//!
//! 1/R = 1/R1 + 1/R2, 1/E* = (1 - nu1²)/E1 + (1 - nu2²)/E2, 1/m* = 1/m1 + 1/m2.
//!
//! A plane has an infinite radius, a rigid solid an infinite modulus, a fixed solid an infinite mass.
//!
//! Source: Johnson (1985), Contact Mechanics, chapters 4 (statics) and 11 (impact); the tests derive the formulas
//! anew from the half-space's answer to a point load and from the equation of motion.

use std::f64::consts::PI;

/// A ball, or a cylinder across the plane, of linear isotropic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Radius of its surface, m; infinite: a plane.
    pub radius: f64,
    /// Young's modulus, Pa; infinite: rigid.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
}

impl Solid {
    /// A rigid solid with a plane surface.
    pub const RIGID_PLANE: Solid = Solid {
        radius: f64::INFINITY,
        young: f64::INFINITY,
        poisson: 0.0,
    };

    /// (1 - nu²)/E, 1/Pa.
    fn compliance(&self) -> f64 {
        (1.0 - self.poisson * self.poisson) / self.young
    }
}

/// Two solids in contact, reduced to what the formulas take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// R of the pair, m: R1 R2/(R1 + R2), half the radius of equal spheres.
    pub radius: f64,
    /// E* of the pair, Pa: E/(2 (1 - nu²)) for equal materials.
    pub modulus: f64,
}

impl Pair {
    /// The pair of two convex solids, one of them curved and one of them elastic at least.
    pub fn new(first: Solid, second: Solid) -> Pair {
        Pair {
            radius: 1.0 / (1.0 / first.radius + 1.0 / second.radius),
            modulus: 1.0 / (first.compliance() + second.compliance()),
        }
    }

    /// Two spheres whose distant points have come closer by `approach` delta (m) since first touch:
    /// F = 4/3 E* √R delta^(3/2), a = √(R delta), p0 = 2 E* a/(pi R).
    ///
    /// All zero for a negative approach (apart).
    pub fn spot(&self, approach: f64) -> Spot {
        let approach = approach.max(0.0);
        let radius = (self.radius * approach).sqrt();
        Spot {
            approach,
            force: 4.0 / 3.0 * self.modulus * radius * approach,
            radius,
            peak: 2.0 * self.modulus * radius / (PI * self.radius),
        }
    }

    /// Two spheres pressed together by a `force` F (N): the [`Pair::spot`] of delta = (3 F/(4 E* √R))^(2/3).
    pub fn spot_under(&self, force: f64) -> Spot {
        let ratio = 3.0 * force.max(0.0) / (4.0 * self.modulus * self.radius.sqrt());
        self.spot(ratio.powf(2.0 / 3.0))
    }

    /// Two parallel cylinders pressed together by a `force` f per length (N/m): b = √(4 f R/(pi E*)),
    /// p0 = 2 f/(pi b) = E* b/(2 R).
    ///
    /// The approach of distant points is no property of this contact: it grows with the logarithm of their distance.
    pub fn strip(&self, force: f64) -> Strip {
        let force = force.max(0.0);
        let half_width = (4.0 * force * self.radius / (PI * self.modulus)).sqrt();
        Strip {
            force,
            half_width,
            peak: self.modulus * half_width / (2.0 * self.radius),
        }
    }

    /// Two spheres that meet head-on: m* delta'' = -F(delta), from delta = 0 to delta = 0 again.
    ///
    /// `mass` m* of the pair in kg (see [`reduced_mass`]), `speed` v of approach in m/s. Largest approach
    /// delta1 = (15 m* v²/(16 E* √R))^(2/5); duration 2.9433 delta1/v = 2.8683 (m*²/(R E*² v))^(1/5). The two constants
    /// are 2 I and 2 I (15/16)^(2/5) with I = ∫0^1 dx/√(1 - x^(5/2)). Valid where the duration is much longer than the
    /// transit of waves through the spheres.
    pub fn collision(&self, mass: f64, speed: f64) -> Collision {
        let stiffness = self.modulus * self.radius.sqrt();
        let approach = (15.0 * mass * speed * speed / (16.0 * stiffness)).powf(0.4);
        Collision {
            duration: 2.0 * QUARTER * approach / speed,
            largest: self.spot(approach),
        }
    }
}

/// I = ∫0^1 dx/√(1 - x^(5/2)) = 2/5 B(2/5, 1/2): half the duration of a collision in units of delta1/v.
const QUARTER: f64 = 1.471_637_592_162_352;

/// m* = m1 m2/(m1 + m2), kg; an infinite mass is a fixed solid.
pub fn reduced_mass(masses: [f64; 2]) -> f64 {
    1.0 / (1.0 / masses[0] + 1.0 / masses[1])
}

/// The circular contact of two spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Approach delta of distant points since first touch, m.
    pub approach: f64,
    /// Normal force F, N, positive in compression.
    pub force: f64,
    /// Radius a of the contact, m.
    pub radius: f64,
    /// Pressure p0 in the middle, Pa: 3/2 of the mean.
    pub peak: f64,
}

impl Spot {
    /// Pressure at the distance `r` (m) from the middle, Pa: p0 √(1 - r²/a²), zero outside.
    pub fn pressure(&self, r: f64) -> f64 {
        ellipse(self.peak, r, self.radius)
    }
}

/// The contact of two parallel cylinders, per length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strip {
    /// Normal force f per length, N/m, positive in compression.
    pub force: f64,
    /// Half-width b of the contact, m.
    pub half_width: f64,
    /// Pressure p0 in the middle, Pa: 4/pi of the mean.
    pub peak: f64,
}

impl Strip {
    /// Pressure at the distance `x` (m) from the middle, Pa: p0 √(1 - x²/b²), zero outside.
    pub fn pressure(&self, x: f64) -> f64 {
        ellipse(self.peak, x, self.half_width)
    }
}

/// The collision of two spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision {
    /// Time in contact, s.
    pub duration: f64,
    /// The contact at the moment of the largest approach and force, half-way.
    pub largest: Spot,
}

fn ellipse(peak: f64, x: f64, half: f64) -> f64 {
    if x.abs() < half {
        peak * (1.0 - (x / half) * (x / half)).sqrt()
    } else {
        0.0
    }
}
