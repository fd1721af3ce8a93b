//! Bodies reduced to nodes and modes.

use carom_dynamics::{Model, ModelLink};
use carom_reduction::{Error, Keep, reduce};

use super::Builder;
use crate::error::Problem;

impl Builder<'_> {
    /// Reduces the bodies of a model that are to be. `links`: between zones, with terms at nodes of the mesh.
    pub(super) fn reduce(&mut self, model: &mut Model, links: &[ModelLink]) {
        let case = self.case;
        for (number, (name, body)) in case.body.iter().enumerate() {
            let Some(given) = &body.reduction else {
                continue;
            };
            let path = format!("body.{name}.reduction");
            if body.rigid.is_some() {
                let problem = Problem::new(&path, "a rigid body has no modes");
                self.problems
                    .push(problem.accepted(["either `rigid` or `reduction`"]));
                continue;
            }
            let rows = links.iter().flat_map(|link| &link.rows);
            let terms = rows.flat_map(|row| row.inner.iter().chain(&row.outer));
            let mut nodes: Vec<u32> = terms.map(|term| term.node).collect();
            for group in &given.retain {
                let path = format!("{path}.retain");
                if let Some(group) = self.group(&model.mesh, &path, group) {
                    nodes.extend(model.mesh.group_nodes(group));
                }
            }
            let keep = Keep {
                modes: given.modes as usize,
                nodes,
                massless: given.massless,
                ratio: given.damping_ratio,
                rayleigh: model
                    .nonlinear
                    .damping
                    .get(number)
                    .copied()
                    .unwrap_or_default(),
            };
            match reduce(model, number, &keep) {
                Ok(()) => {
                    // it is part of the reduced matrices
                    if let Some(damping) = model.nonlinear.damping.get_mut(number) {
                        *damping = Default::default();
                    }
                }
                Err(error) => {
                    let path = match error {
                        Error::Count { .. } => format!("{path}.modes"),
                        _ => path,
                    };
                    let problem = Problem::new(path, error.to_string());
                    self.problems.push(match error {
                        Error::Count { exist, .. } => problem.accepted([format!("1 to {exist}")]),
                        _ => problem,
                    });
                }
            }
        }
    }
}
