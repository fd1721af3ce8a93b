//! The iterations of pieces that supports leave free in a static stage, and that contacts may hold.
//!
//! Their stiffness is singular. The matrix of the iterations has a proximal term on them,
//!
//! `A = K + σ |diag K|`, about the last iterate: it acts on the motion of the iteration, not on x,
//!
//! so that where the iterations end nothing of it is left: the balance of forces is tested without it. Iterations shrink
//! errors by σ/(σ + k), k the stiffness with which contacts hold the piece over |diag K|. A round body whose edge has straight sides
//! rolls with a k of 1e-8 to 1e-6 and of either sign; mixing of the iterations finds its equilibrium all the same, stable or
//! not, if it is not misled: turns are finite ([`crate::driver::parts::rigid`]), and motions that nothing holds stay within what an
//! iteration knows of the surfaces. A motion that nothing holds and nothing loads stays as it is.
//!
//! What is loaded along such a motion is moved on to the next contact; where none is on its way there is no equilibrium
//! near, and the body and its motion are named. Held is what a support, a spring, a constraint or the row of a contact that carries a force
//! holds.
//!
//! The proximal point algorithm: R. T. Rockafellar (1976), SIAM J. Control Optim. 14; here one Newton iteration to each of its.

use std::sync::Arc;

use super::Driver;
use super::parts::rigid::{Rigid, Span, norm};
use crate::coulomb::Slip;
use crate::error::Error;

/// Largest turn on the way to a contact, rad: places move along straight lines.
const TURN: f64 = 0.1;

/// Largest way of a node in an iteration along motions that nothing holds, over the size of the elements: about as far as
/// normals and pairs of faceted surfaces say what comes.
const REACH: f64 = 0.25;

/// Change of the load along motions that nothing holds, over that load, from one iteration to the next, up to which it does
/// not depend on where the part is.
const STEADY: f64 = 1e-6;

impl Driver {
    /// Moves pieces that are loaded along a rigid motion that nothing holds to the next contact on their way; whether that was
    /// any way at all. The load of pieces that hang together with nothing else is that of an equilibrium, whatever is
    /// deformed. Contact with something else has forces of the iteration, which change as it goes on: there a load
    /// counts once it does not.
    ///
    /// # Errors
    /// No contact on the way; forces that cannot be taken where it ends.
    pub(super) fn approach(&mut self, scale: f64) -> Result<bool, Error> {
        let (system, pieces) = (
            Arc::clone(&self.attempt.system),
            Arc::clone(self.parts.floating().pieces()),
        );
        let rigid = Rigid::new(
            &system,
            &pieces,
            (
                &self.attempt.places(),
                Some(&self.attempt.state.motion.frames),
            ),
        );
        let Some(c) = self.certain_load(&rigid, scale) else {
            return match self.contacts.tips(&mut self.parts, &self.attempt, &rigid) {
                true => Err(self.attempt.unheld(&rigid, &self.parts.floating().carried)),
                false => Ok(false),
            };
        };
        let Some(way) = self.contacts.way_to_contact(&self.attempt, &rigid, &c) else {
            return Err(self.attempt.unheld(&rigid, &c));
        };
        let way = way.min(TURN / rigid.turn(&c).max(f64::MIN_POSITIVE));
        if way * norm(&c) <= 100.0 * self.attempt.system.tolerance {
            return Ok(false);
        }
        let motion: Vec<f64> = c.iter().map(|c| way * c).collect();
        for (i, u) in rigid.motion(&motion).chain(rigid.arc(&motion)) {
            if !system.fixed[i] {
                self.attempt.vectors.x[i] += u;
            }
        }
        self.parts.floating_mut().load.clear();
        self.evaluate(false)?;
        self.contacts.pair(&mut self.attempt, false);
        Ok(true)
    }

    /// Loads along rigid motions that nothing holds, as far as they are more than the iteration's; none within the tolerance.
    fn certain_load(&mut self, rigid: &Rigid, scale: f64) -> Option<Vec<f64>> {
        let mut c = self.unheld_load(rigid);
        let before = std::mem::replace(&mut self.parts.floating_mut().load, c.clone());
        let change = before.iter().zip(&c).map(|(before, c)| c - before);
        let change: Vec<f64> = change.collect();
        let steady = !before.is_empty() && norm(&change) <= STEADY * norm(&c);
        let grounded = self.contacts.grounded(&self.parts, &self.attempt);
        if !grounded.is_empty() {
            self.parts.floating_mut().carried.clone_from(&c);
        }
        if !steady {
            for piece in grounded {
                c[rigid.coordinates(piece)].fill(0.0);
            }
        }
        let least = (self.attempt.system.nonlinear.iteration.tolerance * scale)
            .max(self.parts.rounding(&self.attempt));
        (norm(&c) > least).then_some(c)
    }

    /// The error of iterations that ended out of balance: the load along a motion that nothing holds, where most is that and
    /// no contact carries the piece, or comes to.
    pub(super) fn unbalanced(&self, passes: usize, imbalance: f64) -> Error {
        let system = &*self.attempt.system;
        if self.parts.floats(&self.attempt) {
            let rigid = Rigid::new(
                system,
                self.parts.floating().pieces(),
                (
                    &self.attempt.places(),
                    Some(&self.attempt.state.motion.frames),
                ),
            );
            let c = self.unheld_load(&rigid);
            let mut loose = c.clone();
            for piece in self.contacts.grounded(&self.parts, &self.attempt) {
                loose[rigid.coordinates(piece)].fill(0.0);
            }
            let free = || {
                let most = norm(&c) > 0.5 * imbalance;
                most && self
                    .contacts
                    .way_to_contact(&self.attempt, &rigid, &c)
                    .is_none()
            };
            if norm(&loose) > self.parts.left_over() || free() {
                // what fell off is named by how it left its contact
                return match self.parts.floating().carried.is_empty() {
                    true => self.attempt.unheld(&rigid, &c),
                    false => self.attempt.unheld(&rigid, &self.parts.floating().carried),
                };
            }
        }
        self.contacts
            .no_equilibrium(&self.parts, &self.attempt, passes)
    }

    /// Loads and contact forces along the rigid motions, less what is held: internal forces have no resultant, and those of springs are held.
    fn unheld_load(&self, rigid: &Rigid) -> Vec<f64> {
        let vectors = &self.attempt.vectors;
        let left = (0..vectors.x.len()).filter(|&i| !self.attempt.system.fixed[i]);
        let mut c = rigid.of(left.map(|i| (i, vectors.residual[i] + vectors.contact[i])));
        self.held(rigid).take_from(&mut c);
        c
    }

    /// Shortens the motion of the iteration along rigid motions that nothing holds to the reach of what it knows of the
    /// surfaces; whether it was longer. Contacts that carry forces, and the forces inside, know nothing of these motions.
    pub(super) fn restrain(&mut self) -> bool {
        let mut shortened = false;
        let system = Arc::clone(&self.attempt.system);
        let pieces = Arc::clone(self.parts.floating().pieces());
        let rigid = Rigid::new(
            &system,
            &pieces,
            (
                &self.attempt.places(),
                Some(&self.attempt.state.motion.frames),
            ),
        );
        let mut c = rigid.nearest(&self.attempt.vectors.dx);
        self.held(&rigid).take_from(&mut c);
        for (piece, size) in self.parts.floating().sizes.iter().enumerate() {
            let reach = rigid.reach(piece, &c);
            let beyond = (1.0 - REACH * size / reach.max(f64::MIN_POSITIVE)).max(0.0);
            shortened |= beyond > 0.0;
            c[rigid.coordinates(piece)]
                .iter_mut()
                .for_each(|c| *c *= beyond);
        }
        for (i, u) in rigid.motion(&c) {
            if !system.fixed[i] {
                self.attempt.vectors.dx[i] -= u;
            }
        }
        shortened
    }

    /// What supports, springs, constraints and contacts that carry a force hold of the rigid motions.
    fn held(&self, rigid: &Rigid) -> Span {
        let mut held = Span::default();
        for i in self.parts.floating().pieces.unknowns() {
            if self.attempt.system.fixed[i] {
                held.add(rigid.of([(i, 1.0)]));
            }
        }
        for row in rigid.held_inside() {
            held.add(row);
        }
        for body in &self.attempt.system.bodies {
            body.each_spring(&mut |row| {
                held.add(rigid.row(row.iter().copied()));
            });
        }
        for row in self.links.rows().iter() {
            held.add(rigid.row(row.iter().map(|&(i, c)| (i as usize, c))));
        }
        let tangents = self.contacts.tangent_rows(&self.attempt);
        for point in self.attempt.carrying() {
            held.add(rigid.contact_row(self.contacts.normal_rows(), point));
            if self.contacts.slips().get(point) == Some(&Slip::Stick) {
                for rows in tangents {
                    held.add(rigid.contact_row(rows, point));
                }
            }
        }
        held
    }
}
