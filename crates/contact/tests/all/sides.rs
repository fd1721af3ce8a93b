//! Contacts that two pieces of one surface would tell are told by one of them.

use carom_algebra::unknowns::Unknowns;
use carom_contact::{Contact, Frames, Places, Point, Sight, Target};
use carom_elements::Kind;
use carom_mesh::Face;

use crate::fixture::{contact, face, paired};

/// Segments of the lower line, whose points come first, and of the upper one, 1 m long each.
const LOWER: u32 = 6;
const UPPER: u32 = 9;

/// Two straight lines 1 mm apart that face each other, as one surface.
fn lines() -> (Vec<[f64; 3]>, Contact) {
    let line = |n: u32, y: f64| (0..=n).map(move |k| [f64::from(k) / f64::from(n), y, 0.0]);
    let x: Vec<[f64; 3]> = line(LOWER, 0.0).chain(line(UPPER, 1e-3)).collect();
    let first = LOWER + 1;
    let lower = (0..LOWER).map(|k| face(Kind::Bar2, &[k + 1, k]));
    let upper = (0..UPPER).map(|k| face(Kind::Bar2, &[first + k, first + k + 1]));
    let faces: Vec<Face> = lower.chain(upper).collect();
    let points: Vec<Point> = (0..x.len() as u32)
        .map(|node| Point::at_node(node, 1.0, 1.0))
        .collect();
    let sight = Sight::new((&points, &faces), &faces, &x, Some(0.1));
    let mut contact = contact(points, Target::Surface(faces));
    contact.sight = Some(sight);
    (x, contact)
}

#[test]
fn the_coarser_piece_leaves_the_contact_to_the_finer_one_where_all_of_it_takes_part() {
    let (x, contact) = lines();
    let unknowns = Unknowns::translations(2, x.len());
    let places = Places {
        unknowns: &unknowns,
        time: 0.0,
        x: &x,
        u: &vec![0.0; 2 * x.len()],
        frames: Frames::default(),
    };
    let pairing = paired(&contact, &places);
    let (lower, all) = (LOWER as usize + 1, x.len());
    let leaves = |point: usize, without: Option<usize>| {
        contact.leaves_it((&pairing, 0), point, |other| Some(other) != without)
    };
    for point in 0..all {
        assert!((pairing.rows.gap(point) - 1e-3).abs() < 1e-15);
        assert_eq!(leaves(point, None), point < lower, "{point}");
    }
    // the point in the middle is opposite to the segment between the upper points 4 and 5
    let [middle, end] = [LOWER as usize / 2, 0];
    for other in [4, 5] {
        assert!(!leaves(middle, Some(lower + other)));
        assert!(leaves(end, Some(lower + other)));
    }
}
