//! Which rank has each contact point.
//!
//! Forces of contact points whose rows share a node depend on each other, and so do points that look for the same faces. Points and nodes
//! that such rows may connect are a *family*: each node with its points under an obstacle is one; a point that may touch faces of another
//! surface soon ([`in_reach`](super::in_reach)) is of one family with the nodes of these faces and of those around it; where that is not known
//! ahead, as of mortar contacts, all points and nodes of a contact are of one. A family is solved by one
//! rank, its *home*: of those that own its nodes the one that owns most of them. A point that touches nothing soon is with the owner of its node. So points on obstacles stay where
//! their nodes are, and contacts are shared out by their places.

use std::ops::Range;

use carom_contact::{Contact, Target};
use carom_mesh::Face;

use super::in_reach::Faces;
use crate::system::System;

/// Home of a node without contacts.
const NONE: u32 = u32::MAX;

/// The homes of all contact points.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Homes {
    /// Of each point.
    pub(crate) of_point: Vec<u32>,
    /// Of each node of the system, or [`NONE`].
    of_node: Vec<u32>,
}

/// Which of a contact's points a rank has.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Own {
    All,
    /// Others have the rest.
    Some(Part),
}

/// What a rank has of a contact. None of its points perhaps.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Part {
    /// Points, by their numbers in the contact, ascending.
    pub(crate) points: Vec<u32>,
    /// Those of them that may touch something.
    pub(crate) looked: Vec<u32>,
    /// Nodes of the contact that this rank knows, ascending.
    pub(crate) nodes: Vec<u32>,
    /// Faces that some of the points may touch, by their numbers in the contact, ascending; none of a contact with an obstacle.
    pub(crate) faces: Option<Vec<u32>>,
}

impl Homes {
    /// `owner`: rank that owns each node of the system.
    pub(crate) fn new(system: &System, owner: &[u32], in_reach: &Faces) -> Homes {
        let mut families = Families::new(owner.len());
        for (contact, in_reach) in system.contacts.iter().zip(in_reach) {
            match in_reach {
                Some(faces) => families.join_near(contact, faces),
                None if is_split(contact) => {
                    for point in &contact.points {
                        families.join(point.carriers().map(|(node, _)| node));
                    }
                }
                None => families.join(contact.nodes().0.into_iter()),
            }
        }
        let of_node = families.homes(owner);
        let points = system.contacts.iter().flat_map(|contact| &contact.points);
        let home = |node: usize| match of_node[node] {
            NONE => owner[node],
            home => home,
        };
        Homes {
            of_point: points.map(|point| home(point.node() as usize)).collect(),
            of_node,
        }
    }

    /// The home of a node's contacts; none if it has none.
    pub(crate) fn of_node(&self, node: usize) -> Option<u32> {
        Some(self.of_node[node]).filter(|home| *home != NONE)
    }

    /// Of each contact what a rank has. `knows`: whether it computes the motion of a node.
    pub(crate) fn own(
        &self,
        system: &System,
        (rank, in_reach): (usize, &Faces),
        knows: impl Fn(u32) -> bool,
    ) -> Vec<Own> {
        let own = |range: Range<usize>| {
            let homes = self.of_point[range].iter().zip(0..);
            let own = homes.filter(|(home, _)| **home as usize == rank);
            own.map(|(_, point)| point).collect::<Vec<u32>>()
        };
        let of_contact = |(number, in_reach): (usize, &Option<Vec<Vec<u32>>>)| {
            let (contact, range) = (&system.contacts[number], system.points_of(number));
            let points = own(range.clone());
            match in_reach {
                Some(in_reach) => Own::Some(Part::in_reach(contact, points, in_reach, &knows)),
                None if points.len() == range.len() => Own::All,
                None => Own::Some(Part::of_points(contact, points)),
            }
        };
        in_reach.iter().enumerate().map(of_contact).collect()
    }
}

impl Part {
    /// Points with the faces that they may touch. `knows`: whether the rank computes the motion of a node.
    fn in_reach(
        contact: &Contact,
        points: Vec<u32>,
        in_reach: &[Vec<u32>],
        knows: impl Fn(u32) -> bool,
    ) -> Part {
        let faces_of = |point: u32| &in_reach[point as usize];
        let looked = points.iter().copied();
        let looked: Vec<u32> = looked
            .filter(|&point| !faces_of(point).is_empty())
            .collect();
        let faces = looked
            .iter()
            .flat_map(|&point| faces_of(point).iter().copied());
        let mut nodes = contact.nodes().0;
        nodes.retain(|&node| knows(node));
        Part {
            faces: Some(in_order(faces.collect())),
            looked,
            nodes,
            points,
        }
    }

    /// Points that are looked at whatever the others do.
    fn of_points(contact: &Contact, points: Vec<u32>) -> Part {
        let own = points.iter().map(|&point| &contact.points[point as usize]);
        let carriers = own.flat_map(|point| point.carriers());
        Part {
            nodes: in_order(carriers.map(|(node, _)| node).collect()),
            looked: points.clone(),
            faces: None,
            points,
        }
    }
}

fn in_order(mut numbers: Vec<u32>) -> Vec<u32> {
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

/// Whether the rows of each point are those of its own nodes, whatever the others do.
fn is_split(contact: &Contact) -> bool {
    matches!(contact.target, Target::Rigid(_)) && contact.mortar.is_none()
}

/// Nodes that contacts connect, as trees: each node's parent, itself where it is the root, and [`NONE`] without contacts.
struct Families {
    parents: Vec<u32>,
}

impl Families {
    fn new(nodes: usize) -> Families {
        Families {
            parents: vec![NONE; nodes],
        }
    }

    fn root(&mut self, node: u32) -> u32 {
        let mut at = node;
        while self.parents[at as usize] != at {
            let parent = self.parents[at as usize];
            let above = self.parents[parent as usize];
            self.parents[at as usize] = above;
            at = above;
        }
        at
    }

    /// Makes the nodes of each point and of the faces that it may touch, and of those around it, of one family. `in_reach`: these faces, by
    /// their numbers.
    fn join_near(&mut self, contact: &Contact, in_reach: &[Vec<u32>]) {
        let Target::Surface(faces) = &contact.target else {
            return;
        };
        let points = contact.points.iter().zip(in_reach).enumerate();
        for (number, (point, near)) in points.filter(|(_, (_, near))| !near.is_empty()) {
            let near = near.iter().map(|&face| &faces[face as usize]);
            let nodes = near
                .chain(contact.faces_around(number))
                .flat_map(Face::corners);
            let own = point.carriers().map(|(node, _)| node);
            let own = own.chain(point.beside_edge().iter().copied());
            self.join(own.chain(nodes.copied()));
        }
    }

    /// Makes some nodes of one family.
    fn join(&mut self, nodes: impl Iterator<Item = u32>) {
        let mut first = NONE;
        for node in nodes {
            if self.parents[node as usize] == NONE {
                self.parents[node as usize] = node;
            }
            let root = self.root(node);
            if first == NONE {
                first = root;
            }
            self.parents[root as usize] = first;
        }
    }

    /// The home of each node: the owner of most nodes of its family, the first of equals.
    fn homes(mut self, owner: &[u32]) -> Vec<u32> {
        let nodes = 0..self.parents.len() as u32;
        let with: Vec<u32> = nodes
            .filter(|&node| self.parents[node as usize] != NONE)
            .collect();
        let mut members: Vec<[u32; 2]> = Vec::with_capacity(with.len());
        for &node in &with {
            members.push([self.root(node), owner[node as usize]]);
        }
        members.sort_unstable();
        let mut of_root: Vec<(u32, usize, u32)> = Vec::new();
        for owned in members.chunk_by(|a, b| a == b) {
            let [root, owner] = owned[0];
            match of_root.last_mut() {
                Some(last) if last.0 == root => {
                    if owned.len() > last.1 {
                        (last.1, last.2) = (owned.len(), owner);
                    }
                }
                _ => of_root.push((root, owned.len(), owner)),
            }
        }
        let mut homes = vec![NONE; self.parents.len()];
        for node in with {
            let root = self.root(node);
            let found = of_root.binary_search_by_key(&root, |of| of.0);
            if let Ok(found) = found {
                homes[node as usize] = of_root[found].2;
            }
        }
        homes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_family_is_with_the_rank_that_owns_most_of_it() {
        // nodes 0 to 2 and 4 are connected by three lists; 3 has no contact; 5 and 6 belong to one rank each
        let mut families = Families::new(8);
        for nodes in [&[0, 1][..], &[4, 2], &[2, 1], &[5], &[6, 7]] {
            families.join(nodes.iter().copied());
        }
        let owner = [3, 1, 1, 0, 2, 4, 5, 2];
        // of the two ranks that own one node of 6 and 7 each the first
        assert_eq!(families.homes(&owner), [1, 1, 1, NONE, 1, 4, 2, 2]);
    }
}
