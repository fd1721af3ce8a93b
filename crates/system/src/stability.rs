//! The critical step of explicit schemes, contact stiffness included.

use std::collections::BTreeMap;

use carom_bodies::{FrequencyBound, Placement};
use carom_contact::law::{Local, Status};
use carom_contact::{Contact, Rows, Search};

use crate::contact_pair::ContactPair;
use crate::modal::NumberedModal;
use crate::motion::Motion;
use crate::system::System;
use carom_schemes::Scheme;

impl System {
    /// Critical step of an explicit scheme, s: its critical ω dt, or that of central differences, 2, over a bound of ω.
    ///
    /// ω² is at most the largest eigenvalue of an element, plus that of the stiffness `Σ k_i n_i n_iᵀ` of compliant contact
    /// laws against the lumped mass, which is bounded by the largest row sum of `sqrt(k_i k_j) n_i · M⁻¹ n_j` over points
    /// i, j, paired as at the start. Points that face nothing then count with the lightest node of the system. The stiffness of a law
    /// that grows with the penetration is that where the contact would hold the kinetic energy of the start; loads may press it deeper.
    ///
    /// Rayleigh damping acts with the velocity that is known before the forces, and shortens the step: with Ω the critical ω dt
    /// without damping and c = α + β ω² a mode is stable for `(2 ω dt/Ω)² + 2 c dt ≤ 4` (from the characteristic polynomial
    /// z² + (A - 2) z + 1 - A + ω² dt² with A = φ ω² dt² + c dt, Ω² = 4/(2φ - 1), at z = -1; φ = 1 for central differences). The largest
    /// ω² and c bound all modes.
    pub fn critical_step(&self) -> f64 {
        let bodies = self.bodies.iter().zip(&self.zone_of_body);
        let bodies = bodies.filter(|(_, zone)| self.is_explicit(**zone));
        let bounds = bodies.map(|(body, _)| body.frequency_bound());
        self.critical_with(bounds.fold(0.0, f64::max))
    }

    /// Critical step about a motion, s, with the tangents there; a body at small strain has always the same. And the bound of the
    /// elements.
    ///
    /// # Errors
    /// An element without tangent.
    pub fn critical_step_at(
        &self,
        motion: &Motion,
    ) -> Result<(f64, FrequencyBound), carom_bodies::Error> {
        let mut bound = FrequencyBound::default();
        for body in (0..self.bodies.len()).filter(|&body| self.is_bound_by(body)) {
            let at = self.placement(body, motion);
            bound = bound.most(&self.bodies[body].frequency_bound_at(&at)?);
        }
        Ok((self.critical_with(bound.frequency), bound))
    }

    /// Where a body is in a motion.
    pub fn placement<'a>(&self, body: usize, motion: &'a Motion) -> Placement<'a> {
        Placement {
            u: &motion.u,
            v: &motion.v,
            from: None,
            frames: &motion.frames,
            dt: self.dt,
            old: &motion.history[self.nonlinear.histories[body].clone()],
        }
    }

    /// Whether the elements of a body bound the step.
    pub fn is_bound_by(&self, body: usize) -> bool {
        self.is_explicit(self.zone_of_body[body])
    }

    /// Whether the elements of a zone bound the step: those of all where no scheme is explicit.
    fn is_explicit(&self, zone: usize) -> bool {
        let explicit = |scheme: &Scheme| scheme.get().is_explicit();
        explicit(&self.schemes[zone]) || !self.schemes.iter().any(explicit)
    }

    /// The same, s, of bodies with this bound of their frequencies, rad/s.
    pub fn critical_with(&self, bodies: f64) -> f64 {
        let (springs, dashpots) = self.discrete_bounds();
        let explicit = |body: usize| self.is_explicit(self.zone_of_body[body]);
        let touches = |pair: &&ContactPair| pair.bodies.iter().any(|&body| explicit(body));
        let touching = self.contacts.iter().filter(touches);
        let contacts = touching
            .map(|contact| self.contact_bound(contact))
            .sum::<f64>();
        let squared = bodies * bodies + contacts + springs;
        let damping = self.nonlinear.damping.iter().enumerate();
        let damping = damping.filter(|(body, _)| explicit(*body));
        let rates = damping.map(|(_, damping)| damping.mass + damping.stiffness * bodies * bodies);
        let modal = self.modal.iter().filter(|modal| explicit(modal.body));
        let rates = rates.chain(modal.map(NumberedModal::rate));
        let rate = rates.fold(0.0, f64::max) + dashpots;
        let critical = self
            .schemes
            .iter()
            .filter_map(|scheme| scheme.get().critical());
        let undamped = critical.reduce(f64::min).unwrap_or(2.0);
        let stiffness = 4.0 * squared / (undamped * undamped);
        match rate > 0.0 {
            true => 4.0 / (rate + (rate * rate + 4.0 * stiffness).sqrt()),
            false => undamped / squared.sqrt(),
        }
    }

    /// Bounds of the eigenvalues of the stiffness of the springs of explicit zones (1/s²) and of the damping matrix of their
    /// dashpots (1/s) against the lumped mass: the largest sums of magnitudes in their rows, over the mass (Gershgorin).
    fn discrete_bounds(&self) -> (f64, f64) {
        let bodies = self.bodies.iter().zip(&self.zone_of_body);
        let discrete =
            bodies.filter(|(body, zone)| body.as_discrete().is_some() && self.is_explicit(**zone));
        let [mut springs, mut dashpots] = [0, 1].map(|_| vec![0.0; self.unknowns()]);
        let mut some = false;
        for (body, _) in discrete {
            body.add_row_sums(&mut springs, &mut dashpots);
            some = true;
        }
        if !some {
            return (0.0, 0.0);
        }
        let largest = |sums: &[f64]| {
            let free = (0..sums.len()).filter(|&i| !self.fixed[i] && sums[i] > 0.0);
            free.map(|i| sums[i] / self.mass.lumped[i])
                .fold(0.0, f64::max)
        };
        (largest(&springs), largest(&dashpots))
    }

    /// Bound of the eigenvalues of the stiffness of a contact against the lumped mass, 1/s².
    fn contact_bound(&self, contact: &Contact) -> f64 {
        let moving = self.mass.lumped.iter().zip(&self.initial.velocity);
        let energy = 0.5 * moving.map(|(m, v)| m * v * v).sum::<f64>();
        let stiffness: Vec<f64> = contact
            .points
            .iter()
            .map(|point| {
                let local = Local {
                    area: point.area,
                    share: point.share,
                    ..Local::default()
                };
                let law = contact.law.get();
                let local = local.about(-law.depth(energy), 0.0);
                let relation = law.relation(Status::Closed, &local);
                if relation.compliance > 0.0 {
                    relation.gap / relation.compliance
                } else {
                    0.0
                }
            })
            .collect();
        if stiffness.iter().all(|k| *k == 0.0) {
            return 0.0;
        }
        let mut rows = Rows::default();
        rows.clear();
        let places = self.places(0.0, &self.initial.displacement, &self.initial.frames);
        contact.pair(&places, &mut Search::default(), &mut rows);
        let lightest = self
            .mass
            .lumped
            .iter()
            .copied()
            .filter(|m| *m > 0.0)
            .fold(f64::INFINITY, f64::min);
        let mut by_unknown: BTreeMap<u32, f64> = BTreeMap::new();
        for (i, k) in stiffness.iter().enumerate() {
            let (dofs, coefficients) = rows.row(i);
            for (&dof, n) in dofs.iter().zip(coefficients) {
                *by_unknown.entry(dof).or_default() += k.sqrt() * n.abs();
            }
        }
        let row_sum = |(i, k): (usize, &f64)| {
            let (dofs, coefficients) = rows.row(i);
            if dofs.is_empty() {
                return 2.0 * k / lightest;
            }
            let terms = dofs
                .iter()
                .zip(coefficients)
                .filter(|(dof, _)| !self.fixed[**dof as usize]);
            terms
                .map(|(dof, n)| {
                    k.sqrt() * n.abs() * by_unknown[dof] / self.mass.lumped[*dof as usize]
                })
                .sum()
        };
        stiffness
            .iter()
            .enumerate()
            .map(row_sum)
            .fold(0.0, f64::max)
    }
}
