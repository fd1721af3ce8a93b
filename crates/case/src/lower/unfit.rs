//! What is wrong or strange about overlaps and their rows, in words and cells.

use carom_arlequin::{Error, Rows, Warning};
use carom_dynamics::ModelBody;
use carom_mesh::{ElementId, Mesh};

use super::joints::Joint;
use super::problems::{Problems, place, plural};
use crate::error::Problem;

/// Least eigenvalue of the Gram matrix of the rows, each of length one, below which they count as dependent: the
/// multipliers would keep less than half of their digits.
const LEAST_RANK: f64 = 1e-8;
/// Nodes named in one message; the others are counted.
const LISTED: usize = 3;

/// Refuses rows that are dependent on the unknowns that are free.
pub(super) fn full_rank(joint: &Joint, bodies: &[ModelBody], rows: &Rows, problems: &mut Problems) {
    let (path, mesh) = (&joint.path, joint.mesh);
    let rank = match rows.rank(|node, component| joint.held.has(node, component)) {
        Ok(rank) => rank,
        Err(error) => {
            problems.push(Problem::new(path, error.to_string()));
            return;
        }
    };
    if rank.smallest >= LEAST_RANK {
        return;
    }
    let (node, component) = rank.weakest;
    let at = place(mesh.nodes[node as usize]);
    let message = "the mediator has functions that vanish on both bodies: their rows are dependent";
    let problem = Problem::new(format!("{path}.mediator"), message)
        .found(format!(
            "a least eigenvalue of {:.1e} of the scaled rows, most of it of node {node}, {at}, in {}",
            rank.smallest,
            axis(mesh, component)
        ))
        .accepted([
            format!("at least {LEAST_RANK:e}"),
            "mediator = \"coarser\"".to_string(),
            "supports that end outside the overlap".to_string(),
        ]);
    let cells = bodies.iter().flat_map(|body| &body.spec.cells);
    let around = cells.filter(|&&cell| mesh.element_nodes(cell).contains(&node));
    let around: Vec<ElementId> = around.copied().collect();
    problems.push(joint.shown(problem, &around));
}

/// The problem behind an error of an overlap. `all`: cells of both bodies.
pub(super) fn problem(joint: &Joint, error: &Error, all: &[ElementId]) -> Problem {
    let (key, cells, accepted): (&str, &[ElementId], &str) = match error {
        Error::NotCovered { cells, .. } => {
            (".overlap", cells, "a group of cells that both bodies cover")
        }
        Error::EndsOutside { cells } => (
            ".overlap",
            cells,
            "an overlap up to the end of the inner body",
        ),
        Error::Thin { cells, .. } => (
            ".overlap",
            cells,
            "at least one cell of the outer body, better two to four",
        ),
        Error::Bent { cells } => (
            ".overlap",
            cells,
            "a beam with a straight axis in the solid",
        ),
        Error::SolidEndsOutside { cells } => {
            (".overlap", cells, "an overlap up to the end of the solid")
        }
        Error::Short { cells, .. } => (
            ".overlap",
            cells,
            "at least one cell of the coarser body, better two to four",
        ),
        Error::Section { cells, .. } => (
            ".overlap",
            cells,
            "a solid whose sections are those of the beam, about the same axis",
        ),
        Error::Thickness { cells, .. } => (
            ".overlap",
            cells,
            "a solid from one face of the shell to the other, about the same middle surface",
        ),
        Error::Fold { cells } => (
            ".overlap",
            cells,
            "a shell without folds in the overlap, its normals all to the same side",
        ),
        Error::FoldsOver { cell } => (
            "",
            std::slice::from_ref(cell),
            "flatter cells, or a thinner shell",
        ),
        Error::Empty => (".overlap", all, "a place where both bodies are"),
        Error::NoEnd { .. } => (
            ".overlap",
            all,
            "a beam or a shell that ends in the solid, or a group or a box that says how far it goes",
        ),
        Error::NoBorder { .. } => (".weights", all, "an overlap in which each body ends"),
        Error::Range { .. } | Error::Reflects { .. } => (".weights", &[], "\"linear\""),
        Error::NoMediator => (".mediator", all, "\"coarser\""),
        Error::Dimension { cell, .. } | Error::InverseMap { cell } => (
            "",
            std::slice::from_ref(cell),
            "sound cells that fill the space of the mesh",
        ),
        Error::Kind { cell, .. } => (
            "",
            std::slice::from_ref(cell),
            "bodies of linear cells, pyramids and wedges apart",
        ),
        Error::SharedNode { .. } => ("", &[], "bodies with meshes of their own"),
        Error::NoCells { .. } => ("", &[], "bodies with cells"),
        Error::Defect(_)
        | Error::NoInterface { .. }
        | Error::Ambiguous { .. }
        | Error::FacesOnLine { .. }
        | Error::FaceOfEdge { .. }
        | Error::EdgeWithoutFace { .. }
        | Error::Algebra(_) => ("", &[], "two sound bodies"),
    };
    let problem = Problem::new(format!("{}{key}", joint.path), error.to_string());
    joint.shown(problem.accepted([accepted]), cells)
}

/// Drops the rows of nodes that supports hold in both bodies.
pub(super) fn drop_held(joint: &Joint, rows: &mut Rows, problems: &mut Problems) {
    let dropped = joint.held.drop_rows(rows);
    let what = "removed: supports hold both bodies there";
    name_rows(joint, &dropped, what, problems);
}

/// Warns of rows, named by node and direction.
pub(super) fn name_rows(joint: &Joint, rows: &[(u32, u32)], what: &str, problems: &mut Problems) {
    let mesh = joint.mesh;
    let name = |&(node, component): &(u32, u32)| {
        let (axis, place) = (axis(mesh, component), place(mesh.nodes[node as usize]));
        format!("{axis} of node {node}, {place}")
    };
    name_all(joint, "constraint", rows.iter().map(name), what, problems);
}

/// Warns of mediator functions, named by their node.
pub(super) fn name_nodes(joint: &Joint, nodes: &[u32], what: &str, problems: &mut Problems) {
    let name = |&node: &u32| format!("node {node}, {}", place(joint.mesh.nodes[node as usize]));
    let noun = "mediator function";
    name_all(joint, noun, nodes.iter().map(name), what, problems);
}

fn name_all(
    joint: &Joint,
    noun: &str,
    names: impl ExactSizeIterator<Item = String>,
    what: &str,
    problems: &mut Problems,
) {
    let count = names.len();
    if count == 0 {
        return;
    }
    let first: Vec<String> = names.take(LISTED).collect();
    let more = match count > LISTED {
        true => format!("; and {} more", count - LISTED),
        false => String::new(),
    };
    problems.warn(format!(
        "joint `{}`: {} {what} ({}{more})",
        joint.name,
        plural(count, noun),
        first.join("; ")
    ));
}

/// What is doubtful about weights.
pub(super) fn doubt(warning: &Warning) -> String {
    match warning {
        Warning::NotPatchExact => "a constant strain is not reproduced exactly: only linear weights between two plane parallel borders do that".to_string(),
        Warning::SmallStep { model, factor } => format!(
            "the weights reduce the critical step of the {model} body to about {factor:.2} of its own"
        ),
    }
}

/// A translation, or after them a rotation.
fn axis(mesh: &Mesh, component: u32) -> &'static str {
    let component = component as usize;
    match (mesh.dim, component.checked_sub(mesh.dim)) {
        (_, None) => ["x", "y", "z"][component],
        (2, Some(_)) => "rz",
        (_, Some(turned)) => ["rx", "ry", "rz"][turned.min(2)],
    }
}
