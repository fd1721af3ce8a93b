//! What acts on a model, for its picture.

use std::collections::BTreeMap;

use carom_algebra::unknowns::Kind;
use carom_bodies::Body;
use carom_contact::Target;
use carom_dynamics::{NumberedForce, System};

use crate::plot::{Sign, What};

/// Bodies by name, supports, loads, masses, springs and contacts of a model.
pub(crate) fn signs(system: &System) -> Vec<Sign> {
    let mut all: Vec<Sign> = Vec::new();
    all.extend(contacts(system));
    all.extend(system.bodies.iter().map(|body| of_body(system, body)));
    all.extend(supports(system));
    all.extend(loads(system));
    all
}

fn sign(what: What, label: String, places: Vec<[f64; 3]>) -> Sign {
    Sign {
        what,
        label,
        places,
        ways: Vec::new(),
    }
}

/// A body by its name, or discrete elements: masses and what joins two nodes.
fn of_body(system: &System, body: &Body) -> Sign {
    let mut places = Vec::new();
    let Some(discrete) = body.as_discrete() else {
        body.each_element(&mut |nodes| {
            places.extend(nodes.iter().map(|&node| system.x[node as usize]));
        });
        return sign(What::Body, body.name().to_owned(), places);
    };
    let mut is_pair = true;
    body.each_element(&mut |nodes| {
        is_pair &= nodes.len() == 2;
        places.extend(nodes.iter().map(|&node| system.x[node as usize]));
    });
    let what = if is_pair { What::Link } else { What::Mass };
    sign(
        what,
        format!("{} {}", discrete.kind_name(), body.name()),
        places,
    )
}

fn supports(system: &System) -> impl Iterator<Item = Sign> {
    system.supports.iter().map(|support| {
        let nodes = support
            .held
            .iter()
            .map(|held| system.unknowns.node(held.unknown as usize));
        let mut nodes: Vec<u32> = nodes.collect();
        nodes.dedup();
        let places = nodes.iter().map(|&node| system.x[node as usize]);
        sign(
            What::Support,
            format!("support {}", support.name),
            places.collect(),
        )
    })
}

/// Loads by name: an arrow at each node with the direction of its force. Gravity has no place.
fn loads(system: &System) -> impl Iterator<Item = Sign> {
    let given = &system.nonlinear;
    let named = given.loads.iter().filter_map(|load| {
        let name = given.load_names.get(load.named?)?;
        let NumberedForce::Dead(forces) = &load.force else {
            let centre = load
                .bodies
                .first()
                .map(|&body| of_body(system, &system.bodies[body]));
            return centre.map(|body| sign(What::Load, format!("load {name}"), body.places));
        };
        let mut by_node: BTreeMap<u32, [f64; 3]> = BTreeMap::new();
        for &(unknown, force) in forces {
            let unknown = unknown as usize;
            if let Kind::Translation(axis) = system.unknowns.kind(unknown) {
                by_node.entry(system.unknowns.node(unknown)).or_default()[axis] += force;
            }
        }
        let mut all = sign(What::Load, format!("load {name}"), Vec::new());
        for (node, force) in by_node {
            all.places.push(system.x[node as usize]);
            all.ways.push(force);
        }
        Some(all)
    });
    named.collect::<Vec<Sign>>().into_iter()
}

/// Both sides of contacts, of stops the one.
fn contacts(system: &System) -> Vec<Sign> {
    let mut all = Vec::new();
    for contact in &system.contacts {
        let place = |node: &u32| system.x[*node as usize];
        let nodes = contact.points.iter().flat_map(|point| point.carriers());
        let points: Vec<[f64; 3]> = nodes.map(|(node, _)| place(&node)).collect();
        all.push(sign(
            What::Contact,
            format!("contact {}", contact.name),
            points,
        ));
        if let Target::Surface(faces) = &contact.target {
            let nodes = faces.iter().flat_map(|face| face.corners());
            all.push(sign(
                What::Primary,
                String::new(),
                nodes.map(place).collect(),
            ));
        }
    }
    all
}
