//! Connected parts: matrices and factors, forces and histories of the bodies, residual and iterations.

pub(crate) mod approach;
pub(crate) mod balance;
pub(crate) mod begun_solve;
pub(crate) mod direct;
pub(crate) mod effective;
pub(crate) mod factored_step;
pub(crate) mod floating;
pub(crate) mod forces;
pub(crate) mod joined;
pub(crate) mod linear_part;
pub(crate) mod matrices;
pub(crate) mod mixing;
pub(crate) mod pace;
pub(crate) mod part_matrix;
pub(crate) mod pieces;
pub(crate) mod renewal;
pub(crate) mod residual;
pub(crate) mod rigid;
pub(crate) mod rounding;
pub(crate) mod solve;
pub(crate) mod start;
pub(crate) mod tangent_solver;

use std::time::Instant;

use carom_bodies::{Scratch, Stored};

use crate::driver::attempt::Attempt;
use crate::driver::explicit::leapfrog::Direct;
use crate::error::Error;
use crate::shared::Shared;
use crate::system::System;
use effective::Effective;
use floating::Floating;
use mixing::{Carried, Mixing, Refined};
use pace::{Pace, Squares};

/// Connected parts: matrices and factors, forces and histories of the bodies, residual and iterations.
pub(crate) struct Parts {
    pub(crate) effective: Effective,
    pub(crate) floating: Floating,
    /// Buffers of the bodies.
    pub(crate) scratch: Vec<Scratch>,
    pub(crate) force_sweeps: usize,
    /// Residuals of the iterations of the last attempt, relative.
    pub(crate) residuals: Vec<f64>,
    pub(crate) pace: Pace,
    pub(crate) mixing: Mixing,
    pub(crate) refined: Refined,
    pub(crate) carried: Carried,
    /// Sizes of the forces of each assembly.
    pub(crate) squares: Vec<Squares>,
    /// Energies of the iteration.
    pub(crate) stored: Stored,
    /// Whether the residual without the forces of links, and the pairing, are those of the step.
    pub(crate) prepared: bool,
    /// Norm of the forces that the iterations of the step may leave unbalanced, N.
    pub(crate) left_over: f64,
}

impl Parts {
    /// Whether pieces float in the attempt under way.
    pub(crate) fn floats(&self, attempt: &Attempt) -> bool {
        attempt.maps.is_static() && !self.floating.pieces.is_empty()
    }

    /// Those of a system.
    ///
    /// # Errors
    /// A static stage of a body that neither supports nor contacts could hold.
    pub(crate) fn of(system: &System) -> Result<Parts, Error> {
        Ok(Parts {
            effective: Effective::new(),
            floating: Floating::new(system)?,
            scratch: system.bodies.iter().map(|_| Scratch::default()).collect(),
            force_sweeps: 0,
            residuals: Vec::new(),
            pace: Pace::default(),
            mixing: Mixing::default(),
            refined: Refined::default(),
            carried: Carried::default(),
            squares: Vec::new(),
            stored: Stored::default(),
            prepared: false,
            left_over: 0.0,
        })
    }

    /// Internal forces and histories of the end, at the nodes of this rank.
    pub(crate) fn forces_on_ranks(
        &mut self,
        attempt: &mut Attempt,
        shared: &mut Shared,
        direct: &Direct,
    ) -> Result<(), Error> {
        let begin = Instant::now();
        self.force_sweeps += 1;
        let dim = attempt.system.dim;
        for block in &direct.blocks {
            block
                .nodes
                .clear(dim, &mut attempt.next.motion.internal_force);
        }
        let motions = (&attempt.state.motion, &mut attempt.next.motion, attempt.dt);
        let stored = shared.forces(&attempt.system, motions);
        attempt.phases.forces += begin.elapsed();
        self.stored = stored?;
        Ok(())
    }
}
