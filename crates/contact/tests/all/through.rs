//! Points that come deep behind a surface in one step.

use carom_algebra::unknowns::Unknowns;
use carom_contact::{Frames, Pairing, Places, Point, Search, Target};
use carom_mesh::{Surface, generate};

use crate::fixture::contact;

/// A point goes 0.2 m down through the top of a cube of 1 m, near to its side: the side is nearer, and the point comes on that from within. Where it was
/// inside before, or where no step is under way, the nearer one is faced.
#[test]
fn a_point_faces_the_face_that_it_has_come_through() {
    let mut mesh = generate::box_("a", [0.0; 3], [1.0; 3], [1; 3], false);
    let faces = Surface::outer(&mesh, &mesh.groups["a"].elements)
        .faces
        .clone();
    let node = mesh.nodes.len() as u32;
    mesh.nodes.push([0.95, 0.4, 1.1]);
    let contact = contact(vec![Point::at_node(node, 1.0, 1.0)], Target::Surface(faces));
    let unknowns = Unknowns::translations(3, mesh.nodes.len());
    let places = |u| Places {
        unknowns: &unknowns,
        time: 0.0,
        x: &mesh.nodes,
        u,
        frames: Frames::default(),
    };
    let still = vec![0.0; 3 * mesh.nodes.len()];
    let mut down = still.clone();
    down[3 * node as usize + 2] = -0.3;
    let gap = |start: Option<&Places>, was_inside: bool| {
        let (mut search, mut pairing) = (Search::default(), Pairing::default());
        pairing.clear();
        let inside = move |_| was_inside;
        let near = (start, 1.0, &inside as &(dyn Fn(usize) -> bool + Sync));
        contact.append_near(&places(&down), &mut search, near, &mut pairing);
        (pairing.rows.gap(0), pairing.rows.normal(0))
    };
    let start = places(&still);
    for (found, depth, axis) in [
        (gap(Some(&start), false), 0.2, 2),
        (gap(Some(&start), true), 0.05, 0),
        (gap(None, false), 0.05, 0),
    ] {
        // rounding of coordinates of 1 m
        assert!((found.0 + depth).abs() < 1e-15, "{found:?}");
        assert!((found.1[axis] - 1.0).abs() < 1e-15, "{found:?}");
    }
}
