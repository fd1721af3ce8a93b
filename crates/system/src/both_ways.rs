//! Contacts that are looked for both ways, so that what touches does not depend on which side is the secondary one.
//!
//! Nodes of each side face the other, and in space sharp edges cross those of the other. The two surfaces are one together, of which faces of one
//! side do not touch each other. Points of the finer side tell what points of both would tell, as on a surface that faces itself. A side is the outer
//! side of solids, or middles of shells.

use carom_bodies::height;
use carom_contact::{Contact, Edges, Parts, Point, Sight, Target};
use carom_mesh::{Face, Mesh, Rim, SharpEdge, Surface};

use crate::contacts::{
    DEPTH, at_edges, crossing, is_axis, least_height, lines_of, nodes, renumbered, shared,
    surface_factor,
};
use crate::model::{Model, ModelContact, ModelTarget};

/// A contact that is looked for both ways by system number; none of one that is not, of a surface that faces itself, which its points see from all
/// sides, and of axes, whose lines alone cross edges of the other side. `x`: reference coordinates by system number, m.
pub(crate) fn numbered(
    contact: &ModelContact,
    model: &Model,
    number: &[u32],
    x: &[[f64; 3]],
) -> Option<Contact> {
    let ModelTarget::Surface(primary) = &contact.primary else {
        return None;
    };
    let sides = [&contact.secondary, primary];
    let alone = || Sight::is_needed(&sides[0].faces, &sides[1].faces);
    if !contact.both_ways || sides.iter().any(|side| kind(side).is_none()) || alone() {
        return None;
    }
    let mesh = &model.mesh;
    let of_side = |side: &Surface| {
        let factor = surface_factor(model, side);
        shared(nodes(side, mesh, number, factor))
    };
    let mut points = of_side(sides[0]);
    points.extend(of_side(sides[1]).into_iter().map(Point::on_primary));
    let faces = sides.iter().flat_map(|side| &side.faces);
    let both = Surface::of_faces(faces.copied().collect());
    let first = sides[0].faces.len();
    let sharp = sharp_edges((sides, &both), mesh);
    points.extend(
        at_edges((&both, &sharp), mesh, number)
            .into_iter()
            .map(|(edge, point)| match (edge.faces[0] as usize) < first {
                true => point,
                false => point.on_primary(),
            }),
    );
    // edges of shells that cross each other have points on one side
    let are_shells = sides.iter().all(|side| kind(side) == Some(Kind::Shells));
    let [own, of_primary] = match are_shells {
        true => sides.map(|side| lines_of(side, mesh)),
        false => [const { Vec::new() }; 2],
    };
    if !of_primary.is_empty() {
        points.extend(own.iter().map(|line| crossing(&renumbered(line, number))));
    }
    let own = sharp.iter();
    let own = own.map(|edge| edge.renumbered(|node| number[node as usize]));
    let own: Vec<SharpEdge> = own.collect();
    let depth = DEPTH * least_height((&both, &sharp), mesh);
    let in_system = |faces: &[Face]| -> Vec<Face> {
        let faces = faces.iter();
        faces.map(|face| renumbered(face, number)).collect()
    };
    let (faces, lines) = (in_system(&both.faces), in_system(&of_primary));
    let counts = [first, sides[1].faces.len()];
    let parts = Parts::both_ways(contact.parts.as_ref(), counts, lines.len());
    let deep = contact.depth.or_else(|| depth_of_view(&both, mesh));
    let sight = Sight::both_ways(&points, (&faces, &lines), x, (deep, &parts));
    let mut target = faces;
    Rim::mark(&mut target, |node| x[node as usize], |node| node);
    target.extend(lines);
    Some(Contact {
        name: contact.name.clone(),
        law: contact.law,
        sliding: contact.sliding,
        integration: contact.integration,
        edges: Edges::new(&own, &points, x, depth),
        points,
        mortar: None,
        target: Target::Surface(target),
        sight: Some(sight),
        offsets: Vec::new(),
        near_only: contact.near_only,
    })
}

/// What a side is of.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Solids,
    Shells,
}

/// What all faces of a side are of; none of axes of beams, of points and of a mixture.
fn kind(side: &Surface) -> Option<Kind> {
    let is_of_shell = |face: &Face| face.is_round() && !is_axis(face) && face.kind.table().dim == 2;
    if side.faces.iter().all(|face| face.radius.is_none()) {
        return Some(Kind::Solids);
    }
    side.faces.iter().all(is_of_shell).then_some(Kind::Shells)
}

/// The edges that cross between nodes where a side is of solids: sharp ones of these, and of shells if the solids have any.
fn sharp_edges((sides, both): ([&Surface; 2], &Surface), mesh: &Mesh) -> Vec<SharpEdge> {
    if mesh.dim != 3 {
        return Vec::new();
    }
    let sharp = both.sharp_edges_of_solids(mesh);
    let first = sides[0].faces.len() as u32;
    let of_shells = sides.into_iter().zip([0, first]);
    let of_shells = of_shells.filter(|(side, _)| kind(side) == Some(Kind::Shells));
    let of_shells = of_shells.flat_map(|(side, first)| {
        let edges = side.edges_to_cross(mesh).into_iter();
        edges.map(move |edge| SharpEdge {
            faces: edge.faces.map(|face| face + first),
            ..edge
        })
    });
    let of_shells: Vec<SharpEdge> = of_shells.collect();
    let is_mixed = sides.iter().any(|side| kind(side) == Some(Kind::Shells));
    match is_mixed && (sharp.is_empty() || of_shells.is_empty()) {
        true => Vec::new(),
        false => [sharp, of_shells].concat(),
    }
}

/// How deep points see where a side is of shells and the contact does not say, m: by the cells at the surfaces of solids, by the thickness of shells that
/// meet. None where both are of solids.
fn depth_of_view(both: &Surface, mesh: &Mesh) -> Option<f64> {
    let radii = both.faces.iter().filter_map(|face| face.radius);
    let radius = radii.reduce(f64::max)?;
    let solids = both.faces.iter().filter(|face| face.radius.is_none());
    let heights = solids.map(|face| height(mesh, face.parent, face.kind, face.corners()));
    Some(heights.reduce(f64::min).unwrap_or(2.0 * radius))
}
