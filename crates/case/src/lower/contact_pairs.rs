//! Contacts that join the same faces.

use std::collections::{BTreeMap, BTreeSet};

use carom_dynamics::{ModelContact, ModelTarget};
use carom_mesh::{Face, Surface};

use super::lookup::faces_of;
use super::problems::Problems;
use crate::error::Problem;

/// Refuses contacts between faces that another contact joins in the same way: their stiffnesses add up, and their
/// constraints are the same twice. Warns where the sides are exchanged.
pub(super) fn check(contacts: &[ModelContact], problems: &mut Problems) {
    let sides = Sides::of(contacts);
    for (k, contact) in contacts.iter().enumerate() {
        for other in sides
            .that_meet(contact, k)
            .into_iter()
            .map(|k| &contacts[k])
        {
            let same = shares_faces(&contact.secondary, &other.secondary)
                && match (&contact.primary, &other.primary) {
                    (ModelTarget::Rigid(one), ModelTarget::Rigid(two)) => one == two,
                    (ModelTarget::Surface(one), ModelTarget::Surface(two)) => {
                        shares_faces(one, two)
                    }
                    _ => false,
                };
            if same {
                let message = format!("the contact `{}` joins the same faces already", other.name);
                let problem = Problem::new(format!("contact.{}", contact.name), message);
                let problem = problem.found(format!("`{}` and `{}`", other.name, contact.name));
                problems.push(problem.accepted(["one contact for a pair of faces"]));
            } else if let (ModelTarget::Surface(one), ModelTarget::Surface(two)) =
                (&contact.primary, &other.primary)
                && shares_faces(&contact.secondary, two)
                && shares_faces(one, &other.secondary)
            {
                problems.warn(format!(
                    "contact `{}`: the contact `{}` joins the same faces with secondary and primary exchanged: stiffnesses of penalty laws add up, and constraints may have no unique forces",
                    contact.name, other.name
                ));
            }
        }
    }
}

/// Whether two surfaces have a face in common.
fn shares_faces(one: &Surface, two: &Surface) -> bool {
    let of_one: BTreeSet<Vec<u32>> = one.faces.iter().map(sorted_nodes).collect();
    let mut of_two = two.faces.iter().map(sorted_nodes);
    of_two.any(|face| of_one.contains(&face))
}

fn sorted_nodes(face: &Face) -> Vec<u32> {
    let mut nodes = face.corners().to_vec();
    nodes.sort_unstable();
    nodes
}

/// Contacts by the faces of their sides.
struct Sides(BTreeMap<Vec<u32>, Vec<usize>>);

impl Sides {
    fn of(contacts: &[ModelContact]) -> Sides {
        let mut sides = BTreeMap::new();
        for (k, contact) in contacts.iter().enumerate() {
            for face in faces_of(contact).into_iter().flatten() {
                let of: &mut Vec<usize> = sides.entry(sorted_nodes(face)).or_default();
                if of.last() != Some(&k) {
                    of.push(k);
                }
            }
        }
        Sides(sides)
    }

    /// Contacts before the `k`-th that have a face of its secondary side, ascending.
    fn that_meet(&self, contact: &ModelContact, k: usize) -> BTreeSet<usize> {
        let faces = contact.secondary.faces.iter().map(sorted_nodes);
        let of = faces.filter_map(|face| self.0.get(&face));
        of.flatten().copied().filter(|other| *other < k).collect()
    }
}
