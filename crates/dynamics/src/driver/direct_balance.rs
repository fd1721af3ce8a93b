//! Balance and records of an explicit step in one pass: the third source of what the ledger is told.

use std::sync::Arc;

use super::Driver;
use super::explicit::leapfrog::Direct;
use crate::assembly_energy::PartMotion;
use crate::resultant::Resultant;
use crate::step_forces::OutsideForces;
use crate::step_map::Impulse;
use crate::step_terms::{Energies, NonlinearTerms, Squares, StepTerms};
use crate::tolerated::Tolerated;
use crate::update::Sums;

impl Driver {
    /// Balance and records of the end, from what was reported of the contacts.
    pub(super) fn end_directly(&mut self, sums: &Sums, direct: &Direct) {
        self.balance_directly(sums, direct);
        self.record_links();
        self.record_contacts();
        let records = &self.attempt.next.records.contacts;
        let momenta = |part: usize| direct.parts[part].momentum.linear;
        self.attempt
            .next
            .exchange
            .close(&self.attempt.system, momenta, records);
        self.balances
            .work_of_obstacles(&self.contacts, &self.attempt);
        let inertia = self.attempt.inertia_of_identity();
        let part = |part: usize| {
            let sums = &direct.parts[part];
            PartMotion {
                kinetic: 0.5 * sums.velocity,
                momentum: sums.momentum.linear,
                taken: sums.works[1],
                damped: sums.works[4],
                given: sums.works[2],
                of_scheme: inertia * sums.acceleration[1],
            }
        };
        let mut motions = std::mem::take(&mut self.balances.works_mut().motions);
        motions.clear();
        motions.extend((0..direct.parts.len()).map(part));
        let bodies = self.parts.energy_of_bodies();
        self.balances
            .add_to_assemblies(&mut self.attempt, motions, bodies);
        self.look_at_the_end();
    }

    /// Energy and momentum of the step.
    fn balance_directly(&mut self, sums: &Sums, direct: &Direct) {
        let (system, parts) = (Arc::clone(&self.attempt.system), &direct.parts);
        let identity = self.attempt.identity_of_ledger();
        let map = *self.attempt.maps.first();
        let weights = [[map.impulse.old, map.impulse.new]];
        let (old, new) = (&self.attempt.state.motion, &self.attempt.next.motion);
        let forces = [&old.link_force[..], &new.link_force];
        let links = direct.links.work(weights[0], forces, [&old.u, &new.u]);
        let link_norm = direct.links.norm(&new.link_force);
        let of_contacts = self.contacts.sums().iter();
        let friction = -of_contacts.map(|of| of.report.friction_loss).sum::<f64>();
        let obstacles =
            self.obstacle_work(&weights, &|contact| self.contacts.sums()[contact].pushed);
        let [inertia, internal, load, touch, beside] = sums.works;
        let stored = *self.parts.stored();
        let energies = Energies {
            kinetic: 0.5 * sums.velocity,
            strain: stored.strain,
            acceleration: sums.acceleration[1],
            memory: 0.0,
            lagged: 0.0,
            momentum: sums.momentum,
        };
        let before = identity.inertia * sums.acceleration[0];
        let start = &self.attempt.state.ledger.balance;
        let gained = energies.kinetic - start.kinetic + energies.of_scheme(&identity) - before;
        let kept = energies.strain - start.strain + stored.hardening - start.hardening;
        let one = Impulse::weights(0.0, 1.0);
        // forces that are means already, or those of the end
        let [impulse, contact_impulse] = match system.is_nonlinear() {
            true => [&one, &one],
            false => [&map.impulse, &map.contact_impulse],
        };
        let mut dissipation = Squares::default().dissipation(&identity);
        let mut nonlinear = None;
        if system.is_nonlinear() {
            dissipation = inertia - gained + internal - kept - stored.dissipated - stored.viscous;
            self.parts.leave_over(
                self.attempt.system.nonlinear.iteration.tolerance
                    * scale(sums, self.attempt.dt).max(link_norm),
            );
            let nodes = system.nodes_of_whole as f64;
            nonlinear = Some(NonlinearTerms {
                work_supports: 0.0,
                work_obstacles: obstacles,
                dissipation_material: stored.dissipated,
                // what is beside internal forces is damping less the forces of links
                dissipation_damping: beside + links,
                dissipation_friction: -friction,
                dissipation_viscosity: stored.viscous,
                hardening: stored.hardening,
                hourglass: stored.hourglass,
                tolerated: Tolerated {
                    energy: self.parts.left_over() * sums.way.sqrt(),
                    momentum: self.parts.left_over() * nodes.sqrt() * self.attempt.dt,
                },
            });
        }
        let [loads, contacts, supports, beside] = sums.forces;
        self.attempt.next.ledger = self.attempt.state.ledger.after(&StepTerms {
            dt: self.attempt.dt,
            is_static: false,
            identity: &identity,
            impulse,
            contact_impulse,
            energies,
            work_loads: load,
            work_contacts: touch - friction - obstacles,
            work_links: links,
            dissipation,
            energy_of_scheme: Some(before),
            forces: OutsideForces {
                loads,
                contacts,
                supports,
                held: Resultant::default(),
                links: beside.reversed(),
            },
            kick: Resultant::default(),
            nonlinear,
            rounding: Tolerated::default(),
        });
        let exchange = &mut self.attempt.next.exchange;
        exchange.follow(&self.attempt.state.exchange);
        let apart = system.is_nonlinear();
        let outside = |part: usize| {
            let [own, held] = parts[part].outside;
            match apart {
                true => own,
                false => [0, 1, 2].map(|i| own[i] + held[i]),
            }
        };
        exchange.add_sums(&system, (0, self.attempt.dt, |_| map.impulse), outside);
        if apart {
            let held = |part: usize| parts[part].outside[1];
            exchange.add_sums(&system, (1, self.attempt.dt, |_| map.contact_impulse), held);
        }
    }
}

/// Largest norm of the forces that balance, and of the momentum over the step, N.
fn scale(sums: &Sums, dt: f64) -> f64 {
    let [forces @ .., momentum] = sums.squares;
    let forces = forces.iter().map(|square| square.sqrt());
    forces
        .fold(momentum.sqrt() / dt, f64::max)
        .max(f64::MIN_POSITIVE)
}
