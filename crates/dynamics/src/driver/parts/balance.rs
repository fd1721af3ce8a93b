//! Internal forces and energies of the parts at the end of a step.

use std::sync::Arc;

use super::Parts;
use crate::driver::attempt::Attempt;
use crate::driver::attempt::identity::{End, difference, energies};
use crate::driver::attempt::vectors::Vectors;
use crate::scheme::EnergyIdentity;
use crate::step_terms::Energies;
use crate::tolerated::Tolerated;

impl Parts {
    /// Internal forces of linear bodies where the balance of the step takes them.
    pub(crate) fn balance_linear_forces(&mut self, attempt: &mut Attempt) {
        if attempt
            .maps
            .all()
            .iter()
            .any(|map| map.force_fraction.is_none())
        {
            let Vectors { x, push, place, .. } = &mut attempt.vectors;
            attempt
                .maps
                .whole(|map| map.force, &attempt.state.motion, [x, push], place);
            self.linear_forces(attempt);
            let Vectors { balanced, work, .. } = &mut attempt.vectors;
            balanced.copy_from_slice(work);
        }
        let (old, new) = (
            &attempt.state.motion.internal_force,
            &attempt.vectors.internal,
        );
        for (span, map) in attempt.maps.spans() {
            let Some(part) = map.force_fraction else {
                continue;
            };
            for i in span {
                attempt.vectors.balanced[i] = (1.0 - part) * old[i] + part * new[i];
            }
        }
    }

    /// Energies of the end, with what the scheme balances beside.
    pub(crate) fn energies_at_the_end(
        &mut self,
        attempt: &mut Attempt,
        identity: &EnergyIdentity,
    ) -> Energies {
        let strain = self.stored().strain;
        let [memory, lagged] = self.own_energies(attempt, End::Finish, identity, strain);
        let (system, new) = (&*attempt.system, &attempt.next.motion);
        let of = (strain, identity.inertia != 0.0, Some(&new.u[..]));
        let found = energies(system, new, of, &mut attempt.vectors.work);
        Energies {
            memory,
            lagged,
            ..found.of_zones(&attempt.maps, system, new)
        }
    }

    /// What the iterations of the step may leave of energy and momentum.
    pub(crate) fn tolerated(&self, attempt: &Attempt) -> Tolerated {
        let (old, new) = (&attempt.state.motion.u, &attempt.next.motion.u);
        let travel = (0..new.len()).map(|i| (new[i] - old[i]).powi(2));
        let nodes = attempt.system.nodes_of_whole as f64;
        Tolerated {
            energy: self.left_over * travel.sum::<f64>().sqrt(),
            momentum: self.left_over * nodes.sqrt() * attempt.dt,
        }
    }

    /// The term of the scheme in the energy of the ledger, at the start of the step, J.
    pub(crate) fn own_energy_at_the_start(
        &mut self,
        attempt: &mut Attempt,
        identity: &EnergyIdentity,
    ) -> f64 {
        let strain = attempt.state.ledger.balance.strain;
        let [memory, lagged] = self.own_energies(attempt, End::Start, identity, strain);
        let acceleration = attempt.acceleration_at_the_start(identity);
        identity.inertia * acceleration + identity.memory * memory + lagged
    }

    /// Energies of a motion with this strain energy (J), those that the scheme balances beside included.
    pub(crate) fn energies_at(&mut self, attempt: &mut Attempt, end: End, strain: f64) -> Energies {
        let system = Arc::clone(&attempt.system);
        let identity = attempt.identity.unwrap_or_default();
        let [memory, lagged] = self.own_energies(attempt, end, &identity, strain);
        let motion = match end {
            End::Start => &attempt.state.motion,
            End::Finish => &attempt.next.motion,
        };
        let work = &mut attempt.vectors.work;
        let with_acceleration = identity.inertia != 0.0;
        Energies {
            memory,
            lagged,
            ..energies(&system, motion, (strain, with_acceleration, None), work)
        }
    }

    /// |m|²_K and U(u - lag v) - U(u) of a motion with this strain energy, J, as far as the identity asks for them; of linear bodies.
    pub(crate) fn own_energies(
        &mut self,
        attempt: &mut Attempt,
        end: End,
        identity: &EnergyIdentity,
        strain: f64,
    ) -> [f64; 2] {
        let mut place = std::mem::take(&mut attempt.vectors.place);
        let mut lagged = 0.0;
        if identity.lag != 0.0 {
            let motion = attempt.motion_at(end);
            for (i, place) in place.iter_mut().enumerate() {
                *place = motion.u[i] - identity.lag * motion.v[i];
            }
            attempt.vectors.place = place;
            lagged = self.linear_forces(attempt) - strain;
            place = std::mem::take(&mut attempt.vectors.place);
        }
        let mut memory = 0.0;
        if identity.memory != 0.0 {
            place.copy_from_slice(&attempt.motion_at(end).memory);
            attempt.vectors.place = place;
            // U is quadratic
            memory = 2.0 * self.linear_forces(attempt);
            place = std::mem::take(&mut attempt.vectors.place);
        }
        attempt.vectors.place = place;
        [memory, lagged]
    }

    /// Energies of the state, with what the scheme of the step balances.
    pub(crate) fn energies_at_the_start(&mut self, attempt: &mut Attempt, strain: f64) -> Energies {
        self.energies_at(attempt, End::Start, strain)
    }

    /// |Δm|²_K of the step, as far as the identity asks for it.
    pub(crate) fn filtered(&mut self, attempt: &mut Attempt, identity: &EnergyIdentity) -> f64 {
        if identity.filtered == 0.0 {
            return 0.0;
        }
        let [old, new] = [&attempt.state, &attempt.next].map(|state| &state.motion.memory);
        difference(old, new, &mut attempt.vectors.place);
        2.0 * self.linear_forces(attempt)
    }
}
