//! Rigid links and linear constraints, and the hinges of beams.

use carom_algebra::unknowns::Kind;
use carom_bodies::{BodySpec, Kinematics, Release};
use carom_dynamics::{ModelBody, ModelConstraint};
use carom_mesh::{ElementId, Mesh};

use super::context::Context;
use super::problems::Problems;
use super::turning::{SMALL_TURNS, any_angle};
use super::{beams, lookup};
use crate::error::Problem;
use crate::schema::{Axis, Body, Hinge};

/// The constraints of a case.
pub(super) fn lower(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    problems: &mut Problems,
) -> Vec<ModelConstraint> {
    let case = context.case;
    let turning = beams::nodes_with_rotations(context, mesh);
    let turns = |node: u32| turning.binary_search(&node).is_ok();
    let mut all = Vec::new();
    for (name, link) in case.rigid_link.iter() {
        let path = format!("rigid-link.{name}");
        let first = lookup::single(mesh, &format!("{path}.first"), &link.first, problems);
        let nodes = problems.group(mesh, &format!("{path}.nodes"), &link.nodes);
        let (Some(first), Some(nodes)) = (first, nodes) else {
            continue;
        };
        let nodes: Vec<(u32, bool)> = mesh
            .group_nodes(nodes)
            .into_iter()
            .filter(|&node| node != first)
            .map(|node| (node, turns(node)))
            .collect();
        if nodes.is_empty() {
            let problem = Problem::new(format!("{path}.nodes"), "no node but the first one");
            let problem = problem.found(&link.nodes);
            problems.push(problem.accepted(["a group with other nodes"]));
            continue;
        }
        let leads = turns(first);
        let mut linked: Vec<u32> = nodes.iter().map(|(node, _)| *node).collect();
        linked.push(first);
        linked.sort_unstable();
        if let (true, Some(body)) = (leads, any_angle(mesh, bodies, &linked)) {
            let name = &body.spec.name;
            let message =
                format!("a rigid link turns by small angles, and body '{name}' may turn by any");
            let problem = Problem::new(format!("{path}.nodes"), message).found(&link.nodes);
            problems.push(problem.accepted(SMALL_TURNS));
            continue;
        }
        all.push(ModelConstraint::rigid_link(
            name, mesh, first, &nodes, leads,
        ));
    }
    for (name, constraint) in case.constraint.iter() {
        let mut row = Vec::new();
        for (k, term) in constraint.terms.iter().enumerate() {
            let path = format!("constraint.{name}.terms[{k}]");
            let Some(node) = lookup::single(mesh, &format!("{path}.on"), &term.on, problems) else {
                continue;
            };
            let (axis, rotates) = term.direction.index();
            let kind = match rotates {
                true => Kind::Rotation(axis),
                false => Kind::Translation(axis),
            };
            if rotates && !turns(node) {
                let problem = Problem::new(
                    format!("{path}.direction"),
                    "only nodes of beams have rotations",
                );
                problems.push(problem.accepted(["x, y, z", "a node of a beam"]));
                continue;
            }
            row.push((node, kind, term.factor));
        }
        all.push(ModelConstraint {
            name: name.to_owned(),
            rows: vec![row],
        });
    }
    if let (Some(first), false) = (all.first(), context.plan.zones.is_empty()) {
        let kind = match case.rigid_link.get(&first.name) {
            Some(_) => "rigid-link",
            None => "constraint",
        };
        let message = "rigid links and constraints are not available in zones";
        let problem = Problem::new(format!("{kind}.{}", first.name), message);
        problems.push(problem.accepted(["a case without zones"]));
    }
    all
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
            let x = mesh.nodes[node as usize];
            let problem = Problem::new(&path, "a hinge at a node that the body does not have");
            problems.push(
                problem
                    .found(format!(
                        "node {node}, ({:.6}, {:.6}, {:.6}) m",
                        x[0], x[1], x[2]
                    ))
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
