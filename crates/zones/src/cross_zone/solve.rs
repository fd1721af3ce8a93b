//! The forces of contacts between zones that a pass asks for.

use carom_contact::law::{Level, Status};
use carom_dynamics::Driver;
use carom_nonsmooth::coulomb::Slip;
use carom_nonsmooth::{Compliance, Condensed, ContactPoint, PointForces};

use super::CrossZoneContacts;
use crate::ending::{GAIN, TOLERANCE, largest, rounding, speed};
use crate::error::Error;

impl CrossZoneContacts {
    /// Whether the forces obey the laws at the rates found, or would after a change by rounding; corrects them if not. `dt`: the outer step, s.
    ///
    /// # Errors
    /// A contact problem without solution.
    pub(crate) fn corrected(
        &mut self,
        (step, dt): (u64, f64),
        drivers: &[Driver],
    ) -> Result<bool, Error> {
        if self.candidates.points.is_empty() {
            return Ok(true);
        }
        self.describe(dt);
        let problem = Condensed {
            d: Compliance::Dense(self.compliance.matrix()),
            version: self.compliance.version,
            s: [dt, 1.0, 1.0],
            tangents: self.candidates.tangents,
            tolerance: self.system.nonlinear.iteration.tolerance,
        };
        if let Err(cause) = self.solver.solve(self.described.all(), &problem) {
            let first = self.candidates.points[0] as usize;
            return Err(Error::CrossZone {
                step: step + 1,
                contact: self.system.point(first).0.name.clone(),
                cause,
            });
        }
        let found = self.found();
        let changes = self.candidates.forces.iter().zip(&found);
        let change = changes.fold(0.0_f64, |m, (old, new)| m.max((old - new).abs()));
        let gains = change < GAIN * self.change;
        self.change = change;
        let held = change <= TOLERANCE * largest(&found)
            || !gains && (change <= rounding(drivers) || self.keeps_rates(&found, speed(drivers)));
        if !held {
            self.candidates.forces = found;
        }
        Ok(held)
    }

    /// What the laws and friction of the candidates know, for an outer step of `dt` (s).
    fn describe(&mut self, dt: f64) {
        let (candidates, width) = (&self.candidates, self.candidates.width());
        let n = candidates.forces.len();
        let matrix = &self.compliance.responses;
        // what the rows do without the forces of the candidates
        let free = |row: usize| {
            let forces = candidates.forces.iter();
            let of_forces: f64 = forces.zip(&matrix[row * n..]).map(|(p, d)| d * p).sum();
            candidates.rates[row] - of_forces
        };
        let (system, interface) = (&*self.system, &self.state.interface);
        let (rows, start) = (&self.geometry.pairing.rows, &self.geometry.start);
        let tangents = &self.geometry.pairing.tangents;
        self.described.clear();
        for (i, &point) in candidates.points.iter().enumerate() {
            let point = point as usize;
            let (contact, place) = system.point(point);
            let (carrier, level) = (&contact.points[place], contact.law.get().level());
            let (row, way) = (i * width, way_of(level));
            let (mean, started) = (free(row), rows.product(point, &start[1]));
            let strikes = !candidates.lasting[i] && started < 0.0;
            let begins = level == Level::Rate && strikes;
            let (rate, rate_free) = match begins {
                true => {
                    let part = self.compliance.part(row);
                    (1.0 / part, started + (mean - started) / part)
                }
                false => (1.0, mean),
            };
            let captured = contact.law.get().capture() * dt;
            let at_start = rows.gap(point) - captured * started;
            let (mut along, mut force, mut square) = ([0.0; 2], [0.0; 2], 0.0);
            for k in 0..candidates.tangents {
                along[k] = free(row + 1 + k);
                force[k] = candidates.forces[row + 1 + k];
                square += tangents[k].product(point, &start[1]).powi(2);
            }
            let described = ContactPoint {
                law: contact.law,
                area: carrier.area,
                share: carrier.share,
                tolerance: system.tolerance_at(point),
                faces_itself: false,
                crush: interface.crush[point],
                gap: rows.gap(point),
                rate: started,
                // what lasts or opens has nothing to give back
                rebound: if strikes { 1.0 } else { 0.0 },
                in_way: 0.0,
                dt,
                last: PointForces {
                    normal: candidates.forces[row],
                    tangential: force,
                    status: match candidates.forces[row] != 0.0 {
                        true => closed(interface.status[point]),
                        false => interface.status[point],
                    },
                    slip: match force == [0.0; 2] {
                        true => Slip::Open,
                        false => Slip::Stick,
                    },
                },
            };
            let gap_free = match level {
                Level::Rate => rows.gap(point),
                _ => at_start + way * dt * mean,
            };
            let candidate = described.candidate([gap_free, rate_free], [way, rate]);
            self.described.normal.push(candidate);
            if candidates.tangents > 0 {
                let friction = &system.contacts[system.contact_of(point)].friction;
                let tangential = described.tangential(friction, square.sqrt(), along);
                self.described.friction.push(tangential);
            }
        }
    }

    /// Forces of all rows as the solver found them.
    fn found(&self) -> Vec<f64> {
        let tangents = self.candidates.tangents;
        let of = |candidate: usize| {
            let found = &self.solver.found[candidate];
            let [one, two] = found.tangential;
            [found.normal, one, two].into_iter().take(1 + tangents)
        };
        (0..self.candidates.points.len()).flat_map(of).collect()
    }

    /// Whether the forces just found leave the rates what they are, beside the rounding of velocities up to this `speed` (m/s): those of
    /// points of rigid bodies are not unique, and those that a stiff body needs to change its rate by rounding may be large.
    fn keeps_rates(&self, found: &[f64], speed: f64) -> bool {
        let n = found.len();
        let changes = found.iter().zip(&self.candidates.forces);
        let changes: Vec<f64> = changes.map(|(new, old)| new - old).collect();
        (0..n).all(|row| {
            let of_changes = self.compliance.responses[row * n..(row + 1) * n].iter();
            let rate: f64 = of_changes.zip(&changes).map(|(d, change)| d * change).sum();
            let (point, tangent) = self.candidates.of_row(row);
            let pairing = &self.geometry.pairing;
            let rows = tangent.map_or(&pairing.rows, |k| &pairing.tangents[k]);
            let (_, coefficients) = rows.row(point);
            let size: f64 = coefficients.iter().map(|n| n.abs()).sum();
            rate.abs() <= TOLERANCE * size * speed
        })
    }
}

/// The part of the way of the outer step at which a law in the gap holds: a law with a compliance for the mean of the step.
fn way_of(level: Level) -> f64 {
    match level {
        Level::GapAndRate => 0.5,
        Level::Gap | Level::Rate => 1.0,
    }
}

/// The status from which a point that carries a force begins.
fn closed(status: Status) -> Status {
    match status {
        Status::Open => Status::Closed,
        other => other,
    }
}
