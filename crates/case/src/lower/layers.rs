//! Sections of solids that the static stage tightens: which cells lie between two planes across the bolt.

use std::collections::{BTreeMap, BTreeSet};

use carom_bodies::{Kinematics, TightenedLayer};
use carom_dynamics::ModelBody;
use carom_mesh::{ElementId, Mesh, Parts};

use super::context::Context;
use super::problems::{Problems, Refusal};
use crate::error::Problem;
use crate::schema::Pretension;

/// Sine of the angle between two faces, and distance from the end of the layer over its thickness, up to which faces are in one plane.
const PLANE: f64 = 1e-6;

/// What a section has to be.
const WANTED: [&str; 2] = [
    "a group of all cells that the bolt has between two planes across it",
    "a group of the faces of cells in one plane across the bolt, inside it",
];

/// Bolts as a case gives them.
pub(super) struct Bolt<'a> {
    pub(super) name: &'a str,
    /// Its key.
    pub(super) path: String,
    pub(super) given: &'a Pretension,
}

impl Bolt<'_> {
    /// The name of one of `count` bolts.
    pub(super) fn name_of(&self, k: usize, count: usize) -> String {
        match count {
            1 => self.name.to_owned(),
            _ => format!("{}-{}", self.name, k + 1),
        }
    }
}

/// The layers of a solid that are tightened: those of a group of its cells, or beside a group of faces inside it.
pub(super) fn across_solid(
    context: &Context,
    (mesh, body): (&Mesh, &ModelBody),
    bolt: &Bolt,
    problems: &mut Problems,
) -> Option<Vec<TightenedLayer>> {
    let path = format!("{}.on", bolt.path);
    may_have_layers(context, &path, body, problems)?;
    let on = bolt.given.on.as_deref().unwrap_or_default();
    let elements = &mesh.groups.get(on)?.elements;
    let pieces = pieces(mesh, elements).into_iter();
    let layers: Option<Vec<_>> = match mesh.kind(elements[0]).table().dim == mesh.dim {
        true => pieces.map(|cells| layer(mesh, body, cells)).collect(),
        false => pieces.map(|faces| beside(mesh, body, &faces)).collect(),
    };
    let Some(layers) = layers else {
        let message = "this is no section across a bolt: a static stage shortens a layer of cells between two planes";
        let problem = Problem::new(path, message).found(on);
        return problems.refuse(problem.accepted(WANTED));
    };
    let count = layers.len();
    let mut tightened: Vec<TightenedLayer> = Vec::new();
    for (k, (cells, axis)) in layers.into_iter().enumerate() {
        let mut others = body.spec.layers.iter().chain(&tightened);
        let shares = |other: &&TightenedLayer| other.cells.iter().any(|cell| cells.contains(cell));
        if let Some(other) = others.find(shares) {
            let message = format!("`{}` tightens the same cells", other.name);
            return problems.refuse(Problem::new(path, message));
        }
        tightened.push(TightenedLayer {
            name: bolt.name_of(k, count),
            cells,
            axis,
            force: bolt.given.force.0,
            tightens: false,
        });
    }
    Some(tightened)
}

/// Refuses solids whose layers cannot be tightened.
fn may_have_layers(
    context: &Context,
    path: &str,
    body: &ModelBody,
    problems: &mut Problems,
) -> Option<()> {
    let name = &body.spec.name;
    let table = [
        Refusal {
            is: body.spec.material.finite().is_some(),
            key: "",
            message: "a solid at finite strain is not tightened",
            accepted: &[
                "a body of its own for the shank, of an `elastic` material, on nodes of the rest",
            ],
        },
        Refusal {
            is: context.case.body.get(name)?.reduction.is_some(),
            key: "",
            message: "a reduced body is not tightened",
            accepted: &["a body that is not reduced"],
        },
        Refusal {
            is: body.rigid.is_some(),
            key: "",
            message: "a rigid body is not tightened",
            accepted: &["a body that is not rigid"],
        },
        Refusal {
            is: body.spec.weights.is_some(),
            key: "",
            message: "a body that shares its volume with another model is not tightened",
            accepted: &["a body that is alone in its volume"],
        },
    ];
    problems.refuse_first((path, Some(name)), &table)
}

/// The solid that has the cells of a group, or cells with its faces; none where no solid has.
pub(super) fn solid_of<'b>(
    mesh: &Mesh,
    bodies: &'b mut [ModelBody],
    elements: &[ElementId],
) -> Option<&'b mut ModelBody> {
    let first = *elements.first()?;
    let dim = mesh.kind(first).table().dim;
    let has = |body: &&mut ModelBody| match body.spec.kinematics {
        Kinematics::Bar { .. } | Kinematics::Beam(_) | Kinematics::Shell(_) => false,
        _ if dim == mesh.dim => body.spec.cells.contains(&first),
        _ => dim + 1 == mesh.dim && !cells_at(mesh, &body.spec.cells, &[first]).is_empty(),
    };
    bodies.iter_mut().find(has)
}

/// Elements by connected piece.
fn pieces(mesh: &Mesh, elements: &[ElementId]) -> Vec<Vec<ElementId>> {
    let parts = Parts::new(mesh, elements.iter().copied());
    let mut pieces: BTreeMap<Option<u32>, Vec<ElementId>> = BTreeMap::new();
    for &element in elements {
        let part = parts.of(mesh.element_nodes(element)[0]);
        pieces.entry(part).or_default().push(element);
    }
    pieces.into_values().collect()
}

/// The cells that have all nodes of one of some faces.
fn cells_at(mesh: &Mesh, cells: &[ElementId], faces: &[ElementId]) -> Vec<ElementId> {
    let mut faces_at: BTreeMap<u32, Vec<ElementId>> = BTreeMap::new();
    for &face in faces {
        faces_at
            .entry(mesh.element_nodes(face)[0])
            .or_default()
            .push(face);
    }
    let has = |cell: &&ElementId| {
        let nodes = mesh.element_nodes(**cell);
        let mut near = nodes.iter().filter_map(|node| faces_at.get(node)).flatten();
        near.any(|&face| {
            mesh.element_nodes(face)
                .iter()
                .all(|node| nodes.contains(node))
        })
    };
    cells.iter().filter(has).copied().collect()
}

/// The layer on one side of faces in one plane; none on the surface of the body, or where neither side has one.
fn beside(
    mesh: &Mesh,
    body: &ModelBody,
    faces: &[ElementId],
) -> Option<(Vec<ElementId>, [f64; 3])> {
    let nodes = mesh.element_nodes(faces[0]);
    let n = normal(mesh, nodes)?;
    let level = along(&n, &mesh.nodes[nodes[0] as usize]);
    let both = cells_at(mesh, &body.spec.cells, faces);
    let middle = |cell: &ElementId| {
        let nodes = mesh.element_nodes(*cell);
        let sum: f64 = nodes
            .iter()
            .map(|&node| along(&n, &mesh.nodes[node as usize]))
            .sum();
        sum / nodes.len() as f64
    };
    let (above, below) = both
        .into_iter()
        .partition::<Vec<_>, _>(|cell| middle(cell) > level);
    if above.len() != below.len() {
        return None;
    }
    layer(mesh, body, above).or_else(|| layer(mesh, body, below))
}

/// Cells that are all of the body between two planes, and the direction across these; none where they are not.
fn layer(
    mesh: &Mesh,
    body: &ModelBody,
    cells: Vec<ElementId>,
) -> Option<(Vec<ElementId>, [f64; 3])> {
    let own: BTreeSet<ElementId> = cells.iter().copied().collect();
    let all = &body.spec.cells;
    if !cells.iter().all(|cell| all.contains(cell)) {
        return None;
    }
    let is_own: Vec<bool> = all.iter().map(|cell| own.contains(cell)).collect();
    let ends = mesh.bare_faces(all, &is_own);
    let axis = normal(mesh, ends.first()?.corners())?;
    let nodes = cells.iter().flat_map(|&cell| mesh.element_nodes(cell));
    let heights = nodes.map(|&node| along(&axis, &mesh.nodes[node as usize]));
    let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], z| {
        [low.min(z), high.max(z)]
    });
    let near = PLANE * (high - low);
    let is_end =
        |node: &u32, level: f64| (along(&axis, &mesh.nodes[*node as usize]) - level).abs() <= near;
    let flat = ends.iter().all(|face| {
        let corners = face.corners();
        let level = if is_end(&corners[0], low) { low } else { high };
        corners.iter().all(|node| is_end(node, level))
    });
    flat.then_some((cells, axis))
}

/// Σ n x.
fn along(n: &[f64; 3], x: &[f64; 3]) -> f64 {
    (0..3).map(|i| n[i] * x[i]).sum()
}

/// Unit normal of a face by its first corners; none of a face without area.
fn normal(mesh: &Mesh, corners: &[u32]) -> Option<[f64; 3]> {
    let x = |k: usize| mesh.nodes[corners[k] as usize];
    let way = |k: usize| [0, 1, 2].map(|i| x(k)[i] - x(0)[i]);
    let s = way(1);
    let n = match mesh.dim {
        2 => [s[1], -s[0], 0.0],
        _ => {
            let t = way(2);
            [0, 1, 2].map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                s[j] * t[k] - s[k] * t[j]
            })
        }
    };
    let length = along(&n, &n).sqrt();
    (length > 0.0).then(|| n.map(|n| n / length))
}
