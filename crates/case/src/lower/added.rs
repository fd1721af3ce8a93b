//! Forces that a program adds to a case and sets while the run goes on.

use carom_dynamics::{Amplitude, Held, NodalLoad};
use carom_mesh::Mesh;

use super::context::Context;
use super::problems::Problems;
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

/// Added forces as loads at nodes.
pub(super) fn lower(
    context: &Context,
    mesh: &Mesh,
    forces: &[AddedForce],
    problems: &mut Problems,
) -> Vec<NodalLoad> {
    let mut loads = Vec::new();
    for added in forces {
        let path = format!("force {}", added.name);
        let direction = &added.direction;
        if direction.len() != mesh.dim || !direction.iter().all(|c| c.is_finite()) {
            let problem = Problem::new(&path, "not a direction in the space of the mesh");
            let problem = problem.found(format!("{direction:?}"));
            let accepted = format!("{} finite numbers", mesh.dim);
            problems.push(problem.accepted([accepted]));
            continue;
        }
        if context.case.time.is_static() || context.case.time.stage.is_some() {
            let message = "forces that are set between the steps need a run without a static stage";
            problems.push(Problem::new(&path, message));
            continue;
        }
        let Some(group) = problems.group(mesh, &path, &added.on) else {
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
