//! Ends of beams and edges of shells on faces of solids, and surfaces on each other.

use carom_arlequin::{EdgeCell, Rows, edge_mean_motion, edge_rigid_motion, mean_motion};
use carom_bodies::{Kinematics, ShellPlate, plates};
use carom_dynamics::{ModelBody, ModelConstraint, ModelLink};
use carom_elements::Kind;
use carom_mesh::{ElementId, Mesh, Surface};

use super::Builder;
use super::turning::{SMALL_TURNS, any_angle};
use crate::error::Problem;
use crate::schema::TransitionMotion;

/// An end on a face, as a case gives it.
struct Given<'a> {
    end: &'a str,
    face: &'a str,
    motion: TransitionMotion,
}

impl Builder<'_> {
    /// The constraints between ends of beams or edges of shells and faces, and the links of those that turn by any angle. `turning`: nodes with rotations, sorted.
    pub(super) fn transitions(
        &mut self,
        mesh: &Mesh,
        bodies: &[ModelBody],
        turning: &[u32],
    ) -> (Vec<ModelConstraint>, Vec<ModelLink>) {
        let case = self.case;
        let cells = bodies.iter().flat_map(|body| body.spec.cells.iter());
        let sides: Vec<ElementId> = cells
            .copied()
            .filter(|&cell| mesh.kind(cell).table().dim == mesh.dim)
            .collect();
        let (mut all, mut links) = (Vec::new(), Vec::new());
        for (name, given) in case.transition.iter() {
            let path = format!("transition.{name}");
            if let Some(surfaces) = &given.surfaces {
                all.extend(self.tied((mesh, bodies), (name, &path), surfaces, &sides));
            }
            let (Some(end), Some(face)) = (&given.end, &given.face) else {
                continue;
            };
            let given = &Given {
                end,
                face,
                motion: given.motion.unwrap_or_default(),
            };
            let face = self.surface(mesh, &sides, &format!("{path}.face"), given.face);
            let of = (name, given, path.as_str());
            if self.both_turn(mesh, bodies, of, face.as_ref()) {
                links.extend(self.end_turns_on((mesh, bodies), of, face));
                continue;
            }
            if self.turns_by_any_angle(mesh, bodies, of, face.as_ref()) {
                continue;
            }
            let found = match self.is_edge(mesh, given.end) {
                true => self.edge_on(mesh, bodies, of, face),
                false => self.end_on(mesh, turning, of, face),
            };
            all.extend(found);
        }
        let inside = |link: &&ModelLink| link.zones[0] == link.zones[1];
        let names = all.iter().map(|one| &one.name);
        let mut names = names.chain(links.iter().filter(inside).map(|one| &one.name));
        if let (Some(first), false) = (names.next(), self.plan.zones.is_empty()) {
            let message = "in zones a transition joins a beam with finite rotations and a solid at finite strain of two zones";
            let problem = Problem::new(format!("transition.{first}"), message);
            self.problems.push(problem.accepted([
                "a case without zones",
                "[arlequin.<name>] between the two bodies",
            ]));
        }
        (all, links)
    }

    /// Whether the end of a beam and the face that has its motion in the mean both turn by any angle.
    fn both_turn(
        &self,
        mesh: &Mesh,
        bodies: &[ModelBody],
        (_, given, _): (&str, &Given, &str),
        face: Option<&Surface>,
    ) -> bool {
        let end = mesh.groups.get(given.end);
        let end = end.map_or(Vec::new(), |group| mesh.group_nodes(group));
        let face = face.map_or(&[][..], |face| &face.nodes);
        let turns = |nodes: &[u32]| any_angle(mesh, bodies, nodes).is_some();
        given.motion == TransitionMotion::Distributing
            && !self.is_edge(mesh, given.end)
            && turns(&end)
            && turns(face)
    }

    /// The end of a beam with finite rotations on a face of a solid at finite strain.
    fn end_turns_on(
        &mut self,
        (mesh, bodies): (&Mesh, &[ModelBody]),
        (name, given, path): (&str, &Given, &str),
        face: Option<Surface>,
    ) -> Option<ModelLink> {
        let end = self.single(mesh, &format!("{path}.end"), given.end);
        let (end, face) = (end?, face?);
        self.apart_from_face(&[end], &face, (given, path))?;
        let rows = self.mean_rows(mesh, (end, &face), (given, path))?;
        // those of the face are the inner terms
        let on_face = |cell: &ElementId| face.faces.iter().any(|face| face.parent == *cell);
        let at_end = |cell: &ElementId| mesh.element_nodes(*cell).contains(&end);
        let zone = |own: &dyn Fn(&ElementId) -> bool| {
            let body = bodies
                .iter()
                .position(|body| body.spec.cells.iter().any(own));
            body.and_then(|body| self.plan.zone_of(body)).unwrap_or(0)
        };
        Some(ModelLink {
            name: name.to_owned(),
            zones: [zone(&on_face), zone(&at_end)],
            rows: rows.rows,
        })
    }

    /// The rows of the mean motion of a face.
    fn mean_rows(
        &mut self,
        mesh: &Mesh,
        (end, face): (u32, &Surface),
        (given, path): (&Given, &str),
    ) -> Option<Rows> {
        match mean_motion(mesh, &face.faces, end) {
            Ok(rows) => Some(rows),
            Err(error) => {
                let problem = Problem::new(format!("{path}.face"), error.to_string());
                let problem = problem.found(given.face);
                self.problems
                    .push(problem.accepted(["faces that are not on one line"]));
                None
            }
        }
    }

    /// Refuses ends and faces of bodies that turn by any angle where the rows are those of small turns.
    fn turns_by_any_angle(
        &mut self,
        mesh: &Mesh,
        bodies: &[ModelBody],
        (_, given, path): (&str, &Given, &str),
        face: Option<&Surface>,
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
        let message = format!(
            "a transition holds for small rotations, and body '{name}' may turn by any angle"
        );
        let problem = Problem::new(format!("{path}.{key}"), message).found(found);
        let both = "motion = \"distributing\", of a beam with finite rotations and a solid at finite strain";
        let accepted = SMALL_TURNS.into_iter().chain([both]);
        self.problems.push(problem.accepted(accepted));
        true
    }

    /// Whether a name is that of a group of lines.
    fn is_edge(&self, mesh: &Mesh, name: &str) -> bool {
        let lines = |cell: &ElementId| mesh.kind(*cell) == Kind::Bar2;
        let group = mesh.groups.get(name);
        mesh.dim == 3 && group.is_some_and(|group| group.elements.iter().all(lines))
    }

    /// The end of a beam on a face.
    fn end_on(
        &mut self,
        mesh: &Mesh,
        turning: &[u32],
        (name, given, path): (&str, &Given, &str),
        face: Option<Surface>,
    ) -> Option<ModelConstraint> {
        let end = self.single(mesh, &format!("{path}.end"), given.end);
        let (end, face) = (end?, face?);
        if turning.binary_search(&end).is_err() {
            let message = "the node at the end of a transition must have rotations";
            let problem = Problem::new(format!("{path}.end"), message).found(given.end);
            self.problems.push(problem.accepted(["a node of a beam"]));
            return None;
        }
        self.apart_from_face(&[end], &face, (given, path))?;
        Some(match given.motion {
            TransitionMotion::Rigid => {
                let nodes: Vec<(u32, bool)> = face
                    .nodes
                    .iter()
                    .map(|&node| (node, turning.binary_search(&node).is_ok()))
                    .collect();
                ModelConstraint::rigid_link(name, mesh, end, &nodes, true)
            }
            TransitionMotion::Distributing => {
                let rows = self.mean_rows(mesh, (end, &face), (given, path))?;
                ModelConstraint::of_rows(name, &rows.rows, mesh.dim)
            }
        })
    }

    /// The edge of a shell on a face.
    fn edge_on(
        &mut self,
        mesh: &Mesh,
        bodies: &[ModelBody],
        (name, given, path): (&str, &Given, &str),
        face: Option<Surface>,
    ) -> Option<ModelConstraint> {
        let group = self.group(mesh, &format!("{path}.end"), given.end)?;
        let (lines, nodes) = (group.elements.clone(), mesh.group_nodes(group));
        let face = face?;
        self.apart_from_face(&nodes, &face, (given, path))?;
        let edge = self.edge(mesh, bodies, &lines, (given, path))?;
        let rows = match given.motion {
            TransitionMotion::Distributing => edge_mean_motion(mesh, &face.faces, &edge),
            TransitionMotion::Rigid => edge_rigid_motion(mesh, &face.faces, &edge),
        };
        match rows {
            Ok(rows) => Some(ModelConstraint::of_rows(name, &rows.rows, mesh.dim)),
            Err(error) => {
                let problem = Problem::new(format!("{path}.face"), error.to_string());
                let accepted = "the side of a solid along the edge, as high as the shell is thick";
                self.problems
                    .push(problem.found(given.face).accepted([accepted]));
                None
            }
        }
    }

    /// Lines as pieces of the edge of a shell.
    fn edge(
        &mut self,
        mesh: &Mesh,
        bodies: &[ModelBody],
        lines: &[ElementId],
        (given, path): (&Given, &str),
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
                    self.problems.push(Problem::new(path, error.to_string()));
                    return None;
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
            let problem = Problem::new(format!("{path}.end"), message).found(given.end);
            let accepted = ["edges of a shell", "a group of one node: the end of a beam"];
            self.problems.push(problem.accepted(accepted));
        }
        edge
    }

    /// Refuses nodes of the end that belong to the face.
    fn apart_from_face(
        &mut self,
        nodes: &[u32],
        face: &Surface,
        (given, path): (&Given, &str),
    ) -> Option<()> {
        let has = |node: &u32| face.nodes.binary_search(node).is_ok();
        if !nodes.iter().any(has) {
            return Some(());
        }
        let message =
            "the node belongs to the face: a transition joins bodies without common nodes";
        let problem = Problem::new(format!("{path}.end"), message).found(given.end);
        self.problems
            .push(problem.accepted(["a beam or a shell with nodes of its own"]));
        None
    }
}
