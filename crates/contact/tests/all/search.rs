//! The search with its memory against asking all faces.

use carom_algebra::unknowns::Unknowns;
use carom_contact::{Contact, Frames, Places, Point, Rows, Search, Target};
use carom_elements::Kind;
use carom_mesh::{Face, Rim, project};
use carom_testing::Random;

use crate::fixture::{contact, face};

/// A waving strip or sheet, and points over, under and beside it.
struct Scene {
    dim: usize,
    x: Vec<[f64; 3]>,
    contact: Contact,
    faces: Vec<Face>,
    random: Random,
}

impl Scene {
    /// `side`: faces along a side.
    fn new(kind: Kind, side: u32, points: u32) -> Scene {
        let dim = kind.table().dim + 1;
        let mut random = Random(11);
        let (mut x, mut faces) = match dim {
            2 => strip(side),
            _ => sheet(kind, side),
        };
        Rim::mark(&mut faces, |node| x[node as usize], |node| node);
        let first = x.len() as u32;
        for _ in 0..points {
            let place = [0; 3].map(|_| random.between(-0.3, 1.3) * f64::from(side));
            x.push(match dim {
                2 => [place[0], 0.2 * place[1], 0.0],
                _ => [place[0], place[1], 0.2 * place[2]],
            });
        }
        let points = (first..first + points).map(|node| Point::at_node(node, 1.0, 1.0));
        Scene {
            dim,
            x,
            contact: contact(points.collect(), Target::Surface(faces.clone())),
            faces,
            random,
        }
    }

    /// Everything waves by `size`, and some points jump.
    fn displacement(&mut self, time: f64, size: f64) -> Vec<f64> {
        let dim = self.dim;
        let mut u = vec![0.0; dim * self.x.len()];
        let jumps = self.random.between(0.0, 1.0) < 0.2;
        for (u, x) in u.chunks_exact_mut(dim).zip(&self.x) {
            for (i, u) in u.iter_mut().enumerate() {
                *u = size * (time + 0.7 * x[0] + 0.4 * x[1] + i as f64).sin();
            }
            if jumps && self.random.between(0.0, 1.0) < 0.02 {
                u[0] += self.random.between(-2.0, 2.0);
            }
        }
        u
    }

    /// Gap and normal of a point over the first of the closest of all faces, if it faces it.
    fn brute_force(&self, places: &Places, point: &Point) -> (f64, [f64; 3]) {
        let x = point.place(places);
        let feet = self.faces.iter().map(|face| {
            let positions: Vec<[f64; 3]> =
                face.corners().iter().map(|&node| places.of(node)).collect();
            (project(face, &positions, &x), face)
        });
        let closest = feet.reduce(|best, foot| match foot.0.distance < best.0.distance {
            true => foot,
            false => best,
        });
        let (foot, face) = closest.unwrap();
        let sideways = (foot.distance.powi(2) - foot.gap.powi(2)).max(0.0).sqrt();
        let goes_on = !face.rim.holds(face.kind, &foot.xi);
        match foot.inside || goes_on && (foot.gap < 0.0 || sideways <= foot.gap.abs()) {
            true => (foot.gap, foot.normal),
            false => (f64::INFINITY, [0.0; 3]),
        }
    }
}

fn strip(side: u32) -> (Vec<[f64; 3]>, Vec<Face>) {
    let x = (0..=side).map(|i| [f64::from(i), 0.3 * f64::from(i).sin(), 0.0]);
    let faces = (0..side).map(|i| face(Kind::Bar2, &[i + 1, i]));
    (x.collect(), faces.collect())
}

fn sheet(kind: Kind, side: u32) -> (Vec<[f64; 3]>, Vec<Face>) {
    let n = side + 1;
    let x = (0..n * n).map(|i| {
        let [x, y] = [f64::from(i % n), f64::from(i / n)];
        [x, y, 0.3 * (x + 0.5 * y).sin()]
    });
    let mut faces = Vec::new();
    for i in 0..side * side {
        let a = i % side + n * (i / side);
        match kind {
            Kind::Quad4 => faces.push(face(kind, &[a, a + 1, a + n + 1, a + n])),
            _ => {
                faces.push(face(kind, &[a, a + 1, a + n + 1]));
                faces.push(face(kind, &[a, a + n + 1, a + n]));
            }
        }
    }
    (x.collect(), faces)
}

fn paired(contact: &Contact, places: &Places, search: &mut Search) -> Rows {
    let mut rows = Rows::default();
    rows.clear();
    contact.pair(places, search, &mut rows);
    rows
}

#[test]
fn pairings_of_moving_surfaces_equal_brute_force_whatever_the_search_remembers() {
    for (kind, side) in [(Kind::Bar2, 40), (Kind::Quad4, 9), (Kind::Tri3, 7)] {
        let mut scene = Scene::new(kind, side, 60);
        let mut search = Search::default();
        let mut facing = 0;
        for step in 0..60 {
            // slow, then fast, then standing still
            let time = match step {
                0..30 => 0.02 * f64::from(step),
                30..45 => 0.6 + 0.7 * f64::from(step - 30),
                _ => 11.1,
            };
            let u = scene.displacement(time, 0.5);
            let places = Places {
                unknowns: &Unknowns::translations(scene.dim, scene.x.len()),
                time: 0.0,
                x: &scene.x,
                u: &u,
                frames: Frames::default(),
            };
            let rows = paired(&scene.contact, &places, &mut search);
            assert_eq!(
                rows,
                paired(&scene.contact, &places, &mut Search::default())
            );
            for (k, point) in scene.contact.points.iter().enumerate() {
                let expected = scene.brute_force(&places, point);
                assert_eq!(
                    (rows.gap(k), rows.normal(k)),
                    expected,
                    "{kind:?} {step} {k}"
                );
                facing += usize::from(expected.0.is_finite());
            }
        }
        assert!(facing > 1000, "{kind:?} {facing}");
    }
}

#[test]
fn a_slow_surface_is_hardly_searched() {
    let mut scene = Scene::new(Kind::Quad4, 40, 300);
    let mut search = Search::default();
    let mut projections = 0;
    let shape = scene.displacement(0.0, 0.1);
    for step in 0..12 {
        let u: Vec<f64> = shape.iter().map(|u| 1e-2 * f64::from(step) * u).collect();
        let places = Places {
            unknowns: &Unknowns::translations(3, scene.x.len()),
            time: 0.0,
            x: &scene.x,
            u: &u,
            frames: Frames::default(),
        };
        paired(&scene.contact, &places, &mut search);
        projections = search.projections();
    }
    // of 1600 faces a point asks the one on which its foot was, and those beyond the two edges and the corner that are nearest to
    // the foot; one more for all that the motion of both sides leaves open
    assert!(projections < 300 * 5, "{projections}");
}

#[test]
fn memory_of_other_faces_does_no_harm() {
    let scenes = [
        Scene::new(Kind::Quad4, 6, 30),
        Scene::new(Kind::Tri3, 6, 30),
    ];
    let mut search = Search::default();
    for _ in 0..3 {
        for scene in &scenes {
            let u = vec![0.0; 3 * scene.x.len()];
            let places = Places {
                unknowns: &Unknowns::translations(3, scene.x.len()),
                time: 0.0,
                x: &scene.x,
                u: &u,
                frames: Frames::default(),
            };
            let rows = paired(&scene.contact, &places, &mut search);
            assert_eq!(
                rows,
                paired(&scene.contact, &places, &mut Search::default())
            );
        }
    }
}

/// A sheet that goes forth and back by a face under points that stand, one over each face and as near to it as a part of the face.
/// Faces are numbered along rows, so that the face of the next point is told by that of the last, and nothing else is near: but for the
/// ends of rows one projection a point is enough. Places equal those of a search without memory.
#[test]
fn points_over_a_sheet_that_moves_by_a_face_are_projected_once() {
    let side = 30;
    let (mut x, faces) = sheet(Kind::Quad4, side);
    let first = x.len() as u32;
    for i in 0..side * side {
        let [a, b] = [f64::from(i % side) + 0.3, f64::from(i / side) + 0.6];
        x.push([a, b, 0.3 * (a + 0.5 * b).sin() + 0.2]);
    }
    let points = (first..first + side * side).map(|node| Point::at_node(node, 1.0, 1.0));
    let contact = contact(points.collect(), Target::Surface(faces));
    let mut search = Search::default();
    for step in 0..8 {
        let mut u = vec![0.0; 3 * x.len()];
        let sheet = u[..3 * first as usize].iter_mut().step_by(3);
        sheet.for_each(|u| *u = f64::from(step % 2));
        let places = Places {
            unknowns: &Unknowns::translations(3, x.len()),
            time: 0.0,
            x: &x,
            u: &u,
            frames: Frames::default(),
        };
        let rows = paired(&contact, &places, &mut search);
        let projections = search.projections() as f64 / f64::from(side * side);
        assert!(step == 0 || projections < 1.3, "{step}: {projections}");
        assert_eq!(rows, paired(&contact, &places, &mut Search::default()));
    }
}

#[test]
fn memory_of_the_search_is_some_eighty_bytes_for_a_face() {
    let scene = Scene::new(Kind::Quad4, 100, 1);
    let u = vec![0.0; 3 * scene.x.len()];
    let places = Places {
        unknowns: &Unknowns::translations(3, scene.x.len()),
        time: 0.0,
        x: &scene.x,
        u: &u,
        frames: Frames::default(),
    };
    let mut search = Search::default();
    paired(&scene.contact, &places, &mut search);
    // a box of 48 bytes, two numbers of 4, and a node of 192 for eight faces with those above it: 83, and what nodes that are not full
    // cost
    let per_face = search.bytes() / scene.faces.len();
    assert!((83..100).contains(&per_face), "{per_face}");
}

#[test]
fn a_point_that_comes_back_twice_in_a_step_stays_with_its_face() {
    let x = vec![[-1.0, 0.1, 0.0], [0.0; 3], [1.0, 0.1, 0.0], [0.0; 3]];
    let faces = vec![face(Kind::Bar2, &[1, 0]), face(Kind::Bar2, &[2, 1])];
    let contact = contact(vec![Point::at_node(3, 1.0, 1.0)], Target::Surface(faces));
    let normals = |search: &mut Search| {
        let sides = [-0.01, 0.01, -0.01, 0.01, -0.01, -0.01];
        sides.map(|side| {
            let places = Places {
                unknowns: &Unknowns::translations(2, x.len()),
                time: 0.0,
                x: &x,
                u: &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, side, 0.002],
                frames: Frames::default(),
            };
            let rows = paired(&contact, &places, search);
            let held = contact.held(&places, search);
            (rows.normal(0)[0] < 0.0, rows.gap(0), held)
        })
    };
    let mut search = Search::default();
    // the normal of the face to the right leans to the left
    let free = [false, true, false, true, false, false];
    assert_eq!(normals(&mut search).map(|(right, ..)| right), free);
    search.begin_step();
    let ways = normals(&mut search);
    // to the right for the second time, it stays there
    assert_eq!(
        ways.clone().map(|(right, ..)| right),
        [false, true, false, true, true, true]
    );
    let (_, gap, held) = &ways[5];
    // over the line of the face to the right, where the face to the left is closer
    let [left, right] = [-1.0, 1.0].map(|side: f64| (0.002 - side * 0.1 * -0.01) / 1.01_f64.sqrt());
    assert!((gap - right).abs() < 1e-15, "{gap} {right}");
    let error = (right - left) / 1.01_f64.sqrt();
    assert!((held[0].error - error).abs() < 1e-15 && ways[2].2.is_empty());
    search.begin_step();
    assert_eq!(normals(&mut search)[..3], ways[..3], "a new step forgets");
}

/// An iteration that leads nowhere leaves nothing behind.
#[test]
fn places_that_are_no_numbers_do_no_harm_to_those_after_them() {
    let scene = Scene::new(Kind::Quad4, 10, 40);
    let unknowns = Unknowns::translations(3, scene.x.len());
    let still = vec![0.0; 3 * scene.x.len()];
    let places = |u| Places {
        unknowns: &unknowns,
        time: 0.0,
        x: &scene.x,
        u,
        frames: Frames::default(),
    };
    let mut search = Search::default();
    let before = paired(&scene.contact, &places(&still), &mut search);
    let nowhere = vec![f64::NAN; still.len()];
    for _ in 0..3 {
        paired(&scene.contact, &places(&nowhere), &mut search);
    }
    let after = paired(&scene.contact, &places(&still), &mut search);
    assert!(after == before);
    assert!((0..after.len()).any(|point| after.gap(point).is_finite()));
}
