//! Connected parts: matrices and factors, forces and histories of the bodies, residual and iterations.

mod approach;
mod balance;
mod begun_solve;
mod direct;
pub(crate) mod effective;
mod factored_step;
pub(crate) mod floating;
mod forces;
mod joined;
mod linear_part;
mod matrices;
pub(crate) mod mixing;
pub(crate) mod pace;
pub(crate) mod part_matrix;
pub(crate) mod pieces;
mod renewal;
mod residual;
pub(crate) mod rigid;
mod rounding;
pub(crate) mod solve;
mod start;
mod tangent_solver;

use std::time::Instant;

use carom_bodies::{Scratch, Stored};
use carom_ranks::Ranks;

use crate::body_energies::{BodyEnergies, BodyEnergy};
use crate::driver::attempt::Attempt;
use crate::driver::explicit::leapfrog::Direct;
use crate::error::Error;
use crate::operator::Operators;
use crate::shared::Shared;
use crate::state::InterfaceState;
use crate::system::System;
use effective::Effective;
use floating::Floating;
use mixing::{Carried, Mixing, Refined};
use pace::{Pace, Squares};

/// Connected parts: matrices and factors, forces and histories of the bodies, residual and iterations.
pub(crate) struct Parts {
    effective: Effective,
    floating: Floating,
    /// Buffers of the bodies.
    scratch: Vec<Scratch>,
    force_sweeps: usize,
    /// Residuals of the iterations of the last attempt, relative.
    residuals: Vec<f64>,
    pace: Pace,
    mixing: Mixing,
    refined: Refined,
    carried: Carried,
    /// Sizes of the forces of each assembly.
    squares: Vec<Squares>,
    /// Energies of the iteration.
    energies: BodyEnergies,
    /// Whether the residual without the forces of links, and the pairing, are those of the step.
    prepared: bool,
    /// Norm of the forces that the iterations of the step may leave unbalanced, N.
    left_over: f64,
}

impl Parts {
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
            energies: BodyEnergies::default(),
            prepared: false,
            left_over: 0.0,
        })
    }

    /// Pieces that float, for the iterations that move them.
    pub(crate) fn floating_mut(&mut self) -> &mut Floating {
        &mut self.floating
    }

    /// How fast the iterations go.
    pub(crate) fn pace(&self) -> &Pace {
        &self.pace
    }

    /// The same, to count an iteration.
    pub(crate) fn pace_mut(&mut self) -> &mut Pace {
        &mut self.pace
    }

    /// Begins the iterations of an attempt, which go as fast at first as those of the step before (`fresh`).
    pub(crate) fn begin_iterations(&mut self, fresh: f64) {
        self.residuals.clear();
        (self.pace.age, self.pace.fresh) = (0, fresh);
        self.pace.is_sized = false;
        self.floating.begin();
        self.mixing.clear();
    }

    /// Notes the residual of an iteration, relative.
    pub(crate) fn note_residual(&mut self, residual: f64) {
        self.residuals.push(residual);
    }

    /// Mixes no iteration with those before.
    pub(crate) fn forget_mixing(&mut self) {
        self.mixing.clear();
    }

    /// Mixes with the last iteration alone.
    pub(crate) fn keep_last_mixed(&mut self) {
        self.mixing.keep_last();
    }

    /// Mixes the iteration with those before it; whether it did.
    pub(crate) fn mix(&mut self, attempt: &mut Attempt, largest: f64) -> bool {
        let way = (&attempt.vectors.x[..], &mut attempt.vectors.dx[..]);
        self.mixing.mix(way, &mut attempt.next.interface, largest)
    }

    /// Keeps the contact forces before an iteration.
    pub(crate) fn keep_forces(&mut self, interface: &InterfaceState) {
        self.carried.keep(interface);
    }

    /// Halves the change of the contact forces since they were kept.
    pub(crate) fn halve_forces(&self, interface: &mut InterfaceState) {
        self.carried.halve(interface);
    }

    /// Takes what the passes of an iteration need; columns of the compliance hold until it is kept again.
    pub(crate) fn take_refined(&mut self) -> Refined {
        let columns = Refined {
            holds_columns: true,
            ..Refined::default()
        };
        std::mem::replace(&mut self.refined, columns)
    }

    /// Keeps what the passes had taken.
    pub(crate) fn keep_refined(&mut self, refined: Refined) {
        self.refined = refined;
    }

    /// Whether columns of the compliance hold, in the passes of an iteration.
    pub(crate) fn holds_columns(&self) -> bool {
        self.refined.holds_columns
    }

    /// Takes the sizes of the forces of each part.
    pub(crate) fn take_squares(&mut self) -> Vec<Squares> {
        std::mem::take(&mut self.squares)
    }

    /// Keeps these sizes.
    pub(crate) fn keep_squares(&mut self, squares: Vec<Squares>) {
        self.squares = squares;
    }

    /// Operators and the buffers of the bodies; none without matrices.
    pub(crate) fn operators_and_scratch(&mut self) -> Option<(&mut Operators, &mut [Scratch])> {
        let (operators, _) = self.effective.both()?;
        Some((operators, &mut self.scratch))
    }

    /// Energies of the iteration, to add those of other ranks.
    pub(crate) fn energies_mut(&mut self) -> &mut BodyEnergies {
        &mut self.energies
    }

    /// Matrices, factors and compliances.
    pub(crate) fn effective(&self) -> &Effective {
        &self.effective
    }

    /// The same, to solve with.
    pub(crate) fn effective_mut(&mut self) -> &mut Effective {
        &mut self.effective
    }

    /// Pieces that float in a static stage.
    pub(crate) fn floating(&self) -> &Floating {
        &self.floating
    }

    /// Residuals of the iterations of the last attempt, relative.
    pub(crate) fn residuals(&self) -> &[f64] {
        &self.residuals
    }

    /// How often the internal forces were computed.
    pub(crate) fn force_sweeps(&self) -> usize {
        self.force_sweeps
    }

    /// Energies of the iteration.
    pub(crate) fn stored(&self) -> &Stored {
        &self.energies.all
    }

    /// The same of each body.
    pub(crate) fn energy_of_bodies(&self) -> &[BodyEnergy] {
        &self.energies.each
    }

    /// Norm of the forces that the iterations of the step may leave unbalanced, N.
    pub(crate) fn left_over(&self) -> f64 {
        self.left_over
    }

    /// Sets the norm of the forces that the step may leave unbalanced, N.
    pub(crate) fn leave_over(&mut self, norm: f64) {
        self.left_over = norm;
    }

    /// Whether the residual without the forces of links, and the pairing, are those of the step.
    pub(crate) fn is_prepared(&self) -> bool {
        self.prepared
    }

    /// Tells whether they are.
    pub(crate) fn set_prepared(&mut self, prepared: bool) {
        self.prepared = prepared;
    }

    /// Tries iterations again where factors were taken in their place.
    pub(crate) fn return_to_iterations(&mut self) {
        self.effective.return_to_iterations();
    }

    /// Forgets all matrices.
    pub(crate) fn forget_matrices(&mut self) {
        self.effective.forget();
    }

    /// Shares the products of iterations with other ranks.
    pub(crate) fn share(&mut self, ranks: &Ranks) {
        self.effective.share(ranks);
    }

    /// Whether pieces float in the attempt under way.
    pub(crate) fn floats(&self, attempt: &Attempt) -> bool {
        attempt.maps.is_static() && !self.floating.pieces.is_empty()
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
        let forced = shared.forces(&attempt.system, motions, &mut self.energies);
        attempt.phases.forces += begin.elapsed();
        forced
    }
}
