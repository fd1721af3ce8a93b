//! Complementarity with the mass alone: the stages of a step that change velocities, accelerations or a predictor by
//! impulses of the contact points.

use carom_contact::law::{Displacement, Local, Status};
use carom_contact::{Law, Rows};

use crate::compliance::Compliance;
use crate::error::Error;
use crate::interface::{Candidate, Failure, Interface};
use crate::operator::Operators;
use crate::system::System;

use super::weak::{WeakForms, WithWeak};

/// Solver for `0 <= q + D ΔI ⟂ I + ΔI >= 0`, D = N M⁻¹ Nᵀ, with q a quantity of the points and I what acts on them
/// already. Then q + D ΔI is the quantity closest to the one without any I, in the norm of the mass, among those that are
/// not negative.
pub(super) struct Impulses {
    operators: Operators,
    compliance: Compliance,
    with_weak: WithWeak,
    interface: Interface,
    candidates: Vec<Candidate>,
    half: Vec<f64>,
    /// ΔI of each point of the last solve.
    pub(super) added: Vec<f64>,
    /// Whether I + ΔI > 0 for each point of the last solve.
    pub(super) active: Vec<bool>,
    /// M⁻¹ Nᵀ ΔI of the last solve.
    pub(super) change: Vec<f64>,
}

impl Impulses {
    pub(super) fn new(system: &System) -> Result<Impulses, Error> {
        Ok(Impulses {
            operators: Operators::new(system, 1.0, 0.0, "mass matrix")?,
            compliance: Compliance::new(system.points()),
            with_weak: WithWeak::default(),
            interface: Interface::default(),
            candidates: Vec::new(),
            half: vec![0.0; system.unknowns()],
            added: Vec::new(),
            active: Vec::new(),
            change: vec![0.0; system.unknowns()],
        })
    }

    /// Solves for the points (ascending). `weak`: weak forms, and impulse over force. `values`: q of each; infinite where
    /// I + ΔI must vanish. `present`: I of each.
    pub(super) fn solve(
        &mut self,
        system: &System,
        weak: (&WeakForms, f64),
        rows: &Rows,
        points: &[u32],
        values: &[f64],
        present: &[f64],
    ) -> Result<(), Failure> {
        let n = points.len();
        self.compliance
            .update(points, rows, &system.fixed, &mut self.operators);
        let compliance = self
            .with_weak
            .of(weak.0, system, (&self.compliance, rows), [weak.1; 2]);
        let d = compliance.0;
        self.candidates.clear();
        for (i, value) in values.iter().enumerate() {
            let of_present: f64 = d[i * n..(i + 1) * n]
                .iter()
                .zip(present)
                .map(|(d, impulse)| d * impulse)
                .sum();
            self.candidates.push(Candidate {
                law: Law::Displacement(Displacement::default()),
                local: Local {
                    gap_free: value - of_present,
                    ..Local::default()
                },
                rate_free: 0.0,
                status: match value.is_finite() {
                    true => Status::Closed,
                    false => Status::Open,
                },
            });
        }
        self.interface
            .solve(&self.candidates, compliance, [1.0, 0.0])?;
        self.added.clear();
        self.active.clear();
        self.half.fill(0.0);
        for (k, &point) in points.iter().enumerate() {
            let added = self.interface.forces[k] - present[k];
            self.added.push(added);
            self.active.push(self.interface.statuses[k] != Status::Open);
            self.compliance
                .add(point, added, &self.operators, &mut self.half);
        }
        self.operators.end(&mut self.half, &mut self.change);
        Ok(())
    }
}
