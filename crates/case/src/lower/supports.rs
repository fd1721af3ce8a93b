//! Supports: nodes held, and nodes that move as prescribed.

use std::collections::BTreeMap;

use carom_dynamics::{Amplitude, NamedSupport, Prescribed, PrescribedTurn, Support};
use carom_mesh::Mesh;

use super::context::Context;
use super::lookup::{self, AXES};
use super::problems::Problems;
use super::signals::{self, Follower};
use super::{beams, course};
use crate::error::Problem;
use crate::schema::{Axis, Case, Movement, MovementCourse};

/// What supports hold and move.
#[derive(Default)]
pub(super) struct Supports {
    pub(super) supports: Vec<Support>,
    pub(super) motions: Vec<Prescribed>,
    /// Prescribed rotations.
    pub(super) turns: Vec<PrescribedTurn>,
}

/// What the supports of a case hold or move.
pub(super) fn named(case: &Case, mesh: &Mesh) -> Vec<NamedSupport> {
    let named = case.support.iter().filter_map(|(name, support)| {
        let nodes = mesh.group_nodes(mesh.groups.get(&support.on)?);
        let [mut axes, mut rotations] = fixed(&support.fix);
        if let Some(motion) = &support.motion {
            let moved = [&motion.x, &motion.y, &motion.z].map(|points| points.is_some());
            let turned = [&motion.rx, &motion.ry, &motion.rz].map(|points| points.is_some());
            (0..3).for_each(|i| axes[i] |= moved[i]);
            (0..3).for_each(|i| rotations[i] |= turned[i]);
        }
        Some(NamedSupport {
            name: name.to_owned(),
            nodes,
            axes,
            rotations,
        })
    });
    named.collect()
}

/// Translations and rotations among some axes.
fn fixed(axes: &[Axis]) -> [[bool; 3]; 2] {
    let mut fixed = [[false; 3]; 2];
    for (axis, turns) in axes.iter().map(|axis| axis.index()) {
        fixed[usize::from(turns)][axis] = true;
    }
    fixed
}

/// Names of the supports that move, or hold, a node in a direction.
type Directions<'a> = BTreeMap<(u32, usize), &'a str>;

/// Supports and prescribed motions; no node is held or moved twice in one direction where one of both is a motion.
pub(super) fn lower(context: &Context, mesh: &Mesh, problems: &mut Problems) -> Supports {
    let mut all = Supports::default();
    let (mut moved, mut held) = (Directions::new(), Directions::new());
    for (name, support) in context.case.support.iter() {
        let path = format!("support.{name}");
        for (k, axis) in support.fix.iter().enumerate() {
            let (axis, turns) = axis.index();
            let path = format!("{path}.fix[{k}]");
            match turns {
                true => check_turn(context, mesh, &path, (axis, &support.on), problems),
                false => lookup::within(mesh, &path, axis, problems),
            }
        }
        let Some(group) = problems.group(mesh, &format!("{path}.on"), &support.on) else {
            continue;
        };
        let nodes = mesh.group_nodes(group);
        let [fix, fix_rotations] = fixed(&support.fix);
        let own = Supported {
            name,
            path: &path,
            on: &support.on,
            nodes: &nodes,
        };
        whole_if_rigid(context, mesh, &own, problems);
        for axis in (0..3).filter(|&axis| fix[axis]) {
            held.extend(nodes.iter().map(|&node| ((node, axis), name)));
        }
        if let Some(given) = &support.motion {
            let displacement = motion(context, mesh, (&own, given), &mut moved, problems);
            all.turns
                .extend(turns(context, mesh, &own, given, problems));
            all.motions.push(Prescribed {
                nodes: nodes.clone(),
                displacement,
            });
        }
        all.supports.push(Support {
            nodes,
            fix,
            fix_rotations,
        });
    }
    not_held(&moved, &held, problems);
    all
}

/// A support with its nodes.
struct Supported<'n, 'a> {
    name: &'a str,
    path: &'n str,
    /// Its group.
    on: &'n str,
    nodes: &'n [u32],
}

/// The displacements of a support that moves; enters them in those of all.
fn motion<'a>(
    context: &Context,
    mesh: &Mesh,
    (own, given): (&Supported<'_, 'a>, &Movement),
    moved: &mut Directions<'a>,
    problems: &mut Problems,
) -> [Option<Amplitude>; 3] {
    let mut displacement = [None, None, None];
    let given = [&given.x, &given.y, &given.z];
    for (axis, course) in given.into_iter().enumerate() {
        let Some(course) = course else { continue };
        let path = format!("{}.move.{}", own.path, AXES[axis]);
        lookup::within(mesh, &path, axis, problems);
        once(&path, own.nodes, axis, moved, problems);
        moved.extend(own.nodes.iter().map(|&node| ((node, axis), own.name)));
        displacement[axis] = movement(context, &path, course, problems);
        warn_of_a_jump(context, &path, displacement[axis].as_ref(), problems);
    }
    displacement
}

/// The rotations of a support that turns.
fn turns(
    context: &Context,
    mesh: &Mesh,
    own: &Supported,
    given: &Movement,
    problems: &mut Problems,
) -> Vec<PrescribedTurn> {
    let mut turns = Vec::new();
    let given = [&given.rx, &given.ry, &given.rz];
    for (axis, points) in given.into_iter().enumerate() {
        let Some(points) = points else { continue };
        let path = format!("{}.move.r{}", own.path, AXES[axis]);
        check_turn(context, mesh, &path, (axis, own.on), problems);
        let points = points.iter().map(|point| [point.time.0, point.angle.0]);
        let Some(angle) = course::amplitude(&path, points.collect(), problems) else {
            continue;
        };
        // a rigid body has one rotation, beams one at each node
        let nodes = match are_of_beams(context, mesh, own.nodes) {
            true => own.nodes,
            false => &own.nodes[..1],
        };
        turns.extend(nodes.iter().map(|&node| PrescribedTurn {
            node,
            axis,
            angle: angle.clone(),
        }));
    }
    turns
}

/// Whether all these nodes are nodes of beams or shells.
fn are_of_beams(context: &Context, mesh: &Mesh, nodes: &[u32]) -> bool {
    let beams = beams::nodes_with_rotations(context, mesh);
    nodes.iter().all(|node| beams.binary_search(node).is_ok())
}

/// Refuses a rotation of what has none: rigid bodies and nodes of beams turn.
fn check_turn(
    context: &Context,
    mesh: &Mesh,
    path: &str,
    (axis, on): (usize, &str),
    problems: &mut Problems,
) {
    let mut bodies = context.case.body.iter();
    let rigid = bodies.any(|(_, body)| body.region == on && body.rigid.is_some());
    let group = mesh.groups.get(on);
    let beams = group.is_some_and(|group| are_of_beams(context, mesh, &mesh.group_nodes(group)));
    let (message, accepted) = match (rigid || beams, mesh.dim) {
        (false, _) => (
            "nodes of a body that deforms have no rotations, except those of beams and shells",
            "the region of a rigid body, or nodes of beams or shells",
        ),
        (true, 3) => return,
        (true, 2) if axis == 2 => return,
        (true, 2) => ("in the plane a body turns about z only", "rz"),
        (true, _) => ("on a line nothing turns", "x"),
    };
    let problem = Problem::new(path, message).found(on.to_string());
    problems.push(problem.accepted([accepted]));
}

/// Refuses a part of a rigid body: it is held or moved as a whole.
fn whole_if_rigid(context: &Context, mesh: &Mesh, own: &Supported, problems: &mut Problems) {
    let regions: Vec<(String, bool)> = context
        .case
        .body
        .iter()
        .filter(|(_, body)| body.rigid.is_some() && body.region != own.on)
        .filter_map(|(_, body)| {
            let group = mesh.groups.get(&body.region)?;
            let nodes = mesh.group_nodes(group);
            let shares = own
                .nodes
                .iter()
                .any(|node| nodes.binary_search(node).is_ok());
            Some((body.region.clone(), shares))
        })
        .collect();
    for (region, _) in regions.iter().filter(|(_, shares)| *shares) {
        let message = "a rigid body is held or moved as a whole";
        let problem = Problem::new(format!("{}.on", own.path), message).found(own.on);
        problems.push(problem.accepted([format!("its region, `{region}`")]));
    }
}

/// Refuses a motion of nodes that move already.
fn once(path: &str, nodes: &[u32], axis: usize, moved: &Directions, problems: &mut Problems) {
    let mut twice = nodes.iter().filter_map(|&node| {
        let name = moved.get(&(node, axis))?;
        Some((node, *name))
    });
    if let Some((node, other)) = twice.next() {
        problems.push(clash(path, node, "moves", other));
    }
}

/// Refuses motions of nodes that are held.
fn not_held(moved: &Directions, held: &Directions, problems: &mut Problems) {
    let mut told = Vec::new();
    for (&(node, axis), name) in moved {
        let Some(other) = held.get(&(node, axis)) else {
            continue;
        };
        let path = format!("support.{name}.move.{}", AXES[axis]);
        if !told.contains(&path) {
            problems.push(clash(&path, node, "holds", other));
            told.push(path);
        }
    }
}

/// Warns of a prescribed displacement that is not zero at the start: its nodes jump in the first step. A static stage takes
/// it as any other load.
fn warn_of_a_jump(
    context: &Context,
    path: &str,
    motion: Option<&Amplitude>,
    problems: &mut Problems,
) {
    let start = motion.map_or(0.0, |motion| motion.at(0.0));
    if start != 0.0 && context.case.time.stage.is_none() {
        problems.doubt(format!(
            "{path}: the displacement is {start:.4e} m at time 0: the nodes jump there in the first step, which is a shock to the body; begin with displacement = 0 at time = 0"
        ));
    }
}

fn movement(
    context: &Context,
    path: &str,
    course: &MovementCourse,
    problems: &mut Problems,
) -> Option<Amplitude> {
    match course {
        MovementCourse::Signal(name) => {
            signals::followed(context, path, name, Follower::Displacement, problems)
        }
        MovementCourse::Points(points) => {
            let points = points.iter();
            let points = points.map(|point| [point.time.0, point.displacement.0]);
            course::amplitude(path, points.collect(), problems)
        }
    }
}

fn clash(path: &str, node: u32, verb: &str, other: &str) -> Problem {
    let message = format!("the support `{other}` {verb} node {node} in this direction already");
    Problem::new(path, message).accepted(["one support for each node and direction"])
}
