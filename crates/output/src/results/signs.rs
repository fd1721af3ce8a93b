//! What acts on a model, for its picture.

use std::collections::BTreeMap;

use carom_algebra::unknowns::Kind;
use carom_bodies::Body;
use carom_contact::Target;
use carom_dynamics::{NumberedForce, System};
use carom_pages::plot::{Sign, What};

/// Bodies by name, supports, loads, masses, springs and contacts of a model.
pub(crate) fn signs(system: &System) -> Vec<Sign> {
    let mut all: Vec<Sign> = Vec::new();
    all.extend(contacts(system));
    all.extend(system.bodies.iter().map(|body| of_body(system, body)));
    all.extend(supports(system));
    all.extend(loads(system));
    all
}

fn sign(system: &System, what: What, label: String, nodes: Vec<u32>) -> Sign {
    let places = nodes.iter().map(|&node| system.x[node as usize]).collect();
    Sign {
        what,
        label,
        nodes,
        places,
        ways: Vec::new(),
    }
}

/// A body by its name, or discrete elements: masses and what joins two nodes.
fn of_body(system: &System, body: &Body) -> Sign {
    let (mut all, mut is_pair) = (Vec::new(), true);
    body.each_element(&mut |nodes| {
        is_pair &= nodes.len() == 2;
        all.extend_from_slice(nodes);
    });
    let Some(discrete) = body.as_discrete() else {
        return sign(system, What::Body, body.name().to_owned(), all);
    };
    let what = if is_pair { What::Link } else { What::Mass };
    let label = format!("{} {}", discrete.kind_name(), body.name());
    sign(system, what, label, all)
}

fn supports(system: &System) -> impl Iterator<Item = Sign> {
    system.supports.iter().map(|support| {
        let nodes = support
            .held
            .iter()
            .map(|held| system.unknowns.node(held.unknown as usize));
        let mut nodes: Vec<u32> = nodes.collect();
        nodes.dedup();
        let label = format!("support {}", support.name);
        sign(system, What::Support, label, nodes)
    })
}

/// Loads by name: an arrow at each node with the direction of its force. Gravity has no place.
fn loads(system: &System) -> impl Iterator<Item = Sign> {
    let given = &system.nonlinear;
    let named = given.loads.iter().filter_map(|load| {
        let name = given.load_names.get(load.named?)?;
        let NumberedForce::Dead(forces) = &load.force else {
            let body = &system.bodies[*load.bodies.first()?];
            let nodes = of_body(system, body).nodes;
            return Some(sign(system, What::Load, format!("load {name}"), nodes));
        };
        let mut by_node: BTreeMap<u32, [f64; 3]> = BTreeMap::new();
        for &(unknown, force) in forces {
            let unknown = unknown as usize;
            if let Kind::Translation(axis) = system.unknowns.kind(unknown) {
                by_node.entry(system.unknowns.node(unknown)).or_default()[axis] += force;
            }
        }
        let (nodes, ways) = by_node.into_iter().unzip();
        let all = sign(system, What::Load, format!("load {name}"), nodes);
        Some(Sign { ways, ..all })
    });
    named.collect::<Vec<Sign>>().into_iter()
}

/// Both sides of contacts, of stops the one.
fn contacts(system: &System) -> Vec<Sign> {
    let mut all = Vec::new();
    for contact in &system.contacts {
        let own = contact.points.iter().filter(|point| !point.is_on_primary());
        let nodes = own.flat_map(|point| point.carriers());
        let nodes = nodes.map(|(node, _)| node).collect();
        let label = format!("contact {}", contact.name);
        all.push(sign(system, What::Contact, label, nodes));
        if let Target::Surface(_) = &contact.target {
            let nodes = contact
                .primary_faces()
                .iter()
                .flat_map(|face| face.corners());
            let nodes = nodes.copied().collect();
            all.push(sign(system, What::Primary, String::new(), nodes));
        }
    }
    all
}
