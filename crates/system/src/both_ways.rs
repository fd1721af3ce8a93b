//! Contacts that are looked for both ways, so that what touches does not depend on which side is the secondary one.
//!
//! Nodes of each side face the other, and in space sharp edges cross those of the other. The two surfaces are one together, of which faces of one
//! side do not touch each other. Points of the finer side tell what points of both would tell, as on a surface that faces itself.

use carom_contact::{Contact, Edges, Parts, Point, Sight, Target};
use carom_mesh::{Face, Rim, SharpEdge, Surface};

use crate::contacts::{DEPTH, at_edges, least_height, nodes, renumbered, shared, surface_factor};
use crate::model::{Model, ModelContact, ModelTarget};

/// A contact that is looked for both ways by system number; none of one that is not, of a surface that faces itself, which its points see from all
/// sides, and of axes and middles, whose edges alone cross those of the other side. `x`: reference coordinates by system number, m.
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
    let solid = |side: &&Surface| side.faces.iter().all(|face| face.radius.is_none());
    let alone = || Sight::is_needed(&sides[0].faces, &sides[1].faces);
    if !contact.both_ways || !sides.iter().all(solid) || alone() {
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
    let sharp = match mesh.dim {
        3 => both.sharp_edges_of_solids(mesh),
        _ => Vec::new(),
    };
    let first = sides[0].faces.len();
    points.extend(
        at_edges((&both, &sharp), mesh, number)
            .into_iter()
            .map(|(edge, point)| match (edge.faces[0] as usize) < first {
                true => point,
                false => point.on_primary(),
            }),
    );
    let own = sharp.iter();
    let own = own.map(|edge| edge.renumbered(|node| number[node as usize]));
    let own: Vec<SharpEdge> = own.collect();
    let depth = DEPTH * least_height((&both, &sharp), mesh);
    let faces = both.faces.iter();
    let faces: Vec<Face> = faces.map(|face| renumbered(face, number)).collect();
    let parts = Parts::both_ways(contact.parts.as_ref(), [first, sides[1].faces.len()]);
    let sight = Sight::both_ways((&points, &faces), x, contact.depth, &parts);
    let mut target = faces;
    Rim::mark(&mut target, |node| x[node as usize], |node| node);
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
