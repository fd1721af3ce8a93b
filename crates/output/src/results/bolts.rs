//! Forces of the bolts that the static stage tightens.

use std::collections::BTreeMap;

use carom_bodies::Bolt;
use carom_dynamics::{State, System};
use serde::{Deserialize, Serialize};

use crate::summary::Pretension;

/// What each bolt bore so far, in the order of [`each`].
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct BoltForces {
    bolts: Vec<Pretension>,
}

/// All bolts of a system, each with the force that it keeps beside its stiffness.
pub(crate) fn each<'a>(
    system: &'a System,
    state: &'a State,
) -> impl Iterator<Item = (&'a Bolt, f64)> {
    let bodies = system.bodies.iter().enumerate();
    bodies.flat_map(|(number, body)| {
        let history = system.history(number, &state.motion.history);
        body.bolts().iter().zip(history.iter().copied())
    })
}

impl BoltForces {
    /// Whether this can be gone on with for a system.
    pub(crate) fn is_of(&self, system: &System) -> bool {
        let count: usize = system.bodies.iter().map(|body| body.bolts().len()).sum();
        [0, count].contains(&self.bolts.len())
    }

    /// Takes the forces at the end of a step.
    pub(crate) fn push(&mut self, system: &System, state: &State) {
        if !system.has_bolts || state.step < system.static_steps() {
            return;
        }
        for (number, (bolt, kept)) in each(system, state).enumerate() {
            let force = bolt.tension(&state.motion.u, kept);
            if number == self.bolts.len() {
                self.bolts.push(Pretension::default());
            }
            let found = &mut self.bolts[number];
            if state.step == system.static_steps() {
                found.end_of_stage = Some(force);
                continue;
            }
            let at = [force, state.time];
            found.largest = found
                .largest
                .filter(|so_far| so_far[0] >= force)
                .or(Some(at));
            found.smallest = found
                .smallest
                .filter(|so_far| so_far[0] <= force)
                .or(Some(at));
            found.last = Some(force);
        }
    }

    /// By name.
    pub(crate) fn all(&self, system: &System) -> BTreeMap<String, Pretension> {
        let bolts = system.bodies.iter().flat_map(|body| body.bolts());
        let told = bolts.zip(&self.bolts).map(|(bolt, found)| {
            let loss = match (found.end_of_stage, found.last) {
                (Some(start), Some(last)) if start > 0.0 => Some(1.0 - last / start),
                _ => None,
            };
            (bolt.name.clone(), Pretension { loss, ..*found })
        });
        told.collect()
    }
}
