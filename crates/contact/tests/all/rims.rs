//! Points beyond the rim of a surface are beside it; where the surface goes on they are before it or behind it.

use carom_algebra::unknowns::Unknowns;
use carom_contact::{Basis, Contact, Frames, Places, Point, Rows, Search, Sight, Target};
use carom_elements::Kind;
use carom_mesh::{Face, Rim};

use crate::fixture::{contact, face, paired};
use crate::pairs::lines;

/// The last node of `x`, over faces with their rims.
fn over(mut faces: Vec<Face>, x: &[[f64; 3]]) -> Contact {
    Rim::mark(&mut faces, |node| x[node as usize], |node| node);
    let point = Point::at_node(x.len() as u32 - 1, 1.0, 1.0);
    contact(vec![point], Target::Surface(faces))
}

fn gap(contact: &Contact, dim: usize, x: &[[f64; 3]]) -> f64 {
    let places = Places {
        unknowns: &Unknowns::translations(dim, x.len()),
        time: 0.0,
        x,
        u: &vec![0.0; dim * x.len()],
        frames: Frames::default(),
    };
    let mut rows = Rows::default();
    rows.clear();
    contact.pair(&places, &mut Search::default(), &mut rows);
    rows.gap(0)
}

/// A place over a strip of two lines along x, from -1 to 1.
fn over_strip(height: f64, point: [f64; 2], origin: f64) -> f64 {
    let mut x = vec![[-1.0, 0.0, 0.0], [0.0, height, 0.0], [1.0, 0.0, 0.0]];
    x.push([point[0], point[1], 0.0]);
    x.iter_mut().for_each(|x| x[0] += origin);
    let faces = vec![face(Kind::Bar2, &[1, 0]), face(Kind::Bar2, &[2, 1])];
    gap(&over(faces, &x), 2, &x)
}

#[test]
fn a_point_beyond_the_rim_faces_nothing_above_the_plane_and_below_it() {
    for beside in [1e-3, 1e-6, 1e-8] {
        for height in [1e-9, 1e-4, 0.5, 10.0] {
            // the root of what two squares lose that cancel is a part of 1.5e-8 of a distance
            if beside < 2e-8 * height {
                continue;
            }
            for height in [height, -height] {
                let found = over_strip(0.0, [1.0 + beside, height], 0.0);
                assert_eq!(found, f64::INFINITY, "{beside} {height}");
                // over the rim and within it the gap is the height
                for x in [1.0, 1.0 - beside] {
                    let found = over_strip(0.0, [x, height], 0.0);
                    assert!((found - height).abs() < 1e-15, "{x} {height} {found}");
                }
            }
        }
    }
}

#[test]
fn the_rim_is_the_same_far_from_the_origin() {
    for beside in [5e-4, 1e-6, -1e-6] {
        for height in [0.2, -0.2, -1e-4] {
            let found = [0.0, 1e6].map(|origin| over_strip(0.0, [1.0 + beside, height], origin));
            let expected = if beside > 0.0 { f64::INFINITY } else { height };
            // heights are not moved, and the rounding of the places along the strip does not turn its normal
            assert_eq!(found, [expected; 2], "{beside} {height}");
        }
    }
    // an ulp of a million is 1.2e-10: matching rims may be some of them apart, which is no way beside
    assert_eq!(over_strip(0.0, [1.0 + 3e-10, -0.2], 1e6), -0.2);
}

#[test]
fn the_rim_of_a_sheet_ends_at_its_border_and_at_corners_that_touch_it() {
    // four squares around the origin; faces look up
    let mut x = Vec::new();
    for i in 0..9 {
        x.push([f64::from(i % 3) - 1.0, f64::from(i / 3) - 1.0, 0.0]);
    }
    let square = |a: u32| face(Kind::Quad4, &[a, a + 1, a + 4, a + 3]);
    let faces: Vec<Face> = [0, 1, 3, 4].map(square).to_vec();
    x.push([0.0; 3]);
    let mut at = |place: [f64; 3]| {
        x[9] = place;
        gap(&over(faces.clone(), &x), 3, &x)
    };
    for height in [0.1, -0.1] {
        assert_eq!(at([1.01, 0.0, height]), f64::INFINITY);
        assert_eq!(at([1.01, 0.7, height]), f64::INFINITY);
        assert_eq!(at([-1.01, -1.01, height]), f64::INFINITY);
        assert!((at([1.0, 0.0, height]) - height).abs() < 1e-15);
        assert!((at([0.0, 0.0, height]) - height).abs() < 1e-15);
    }
}

#[test]
fn a_point_behind_a_fold_and_one_before_a_ridge_face_the_surface() {
    // seen from the middle node, 0.3 away along the bisector: the cosine of the slope times that from either line
    for (height, sign) in [(-0.3, -1.0), (0.3, 1.0)] {
        let found = over_strip(height, [0.0, height + sign * 0.3], 0.0);
        let expected = sign * 0.3 / 1.09_f64.sqrt();
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }
}

/// What runs along a rim from a fold that ends there is not beyond it: whether the closer face is the one or the other is a matter of rounding.
#[test]
fn a_point_behind_the_end_of_a_fold_at_the_rim_faces_the_surface() {
    for (slope, sign) in [(0.3, -1.0), (-0.3, 1.0)] {
        let at = |y: f64| {
            let mut x = Vec::new();
            for j in 0..2 {
                x.extend([-1.0_f64, 0.0, 1.0].map(|x| [x, f64::from(j), slope * x.abs()]));
            }
            x.push([0.0, y, 0.3 * sign]);
            let faces = [[0, 1, 4, 3], [1, 2, 5, 4]];
            let faces = faces.map(|nodes| face(Kind::Quad4, &nodes));
            gap(&over(faces.to_vec(), &x), 3, &x)
        };
        let expected = sign * 0.3 / 1.09_f64.sqrt();
        for y in [0.0, 1e-3, 0.5, 1.0] {
            assert!((at(y) - expected).abs() < 1e-15, "{y} {}", at(y));
        }
        assert_eq!([-1e-4, 1.0001, -0.5].map(at), [f64::INFINITY; 3]);
    }
}

/// A corner of the rim that two triangles share is an end in both directions, though each triangle has one side of it.
#[test]
fn a_point_beyond_a_corner_that_two_triangles_share_is_beside_them() {
    let mut x = vec![
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0; 3],
    ];
    let faces = [[0, 1, 2], [0, 2, 3]].map(|nodes| face(Kind::Tri3, &nodes));
    for height in [0.1, -0.1] {
        for beside in [
            [1.01, 1.0],
            [1.0, 1.01],
            [1.01, 1.01],
            [-0.01, 0.0],
            [0.0, -0.01],
        ] {
            x[4] = [beside[0], beside[1], height];
            assert_eq!(gap(&over(faces.to_vec(), &x), 3, &x), f64::INFINITY);
        }
        x[4] = [1.0, 1.0, height];
        assert!((gap(&over(faces.to_vec(), &x), 3, &x) - height).abs() < 1e-15);
    }
}

#[test]
fn a_point_behind_a_steep_fold_faces_it_however_far_it_is_to_the_side() {
    // the lines fall to the fold by 60°: below it the way to it runs more sideways than along their normals
    let height = -3.0_f64.sqrt();
    let found = over_strip(height, [0.0, height - 0.3], 0.0);
    assert!((found + 0.15).abs() < 1e-15, "{found}");
}

/// A block from -1 to 0 in both axes of which all sides are in the surface, and a node whose own faces look down: it sees the top alone.
/// The side to the right turns by 90° times `lean` from the top.
fn beside_block(point: [f64; 2], lean: f64) -> f64 {
    let (sin, cos) = (lean * std::f64::consts::FRAC_PI_2).sin_cos();
    let mut x = vec![
        [-1.0, -1.0, 0.0],
        [cos, -sin, 0.0],
        [0.0; 3],
        [-1.0, 0.0, 0.0],
    ];
    let sides = [[0, 1], [1, 2], [2, 3], [3, 0]];
    let faces: Vec<Face> = sides.map(|side| face(Kind::Bar2, &side)).to_vec();
    x.push([point[0] - 0.1, point[1], 0.0]);
    x.push([point[0] + 0.1, point[1], 0.0]);
    x.push([point[0], point[1], 0.0]);
    let own = vec![face(Kind::Bar2, &[4, 6]), face(Kind::Bar2, &[6, 5])];
    let mut contact = over(faces.clone(), &x);
    contact.sight = Some(Sight::new((&contact.points, &own), &faces, &x, Some(1.0)));
    gap(&contact, 2, &x)
}

#[test]
fn a_point_that_sees_the_top_of_a_block_alone_is_beside_it_where_it_is_before_its_side() {
    for depth in [1e-3, 0.3, 0.8] {
        assert_eq!(beside_block([0.5 * depth, -depth], 1.0), f64::INFINITY);
        assert!((beside_block([-0.5 * depth, -depth], 1.0) + depth).abs() < 1e-15);
    }
    // above the top and beyond its edge a fall along the normal of the top leads past the block
    assert_eq!(beside_block([0.1, 0.3], 1.0), f64::INFINITY);
    assert!((beside_block([-0.1, 0.3], 1.0) - 0.3).abs() < 1e-15);
    // the side falls by 70°: the point is behind it where it is beyond the edge by less than the depth over the tangent
    let (lean, tangent) = (70.0 / 90.0, 70.0_f64.to_radians().tan());
    let behind = beside_block([0.3 / tangent - 1e-6, -0.3], lean);
    assert!((behind + 0.3).abs() < 1e-15, "{behind}");
    let before = beside_block([0.3 / tangent + 1e-6, -0.3], lean);
    assert_eq!(before, f64::INFINITY);
}

/// The gap of the end of a line 1 cm below the strip from -1 to 1, which is `beside` its rim (m); the other end is `along` from there.
fn end_of_line(beside: f64, along: f64) -> f64 {
    let mut x = vec![[-1.0, 0.0, 0.0], [0.0; 3], [1.0, 0.0, 0.0]];
    x.push([1.0 + beside + along, -0.01, 0.0]);
    x.push([1.0 + beside, -0.01, 0.0]);
    let faces = vec![face(Kind::Bar2, &[1, 0]), face(Kind::Bar2, &[2, 1])];
    let mut contact = over(faces, &x);
    contact.points[0].add_face(&[3, 4]);
    gap(&contact, 2, &x)
}

#[test]
fn flush_sides_that_spread_stay_in_contact_and_a_body_beside_has_none() {
    for beside in [1e-6, 1e-3, 0.02, 0.04] {
        // its own surface is over the other one: a twentieth of a face is what bodies spread by
        let found = end_of_line(beside, -0.5);
        assert!((found + 0.01).abs() < 1e-15, "{beside} {found}");
        // its own surface is beyond the rim
        assert_eq!(end_of_line(beside, 0.5), f64::INFINITY, "{beside}");
    }
    assert_eq!(end_of_line(0.06, -0.5), f64::INFINITY);
}

/// A place over a strip of four lines along x, from 0 to 1, seen by a node whose own faces look down.
fn seen_over_strip(point: [f64; 2]) -> f64 {
    let mut x: Vec<[f64; 3]> = (0..5).map(|i| [0.25 * f64::from(i), 0.0, 0.0]).collect();
    let faces: Vec<Face> = (0..4).map(|a| face(Kind::Bar2, &[a + 1, a])).collect();
    for beside in [-0.1, 0.1, 0.0] {
        x.push([point[0] + beside, point[1], 0.0]);
    }
    let own = vec![face(Kind::Bar2, &[5, 7]), face(Kind::Bar2, &[7, 6])];
    let mut contact = over(faces, &x);
    let Target::Surface(faces) = &contact.target else {
        unreachable!()
    };
    contact.sight = Some(Sight::new((&contact.points, &own), faces, &x, Some(2.0)));
    gap(&contact, 2, &x)
}

#[test]
fn a_point_beside_the_rim_is_not_behind_a_face_further_in_however_deep_it_is() {
    // deeper than one face, two and three are wide: the way to the end of each further face is within 45°
    for depth in [0.1, 0.3, 0.6, 0.9, 1.5] {
        assert_eq!(seen_over_strip([1.01, -depth]), f64::INFINITY, "{depth}");
        assert!((seen_over_strip([0.99, -depth]) + depth).abs() < 1e-15);
    }
}

#[test]
fn the_mean_of_a_face_that_has_fallen_beside_a_surface_and_tilts_takes_nothing_of_it() {
    // the lower left end of the secondary line is 1 mm beside the rim at x = 1 and 20 mm below the plane; tilted by 10°, its shadow, cast
    // along its own normal, covers 2.5 mm of the primary line
    let mut pair = lines(&[1.001, 1.501], &[-1.0, 0.0, 1.0], -0.02, Kind::Bar2);
    let x = pair.x.clone();
    Rim::mark(&mut pair.primary, |node| x[node as usize], |node| node);
    let right = pair.secondary[0].corners()[1] as usize;
    pair.x[right] = [
        1.001 + 0.5 * 0.17_f64.cos(),
        -0.02 + 0.5 * 0.17_f64.sin(),
        0.0,
    ];
    let places = Places {
        unknowns: &pair.unknowns,
        time: 0.0,
        x: &pair.x,
        u: &vec![0.0; 2 * pair.x.len()],
        frames: Frames::default(),
    };
    for basis in [Basis::Standard, Basis::Dual] {
        let pairing = paired(&pair.contact(basis, 1.0), &places);
        for point in 0..pairing.len() {
            assert_eq!(pairing.rows.gap(point), f64::INFINITY, "{basis:?} {point}");
        }
    }
}
