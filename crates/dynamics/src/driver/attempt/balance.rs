//! Forces and motion at the end of an attempt, as its balance takes them.

use carom_contact::Target;

use super::Attempt;
use super::vectors::Vectors;
use crate::records::Pushed;
use crate::scheme::EnergyIdentity;
use crate::step_forces::StepForces;
use crate::step_map::Impulse;

impl Attempt {
    /// Displacements and velocities of unknowns that follow a motion.
    pub(crate) fn follow_motions(&mut self) {
        let system = &*self.system;
        let (old, new) = (&self.state.motion, &mut self.next.motion);
        let time = [self.state.time, self.state.time + self.dt];
        system.nonlinear.prescribe(time, &mut new.u);
        for follows in &system.nonlinear.follows {
            let i = follows.unknown as usize;
            // the mean rate: the end rate of a mid-point rule would swing about it
            (new.v[i], new.a[i]) = ((new.u[i] - old.u[i]) / self.dt, 0.0);
        }
    }

    /// Weights of the forces at the start ([`Impulse`](crate::step_map::Impulse)) and of the step in their works, by zone.
    pub(crate) fn weights(&self) -> Vec<[f64; 2]> {
        let zones = 0..self.maps.all().len();
        zones.map(|zone| self.weights_of(zone)).collect()
    }

    /// The same of one zone.
    pub(super) fn weights_of(&self, zone: usize) -> [f64; 2] {
        let impulse = &self.maps.all()[zone].impulse;
        match (self.is_plain(), self.maps.is_static()) {
            _ if self.state.forces.is_empty() => [0.0, 1.0],
            (true, _) => [impulse.of_start(), impulse.new],
            // along a static step forces go from one equilibrium to the next
            (false, true) => [0.5, 0.5],
            (false, false) => [0.0, 1.0],
        }
    }

    /// Whether the forces of a dynamic step change the momentum as they are, or in stages by their sums.
    pub(crate) fn is_plain(&self) -> bool {
        let staged = self.stage.is_one_of_several();
        let mut impulses = self.maps.all().iter().map(|map| &map.impulse);
        !self.maps.is_static()
            && impulses.all(|one| one.gain == 1.0 && (one.carry == 0.0 || staged))
    }

    /// What forces of friction and of obstacles weigh at the start and in the step in their works. In stages they are not kept as the momentum
    /// takes them: the force of the stage keeps its weight, and that at its start has what is left of 1.
    pub(crate) fn weights_as_told(&self, weights: [f64; 2]) -> [f64; 2] {
        match self.stage.is_one_of_several() && !self.maps.is_static() {
            true => [1.0 - weights[1], weights[1]],
            false => weights,
        }
    }

    /// |a|²_M at the start of the step, as far as the identity asks for it.
    pub(crate) fn acceleration_at_the_start(&mut self, identity: &EnergyIdentity) -> f64 {
        if identity.inertia == 0.0 {
            return 0.0;
        }
        let motion = &self.state.motion;
        if self.maps.only().is_none() {
            return self.maps.square_of_acceleration(&self.system, motion);
        }
        let work = &mut self.vectors.work;
        self.system.mass.multiply(&motion.a, work);
        carom_algebra::reduce::dot(&motion.a, work)
    }

    pub(crate) fn weights_of_forces(&self) -> Weights {
        let forces = self.weights();
        let pushes = !self.vectors.push.is_empty();
        Weights {
            // forces that push by themselves are in no other force of the balance
            contacts: match pushes {
                true => vec![[0.0, 1.0]; forces.len()],
                false => forces.clone(),
            },
            forces,
            pushes,
        }
    }

    /// Work of the contact forces, J, as the identity of the scheme counts it, whichever forces the balance takes. `touch`: that in the balance.
    pub(crate) fn counted_work(&self, touch: f64, of: &Weights) -> f64 {
        let factor = self.contact_factor();
        let counted = self.identity.is_some().then(|| self.work_weights());
        let (old, new) = (&self.state.motion, &self.next.motion);
        match counted {
            Some(weights) if weights.differ(of.contacts[0].map(|weight| weight * factor)) => {
                let moved = |i: usize| {
                    let change = new.v[i] - old.v[i];
                    new.u[i] - old.u[i] - weights.lag * change
                };
                let travel: Vec<f64> = (0..new.u.len()).map(moved).collect();
                weights.of([old, new], &travel)
            }
            _ => touch,
        }
    }

    /// How far the translation of an obstacle goes in the step, m; `None` where it does not move.
    pub(crate) fn way_of_obstacle(&self, contact: usize) -> Option<[f64; 3]> {
        match &self.system.contacts[contact].target {
            Target::Rigid(obstacle) if obstacle.motion.moves() => {
                let [from, to] = [self.state.time, self.state.time + self.dt];
                let (from, to) = (obstacle.displacement(from), obstacle.displacement(to));
                Some([0, 1, 2].map(|i| to[i] - from[i]))
            }
            Target::Rigid(_) | Target::Surface(_) => None,
        }
    }

    /// That of the obstacle of one contact, without the factor of contact forces; `None` where it does not move.
    pub(crate) fn work_of_obstacle(
        &self,
        contact: usize,
        weights: [f64; 2],
        pushed: Pushed,
    ) -> Option<f64> {
        let way = self.way_of_obstacle(contact)?;
        let pushed = [self.state.records.contacts[contact].pushed, pushed];
        let work = |pushed: &Pushed| dot(&pushed.force, &way) + self.dt * pushed.turn;
        Some(weights[0] * work(&pushed[0]) + weights[1] * work(&pushed[1]))
    }

    pub(crate) fn weights_of_work(&self, contact: usize) -> super::identity::WorkWeights {
        match self.system.is_nonlinear() {
            false => self.work_weights(),
            true => {
                let impulse = self.contact_impulse(contact);
                super::identity::WorkWeights {
                    old: match self.stage.is_one_of_several() {
                        true => impulse.of_start(),
                        false => impulse.old,
                    },
                    new: impulse.new,
                    lag: 0.0,
                }
            }
        }
    }

    /// How the forces of a contact change the momentum; of a static step, which changes none, how they count in its works, as all forces
    /// do there.
    pub(crate) fn contact_impulse(&self, contact: usize) -> Impulse {
        match self.maps.is_static() {
            true => {
                let [old, new] = self.weights_of(self.system.zone_of(contact));
                Impulse::weights(old, new)
            }
            false => self.map_of(contact).contact_impulse,
        }
    }
}

/// Weights of the forces at the start and of the step in their means, by zone.
pub(crate) struct Weights {
    pub(crate) forces: Vec<[f64; 2]>,
    pub(crate) contacts: Vec<[f64; 2]>,
    /// Whether contact forces push by themselves.
    pub(crate) pushes: bool,
}

/// The forces in the balance of the step.
pub(crate) fn balanced<'a>(
    vectors: &'a Vectors,
    link: &'a [f64],
    [contact, reaction, spring]: [&'a [f64]; 3],
) -> StepForces<&'a [f64]> {
    StepForces {
        load: &vectors.load,
        contact,
        reaction,
        inertia: &vectors.inertia,
        internal: &vectors.balanced,
        damping: &vectors.damping,
        link,
        spring,
    }
}

pub(crate) fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}
