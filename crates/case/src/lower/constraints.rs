//! Rigid links and linear constraints, and the hinges of beams.

use carom_algebra::unknowns::Kind;
use carom_bodies::{BodySpec, Kinematics, Release};
use carom_dynamics::{ModelBody, ModelConstraint};
use carom_mesh::{ElementId, Mesh};

use super::context::Context;
use super::problems::{Problems, place};
use super::turning::{SMALL_TURNS, any_angle};
use super::{beams, lookup};
use crate::error::Problem;
use crate::schema::{Axis, Body, ConstraintTerm, Hinge, RigidLink};

/// The constraints of a case.
pub(super) fn lower(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    problems: &mut Problems,
) -> Vec<ModelConstraint> {
    let case = context.case;
    let turning = beams::nodes_with_rotations(context, mesh);
    let mut all = Vec::new();
    for (name, given) in case.rigid_link.iter() {
        all.extend(rigid_link(
            (mesh, bodies),
            &turning,
            (name, given),
            problems,
        ));
    }
    for (name, given) in case.constraint.iter() {
        let terms = given.terms.iter().enumerate();
        let terms = terms.map(|(k, given)| {
            let path = format!("constraint.{name}.terms[{k}]");
            term(mesh, &turning, (&path, given), problems)
        });
        all.push(ModelConstraint {
            name: name.to_owned(),
            rows: vec![terms.flatten().collect()],
        });
    }
    all
}

/// A rigid link. `turning`: nodes with rotations, sorted.
fn rigid_link(
    (mesh, bodies): (&Mesh, &[ModelBody]),
    turning: &[u32],
    (name, given): (&str, &RigidLink),
    problems: &mut Problems,
) -> Option<ModelConstraint> {
    let turns = |node: u32| turning.binary_search(&node).is_ok();
    let path = format!("rigid-link.{name}");
    let first = lookup::single(mesh, &format!("{path}.first"), &given.first, problems);
    let path = format!("{path}.nodes");
    let nodes = problems.group(mesh, &path, &given.nodes);
    let (first, nodes) = (first?, mesh.group_nodes(nodes?));
    let others = nodes.into_iter().filter(|&node| node != first);
    let others: Vec<(u32, bool)> = others.map(|node| (node, turns(node))).collect();
    if others.is_empty() {
        let problem = Problem::new(path, "no node but the first one").found(&given.nodes);
        return problems.refuse(problem.accepted(["a group with other nodes"]));
    }
    let mut linked: Vec<u32> = others.iter().map(|(node, _)| *node).collect();
    linked.push(first);
    linked.sort_unstable();
    let leads = turns(first);
    if let (true, Some(body)) = (leads, any_angle(mesh, bodies, &linked)) {
        let name = &body.spec.name;
        let message =
            format!("a rigid link turns by small angles, and body '{name}' may turn by any");
        let problem = Problem::new(path, message).found(&given.nodes);
        return problems.refuse(problem.accepted(SMALL_TURNS));
    }
    Some(ModelConstraint::rigid_link(
        name, mesh, first, &others, leads,
    ))
}

/// A term of a constraint: node, direction and factor.
fn term(
    mesh: &Mesh,
    turning: &[u32],
    (path, given): (&str, &ConstraintTerm),
    problems: &mut Problems,
) -> Option<(u32, Kind, f64)> {
    let node = lookup::single(mesh, &format!("{path}.on"), &given.on, problems)?;
    let (axis, rotates) = given.direction.index();
    if !rotates {
        return Some((node, Kind::Translation(axis), given.factor));
    }
    if turning.binary_search(&node).is_err() {
        let message = "only nodes of beams have rotations";
        let problem = Problem::new(format!("{path}.direction"), message);
        return problems.refuse(problem.accepted(["x, y, z", "a node of a beam"]));
    }
    Some((node, Kind::Rotation(axis), given.factor))
}

/// A body with its hinges; `path`: of the body.
pub(super) fn hinged(
    mesh: &Mesh,
    (path, body): (&str, &Body),
    mut spec: BodySpec,
    problems: &mut Problems,
) -> BodySpec {
    for (k, hinge) in body.hinges.iter().enumerate() {
        let path = format!("{path}.hinges[{k}]");
        if !matches!(spec.kinematics, Kinematics::Beam(_)) {
            let problem = Problem::new(path, "only beams have hinges");
            problems.push(problem.accepted(["section.beam"]));
            break;
        }
        let releases = releases(mesh, &path, hinge, &spec.cells, problems);
        spec.releases.extend(releases);
    }
    spec
}

fn releases(
    mesh: &Mesh,
    path: &str,
    hinge: &Hinge,
    cells: &[ElementId],
    problems: &mut Problems,
) -> Vec<Release> {
    let Some(group) = problems.group(mesh, &format!("{path}.on"), &hinge.on) else {
        return Vec::new();
    };
    if let Some(k) = hinge.free.iter().position(|axis| !axis.index().1) {
        let problem = Problem::new(format!("{path}.free[{k}]"), "a hinge frees rotations");
        problems.push(problem.accepted(["rx", "ry", "rz"]));
        return Vec::new();
    }
    let path = format!("{path}.on");
    let rotations = [Axis::Rx, Axis::Ry, Axis::Rz].map(|axis| hinge.free.contains(&axis));
    let mut releases = Vec::new();
    for node in mesh.group_nodes(group) {
        let end = |cell: ElementId| mesh.element_nodes(cell).iter().position(|&n| n == node);
        let own = cells.iter().filter_map(|&cell| Some((cell, end(cell)?)));
        let own: Vec<(ElementId, usize)> = own.collect();
        if own.is_empty() {
            let problem = Problem::new(&path, "a hinge at a node that the body does not have");
            let found = format!("node {node}, {}", place(mesh.nodes[node as usize]));
            problems.push(
                problem
                    .found(found)
                    .accepted(["nodes of the cells of the body"]),
            );
            break;
        }
        let kept = usize::from(own.len() > 1);
        releases.extend(own[kept..].iter().map(|&(cell, end)| Release {
            cell,
            end,
            rotations,
        }));
    }
    releases
}
