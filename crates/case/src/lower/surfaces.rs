//! Surfaces of contacts: sides of cells, and what is around the axes of beams.

use carom_bodies::{BeamSection, Kinematics};
use carom_dynamics::ModelBody;
use carom_mesh::{CellsByNode, ElementId, Group, Mesh, Surface};

use super::lookup;
use super::problems::Problems;
use super::shells::around_shells;
use crate::error::Problem;

/// Cells of a body of beams that a surface may be around.
struct Axes<'a> {
    body: &'a str,
    section: &'a BeamSection,
    cells: &'a [ElementId],
}

/// The surface of a contact: sides of cells, or the round surface around lines and points of beams. `cells`: of all bodies.
pub(super) fn contact_surface(
    mesh: &Mesh,
    (bodies, cells): (&[ModelBody], &CellsByNode),
    path: &str,
    name: &str,
    problems: &mut Problems,
) -> Option<Surface> {
    let group = problems.group(mesh, path, name)?;
    if let Some(surface) = around_shells(mesh, bodies, group) {
        return Some(surface);
    }
    let axes = axes(mesh, bodies, group);
    let flat = group.dim == 0 && axes.iter().all(|axes| axes.section.radius == Some(0.0));
    if axes.is_empty() || flat {
        return lookup::surface(mesh, &cells.beside(mesh, group), path, name, problems);
    }
    let known = axes.iter().map(|axes| has_surface(axes, problems));
    let known: Vec<Option<()>> = known.collect();
    known.into_iter().collect::<Option<()>>()?;
    let own: Vec<ElementId> = axes.iter().flat_map(|axes| axes.cells).copied().collect();
    let radius = |cell: ElementId| {
        let owner = axes
            .iter()
            .find(|axes| axes.cells.binary_search(&cell).is_ok());
        owner.and_then(|axes| axes.section.radius).unwrap_or(0.0)
    };
    match Surface::of_axes(mesh, group, &own, radius) {
        Ok(surface) => Some(surface),
        Err(error) => {
            let problem = Problem::new(path, error.to_string()).found(name);
            problems.refuse(problem.accepted(["lines and points of beams"]))
        }
    }
}

/// Refuses beams of which a contact does not know where their surface is.
fn has_surface(axes: &Axes, problems: &mut Problems) -> Option<()> {
    let path = format!("body.{}.section.beam", axes.body);
    if axes.section.offset != [0.0; 2] {
        let message = "contacts of beams whose axis is beside their nodes are not available";
        let problem = Problem::new(format!("{path}.offset"), message);
        let problem = problem.found(format!("{:?} m", axes.section.offset));
        return problems.refuse(problem.accepted(["no `offset`", "a stop between nodes"]));
    }
    if axes.section.radius.is_none() {
        let message = "a contact must know how far the surface of the beam is from its axis, and this shape does not say";
        let problem = Problem::new(path, message);
        return problems.refuse(problem.accepted([
            "`radius`",
            "shape.circle",
            "shape.tube",
            "in the plane: shape.rectangle, shape.i",
        ]));
    }
    Some(())
}

/// The beams of which a group is cells or points; none if it is anything else.
fn axes<'a>(mesh: &Mesh, bodies: &'a [ModelBody], group: &Group) -> Vec<Axes<'a>> {
    let mut found = Vec::new();
    let mut left: Vec<ElementId> = group.elements.clone();
    for body in bodies {
        let Kinematics::Beam(section) = &body.spec.kinematics else {
            continue;
        };
        let cells = &body.spec.cells;
        let has = |&id: &ElementId| match group.dim {
            0 => {
                let node = mesh.element_nodes(id)[0];
                let mut ends = cells.iter().flat_map(|&cell| mesh.element_nodes(cell));
                ends.any(|&end| end == node)
            }
            _ => cells.binary_search(&id).is_ok(),
        };
        let before = left.len();
        left.retain(|id| !has(id));
        if left.len() < before {
            found.push(Axes {
                body: &body.spec.name,
                section,
                cells,
            });
        }
    }
    match left.is_empty() {
        true => found,
        false => Vec::new(),
    }
}
