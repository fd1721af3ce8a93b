//! The stage that follows a step in which points of a law with projection close.
//!
//! The velocity becomes the one closest, in the norm of the mass, to that without the contact impulses of the step,
//! among those with `N v₊ >= 0` at the closed points; a closed point alone comes to rest:
//! `v₊ ← v₊ - M⁻¹ Nᵀ (N M⁻¹ Nᵀ)⁻¹ N v₊`. The whole impulse of each point in the step, that of its forces and that of the
//! projection, is compressive. The acceleration is projected in the same way at the points that stay, and their force
//! becomes the one in balance with it, which the next step finds at its beginning.
//!
//! Source: derived here, as the inelastic impact of the nodes in contact (Moreau 1988), with the force that keeps the
//! balance.

use std::sync::Arc;

use super::Driver;
use super::attempt::identity::energies;
use super::attempt::vectors::Vectors;
use super::links::linking::add_all_forces;
use crate::error::Error;
use crate::ledger::reactions;
use crate::resultant::Resultant;
use crate::step_terms::Jump;

impl Driver {
    /// Projects the end of the step if points of laws with projection have closed in it.
    pub(super) fn project(&mut self) -> Result<(), Error> {
        self.stages.forget_projected();
        if !self.stages.are_any()
            || self.attempt.maps.is_static()
            || !self.stages.projected_points(&self.contacts, &self.attempt)
        {
            return Ok(());
        }
        let identity = self.attempt.identity_of_ledger();
        let mut jump = Jump {
            impulses: self
                .stages
                .project_velocity(&self.contacts, &mut self.attempt)?,
            ..Jump::default()
        };
        (jump.work, jump.work_obstacles) = self.stages.works_of_impulses(&self.contacts);
        jump.dissipation = -identity.inertia
            * self
                .stages
                .project_acceleration(&self.contacts, &mut self.attempt)?;
        self.enter_jump(jump);
        Ok(())
    }

    /// Gives the velocity back what the contact took, if the scheme does so.
    pub(super) fn restore(&mut self) {
        if !self.attempt.system.scheme.get().restores_contact_work()
            || self.attempt.maps.is_static()
        {
            return;
        }
        if let Some(jump) = self.stages.restore(&self.contacts, &mut self.attempt) {
            self.enter_jump(jump);
        }
    }

    /// Enters a jump of the motion after the step into the ledger.
    pub(super) fn enter_jump(&mut self, mut jump: Jump) {
        let system = Arc::clone(&self.attempt.system);
        let identity = self.attempt.identity_of_ledger();
        let mut springs = std::mem::take(&mut self.balances.works_mut().springs);
        springs.clear();
        if system.is_nonlinear() && system.has_springs {
            self.attempt
                .vectors
                .place
                .copy_from_slice(&self.attempt.next.motion.u);
            self.attempt.springs_at_place(false, &mut springs);
        }
        let (nonlinear, factor) = (system.is_nonlinear(), self.attempt.contact_factor());
        let (old, new) = (&self.attempt.state.motion, &self.attempt.next.motion);
        let Vectors {
            work,
            inertia,
            load,
            damping,
            ..
        } = &mut self.attempt.vectors;
        let u = nonlinear.then_some(&new.u[..]);
        let of = (self.parts.stored().strain, identity.inertia != 0.0, u);
        let energies = energies(&system, new, of, work);
        system.mass.multiply(&new.a, inertia);
        if nonlinear {
            for (i, reaction) in work.iter_mut().enumerate() {
                let balance = inertia[i] + new.internal_force[i] + damping[i] - load[i];
                let outside = new.link_of(i) + factor * new.contact_force[i];
                *reaction = if system.fixed[i] {
                    balance - outside
                } else {
                    0.0
                };
            }
            let held = |i: usize| match system.fixed[i] {
                true => factor * new.contact_force[i],
                false => 0.0,
            };
            let spring = |i: usize| springs.get(i).unwrap_or(&0.0);
            let own =
                |i: usize| work[i] + held(i) + load[i] + new.link_of(i) - damping[i] - spring(i);
            self.attempt.next.exchange.renew(&system, own);
            let kept = &mut self.attempt.next.forces;
            if !kept.reaction.is_empty() {
                if !new.link_force.is_empty() {
                    kept.link.copy_from_slice(&new.link_force);
                }
                for (f, p) in kept.contact.iter_mut().zip(&new.contact_force) {
                    *f = factor * p;
                }
                kept.reaction.copy_from_slice(work);
                kept.inertia.copy_from_slice(inertia);
            }
            for (reaction, spring) in work.iter_mut().zip(&springs) {
                *reaction -= spring;
            }
            self.balances.works_mut().springs = springs;
        } else {
            reactions(&system, self.attempt.maps.first(), old, new, inertia, work);
            self.attempt.take_linear_springs();
            let (new, work) = (&self.attempt.next.motion, &self.attempt.vectors.work);
            let own = |i: usize| work[i] + system.load[i] + new.link_of(i);
            self.attempt.next.exchange.renew(&system, own);
        }
        let (new, work) = (&self.attempt.next.motion, &self.attempt.vectors.work);
        jump.contacts = Resultant::of(&system, &new.contact_force);
        jump.supports = Resultant::of(&system, work);
        let half = &mut self.attempt.vectors.half;
        half.fill(0.0);
        add_all_forces(&system, &self.stages.projected().links, half);
        jump.links = Resultant::of(&system, half);
        self.attempt.next.ledger.jump(&identity, &energies, &jump);
    }
}
