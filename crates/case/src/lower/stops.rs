//! Stops: contacts of one point between two nodes, or a node and the ground.

use carom_contact::law::{CurvePoint, Defaults, GivenStop, Side};
use carom_contact::{Initial, Law, Obstacle, Plane, Sliding};
use carom_dynamics::{ModelBody, ModelContact, ModelDiscrete, ModelTarget};
use carom_mesh::{ElementId, Mesh, Surface};

use super::context::Context;
use super::discrete::{self, End};
use super::laws::{default_capture, no_curve};
use super::problems::Problems;
use super::{lookup, obstacles};
use crate::error::Problem;
use crate::schema::{Force, Length, Scheme, Stop};

/// What a stop joins.
struct Facing {
    /// The node of its first end, if it is one.
    nodes: Vec<u32>,
    other: Other,
    /// From the first end to the second one; zero where an obstacle has its own normals.
    axis: [f64; 3],
    radii: [f64; 2],
    initial: Initial,
    sliding: Sliding,
}

/// The second end.
enum Other {
    Node(u32),
    Obstacle(Obstacle),
}

/// Part of the distance between two ends that counts as rounding.
const ROUNDING: f64 = 1e-9;

/// The stops. A node may have several.
pub(super) fn lower(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    discrete: &[ModelDiscrete],
    problems: &mut Problems,
) -> Vec<ModelContact> {
    let owner = |node: u32| owner(mesh, bodies, discrete, node);
    let stops = context.case.stop.iter();
    let stops = stops.map(|(name, given)| stop(context, mesh, (name, given), &owner, problems));
    stops.flatten().collect()
}

/// One stop. `owner`: a cell with a node.
fn stop(
    context: &Context,
    mesh: &Mesh,
    (name, given): (&str, &Stop),
    owner: &dyn Fn(u32) -> Option<ElementId>,
    problems: &mut Problems,
) -> Option<ModelContact> {
    let path = format!("stop.{name}");
    if context.case.contact.get(name).is_some() {
        let problem = Problem::new(&path, "a contact has this name").found(name);
        return problems.refuse(problem.accepted(["another name"]));
    }
    let ends = discrete::ends(mesh, &path, &given.ends, problems);
    let radii = radii(&path, given, ends.as_ref(), problems);
    let facing =
        ends.and_then(|ends| facing(context, mesh, (&path, given), (ends, radii), problems));
    let law = stop_law(&path, given, &context.case.time.scheme(), problems);
    let (facing, law) = (facing?, law?);
    let owned = |nodes: &[u32], axis: [f64; 3], radius: f64| {
        let owned = |&node: &u32| Some((node, owner(node)?));
        let points: Option<Vec<(u32, ElementId)>> = nodes.iter().map(owned).collect();
        let mut surface = Surface::of_points(&points?, axis);
        for face in &mut surface.faces {
            face.radius = Some(radius);
        }
        Some(surface)
    };
    let nodes = &facing.nodes;
    let secondary = owned(nodes, facing.axis, facing.radii[0]).filter(|_| nodes.len() == 1);
    let primary = match facing.other {
        Other::Node(other) => {
            owned(&[other], facing.axis.map(|n| -n), facing.radii[1]).map(ModelTarget::Surface)
        }
        Other::Obstacle(obstacle) => Some(ModelTarget::Rigid(obstacle)),
    };
    let (Some(secondary), Some(primary)) = (secondary, primary) else {
        let message = "an end of the stop is not one node with a mass";
        let problem = Problem::new(format!("{path}.ends"), message);
        let accepted = "nodes of bodies or of masses, one at each end, or `ground`";
        return problems.refuse(problem.accepted([accepted]));
    };
    Some(ModelContact {
        initial: facing.initial,
        sliding: facing.sliding,
        friction: given.friction.unwrap_or_default(),
        ..ModelContact::new(name, secondary, primary, law)
    })
}

/// What faces what: along an axis from places of the mesh, or the shape of an obstacle.
fn facing(
    context: &Context,
    mesh: &Mesh,
    (path, stop): (&str, &Stop),
    (ends, radii): ([End; 2], [f64; 2]),
    problems: &mut Problems,
) -> Option<Facing> {
    let gap = stop.gap.map_or(0.0, |gap| gap.0);
    if let Some(obstacle) = &stop.obstacle {
        let (nodes, radius) = match ends {
            [End::Nodes(nodes), End::Ground] => (nodes, radii[0]),
            [End::Ground, End::Nodes(nodes)] => (nodes, radii[1]),
            _ => {
                let message = "an obstacle is the place and shape of the ground";
                let problem = Problem::new(format!("{path}.ends"), message);
                let accepted = "a group of one node and `ground`";
                return problems.refuse(problem.accepted([accepted]));
            }
        };
        return Some(Facing {
            nodes,
            other: Other::Obstacle(obstacles::obstacle(
                context, mesh, path, obstacle, problems,
            )?),
            axis: [0.0; 3],
            radii: [radius, 0.0],
            initial: Initial::Further(gap),
            sliding: Sliding::Finite,
        });
    }
    let axis = lookup::normal(mesh, &format!("{path}.axis"), stop.axis.as_ref()?, problems)?;
    let (nodes, other, axis, radii) = match ends {
        [End::Nodes(one), End::Nodes(other)] => (one, other.first().copied(), axis, radii),
        [End::Nodes(one), End::Ground] => (one, None, axis, radii),
        [End::Ground, End::Nodes(one)] => (one, None, axis.map(|n| -n), [radii[1], 0.0]),
        [End::Ground, End::Ground] => return None,
    };
    let place = mesh.nodes[*nodes.first()? as usize];
    let other = match other {
        Some(other) => {
            let reach = gap + radii[0] + radii[1];
            let places = [place, mesh.nodes[other as usize]];
            face_each_other(path, places, axis, reach, problems);
            Other::Node(other)
        }
        None => Other::Obstacle(
            Plane {
                point: place,
                normal: axis.map(|n| -n),
            }
            .into(),
        ),
    };
    Some(Facing {
        nodes,
        other,
        axis,
        radii,
        initial: Initial::Gap(gap),
        sliding: Sliding::Small,
    })
}

/// The radii of the sections of the two ends, m. The ground has none.
fn radii(path: &str, stop: &Stop, ends: Option<&[End; 2]>, problems: &mut Problems) -> [f64; 2] {
    let given = stop.radius.as_deref().unwrap_or_default();
    let radii = [0, 1].map(|k| given.get(k).map_or(0.0, |radius| radius.0));
    for (k, end) in ends.into_iter().flatten().enumerate() {
        if matches!(end, End::Ground) && radii[k] != 0.0 {
            let path = format!("{path}.radius[{k}]");
            let problem = Problem::new(path, "the ground does not turn: it has no radius");
            let problem = problem.found(format!("{} m", radii[k]));
            problems.push(problem.accepted(["0 m"]));
        }
    }
    radii
}

/// Refuses ends that the axis does not lead from one to the other. Ends no further apart than the stop's reach are one inside the
/// other, as a rod in its hole: any axis leads from one to the other there.
fn face_each_other(
    path: &str,
    [one, other]: [[f64; 3]; 2],
    axis: [f64; 3],
    reach: f64,
    problems: &mut Problems,
) {
    let way = [0, 1, 2].map(|i| other[i] - one[i]);
    let along: f64 = (0..3).map(|i| way[i] * axis[i]).sum();
    let distance = way.iter().map(|w| w * w).sum::<f64>().sqrt();
    let sideways = (distance * distance - along * along).max(0.0).sqrt();
    let size = one
        .iter()
        .chain(&other)
        .fold(0.0_f64, |a, x| a.max(x.abs()));
    if distance <= reach + ROUNDING * size || along >= sideways * (1.0 - ROUNDING) {
        return;
    }
    let message = "the ends do not face each other along the axis";
    let found = format!(
        "from the first end to the second one it is {along:.4e} m along the axis and {sideways:.4e} m across it"
    );
    problems.push(
        Problem::new(format!("{path}.axis"), message)
            .found(found)
            .accepted([
                "an axis from the first end towards the second one, within 45 degrees",
                "ends no further apart than gap and radii",
            ]),
    );
}

/// The law of a stop; nothing of it has a default from the sides. `scheme`: that of the case.
fn stop_law(path: &str, stop: &Stop, scheme: &Scheme, problems: &mut Problems) -> Option<Law> {
    let defaults = Defaults {
        capture: default_capture(scheme),
        softer: Side::default(),
    };
    let (law, at) = match &stop.law {
        Some(given) => (given.law(&defaults), format!("{path}.law.stop")),
        None => (
            own_law(stop)?.law(&defaults).map(Law::Stop),
            path.to_owned(),
        ),
    };
    match law {
        Ok(law) => discrete::acts_at_a_point(path, &law, problems).then_some(law),
        Err(error) => problems.refuse(no_curve(&at, &error)),
    }
}

/// The spring and the dashpot of a stop.
fn own_law(stop: &Stop) -> Option<GivenStop> {
    let curve = match (stop.stiffness, &stop.curve) {
        // a line: one metre, and its force
        (Some(stiffness), _) => vec![CurvePoint {
            penetration: Length(1.0),
            force: Force(stiffness.0),
        }],
        (None, Some(points)) => points.clone(),
        (None, None) => return None,
    };
    Some(GivenStop {
        clearance: None,
        curve,
        crush: stop.crush,
        damping: stop.damping,
        adhesion: stop.adhesion,
    })
}

/// A cell with a node, of a body or else of a mass.
fn owner(
    mesh: &Mesh,
    bodies: &[ModelBody],
    discrete: &[ModelDiscrete],
    node: u32,
) -> Option<ElementId> {
    let solids = bodies.iter().map(|body| &body.spec.cells);
    let masses = discrete
        .iter()
        .filter(|some| matches!(some.spec.kind, carom_bodies::DiscreteKind::Mass(_)));
    let masses = masses.map(|some| &some.spec.cells);
    let has = |cell: &&ElementId| mesh.element_nodes(**cell).contains(&node);
    solids.chain(masses).flatten().find(has).copied()
}
