//! How ranks begin: the first one with the whole system and its state, each other with the part of both that it has.
//!
//! The first rank shares the elements out, and begins the run, anew or from a checkpoint. Each other builds its part of the system from the model, with
//! what the first one tells it of the whole, and is given the part of the state that belongs to its nodes and elements.

use std::sync::Arc;

use carom_bodies::{Looks, Solid};
use carom_ranks::{Message, Ranks};

use super::halo::{AtNodes, contact_nodes};
use super::parts::{Partition, SharedNodes, ask};
use crate::error::Error;
use crate::state::State;
use crate::system::{Kept, Model, Motion, System};

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

/// Who has what of a system: of the whole on the first rank; on another one of the part [around](System::around) its elements.
pub(crate) struct Begin {
    partition: Partition,
    at_nodes: AtNodes,
    /// Nodes at which any contact looks, ascending.
    of_contacts: Vec<u32>,
    /// Places of the elements of each body among those of the whole body; none on the first rank.
    places: Option<Vec<Vec<u32>>>,
    /// What the first one has told another rank of the whole.
    facts: Vec<f64>,
}

impl Begin {
    /// On the first rank, which tells the others what they need to know.
    ///
    /// # Errors
    /// [`Error::Partition`].
    pub(crate) fn first(system: &System, ranks: &Ranks) -> Result<Begin, Error> {
        let partition = Partition::of(system, ranks);
        // others are given something after an error too: they ask for it
        let mut told = Vec::new();
        if let Ok(partition) = &partition {
            let facts = system.facts_of_whole();
            told.extend([system.dt, facts.len() as f64]);
            told.extend(facts);
            told.extend(partition.numbers());
        }
        ranks.broadcast(&mut told);
        Ok(Begin::new(system, partition?, None, Vec::new()))
    }

    /// On another rank, with its elements and those around them.
    ///
    /// # Errors
    /// As [`Begin::first`]; a part that cannot be built.
    pub(crate) fn other(mut model: Model, ranks: &Ranks) -> Result<(System, Begin), Error> {
        let asked = ask(ranks);
        let mut told = Vec::new();
        ranks.broadcast(&mut told);
        asked?;
        let [dt, count, told @ ..] = &told[..] else {
            return Err(Error::Partition("the first rank has none".into()));
        };
        let (facts, parts) = told.split_at(*count as usize);
        let mut partition = Partition::of_numbers(parts);
        model.dt = *dt;
        let (system, places) = System::around(model, &partition.of_bodies, ranks.rank() as u32)?;
        for (parts, places) in partition.of_bodies.iter_mut().zip(&places) {
            *parts = places.iter().map(|place| parts[*place as usize]).collect();
        }
        let begin = Begin::new(&system, partition, Some(places), facts.to_vec());
        Ok((system, begin))
    }

    fn new(
        system: &System,
        partition: Partition,
        places: Option<Vec<Vec<u32>>>,
        facts: Vec<f64>,
    ) -> Begin {
        let mut of_contacts = contact_nodes(system, |_| true);
        let faces = system.secondary_faces.iter().flatten();
        of_contacts.extend(faces.flat_map(|face| face.corners()));
        of_contacts.sort_unstable();
        of_contacts.dedup();
        Begin {
            at_nodes: AtNodes::new(system, &partition.of_bodies),
            partition,
            of_contacts,
            places,
            facts,
        }
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

    /// On another rank, its part of the system without the elements around, and its elements.
    pub(crate) fn of_other(self, rank: usize, around: &System) -> (Arc<System>, Own) {
        let kept = self.kept(rank);
        let mut system = around.part(&kept);
        system.know_whole(&self.facts);
        let own = kept.elements.iter().zip(self.places.iter().flatten());
        let in_whole = |(own, places): (&Vec<u32>, &Vec<u32>)| {
            let own = own.iter().map(|place| places[*place as usize]);
            own.collect()
        };
        let own = Own {
            places: Some(own.map(in_whole).collect()),
            ranks: kept
                .elements
                .iter()
                .map(|places| vec![rank as u32; places.len()])
                .collect(),
            at_nodes: self.at_nodes.some(&kept.nodes),
            shared_nodes: self.partition.shared,
        };
        (Arc::new(system), own)
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
                    own.iter()
                        .map(place)
                        .for_each(|place| visit(looks, place, numbers));
                }
            }
        }
    }
}
