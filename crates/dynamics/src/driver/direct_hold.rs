//! The multipliers of links in explicit steps with lumped mass follow from accelerations without them.
//!
//! The rows `C v₊ = 0` with `v₊ = v₀ + ν a₊`, v₀ known and `M a₊ = r + Cᵀ L`, say `C M⁻¹ Cᵀ L = -C (v₀/ν + M⁻¹ r)`. Where no unknown of a
//! contact is in a row, the forces of contacts change nothing in r there, and both are solved apart.

use std::sync::Arc;

use super::Driver;
use super::explicit::leapfrog::Direct;
use super::links::linking::of_mass;
use crate::error::Error;
use crate::operator::Operators;
use crate::system::LinkRow;

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
        if !self.attempt.has_links() {
            return Ok(());
        }
        let system = Arc::clone(&self.attempt.system);
        let links = &mut direct.links;
        let mut condensed = match links.condensed.take() {
            Some(condensed) => condensed,
            None => {
                let mut mass = Operators::new(&system, 1.0, 0.0, "mass matrix")?;
                of_mass((&system, &system.links.rows), &mut mass)?
            }
        };
        links.free.resize(system.unknowns(), 0.0);
        if !system.has_damping() {
            // what the step before left there
            let beside = &mut self.attempt.vectors.damping;
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
        let (motion, known) = (
            &self.attempt.state.motion,
            self.attempt.maps.link_row(self.attempt.maps.first()),
        );
        let of_row = |row: &LinkRow| -> f64 {
            let term = |&(dof, c): &(u32, f64)| {
                let i = dof as usize;
                let before = known.u * motion.u[i] + known.v * motion.v[i] + known.a * motion.a[i];
                c * (before + known.x * links.free[i])
            };
            row.iter().map(term).sum::<f64>() / -known.x
        };
        let now = self.links.multipliers_mut();
        now.clear();
        now.extend(system.links.rows.iter().map(of_row));
        condensed.solve(now);
        links.condensed = Some(condensed);
        self.links.spread_links(&mut self.attempt, &direct.links);
        Ok(())
    }
}
