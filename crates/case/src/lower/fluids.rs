//! What moves with bodies and holds them along their length: fluids around beams and between two bodies, elastic foundations.

use carom_bodies::{DiscreteKind, DiscreteSpec, FluidGap};
use carom_dynamics::ModelDiscrete;
use carom_elements::Kind;
use carom_mesh::{ElementId, Group, Mesh};

use super::context::Context;
use super::lookup;
use super::problems::{Problems, plural};
use crate::error::Problem;
use crate::schema::{self, AddedMass};

/// Distance along the axis, over the length of the body, up to which nodes stand beside each other.
const BESIDE: f64 = 1e-6;

/// An inner and an outer node, and the length that they stand for, m.
type Pair = ([u32; 2], f64);

/// Stiffness of an elastic foundation along the axes of the section, N/m²; `path`: of the section.
pub(super) fn foundation(
    mesh: &Mesh,
    path: &str,
    given: Option<schema::Foundation>,
    problems: &mut Problems,
) -> Option<[f64; 3]> {
    let Some(given) = given else {
        return Some([0.0; 3]);
    };
    if mesh.dim == 2 && given.z.is_some() {
        let problem = Problem::new(
            format!("{path}.foundation.z"),
            "in the plane nothing moves along z",
        );
        return problems.refuse(problem.accepted(["x", "y"]));
    }
    Some([given.x, given.y, given.z].map(|k| k.map_or(0.0, |k| k.0)))
}

/// Masses per length of the fluid around a section of this outer diameter, kg/m: what moves with it, and what it displaces.
pub(super) fn added_mass(
    path: &str,
    given: Option<AddedMass>,
    diameter: Option<f64>,
    problems: &mut Problems,
) -> Option<[f64; 2]> {
    let channel = match given {
        None => return Some([0.0; 2]),
        Some(AddedMass::PerLength(mass)) => return Some([mass.0, 0.0]),
        Some(AddedMass::Channel(channel)) => channel,
    };
    let path = format!("{path}.added-mass.channel");
    let Some(diameter) = diameter else {
        let problem = Problem::new(
            path,
            "the added mass in a channel is known of round sections",
        );
        return problems.refuse(problem.accepted(["shape.circle", "shape.tube", "`per-length`"]));
    };
    let outer = channel.diameter.0;
    if outer <= diameter {
        let problem = Problem::new(
            format!("{path}.diameter"),
            "the channel is not around the section",
        );
        let problem = problem.found(format!("{outer} m"));
        return problems.refuse(problem.accepted([format!("more than {diameter} m")]));
    }
    Some(FluidGap::around(
        channel.density.0,
        [0.5 * diameter, 0.5 * outer],
    ))
}

/// The fluids in gaps; their cells are added to the mesh.
pub(super) fn lower(
    context: &Context,
    mesh: &mut Mesh,
    problems: &mut Problems,
) -> Vec<ModelDiscrete> {
    let fluids = context.case.fluid.iter();
    let fluids = fluids.map(|(name, given)| fluid(mesh, name, given, problems));
    fluids.flatten().flatten().collect()
}

/// The fluid in one gap, by the length that pairs of nodes stand for.
fn fluid(
    mesh: &mut Mesh,
    name: &str,
    given: &schema::FluidGap,
    problems: &mut Problems,
) -> Option<Vec<ModelDiscrete>> {
    let path = format!("fluid.{name}");
    let per_length = fluid_per_length(&path, given, problems)?;
    let (pairs, axis) = beside(mesh, &path, given, problems)?;
    let mut sets: Vec<(f64, Vec<ElementId>)> = Vec::new();
    for (nodes, length) in pairs {
        let cell = mesh.push(Kind::Bar2, &nodes);
        let mut known = sets.iter_mut();
        match known.find(|(other, _)| (*other - length).abs() <= BESIDE * length) {
            Some((_, cells)) => cells.push(cell),
            None => sets.push((length, vec![cell])),
        }
    }
    let width = given.diameters;
    let width = width.map(|[inner, outer]| 0.5 * (outer.0 - inner.0));
    let set = |(k, (length, cells)): (usize, (f64, Vec<ElementId>))| {
        ModelDiscrete::new(DiscreteSpec {
            name: match k {
                0 => name.to_owned(),
                _ => format!("{name}.{}", k + 1),
            },
            cells,
            kind: DiscreteKind::Fluid(FluidGap {
                masses: per_length.map(|mass| mass * length),
                axis: Some(axis),
                width,
            }),
        })
    };
    Some(sets.into_iter().enumerate().map(set).collect())
}

/// Masses of a fluid per length, kg/m.
fn fluid_per_length(
    path: &str,
    fluid: &schema::FluidGap,
    problems: &mut Problems,
) -> Option<[f64; 3]> {
    let (Some(diameters), Some(density)) = (fluid.diameters, fluid.density) else {
        return fluid.relative_mass.map(|mass| [mass.0, -mass.0, mass.0]);
    };
    let [inner, outer] = diameters.map(|d| 0.5 * d.0);
    if inner < outer {
        return Some(FluidGap::new(density.0, [inner, outer], 1.0).masses);
    }
    let message = "no gap is between these diameters";
    let problem = Problem::new(format!("{path}.diameters"), message);
    let found = format!("{} m and {} m", 2.0 * inner, 2.0 * outer);
    let accepted = "the inner one first, and less than the outer one";
    problems.refuse(problem.found(found).accepted([accepted]))
}

/// Pairs of nodes beside each other with the length that each stands for (m), and the axis.
fn beside(
    mesh: &Mesh,
    path: &str,
    fluid: &schema::FluidGap,
    problems: &mut Problems,
) -> Option<(Vec<Pair>, [f64; 3])> {
    let inner = problems.group(mesh, &format!("{path}.inner"), &fluid.inner)?;
    let outer = problems.group(mesh, &format!("{path}.outer"), &fluid.outer)?;
    if let (Some(length), Some(axis)) = (fluid.length, &fluid.axis) {
        let [one, other] = [inner, outer].map(|group| mesh.group_nodes(group));
        let axis = lookup::normal(mesh, &format!("{path}.axis"), axis, problems)?;
        if let ([one], [other]) = (&one[..], &other[..]) {
            return Some((vec![([*one, *other], length.0)], axis));
        }
        let problem = Problem::new(format!("{path}.length"), "a length is that of one node");
        let [one, other] = [one, other].map(|nodes| plural(nodes.len(), "node"));
        let accepted = ["groups of one node", "groups of lines, without `length`"];
        return problems.refuse(
            problem
                .found(format!("{one} and {other}"))
                .accepted(accepted),
        );
    }
    let lines = |group: &Group| group.dim == 1;
    if lines(inner) && lines(outer) {
        return along_lines(mesh, path, [inner, outer], problems);
    }
    let key = if lines(inner) { "outer" } else { "inner" };
    let problem = Problem::new(format!("{path}.{key}"), "a fluid gap is along lines");
    problems.refuse(problem.accepted([
        "a group of bars or beams",
        "a group of one node with `length` and `axis`",
    ]))
}

/// As [`beside`], of groups of lines: each node of the inner one, with half of the lines that it has.
fn along_lines(
    mesh: &Mesh,
    path: &str,
    [inner, outer]: [&Group; 2],
    problems: &mut Problems,
) -> Option<(Vec<Pair>, [f64; 3])> {
    let (own, others) = (mesh.group_nodes(inner), mesh.group_nodes(outer));
    let [from, to] = [own.first()?, own.last()?].map(|&node| mesh.nodes[node as usize]);
    let way = [0, 1, 2].map(|i| to[i] - from[i]);
    let size = way.iter().map(|w| w * w).sum::<f64>().sqrt();
    let axis = way.map(|w| w / size);
    let place = |node: u32| -> f64 {
        let x = mesh.nodes[node as usize];
        (0..3).map(|i| axis[i] * (x[i] - from[i])).sum()
    };
    let mut pairs: Vec<Pair> = Vec::new();
    for &node in &own {
        let off = |other: &&u32| (place(**other) - place(node)).abs();
        let nearest = others.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
        if off(&nearest) > BESIDE * size {
            let message = "nodes of the two bodies must stand beside each other along the axis";
            let problem = Problem::new(format!("{path}.outer"), message);
            let (count, most) = (plural(others.len(), "node"), BESIDE * size);
            let problem = problem.found(format!(
                "{count}, none within {most:.3e} m of node {node} of the inner body"
            ));
            return problems
                .refuse(problem.accepted(["bodies with the same division along the axis"]));
        }
        let around = |id: &&ElementId| mesh.element_nodes(**id).contains(&node);
        let half = |id: &ElementId| {
            let nodes = mesh.element_nodes(*id);
            0.5 * (place(nodes[1]) - place(nodes[0])).abs()
        };
        let length = inner.elements.iter().filter(around).map(half).sum();
        pairs.push(([node, *nearest], length));
    }
    Some((pairs, axis))
}
