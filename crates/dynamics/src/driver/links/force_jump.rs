//! Room for a force that jumps, and what the mass answers to it.

use crate::error::Error;
use crate::operator::Operators;
use crate::system::System;

/// What forces that jump give: buffers by unknown, and the mass once they have.
#[derive(Default)]
pub(crate) struct ForceJump {
    mass: Option<Operators>,
    /// Those on what is not held, N, and the solve with them.
    free: Vec<f64>,
    half: Vec<f64>,
    /// Accelerations, m/s².
    pub(crate) given: Vec<f64>,
    /// Inertia, and what supports take, N.
    pub(crate) inertia: Vec<f64>,
    pub(crate) reaction: Vec<f64>,
}

impl ForceJump {
    /// M⁻¹ of forces (N) on what is not held, inertia, reactions.
    ///
    /// # Errors
    /// A mass that is not positive definite.
    pub(crate) fn solve(&mut self, system: &System, forces: &[f64]) -> Result<(), Error> {
        let mass = match &mut self.mass {
            Some(mass) => mass,
            none => none.insert(Operators::new(system, 1.0, 0.0, "mass matrix")?),
        };
        let buffers = [&mut self.half, &mut self.given, &mut self.inertia];
        for buffer in buffers {
            buffer.resize(forces.len(), 0.0);
        }
        let held = || forces.iter().zip(&system.fixed);
        self.free.clear();
        let free = held().map(|(force, fixed)| if *fixed { 0.0 } else { *force });
        self.free.extend(free);
        mass.begin(&self.free, &mut self.half);
        mass.end(&mut self.half, &mut self.given);
        system.mass.multiply(&self.given, &mut self.inertia);
        self.reaction.clear();
        let held = held().zip(&self.inertia);
        let held = held.map(|((force, fixed), inertia)| match fixed {
            true => inertia - force,
            false => 0.0,
        });
        self.reaction.extend(held);
        Ok(())
    }
}
