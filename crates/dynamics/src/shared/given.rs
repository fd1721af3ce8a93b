//! The state with which ranks begin: the first one begins the run, anew or from a checkpoint, and gives each other what belongs to its nodes and
//! elements, and all of the rest.

use carom_bodies::{Looks, Solid};
use carom_ranks::{Message, Ranks};

use super::begin::Begin;
use crate::error::Error;
use crate::state::State;
use crate::step_forces::StepForces;
use crate::system::{Kept, Motion, System};

impl Begin {
    /// Gives the other ranks their parts of the state of the first one, this.
    ///
    /// # Errors
    /// None is known; the encoder's own error is passed on.
    pub(crate) fn give(
        &self,
        (system, ranks): (&System, &Ranks),
        state: &mut State,
    ) -> Result<(), Error> {
        let mut arrays = Arrays::take(state);
        let rest = state.to_bytes();
        // others are given something after an error too: they ask for it
        ranks.broadcast_bytes(rest.as_deref().unwrap_or_default());
        ranks.broadcast(&mut arrays.sizes());
        for with in 1..ranks.count() {
            let kept = self.kept(with);
            let mut values = Vec::new();
            arrays.each(system, &kept, &mut |number| values.push(*number));
            arrays.each_look(system, &kept, &mut |looks, (element, _), _| {
                looks.push(element, &mut values);
            });
            ranks.exchange(&[Message { with, values }], &mut [], || ());
        }
        arrays.put_back(state);
        rest.map(|_| ())
    }
}

/// The part of the state that the first rank gives this one, of its `system`.
///
/// # Errors
/// What is given is no state.
pub(crate) fn receive(system: &System, ranks: &Ranks) -> Result<State, Error> {
    let rest = ranks.broadcast_bytes(&[]);
    let mut sizes = Vec::new();
    ranks.broadcast(&mut sizes);
    let mut arrays = Arrays::of_sizes(system, &sizes);
    let all = Kept {
        nodes: (0..system.x.len() as u32).collect(),
        elements: system
            .bodies
            .iter()
            .map(|body| (0..body.cells().len() as u32).collect())
            .collect(),
    };
    let mut count = 0;
    arrays.each(system, &all, &mut |_| count += 1);
    arrays.each_look(system, &all, &mut |_, _, numbers| count += numbers);
    let mut message = [Message {
        with: 0,
        values: vec![0.0; count],
    }];
    ranks.exchange(&[], &mut message, || ());
    let mut values = &message[0].values[..];
    let mut take = |count: usize| {
        let (own, rest) = values.split_at(count);
        values = rest;
        own
    };
    arrays.each(system, &all, &mut |number| *number = take(1)[0]);
    arrays.each_look(system, &all, &mut |looks, place, numbers| {
        looks.take(place, take(numbers));
    });
    let mut state = State::decode(&rest)?;
    arrays.put_back(&mut state);
    // nobody here sees whole states
    state.crossings = None;
    state.check(system)?;
    Ok(state)
}

/// Who is shown the looks of a body, the place of an element among all that are looked at there, and how many numbers it has.
type VisitLook<'a> = dyn FnMut(&mut Looks, (usize, usize), usize) + 'a;

/// What a state has of each node and of each element.
struct Arrays {
    /// Displacement, velocity, acceleration, internal and contact force.
    motion: [Vec<f64>; 5],
    history: Vec<f64>,
    forces: StepForces<Vec<f64>>,
    looks: Vec<Looks>,
    /// Of each body whether anything is known of the frequencies of its elements.
    looked: Vec<bool>,
}

impl Arrays {
    /// Takes them out of a state.
    fn take(state: &mut State) -> Arrays {
        let Motion {
            u,
            v,
            a,
            internal_force,
            contact_force,
            history,
            ..
        } = std::mem::take(&mut state.motion);
        let looks = std::mem::take(&mut state.shapes.looks);
        Arrays {
            motion: [u, v, a, internal_force, contact_force],
            history,
            forces: std::mem::take(&mut state.forces),
            looked: looks.iter().map(|looks| !looks.is_empty()).collect(),
            looks,
        }
    }

    fn put_back(self, state: &mut State) {
        let [u, v, a, internal_force, contact_force] = self.motion;
        state.motion = Motion {
            u,
            v,
            a,
            internal_force,
            contact_force,
            history: self.history,
            ..Motion::default()
        };
        state.forces = self.forces;
        state.shapes.looks = self.looks;
    }

    /// Whether each of the forces has entries, and of which bodies there are looks.
    fn sizes(&self) -> Vec<f64> {
        let forces = self.forces.each().map(|force| !force.is_empty());
        let flags = forces.into_iter().chain(self.looked.iter().copied());
        flags.map(f64::from).collect()
    }

    /// Room for those of a part of the system.
    fn of_sizes(system: &System, sizes: &[f64]) -> Arrays {
        let mut forces = StepForces::default();
        let (has, looked) = sizes.split_at(forces.each().len());
        let vector = || vec![0.0; system.unknowns()];
        for (force, has) in forces.each_mut().into_iter().zip(has) {
            if *has != 0.0 {
                *force = vector();
            }
        }
        Arrays {
            motion: [0; 5].map(|_| vector()),
            history: system.start_histories(),
            forces,
            looks: vec![Looks::default(); looked.len()],
            looked: looked.iter().map(|has| *has != 0.0).collect(),
        }
    }

    /// Visits the numbers of some nodes and elements, but for what is known of frequencies.
    fn each(&mut self, system: &System, of: &Kept, visit: &mut dyn FnMut(&mut f64)) {
        let dim = system.dim;
        let vectors = self.motion.iter_mut().chain(self.forces.each_mut());
        for vector in vectors.filter(|vector| !vector.is_empty()) {
            for &node in &of.nodes {
                let entries = &mut vector[dim * node as usize..][..dim];
                entries.iter_mut().for_each(&mut *visit);
            }
        }
        let histories = system.bodies.iter().zip(&system.nonlinear.histories);
        for ((body, range), own) in histories.zip(&of.elements) {
            let (mut at, mut own) = (range.start, own.iter().peekable());
            let kept = body
                .as_solid()
                .into_iter()
                .flat_map(Solid::kept_of_elements);
            for (place, kept) in (0..).zip(kept) {
                if own.next_if(|own| **own == place).is_some() {
                    self.history[at..at + kept].iter_mut().for_each(&mut *visit);
                }
                at += kept;
            }
        }
    }

    /// Visits what is known of the frequencies of some elements. Of a body whose frequencies never change one stands for all.
    fn each_look(&mut self, system: &System, of: &Kept, visit: &mut VisitLook) {
        let bodies = system.bodies.iter().zip(&of.elements);
        let looks = self.looks.iter_mut().zip(&self.looked);
        for ((body, own), (looks, _)) in bodies.zip(looks).filter(|(_, (_, looked))| **looked) {
            match body.as_solid().and_then(Solid::numbers_of_look) {
                None => visit(looks, (0, 1), 2),
                Some(numbers) => {
                    let place = |place: &u32| (*place as usize, own.len());
                    own.iter()
                        .map(place)
                        .for_each(|place| visit(looks, place, numbers));
                }
            }
        }
    }
}
