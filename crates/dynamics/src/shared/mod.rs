//! A run that several processes compute together, in explicit steps.
//!
//! The first rank has the whole [`System`], each other [its part](begin): its own elements with their nodes, and those of all contacts. Each computes
//! the forces of its own elements, the motion of their nodes, and the contact points whose [home](homes) it is; other entries are those of some
//! earlier step, and nobody reads them. Sums over all
//! ranks end a step ([`Shared::sum_up`]), so that all have the same ledger and records. The first one has the results: what it needs of the others comes where somebody looks
//! ([`Shared::gather`]).

mod begin;
mod contacts;
mod given;
pub(crate) mod halo;
mod homes;
mod in_reach;
mod looks;
mod parts;
mod spread;
mod whole;

use carom_bodies::{Looks, Placement, Seen, Share};
use carom_ranks::{Message, Ranks};

use crate::blocks::{Block, blocks_of};
use crate::body_energies::BodyEnergies;
use crate::contact_sums::ContactSums;
use crate::error::Error;
use crate::march::{Scope, Watched};
use crate::records::ContactRecord;
use crate::resultant::Resultant;
use crate::state::State;
use crate::system::{Motion, System};
use crate::update::Sums;
pub(crate) use begin::{Begin, OwnElements};
pub(crate) use given::receive;
use halo::{Halo, contact_nodes, messages, pack, unpack};
pub(crate) use homes::{Own, Part};
pub(crate) use in_reach::InReach;
pub use parts::SharedNodes;

/// What a rank has of a run.
pub(crate) struct Shared {
    pub(crate) ranks: Ranks,
    pub(crate) halo: Halo,
    /// What is known of the faces that points may touch.
    pub(crate) in_reach: InReach,
    /// How often homes have been found.
    pub(crate) found_homes: usize,
    /// The most points of this rank so far that might touch something.
    pub(crate) looked: usize,
    own: OwnElements,
    watched: Watched,
    /// Of each body the elements at nodes that others may have too, and the others.
    bodies: Vec<[Share; 2]>,
    sends: Vec<Message>,
    receives: Vec<Message>,
    /// Forces of this rank's elements on the shared nodes, N.
    given: Vec<f64>,
    /// Forces of the contacts: those that this rank gives to others, and those that it is given.
    touches: Vec<Message>,
    touched: Vec<Message>,
    /// Numbers that are summed over the ranks, and those of which the largest counts.
    sums: Vec<f64>,
    largest: Vec<f64>,
    whole: whole::Whole,
    looks: looks::SharedLooks,
    points: contacts::SharedPoints,
    spread: spread::Spread,
}

/// What a step tells all ranks, beside its sums.
pub(crate) struct Told {
    /// Whether it has failed on any.
    pub(crate) failed: bool,
    /// Most passes of an interface problem.
    pub(crate) passes: usize,
}

impl Shared {
    /// Of this rank, in a state in which all nodes that it has are known. `own`: its elements, of solids.
    pub(crate) fn new(
        system: &System,
        ranks: &Ranks,
        (watched, own): (&Watched, OwnElements),
        (in_reach, state): (InReach, &State),
    ) -> Shared {
        let rank = ranks.rank();
        let mut shared = Shared {
            ranks: ranks.clone(),
            halo: Halo::default(),
            in_reach,
            found_homes: 0,
            looked: 0,
            watched: watched.clone(),
            bodies: Vec::new(),
            sends: Vec::new(),
            receives: Vec::new(),
            given: Vec::new(),
            touches: Vec::new(),
            touched: Vec::new(),
            sums: Vec::new(),
            largest: Vec::new(),
            whole: whole::Whole::new(system, &own.ranks, rank),
            looks: looks::SharedLooks::new(&own.ranks, ranks.count()),
            points: contacts::SharedPoints::default(),
            spread: spread::Spread::default(),
            own,
        };
        shared.in_reach.look(system, state, ranks);
        shared.find_homes(system);
        let mut border = vec![false; system.x.len()];
        let shared_later = contact_nodes(system, |contact| shared.in_reach.has(contact));
        for &node in shared.halo.shared.iter().chain(&shared_later) {
            border[node as usize] = true;
        }
        let shares = |(body, parts): (&carom_bodies::Body, &Vec<u32>)| {
            let (mut lists, mut place) = ([Vec::new(), Vec::new()], 0);
            body.each_element(&mut |nodes| {
                if parts[place as usize] as usize == rank {
                    let inside = !nodes.iter().any(|&node| border[node as usize]);
                    lists[usize::from(inside)].push(place);
                }
                place += 1;
            });
            body.as_solid()
                .map(|solid| lists.map(|list| solid.share(list)))
        };
        let bodies = system.bodies.iter().zip(&shared.own.ranks);
        shared.bodies = bodies.filter_map(shares).collect();
        shared
    }

    /// Finds which rank has which contact points.
    fn find_homes(&mut self, system: &System) {
        let (rank, dim) = (self.ranks.rank(), system.dim);
        let at_nodes = &self.own.at_nodes;
        let halo = Halo::new(system, (at_nodes, &self.in_reach.faces), rank);
        self.sends = messages(&halo.sends, dim);
        self.receives = messages(&halo.receives, dim);
        self.given = vec![0.0; dim * halo.shared.len()];
        self.touches = messages(&halo.touches, dim);
        self.touched = messages(&halo.touched, dim);
        self.points = contacts::SharedPoints::new(system, (&halo, rank), &self.watched);
        self.spread = spread::Spread::new(system, &self.in_reach, &halo, self.ranks.count());
        self.whole.take(system, (&halo, rank), &self.watched.nodes);
        self.halo = halo;
        self.found_homes += 1;
    }

    /// Looks for the faces that points may touch; whether contact points have other homes now, which know the motion of their nodes then. All
    /// ranks ask together.
    pub(crate) fn look_for_faces(&mut self, system: &System, state: &mut State) -> bool {
        self.spread.give_places(&self.ranks, system.dim, state);
        if !self.in_reach.look(system, state, &self.ranks) {
            return false;
        }
        let (last, before) = (
            std::mem::take(&mut self.halo),
            std::mem::take(&mut self.spread),
        );
        self.find_homes(system);
        let homes = [&last.homes, &self.halo.homes];
        before.give((&self.ranks, system.dim), homes, state);
        true
    }

    /// Whether this is the first rank.
    pub(crate) fn is_first(&self) -> bool {
        self.ranks.is_first()
    }

    /// Nodes that ranks share, by both ways of sharing out the elements.
    pub(crate) fn shared_nodes(&self) -> SharedNodes {
        self.own.shared_nodes
    }

    /// The place among the elements of the whole body that an element of this rank's has.
    pub(crate) fn place_in_whole(&self, body: usize, place: u32) -> u32 {
        self.own.place_in_whole(body, place)
    }

    /// Of each body the elements at nodes that others have too, and the others.
    pub(crate) fn bodies(&self) -> impl Iterator<Item = &[Share; 2]> {
        self.bodies.iter()
    }

    /// The blocks of the nodes that this rank has.
    pub(crate) fn blocks(&self, system: &System) -> Vec<Block> {
        let rank = self.ranks.rank();
        blocks_of(system, &self.halo.present, &|node| {
            self.halo.counts(node, rank)
        })
    }

    /// Internal forces at the nodes of this rank, N, which are zero before, and histories and energies of its elements. After an error the others have
    /// forces of no use.
    pub(crate) fn forces(
        &mut self,
        system: &System,
        (old, new, dt): (&Motion, &mut Motion, f64),
        energies: &mut BodyEnergies,
    ) -> Result<(), Error> {
        let Motion {
            u,
            history,
            internal_force,
            ..
        } = new;
        let Shared {
            bodies,
            ranks,
            halo,
            sends,
            receives,
            ..
        } = self;
        energies.begin(bodies.len());
        let mut forced = Ok(());
        let mut add = |side: usize, forces: &mut [f64]| {
            let ranges = &system.nonlinear.histories;
            for (body, (shares, range)) in bodies.iter_mut().zip(ranges).enumerate() {
                let at = Placement {
                    u,
                    v: &[],
                    from: None,
                    frames: &[],
                    dt,
                    old: &old.history[range.clone()],
                };
                match shares[side].force(&at, &mut history[range.clone()], forces) {
                    Ok(given) => energies.include(body, &given),
                    // the first one tells the cause
                    Err(error) if forced.is_ok() => forced = Err(error),
                    Err(_) => {}
                }
            }
            forced.is_ok()
        };
        let dim = system.dim;
        let known = add(0, internal_force);
        for (with, message) in halo.sends.iter().zip(&mut *sends) {
            match known {
                true => pack(&with.nodes, dim, internal_force, &mut message.values),
                false => message.values.fill(0.0),
            }
        }
        ranks.exchange(sends, receives, || {
            add(1, internal_force);
        });
        self.add_up(dim, internal_force);
        Ok(forced?)
    }

    /// Adds what the ranks give at shared nodes, in their order.
    fn add_up(&mut self, dim: usize, forces: &mut [f64]) {
        let Shared {
            halo,
            given: own,
            receives,
            ranks,
            ..
        } = self;
        pack(&halo.shared, dim, forces, own);
        for &node in &halo.shared {
            forces[dim * node as usize..][..dim].fill(0.0);
        }
        let mut own = Some(&own[..]);
        for (with, message) in halo.receives.iter().zip(receives) {
            if with.rank > ranks.rank()
                && let Some(own) = own.take()
            {
                add(&halo.shared, dim, own, forces);
            }
            add(&with.nodes, dim, &message.values, forces);
        }
        if let Some(own) = own {
            add(&halo.shared, dim, own, forces);
        }
    }

    /// Gives the forces of the contacts to the ranks whose elements have their nodes; `touch` is told of nodes with a force there.
    pub(crate) fn pass_contact_forces(
        &mut self,
        dim: usize,
        forces: &mut [f64],
        mut touch: impl FnMut(usize),
    ) {
        for (with, message) in self.halo.touches.iter().zip(&mut self.touches) {
            pack(&with.nodes, dim, forces, &mut message.values);
        }
        let received = &mut self.touched;
        self.ranks.exchange(&self.touches, received, || ());
        for (with, message) in self.halo.touched.iter().zip(received) {
            unpack(&with.nodes, dim, &message.values, forces);
            let values = message.values.chunks_exact(dim);
            let nodes = with.nodes.iter().zip(values);
            for (&node, _) in nodes.filter(|(_, f)| f.iter().any(|f| *f != 0.0)) {
                touch(node as usize);
            }
        }
    }

    /// What this rank has of each contact.
    pub(crate) fn own_points(&mut self, system: &System) -> Vec<Own> {
        let (halo, rank) = (&self.halo, self.ranks.rank());
        let knows = |node: u32| halo.present.binary_search(&node).is_ok();
        let own = halo.homes.own(system, (rank, &self.in_reach.faces), knows);
        let looked = own.iter().zip(0..).map(|(own, contact)| match own {
            Own::All => system.points_of(contact).len(),
            Own::Some(part) => part.looked.len(),
        });
        self.looked = self.looked.max(looked.sum());
        own
    }

    /// Brings to the first rank what it has to have of a state.
    pub(crate) fn bring(&mut self, dim: usize, scope: Scope, state: &mut State) {
        self.points.gather(&self.ranks, scope, state);
        match scope {
            Scope::All => self.whole.gather(&self.ranks, dim, &mut state.motion),
            Scope::Watched | Scope::Points => self.whole.watch(&self.ranks, dim, &mut state.motion),
        }
    }

    /// Brings to it what is looked at of contacts: the displacements of their nodes, and their points.
    pub(crate) fn bring_contacts(&mut self, dim: usize, state: &mut State) {
        self.points.gather_seen(&self.ranks, state);
        let motion = &mut state.motion;
        self.whole.gather_touched(&self.ranks, dim, motion);
    }

    /// Brings the velocities of all nodes at the start and the end of a step to the first rank.
    pub(crate) fn gather_velocities(&mut self, dim: usize, velocities: [&mut [f64]; 2]) {
        self.whole.gather_velocities(&self.ranks, dim, velocities);
    }

    /// Takes what is known of the frequencies of the elements of this rank from what is known of all.
    pub(crate) fn take_looks(&mut self, system: &System, all: &[Looks]) {
        self.looks.take(system, &self.bodies, all);
    }

    /// Brings to the first rank, if there is anything new, what is known of the frequencies of all elements.
    pub(crate) fn gather_looks(&mut self, system: &System, all: &mut Vec<Looks>) {
        let of = (&self.ranks, &self.own, &self.bodies[..]);
        self.looks.gather(of, system, all);
    }

    /// As [`carom_bodies::Body::look`], of all bodies, each with the mean velocity (m/s) of its nodes.
    ///
    /// # Errors
    /// That of the first rank which has one, on all ranks.
    pub(crate) fn look(
        &mut self,
        system: &System,
        motion: &Motion,
        worth: f64,
    ) -> Result<Vec<(Seen, [f64; 3])>, Error> {
        let of = (&self.ranks, &self.halo, &mut self.bodies[..]);
        self.looks.look(of, (system, motion), worth)
    }

    /// Largest |v - w|² (m²/s²) over the nodes of each part, with the w of the part.
    pub(crate) fn fastest(&self, system: &System, w: &[[f64; 3]], v: &[f64]) -> Vec<f64> {
        looks::fastest((&self.ranks, &self.halo), system, (w, v))
    }

    /// Sums the parts, the energies, the forces of supports and the begin of what contacts did in a step over the ranks, with what it tells.
    pub(crate) fn sum_up(
        &mut self,
        parts: &mut [Sums],
        (energies, supports): (&mut BodyEnergies, &mut [Resultant]),
        contacts: &mut [ContactSums],
        told: &Told,
    ) -> Told {
        let Shared {
            sums,
            largest,
            ranks,
            points,
            ..
        } = self;
        sums.clear();
        largest.clear();
        for part in parts.iter() {
            sums.extend(part.numbers());
            largest.push(part.fastest);
        }
        for support in supports.iter() {
            sums.extend(support.linear.iter().chain(&support.angular));
        }
        sums.extend(energies.sums().map(|energy| *energy));
        largest.extend([
            energies.all.compression,
            f64::from(told.failed),
            told.passes as f64,
        ]);
        points.begin_sum(contacts, (sums, largest));
        ranks.reduce(sums, largest);
        let (mut sums, mut largest) = (sums.iter().copied(), largest.iter().copied());
        let mut next = || sums.next().unwrap_or_default();
        let mut most = || largest.next().unwrap_or_default();
        for part in parts {
            part.take(&mut next);
            part.fastest = most();
        }
        for support in supports {
            let entries = support.linear.iter_mut().chain(&mut support.angular);
            entries.for_each(|entry| *entry = next());
        }
        for energy in energies.sums() {
            *energy = next();
        }
        energies.all.compression = most();
        let told = Told {
            failed: most() != 0.0,
            passes: most() as usize,
        };
        contacts::SharedPoints::take_begun(contacts, (&mut next, &mut most));
        told
    }

    /// Makes of what the points of this rank did in a step what those of all ranks did. Their least gaps are known.
    /// `before`: the records at its start, `end`: its end, s.
    pub(crate) fn sum_contacts(
        &mut self,
        system: &System,
        contacts: &mut [ContactSums],
        (before, end): (&[ContactRecord], f64),
    ) {
        let tolerances = system.contacts.iter().map(|contact| contact.tolerance);
        self.points
            .sum(&self.ranks, contacts, (before, end), tolerances);
    }
}

/// Adds the entries of nodes to a system vector.
fn add(nodes: &[u32], dim: usize, values: &[f64], vector: &mut [f64]) {
    for (&node, given) in nodes.iter().zip(values.chunks_exact(dim)) {
        let sums = &mut vector[dim * node as usize..][..dim];
        for (sum, given) in sums.iter_mut().zip(given) {
            *sum += given;
        }
    }
}
