//! Bodies, nodes, surfaces and directions by what a case says of them.

use carom_dynamics::{ModelBody, ModelContact, ModelTarget};
use carom_mesh::{Bounds, ElementId, Face, Mesh, Surface};

use super::problems::{Problems, dimensions, plural};
use crate::error::Problem;
use crate::schema::{Case, NormalVector};

/// The number of the body called `name`, or a problem at `path`.
pub(super) fn body(case: &Case, path: &str, name: &str, problems: &mut Problems) -> Option<usize> {
    let names: Vec<&str> = case.body.names().collect();
    let number = names.iter().position(|one| *one == name);
    if number.is_none() {
        let problem = Problem::new(path, "no body of this name");
        problems.push(problem.unknown(name, names));
    }
    number
}

/// The numbers of the inner and the outer body of a joint; `path`: its key.
pub(super) fn bodies(
    case: &Case,
    path: &str,
    [inner, outer]: [&str; 2],
    problems: &mut Problems,
) -> Option<[usize; 2]> {
    let inner = body(case, &format!("{path}.inner"), inner, problems);
    let outer = body(case, &format!("{path}.outer"), outer, problems);
    Some([inner?, outer?])
}

/// The node of a group of one.
pub(super) fn single(mesh: &Mesh, path: &str, name: &str, problems: &mut Problems) -> Option<u32> {
    let group = problems.group(mesh, path, name)?;
    let nodes = mesh.group_nodes(group);
    if let [node] = nodes[..] {
        return Some(node);
    }
    let problem = Problem::new(path, "a group of one node is needed");
    let problem = problem.found(plural(nodes.len(), "node"));
    problems.refuse(problem.accepted(["a group of one node"]))
}

pub(super) fn surface(
    mesh: &Mesh,
    cells: &[ElementId],
    path: &str,
    name: &str,
    problems: &mut Problems,
) -> Option<Surface> {
    let group = problems.group(mesh, path, name)?;
    // beams beside solids: only cells of one dimension more can have the sides
    let dim = |cell: &&ElementId| mesh.kind(**cell).table().dim == group.dim + 1;
    let over: Vec<ElementId> = cells.iter().filter(dim).copied().collect();
    let over = if over.is_empty() { cells } else { &over };
    match Surface::new(mesh, group, over) {
        Ok(surface) => Some(surface),
        Err(error) => {
            let problem = Problem::new(path, error.to_string()).found(name);
            problems.refuse(problem.accepted(["a group of outer sides of bodies"]))
        }
    }
}

/// A unit vector in the space of the mesh.
pub(super) fn normal(
    mesh: &Mesh,
    path: &str,
    given: &NormalVector,
    problems: &mut Problems,
) -> Option<[f64; 3]> {
    let normal = given.components();
    if normal[mesh.dim..].iter().any(|n| *n != 0.0) {
        let message = format!("a normal beyond the {} of the mesh", dimensions(mesh.dim));
        let problem = Problem::new(path, message).found(format!("{normal:?}"));
        return problems.refuse(problem.accepted(["a normal in the space of the mesh"]));
    }
    Some(unit(normal))
}

/// A unit vector along an axis: in the plane across it.
pub(super) fn axis(
    mesh: &Mesh,
    path: &str,
    given: &NormalVector,
    problems: &mut Problems,
) -> Option<[f64; 3]> {
    let axis = given.components();
    let across = axis[0] == 0.0 && axis[1] == 0.0;
    if mesh.dim < 3 && !across {
        let message = "an axis in the plane of the mesh";
        let problem = Problem::new(path, message).found(format!("{axis:?}"));
        return problems.refuse(problem.accepted(["[0, 0, 1]"]));
    }
    Some(unit(axis))
}

/// The direction of a vector of any length but zero, brought near one first: squares of its components may be no numbers.
pub(super) fn unit(vector: [f64; 3]) -> [f64; 3] {
    let largest = vector
        .iter()
        .fold(0.0_f64, |largest, n| largest.max(n.abs()));
    // in two steps: one over the smallest numbers is infinite
    let vector = vector.map(|n| n / largest);
    let length = vector.iter().map(|n| n * n).sum::<f64>().sqrt();
    vector.map(|n| n / length)
}

/// Names of the axes.
pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// Refuses a direction that the mesh does not have.
pub(super) fn within(mesh: &Mesh, path: &str, axis: usize, problems: &mut Problems) {
    if axis < mesh.dim {
        return;
    }
    let message = format!(
        "a direction beyond the {} of the mesh",
        dimensions(mesh.dim)
    );
    let problem = Problem::new(path, message).found(AXES[axis]);
    problems.push(problem.accepted(AXES[..mesh.dim].to_vec()));
}

/// The body that has a cell.
pub(super) fn owner(bodies: &[ModelBody], cell: ElementId) -> Option<&ModelBody> {
    let mut bodies = bodies.iter();
    bodies.find(|body| body.spec.cells.binary_search(&cell).is_ok())
}

/// The body of a surface: that of its first face.
pub(super) fn body_behind<'a>(bodies: &'a [ModelBody], surface: &Surface) -> Option<&'a ModelBody> {
    owner(bodies, surface.faces.first()?.parent)
}

/// The faces of both sides of a contact; an obstacle has none.
pub(super) fn faces_of(contact: &ModelContact) -> [&[Face]; 2] {
    let primary = match &contact.primary {
        ModelTarget::Surface(surface) => &surface.faces[..],
        ModelTarget::Rigid(_) => &[],
    };
    [&contact.secondary.faces, primary]
}

/// The mean of the places of nodes, m.
pub(super) fn middle(mesh: &Mesh, nodes: &[u32]) -> [f64; 3] {
    let places = || nodes.iter().map(|&node| mesh.nodes[node as usize]);
    [0, 1, 2].map(|i| places().map(|x| x[i]).sum::<f64>() / nodes.len() as f64)
}

/// Diagonal of the box around nodes, m.
pub(super) fn diagonal(mesh: &Mesh, nodes: &[u32]) -> f64 {
    let places: Vec<[f64; 3]> = nodes
        .iter()
        .map(|&node| mesh.nodes[node as usize])
        .collect();
    let bounds = Bounds::of(&places);
    let squares = (0..3).map(|i| (bounds.max[i] - bounds.min[i]).powi(2));
    squares.sum::<f64>().sqrt()
}
