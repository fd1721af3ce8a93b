//! The closest point of one face, and the box around it.

use carom_elements::Kind;
use carom_mesh::{Bounds, Face, Projection, project};

use crate::Places;

/// The closest point of one of the faces.
pub(crate) fn foot_on<'a>(
    places: &Places,
    faces: &'a [Face],
    item: u32,
    x: &[f64; 3],
) -> (Projection, &'a Face) {
    let face = &faces[item as usize];
    if face.kind == Kind::Quad4 {
        return (project(face, &corners(places, face), x), face);
    }
    let positions = places.of_face(face);
    (project(face, &positions[..face.corners().len()], x), face)
}

/// The corners of a quadrilateral, m.
#[inline]
pub(super) fn corners(places: &Places, face: &Face) -> [[f64; 3]; 4] {
    let [a, b, c, d, ..] = face.nodes;
    [places.of(a), places.of(b), places.of(c), places.of(d)]
}

/// A box that holds a face.
pub(crate) fn hull(places: &Places, face: &Face) -> Bounds {
    if face.kind == Kind::Quad4 {
        return Bounds::of(&corners(places, face));
    }
    Bounds::of_face(face.kind, &places.of_face(face)[..face.corners().len()])
}

/// Whether a point faces the face on which its closest point lies: whether the way to it runs sideways by no more than
/// it runs along the normal.
pub(crate) fn faces_point(foot: &Projection, face: &Face) -> bool {
    if foot.inside || face.kind == Kind::Point1 {
        return true;
    }
    let sideways = (foot.distance.powi(2) - foot.gap.powi(2)).max(0.0).sqrt();
    // Matching rims coincide only to rounding: a foot that close to the rim counts as inside.
    let rounding = 1e-9
        * foot
            .point
            .iter()
            .fold(1e-300_f64, |size, x| size.max(x.abs()));
    sideways <= foot.gap.abs().max(rounding)
}

/// The most that Σ |N_a| is on a face: places between its nodes move by that times the motion of the nodes at most.
pub(crate) fn spread(kind: Kind) -> f64 {
    match kind {
        Kind::Point1 | Kind::Bar2 | Kind::Tri3 | Kind::Quad4 => 1.0,
        // eight nodes, at the centre: four times 1/4 and four times 1/2; other kinds have less
        _ => 3.0,
    }
}
