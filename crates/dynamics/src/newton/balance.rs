//! The balance of a nonlinear step, its records, and the report.
//!
//! The balance of forces of the step, times the way Δu, is the balance of energy: what inertia takes beyond the change of
//! the kinetic energy, and internal forces beyond what is stored and dissipated by the material, is the scheme's share, of
//! no fixed sign. The residual is the work of what the iterations left unbalanced.

use std::sync::Arc;

use carom_contact::law::Level;

use super::start::energies;
use super::{Newton, Which};
use crate::driver::contact_report;
use crate::error::Error;
use crate::ledger::{Beyond, Squares, Tolerated};
use crate::records::Step;
use crate::resultant::Resultant;
use crate::scheme::EnergyIdentity;
use crate::state::State;
use crate::step_map::Impulse;

impl Newton {
    /// Writes the motion at the end of the step, its internal forces and histories.
    pub(super) fn advance(&mut self) -> Result<(), Error> {
        let system = Arc::clone(&self.system);
        let (old, map) = (&self.state.motion, &self.map);
        let new = &mut self.next.motion;
        let x = &self.vectors.x;
        map.displacement.whole(old, x, &[], &mut new.u);
        map.velocity.whole(old, x, &[], &mut new.v);
        map.acceleration.whole(old, x, &[], &mut new.a);
        let time = self.state.time + self.dt;
        self.vectors.work.copy_from_slice(&new.u);
        system.nonlinear.prescribe(time, &mut self.vectors.work);
        for follows in &system.nonlinear.follows {
            let i = follows.unknown as usize;
            new.u[i] = self.vectors.work[i];
            // the mean rate: the end rate of a mid-point rule would swing about it
            (new.v[i], new.a[i]) = ((new.u[i] - old.u[i]) / self.dt, 0.0);
        }
        if self.map.inertia.x == 0.0 {
            new.v.fill(0.0);
            new.a.fill(0.0);
        }
        let ended = self.between() || self.map.force == self.map.displacement;
        self.balanced.clone_from(&self.vectors.internal);
        if !ended {
            self.stored = self.internal((Which::Next, false), self.dt)?;
        }
        let new = &mut self.next.motion;
        new.internal_force.clone_from(&self.vectors.internal);
        new.history.clone_from(&self.vectors.history);
        new.contact_force.clone_from(&self.vectors.contact);
        new.link_force.clone_from(&self.link_force);
        let interface = &mut self.next.interface;
        interface.carried.clone_from(&interface.force);
        interface.count_flights(&self.state.interface.flight, self.dt);
        for point in 0..system.points() {
            let ahead = self
                .map
                .displacement
                .since(&self.paired_at(system.point(point).0));
            let motion = &self.state.motion;
            let xc = [&self.vectors.x[..], &[]];
            let rows = &self.pairing.rows;
            let moved = crate::driver::on_row(rows, point, &ahead, motion, xc);
            self.next.interface.gap[point] = rows.gap(point) + moved;
            self.next.interface.rate[point] = match self.map.rate == Default::default() {
                true => 0.0,
                false => {
                    crate::driver::on_row(rows, point, &self.map.rate, motion, xc)
                        + rows.rate(point)
                }
            };
            self.next.interface.opening[point] = match self.law(system.point(point).0).get().level()
            {
                Level::Rate => (self.map.start_in_way() * self.rate_at_start(point)).max(0.0),
                Level::Gap | Level::GapAndRate => 0.0,
            };
        }
        self.crush();
        Ok(())
    }

    /// Renews the memory of the laws at the points that carry a force at the end of the step.
    fn crush(&mut self) {
        let (old, new) = (&self.state.interface, &mut self.next.interface);
        new.crush.clone_from(&old.crush);
        for point in 0..new.crush.len() {
            if new.status[point] != carom_contact::law::Status::Open {
                let law = &self.system.point(point).0.law;
                new.crush[point] = law.crushed(old.crush[point], new.gap[point]);
            }
        }
    }

    /// What the energy that the scheme balances has beside kinetic and strain energy, as far as it is inertia alone: the
    /// forces of bodies that are not linear give it no other form. All else that the scheme takes is found from its works.
    pub(super) fn identity(&self) -> EnergyIdentity {
        let dynamic = self.map.inertia.x != 0.0 && self.system.scheme.get().keeps_acceleration();
        let of_scheme = self.system.scheme.get().energy_identity(self.dt);
        EnergyIdentity {
            inertia: match (dynamic, of_scheme) {
                (true, Some(identity)) => identity.inertia,
                _ => 0.0,
            },
            ..EnergyIdentity::default()
        }
    }

    /// Energy and momentum of the step.
    pub(super) fn balance(&mut self) {
        let system = Arc::clone(&self.system);
        let impulse = &self.map.impulse;
        let plain = impulse.gain == 1.0 && impulse.carry == 0.0 && self.map.inertia.x != 0.0;
        let weights = match (plain, self.map.inertia.x == 0.0) {
            _ if self.state.forces.is_empty() => [0.0, 1.0],
            (true, _) => [impulse.old, impulse.new],
            // along a static step forces go from one equilibrium to the next
            (false, true) => [0.5, 0.5],
            (false, false) => [0.0, 1.0],
        };
        let friction = self.friction_work(weights);
        let obstacles = self.obstacle_work(weights);
        let identity = self.identity();
        let (old, new) = (&self.state.motion, &self.next.motion);
        let map = &self.map;
        let vectors = &mut self.vectors;
        let strain = self.stored.strain;
        let energies = energies(&system, new, strain, &identity, &mut vectors.work);
        let before = &self.state.forces;
        let mean = |k: usize, now: &[f64]| -> Vec<f64> {
            match before.get(k).filter(|_| weights[0] != 0.0) {
                Some(f) => (0..f.len())
                    .map(|i| weights[0] * f[i] + weights[1] * now[i])
                    .collect(),
                None => now.to_vec(),
            }
        };
        let link: Vec<f64> = match self.link_force.is_empty() {
            true => vec![0.0; system.unknowns()],
            false => self.link_force.clone(),
        };
        // supports hold what the balance leaves at their unknowns
        let reaction: Vec<f64> = (0..system.unknowns())
            .map(|i| match system.fixed[i] {
                true => {
                    vectors.inertia[i] + self.balanced[i] + vectors.damping[i]
                        - vectors.load[i]
                        - link[i]
                        - map.contact * vectors.contact[i]
                }
                false => 0.0,
            })
            .collect();
        let contact: Vec<f64> = vectors.contact.iter().map(|f| map.contact * f).collect();
        let now = [
            &vectors.load,
            &contact,
            &reaction,
            &vectors.inertia,
            &self.balanced,
            &vectors.damping,
            &link,
        ];
        let way = |f: &[f64]| -> f64 { (0..f.len()).map(|i| f[i] * (new.u[i] - old.u[i])).sum() };
        let means = [0, 1, 2, 3, 4, 5, 6].map(|k| mean(k, now[k]));
        let [load, touch, support, inertia, internal, damping] =
            [0, 1, 2, 3, 4, 5].map(|k| way(&means[k]));
        let start = &self.state.ledger.balance;
        // what supports that jump give is no inertia of the step
        let gained = energies.kinetic - start.kinetic - self.jump.work;
        let stored = energies.strain - start.strain + self.stored.hardening - start.hardening;
        let own = identity.inertia * energies.acceleration - start.scheme_energy;
        let scheme = inertia - gained - own + internal - stored - self.stored.dissipated;
        let nodes = system.x.len() as f64;
        let travel = (0..new.u.len()).map(|i| (new.u[i] - old.u[i]).powi(2));
        let tolerated = Tolerated {
            energy: self.left_over * travel.sum::<f64>().sqrt(),
            momentum: self.left_over * nodes.sqrt() * self.dt,
        };
        let places = [&old.u[..], &new.u[..]];
        let forces = [
            Resultant::at(&system, &places, &means[0]),
            Resultant::at(&system, &places, &means[1]),
            Resultant::at(&system, &places, &means[2]),
            Resultant::default(),
            Resultant::at(&system, &places, &means[6])
                .plus(&Resultant::at(&system, &places, &means[5]).reversed()),
        ];
        self.next.forces = match weights[0] != 0.0 || map.inertia.x == 0.0 {
            true => now.iter().map(|f| f.to_vec()).collect(),
            false => Vec::new(),
        };
        if map.inertia.x != 0.0 {
            let exchange = &mut self.next.exchange;
            exchange.follow(&self.state.exchange);
            if let Some(impulses) = self.jump.impulses() {
                exchange.jump(&system, impulses);
            }
            let held = |i: usize| if system.fixed[i] { contact[i] } else { 0.0 };
            let own =
                |i: usize| vectors.load[i] + reaction[i] + held(i) + link[i] - vectors.damping[i];
            exchange.add(&system, (0, self.dt, &map.impulse), own);
            exchange.add(&system, (1, self.dt, &map.contact_impulse), |i| -held(i));
        }
        self.next.ledger.clone_from(&self.state.ledger);
        self.next.ledger.kick(&self.jump.impulse);
        self.next.ledger.go_beyond(&Beyond {
            work_supports: support + self.jump.work,
            work_obstacles: obstacles,
            tolerated,
            dissipation_material: self.stored.dissipated,
            dissipation_damping: damping,
            dissipation_friction: -friction,
            hardening: self.stored.hardening,
        });
        let squares = Squares {
            stage: scheme,
            ..Squares::default()
        };
        let one = Impulse::weights(0.0, 1.0);
        let impulses = match plain || map.inertia.x == 0.0 {
            true => [&one, &one],
            false => [&map.impulse, &map.contact_impulse],
        };
        let dt = if map.inertia.x == 0.0 { 0.0 } else { self.dt };
        self.next.ledger.add(
            (dt, &identity, impulses),
            &energies,
            [load, touch - friction - obstacles, way(&means[6])],
            &squares,
            forces,
        );
        if map.inertia.x == 0.0 {
            self.next.ledger.end_static_step();
        }
    }

    /// Records of the contacts.
    pub(super) fn record(&mut self) {
        let system = Arc::clone(&self.system);
        self.next.records.follow(&self.state.records);
        self.next.time = self.state.time + self.dt;
        // without inertia forces give no impulse, and closing is no impact
        let (impulse, dt) = match self.map.inertia.x == 0.0 {
            true => (Impulse::weights(0.0, 1.0), 0.0),
            false => (self.map.contact_impulse, self.dt),
        };
        for k in 0..system.contacts.len() {
            let (old, new) = (&self.state.interface, &self.next.interface);
            let mut report = contact_report(&system, k, &self.pairing.rows, old, new, self.dt);
            let points = system.first_point[k]..system.first_point[k + 1];
            report.mixed = self.weak.mixed(k, &new.force[points]);
            self.report_friction(k, &mut report);
            let points = system.first_point[k]..system.first_point[k + 1];
            let work = points.map(|point| {
                let force = impulse.old * old.carried[point] + impulse.new * new.force[point];
                let rows = &self.pairing.rows;
                let moved = rows.product(point, &self.next.motion.u)
                    - rows.product(point, &self.state.motion.u)
                    + self.dt * rows.rate(point);
                force * moved
            });
            let (work, time) = (work.sum(), self.next.time);
            let State {
                motion,
                records,
                interface,
                ..
            } = &mut self.next;
            let step = Step {
                span: [self.state.time, time],
                dt,
                impulse,
                forces: [&old.force, &interface.force],
                report: &report,
                work,
                crushed: crate::driver::crush_energy(&system, k, interface),
                jump: [(0.0, [0.0; 3]); 2],
            };
            records.add(&system, k, &step, &self.state, &motion.v);
            self.next.records.contacts[k].pushed = self.pushed(k);
            self.report.contacts[k] = report;
        }
        self.watch
            .look(&system, self.state.step + 1, &mut self.next);
        if self.map.inertia.x != 0.0 {
            let work = &mut self.vectors.work;
            system.mass.multiply(&self.next.motion.v, work);
            let records = &self.next.records.contacts;
            self.next.exchange.close(&system, work, records);
        }
    }

    /// Completes the report of the state just accepted. `dt`: the whole step, s.
    pub(super) fn tell(&mut self, dt: f64) {
        let state = &self.state;
        self.report.step = state.step;
        self.report.time = state.time;
        self.report.dt = dt;
        self.report.balance = state.ledger.balance;
        self.report.passes = self.residuals.len();
        if state.step == 0 {
            for (k, report) in self.report.contacts.iter_mut().enumerate() {
                let interface = &state.interface;
                *report = contact_report(
                    &self.system,
                    k,
                    &self.pairing.rows,
                    interface,
                    interface,
                    0.0,
                );
            }
        }
    }
}
