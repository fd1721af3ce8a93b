//! Ends of beams on faces of solids.

use carom_arlequin::mean_motion;
use carom_dynamics::ModelConstraint;
use carom_mesh::{ElementId, Mesh};

use super::Builder;
use crate::error::Problem;
use crate::schema::TransitionMotion;

impl Builder<'_> {
    /// The constraints between ends of beams and faces. `cells`: of all bodies; `turning`: nodes with rotations, sorted.
    pub(super) fn transitions(
        &mut self,
        mesh: &Mesh,
        cells: &[ElementId],
        turning: &[u32],
    ) -> Vec<ModelConstraint> {
        let case = self.case;
        let mut all = Vec::new();
        for (name, given) in case.transition.iter() {
            let path = format!("transition.{name}");
            let end = self.single(mesh, &format!("{path}.end"), &given.end);
            let sides: Vec<ElementId> = cells
                .iter()
                .copied()
                .filter(|&cell| mesh.kind(cell).table().dim == mesh.dim)
                .collect();
            let face = self.surface(mesh, &sides, &format!("{path}.face"), &given.face);
            let (Some(end), Some(face)) = (end, face) else {
                continue;
            };
            if turning.binary_search(&end).is_err() {
                let message = "the node at the end of a transition must have rotations";
                let problem = Problem::new(format!("{path}.end"), message).found(&given.end);
                self.problems.push(problem.accepted(["a node of a beam"]));
                continue;
            }
            if face.nodes.binary_search(&end).is_ok() {
                let message =
                    "the node belongs to the face: a transition joins bodies without common nodes";
                let problem = Problem::new(format!("{path}.end"), message).found(&given.end);
                self.problems
                    .push(problem.accepted(["a beam with nodes of its own"]));
                continue;
            }
            all.push(match given.motion {
                TransitionMotion::Rigid => {
                    let nodes: Vec<(u32, bool)> = face
                        .nodes
                        .iter()
                        .map(|&node| (node, turning.binary_search(&node).is_ok()))
                        .collect();
                    ModelConstraint::rigid_link(name, mesh, end, &nodes, true)
                }
                TransitionMotion::Distributing => match mean_motion(mesh, &face.faces, end) {
                    Ok(rows) => ModelConstraint::of_rows(name, &rows.rows, mesh.dim),
                    Err(error) => {
                        let problem = Problem::new(format!("{path}.face"), error.to_string());
                        let problem = problem.found(&given.face);
                        self.problems
                            .push(problem.accepted(["faces that are not on one line"]));
                        continue;
                    }
                },
            });
        }
        if let (Some(first), false) = (all.first(), self.plan.zones.is_empty()) {
            let message = "transitions are not available in zones";
            let problem = Problem::new(format!("transition.{}", first.name), message);
            self.problems.push(problem.accepted([
                "a case without zones",
                "[arlequin.<name>] between the two bodies",
            ]));
        }
        all
    }
}
