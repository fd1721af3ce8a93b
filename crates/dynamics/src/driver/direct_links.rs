//! Links in explicit steps with lumped mass that meet no contact: their multipliers follow from accelerations without them.
//!
//! The rows `C v₊ = 0` with `v₊ = v₀ + ν a₊`, v₀ known and `M a₊ = r + Cᵀ L`, say `C M⁻¹ Cᵀ L = -C (v₀/ν + M⁻¹ r)`. Where no unknown of a
//! contact is in a row, the forces of contacts change nothing in r there, and both are solved apart.

use std::sync::Arc;

use super::Driver;
use super::leapfrog::Direct;
use super::linking::of_mass;
use crate::condensed::Condensed;
use crate::error::Error;
use crate::operator::Operators;
use crate::system::{LinkRow, System};

/// What such links need.
#[derive(Default)]
pub(super) struct DirectLinks {
    /// C M⁻¹ Cᵀ, from the first step on.
    condensed: Option<Condensed>,
    /// The unknowns of the rows, ascending.
    pub(super) unknowns: Vec<u32>,
    /// Accelerations without links, m/s², of these unknowns; other entries have no meaning.
    free: Vec<f64>,
}

impl DirectLinks {
    /// None where links turn, or meet a contact.
    pub(super) fn of(system: &System) -> Option<DirectLinks> {
        let mut unknowns: Vec<u32> = system
            .link_rows
            .iter()
            .flatten()
            .map(|(dof, _)| *dof)
            .collect();
        unknowns.sort_unstable();
        unknowns.dedup();
        let meets = |node: u32| {
            let mut own = system.unknowns.of(node);
            own.any(|unknown| unknowns.binary_search(&(unknown as u32)).is_ok())
        };
        let contacts = system.contacts.iter();
        let touched = || contacts.clone().flat_map(|contact| contact.nodes().0);
        // surfaces are renewed where elements are deleted
        let renewed = system.bodies.iter().any(|body| body.has_deletion());
        let apart = unknowns.is_empty() || !renewed && !touched().any(meets);
        (apart && system.turning_rows.is_empty()).then_some(DirectLinks {
            unknowns,
            ..DirectLinks::default()
        })
    }

    /// Work on the way from `before` to `after` of forces at the start and the end with these weights, J.
    pub(super) fn work(&self, weights: [f64; 2], forces: [&[f64]; 2], ways: [&[f64]; 2]) -> f64 {
        let of_unknown = |&unknown: &u32| {
            let i = unknown as usize;
            let force = weights[0] * forces[0][i] + weights[1] * forces[1][i];
            force * (ways[1][i] - ways[0][i])
        };
        self.unknowns.iter().map(of_unknown).sum()
    }

    /// Norm of forces on these unknowns, N.
    pub(super) fn norm(&self, forces: &[f64]) -> f64 {
        let squares = self.unknowns.iter().map(|&i| forces[i as usize].powi(2));
        squares.sum::<f64>().sqrt()
    }
}

impl Driver {
    /// Finds the multipliers of the end and takes their forces from those of damping. `left`: what loads, damping and
    /// internal forces leave on an unknown that moves, N.
    ///
    /// # Errors
    /// Rows that say the same twice.
    pub(super) fn hold_directly(
        &mut self,
        direct: &mut Direct,
        left: impl Fn(&Driver, usize) -> f64,
    ) -> Result<(), Error> {
        if !self.has_links() {
            return Ok(());
        }
        let system = Arc::clone(&self.system);
        let links = &mut direct.links;
        let mut condensed = match links.condensed.take() {
            Some(condensed) => condensed,
            None => {
                let mut mass = Operators::new(&system, 1.0, 0.0, "mass matrix")?;
                of_mass((&system, &system.link_rows), &mut mass)?
            }
        };
        links.free.resize(system.unknowns(), 0.0);
        if !system.has_damping() {
            // what the step before left there
            let beside = &mut self.vectors.damping;
            beside.resize(system.unknowns(), 0.0);
            for &unknown in &links.unknowns {
                beside[unknown as usize] = 0.0;
            }
        }
        for &unknown in &links.unknowns {
            let i = unknown as usize;
            links.free[i] = match system.fixed[i] {
                true => 0.0,
                false => left(self, i) / system.mass.lumped[i],
            };
        }
        let (motion, known) = (&self.state.motion, self.maps.link_row(self.maps.first()));
        let of_row = |row: &LinkRow| -> f64 {
            let term = |&(dof, c): &(u32, f64)| {
                let i = dof as usize;
                let before = known.u * motion.u[i] + known.v * motion.v[i] + known.a * motion.a[i];
                c * (before + known.x * links.free[i])
            };
            row.iter().map(term).sum::<f64>() / -known.x
        };
        let now = &mut self.multipliers.now;
        now.clear();
        now.extend(system.link_rows.iter().map(of_row));
        condensed.solve(now);
        links.condensed = Some(condensed);
        self.spread_links(&direct.links);
        Ok(())
    }

    /// Forces of the multipliers, and their part of the forces beside internal ones.
    fn spread_links(&mut self, links: &DirectLinks) {
        let system = &*self.system;
        let force = &mut self.link_force;
        force.resize(system.unknowns(), 0.0);
        for &unknown in &links.unknowns {
            force[unknown as usize] = 0.0;
        }
        for (row, l) in system.link_rows.iter().zip(&self.multipliers.now) {
            for &(dof, c) in row {
                force[dof as usize] += c * l;
            }
        }
        let (beside, end) = (&mut self.vectors.damping, &mut self.next.motion.link_force);
        end.resize(system.unknowns(), 0.0);
        for &unknown in &links.unknowns {
            let i = unknown as usize;
            beside[i] -= force[i];
            end[i] = force[i];
        }
    }
}
