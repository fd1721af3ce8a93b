//! An elastic bar and its state at the start.

use crate::Error;

/// What holds the end of a bar that is away from the contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FarEnd {
    /// No force.
    Free,
    /// No velocity.
    Clamped,
}

/// A uniform elastic bar with a uniform initial state.
///
/// Its own axis s runs from the contact end (s = 0) INTO the bar, to the far end (s = length). Velocity, displacement
/// and acceleration are positive along s, that is away from the contact: a striker has a negative velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// Length L, m.
    pub length: f64,
    /// Cross-section A, m².
    pub area: f64,
    /// Modulus E of the longitudinal wave, Pa: Young's, or [`constrained_modulus`] where lateral motion is blocked.
    pub modulus: f64,
    /// Density rho, kg/m³.
    pub density: f64,
    /// Initial velocity, m/s, positive away from the contact.
    pub velocity: f64,
    /// Initial strain, positive in tension; the initial displacement is strain (s - L), zero at the far end.
    pub strain: f64,
    /// Body force per mass, m/s², positive away from the contact: gravity g towards the contact is -g.
    pub acceleration: f64,
    /// Support of the far end.
    pub far_end: FarEnd,
}

impl Bar {
    /// A bar at rest, unstrained, without gravity, its far end free. `modulus` in Pa, `density` in kg/m³.
    pub fn new(length: f64, area: f64, modulus: f64, density: f64) -> Bar {
        Bar {
            length,
            area,
            modulus,
            density,
            velocity: 0.0,
            strain: 0.0,
            acceleration: 0.0,
            far_end: FarEnd::Free,
        }
    }

    /// The same bar with an initial velocity, m/s, positive away from the contact.
    pub fn with_velocity(self, velocity: f64) -> Bar {
        Bar { velocity, ..self }
    }

    /// The same bar with a uniform initial strain, positive in tension.
    pub fn with_strain(self, strain: f64) -> Bar {
        Bar { strain, ..self }
    }

    /// The same bar under gravity `g`, m/s², positive TOWARDS the contact.
    pub fn with_gravity(self, g: f64) -> Bar {
        Bar {
            acceleration: -g,
            ..self
        }
    }

    /// The same bar, its far end clamped.
    pub fn clamped(self) -> Bar {
        Bar {
            far_end: FarEnd::Clamped,
            ..self
        }
    }

    /// Wave speed c = sqrt(E/rho), m/s.
    pub fn wave_speed(&self) -> f64 {
        (self.modulus / self.density).sqrt()
    }

    /// Impedance Z = rho c A, N s/m.
    pub fn impedance(&self) -> f64 {
        self.density * self.wave_speed() * self.area
    }

    /// Time T = 2 L/c for a wave to go to the far end and back, s.
    pub fn round_trip(&self) -> f64 {
        2.0 * self.length / self.wave_speed()
    }

    /// Mass rho A L, kg.
    pub fn mass(&self) -> f64 {
        self.density * self.area * self.length
    }

    /// Sign of a velocity wave after reflection at the far end: +1 free, -1 clamped.
    pub(crate) fn reflection(&self) -> f64 {
        match self.far_end {
            FarEnd::Free => 1.0,
            FarEnd::Clamped => -1.0,
        }
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        let positive = [
            ("length", self.length),
            ("area", self.area),
            ("modulus", self.modulus),
            ("density", self.density),
        ];
        let finite = [
            ("velocity", self.velocity),
            ("strain", self.strain),
            ("acceleration", self.acceleration),
        ];
        for (quantity, value) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::NotPositive { quantity, value });
            }
        }
        for (quantity, value) in finite {
            if !value.is_finite() {
                return Err(Error::NotFinite { quantity, value });
            }
        }
        Ok(())
    }
}

/// Modulus of a longitudinal wave where lateral motion is blocked, Pa.
///
/// E (1 - nu) / ((1 + nu) (1 - 2 nu)), with `young` E in Pa and Poisson's ratio -1 < nu < 1/2.
pub fn constrained_modulus(young: f64, poisson: f64) -> f64 {
    young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
}
