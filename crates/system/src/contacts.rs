//! Contacts in the numbers of a system: bodies of each side, points, and which law may hold where.

use std::collections::{BTreeMap, BTreeSet};

use carom_bodies::{Kinematics, height};
use carom_contact::{Contact, Edges, Integration, Mortar, Point, Sight, Sliding, Target};
use carom_mesh::{ElementId, Face, Mesh, Rim, SharpEdge, Surface};

use crate::model::{Model, ModelBody, ModelContact, ModelTarget};
use crate::round_obstacles::points_between;

/// The body of a cell, in the order of the system.
fn owner(model: &Model, cell: ElementId) -> Option<usize> {
    let solids = model.bodies.iter().map(|body| &body.spec.cells);
    let discrete = model.discrete.iter().map(|body| &body.spec.cells);
    solids
        .chain(discrete)
        .position(|cells| cells.contains(&cell))
}

/// Bodies of a contact: the secondary's, and the primary's unless it is rigid.
pub fn sides(contact: &ModelContact, model: &Model) -> (usize, Option<usize>) {
    let body = |surface: &Surface| {
        surface
            .faces
            .first()
            .and_then(|face| owner(model, face.parent))
    };
    let primary = match &contact.primary {
        ModelTarget::Surface(surface) => body(surface),
        ModelTarget::Rigid(_) => None,
    };
    (body(&contact.secondary).unwrap_or(0), primary)
}

/// The body of each cell at a contact.
pub(crate) fn owners(model: &Model) -> BTreeMap<ElementId, usize> {
    let parents = |surface: &Surface| -> Vec<ElementId> {
        surface.faces.iter().map(|face| face.parent).collect()
    };
    let mut cells = BTreeSet::new();
    for contact in &model.contacts {
        cells.extend(parents(&contact.secondary));
        if let ModelTarget::Surface(primary) = &contact.primary {
            cells.extend(parents(primary));
        }
    }
    let solids = model.bodies.iter().map(|body| &body.spec.cells);
    let discrete = model.discrete.iter().map(|body| &body.spec.cells);
    let mut owners = BTreeMap::new();
    for (body, of) in solids.chain(discrete).enumerate() {
        for &cell in of.iter().filter(|cell| cells.contains(cell)) {
            owners.entry(cell).or_insert(body);
        }
    }
    owners
}

/// The bodies of the two sides of a contact; none of a rigid obstacle. `owners`: of [`owners`].
pub(crate) fn bodies_of(
    contact: &ModelContact,
    owners: &BTreeMap<ElementId, usize>,
) -> [BTreeSet<usize>; 2] {
    let bodies = |surface: &Surface| -> BTreeSet<usize> {
        let faces = surface.faces.iter();
        let known = faces.filter_map(|face| owners.get(&face.parent));
        known.copied().collect()
    };
    let primary = match &contact.primary {
        ModelTarget::Surface(surface) => bodies(surface),
        ModelTarget::Rigid(_) => BTreeSet::new(),
    };
    [bodies(&contact.secondary), primary]
}

/// All bodies of a contact, ascending: those of its [`sides`], and others where a side has several.
pub(crate) fn touching(
    contact: &ModelContact,
    model: &Model,
    owners: &BTreeMap<ElementId, usize>,
) -> Vec<usize> {
    let (secondary, primary) = sides(contact, model);
    let first = [Some(secondary), primary].into_iter().flatten();
    let all = bodies_of(contact, owners).into_iter().flatten();
    let bodies: BTreeSet<usize> = first.chain(all).collect();
    bodies.into_iter().collect()
}

/// Whether a side of a contact has several bodies that move apart: bodies that share nodes are one ([`System::part_of_body`]),
/// unless both sides are of them.
pub(crate) fn is_of_many(
    contact: &ModelContact,
    owners: &BTreeMap<ElementId, usize>,
    part_of_body: &[usize],
) -> bool {
    let bodies = bodies_of(contact, owners);
    let [one, other] = bodies
        .each_ref()
        .map(|side| -> BTreeSet<usize> { side.iter().map(|&body| part_of_body[body]).collect() });
    match one.is_disjoint(&other) {
        true => one.len().max(other.len()) > 1,
        false => bodies.iter().any(|side| side.len() > 1),
    }
}

/// A contact one way with its points and its target by system number. `x`: reference coordinates by system number, m.
pub(crate) fn numbered(
    contact: &ModelContact,
    model: &Model,
    number: &[u32],
    x: &[[f64; 3]],
) -> Contact {
    let surface = &contact.secondary;
    let (solid, factor) = (body_of(model, surface), surface_factor(model, surface));
    let faces = |surface: &Surface| -> Vec<Face> {
        let faces = surface.faces.iter();
        faces.map(|face| renumbered(face, number)).collect()
    };
    let lines = crossed(contact, model);
    let sharp = sharp_edges(contact, &model.mesh);
    let (points, mortar) = match contact.integration {
        Integration::Node => {
            let mut points = nodes(surface, &model.mesh, number, factor);
            if let Some(body) = solid.filter(|body| body.spec.deletion.is_some()) {
                points.extend(inner_nodes(&body.spec.cells, surface, &model.mesh, number));
            }
            let crosses = !lines.is_empty();
            if crosses {
                let own = lines_of(surface, &model.mesh).into_iter();
                points.extend(own.map(|line| crossing(&renumbered(&line, number))));
            }
            let mut points = shared(points);
            if solid.is_none_or(|body| body.spec.deletion.is_none()) {
                let between = points_between(contact, (&model.mesh, number), &points);
                points.extend(between);
            }
            if let Some(sharp) = &sharp {
                let own = (surface, &sharp.secondary[..]);
                let own = at_edges(own, &model.mesh, number);
                points.extend(own.into_iter().map(|(_, point)| point));
            }
            (points, None)
        }
        Integration::Points | Integration::Weak { .. } => {
            (Point::of_faces(&faces(surface), x, factor), None)
        }
        Integration::Mortar { .. } => {
            let (mortar, points) = Mortar::new(faces(surface), x, factor);
            (points, Some(mortar))
        }
    };
    let target = match &contact.primary {
        ModelTarget::Rigid(obstacle) => Target::Rigid(obstacle.clone()),
        ModelTarget::Surface(surface) => {
            let mut faces = faces(surface);
            Rim::mark(&mut faces, |node| x[node as usize], |node| node);
            let edges = lines.iter().filter(|line| !surface.faces.contains(line));
            faces.extend(edges.map(|line| renumbered(line, number)));
            Target::Surface(faces)
        }
    };
    let edges = sharp.and_then(|sharp| {
        let edges = sharp.primary.iter();
        let edges = edges.map(|edge| edge.renumbered(|node| number[node as usize]));
        let edges: Vec<SharpEdge> = edges.collect();
        Edges::new(&edges, &points, x, sharp.depth)
    });
    let sight = match &target {
        Target::Surface(primary) => {
            let secondary = faces(surface);
            let needed = contact.depth.is_some() || Sight::is_needed(&secondary, primary);
            let sight = || Sight::new((&points, &secondary), primary, x, contact.depth);
            let needed = needed || contact.parts.is_some();
            needed.then(|| match &contact.parts {
                Some(parts) => sight().with_parts(parts),
                None => sight(),
            })
        }
        Target::Rigid(_) => None,
    };
    Contact {
        name: contact.name.clone(),
        law: contact.law,
        sliding: contact.sliding,
        integration: contact.integration,
        points,
        mortar,
        target,
        edges,
        sight,
        offsets: Vec::new(),
        near_only: contact.near_only,
    }
}

/// The body of a surface; of a point mass none.
fn body_of<'a>(model: &'a Model, surface: &Surface) -> Option<&'a ModelBody> {
    let first = surface.faces.first();
    model
        .bodies
        .get(first.and_then(|face| owner(model, face.parent))?)
}

/// Area in m² that a unit of the measure of the faces of a surface stands for at a place; of a point mass a force stands for itself.
pub(crate) fn surface_factor(
    model: &Model,
    surface: &Surface,
) -> impl Fn(&[f64; 3]) -> f64 + use<> {
    let kinematics = body_of(model, surface).map(|body| body.spec.kinematics);
    let runs_along = surface.faces.first().is_some_and(is_axis);
    move |x: &[f64; 3]| match kinematics {
        Some(Kinematics::Beam(section)) if runs_along => section.width(),
        other => other.map_or(1.0, |k| k.surface_factor(x)),
    }
}

/// Lines of the primary side that lines of the other side may cross, at nodes in space: axes of beams, and of two surfaces of which none faces itself also sharp edges of shells.
fn crossed(contact: &ModelContact, model: &Model) -> Vec<Face> {
    let ModelTarget::Surface(other) = &contact.primary else {
        return Vec::new();
    };
    let own = &contact.secondary.faces;
    let alone = || contact.depth.is_none() && !Sight::is_needed(own, &other.faces);
    let round = || own.iter().chain(&other.faces).all(Face::is_round);
    let takes = other.faces.iter().all(is_axis) || round() && alone();
    match model.mesh.dim == 3 && contact.integration == Integration::Node && takes {
        true => lines_of(other, &model.mesh),
        false => Vec::new(),
    }
}

/// Part of the size of the elements at the edges beyond which edges of solids that are behind each other do not touch.
pub(crate) const DEPTH: f64 = 0.25;

/// Length of an edge over the least height of the cells at the edges, from which on it has a second point: rounding of cubes aside.
const LONG: f64 = 1.01;

/// Edges of both sides of a contact that may cross, by the numbers of the mesh.
struct SharpEdges {
    secondary: Vec<SharpEdge>,
    primary: Vec<SharpEdge>,
    /// Penetration beyond which they do not touch, m.
    depth: f64,
}

/// The edges of a contact that asks for them: sharp ones of solids, of which a side is, and axes of beams or sharp edges of shells of the other. None
/// where a side has none.
fn sharp_edges(contact: &ModelContact, mesh: &Mesh) -> Option<SharpEdges> {
    let ModelTarget::Surface(primary) = &contact.primary else {
        return None;
    };
    let at_nodes = contact.integration == Integration::Node;
    let slides = contact.sliding == Sliding::Finite;
    if !(contact.both_ways && mesh.dim == 3 && at_nodes && slides) {
        return None;
    }
    let surfaces = [&contact.secondary, primary];
    let [secondary, primary] = surfaces.map(|surface| surface.edges_to_cross(mesh));
    let mut of_solids = secondary.iter().chain(&primary);
    let any_of_solids = of_solids.any(|edge| edge.beside.is_some());
    if secondary.is_empty() || primary.is_empty() || !any_of_solids {
        return None;
    }
    let sides = surfaces.into_iter().zip([&secondary, &primary]);
    let least = sides.map(|(surface, edges)| least_height((surface, edges), mesh));
    let least = least.fold(f64::INFINITY, f64::min);
    Some(SharpEdges {
        secondary,
        primary,
        depth: DEPTH * least,
    })
}

/// The least height of the cells at sharp edges of solids of a surface over its faces, m; infinite without any.
pub(crate) fn least_height((surface, edges): (&Surface, &[SharpEdge]), mesh: &Mesh) -> f64 {
    let edges = edges.iter().filter(|edge| edge.beside.is_some());
    let faces = edges.flat_map(|edge| edge.faces);
    let faces = faces.map(|face| &surface.faces[face as usize]);
    let heights = faces.map(|face| height(mesh, face.parent, face.kind, face.corners()));
    heights.fold(f64::INFINITY, f64::min)
}

/// The points of sharp edges, first one of each, then a second one of those that are longer than the bodies are thick at them: they may cross two edges.
/// Each stands for a square of half its length.
pub(crate) fn at_edges<'a>(
    (surface, edges): (&Surface, &'a [SharpEdge]),
    mesh: &Mesh,
    number: &[u32],
) -> Vec<(&'a SharpEdge, Point)> {
    let point = |edge: &SharpEdge| {
        let half = 0.5 * edge.length(&mesh.nodes);
        let edge = edge.renumbered(|node| number[node as usize]);
        Point::at_edge(&edge, half * half)
    };
    let thin = least_height((surface, edges), mesh);
    let long = edges.iter();
    let long = long.filter(|edge| edge.beside.is_none() || edge.length(&mesh.nodes) > LONG * thin);
    let second = long.map(|edge| (edge, point(edge).second()));
    let first = edges.iter().map(|edge| (edge, point(edge)));
    first.chain(second).collect()
}

/// Axes of beams and sharp edges of shells.
pub(crate) fn lines_of(surface: &Surface, mesh: &Mesh) -> Vec<Face> {
    let axes = surface.faces.iter().filter(|face| is_axis(face)).copied();
    axes.chain(surface.sharp_edges(mesh)).collect()
}

/// Whether a face is a part of the axis of a beam, not the end or a point of it.
pub(crate) fn is_axis(face: &Face) -> bool {
    face.is_round() && face.corners().len() == 2
}

/// The point of an axis that crosses another; it stands for the square of its diameter.
pub(crate) fn crossing(axis: &Face) -> Point {
    let diameter = 2.0 * axis.radius.unwrap_or(0.0);
    Point::crossing(axis, diameter * diameter)
}

/// The points with their shares in the surface.
pub(crate) fn shared(mut points: Vec<Point>) -> Vec<Point> {
    let total: f64 = points.iter().map(|point| point.area).sum();
    for point in &mut points {
        point.share = point.area / total;
    }
    points
}

/// The nodes of a surface with the areas that they stand for, and the radii around them.
pub(crate) fn nodes(
    surface: &Surface,
    mesh: &Mesh,
    number: &[u32],
    factor: impl Fn(&[f64; 3]) -> f64,
) -> Vec<Point> {
    let areas = surface.tributary_areas(mesh, factor);
    let mut radii = vec![0.0_f64; surface.nodes.len()];
    for face in &surface.faces {
        for k in face
            .corners()
            .iter()
            .filter_map(|&node| surface.index_of(node))
        {
            radii[k] = radii[k].max(face.radius.unwrap_or(0.0));
        }
    }
    let points = surface.nodes.iter().zip(areas).zip(radii);
    let at = |((&node, area), radius): ((&u32, f64), f64)| {
        Point::at_node(number[node as usize], area, 0.0).around(radius)
    };
    let mut points: Vec<Point> = points.map(at).collect();
    for face in &surface.faces {
        let own = renumbered(face, number);
        for k in face
            .corners()
            .iter()
            .filter_map(|&node| surface.index_of(node))
        {
            points[k].add_face(own.corners());
        }
    }
    points
}

/// The nodes of these cells that are not on the surface, in the order of the cells: the deletion of cells may lay them bare. They stand
/// for no area.
fn inner_nodes(cells: &[ElementId], surface: &Surface, mesh: &Mesh, number: &[u32]) -> Vec<Point> {
    let mut seen = vec![false; mesh.nodes.len()];
    for &node in &surface.nodes {
        seen[node as usize] = true;
    }
    let nodes = cells.iter().flat_map(|&cell| mesh.element_nodes(cell));
    let inner = nodes.filter(|&&node| !std::mem::replace(&mut seen[node as usize], true));
    inner
        .map(|&node| Point::at_node(number[node as usize], 0.0, 0.0))
        .collect()
}

/// A face with its nodes by system number.
pub(crate) fn renumbered(face: &Face, number: &[u32]) -> Face {
    face.renumbered(|node| number[node as usize])
}
