//! Forces that a program adds to a case and sets while the run goes on.

use carom_dynamics::{Amplitude, Held, NodalLoad};
use carom_mesh::Mesh;

use super::Builder;
use crate::error::Problem;

/// A force on a group of nodes, in no case file, whose size is set between the steps.
#[derive(Clone, Debug)]
pub struct AddedForce {
    /// Name, for messages.
    pub name: String,
    /// Group of the mesh.
    pub on: String,
    /// Components of a force of size 1, N; together on all nodes of the group, which have equal shares.
    pub direction: Vec<f64>,
    /// Its size, constant over each step.
    pub size: Held,
}

impl Builder<'_> {
    /// Added forces as loads at nodes.
    pub(super) fn added_forces(&mut self, mesh: &Mesh, forces: &[AddedForce]) -> Vec<NodalLoad> {
        let mut loads = Vec::new();
        for added in forces {
            let path = format!("force {}", added.name);
            let direction = &added.direction;
            if direction.len() != mesh.dim || !direction.iter().all(|c| c.is_finite()) {
                let problem = Problem::new(&path, "not a direction in the space of the mesh");
                let problem = problem.found(format!("{direction:?}"));
                let accepted = format!("{} finite numbers", mesh.dim);
                self.problems.push(problem.accepted([accepted]));
                continue;
            }
            if self.case.time.is_static() || self.case.time.stage.is_some() {
                let message =
                    "forces that are set between the steps need a run without a static stage";
                self.problems.push(Problem::new(&path, message));
                continue;
            }
            let Some(group) = self.group(mesh, &path, &added.on) else {
                continue;
            };
            let nodes = mesh.group_nodes(group);
            let mut force = [0.0; 3];
            for (component, c) in force.iter_mut().zip(direction) {
                *component = c / nodes.len() as f64;
            }
            loads.push(NodalLoad {
                name: added.name.clone(),
                nodes,
                force,
                moment: [0.0; 3],
                amplitude: Amplitude::held(&added.size),
            });
        }
        loads
    }
}
