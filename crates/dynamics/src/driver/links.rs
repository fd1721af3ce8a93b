//! Links in a step: multipliers of the rows between velocities, from the start of a run to the record of a step.

use std::sync::Arc;

use super::Driver;
use super::identity::WorkWeights;
use super::linking::{Multipliers, add_forces, of_mass};
use super::owners::{Attempt, Links, Parts};
use crate::error::Error;
use crate::operator::Operators;
use crate::state;
use crate::system::{LinkRow, on};

impl Driver {
    /// What contact forces give by themselves keeps the rows of links by multipliers of its own, which are among the contact forces:
    /// takes them from the change of the others.
    pub(super) fn part_links(&mut self) {
        if self.attempt.vectors.push.is_empty() || !self.attempt.has_links() {
            return;
        }
        self.stages.spread(&self.contacts, &mut self.attempt);
        // schemes in which forces give accelerations by themselves stand alone
        let part = self.attempt.maps.contact() / self.attempt.maps.link_weights(0)[1];
        if let Some(stage) = &self.stages.impulses {
            let changes = self.links.multipliers.change[1].iter_mut();
            changes
                .zip(&stage.links)
                .for_each(|(change, l)| *change -= part * l);
        }
    }

    /// Multipliers and works of the links in the step that was taken.
    pub(super) fn record_links(&mut self) {
        if !self.attempt.has_links() {
            return;
        }
        let system = Arc::clone(&self.attempt.system);
        let start = self.links.rows_before(&self.attempt);
        let (old, next) = (&self.attempt.state.links, &mut self.attempt.next.links);
        next.multipliers.clone_from(&self.links.multipliers.now);
        next.mixed.clone_from(&old.mixed);
        next.works.clone_from(&old.works);
        let [before, after] = [&self.attempt.state.motion.u, &self.attempt.next.motion.u];
        let rates = [&self.attempt.state.motion.v, &self.attempt.next.motion.v];
        // in stages those of the links are kept as the momentum takes them
        let carry = match self.attempt.is_plain() {
            true => self.attempt.maps.first().impulse.carry,
            false => 0.0,
        };
        for zone in 0..system.schemes.len() {
            let (weights, of_work) = (
                self.attempt.maps.link_weights(zone),
                self.attempt.link_work_weights(zone),
            );
            let next = &mut self.attempt.next.links;
            let own = |i: usize| system.zone_at(i) == zone;
            for (link, (_, rows)) in system.links.named.iter().enumerate() {
                for row in rows.clone() {
                    let [l, mixed] = [old.multipliers[row], old.mixed[zone][row]];
                    let now = weights[0] * l + weights[1] * next.multipliers[row];
                    let mean = of_work.old * mixed + of_work.new * now;
                    // those of the rows at the start of the step, and at its end
                    let earlier = of_work.old * mixed + of_work.new * weights[0] * l;
                    let later = of_work.new * weights[1] * next.multipliers[row];
                    let (terms, inner) = (&self.links.rows[row], system.links.inner_terms[row]);
                    let sides = [0..inner, inner..terms.len()];
                    for (work, side) in next.works[link].iter_mut().zip(sides) {
                        let side = side.filter(|&k| own(terms[k].0 as usize));
                        let way = |k: usize| {
                            let i = terms[k].0 as usize;
                            let lag = of_work.lag * (rates[1][i] - rates[0][i]);
                            after[i] - before[i] - lag
                        };
                        *work += match &start {
                            None => mean * side.map(|k| terms[k].1 * way(k)).sum::<f64>(),
                            Some(start) => side
                                .map(|k| (start[row][k].1 * earlier + terms[k].1 * later) * way(k))
                                .sum(),
                        };
                    }
                    next.mixed[zone][row] = match carry == 0.0 {
                        true => now,
                        false => now - carry * mixed,
                    };
                }
            }
        }
        // a projection after the step changes the forces that the next one begins with
        let next = &mut self.attempt.next.links;
        for (row, more) in self.stages.projected.links.iter().enumerate() {
            next.multipliers[row] += more;
            next.mixed.iter_mut().for_each(|mixed| mixed[row] += more);
        }
    }

    /// Multipliers of the rows of the links at the present instant, N per unit of the row.
    pub fn multipliers(&self) -> &[f64] {
        &self.attempt.state.links.multipliers
    }

    /// Name, number of rows, and works on the inner and the outer side since the start in J of each link.
    pub fn links(&self) -> impl Iterator<Item = (&str, usize, [f64; 2])> {
        let links = self
            .attempt
            .system
            .links
            .named
            .iter()
            .zip(&self.attempt.state.links.works);
        links.map(|((name, rows), work)| (name.as_str(), rows.len(), *work))
    }
}

impl Attempt {
    /// Whether the system has links of its own.
    pub(super) fn has_links(&self) -> bool {
        !self.system.links.rows.is_empty()
    }

    /// Weights of the forces of links at the start and of the step in their work in a zone: those of the ledger.
    pub(super) fn link_work_weights(&self, zone: usize) -> WorkWeights {
        if !self.system.is_nonlinear() {
            let [old, new] = self.system.scheme.get().link_work(self.dt);
            let lag = self.work_weights().lag;
            return WorkWeights { old, new, lag };
        }
        let [old, new] = self.weights_of(zone);
        WorkWeights { old, new, lag: 0.0 }
    }
}

impl Links {
    /// Begins the attempt with the multipliers of the state.
    pub(super) fn begin_links(&mut self, attempt: &Attempt) {
        if attempt.has_links() {
            self.multipliers
                .now
                .clone_from(&attempt.state.links.multipliers);
            self.set_links(attempt);
        }
    }

    /// Begins an iteration.
    pub(super) fn begin_link_iteration(&mut self) {
        self.multipliers.change[0].fill(0.0);
        self.multipliers.before.clone_from(&self.multipliers.now);
    }

    /// Makes the multipliers those of the iteration, a part `share` of its way from those before.
    pub(super) fn move_links(&mut self, attempt: &Attempt, share: f64) {
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
    pub(super) fn start_links(&mut self, attempt: &mut Attempt) -> Result<(), Error> {
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
    pub(super) fn hold_links(&mut self, parts: &mut Parts, attempt: &mut Attempt) {
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
        if let Some((operators, _, Some(linking))) = parts.effective.all() {
            let forces = (&mut vectors.work[..], &mut vectors.half[..]);
            linking.hold(&system, operators, forces, (defect, free));
        }
    }
}
