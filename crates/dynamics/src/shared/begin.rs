//! How ranks begin: the first one with the whole system and its state, each other with the part of both that it has.
//!
//! All ranks build the whole system, find the same partition of its elements, and know from it what each of them keeps. The first one then begins the
//! run, anew or from a checkpoint, and gives each other the part of the state that belongs to its nodes and elements.

use std::sync::Arc;

use carom_bodies::{Looks, Solid};
use carom_ranks::{Message, Ranks};

use super::halo::{AtNodes, contact_nodes};
use super::parts::{Partition, SharedNodes, partition_of};
use crate::error::Error;
use crate::march::Watched;
use crate::state::State;
use crate::system::{Kept, Motion, System};

/// The elements of the bodies that a rank has, and who has their nodes.
pub(crate) struct Own {
    /// The rank of each element of each body of this rank's system.
    pub(super) ranks: Vec<Vec<u32>>,
    pub(super) at_nodes: AtNodes,
    pub(super) shared_nodes: SharedNodes,
    /// Places of the elements of each body among those of the whole body; none on the first rank, which has these.
    places: Option<Vec<Vec<u32>>>,
}

impl Own {
    /// The place of an element of a body among those of the whole body.
    pub(super) fn place_in_whole(&self, body: usize, place: u32) -> u32 {
        match &self.places {
            None => place,
            Some(places) => places[body][place as usize],
        }
    }
}

/// Who has what of a system that is still whole on all ranks.
pub(crate) struct Begin {
    partition: Partition,
    at_nodes: AtNodes,
    /// Nodes at which any contact looks, ascending.
    of_contacts: Vec<u32>,
}

impl Begin {
    /// All ranks ask together.
    ///
    /// # Errors
    /// [`Error::Partition`].
    pub(crate) fn new(system: &System, ranks: &Ranks) -> Result<Begin, Error> {
        let partition = partition_of(system, ranks)?;
        let mut of_contacts = contact_nodes(system, |_| true);
        let faces = system.secondary_faces.iter().flatten();
        of_contacts.extend(faces.flat_map(|face| face.corners()));
        of_contacts.sort_unstable();
        of_contacts.dedup();
        Ok(Begin {
            at_nodes: AtNodes::new(system, &partition.of_bodies),
            partition,
            of_contacts,
        })
    }

    /// What another rank than the first keeps.
    fn kept(&self, rank: usize) -> Kept {
        let mut has = self.at_nodes.has(rank);
        for &node in &self.of_contacts {
            has[node as usize] = true;
        }
        let nodes = has.into_iter().zip(0..).filter(|(has, _)| *has);
        let own = |ranks: &Vec<u32>| {
            let own = ranks.iter().zip(0..);
            let own = own.filter(|(of, _)| **of as usize == rank);
            own.map(|(_, place)| place).collect()
        };
        Kept {
            nodes: nodes.map(|(_, node)| node).collect(),
            elements: self.partition.of_bodies.iter().map(own).collect(),
        }
    }

    /// The elements of the first rank, whose system is the whole.
    pub(crate) fn of_first(self) -> Own {
        Own {
            ranks: self.partition.of_bodies,
            at_nodes: self.at_nodes,
            shared_nodes: self.partition.shared,
            places: None,
        }
    }

    /// The elements of another rank. `system` becomes its part, and `watched` what of it is watched.
    pub(crate) fn of_other(
        self,
        rank: usize,
        system: &mut Arc<System>,
        watched: &mut Watched,
    ) -> Own {
        let kept = self.kept(rank);
        *system = Arc::new(system.part(&kept));
        let nodes = watched.nodes.iter();
        let own = nodes.filter_map(|node| kept.nodes.binary_search(node).ok());
        watched.nodes = own.map(|node| node as u32).collect();
        let count = |places: &Vec<u32>| vec![rank as u32; places.len()];
        Own {
            ranks: kept.elements.iter().map(count).collect(),
            at_nodes: self.at_nodes.some(&kept.nodes),
            shared_nodes: self.partition.shared,
            places: Some(kept.elements),
        }
    }

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
    state.check(system)?;
    Ok(state)
}

/// What a state has of each node and of each element.
struct Arrays {
    /// Displacement, velocity, acceleration, internal and contact force.
    motion: [Vec<f64>; 5],
    history: Vec<f64>,
    forces: Vec<Vec<f64>>,
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

    /// How many forces there are, whether each has entries, and of which bodies there are looks.
    fn sizes(&self) -> Vec<f64> {
        let forces = self.forces.iter().map(|force| !force.is_empty());
        let flags = forces.chain(self.looked.iter().copied()).map(f64::from);
        let count = std::iter::once(self.forces.len() as f64);
        count.chain(flags).collect()
    }

    /// Room for those of a part of the system.
    fn of_sizes(system: &System, sizes: &[f64]) -> Arrays {
        let (forces, looked) = sizes[1..].split_at(sizes[0] as usize);
        let vector = || vec![0.0; system.unknowns()];
        let force = |has: &f64| if *has == 0.0 { Vec::new() } else { vector() };
        Arrays {
            motion: [0; 5].map(|_| vector()),
            history: system.start_histories(),
            forces: forces.iter().map(force).collect(),
            looks: vec![Looks::default(); looked.len()],
            looked: looked.iter().map(|has| *has != 0.0).collect(),
        }
    }

    /// Visits the numbers of some nodes and elements, but for what is known of frequencies.
    fn each(&mut self, system: &System, of: &Kept, visit: &mut dyn FnMut(&mut f64)) {
        let dim = system.dim;
        let vectors = self.motion.iter_mut().chain(&mut self.forces);
        for vector in vectors.filter(|vector| !vector.is_empty()) {
            for &node in &of.nodes {
                let entries = &mut vector[dim * node as usize..][..dim];
                entries.iter_mut().for_each(&mut *visit);
            }
        }
        let histories = system.bodies.iter().zip(&system.nonlinear.histories);
        for ((body, range), own) in histories.zip(&of.elements) {
            let (mut at, mut own) = (range.start, own.iter().peekable());
            let kept = body.as_solid().into_iter().flat_map(Solid::kept_of_elements);
            for (place, kept) in (0..).zip(kept) {
                if own.next_if(|own| **own == place).is_some() {
                    self.history[at..at + kept].iter_mut().for_each(&mut *visit);
                }
                at += kept;
            }
        }
    }

    /// Visits what is known of the frequencies of some elements: the looks of each body, the place of an element among all that are looked at there,
    /// and how many numbers it has. Of a body whose frequencies never change one stands for all.
    fn each_look(
        &mut self,
        system: &System,
        of: &Kept,
        visit: &mut dyn FnMut(&mut Looks, (usize, usize), usize),
    ) {
        let bodies = system.bodies.iter().zip(&of.elements);
        let looks = self.looks.iter_mut().zip(&self.looked);
        for ((body, own), (looks, _)) in bodies.zip(looks).filter(|(_, (_, looked))| **looked) {
            match body.as_solid().and_then(Solid::numbers_of_look) {
                None => visit(looks, (0, 1), 2),
                Some(numbers) => {
                    let place = |place: &u32| (*place as usize, own.len());
                    own.iter().map(place).for_each(|place| visit(looks, place, numbers));
                }
            }
        }
    }
}
