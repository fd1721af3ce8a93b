//! Forces and multipliers of links from the start of a step to its end.

use std::sync::Arc;
use std::time::Instant;

use carom_algebra::reduce::norm_squared;

use super::Links;
use super::linking::{Multipliers, add_forces, of_mass};
use crate::driver::attempt::Attempt;
use crate::driver::parts::Parts;
use crate::driver::parts::pace::Squares;
use crate::error::Error;
use crate::operator::Operators;
use crate::state;
use crate::system::{Assembly, LinkRow, on};

impl Links {
    /// The first half of the solve with the forces in `work`.
    ///
    /// # Errors
    /// Iterations that do not end.
    pub(crate) fn begin_solve(
        &mut self,
        parts: &mut Parts,
        attempt: &mut Attempt,
    ) -> Result<(), Error> {
        let begin = Instant::now();
        if let Some((operators, _)) = parts.effective_mut().both() {
            operators.begin(&attempt.vectors.work, &mut attempt.vectors.half);
        }
        attempt.vectors.left.clear();
        self.hold_links(parts, attempt);
        attempt.phases.sweeps += begin.elapsed();
        parts.solves_ended(attempt)
    }

    /// The motion `dx` that the forces in `work` and the jump of the supports give.
    ///
    /// # Errors
    /// Iterations that do not end.
    pub(crate) fn free_motion(
        &mut self,
        parts: &mut Parts,
        attempt: &mut Attempt,
    ) -> Result<(), Error> {
        if attempt.jumps() {
            parts.load_jump(attempt);
        }
        self.begin_solve(parts, attempt)?;
        parts.end_iteration(attempt);
        Ok(())
    }

    /// Begins the attempt with the multipliers of the state.
    pub(crate) fn begin_links(&mut self, attempt: &Attempt) {
        if attempt.has_links() {
            self.multipliers
                .now
                .clone_from(&attempt.state.links.multipliers);
            self.set_links(attempt);
        }
    }

    /// Begins an iteration.
    pub(crate) fn begin_link_iteration(&mut self) {
        self.multipliers.change[0].fill(0.0);
        self.multipliers.before.clone_from(&self.multipliers.now);
    }

    /// Makes the multipliers those of the iteration, a part `share` of its way from those before.
    pub(crate) fn move_links(&mut self, attempt: &Attempt, share: f64) {
        if !attempt.has_links() {
            return;
        }
        let Multipliers {
            now,
            change: [free, pushed],
            before,
            ..
        } = &mut self.multipliers;
        for (i, now) in now.iter_mut().enumerate() {
            *now = before[i] + share * (free[i] + pushed[i]);
        }
        self.set_links(attempt);
    }

    /// The force of the multipliers as they stand, Σ_z C_zᵀ (w₀ L_k + w₁ L_{k+1}); of several schemes with rows that turn L_k with the rows at the start of the step.
    pub(super) fn set_links(&mut self, attempt: &Attempt) {
        let start = self.rows_before(attempt);
        self.force.fill(0.0);
        let system = &*attempt.system;
        let (before, now) = (&attempt.state.links.multipliers, &self.multipliers.now);
        for (i, row) in self.rows.iter().enumerate() {
            for (k, &(dof, c)) in row.iter().enumerate() {
                let [old, new] = attempt.maps.link_weights(system.zone_at(dof as usize));
                self.force[dof as usize] += match &start {
                    None => c * (old * before[i] + new * now[i]),
                    Some(start) => start[i][k].1 * old * before[i] + c * new * now[i],
                };
            }
        }
    }

    /// Makes velocities of the state the closest ones, in the norm of the mass, that satisfy the rows, and the multipliers
    /// those that keep the accelerations in them.
    ///
    /// # Errors
    /// Redundant rows, a mass that is not positive.
    pub(crate) fn start_links(&mut self, attempt: &mut Attempt) -> Result<(), Error> {
        if !attempt.has_links() {
            return Ok(());
        }
        let system = Arc::clone(&attempt.system);
        let mut mass = Operators::new(&system, 1.0, 0.0, "mass matrix")?;
        self.turn_rows_at_start(attempt);
        let rows = Arc::clone(&self.rows);
        let mut condensed = of_mass((&system, &rows), &mut mass)?;
        let ones = vec![[1.0; 2]; system.parts.len()];
        let n = system.unknowns();
        let (mut half, mut x) = (vec![0.0; n], vec![0.0; n]);
        let mut solve = |force: &[f64]| -> Vec<f64> {
            mass.begin(force, &mut half);
            mass.end(&mut half, &mut x);
            x.clone()
        };
        let velocities = &mut attempt.state.motion.v;
        let mut l: Vec<f64> = rows.iter().map(|row| on(row, velocities)).collect();
        condensed.solve(&mut l);
        let mut force = vec![0.0; n];
        add_forces((&system, &rows), &ones, &l, &mut force);
        for (v, change) in velocities.iter_mut().zip(solve(&force)) {
            *v -= change;
        }
        attempt.evaluate_loads(attempt.state.time);
        let (load, motion) = (&attempt.vectors.load, &attempt.state.motion);
        let (inside, contact) = (&motion.internal_force, &motion.contact_force);
        let damping = &attempt.vectors.damping;
        let free = |i: usize| match system.fixed[i] {
            true => 0.0,
            false => load[i] + contact[i] - inside[i] - damping[i],
        };
        let balance: Vec<f64> = (0..n).map(free).collect();
        let accelerations = solve(&balance);
        let mut l: Vec<f64> = rows.iter().map(|row| -on(row, &accelerations)).collect();
        for (row, own) in attempt.centripetal_rows() {
            l[row] -= own;
        }
        condensed.solve(&mut l);
        self.force.fill(0.0);
        // held unknowns feel the links too
        for (row, l) in rows.iter().zip(&l) {
            for &(dof, c) in row {
                self.force[dof as usize] += c * l;
            }
        }
        attempt.state.motion.link_force.clone_from(&self.force);
        let links = &mut attempt.state.links;
        *links = state::Links::at_rest(&system);
        links.mixed.fill(l.clone());
        links.multipliers = l;
        Ok(())
    }

    /// Holds the rows in the begun solve, without what contact forces change in it.
    fn hold_links(&mut self, parts: &mut Parts, attempt: &mut Attempt) {
        if !attempt.has_links() {
            return;
        }
        let bent = attempt.bent_rows();
        let (system, maps) = (Arc::clone(&attempt.system), &attempt.maps);
        let (motion, vectors) = (&attempt.state.motion, &mut attempt.vectors);
        let of_row = |row: &LinkRow| -> f64 {
            let term = |&(dof, c): &(u32, f64)| {
                let i = dof as usize;
                let row = maps.link_row(maps.of(i));
                let memory = motion.memory.get(i).unwrap_or(&0.0);
                let known = row.u * motion.u[i] + row.v * motion.v[i] + row.a * motion.a[i];
                let known = known + row.m * memory;
                c * (known + row.x * (vectors.x[i] + vectors.jump[i]))
            };
            row.iter().map(term).sum()
        };
        let Multipliers {
            change: [free, pushed],
            defect,
            ..
        } = &mut self.multipliers;
        for (defect, row) in defect.iter_mut().zip(self.rows.iter()) {
            *defect = of_row(row);
        }
        for (row, h) in bent {
            defect[row] = h;
        }
        pushed.fill(0.0);
        if let Some((operators, _, Some(linking))) = parts.effective_mut().all() {
            let forces = (&mut vectors.work[..], &mut vectors.half[..]);
            linking.hold(&system, operators, forces, (defect, free));
        }
    }

    /// The residual with the forces of links as they stand.
    pub(crate) fn add_link_force(&self, attempt: &mut Attempt) {
        let vectors = &mut attempt.vectors;
        let forces = self.force.iter().zip(&vectors.unlinked);
        for (i, (link, unlinked)) in forces.enumerate() {
            vectors.residual[i] = match attempt.system.fixed[i] {
                true => 0.0,
                false => unlinked + link,
            };
        }
    }

    /// Norm of the largest of the forces that balance in each assembly, N.
    pub(crate) fn scale_of_forces(&self, parts: &mut Parts, attempt: &Attempt) -> f64 {
        let mut squares = parts.take_squares();
        self.square_forces(parts, attempt, &mut squares);
        let of = |assembly: &Assembly| {
            let parts = assembly.parts.iter().map(|&part| &squares[part]);
            parts.fold(Squares::default(), Squares::with).scale()
        };
        let assemblies = attempt.system.assemblies.all.iter();
        let scale = assemblies.map(|assembly| of(assembly).powi(2)).sum::<f64>();
        parts.keep_squares(squares);
        scale.sqrt()
    }

    /// Squares of the forces of each part.
    pub(crate) fn square_forces(
        &self,
        parts: &mut Parts,
        attempt: &Attempt,
        squares: &mut Vec<Squares>,
    ) {
        if !std::mem::replace(&mut parts.pace_mut().is_sized, true) {
            parts.size_of_motion(attempt, squares);
        }
        let factor = attempt.maps.contact();
        let (system, vectors) = (&*attempt.system, &attempt.vectors);
        for own in squares.iter_mut() {
            (own.imbalance, own.forces) = (0.0, [0.0; 5]);
        }
        for (part, unknowns) in system.parts.iter().enumerate() {
            let own = &mut squares[part];
            for i in unknowns.clone() {
                let contact = factor * vectors.contact[i];
                if !system.fixed[i] {
                    own.imbalance += (vectors.residual[i] + contact).powi(2);
                }
                let forces = [
                    contact,
                    vectors.load[i],
                    vectors.internal[i],
                    vectors.inertia[i],
                ];
                for (sum, force) in own.forces.iter_mut().zip(forces) {
                    *sum += force * force;
                }
            }
            if let Some(link) = self.force.get(unknowns.clone()) {
                own.forces[4] += norm_squared(link);
            }
        }
    }
}
