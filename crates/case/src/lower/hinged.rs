//! Beams and shells that share nodes with solids. Solids have no rotations: they hold such a node where it is, and not as it is turned.
//!
//! A cell of a beam or a shell that shares a node with a solid turns about it, a shell about the edge that it shares. It is held against that where
//!
//! * another cell with rotations at this node lies on the solid with all its nodes: one of a shell, or of a beam, in space of beams on no single
//!   line, about which they would turn,
//! * supports, rigid bodies, rigid links, constraints or overlaps hold or join its rotations.
//!
//! All others are hinges, which the body must ask for.

use std::collections::{BTreeMap, BTreeSet};

use carom_algebra::unknowns::Kind;
use carom_bodies::Kinematics;
use carom_dynamics::{ModelBody, ModelConstraint, PrescribedTurn, Support};
use carom_mesh::{ElementId, Mesh, Parts};

use super::context::Context;
use super::joints::is_thin;
use super::problems::Problems;
use crate::error::Problem;

/// A node of a solid, and the axes about which a body may turn there.
type FreeNode = (u32, Vec<[f64; 3]>);

/// Sine of an angle below which places are on one line.
const STRAIGHT: f64 = 1e-6;

/// What joins or holds rotations of nodes.
pub(super) struct Joined<'a> {
    pub(super) constraints: &'a [ModelConstraint],
    pub(super) supports: &'a [Support],
    pub(super) turns: &'a [PrescribedTurn],
}

/// Solids by the nodes that they share with beams and shells.
type Shared = BTreeMap<u32, Vec<usize>>;

/// Refuses hinges between a beam or a shell and a solid that its body does not ask for, and bodies that ask for none.
pub(super) fn check(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    joined: &Joined,
    problems: &mut Problems,
) {
    let shared = shared(mesh, bodies);
    let held = held(mesh, bodies, &shared);
    for (number, body) in bodies.iter().enumerate() {
        let Some(given) = context.case.body.get(&body.spec.name) else {
            continue;
        };
        let path = format!("body.{}", body.spec.name);
        let mut found: BTreeMap<usize, Vec<FreeNode>> = BTreeMap::new();
        if is_thin(body) && body.rigid.is_none() {
            for (node, axes) in hinges((mesh, body), &shared, &held) {
                if is_joined(mesh, node, &axes, joined) {
                    continue;
                }
                for &solid in &shared[&node] {
                    if !are_glued(context, bodies, [number, solid]) {
                        found.entry(solid).or_default().push((node, axes.clone()));
                    }
                }
            }
        }
        let name = |solid: usize| bodies[solid].spec.name.as_str();
        for (&solid, nodes) in &found {
            if !given.hinged_to.iter().any(|asked| asked == name(solid)) {
                let problem = refusal((&path, mesh), nodes, name(solid));
                problems.push(problem);
            }
        }
        for (k, asked) in given.hinged_to.iter().enumerate() {
            if !found.keys().any(|&solid| name(solid) == asked) {
                let message = "this body has no hinge on that one: they share no node, or the rotation there is held";
                let problem = Problem::new(format!("{path}.hinged-to[{k}]"), message);
                let others = found.keys().map(|&solid| name(solid));
                problems.push(match found.is_empty() {
                    true => problem.found(asked).accepted(["no `hinged-to`"]),
                    false => problem.unknown(asked, others),
                });
            }
        }
    }
}

/// Whether an overlap glues two bodies.
fn are_glued(context: &Context, bodies: &[ModelBody], pair: [usize; 2]) -> bool {
    let names = pair.map(|body| &bodies[body].spec.name);
    let mut glued = context.case.arlequin.iter();
    glued.any(|(_, given)| {
        let mut names = names.iter();
        names.all(|name| **name == given.inner || **name == given.outer)
    })
}

fn refusal((path, mesh): (&str, &Mesh), nodes: &[(u32, Vec<[f64; 3]>)], solid: &str) -> Problem {
    let (node, axes) = &nodes[0];
    let [x, y, z] = mesh.nodes[*node as usize];
    let about = match axes[..] {
        [axis] if mesh.dim == 3 => {
            let [x, y, z] = axis;
            format!(" about ({x:.3}, {y:.3}, {z:.3}), the line of the nodes that it shares")
        }
        _ => String::new(),
    };
    let message = format!(
        "it turns freely where it shares nodes with the solid `{solid}`: a solid has no rotations to hold it{about}"
    );
    let count = match nodes.len() {
        1 => String::new(),
        count => format!(", and {} more", count - 1),
    };
    Problem::new(format!("{path}.region"), message)
        .found(format!("node {node} at ({x:.6}, {y:.6}, {z:.6}) m{count}"))
        .accepted([
            "nodes of its own, and a [transition.<name>] of its end or edge to a face of the solid"
                .to_owned(),
            format!("hinged-to = [\"{solid}\"], if a hinge is meant"),
            "a support that holds the rotation".to_owned(),
        ])
}

/// Nodes that beams and shells share with solids that are not rigid and with no rigid body.
fn shared(mesh: &Mesh, bodies: &[ModelBody]) -> Shared {
    let nodes = |body: &ModelBody| -> BTreeSet<u32> {
        let cells = body.spec.cells.iter();
        cells
            .flat_map(|&cell| mesh.element_nodes(cell).iter().copied())
            .collect()
    };
    let soft = |body: &&ModelBody| is_thin(body) && body.rigid.is_none();
    let turning: BTreeSet<u32> = bodies.iter().filter(soft).flat_map(nodes).collect();
    let mut shared = Shared::new();
    if turning.is_empty() {
        return shared;
    }
    let is_solid = |body: &ModelBody| {
        let mut cells = body.spec.cells.iter();
        let fills = |cell: &ElementId| mesh.kind(*cell).table().dim == mesh.dim;
        !is_thin(body) && cells.any(fills)
    };
    let solids = bodies.iter().enumerate();
    let solids = solids.filter(|(_, body)| body.rigid.is_none() && is_solid(body));
    for (number, body) in solids {
        for node in nodes(body).intersection(&turning) {
            shared.entry(*node).or_default().push(number);
        }
    }
    let rigid = bodies.iter().filter(|body| body.rigid.is_some());
    for node in rigid.flat_map(nodes) {
        shared.remove(&node);
    }
    shared
}

/// Nodes whose rotation a cell that lies on the solid holds.
fn held(mesh: &Mesh, bodies: &[ModelBody], shared: &Shared) -> BTreeSet<u32> {
    let lies = |cell: &&ElementId| {
        let mut nodes = mesh.element_nodes(**cell).iter();
        nodes.all(|node| shared.contains_key(node))
    };
    let thin = || bodies.iter().filter(|body| is_thin(body));
    let (mut held, mut lines) = (BTreeSet::new(), Vec::new());
    for body in thin() {
        let cells = body.spec.cells.iter().filter(lies);
        match body.spec.kinematics {
            Kinematics::Shell(_) => {
                held.extend(cells.flat_map(|&cell| mesh.element_nodes(cell).iter().copied()));
            }
            _ => lines.extend(cells.copied()),
        }
    }
    let parts = Parts::new(mesh, lines.iter().copied());
    let mut chains: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &node in lines.iter().flat_map(|&cell| mesh.element_nodes(cell)) {
        if let Some(part) = parts.of(node) {
            chains.entry(part).or_default().push(node);
        }
    }
    let holds = |chain: &Vec<u32>| mesh.dim == 2 || !is_straight(mesh, chain);
    held.extend(chains.into_values().filter(holds).flatten());
    held
}

fn way(mesh: &Mesh, from: u32, to: u32) -> [f64; 3] {
    let [from, to] = [from, to].map(|node| mesh.nodes[node as usize]);
    [0, 1, 2].map(|i| to[i] - from[i])
}

fn length(v: &[f64; 3]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Whether nodes are on one line.
fn is_straight(mesh: &Mesh, nodes: &[u32]) -> bool {
    let ways = nodes.iter().map(|&node| way(mesh, nodes[0], node));
    let ways: Vec<[f64; 3]> = ways.collect();
    let Some(longest) = ways.iter().max_by(|a, b| length(a).total_cmp(&length(b))) else {
        return true;
    };
    let beside = |v: &[f64; 3]| {
        let cross = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            v[j] * longest[k] - v[k] * longest[j]
        });
        length(&cross) > STRAIGHT * length(longest).powi(2)
    };
    !ways.iter().any(beside)
}

/// Nodes about which a body turns freely, ascending, with the axes.
fn hinges(
    (mesh, body): (&Mesh, &ModelBody),
    shared: &Shared,
    held: &BTreeSet<u32>,
) -> BTreeMap<u32, Vec<[f64; 3]>> {
    let is_shell = matches!(body.spec.kinematics, Kinematics::Shell(_));
    let mut found = BTreeMap::new();
    for &cell in &body.spec.cells {
        let nodes = mesh.element_nodes(cell);
        let on: Vec<u32> = nodes
            .iter()
            .copied()
            .filter(|node| shared.contains_key(node))
            .collect();
        if on.len() == nodes.len() {
            continue;
        }
        for &node in on.iter().filter(|node| !held.contains(node)) {
            let other = on.iter().find(|other| **other != node);
            let axes = match (mesh.dim, is_shell, other) {
                (2, ..) => vec![[0.0, 0.0, 1.0]],
                (_, true, Some(&other)) => {
                    let edge = way(mesh, node.min(other), node.max(other));
                    vec![edge.map(|e| e / length(&edge))]
                }
                _ => [0, 1, 2]
                    .map(|i| [0, 1, 2].map(|j| f64::from(u8::from(i == j))))
                    .to_vec(),
            };
            // where one cell shares an edge, another that shares its end turns about it too
            let known = found.entry(node).or_insert_with(|| axes.clone());
            if axes.len() < known.len() {
                *known = axes;
            }
        }
    }
    found
}

/// Whether supports hold, or constraints join, the rotations of a node about these axes.
fn is_joined(mesh: &Mesh, node: u32, axes: &[[f64; 3]], joined: &Joined) -> bool {
    let first = if mesh.dim == 2 { 2 } else { 0 };
    let terms = joined
        .constraints
        .iter()
        .flat_map(|one| &one.rows)
        .flatten();
    let mut terms = terms.filter(|(of, kind, _)| *of == node && matches!(kind, Kind::Rotation(_)));
    if terms.next().is_some() {
        return true;
    }
    let fixed = |axis: usize| {
        let mut supports = joined.supports.iter();
        let mut turns = joined.turns.iter();
        supports.any(|one| one.fix_rotations[axis] && one.nodes.contains(&node))
            || turns.any(|turn| turn.node == node && turn.axis == axis)
    };
    let crosses = |axis: usize| axes.iter().any(|of| of[axis].abs() > STRAIGHT);
    (first..3).all(|axis| !crosses(axis) || fixed(axis))
}
