//! Whose the cores are, and which pairs of them are not looked at.

use std::collections::BTreeSet;

use crate::system::{ContactPair, CoreOf, CoreOwner, System};

/// Whose a core is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// A body, by its number.
    Body(usize),
    /// The rigid shape of a contact, by the number of that.
    Shape(usize),
}

/// Whose all cores are.
#[derive(Clone, Debug)]
pub(super) struct Sides {
    pub(super) all: Vec<Side>,
    /// Connected parts that links join, ascending.
    linked: BTreeSet<[usize; 2]>,
    /// Contacts whose gaps do not count from the surfaces, or are penetrated as their curve says.
    elsewhere: Vec<bool>,
    /// Pairs of bodies of these, ascending.
    shifted: BTreeSet<[usize; 2]>,
}

impl Sides {
    pub(super) fn of(system: &System, cores: &[CoreOf]) -> Sides {
        let side = |core: &CoreOf| match core.owner {
            CoreOwner::Body(body) => Side::Body(body),
            CoreOwner::Shape(contact, _) => Side::Shape(contact),
        };
        let elsewhere: Vec<bool> = system.contacts.iter().map(is_elsewhere).collect();
        let mut shifted = BTreeSet::new();
        let contacts = system.contacts.iter().zip(&elsewhere);
        for (contact, _) in contacts.filter(|of| *of.1) {
            for (k, &one) in contact.bodies.iter().enumerate() {
                let others = contact.bodies[k..].iter();
                shifted.extend(others.map(|&other| [one, other]));
            }
        }
        Sides {
            all: cores.iter().map(side).collect(),
            linked: linked(system),
            elsewhere,
            shifted,
        }
    }

    /// The body of a core.
    pub(super) fn body(&self, number: u32) -> Option<usize> {
        match self.all[number as usize] {
            Side::Body(body) => Some(body),
            Side::Shape(_) => None,
        }
    }

    pub(super) fn pairs(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let all = self.all.len() as u32;
        (0..all).flat_map(move |one| (one + 1..all).map(move |other| [one, other]))
    }

    /// The two that a pair of numbers is of, by name.
    pub(super) fn names(&self, system: &System, of: [u32; 2]) -> String {
        let sides = of.map(|number| self.all[number as usize]);
        let name = |side: Side| match side {
            Side::Body(body) => format!("`{}`", system.bodies[body].name()),
            Side::Shape(contact) => {
                let contact = &system.contacts[contact].name;
                format!("the obstacle of contact `{contact}`")
            }
        };
        match sides {
            [Side::Body(one), Side::Body(other)] if one == other => {
                format!("two pieces of {}", name(sides[0]))
            }
            _ => format!("{} and {}", name(sides[0]), name(sides[1])),
        }
    }

    /// Pairs of bodies that are not looked at, since links join them or the gaps of their contact count from elsewhere.
    pub(super) fn joined<'a>(&'a self, system: &'a System) -> impl Iterator<Item = [u32; 2]> + 'a {
        let none = self.linked.is_empty() && self.shifted.is_empty();
        let pairs = self.pairs().take(if none { 0 } else { usize::MAX });
        pairs.filter(move |of| {
            let are_bodies = of.iter().all(|number| self.body(*number).is_some());
            are_bodies && self.leaves_out(system, *of)
        })
    }

    /// Whether a pair is not looked at: two shapes, a shape and what its contact is not of, bodies that links join, and those of contacts whose gaps count
    /// from elsewhere.
    pub(super) fn leaves_out(&self, system: &System, of: [u32; 2]) -> bool {
        match of.map(|number| self.all[number as usize]) {
            [Side::Body(one), Side::Body(other)] => {
                let parts = [one, other].map(|body| system.part_of_body[body]);
                let [first, last] = [parts[0].min(parts[1]), parts[0].max(parts[1])];
                self.linked.contains(&[first, last])
                    || self.shifted.contains(&[one.min(other), one.max(other)])
            }
            [Side::Shape(_), Side::Shape(_)] => true,
            [Side::Body(body), Side::Shape(contact)] | [Side::Shape(contact), Side::Body(body)] => {
                !system.contacts[contact].bodies.contains(&body) || self.elsewhere[contact]
            }
        }
    }
}

/// Whether gaps of a contact do not count from the surfaces, or what it lets go deep is told by its curve.
fn is_elsewhere(contact: &ContactPair) -> bool {
    contact.law.get().is_of_the_whole() || contact.offsets.iter().any(|offset| *offset != 0.0)
}

/// Connected parts that links join, ascending.
fn linked(system: &System) -> BTreeSet<[usize; 2]> {
    let mut parts = BTreeSet::new();
    for row in system.links.rows.iter() {
        let of = row.iter().map(|(i, _)| system.part_of(*i as usize));
        let of: BTreeSet<usize> = of.collect();
        for &one in &of {
            let others = of.iter().filter(|other| one < **other);
            parts.extend(others.map(|&other| [one, other]));
        }
    }
    parts
}
