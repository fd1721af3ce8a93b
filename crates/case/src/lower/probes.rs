//! Probes: the nodes of their groups, each with its share of the group.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use carom_bodies::Kinematics;
use carom_dynamics::{ModelBody, System};
use carom_elements::{MAX_NODES, map};
use carom_mesh::{ElementId, Group, Mesh};
use carom_output::Spectrum;
use carom_signals::ChannelFilter;

use super::built::BuiltProbe;
use super::context::Context;
use super::joints::is_thin;
use super::problems::Problems;
use crate::error::Problem;
use crate::schema::{Mean, Motion, Probe};

/// What a probe records of one cell.
struct OfCell {
    what: Motion,
    key: &'static str,
    message: &'static str,
    accepted: &'static str,
}

/// A stress has a cell, and so have forces in a section.
const OF_CELLS: [OfCell; 2] = [
    OfCell {
        what: Motion::Stress,
        key: "stress",
        message: "the stress of a probe is that of one cell",
        accepted: "`at` in place of `on`",
    },
    OfCell {
        what: Motion::SectionForces,
        key: "section-forces",
        message: "forces in a section are those of one cell of a beam or a shell",
        accepted: "`at`, in a model with beams or shells",
    },
];

/// The probes of a case.
pub(super) fn lower(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    problems: &mut Problems,
) -> Vec<BuiltProbe> {
    let probes = context.case.probe.iter();
    let probes = probes.map(|(name, given)| probe(mesh, bodies, (name, given), problems));
    probes.flatten().collect()
}

/// One probe.
fn probe(
    mesh: &Mesh,
    bodies: &[ModelBody],
    (name, given): (&str, &Probe),
    problems: &mut Problems,
) -> Option<BuiltProbe> {
    let spectrum = spectrum(name, given, problems);
    let (nodes, cell, section) = match (&given.on, &given.at) {
        (Some(on), _) => {
            let group = problems.group(mesh, &format!("probe.{name}.on"), on)?;
            let turns = |body: &ModelBody| body.spec.kinematics == Kinematics::Axisymmetric;
            (shares(mesh, group, bodies.iter().any(turns)), None, None)
        }
        (None, Some(at)) => {
            let at = problems.vector(mesh, &format!("probe.{name}.at"), at);
            let node = nearest_node(mesh, bodies, &at);
            let thin = bodies.iter().filter(|body| is_thin(body));
            (
                node.map(|node| (node, 1.0)).into_iter().collect(),
                nearest_cell(mesh, bodies.iter(), &at),
                nearest_cell(mesh, thin, &at).map(|cell| (cell, end(mesh, cell, &at))),
            )
        }
        (None, None) => return None,
    };
    let has = |what| given.record.contains(&what);
    for (row, there) in OF_CELLS.iter().zip([cell.is_some(), section.is_some()]) {
        let place = given.record.iter().position(|of| *of == row.what);
        if let (Some(place), false) = (place, there) {
            let problem = Problem::new(format!("probe.{name}.record[{place}]"), row.message);
            problems.push(problem.found(row.key).accepted([row.accepted]));
        }
    }
    Some(BuiltProbe {
        name: name.to_string(),
        nodes,
        cell: cell.filter(|_| has(Motion::Stress)),
        section: section.filter(|_| has(Motion::SectionForces)),
        record: given.record.clone(),
        spectrum,
        filters: given.filter.iter().map(|class| class.frequency()).collect(),
    })
}

/// Refuses probes of contacts where there is no contact point.
pub(super) fn at_contacts(probes: &[BuiltProbe], system: &System, problems: &mut Problems) {
    let wanted = |probe: &&BuiltProbe| probe.record.contains(&Motion::Contact);
    for probe in probes.iter().filter(wanted) {
        let has = |node: u32| {
            let mesh_node = system.mesh_node[node as usize];
            probe.nodes.iter().any(|(own, _)| *own == mesh_node)
        };
        let mut points = system.contacts.iter().flat_map(|contact| &contact.points);
        if points.any(|point| point.carriers().any(|(node, _)| has(node))) {
            continue;
        }
        let place = probe.record.iter().position(|of| *of == Motion::Contact);
        let path = format!("probe.{}.record[{}]", probe.name, place.unwrap_or(0));
        let message = "there is no contact point at the nodes of this probe: those of a contact are on its secondary side";
        let problem = Problem::new(path, message).found("contact");
        let accepted = ["a probe on the secondary side of a contact"];
        problems.push(problem.accepted(accepted));
    }
}

/// Probes with masses as weights where they ask for them.
pub(super) fn weighed(
    context: &Context,
    mut probes: Vec<BuiltProbe>,
    system: &System,
    problems: &mut Problems,
) -> Vec<BuiltProbe> {
    let given = |probe: &BuiltProbe| context.case.probe.get(&probe.name).map(|given| given.mean);
    if probes.iter().all(|probe| given(probe) != Some(Mean::Mass)) {
        return probes;
    }
    let mut masses = vec![0.0; system.x.len()];
    for &(node, mass) in system.body_masses.iter().flatten() {
        masses[node as usize] += mass;
    }
    for probe in &mut probes {
        let given = context.case.probe.get(&probe.name);
        let Some(given) = given.filter(|given| given.mean == Mean::Mass) else {
            continue;
        };
        let path = format!("probe.{}.mean", probe.name);
        if given.on.is_none() {
            let problem = Problem::new(path, "the motion of one node has no mean");
            let accepted = ["`on` in place of `at`", "no `mean`"];
            problems.push(problem.found("mass").accepted(accepted));
            continue;
        }
        for (node, weight) in &mut probe.nodes {
            let number = system.number[*node as usize];
            *weight = masses.get(number as usize).copied().unwrap_or(0.0);
        }
        if probe.nodes.iter().all(|(_, weight)| *weight == 0.0) {
            let problem = Problem::new(path, "the nodes of the probe have no mass");
            let accepted = ["measure", "a group with mass"];
            problems.push(problem.found("mass").accepted(accepted));
        }
    }
    probes
}

/// Refuses formats of fields that are not built in.
pub(super) fn formats(context: &Context, problems: &mut Problems) {
    let fields = context.case.output.fields.as_ref();
    if cfg!(not(feature = "hdf5")) && fields.is_some_and(|fields| fields.vtkhdf) {
        let message = "this carom writes no VTKHDF files";
        let problem = Problem::new("output.fields.vtkhdf", message).found("true");
        problems.push(problem.accepted([
            "`false`",
            "a carom that is built with: cargo build --release --features hdf5",
        ]));
    }
}

fn spectrum(name: &str, probe: &Probe, problems: &mut Problems) -> Option<Spectrum> {
    let given = probe.response_spectrum?;
    let [from, to] = [given.from.0, given.to.0];
    if to <= from {
        let path = format!("probe.{name}.response-spectrum.to");
        let message = "the highest frequency is not above the lowest one";
        let problem = Problem::new(path, message).found(format!("{to} Hz"));
        return problems.refuse(problem.accepted([format!("more than {from} Hz")]));
    }
    Some(Spectrum::between(
        [from, to],
        given.points as usize,
        given.damping,
    ))
}

/// Refuses filters for which the steps, of `dt` (s), are too long.
pub(super) fn fine_enough(context: &Context, dt: f64, problems: &mut Problems) {
    let probes = context.case.probe.iter();
    let probes = probes.map(|(name, probe)| (format!("probe.{name}"), &probe.filter));
    let contacts = context.case.contact.iter();
    let contacts = contacts.map(|(name, contact)| (format!("contact.{name}"), &contact.filter));
    for (owner, filters) in probes.chain(contacts) {
        for (place, class) in filters.iter().enumerate() {
            let longest = ChannelFilter::longest_step(f64::from(class.frequency()));
            if dt > longest * (1.0 + 1e-9) {
                let path = format!("{owner}.filter[{place}]");
                let message = format!(
                    "the filter needs ten steps in the period of its class, and a step is {dt:.4e} s"
                );
                let problem = Problem::new(path, message).found(class.name());
                problems.push(problem.accepted([
                    format!("steps of at most {longest:.4e} s"),
                    "a lower class".to_owned(),
                ]));
            }
        }
    }
}

/// Refuses probes on nodes of no body. `of`: cells of each body; with overlaps without those that are removed.
pub(super) fn within_bodies(
    context: &Context,
    mesh: &Mesh,
    probes: &[BuiltProbe],
    of: &[Vec<ElementId>],
    problems: &mut Problems,
) {
    let mut used = vec![false; mesh.nodes.len()];
    let nodes = of
        .iter()
        .flatten()
        .flat_map(|&cell| mesh.element_nodes(cell));
    nodes.for_each(|&node| used[node as usize] = true);
    for probe in probes {
        let is_there = |cell: ElementId| of.iter().any(|cells| cells.contains(&cell));
        let cells = probe.cell.into_iter();
        let section = probe.section.map(|(cell, _)| cell);
        if cells.chain(section).any(|cell| !is_there(cell)) {
            let path = format!("probe.{}.at", probe.name);
            let message =
                "the nearest cell is one of those that are removed inside an overlapping body";
            let problem = Problem::new(path, message);
            problems.push(problem.accepted(["a place in the body that stays"]));
            continue;
        }
        let outside = |(node, _): &&(u32, f64)| !used[*node as usize];
        let (message, accepted) = match probe.nodes.iter().filter(outside).count() {
            0 => continue,
            _ if !context.case.arlequin.is_empty() => (
                "the probe has nodes of cells that are removed inside an overlapping body",
                "a group of the body that stays",
            ),
            count if count == probe.nodes.len() => (
                "the probe is on a group without a node of a body",
                "a group of a body or of its surface",
            ),
            _ => continue,
        };
        let given = context.case.probe.get(&probe.name);
        let on = given.and_then(|given| given.on.as_ref());
        let key = if on.is_some() { "on" } else { "at" };
        let path = format!("probe.{}.{key}", probe.name);
        let problem = Problem::new(path, message).accepted([accepted]);
        problems.push(match on {
            Some(on) if accepted.ends_with("surface") => problem.found(on),
            _ => problem,
        });
    }
}

/// The node of a body that is nearest to a place; the first of equals.
fn nearest_node(mesh: &Mesh, bodies: &[ModelBody], at: &[f64; 3]) -> Option<u32> {
    let cells = bodies.iter().flat_map(|body| &body.spec.cells);
    let nodes = cells.flat_map(|cell| mesh.element_nodes(*cell).iter().copied());
    let distance = |node: &u32| squared(&mesh.nodes[*node as usize], at);
    nodes.min_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)))
}

/// The cell of a body whose middle is nearest to a place; the first of equals.
fn nearest_cell<'a>(
    mesh: &Mesh,
    bodies: impl Iterator<Item = &'a ModelBody>,
    at: &[f64; 3],
) -> Option<ElementId> {
    let distance = |cell: &ElementId| {
        let nodes = mesh.element_nodes(*cell);
        let share = 1.0 / nodes.len() as f64;
        let middle = nodes.iter().fold([0.0; 3], |sum, node| {
            let x = mesh.nodes[*node as usize];
            [0, 1, 2].map(|i| sum[i] + share * x[i])
        });
        squared(&middle, at)
    };
    let cells = bodies.flat_map(|body| body.spec.cells.iter().copied());
    cells.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// The node of a cell of a beam that is nearest to a place; the first of equals.
fn end(mesh: &Mesh, cell: ElementId, at: &[f64; 3]) -> usize {
    let nodes = mesh.element_nodes(cell);
    let [first, second] = [0, 1].map(|k| squared(&mesh.nodes[nodes[k] as usize], at));
    usize::from(second < first)
}

fn squared(x: &[f64; 3], y: &[f64; 3]) -> f64 {
    (0..3).map(|i| (x[i] - y[i]).powi(2)).sum()
}

/// The nodes of a group, each with ∫ N_a dΩ over the group: with these weights the mean of the nodes is that of the field over the
/// length, area or volume, in axisymmetry over the full turn. Points count alike.
fn shares(mesh: &Mesh, group: &Group, axisymmetric: bool) -> Vec<(u32, f64)> {
    let turned = integrals(mesh, group, &|x| match axisymmetric {
        true => TAU * x[0],
        false => 1.0,
    });
    // a group on the axis turns over no area: its mean is that along the axis
    match turned.values().sum::<f64>() > 0.0 {
        true => turned.into_iter().collect(),
        false => integrals(mesh, group, &|_| 1.0).into_iter().collect(),
    }
}

/// ∫ N_a `unit` dΩ of each node of a group.
pub(super) fn integrals(
    mesh: &Mesh,
    group: &Group,
    unit: &dyn Fn(&[f64; 3]) -> f64,
) -> BTreeMap<u32, f64> {
    let mut shares = BTreeMap::new();
    let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    for &element in &group.elements {
        let table = mesh.kind(element).table();
        let nodes = mesh.element_nodes(element);
        let x: Vec<[f64; 3]> = nodes.iter().map(|&a| mesh.nodes[a as usize]).collect();
        let (n, dn) = (&mut n[..table.nodes], &mut dn[..table.nodes]);
        for (xi, weight) in table.mass_rule.points.iter().zip(table.mass_rule.weights) {
            (table.shape)(xi, n);
            (table.gradient)(xi, dn);
            let measure = match table.dim {
                3 => map::jacobian(&x, dn, 3).1.abs(),
                dim => map::measure(&x, dn, dim).0,
            };
            let part = weight * measure * unit(&map::point(&x, n));
            for (&node, n) in nodes.iter().zip(&*n) {
                *shares.entry(node).or_insert(0.0) += n * part;
            }
        }
    }
    shares
}
