//! Links between zones and within a model: rows, multipliers, forces.

pub(crate) mod direct_links;
pub(crate) mod force_jump;
pub(crate) mod linking;
mod start;
mod turned;

use std::sync::Arc;

use crate::error::Error;
use crate::system::{LinkRow, System};
use force_jump::ForceJump;
use linking::Multipliers;

/// Links between zones and within a model: rows and multipliers.
pub(crate) struct Links {
    /// Forces of links in the step, N; empty without links.
    force: Vec<f64>,
    jump: ForceJump,
    multipliers: Multipliers,
    /// The rows of the links; those that turn as they are in the iteration.
    rows: Arc<Vec<LinkRow>>,
}

impl Links {
    /// Those of a system.
    pub(crate) fn of(system: &System) -> Links {
        let unknowns = match system.links.rows.is_empty() {
            true => 0,
            false => system.unknowns(),
        };
        Links {
            force: vec![0.0; unknowns],
            jump: ForceJump::default(),
            multipliers: Multipliers::new(system),
            rows: Arc::clone(&system.links.rows),
        }
    }

    /// What contact forces push the rows with, N per unit of the row.
    pub(crate) fn pushed_mut(&mut self) -> &mut [f64] {
        &mut self.multipliers.change[1]
    }

    /// Multipliers of the rows in the iteration, N per unit of the row.
    pub(crate) fn multipliers(&self) -> &[f64] {
        &self.multipliers.now
    }

    /// The same, to write those of an explicit step.
    pub(crate) fn multipliers_mut(&mut self) -> &mut Vec<f64> {
        &mut self.multipliers.now
    }

    /// Forgets the forces until the next ones are set.
    pub(crate) fn forget_force(&mut self) {
        self.force.clear();
    }

    /// Forces of all unknowns, N.
    pub(crate) fn set_force(&mut self, force: Vec<f64>) {
        self.force = force;
    }

    /// No forces, where there are links.
    pub(crate) fn clear_force(&mut self) {
        self.force.fill(0.0);
    }

    /// Cᵀ Λ of the step, N.
    pub(crate) fn set_row_forces(&mut self, rows: &[(u32, LinkRow)], multipliers: &[f64]) {
        self.force.fill(0.0);
        self.add_row_forces(rows, multipliers);
    }

    /// The force given term by term in the order of the rows, N.
    pub(crate) fn set_term_forces(&mut self, rows: &[(u32, LinkRow)], forces: &[f64]) {
        self.force.fill(0.0);
        let terms = rows.iter().flat_map(|(_, terms)| terms);
        for ((dof, _), force) in terms.zip(forces) {
            self.force[*dof as usize] += force;
        }
    }

    /// Makes room for the forces of `unknowns`.
    pub(crate) fn make_room(&mut self, unknowns: usize) {
        if self.force.is_empty() {
            self.force.resize(unknowns, 0.0);
        }
    }

    /// Adds forces of rows, N.
    pub(crate) fn add_row_forces(&mut self, rows: &[(u32, LinkRow)], forces: &[f64]) {
        for (row, terms) in rows {
            for &(dof, c) in terms {
                self.force[dof as usize] += c * forces[*row as usize];
            }
        }
    }

    /// M⁻¹ of forces that jump (N): what they give is kept here.
    ///
    /// # Errors
    /// A mass that is not positive definite.
    pub(crate) fn solve_jump(
        &mut self,
        system: &System,
        forces: &[f64],
    ) -> Result<&ForceJump, Error> {
        self.jump.solve(system, forces)?;
        Ok(&self.jump)
    }

    /// Forces of links in the step, N; empty without links.
    pub(crate) fn force(&self) -> &[f64] {
        &self.force
    }

    /// The rows; those that turn as they are in the iteration.
    pub(crate) fn rows(&self) -> &Arc<Vec<LinkRow>> {
        &self.rows
    }
}
