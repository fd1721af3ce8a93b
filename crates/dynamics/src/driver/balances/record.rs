//! Reactions and totals of a step.

use std::sync::Arc;

use super::Balances;
use crate::assembly_energy::PartMotion;
use crate::body_energies::BodyEnergy;
use crate::driver::attempt::Attempt;
use crate::driver::contacts::Contacts;
use crate::exchange::sum;
use crate::system::{Motion, System};

/// A connected part at the end of a step from displacements and internal forces to a motion. `momentum`: M v of it, by unknown.
pub(crate) fn motion_of(
    system: &System,
    part: usize,
    ([u, force], new): ([&Vec<f64>; 2], &Motion),
    momentum: &[f64],
) -> PartMotion {
    let range = &system.parts[part];
    let mut motion = PartMotion {
        momentum: sum(system, range, momentum),
        ..PartMotion::default()
    };
    for i in range.clone() {
        motion.kinetic += 0.5 * momentum[i] * new.v[i];
        motion.taken += 0.5 * (force[i] + new.internal_force[i]) * (new.u[i] - u[i]);
    }
    motion
}

impl Balances {
    /// Energies of the assemblies at the end of the step, whose momenta M v are in `work`. `bodies`: energies there.
    pub(crate) fn balance_assemblies(
        &mut self,
        contacts: &Contacts,
        attempt: &mut Attempt,
        bodies: &[BodyEnergy],
    ) {
        self.work_of_obstacles(contacts, attempt);
        let inertia = attempt.inertia_of_identity();
        let system = Arc::clone(&attempt.system);
        let system = &*system;
        let (old, new) = (&attempt.state.motion, &attempt.next.motion);
        let (vectors, given) = (&mut attempt.vectors, &self.works.given);
        if inertia != 0.0 {
            system.mass.multiply(&new.a, &mut vectors.half);
        }
        let has_damping = system.has_damping();
        let part = |number: usize| {
            let sum = |of: &dyn Fn(usize) -> f64| system.parts[number].clone().map(of).sum::<f64>();
            let mut motion = motion_of(
                system,
                number,
                ([&old.u, &old.internal_force], new),
                &vectors.work,
            );
            if has_damping {
                motion.damped = sum(&|i| vectors.damping[i] * (new.u[i] - old.u[i]));
            }
            if inertia != 0.0 {
                motion.of_scheme = inertia * sum(&|i| vectors.half[i] * new.a[i]);
            }
            motion.given = given.get(number).copied().unwrap_or(0.0);
            motion
        };
        let motions: &mut Vec<PartMotion> = &mut self.works.motions;
        motions.clear();
        motions.extend((0..system.parts.len()).map(part));
        let motions = std::mem::take(motions);
        self.add_to_assemblies(attempt, motions, bodies);
    }

    /// Adds the end of a step to the energies of the assemblies. `motions`: by connected part; `bodies`: energies at the end.
    pub(crate) fn add_to_assemblies(
        &mut self,
        attempt: &mut Attempt,
        mut motions: Vec<PartMotion>,
        bodies: &[BodyEnergy],
    ) {
        let assemblies = &mut attempt.next.assemblies;
        assemblies.follow(&attempt.state.assemblies);
        if attempt.system.is_nonlinear() {
            self.works
                .balance_materials(&attempt.system, &mut motions, (assemblies, bodies));
            assemblies.store(bodies);
        }
        let records = &attempt.next.records.contacts[..];
        assemblies.add(&attempt.system, &motions, (records, &self.works.obstacles));
        self.works.motions = motions;
    }
}
