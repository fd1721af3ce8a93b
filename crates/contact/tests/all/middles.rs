//! Solids and shells that look at each other: a corner between the nodes of a shell, a corner of a shell between those of a solid, and points that have
//! gone over the middle of a shell.

use carom_algebra::unknowns::Unknowns;
use carom_contact::{Contact, Frames, Pairing, Parts, Places, Point, Sight, Target};
use carom_elements::Kind;
use carom_mesh::{Face, Rim};

use crate::fixture::{assert_balanced, assert_derivatives, contact, face, full, paired};

/// Half the thickness of shells, m.
const HALF: f64 = 0.02;

/// Faces and places of a side.
type Side = (Vec<Face>, Vec<[f64; 3]>);

fn middle(nodes: &[u32], radius: f64) -> Face {
    Face {
        radius: Some(radius),
        ..face(Kind::Quad4, nodes)
    }
}

/// A shell of one face at z = 0.
fn shell() -> Side {
    let x = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let x = x.map(|[x, y]| [x, y, 0.0]).to_vec();
    (vec![middle(&[0, 1, 2, 3], HALF)], x)
}

/// A tetrahedron with its tip down at this height, over the middle of a quarter of the shell.
fn tip(height: f64) -> Side {
    let around = [[0.2, 0.2], [0.8, 0.3], [0.4, 0.8]];
    let mut x: Vec<[f64; 3]> = around.map(|[x, y]| [x, y, height + 0.6]).to_vec();
    x.push([0.45, 0.4, height]);
    let faces = [[0, 1, 2], [1, 0, 3], [2, 1, 3], [0, 2, 3]];
    (faces.map(|nodes| face(Kind::Tri3, &nodes)).to_vec(), x)
}

/// A contact both ways. Nodes of the second side are numbered behind those of the first.
fn between([one, other]: [&Side; 2], depth: f64) -> (Contact, Vec<[f64; 3]>) {
    let first = one.1.len() as u32;
    let points = |(faces, x): &Side, first: u32| -> Vec<Point> {
        let at = |node: u32| {
            let own = faces.iter().filter(|face| face.corners().contains(&node));
            let radius = own.clone().find_map(|face| face.radius).unwrap_or(0.0);
            let mut point = Point::at_node(first + node, 1.0, 1.0).around(radius);
            own.for_each(|face| {
                point.add_face(face.renumbered(|node| first + node).corners());
            });
            point
        };
        (0..x.len() as u32).map(at).collect()
    };
    let mut all = points(one, 0);
    all.extend(points(other, first).into_iter().map(Point::on_primary));
    let x = [&one.1[..], &other.1].concat();
    let of_other = other.0.iter();
    let of_other = of_other.map(|face| face.renumbered(|node| first + node));
    let mut faces: Vec<Face> = one.0.iter().copied().chain(of_other).collect();
    let parts = Parts::both_ways(None, [one.0.len(), other.0.len()], 0);
    let sight = Sight::both_ways(&all, (&faces, &[]), &x, (Some(depth), &parts));
    Rim::mark(&mut faces, |node| x[node as usize], |node| node);
    let mut contact = contact(all, Target::Surface(faces));
    contact.sight = Some(sight);
    (contact, x)
}

/// Pairs at rest and checks rows, second derivatives and balance of what faces something.
fn checked(contact: &Contact, x: &[[f64; 3]]) -> Pairing {
    let unknowns = Unknowns::translations(3, x.len());
    let u = vec![0.0; 3 * x.len()];
    let places = Places {
        unknowns: &unknowns,
        time: 0.0,
        x,
        u: &u,
        frames: Frames::default(),
    };
    let pairing = paired(contact, &places);
    assert_derivatives(&places, |places| paired(contact, places));
    for point in (0..pairing.len()).filter(|&point| pairing.rows.gap(point).is_finite()) {
        assert_balanced(&pairing, point, &places, 1e-13);
    }
    pairing
}

/// The shell and the tip, with the gap of the tip and its row, as (shell, tip) and as (tip, shell).
fn tip_at(height: f64) -> [(f64, f64); 2] {
    let (shell, tip) = (shell(), tip(height));
    let [(one, x), (other, y)] = [between([&shell, &tip], 0.3), between([&tip, &shell], 0.3)];
    let (of_one, of_other) = (checked(&one, &x), checked(&other, &y));
    // nodes of the shell 0 to 3 and of the solid 4 to 7, or of the solid 0 to 3 and of the shell 4 to 7
    let up = |pairing: &Pairing, point: usize| full(pairing, point, 24)[3 * point + 2];
    [
        (of_one.rows.gap(7), up(&of_one, 7)),
        (of_other.rows.gap(3), up(&of_other, 3)),
    ]
}

#[test]
fn a_corner_of_a_solid_meets_a_shell_between_its_nodes_at_half_the_thickness_whichever_side_is_the_secondary_one()
 {
    for height in [0.1, 0.03, HALF, 0.01] {
        for (gap, up) in tip_at(height) {
            // rounding of places of size one
            assert!((gap - (height - HALF)).abs() < 1e-15, "{height}: {gap}");
            assert!((up - 1.0).abs() < 1e-15, "{height}: {up}");
        }
    }
}

#[test]
fn a_corner_that_has_gone_over_the_middle_is_pushed_back_to_its_body() {
    for height in [-0.01, -HALF, -0.1] {
        for (gap, up) in tip_at(height) {
            assert!((gap - (height - HALF)).abs() < 1e-15, "{height}: {gap}");
            assert!((up - 1.0).abs() < 1e-15, "{height}: {up}");
        }
    }
    // by more than half of the depth it is another body that is further on
    for (gap, up) in tip_at(-0.16) {
        assert_eq!((gap, up), (f64::INFINITY, 0.0));
    }
}

/// A block with its top at z = 0 and no node beneath the corner of a shell that stands on it.
fn block() -> Side {
    let corner = |k: u32| [k & 1, k >> 1 & 1, k >> 2].map(f64::from);
    let x = (0..8).map(|k| {
        let [x, y, z] = corner(k);
        [x, y, z - 1.0]
    });
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let faces = faces.map(|nodes| face(Kind::Quad4, &nodes));
    (faces.to_vec(), x.collect())
}

/// A square shell that stands on its corner, 1 m in its diagonal.
fn standing(height: f64) -> Side {
    let x = [[0.3, 0.0], [0.8, 0.5], [0.3, 1.0], [-0.2, 0.5]];
    let x = x.map(|[x, z]| [x, 0.4 + 0.1 * (x - 0.3), z + height]);
    (vec![middle(&[0, 1, 2, 3], HALF)], x.to_vec())
}

#[test]
fn a_corner_of_a_shell_meets_a_face_of_a_solid_between_its_nodes_at_half_the_thickness() {
    let (block, shell) = (block(), standing(0.01));
    for sides in [[&block, &shell], [&shell, &block]] {
        let (contact, x) = between(sides, 1.0);
        let pairing = checked(&contact, &x);
        let corner = contact
            .points
            .iter()
            .position(|point| x[point.node() as usize] == shell.1[0])
            .unwrap();
        assert!((pairing.rows.gap(corner) - (0.01 - HALF)).abs() < 1e-15);
        assert!((pairing.rows.normal(corner)[2] - 1.0).abs() < 1e-15);
        // the force on the secondary side: up on the shell, down on the block
        let up = pairing.rows.resultant(corner)[2];
        let is_secondary = std::ptr::eq(sides[0], &shell);
        assert!((up - if is_secondary { 1.0 } else { -1.0 }).abs() < 1e-15);
    }
}

#[test]
fn shells_meet_at_the_sum_of_half_their_thicknesses_and_a_rim_that_has_gone_over_is_pushed_back() {
    for height in [0.1, 0.05, 0.03, -0.01, -0.1] {
        let (lying, standing) = (shell(), standing(height));
        for sides in [[&lying, &standing], [&standing, &lying]] {
            let (contact, x) = between(sides, 2.0 * HALF);
            let pairing = checked(&contact, &x);
            let mut points = contact.points.iter();
            let at = |point: &Point| x[point.node() as usize] == standing.1[0];
            let corner = points.position(at).unwrap();
            let gap = pairing.rows.gap(corner);
            assert!((gap - (height - 2.0 * HALF)).abs() < 1e-15, "{gap}");
            assert!((pairing.rows.normal(corner)[2] - 1.0).abs() < 1e-15);
        }
    }
}

/// Flat surfaces that lie on each other are told by the finer one, or the secondary one of two that are as fine.
#[test]
fn of_a_flat_contact_of_a_shell_and_a_solid_one_side_tells() {
    let lying = shell();
    let lifted = lying.1.iter().map(|[x, y, _]| [*x, *y, HALF]).collect();
    let (block, shell) = (block(), (lying.0, lifted));
    for sides in [[&block, &shell], [&shell, &block]] {
        let (contact, x) = between(sides, 1.0);
        let unknowns = Unknowns::translations(3, x.len());
        let u = vec![0.0; 3 * x.len()];
        let places = Places {
            unknowns: &unknowns,
            time: 0.0,
            x: &x,
            u: &u,
            frames: Frames::default(),
        };
        let pairing = paired(&contact, &places);
        let closed = |point: usize| pairing.rows.gap(point).abs() < 1e-15;
        let all: Vec<usize> = (0..pairing.len()).filter(|&point| closed(point)).collect();
        assert_eq!(all.len(), 8);
        for point in all {
            let leaves = contact.leaves_it((&pairing, 0), point, closed);
            assert_eq!(leaves, contact.points[point].is_on_primary(), "{point}");
        }
    }
}
