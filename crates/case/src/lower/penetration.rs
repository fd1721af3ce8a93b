//! Contacts that penetrate at the start: refused, or told.

use carom_contact::Contact;
use carom_contact::law::Level;
use carom_dynamics::System;

use super::bodies;
use super::context::Context;
use super::problems::{Problems, place, plural};
use crate::error::Problem;
use crate::schema;

/// Refuses contacts that penetrate at the start, in the initial displacement, or tells of them where the case lets them.
pub(super) fn at_start(context: &Context, system: &System, problems: &mut Problems) {
    let slack = system.tolerance.max(1e-9 * system.mesh.size());
    let places = system.places(0.0, &system.initial.displacement, &system.initial.frames);
    for (k, contact) in system.contacts.iter().enumerate() {
        let name = &contact.name;
        let given = context.case.contact.get(name);
        let way = given.map(|contact| contact.initial);
        let inside = system.self_penetrations(k);
        if let (Some(&node), Some(schema::Penetration::Refuse)) = (inside.first(), way) {
            let count = plural(inside.len(), "node");
            let message = format!("{count} of the surface inside its own body at the start");
            let at = place(system.mesh.nodes[node as usize]);
            let problem = Problem::new(format!("contact.{name}"), message);
            let problem = problem.found(format!("node {node}, {at}"));
            problems.push(problem.accepted(["a mesh that does not overlap itself"]));
            continue;
        }
        if way == Some(schema::Penetration::Offset) {
            let offsets = contact.offsets.iter().enumerate();
            let deepest = offsets.min_by(|a, b| b.1.total_cmp(a.1));
            if let Some((point, depth)) = deepest {
                let count = contact.offsets.iter().filter(|depth| **depth > 0.0).count();
                let node = system.mesh_node[contact.points[point].node() as usize];
                tell(name, count, (node, *depth), "offset", problems);
            }
            continue;
        }
        let mut deep = Vec::new();
        if contact.looks_both_ways() && given.is_some_and(|given| given.depth.is_none()) {
            let one_way = contact.one_way(contact.secondary_faces.len());
            deep = one_way.penetrations(&places, slack);
        }
        if deep.is_empty() {
            deep = contact.penetrations(&places, slack);
        }
        let Some(deepest) = deep.iter().min_by(|a, b| b.depth.total_cmp(&a.depth)) else {
            continue;
        };
        let node = system.mesh_node[deepest.node as usize];
        if let Some(stop) = context.case.stop.get(name) {
            let gap = stop.gap.map_or(0.0, |gap| gap.0);
            compressed(contact, [gap, deepest.depth], slack, problems);
            continue;
        }
        if way == Some(schema::Penetration::Keep) {
            tell(name, deep.len(), (node, deepest.depth), "kept", problems);
            continue;
        }
        let at = place(contact.points[deepest.point].place(&places));
        let verb = match deep.len() {
            1 => "penetrates",
            _ => "penetrate",
        };
        let message = format!("{} {verb} at the start", plural(deep.len(), "point"));
        let problem = Problem::new(format!("contact.{name}"), message)
            .found(format!(
                "a gap of {:.4e} m at node {node}, {at}",
                -deepest.depth
            ))
            .accepted([
                format!("gaps of at least -{slack:.1e} m"),
                "initial = \"offset\" (the overlap stays and carries no force, as for facets of round surfaces)".to_string(),
                "initial = \"remove\" (nodes are moved)".to_string(),
                "initial = \"keep\" (the law pushes them out)".to_string(),
            ]);
        problems.push(problem);
    }
}

/// Tells of a stop that penetrates at the start by a depth (m) as its gap (m) asks, and refuses one that does not, or that has a law without
/// a force for that.
fn compressed(stop: &Contact, [gap, depth]: [f64; 2], slack: f64, problems: &mut Problems) {
    let name = &stop.name;
    let has_force = stop.law.get().level() == Level::GapAndRate;
    if has_force && depth <= slack - gap {
        problems.warn(format!(
            "stop `{name}`: its gap is negative, so that it is compressed by {depth:.4e} m at the start"
        ));
        return;
    }
    let message = match has_force {
        true => "the end of the stop is inside the obstacle at the start",
        false => "a stop that is compressed at the start needs a law that gives it a force",
    };
    let problem = Problem::new(format!("stop.{name}.gap"), message);
    let problem = problem.found(format!("a penetration of {depth:.4e} m"));
    problems.push(match has_force {
        true => problem.accepted([
            "a place outside of the obstacle".to_owned(),
            format!("gap = {:.6} m (compressed at the start)", gap - depth),
        ]),
        false => problem.accepted([
            format!("gap of at least -{slack:.1e} m"),
            "the spring of the stop, without `law`".to_owned(),
        ]),
    });
}

/// Tells which nodes contacts have moved away from the places `before`, and refuses cells that this has spoilt.
pub(super) fn moved(
    context: &Context,
    system: &System,
    before: &[[f64; 3]],
    problems: &mut Problems,
) {
    let places = system.mesh.nodes.iter().zip(before);
    let distance = |(now, then): (&[f64; 3], &[f64; 3])| {
        let squares = now.iter().zip(then).map(|(a, b)| (a - b).powi(2));
        squares.sum::<f64>().sqrt()
    };
    let ways: Vec<f64> = places.map(distance).collect();
    let furthest = ways.iter().enumerate().min_by(|a, b| b.1.total_cmp(a.1));
    let Some((node, way)) = furthest.filter(|(_, way)| **way > 0.0) else {
        return;
    };
    let count = ways.iter().filter(|way| **way > 0.0).count();
    let remove = schema::Penetration::Remove;
    let contacts = context.case.contact.iter();
    let names: Vec<&str> = contacts
        .filter(|(_, contact)| contact.initial == remove)
        .map(|(name, _)| name)
        .collect();
    tell(
        &names.join("`, `"),
        count,
        (node as u32, *way),
        "removed",
        problems,
    );
    for body in system.bodies.iter().filter(|b| b.as_solid().is_some()) {
        let path = format!("body.{}", body.name());
        bodies::sound(&system.mesh, &path, body.cells(), problems);
    }
}

fn tell(
    contact: &str,
    count: usize,
    (node, depth): (u32, f64),
    done: &str,
    problems: &mut Problems,
) {
    problems.warn(format!(
        "contact `{contact}`: {} penetrated at the start, the deepest, at node {node}, by {depth:.4e} m; {done}, as asked",
        plural(count, "point")
    ));
}
