//! Shells: sections, and what shells refuse.

use carom_bodies::{Kinematics, Rotations, SHELL_LAYERS, ShellSection};
use carom_dynamics::ModelBody;
use carom_materials::Law;
use carom_mesh::{ElementId, Group, Mesh, Surface};

use super::Builder;
use crate::error::Problem;
use crate::schema::{self, Body, Section};

impl Builder<'_> {
    /// The kinematics of shells with this section; `path`: of the body.
    pub(super) fn shell(
        &mut self,
        path: &str,
        given: &schema::ShellSection,
        material: Law,
    ) -> Option<Kinematics> {
        let flows = material.plane_stress().is_some();
        if material.finite().is_some() && !flows {
            let problem = Problem::new(
                format!("{path}.material"),
                "shells have small strains; with rotations = \"finite\" they turn by any angle",
            );
            let accepted = ["elastic", "j2", "j2-table", "johnson-cook"];
            self.problems
                .push(problem.found(material.key()).accepted(accepted));
            return None;
        }
        let layers = match (given.layers, flows) {
            (None, _) => SHELL_LAYERS,
            (Some(layers), true) if layers % 2 == 0 => layers,
            (Some(layers), _) => {
                let (message, found, accepted) = match flows {
                    true => (
                        "no layer may lie across the middle of the section",
                        layers.to_string(),
                        "an even number",
                    ),
                    false => (
                        "the section of an elastic shell has no layers",
                        material.key().to_owned(),
                        "a material that flows: j2, j2-table, johnson-cook",
                    ),
                };
                let problem = Problem::new(format!("{path}.section.shell.layers"), message);
                self.problems
                    .push(problem.found(found).accepted([accepted]));
                return None;
            }
        };
        let rotations = match given.rotations {
            schema::Rotations::Small => Rotations::Small,
            schema::Rotations::Finite => Rotations::Finite,
        };
        let offset = given.offset.map_or(0.0, |offset| offset.0);
        if offset != 0.0 && rotations == Rotations::Finite {
            let message = "shells with finite rotations have their middle surface in the nodes";
            let problem = Problem::new(format!("{path}.section.shell.offset"), message);
            self.problems.push(
                problem
                    .found(format!("{offset} m"))
                    .accepted(["no `offset`", "rotations = \"small\""]),
            );
            return None;
        }
        Some(Kinematics::Shell(ShellSection {
            rotations,
            offset,
            layers,
            ..ShellSection::new(given.thickness.0)
        }))
    }

    /// Refuses keys that shells do not take.
    pub(super) fn suits_shells(&mut self, path: &str, body: &Body) {
        if let Some(Section::Shell(section)) = &body.section
            && matches!(body.formulation, schema::Formulation::With(_))
            && section.rotations == schema::Rotations::Small
        {
            let message = "shells with one point have finite rotations";
            let problem = Problem::new(format!("{path}.formulation"), message);
            self.problems.push(
                problem.accepted(["section.shell.rotations = \"finite\"", "no `formulation`"]),
            );
        }
        if is_shell(body) && body.rigid.is_some() {
            let message = "a rigid body of shells has no cells from which its inertia follows";
            let problem = Problem::new(format!("{path}.rigid"), message);
            self.problems
                .push(problem.accepted(["a rigid body of solid cells", "no `rigid`"]));
        }
        if is_shell(body) && body.reduction.is_some() {
            let message = "shells are not reduced";
            let problem = Problem::new(format!("{path}.reduction"), message);
            self.problems
                .push(problem.accepted(["solids and beams", "no `reduction`"]));
        }
    }

    /// The surface around a group of cells of shells, at half their thickness on both sides and around their edges. None if the group is anything
    /// else.
    pub(super) fn around_shells(
        &mut self,
        mesh: &Mesh,
        bodies: &[ModelBody],
        (path, group): (&str, &Group),
    ) -> Option<Surface> {
        let cells = shell_cells(bodies);
        let surface = Surface::of_axes(mesh, group, &cells, |cell| {
            let owner = bodies.iter().find(|body| {
                matches!(body.spec.kinematics, Kinematics::Shell(_))
                    && body.spec.cells.contains(&cell)
            });
            match owner.map(|body| body.spec.kinematics) {
                Some(Kinematics::Shell(section)) => 0.5 * section.thickness,
                _ => 0.0,
            }
        });
        let surface = surface.ok().filter(|_| group.dim == 2 && mesh.dim == 3)?;
        let offset = bodies.iter().find(|body| {
            let has = |face: &carom_mesh::Face| body.spec.cells.contains(&face.parent);
            matches!(body.spec.kinematics, Kinematics::Shell(section) if section.offset != 0.0)
                && surface.faces.iter().any(has)
        });
        if let Some(body) = offset {
            let message = format!(
                "body `{}` has its middle surface beside its nodes, where contacts are not available",
                body.spec.name
            );
            let problem = Problem::new(path, message);
            self.problems
                .push(problem.accepted(["a shell without `offset`"]));
        }
        Some(surface)
    }
}

/// The cells of all shells.
pub(super) fn shell_cells(bodies: &[ModelBody]) -> Vec<ElementId> {
    let shells = bodies
        .iter()
        .filter(|body| matches!(body.spec.kinematics, Kinematics::Shell(_)));
    shells
        .flat_map(|body| body.spec.cells.iter().copied())
        .collect()
}

/// Whether a body is one of shells.
pub(super) fn is_shell(body: &Body) -> bool {
    matches!(body.section, Some(Section::Shell(_)))
}
