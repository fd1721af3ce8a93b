//! Surfaces that are tied to each other within one system.

use carom_dynamics::{ModelBody, ModelConstraint};
use carom_mesh::{ElementId, Mesh};
use carom_zones::mortar_rows;

use super::Builder;
use crate::error::Problem;

impl Builder<'_> {
    /// The rows between two surfaces whose nodes need not match, ([`mortar_rows`]). `sides`: cells that may have such surfaces.
    pub(super) fn tied(
        &mut self,
        (mesh, bodies): (&Mesh, &[ModelBody]),
        (name, path): (&str, &str),
        names: &[String; 2],
        sides: &[ElementId],
    ) -> Option<ModelConstraint> {
        let path = format!("{path}.surfaces");
        let mut surface = |k: usize| {
            let place = format!("{path}[{k}]");
            self.surface(mesh, sides, &place, &names[k])
        };
        let (one, other) = (surface(0), surface(1));
        let (one, other) = (one?, other?);
        let refuse = |message: &str, accepted: &str| {
            let problem = Problem::new(path.clone(), message).found(names.join(" and "));
            problem.accepted([accepted])
        };
        if one
            .nodes
            .iter()
            .any(|node| other.nodes.binary_search(node).is_ok())
        {
            let accepted = "surfaces of two bodies with nodes of their own";
            self.problems
                .push(refuse("these surfaces have common nodes", accepted));
            return None;
        }
        let parent = one.faces.first().map(|face| face.parent)?;
        let body = bodies
            .iter()
            .find(|body| body.spec.cells.contains(&parent))?;
        let rows = mortar_rows(mesh, &one, &other, |x| {
            body.spec.kinematics.surface_factor(x)
        });
        if rows.rows.is_empty() {
            let accepted = "two surfaces that lie on each other";
            self.problems.push(refuse(
                "these surfaces are nowhere opposite to each other",
                accepted,
            ));
            return None;
        }
        Some(ModelConstraint::of_rows(name, &rows.rows, mesh.dim))
    }
}
