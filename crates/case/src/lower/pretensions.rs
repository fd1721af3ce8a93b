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
use super::layers::{self, Bolt, solid_of};
use super::problems::{Problems, Refusal};
use crate::error::Problem;
use crate::schema::{Ends, Section};

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
        let bolt = Bolt {
            name,
            path: format!("pretension.{name}"),
            given,
        };
        if is_tightened_in_time(context, &bolt, problems).is_none() {
            continue;
        }
        if let Some(ends) = &given.ends {
            bolts.extend(between_nodes(mesh, &bolt, ends, problems));
            continue;
        }
        let on = given.on.as_ref().and_then(|on| mesh.groups.get(on));
        let elements = on.map_or(&[][..], |group| &group.elements);
        match solid_of(mesh, bodies, elements) {
            Some(body) => {
                let tightened = layers::across_solid(context, (mesh, body), &bolt, problems);
                body.spec.layers.extend(tightened.unwrap_or_default());
            }
            None => {
                let tightened = along_beams(context, mesh, bodies, &bolt, problems);
                for (body, cell) in tightened.unwrap_or_default() {
                    bodies[body].spec.tightened.push(cell);
                }
            }
        }
    }
    bolts
}

/// Refuses bolts without a static stage.
fn is_tightened_in_time(context: &Context, bolt: &Bolt, problems: &mut Problems) -> Option<()> {
    let table = [Refusal {
        is: context.case.time.stage.is_none(),
        key: "",
        message: "a bolt is tightened over a static stage, and the case has none",
        accepted: &["static = { end = \"1 s\", steps = 4 } in [time]"],
    }];
    problems.refuse_first((&bolt.path, None), &table)
}

/// A bolt between two nodes, or at each node against the ground.
fn between_nodes(
    mesh: &mut Mesh,
    Bolt { name, path, given }: &Bolt,
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
            return problems
                .refuse(problem.accepted(["the direction from the first end to the second one"]));
        }
    }
    Some(ModelDiscrete::new(DiscreteSpec {
        name: (*name).to_owned(),
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

/// Cells of beams that are tightened, with the numbers of their bodies.
fn along_beams(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    bolt: &Bolt,
    problems: &mut Problems,
) -> Option<Vec<(usize, TightenedCell)>> {
    let Bolt { path, given, .. } = bolt;
    let (key, cells) = match (&given.beam, &given.on) {
        (Some(beam), _) => {
            let path = format!("{path}.beam");
            (
                "beam",
                cells_of_beam(context, &path, bodies, beam, problems)?,
            )
        }
        (None, on) => {
            let path = format!("{path}.on");
            let on = on.as_ref()?;
            (
                "on",
                cells_of_group(context, (mesh, bodies), &path, on, problems)?,
            )
        }
    };
    let Some(lines) = lines(mesh, &cells) else {
        let message =
            "its cells branch or close: which of them are the middles of bolts is not known";
        let problem = Problem::new(format!("{path}.{key}"), message);
        return problems.refuse(problem.accepted([
            "cells along lines with two ends",
            "`on`, a group of one cell of each bolt",
        ]));
    };
    let mut tightened = Vec::new();
    for (k, line) in lines.iter().enumerate() {
        let cell = line[line.len() / 2];
        let mut all = bodies.iter();
        let Some(number) = all.position(|body| body.spec.cells.contains(&cell)) else {
            continue;
        };
        let mut others = bodies[number].spec.tightened.iter();
        if let Some(other) = others.find(|other| other.cell == cell) {
            let message = format!("`{}` tightens the same cell", other.name);
            return problems.refuse(Problem::new(path, message));
        }
        let cell = TightenedCell {
            name: bolt.name_of(k, lines.len()),
            cell,
            force: given.force.0,
            tightens: false,
        };
        tightened.push((number, cell));
    }
    Some(tightened)
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
        return problems.refuse(Problem::new(path, message).unknown(beam, beams));
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
            return problems.refuse(problem.accepted([
                "a group of cells of a body with `section.beam`",
                "a group of the cells of a solid between two planes, or of its faces in one",
                "`ends`, `axis` and `stiffness` between two nodes",
            ]));
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
    let table = [
        Refusal {
            is: section.rotations == Rotations::Finite,
            key: "",
            message: "beams with finite rotations are not tightened",
            accepted: &["rotations = \"small\""],
        },
        Refusal {
            is: body.spec.material.uniaxial().is_some(),
            key: "",
            message: "beams whose metal flows are not tightened",
            accepted: &["an elastic material for the shank"],
        },
        Refusal {
            is: context.case.body.get(name)?.reduction.is_some(),
            key: "",
            message: "a reduced body is not tightened",
            accepted: &["a body that is not reduced"],
        },
    ];
    problems.refuse_first((path, Some(name)), &table)
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
