//! How ranks begin: the first one with the whole system, each other with the part that it has.
//!
//! The first rank shares the elements out. Each other builds its part of the system from the model, with what the first one tells it of the whole.

use std::sync::Arc;

use carom_ranks::Ranks;

use super::halo::{AtNodes, contact_nodes};
use super::parts::{Partition, SharedNodes};
use crate::error::Error;
use crate::system::{Kept, Model, System};

/// The elements of the bodies that a rank has, and who has their nodes.
pub(crate) struct OwnElements {
    /// The rank of each element of each body of this rank's system.
    pub(super) ranks: Vec<Vec<u32>>,
    pub(super) at_nodes: AtNodes,
    pub(super) shared_nodes: SharedNodes,
    /// Places of the elements of each body among those of the whole body; none on the first rank, which has these.
    places: Option<Vec<Vec<u32>>>,
}

impl OwnElements {
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
        let mut told = Vec::new();
        ranks.broadcast(&mut told);
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
        let faces = system
            .contacts
            .iter()
            .flat_map(|pair| &pair.secondary_faces);
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
    pub(super) fn kept(&self, rank: usize) -> Kept {
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
    pub(crate) fn of_first(self) -> OwnElements {
        OwnElements {
            ranks: self.partition.of_bodies,
            at_nodes: self.at_nodes,
            shared_nodes: self.partition.shared,
            places: None,
        }
    }

    /// On another rank, its part of the system without the elements around, and its elements.
    pub(crate) fn of_other(self, rank: usize, around: &System) -> (Arc<System>, OwnElements) {
        let kept = self.kept(rank);
        let mut system = around.part(&kept);
        system.know_whole(&self.facts);
        let own = kept.elements.iter().zip(self.places.iter().flatten());
        let in_whole = |(own, places): (&Vec<u32>, &Vec<u32>)| {
            let own = own.iter().map(|place| places[*place as usize]);
            own.collect()
        };
        let own = OwnElements {
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
}
