//! Ends of beams and edges of shells on faces of solids, and surfaces on each other.

use carom_arlequin::{EdgeCell, Rows, edge_mean_motion, edge_rigid_motion, mean_motion};
use carom_bodies::{Kinematics, ShellPlate, plates};
use carom_dynamics::{ModelBody, ModelConstraint, ModelLink};
use carom_elements::Kind;
use carom_mesh::{ElementId, Mesh, Surface};

use super::context::Context;
use super::problems::Problems;
use super::turning::{SMALL_TURNS, any_angle};
use super::{beams, lookup, tied};
use crate::error::Problem;
use crate::schema::TransitionMotion;

/// An end on a face, as a case gives it.
struct Given<'a> {
    name: &'a str,
    path: &'a str,
    end: &'a str,
    face: &'a str,
    motion: TransitionMotion,
}

impl Given<'_> {
    fn path_of(&self, key: &str) -> String {
        format!("{}.{key}", self.path)
    }
}

/// What the transitions of a case come to.
pub(super) struct Transitions {
    pub(super) constraints: Vec<ModelConstraint>,
    /// Links of ends and faces that turn by any angle.
    pub(super) links: Vec<ModelLink>,
}

/// The constraints between ends of beams or edges of shells and faces, and the links of those that turn by any angle.
pub(super) fn lower(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    problems: &mut Problems,
) -> Transitions {
    let turning = beams::nodes_with_rotations(context, mesh);
    let cells = bodies.iter().flat_map(|body| body.spec.cells.iter());
    let fills = |cell: &ElementId| mesh.kind(*cell).table().dim == mesh.dim;
    let sides: Vec<ElementId> = cells.copied().filter(fills).collect();
    let (mut constraints, mut links) = (Vec::new(), Vec::new());
    for (name, given) in context.case.transition.iter() {
        let path = format!("transition.{name}");
        if let Some(surfaces) = &given.surfaces {
            let of = (name, &path[..]);
            let tied = tied::lower((mesh, bodies), of, surfaces, &sides, problems);
            constraints.extend(tied);
        }
        let (Some(end), Some(face)) = (&given.end, &given.face) else {
            continue;
        };
        let given = &Given {
            name,
            path: &path,
            end,
            face,
            motion: given.motion.unwrap_or_default(),
        };
        let face = lookup::surface(mesh, &sides, &given.path_of("face"), given.face, problems);
        if both_turn(mesh, bodies, given, face.as_ref()) {
            links.extend(end_turns_on(context, (mesh, bodies), given, face, problems));
        } else if !turns_by_any_angle(mesh, bodies, given, face.as_ref(), problems) {
            constraints.extend(match is_edge(mesh, given.end) {
                true => edge_on(mesh, bodies, given, face, problems),
                false => end_on(mesh, &turning, given, face, problems),
            });
        }
    }
    let inside = |link: &&ModelLink| link.zones[0] == link.zones[1];
    let names = constraints.iter().map(|one| &one.name);
    let mut names = names.chain(links.iter().filter(inside).map(|one| &one.name));
    if let (Some(first), false) = (names.next(), context.plan.zones.is_empty()) {
        let message = "in zones a transition joins a beam with finite rotations and a solid at finite strain of two zones";
        let problem = Problem::new(format!("transition.{first}"), message);
        problems.push(problem.accepted([
            "a case without zones",
            "[arlequin.<name>] between the two bodies",
        ]));
    }
    Transitions { constraints, links }
}

/// Whether the end of a beam and the face that has its motion in the mean both turn by any angle.
fn both_turn(mesh: &Mesh, bodies: &[ModelBody], given: &Given, face: Option<&Surface>) -> bool {
    let end = mesh.groups.get(given.end);
    let end = end.map_or(Vec::new(), |group| mesh.group_nodes(group));
    let face = face.map_or(&[][..], |face| &face.nodes);
    let turns = |nodes: &[u32]| any_angle(mesh, bodies, nodes).is_some();
    given.motion == TransitionMotion::Distributing
        && !is_edge(mesh, given.end)
        && turns(&end)
        && turns(face)
}

/// The end of a beam with finite rotations on a face of a solid at finite strain.
fn end_turns_on(
    context: &Context,
    (mesh, bodies): (&Mesh, &[ModelBody]),
    given: &Given,
    face: Option<Surface>,
    problems: &mut Problems,
) -> Option<ModelLink> {
    let end = lookup::single(mesh, &given.path_of("end"), given.end, problems);
    let (end, face) = (end?, face?);
    apart_from_face(&[end], &face, given, problems)?;
    let rows = mean_rows(mesh, (end, &face), given, problems)?;
    // those of the face are the inner terms
    let on_face = |cell: &ElementId| face.faces.iter().any(|face| face.parent == *cell);
    let at_end = |cell: &ElementId| mesh.element_nodes(*cell).contains(&end);
    let zone = |own: &dyn Fn(&ElementId) -> bool| {
        let body = bodies
            .iter()
            .position(|body| body.spec.cells.iter().any(own));
        body.and_then(|body| context.plan.zone_of(body))
            .unwrap_or(0)
    };
    Some(ModelLink {
        name: given.name.to_owned(),
        zones: [zone(&on_face), zone(&at_end)],
        rows: rows.rows,
    })
}

/// The rows of the mean motion of a face.
fn mean_rows(
    mesh: &Mesh,
    (end, face): (u32, &Surface),
    given: &Given,
    problems: &mut Problems,
) -> Option<Rows> {
    match mean_motion(mesh, &face.faces, end) {
        Ok(rows) => Some(rows),
        Err(error) => {
            let problem = Problem::new(given.path_of("face"), error.to_string());
            let problem = problem.found(given.face);
            problems.refuse(problem.accepted(["faces that are not on one line"]))
        }
    }
}

/// Refuses ends and faces of bodies that turn by any angle where the rows are those of small turns.
fn turns_by_any_angle(
    mesh: &Mesh,
    bodies: &[ModelBody],
    given: &Given,
    face: Option<&Surface>,
    problems: &mut Problems,
) -> bool {
    let end = mesh.groups.get(given.end);
    let end = end.map_or(Vec::new(), |group| mesh.group_nodes(group));
    let face = face.map_or(&[][..], |face| &face.nodes);
    let [of_end, of_face] = [&end[..], face].map(|nodes| any_angle(mesh, bodies, nodes));
    let (body, key, found) = match (of_end, of_face) {
        (Some(body), _) => (body, "end", given.end),
        (None, Some(body)) => (body, "face", given.face),
        (None, None) => return false,
    };
    let name = &body.spec.name;
    let message =
        format!("a transition holds for small rotations, and body '{name}' may turn by any angle");
    let problem = Problem::new(given.path_of(key), message).found(found);
    let both =
        "motion = \"distributing\", of a beam with finite rotations and a solid at finite strain";
    let accepted = SMALL_TURNS.into_iter().chain([both]);
    problems.push(problem.accepted(accepted));
    true
}

/// Whether a name is that of a group of lines.
fn is_edge(mesh: &Mesh, name: &str) -> bool {
    let lines = |cell: &ElementId| mesh.kind(*cell) == Kind::Bar2;
    let group = mesh.groups.get(name);
    mesh.dim == 3 && group.is_some_and(|group| group.elements.iter().all(lines))
}

/// The end of a beam on a face.
fn end_on(
    mesh: &Mesh,
    turning: &[u32],
    given: &Given,
    face: Option<Surface>,
    problems: &mut Problems,
) -> Option<ModelConstraint> {
    let end = lookup::single(mesh, &given.path_of("end"), given.end, problems);
    let (end, face) = (end?, face?);
    if turning.binary_search(&end).is_err() {
        let message = "the node at the end of a transition must have rotations";
        let problem = Problem::new(given.path_of("end"), message).found(given.end);
        return problems.refuse(problem.accepted(["a node of a beam"]));
    }
    apart_from_face(&[end], &face, given, problems)?;
    Some(match given.motion {
        TransitionMotion::Rigid => {
            let nodes: Vec<(u32, bool)> = face
                .nodes
                .iter()
                .map(|&node| (node, turning.binary_search(&node).is_ok()))
                .collect();
            ModelConstraint::rigid_link(given.name, mesh, end, &nodes, true)
        }
        TransitionMotion::Distributing => {
            let rows = mean_rows(mesh, (end, &face), given, problems)?;
            ModelConstraint::of_rows(given.name, &rows.rows, mesh.dim)
        }
    })
}

/// The edge of a shell on a face.
fn edge_on(
    mesh: &Mesh,
    bodies: &[ModelBody],
    given: &Given,
    face: Option<Surface>,
    problems: &mut Problems,
) -> Option<ModelConstraint> {
    let group = problems.group(mesh, &given.path_of("end"), given.end)?;
    let (lines, nodes) = (group.elements.clone(), mesh.group_nodes(group));
    let face = face?;
    apart_from_face(&nodes, &face, given, problems)?;
    let edge = edge(mesh, bodies, &lines, given, problems)?;
    let rows = match given.motion {
        TransitionMotion::Distributing => edge_mean_motion(mesh, &face.faces, &edge),
        TransitionMotion::Rigid => edge_rigid_motion(mesh, &face.faces, &edge),
    };
    match rows {
        Ok(rows) => Some(ModelConstraint::of_rows(given.name, &rows.rows, mesh.dim)),
        Err(error) => {
            let problem = Problem::new(given.path_of("face"), error.to_string());
            let accepted = "the side of a solid along the edge, as high as the shell is thick";
            problems.refuse(problem.found(given.face).accepted([accepted]))
        }
    }
}

/// Lines as pieces of the edge of a shell.
fn edge(
    mesh: &Mesh,
    bodies: &[ModelBody],
    lines: &[ElementId],
    given: &Given,
    problems: &mut Problems,
) -> Option<Vec<EdgeCell>> {
    let shells = bodies.iter().filter_map(|body| match body.spec.kinematics {
        Kinematics::Shell(section) => Some((&body.spec, section)),
        _ => None,
    });
    let mut all: Vec<(ElementId, ShellPlate)> = Vec::new();
    for (spec, section) in shells {
        match plates(mesh, spec, &section) {
            Ok(plates) => all.extend(spec.cells.iter().copied().zip(plates)),
            Err(error) => {
                let path = format!("body.{}", spec.name);
                return problems.refuse(Problem::new(path, error.to_string()));
            }
        }
    }
    let piece = |&line: &ElementId| {
        let ends = mesh.element_nodes(line);
        all.iter().find_map(|(cell, plate)| {
            let nodes = mesh.element_nodes(*cell);
            let place = |node: u32| nodes.iter().position(|&own| own == node);
            let ([a, b], [from, to]) = ([place(ends[0])?, place(ends[1])?], [ends[0], ends[1]]);
            Some(EdgeCell {
                nodes: [from, to],
                x: [plate.x[a], plate.x[b]],
                directors: [plate.directors[a], plate.directors[b]],
                offset: plate.offset,
                thickness: plate.thickness,
            })
        })
    };
    let edge: Option<Vec<EdgeCell>> = lines.iter().map(piece).collect();
    if edge.is_none() {
        let message = "the lines at the end of a transition must be edges of shells";
        let problem = Problem::new(given.path_of("end"), message).found(given.end);
        let accepted = ["edges of a shell", "a group of one node: the end of a beam"];
        problems.push(problem.accepted(accepted));
    }
    edge
}

/// Refuses nodes of the end that belong to the face.
fn apart_from_face(
    nodes: &[u32],
    face: &Surface,
    given: &Given,
    problems: &mut Problems,
) -> Option<()> {
    let has = |node: &u32| face.nodes.binary_search(node).is_ok();
    if !nodes.iter().any(has) {
        return Some(());
    }
    let message = "the node belongs to the face: a transition joins bodies without common nodes";
    let problem = Problem::new(given.path_of("end"), message).found(given.end);
    problems.refuse(problem.accepted(["a beam or a shell with nodes of its own"]))
}
