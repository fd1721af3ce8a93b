//! The states at the start of an attempt.

use super::Attempt;
use crate::assembly_energy::{AssemblyEnergies, PartMotion};
use crate::body_energies::BodyEnergy;
use crate::driver::balances::record::motion_of;
use crate::exchange::Exchange;

impl Attempt {
    /// Writes the accelerations of the state at the end of a step of `dt`, or, where that is zero, at the start of the dynamics.
    pub(crate) fn show_followed(&mut self, dt: f64) {
        // static steps have no accelerations
        if self.maps.is_static() {
            return;
        }
        let system = &*self.system;
        let begin = system.nonlinear.preload.map_or(0.0, |stage| stage.end);
        for follows in &system.nonlinear.follows {
            let i = follows.unknown as usize;
            let at = |time: f64| system.nonlinear.amplitudes[follows.amplitude].at(time);
            let time = system.instant_of(i, self.state.time, dt);
            let since = time - begin;
            self.state.motion.a[i] = if since > 0.0 {
                let h = dt.min(since);
                (at(time + h) - at(time) - (at(time) - at(time - h))) / (h * h)
            } else {
                // of a scheme whose balance is that of the start of the step, the state before it has the rate there
                let (h, before) = match dt > 0.0 {
                    true => (dt, &self.next.motion),
                    false => (system.dt, &self.state.motion),
                };
                2.0 * (at(time + h) - at(time) - h * before.v[i]) / (h * h)
            };
        }
    }

    /// Takes them from the state again.
    pub(crate) fn hide_followed(&mut self) {
        for follows in &self.system.nonlinear.follows {
            self.state.motion.a[follows.unknown as usize] = 0.0;
        }
    }

    /// Energies of the assemblies begin with the dynamics. `bodies`: of the state.
    pub(crate) fn start_assemblies(&mut self, bodies: &[BodyEnergy]) {
        self.state.assemblies = AssemblyEnergies::default();
        if self.is_static() {
            return;
        }
        let inertia = self.inertia_of_identity();
        let (system, work) = (&*self.system, &mut self.vectors.work);
        let motion = &self.state.motion;
        let mut inertial = vec![0.0; system.unknowns()];
        system.mass.multiply(&motion.a, &mut inertial);
        system.mass.multiply(&motion.v, work);
        let none = vec![0.0; system.unknowns()];
        let part = |number: usize| {
            let unknowns = system.parts[number].clone();
            let square = unknowns.map(|i| motion.a[i] * inertial[i]).sum::<f64>();
            PartMotion {
                of_scheme: inertia * square,
                ..motion_of(system, number, ([&none; 2], motion), work)
            }
        };
        self.state.assemblies = AssemblyEnergies::start(system, part);
        if system.is_nonlinear() {
            self.state.assemblies.store(bodies);
        }
        self.state.records.small.begin_dynamics();
    }

    /// The exchange of momentum begins with the dynamics.
    pub(crate) fn start_exchange(&mut self) {
        self.state.exchange = Exchange::default();
        if self.is_static() {
            return;
        }
        let system = &*self.system;
        let work = &mut self.vectors.work;
        system.mass.multiply(&self.state.motion.v, work);
        let f = &self.state.forces;
        let of = |force: &[f64], i: usize| force.get(i).copied().unwrap_or(0.0);
        let held = |i: usize| match system.fixed[i] {
            true => of(&f.contact, i),
            false => 0.0,
        };
        let outside = |i: usize| of(&f.load, i) + of(&f.reaction, i) + held(i) + of(&f.link, i);
        let own: Vec<f64> = (0..system.unknowns())
            .map(|i| outside(i) - of(&f.damping, i) - of(&f.spring, i))
            .collect();
        let held: Vec<f64> = (0..system.unknowns()).map(|i| -held(i)).collect();
        self.state.exchange = Exchange::start(system, work, [&own, &held]);
    }

    /// Whether loads and internal forces of the state balance where no support does it.
    pub(crate) fn is_balanced(&self) -> bool {
        let (load, internal) = (&self.vectors.load, &self.state.motion.internal_force);
        let (mut left, mut size) = (0.0, 0.0);
        for i in (0..load.len()).filter(|&i| !self.system.fixed[i]) {
            let motion = &self.state.motion;
            let outside = load[i] + motion.contact_force[i] + motion.link_of(i);
            left += (outside - internal[i]).powi(2);
            size += load[i].powi(2) + internal[i].powi(2);
        }
        let tolerance = self.system.nonlinear.iteration.tolerance;
        left <= tolerance * tolerance * size
    }
}
