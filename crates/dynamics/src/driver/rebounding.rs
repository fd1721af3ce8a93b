//! Restitution that makes no energy.
//!
//! Newton's law, `N v₊ = -e N v` in the points that press, gives the bodies the energy `½ I · (q + q₊)`, with the impulses I and the
//! rates q of normals and tangents before and after. In one point without friction that is `-(1 - e²) (N v)²/(2 D)`. With friction
//! (Kane 1984), or where a point that parts is pressed by the rebound of another one, it may be positive: a square that
//! strikes with a corner can leave faster than it came. Without rebound it never is.
//!
//! Among the rigid bodies that points of an iteration join, the coefficient is therefore e s with the largest s up to 1 that makes no
//! energy, found by halving.

use super::Driver;
use crate::error::Error;

/// Halvings of the interval of s.
const HALVINGS: u32 = 40;

/// Energy made over the sum of the magnitudes of its terms that is rounding.
const ROUNDING: f64 = 1e-12;

impl Driver {
    /// Takes as much of the rebounds of the iteration as makes no energy.
    ///
    /// # Errors
    /// A contact problem without solution.
    pub(super) fn limit_rebound(&mut self) -> Result<(), Error> {
        if !self.contacts.rebound().is_any()
            || self.attempt.maps.is_static()
            || self.attempt.maps.first().rate.c != 0.0
        {
            return Ok(());
        }
        let rounding = ROUNDING.max(self.attempt.system.nonlinear.iteration.tolerance);
        self.contacts.join_parts(&self.attempt);
        self.contacts.weigh_impacts(&self.attempt);
        if !self.contacts.rebound_mut().begin_limits(rounding) {
            return Ok(());
        }
        self.rebound_by(|_| 0.0)?;
        // friction at the velocity of the end may give what is of the order of a step, with or without rebound
        self.contacts.rebound_mut().take_least();
        for _ in 0..HALVINGS {
            self.rebound_by(|[low, high]| 0.5 * (low + high))?;
            self.contacts.rebound_mut().halve(rounding);
        }
        self.rebound_by(|[low, _]| low)
    }

    /// Solves the problem of the iteration with an s of the interval where the rebound is limited, and weighs what it makes.
    fn rebound_by(&mut self, of: impl Fn([f64; 2]) -> f64) -> Result<(), Error> {
        self.contacts.rebound_mut().take(of);
        self.begin_forces()?;
        self.find_forces()?;
        self.contacts.weigh_impacts(&self.attempt);
        Ok(())
    }
}
