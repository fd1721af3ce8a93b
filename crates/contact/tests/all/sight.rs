//! Surfaces that face themselves, and thin parts.

use carom_algebra::unknowns::Unknowns;
use carom_contact::{
    Basis, Contact, Frames, Integration, Mortar, Places, Point, Rows, Search, Sight, Target,
};
use carom_elements::Kind;
use carom_mesh::Face;

use crate::fixture::{contact, face};

/// Length of a leg, thickness, and what is open between the legs, m.
const LEG: f64 = 2.0;
const THICK: f64 = 0.1;
const OPEN: f64 = 0.3;
/// Segments of a leg and of a round bend.
const ALONG: u32 = 20;
const ROUND: u32 = 12;

/// A strip folded to a U that opens to the left: its outline, lower side first, then round and back inside.
struct Fold {
    x: Vec<[f64; 3]>,
    faces: Vec<Face>,
    /// Nodes of one side.
    side: u32,
}

impl Fold {
    /// `round`: segments of the bend.
    fn new(round: u32) -> Fold {
        let middle = 0.5 * (OPEN + THICK);
        let count = 2 * ALONG + round;
        let place = |k: u32, off: f64| {
            // along the middle line, the middle of the bend being at (LEG, 0)
            let radius = middle + off;
            if k <= ALONG {
                [LEG * f64::from(k) / f64::from(ALONG), -radius, 0.0]
            } else if k < ALONG + round {
                let angle = std::f64::consts::PI * f64::from(k - ALONG) / f64::from(round);
                [LEG + radius * angle.sin(), -radius * angle.cos(), 0.0]
            } else {
                let k = count - k;
                [LEG * f64::from(k) / f64::from(ALONG), radius, 0.0]
            }
        };
        let outer = (0..=count).map(|k| place(k, 0.5 * THICK));
        let inner = (0..=count).rev().map(|k| place(k, -0.5 * THICK));
        let x: Vec<[f64; 3]> = outer.chain(inner).collect();
        let n = x.len() as u32;
        Fold {
            faces: (0..n)
                .map(|k| face(Kind::Bar2, &[k, (k + 1) % n]))
                .collect(),
            side: count + 1,
            x,
        }
    }

    fn contact(&self, depth: Option<f64>) -> Contact {
        let n = self.x.len() as u32;
        let points: Vec<Point> = (0..n).map(|k| Point::at_node(k, 1.0, 1.0)).collect();
        let sight = Sight::new((&points, &self.faces), &self.faces, &self.x, depth);
        let mut contact = contact(points, Target::Surface(self.faces.clone()));
        contact.sight = Some(sight);
        contact
    }

    /// Node of the inner side at the place `k` along the strip.
    fn inner(&self, k: u32) -> usize {
        (2 * self.side - 1 - k) as usize
    }

    /// The upper leg turns down about its root until its tip has come closer to the lower leg by `way`.
    fn pressed(&self, way: f64) -> Vec<f64> {
        let down = |x: &[f64; 3]| match x[1] > 0.0 {
            true => -way * (1.0 - x[0] / LEG).max(0.0),
            false => 0.0,
        };
        self.x.iter().flat_map(|x| [0.0, down(x)]).collect()
    }

    fn rows(&self, contact: &Contact, u: &[f64], search: &mut Search) -> Rows {
        let places = Places {
            unknowns: &Unknowns::translations(2, self.x.len()),
            time: 0.0,
            x: &self.x,
            u,
            frames: Frames::default(),
        };
        let mut rows = Rows::default();
        rows.clear();
        contact.pair(&places, search, &mut rows);
        rows
    }
}

#[test]
fn a_folded_strip_sees_its_other_leg_and_never_its_far_side() {
    let fold = Fold::new(ROUND);
    let contact = fold.contact(None);
    assert!(Sight::is_needed(&fold.faces, &fold.faces));
    let mut search = Search::default();
    // down to a penetration of 0.4 times the thickness at the tip; slowly, so that the search uses its memory
    for step in 0..=40 {
        let way = (OPEN + 0.4 * THICK) * f64::from(step) / 40.0;
        let u = fold.pressed(way);
        let rows = fold.rows(&contact, &u, &mut search);
        assert_eq!(rows, fold.rows(&contact, &u, &mut Search::default()));
        // the lower leg is straight and at rest: gaps of the upper one over it are exact
        for k in 0..ALONG - 1 {
            let node = fold.inner(2 * ALONG + ROUND - k);
            let gap = fold.x[node][1] + u[2 * node + 1] + 0.5 * OPEN;
            assert!(
                (rows.gap(node) - gap).abs() < 1e-14,
                "{way} {k} {gap} {:?}",
                rows.gap(node)
            );
            assert_eq!(rows.normal(node), [0.0, 1.0, 0.0]);
        }
        // outside there is nothing to face, though the far side is only a thickness behind
        for node in 0..fold.side as usize {
            assert_eq!(rows.gap(node), f64::INFINITY, "{node}");
        }
    }
}

#[test]
fn where_a_strip_bends_sharply_it_does_not_see_its_far_side_either() {
    // two segments, at 83° inside: the point there that is closest to the outer tip of the bend is an edge, neither of whose
    // faces the tip faces
    let mut fold = Fold::new(2);
    let tip = fold.inner(ALONG + 1);
    fold.x[tip][0] += 0.02;
    let (mortar, points) = Mortar::new(fold.faces.clone(), &fold.x, |_| 1.0);
    let sight = Sight::new((&points, &fold.faces), &fold.faces, &fold.x, None);
    let mut contact = contact(points, Target::Surface(fold.faces.clone()));
    contact.integration = Integration::Mortar {
        basis: Basis::Standard,
    };
    (contact.mortar, contact.sight) = (Some(mortar), Some(sight));
    let rows = fold.rows(&contact, &fold.pressed(0.0), &mut Search::default());
    for node in 0..fold.side as usize {
        assert_eq!(rows.gap(node), f64::INFINITY, "{node}");
    }
}

#[test]
fn deeper_than_half_the_thickness_or_than_allowed_is_no_contact() {
    let fold = Fold::new(ROUND);
    let tip = fold.inner(2 * ALONG + ROUND);
    let gap = |depth: Option<f64>, part: f64| {
        let contact = fold.contact(depth);
        let u = fold.pressed(OPEN + part * THICK);
        let rows = fold.rows(&contact, &u, &mut Search::default());
        rows.gap(tip)
    };
    assert!((gap(None, 0.45) + 0.45 * THICK).abs() < 1e-14);
    assert_eq!(gap(None, 0.55), f64::INFINITY);
    assert!((gap(Some(0.3 * THICK), 0.25) + 0.25 * THICK).abs() < 1e-14);
    assert_eq!(gap(Some(0.3 * THICK), 0.35), f64::INFINITY);
}

#[test]
fn a_node_deep_in_a_thin_plate_is_pushed_back_to_the_side_it_came_from() {
    // a plate between y = 0 and y = 0.1, and above it the lower side of a block that has sunk in by 0.07
    let x = [
        [-1.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 0.1, 0.0],
        [-1.0, 0.1, 0.0],
        [0.0, 0.03, 0.0],
        [1.0, 0.03, 0.0],
    ];
    let plate = [0, 1, 2, 3].map(|k| face(Kind::Bar2, &[k, (k + 1) % 4]));
    let block = [face(Kind::Bar2, &[4, 5])];
    let points = vec![Point::at_node(4, 0.5, 0.5), Point::at_node(5, 0.5, 0.5)];
    assert!(!Sight::is_needed(&block, &plate));
    let sight = Sight::new((&points, &block), &plate, &x, Some(0.1));
    let mut contact = contact(points, Target::Surface(plate.to_vec()));
    let places = Places {
        unknowns: &Unknowns::translations(2, x.len()),
        time: 0.0,
        x: &x,
        u: &[0.0; 12],
        frames: Frames::default(),
    };
    let mut gaps = |sight| {
        contact.sight = sight;
        let mut rows = Rows::default();
        rows.clear();
        contact.pair(&places, &mut Search::default(), &mut rows);
        rows
    };
    // the closest face is the far one, and would pull the block through
    assert!((gaps(None).gap(0) + 0.03).abs() < 1e-15);
    let rows = gaps(Some(sight));
    for point in 0..2 {
        assert!((rows.gap(point) + 0.07).abs() < 1e-15);
        assert_eq!(rows.normal(point), [0.0, 1.0, 0.0]);
    }
}

/// The ridge of a sharp wedge along a plane: all its nodes see the plane, though the middle one is pressed up by a thousandth of an edge. The normals
/// of its faces make 101° with that of the plane: neither is turned against it.
#[test]
fn all_nodes_of_a_ridge_see_what_it_points_at() {
    let (half, height) = (0.2, 1.0);
    let mut x = Vec::new();
    for k in 0..3 {
        let y = f64::from(k) - 1.0;
        x.extend([
            [0.0, y, 0.1],
            [half, y, 0.1 + height],
            [-half, y, 0.1 + height],
        ]);
    }
    x[3][2] += 1e-3;
    let floor = x.len() as u32;
    x.extend([
        [-2.0, -2.0, 0.0],
        [2.0, -2.0, 0.0],
        [2.0, 2.0, 0.0],
        [-2.0, 2.0, 0.0],
    ]);
    let flank = |k: u32| {
        let (one, next) = (3 * k, 3 * (k + 1));
        [
            face(Kind::Quad4, &[one, next, next + 1, one + 1]),
            face(Kind::Quad4, &[one, one + 2, next + 2, next]),
        ]
    };
    let flanks: Vec<Face> = (0..2).flat_map(flank).collect();
    let target = vec![face(Kind::Quad4, &[floor, floor + 1, floor + 2, floor + 3])];
    let points: Vec<Point> = (0..3).map(|k| Point::at_node(3 * k, 1.0, 1.0)).collect();
    let sight = Sight::new((&points, &flanks), &target, &x, Some(0.5));
    let mut contact = contact(points, Target::Surface(target));
    contact.sight = Some(sight);
    let unknowns = Unknowns::translations(3, x.len());
    let u = vec![0.0; 3 * x.len()];
    let places = Places {
        unknowns: &unknowns,
        time: 0.0,
        x: &x,
        u: &u,
        frames: Frames::default(),
    };
    let mut rows = Rows::default();
    contact.pair(&places, &mut Search::default(), &mut rows);
    for (point, gap) in [0.1, 0.101, 0.1].into_iter().enumerate() {
        assert!(
            (rows.gap(point) - gap).abs() < 1e-15,
            "{point}: {}",
            rows.gap(point)
        );
    }
}
