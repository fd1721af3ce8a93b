//! Bolts that the static stage tightens: between two nodes, cells of beams, or layers of solids.

use std::collections::{BTreeMap, BTreeSet};

use carom_bodies::{
    Curve, DiscreteKind, DiscreteSpec, Kinematics, Link, Rotations, Tightened, TightenedCell,
};
use carom_dynamics::{ModelBody, ModelDiscrete};
use carom_elements::Kind;
use carom_mesh::{ElementId, Mesh};

use super::context::Context;
use super::discrete;
use super::layers::{self, solid_of};
use super::problems::Problems;
use crate::error::Problem;
use crate::schema::{Ends, Pretension, Section};

/// Bolts between nodes; those of beams and solids are told to their bodies.
pub(super) fn lower(
    context: &Context,
    mesh: &mut Mesh,
    bodies: &mut [ModelBody],
    problems: &mut Problems,
) -> Vec<ModelDiscrete> {
    let case = context.case;
    let mut bolts = Vec::new();
    for (name, given) in case.pretension.iter() {
        let path = format!("pretension.{name}");
        if !is_tightened_in_time(context, &path, problems) {
            continue;
        }
        let of = (name, path.as_str(), given);
        if let Some(ends) = &given.ends {
            bolts.extend(between_nodes(mesh, of, ends, problems));
            continue;
        }
        let on = given.on.as_ref().and_then(|on| mesh.groups.get(on));
        let elements = on.map_or(&[][..], |group| &group.elements);
        match solid_of(mesh, bodies, elements) {
            Some(body) => layers::across_solid(context, (mesh, body), of, elements, problems),
            None => along_beams(context, mesh, bodies, of, problems),
        }
    }
    bolts
}

/// Refuses bolts without a static stage, and in zones.
fn is_tightened_in_time(context: &Context, path: &str, problems: &mut Problems) -> bool {
    let (message, accepted) = match (context.case.time.stage, context.plan.zones.is_empty()) {
        (Some(_), true) => return true,
        (None, _) => (
            "a bolt is tightened over a static stage, and the case has none",
            "static = { end = \"1 s\", steps = 4 } in [time]",
        ),
        (Some(_), false) => ("bolts are not tightened in zones", "a case without zones"),
    };
    let problem = Problem::new(path, message);
    problems.push(problem.accepted([accepted]));
    false
}

/// A bolt between two nodes, or at each node against the ground.
fn between_nodes(
    mesh: &mut Mesh,
    (name, path, given): (&str, &str, &Pretension),
    ends: &Ends,
    problems: &mut Problems,
) -> Option<ModelDiscrete> {
    let stiffness = given.stiffness?.0;
    let (cells, axis) = discrete::linked(mesh, path, ends, given.axis.as_ref(), problems)?;
    let n = axis?;
    for nodes in cells.iter().map(|&cell| mesh.element_nodes(cell)) {
        let [from, to] = [nodes[0], nodes[nodes.len() - 1]].map(|node| mesh.nodes[node as usize]);
        let along: f64 = (0..3).map(|i| n[i] * (to[i] - from[i])).sum();
        if along < 0.0 {
            let message = "the axis points from the second end to the first one: the bolt would push its ends apart";
            let problem = Problem::new(format!("{path}.axis"), message);
            problems.push(problem.accepted(["the direction from the first end to the second one"]));
            return None;
        }
    }
    Some(ModelDiscrete::new(DiscreteSpec {
        name: name.to_owned(),
        cells,
        kind: DiscreteKind::Bolt(Tightened {
            link: Link {
                curve: Curve::line(stiffness),
                axis,
            },
            force: given.force.0,
            tightens: false,
        }),
    }))
}

/// Tells bodies of beams which of their cells are tightened.
fn along_beams(
    context: &Context,
    mesh: &Mesh,
    bodies: &mut [ModelBody],
    (name, path, given): (&str, &str, &Pretension),
    problems: &mut Problems,
) {
    let cells = match (&given.beam, &given.on) {
        (Some(beam), _) => cells_of_beam(context, &format!("{path}.beam"), bodies, beam, problems),
        (None, Some(on)) => {
            cells_of_group(context, (mesh, bodies), &format!("{path}.on"), on, problems)
        }
        (None, None) => None,
    };
    let Some(cells) = cells else { return };
    let Some(lines) = lines(mesh, &cells) else {
        let key = if given.beam.is_some() { "beam" } else { "on" };
        let message =
            "its cells branch or close: which of them are the middles of bolts is not known";
        let problem = Problem::new(format!("{path}.{key}"), message);
        problems.push(problem.accepted([
            "cells along lines with two ends",
            "`on`, a group of one cell of each bolt",
        ]));
        return;
    };
    for (k, line) in lines.iter().enumerate() {
        let cell = line[line.len() / 2];
        let owner = bodies
            .iter_mut()
            .find(|body| body.spec.cells.contains(&cell));
        let Some(body) = owner else { continue };
        let mut all = body.spec.tightened.iter();
        if let Some(other) = all.find(|other| other.cell == cell) {
            let message = format!("`{}` tightens the same cell", other.name);
            problems.push(Problem::new(path, message));
            return;
        }
        body.spec.tightened.push(TightenedCell {
            name: match lines.len() {
                1 => name.to_owned(),
                _ => format!("{name}-{}", k + 1),
            },
            cell,
            force: given.force.0,
            tightens: false,
        });
    }
}

fn cells_of_beam(
    context: &Context,
    path: &str,
    bodies: &[ModelBody],
    beam: &str,
    problems: &mut Problems,
) -> Option<Vec<ElementId>> {
    let all = context.case.body.iter();
    let beams = all.filter(|(_, body)| matches!(body.section, Some(Section::Beam(_))));
    let beams: Vec<&str> = beams.map(|(name, _)| name).collect();
    let body = bodies.iter().find(|body| body.spec.name == beam)?;
    if !beams.contains(&beam) {
        let message = match context.case.body.get(beam) {
            Some(_) => "this body has no beams",
            None => "no body of this name",
        };
        problems.push(Problem::new(path, message).unknown(beam, beams));
        return None;
    }
    may_be_tightened(context, path, body, problems)?;
    Some(body.spec.cells.clone())
}

fn cells_of_group(
    context: &Context,
    (mesh, bodies): (&Mesh, &[ModelBody]),
    path: &str,
    on: &str,
    problems: &mut Problems,
) -> Option<Vec<ElementId>> {
    let cells = problems.group(mesh, path, on)?.elements.clone();
    let of_beams = bodies.iter().filter(is_beam);
    let mut owners = BTreeSet::new();
    for &cell in &cells {
        let mut beams = of_beams.clone();
        let Some(body) = beams.find(|body| body.spec.cells.contains(&cell)) else {
            let message = "a static stage tightens cells of beams, or a section across a solid";
            let problem = Problem::new(path, message).found(on);
            problems.push(problem.accepted([
                "a group of cells of a body with `section.beam`",
                "a group of the cells of a solid between two planes, or of its faces in one",
                "`ends`, `axis` and `stiffness` between two nodes",
            ]));
            return None;
        };
        if owners.insert(&body.spec.name) {
            may_be_tightened(context, path, body, problems)?;
        }
    }
    Some(cells)
}

/// Refuses beams whose cells cannot be tightened.
fn may_be_tightened(
    context: &Context,
    path: &str,
    body: &ModelBody,
    problems: &mut Problems,
) -> Option<()> {
    let Kinematics::Beam(section) = body.spec.kinematics else {
        return None;
    };
    let name = &body.spec.name;
    let given = context.case.body.get(name)?;
    let (message, accepted) = if section.rotations == Rotations::Finite {
        (
            "beams with finite rotations are not tightened",
            "rotations = \"small\"",
        )
    } else if body.spec.material.uniaxial().is_some() {
        (
            "beams whose metal flows are not tightened",
            "an elastic material for the shank",
        )
    } else if given.reduction.is_some() {
        (
            "a reduced body is not tightened",
            "a body that is not reduced",
        )
    } else {
        return Some(());
    };
    let problem = Problem::new(path, message).found(name.as_str());
    problems.push(problem.accepted([accepted]));
    None
}

fn is_beam(body: &&ModelBody) -> bool {
    matches!(body.spec.kinematics, Kinematics::Beam(_))
}

/// Cells of two nodes, line by line in their order from one end to the other; none if they branch or close.
fn lines(mesh: &Mesh, cells: &[ElementId]) -> Option<Vec<Vec<ElementId>>> {
    let mut at: BTreeMap<u32, Vec<ElementId>> = BTreeMap::new();
    for &cell in cells.iter().filter(|&&cell| mesh.kind(cell) == Kind::Bar2) {
        for &node in mesh.element_nodes(cell) {
            at.entry(node).or_default().push(cell);
        }
    }
    if at.values().any(|cells| cells.len() > 2) {
        return None;
    }
    let (mut lines, mut known) = (Vec::new(), BTreeSet::new());
    let ends = at.iter().filter(|(_, cells)| cells.len() == 1);
    for (&end, _) in ends {
        let (mut node, mut line) = (end, Vec::new());
        while let Some(&cell) = at[&node].iter().find(|cell| !known.contains(*cell)) {
            known.insert(cell);
            line.push(cell);
            let nodes = mesh.element_nodes(cell);
            node = if nodes[0] == node { nodes[1] } else { nodes[0] };
        }
        if !line.is_empty() {
            lines.push(line);
        }
    }
    (known.len() == cells.len()).then_some(lines)
}
