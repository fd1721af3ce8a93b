//! The motion of a system at one instant.

use carom_algebra::rotation::Rotation;
use carom_algebra::unknowns::Unknowns;
use carom_schemes::step_map::Known;
use serde::{Deserialize, Serialize};

/// Vectors of the system, one entry per unknown.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// Displacement, m; of rotations the increment since the frames, rad: zero in an accepted state.
    pub u: Vec<f64>,
    /// Velocity, m/s; of rotations the angular velocity about the axes of the frame, rad/s.
    pub v: Vec<f64>,
    /// Rotations of the nodes that have any, in the order of [`Unknowns::turning`](carom_algebra::unknowns::Unknowns::turning).
    pub frames: Vec<Rotation>,
    /// Acceleration, m/s²: in balance, or the mean of the step, as the scheme has it.
    pub a: Vec<f64>,
    /// What the scheme remembers besides, the filtered velocity of Krenk's scheme in m/s; empty for the others.
    pub memory: Vec<f64>,
    /// Internal force f(u), N.
    pub internal_force: Vec<f64>,
    /// Contact force Nᵀ P at the end of the last step, N: after a projection the one in balance with the acceleration.
    pub contact_force: Vec<f64>,
    /// Force of the links to other zones in the last step, N; empty without links.
    pub link_force: Vec<f64>,
    /// Histories of the materials at the integration points, body after body; empty where no material has one.
    pub history: Vec<f64>,
}

impl<'a> From<&'a Motion> for Known<'a> {
    fn from(motion: &'a Motion) -> Known<'a> {
        Known {
            u: &motion.u,
            v: &motion.v,
            a: &motion.a,
            memory: &motion.memory,
        }
    }
}

impl Motion {
    /// What of displacement, velocity and contact force has an entry that is no number, if anything has, and the first such entry.
    pub fn not_finite(&self) -> Option<(&'static str, usize)> {
        let vectors = [
            ("displacement", &self.u),
            ("velocity", &self.v),
            ("contact force", &self.contact_force),
        ];
        let mut bad = vectors
            .into_iter()
            .filter(|(_, vector)| !vector.iter().sum::<f64>().is_finite());
        let (quantity, vector) = bad.next()?;
        // where only the sum is not finite, the largest entry
        let larger = |best: usize, i: usize| match vector[i].abs() > vector[best].abs() {
            true => i,
            false => best,
        };
        let single = vector.iter().position(|x| !x.is_finite());
        let unknown = single.unwrap_or_else(|| (0..vector.len()).fold(0, larger));
        Some((quantity, unknown))
    }

    /// Turns the frames by the increments of the step, R₊ = R cay(θ), which are then zero.
    pub fn compose(&mut self, unknowns: &Unknowns) {
        for (frame, &node) in self.frames.iter_mut().zip(unknowns.turning()) {
            let increment = unknowns.spin(node, &self.u).into();
            *frame = frame.then(&Rotation::cayley(&increment));
            self.u[unknowns.rotations_of(node)].fill(0.0);
        }
    }

    /// Force of the links on one unknown, N.
    pub fn link_of(&self, unknown: usize) -> f64 {
        self.link_force.get(unknown).copied().unwrap_or(0.0)
    }
}
