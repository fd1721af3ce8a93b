//! Contacts that do not look for what is far: of each point in the iterations of an implicit step, and of both sides in any step.
//!
//! A point whose gap is beyond the *reach* where a contact is paired faces nothing. The reach is at least the depth up to which
//! penetrations count, and four times what both sides may come closer in the step. After each iteration the ways of the nodes in the
//! step are compared with it: where two times what they bring closer is more, the contact is paired again with a longer reach,
//! before points are looked for that close. So no point is left out that would have carried a force, and forces are those of all points.
//!
//! Sides whose boxes are further apart than the reach have no point within it, and are not looked at.

use std::f64::consts::SQRT_2;

use carom_algebra::unknowns::Unknowns;
use carom_contact::{Contact, Pairing, Places, Search, Target};
use carom_mesh::Bounds;

use crate::system::System;

/// Reach over what both sides may come closer in a step, and the least that it must be.
const AHEAD: f64 = 4.0;

const LEAST: f64 = 2.0;

/// Part of a distance that counts as rounding.
const ROUNDING: f64 = 1e-9;

/// What the contacts that do not look for what is far have.
#[derive(Default)]
pub(crate) struct Far {
    /// Of each contact; none of those that look for all points.
    contacts: Vec<Option<Reach>>,
    sides: Vec<Side>,
    /// Whether the boxes of the sides are those of the configuration under way.
    placed: bool,
}

/// How far a contact looks.
struct Reach {
    sides: [usize; 2],
    /// Largest penetration that counts as contact, m; none where points have no sight, of which all or none are looked at.
    depth: Option<f64>,
    /// The most that a place on a side moves over the motion of its nodes.
    spread: f64,
    /// What both sides are thick beyond their nodes, m.
    thick: f64,
    /// Gap up to which points are looked for, m.
    reach: f64,
}

/// Whose side it is: a body's, or that of a contact whose sides have several.
#[derive(Clone, Copy, PartialEq)]
enum Owner {
    Body(usize),
    Contact(usize),
}

/// The outer side of a body, or of several.
struct Side {
    owner: Owner,
    /// Its nodes, ascending.
    nodes: Vec<u32>,
    /// How far a side may be beyond the box of its nodes, over the size of the box.
    bulge: f64,
    bounds: Bounds,
    /// Way of its fastest node in the step, m.
    way: f64,
}

impl Far {
    /// Of the contacts that a process has; the places of the nodes of others are not known to it.
    pub(crate) fn of(system: &System, has: impl Fn(usize) -> bool) -> Far {
        let mut far = Far::default();
        for number in 0..system.contacts.len() {
            let reach = match has(number) {
                true => far.reach_of(system, number),
                false => None,
            };
            far.contacts.push(reach);
        }
        for side in &mut far.sides {
            side.nodes.sort_unstable();
            side.nodes.dedup();
        }
        far
    }

    /// Takes in the sides of a contact, if it does not look for what is far.
    fn reach_of(&mut self, system: &System, number: usize) -> Option<Reach> {
        let contact = &system.contacts[number];
        if !contact.near_only || matches!(contact.target, Target::Rigid(_)) {
            return None;
        }
        let (_, spread) = contact.nodes();
        let [secondary, primary] = match system.is_of_many(number) {
            true => [Owner::Contact(number); 2],
            false => [contact.secondary_body, contact.primary_body?].map(Owner::Body),
        };
        let own = contact.points.iter().filter(|point| !point.is_on_primary());
        let own = own.flat_map(|point| point.carriers());
        let own: Vec<u32> = own.map(|(node, _)| node).collect();
        let other = contact.primary_faces().iter();
        let other = other.flat_map(|face| face.corners()).copied();
        let bulge = 0.5 * (spread - 1.0);
        let sides = [
            self.side(secondary, bulge, own.into_iter()),
            self.side(primary, bulge, other),
        ];
        Some(Reach {
            sides,
            depth: contact.deepest(),
            spread,
            thick: contact.thickest(),
            reach: 0.0,
        })
    }

    fn side(&mut self, owner: Owner, bulge: f64, nodes: impl Iterator<Item = u32>) -> usize {
        let known = self.sides.iter().position(|side| side.owner == owner);
        let number = known.unwrap_or(self.sides.len());
        if known.is_none() {
            self.sides.push(Side {
                owner,
                nodes: Vec::new(),
                bulge,
                bounds: Bounds::EMPTY,
                way: 0.0,
            });
        }
        let side = &mut self.sides[number];
        side.nodes.extend(nodes);
        side.bulge = side.bulge.max(bulge);
        number
    }

    /// Whether a contact does not look for what is far.
    pub(crate) fn has(&self, contact: usize) -> bool {
        self.contacts[contact].is_some()
    }

    /// Begins a step whose nodes go this way with their velocity, a system vector times a factor, m.
    pub(crate) fn begin(&mut self, unknowns: &Unknowns, (velocity, factor): (&[f64], f64)) {
        self.take_ways(unknowns, velocity, factor);
        for contact in self.contacts.iter_mut().flatten() {
            contact.reach = contact.needed(AHEAD, &self.sides);
        }
    }

    /// Whether all contacts have looked far enough for ways of the nodes in the step, a system vector in m; those that have not look
    /// further from here on.
    pub(super) fn is_enough(&mut self, unknowns: &Unknowns, ways: &[f64]) -> bool {
        self.take_ways(unknowns, ways, 1.0);
        let mut enough = true;
        for contact in self.contacts.iter_mut().flatten() {
            if contact.needed(LEAST, &self.sides) > contact.reach {
                contact.reach = contact.needed(AHEAD, &self.sides);
                enough = false;
            }
        }
        enough
    }

    /// Whether there is no such contact.
    pub(crate) fn is_empty(&self) -> bool {
        self.sides.is_empty()
    }

    fn take_ways(&mut self, unknowns: &Unknowns, vector: &[f64], factor: f64) {
        for side in &mut self.sides {
            let ways = side.nodes.iter();
            let ways = ways.map(|&node| way(unknowns, node, vector));
            side.way = factor * ways.fold(0.0, f64::max);
        }
    }

    /// Tells that another configuration is under way.
    pub(super) fn forget_places(&mut self) {
        self.placed = false;
    }

    /// Appends the points of a contact at a configuration, in a step that began with the places of `start`.
    pub(crate) fn append(
        &mut self,
        (contact, number): (&Contact, usize),
        (places, start): (&Places, &Places),
        inside: &(dyn Fn(usize) -> bool + Sync),
        (search, pairing): (&mut Search, &mut Pairing),
    ) {
        let reach = self.contacts[number].as_ref().map_or(0.0, |own| own.reach);
        let sees = self.contacts[number]
            .as_ref()
            .is_some_and(|own| own.depth.is_some());
        if self.are_apart(number, reach, (places, None)) {
            contact.append_apart(places.dim(), search, pairing);
        } else if sees {
            contact.append_near(places, search, (Some(start), reach, inside), pairing);
        } else {
            contact.pair_fully(places, search, pairing);
        }
    }

    /// The most that a place on the sides of a contact has moved since the start of the step that [`Far::are_apart`] was given last, m; none of
    /// contacts that look for all points.
    pub(crate) fn way(&self, number: usize) -> Option<f64> {
        let contact = self.contacts[number].as_ref()?;
        let ways = contact.sides.map(|side| self.sides[side].way);
        Some(contact.spread * ways[0].max(ways[1]))
    }

    /// Whether the sides of a contact that does not look for what is far are further apart at a configuration than points within
    /// `reach` (m) can be, or than they can have come closer by since the start of the step, if that is given: a foot may lie as far sideways as
    /// along the normal.
    pub(super) fn are_apart(
        &mut self,
        number: usize,
        reach: f64,
        (places, start): (&Places, Option<&Places>),
    ) -> bool {
        if !std::mem::replace(&mut self.placed, true) {
            let sides = self.sides.iter_mut();
            sides.for_each(|side| side.place((places, start)));
        }
        let Some(contact) = &self.contacts[number] else {
            return false;
        };
        let way = start.and_then(|_| self.way(number));
        let reach = way.map_or(reach, |way| reach.max(AHEAD * way));
        let [one, other] = contact.sides.map(|side| &self.sides[side].bounds);
        let margin = SQRT_2 * (reach + contact.thick);
        let rounding = ROUNDING * (one.reach().max(other.reach()) + margin);
        one.apart(other) > margin + rounding
    }
}

impl Reach {
    /// The gap up to which points are to be looked for, m: some times what both sides come closer by their ways. Powers of two, so that it
    /// stays for many steps.
    fn needed(&self, times: f64, sides: &[Side]) -> f64 {
        let [one, other] = self.sides.map(|side| sides[side].way);
        let closer = times * self.spread * (one + other);
        let closer = match closer > 0.0 && closer.is_finite() {
            true => closer.log2().ceil().exp2(),
            false => closer,
        };
        closer.max(self.depth.unwrap_or(0.0))
    }
}

impl Side {
    /// Takes the box of its nodes, and their ways since the start of the step if that is given.
    fn place(&mut self, (places, start): (&Places, Option<&Places>)) {
        let mut bounds = Bounds::EMPTY;
        let mut square = 0.0_f64;
        for &node in &self.nodes {
            let x = places.of(node);
            bounds = bounds.union(&Bounds::of(&[x]));
            if let Some(start) = start {
                let from = start.of(node);
                square = square.max((0..3).map(|i| (x[i] - from[i]).powi(2)).sum());
            }
        }
        if start.is_some() {
            self.way = square.sqrt();
        }
        let size = (0..3).map(|i| bounds.max[i] - bounds.min[i]);
        self.bounds = bounds.widened(self.bulge * size.fold(0.0, f64::max));
    }
}

/// The most that a node moves by a system vector, in the unit of its translations: of one that another carries, which turns its arm too, the
/// way of that node and the angle times the length of the arm.
fn way(unknowns: &Unknowns, node: u32, vector: &[f64]) -> f64 {
    let size = |a: [f64; 3]| a.iter().map(|a| a * a).sum::<f64>().sqrt();
    match unknowns.carrier(node) {
        None => size(unknowns.vector(node, vector)),
        Some(carrier) => {
            let turn = unknowns.spin(carrier.node, vector);
            size(unknowns.vector(carrier.node, vector)) + size(turn) * size(carrier.arm)
        }
    }
}
