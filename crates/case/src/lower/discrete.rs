//! Point masses, springs and dashpots, at nodes of the mesh or at nodes of their own.

use carom_bodies::{self as bodies, Curve, CurveError, DiscreteKind, DiscreteSpec, Link};
use carom_contact::Law;
use carom_dynamics::ModelDiscrete;
use carom_elements::Kind;
use carom_mesh::{ElementId, Group, Mesh, Surface};

use super::context::Context;
use super::problems::{Problems, plural};
use super::{lookup, rigid};
use crate::error::Problem;
use crate::schema::{Dashpot, Ends, NormalVector, PointMass, Spring};

/// The end that does not move.
const GROUND: &str = "ground";

/// An end of a discrete element.
pub(super) enum End {
    /// What does not move.
    Ground,
    /// Nodes of the mesh.
    Nodes(Vec<u32>),
}

/// A mesh without nodes for a case of point masses alone; its dimension is that of the place of the first one.
pub(super) fn empty_mesh(context: &Context) -> Option<Mesh> {
    let mut places = context
        .case
        .mass
        .iter()
        .filter_map(|(_, mass)| mass.at.as_ref());
    places.next().map(|at| Mesh::new(at.given()))
}

/// Gives each mass with a place its node, and the mesh a group of the name of the mass.
pub(super) fn own_nodes(context: &Context, mesh: &mut Mesh, problems: &mut Problems) {
    for (name, mass) in context.case.mass.iter() {
        let Some(at) = &mass.at else { continue };
        let path = format!("mass.{name}");
        let place = problems.vector(mesh, &format!("{path}.at"), at);
        if mesh.groups.contains_key(name) || name == GROUND {
            let message = match name {
                GROUND => "this name is that of the end that does not move",
                _ => "a group of the mesh has this name",
            };
            let problem = Problem::new(path, message).found(name);
            problems.push(problem.accepted(["another name"]));
            continue;
        }
        let node = mesh.nodes.len() as u32;
        mesh.nodes.push(place);
        let cell = mesh.push(Kind::Point1, &[node]);
        mesh.groups
            .insert(name.to_owned(), Group::new(0, vec![cell]));
    }
}

/// Masses, springs and dashpots; their cells are added to the mesh.
pub(super) fn lower(
    context: &Context,
    mesh: &mut Mesh,
    problems: &mut Problems,
) -> Vec<ModelDiscrete> {
    let case = context.case;
    let mut discrete = Vec::new();
    for (name, given) in case.mass.iter() {
        discrete.extend(mass(mesh, name, given, problems));
    }
    for (name, given) in case.spring.iter() {
        discrete.extend(spring(mesh, name, given, problems));
    }
    for (name, given) in case.dashpot.iter() {
        discrete.extend(dashpot(mesh, name, given, problems));
    }
    discrete
}

fn spring(
    mesh: &mut Mesh,
    name: &str,
    given: &Spring,
    problems: &mut Problems,
) -> Option<ModelDiscrete> {
    let path = format!("spring.{name}");
    let curve = match (&given.stiffness, &given.curve) {
        (Some(stiffness), _) => Some(Curve::line(stiffness.0)),
        (None, Some(points)) => {
            let points = points.iter().map(|p| [p.elongation.0, p.force.0]);
            curve(&path, points.collect(), problems)
        }
        (None, None) => None,
    };
    let cells = linked(mesh, &path, &given.ends, given.axis.as_ref(), problems);
    Some(link(name, curve?, cells?, DiscreteKind::Spring))
}

fn dashpot(
    mesh: &mut Mesh,
    name: &str,
    given: &Dashpot,
    problems: &mut Problems,
) -> Option<ModelDiscrete> {
    let path = format!("dashpot.{name}");
    let curve = match (&given.damping, &given.curve) {
        (Some(damping), _) => Some(Curve::line(damping.0)),
        (None, Some(points)) => {
            let points = points.iter().map(|p| [p.rate.0, p.force.0]);
            let curve = curve(&path, points.collect(), problems);
            curve.filter(|curve| dissipates(&path, curve, problems))
        }
        (None, None) => None,
    };
    let cells = linked(mesh, &path, &given.ends, given.axis.as_ref(), problems);
    Some(link(name, curve?, cells?, DiscreteKind::Dashpot))
}

fn mass(
    mesh: &mut Mesh,
    name: &str,
    mass: &PointMass,
    problems: &mut Problems,
) -> Option<ModelDiscrete> {
    let path = format!("mass.{name}");
    let cells = match &mass.on {
        None => mesh.groups.get(name)?.elements.clone(),
        Some(on) => {
            let group = problems.group(mesh, &format!("{path}.on"), on)?;
            let nodes = mesh.group_nodes(group);
            let point = |node: u32| mesh.push(Kind::Point1, &[node]);
            nodes.into_iter().map(point).collect()
        }
    };
    let inertia = match &mass.inertia {
        None => [0.0; 3],
        Some(moments) => rigid::moments(mesh.dim, &format!("{path}.inertia"), moments, problems)?,
    };
    let point = bodies::PointMass {
        mass: mass.mass.0,
        inertia,
    };
    let mut made = model(name, cells, DiscreteKind::Mass(point));
    // a node of its own is at rest where nothing else is said
    let rest = mass.at.as_ref().map(|_| [0.0; 3]);
    (made.velocity, made.displacement) = (rest, rest);
    if let Some(initial) = &mass.initial {
        let path = format!("{path}.initial");
        if let Some(vector) = &initial.velocity {
            made.velocity = Some(problems.vector(mesh, &format!("{path}.velocity"), vector));
        }
        if let Some(vector) = &initial.displacement {
            let displacement = problems.vector(mesh, &format!("{path}.displacement"), vector);
            made.displacement = Some(displacement);
        }
    }
    Some(made)
}

/// The cells between two ends, and the axis from the node to the ground or from the first node to the second.
pub(super) fn linked(
    mesh: &mut Mesh,
    path: &str,
    names: &Ends,
    axis: Option<&NormalVector>,
    problems: &mut Problems,
) -> Option<(Vec<ElementId>, Option<[f64; 3]>)> {
    let axis = match axis {
        Some(axis) => Some(lookup::normal(
            mesh,
            &format!("{path}.axis"),
            axis,
            problems,
        )?),
        None => None,
    };
    let back = || axis.map(|axis| axis.map(|n| -n));
    match ends(mesh, path, names, problems)? {
        [End::Ground, End::Nodes(nodes)] => Some((points(mesh, &nodes), back())),
        [End::Nodes(nodes), End::Ground] => Some((points(mesh, &nodes), axis)),
        [End::Nodes(one), End::Nodes(other)] => {
            Some((vec![mesh.push(Kind::Bar2, &[one[0], other[0]])], axis))
        }
        [End::Ground, End::Ground] => None,
    }
}

/// The nodes of two ends: one each, or any number against the ground.
pub(super) fn ends(
    mesh: &Mesh,
    path: &str,
    names: &Ends,
    problems: &mut Problems,
) -> Option<[End; 2]> {
    let path = format!("{path}.ends");
    let mut end = |k: usize| match names[k].as_str() {
        GROUND => Some(End::Ground),
        name => {
            let group = problems.group(mesh, &format!("{path}[{k}]"), name)?;
            Some(End::Nodes(mesh.group_nodes(group)))
        }
    };
    let found = [end(0)?, end(1)?];
    let (message, accepted) = match &found {
        [End::Ground, End::Ground] => ("both ends are the ground", "one node at least"),
        [End::Nodes(one), End::Nodes(other)] if one.len() > 1 || other.len() > 1 => (
            "between two groups of nodes each must have one node",
            "groups of one node, or a group and `ground`",
        ),
        [End::Nodes(one), End::Nodes(other)] if one == other => {
            ("both ends are the same node", "two nodes")
        }
        _ => return Some(found),
    };
    let count = |end: &End| match end {
        End::Ground => "the ground".to_owned(),
        End::Nodes(nodes) => plural(nodes.len(), "node"),
    };
    let problem = Problem::new(path, message);
    let [one, other] = &found;
    let problem = problem.found(format!("{} and {}", count(one), count(other)));
    problems.refuse(problem.accepted([accepted]))
}

fn curve(path: &str, points: Vec<[f64; 2]>, problems: &mut Problems) -> Option<Curve> {
    let error = match Curve::new(points) {
        Ok(curve) => return Some(curve),
        Err(error) => error,
    };
    let path = format!("{path}.curve");
    problems.refuse(match error {
        CurveError::NotAscending {
            point,
            found,
            before,
        } => Problem::new(format!("{path}[{}]", point - 1), "the points must ascend")
            .found(format!("{found}"))
            .accepted([format!("more than {before}")]),
        other => Problem::new(path, other.to_string()),
    })
}

/// Whether a dashpot never gives energy: force and rate have the same sign, and none is without the other.
fn dissipates(path: &str, curve: &Curve, problems: &mut Problems) -> bool {
    let against = |[rate, force]: &[f64; 2]| rate * force < 0.0;
    let message = match curve.points().iter().position(against) {
        Some(k) => Some((
            format!("{path}.curve[{k}]"),
            "a dashpot that pulls where it is compressed gives energy",
        )),
        None if curve.value(0.0) != 0.0 => Some((
            format!("{path}.curve"),
            "a dashpot without rate has no force: the curve must go through (0, 0)",
        )),
        None => None,
    };
    let sound = message.is_none();
    if let Some((path, message)) = message {
        let problem = Problem::new(path, message);
        problems.push(problem.accepted(["forces of the sign of their rates"]));
    }
    sound
}

/// The surface of a mass with a node of its own, if `name` is one.
pub(super) fn mass_surface(context: &Context, mesh: &Mesh, name: &str) -> Option<Surface> {
    context
        .case
        .mass
        .get(name)
        .filter(|mass| mass.at.is_some())?;
    let group = mesh.groups.get(name)?;
    let point = |&cell: &ElementId| (mesh.element_nodes(cell)[0], cell);
    let points: Vec<_> = group.elements.iter().map(point).collect();
    Some(Surface::of_points(&points, [0.0; 3]))
}

/// Refuses, of a contact of a point mass, a law per area.
pub(super) fn acts_at_a_point(path: &str, law: &Law, problems: &mut Problems) -> bool {
    let per_area = matches!(law, Law::Damped(_) | Law::Penalty(_) | Law::Compliance(_));
    if per_area {
        let message = "the law is per area, and a point mass has none";
        let problem = Problem::new(format!("{path}.law"), message).found(law.get().name());
        problems.push(problem.accepted([
            "law.displacement",
            "law.velocity",
            "law.restitution",
            "law.hertz",
            "law.hunt-crossley",
            "law.stop",
        ]));
    }
    !per_area
}

/// What joins the ends in these cells, along an axis if there is one.
fn link(
    name: &str,
    curve: Curve,
    (cells, axis): (Vec<ElementId>, Option<[f64; 3]>),
    kind: fn(Link) -> DiscreteKind,
) -> ModelDiscrete {
    model(name, cells, kind(Link { curve, axis }))
}

fn model(name: &str, cells: Vec<ElementId>, kind: DiscreteKind) -> ModelDiscrete {
    ModelDiscrete::new(DiscreteSpec {
        name: name.to_owned(),
        cells,
        kind,
    })
}

fn points(mesh: &mut Mesh, nodes: &[u32]) -> Vec<ElementId> {
    let point = |&node: &u32| mesh.push(Kind::Point1, &[node]);
    nodes.iter().map(point).collect()
}
