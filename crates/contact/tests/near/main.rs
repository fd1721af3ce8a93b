//! Points within reach have the bits of a pairing of all points, whatever the search remembers; the others face nothing.

use carom_algebra::unknowns::Unknowns;
use carom_contact::law::Displacement;
use carom_contact::{
    Basis, Contact, Frames, Integration, Law, Mortar, Near, OwnPart, Pairing, Places, Point,
    Search, Shape, Sight, Sliding, Sphere, Step, Target,
};
use carom_elements::Kind;
use carom_mesh::{ElementId, Face, Rim, face_nodes};
use carom_testing::Random;

mod halves;
mod shells;

const STEPS: usize = 120;
/// Reach, in edges.
const REACH: f64 = 0.7;
/// Gaps that differ from the reach by the rounding of places do not say on which side of it they are, in edges.
const SAME: f64 = 1e-12;

/// Sheets of squares of one edge length, each `n` by `n`: places and faces, which look up or down.
#[derive(Default)]
struct Scene {
    x: Vec<[f64; 3]>,
    faces: Vec<Face>,
    /// First node of each sheet.
    sheets: Vec<usize>,
}

impl Scene {
    fn add(&mut self, n: u32, corner: [f64; 3], up: bool) {
        let first = self.x.len() as u32;
        self.sheets.push(first as usize);
        for i in 0..(n + 1) * (n + 1) {
            let at = [f64::from(i % (n + 1)), f64::from(i / (n + 1)), 0.0];
            self.x.push([0, 1, 2].map(|k| at[k] + corner[k]));
        }
        for i in 0..n * n {
            let a = first + i % n + (n + 1) * (i / n);
            let nodes = match up {
                true => [a, a + 1, a + n + 2, a + n + 1],
                false => [a, a + n + 1, a + n + 2, a + 1],
            };
            self.faces.push(Face {
                kind: Kind::Quad4,
                nodes: face_nodes(&nodes),
                parent: ElementId { block: 0, index: i },
                axis: [0.0; 3],
                radius: None,
                rim: Rim::default(),
            });
        }
    }

    /// The faces of a sheet.
    fn of(&self, sheet: usize) -> Vec<Face> {
        let end = self.sheets.get(sheet + 1).copied().unwrap_or(self.x.len());
        let own = self.sheets[sheet] as u32..end as u32;
        let faces = self
            .faces
            .iter()
            .filter(|face| own.contains(&face.nodes[0]));
        faces.copied().collect()
    }
}

fn contact(target: Target, points: Vec<Point>) -> Contact {
    Contact {
        name: "near".into(),
        law: Law::Displacement(Displacement::default()),
        sliding: Sliding::Finite,
        integration: Integration::Node,
        points,
        mortar: None,
        target,
        sight: None,
        edges: None,
        offsets: Vec::new(),
        near_only: false,
    }
}

/// Displacements of a step: sheets from the second on come down and go up again, sway and tilt, and all nodes tremble.
fn displacement(scene: &Scene, first: usize, step: f64, random: &mut Random, u: &mut [f64]) {
    let phase = 6.3 * step / STEPS as f64;
    for (node, x) in scene.x.iter().enumerate() {
        let above = node >= first;
        let tilt = 0.3 * phase.sin();
        for i in 0..3 {
            let smooth = match (above, i) {
                (false, _) => 0.0,
                (true, 0) => 0.9 * phase.sin(),
                (true, 1) => 0.4 * (2.0 * phase).sin(),
                (true, _) => -1.6 * (1.0 - phase.cos()) + tilt * (x[0] - 2.5),
            };
            let tremble = 2e-3 * random.between(-1.0, 1.0);
            // all drift along, faster than they move against each other
            u[3 * node + i] = smooth + tremble + 0.05 * step;
        }
    }
}

fn places<'a>(unknowns: &'a Unknowns, scene: &'a Scene, u: &'a [f64]) -> Places<'a> {
    Places {
        unknowns,
        time: 0.0,
        x: &scene.x,
        u,
        frames: Frames::default(),
    }
}

/// How the search is treated.
#[derive(Clone, Copy, Default)]
struct Way {
    /// It is lost now and then.
    forgets: bool,
    /// Steps are a quarter as long, and no gap counts that cannot close.
    short: bool,
    /// Every third point is looked at alone.
    some: bool,
}

struct Seen {
    near: usize,
    far: usize,
    /// Projections of both ways.
    projections: [usize; 2],
}

/// Pairs near points and all points side by side.
fn compare(scene: &Scene, contact: &Contact, first: usize, way: Way) -> Seen {
    let unknowns = Unknowns::translations(3, scene.x.len());
    let mut u = vec![0.0; 3 * scene.x.len()];
    let (mut search, mut whole) = (Search::default(), Search::default());
    let (mut near, mut all, mut initial) =
        (Pairing::default(), Pairing::default(), Pairing::default());
    let contacts = [contact.clone()];
    near.open_all(&contacts, 3);
    let mut random = Random(11);
    let mut gaps = vec![1.0; contact.points.len()];
    let mut seen = Seen {
        near: 0,
        far: 0,
        projections: [0; 2],
    };
    let own: Vec<u32> = (0..contact.points.len() as u32).step_by(3).collect();
    let carriers = own.iter().map(|&point| &contact.points[point as usize]);
    let own_nodes: Vec<u32> = carriers.map(Point::node).collect();
    let parts = if way.short { 4 } else { 1 };
    for step in 0..parts * STEPS {
        let before = u.clone();
        let now = step as f64 / parts as f64;
        displacement(scene, first, now, &mut random, &mut u);
        let places = Places {
            unknowns: &unknowns,
            time: 1e-3 * now,
            x: &scene.x,
            u: &u,
            frames: Frames::default(),
        };
        let start = Places {
            u: &before,
            ..places
        };
        let lost = step == 0 || way.forgets && step % 10 == 0;
        if lost {
            search = Search::default();
        }
        // eight times the largest motion of a node, from a 64th of the reach on; beyond the reach no more than four times
        let motions = u.chunks(3).zip(before.chunks(3));
        let motions = motions.map(|(u, v)| u.iter().zip(v).map(|(u, v)| (u - v).powi(2)).sum());
        let largest = motions.fold(0.0, |most: f64, square: f64| most.max(square));
        let reach = match way.short && !contact.moves() && !way.some {
            true => (8.0 * largest.sqrt()).clamp(REACH / 64.0, REACH.max(4.0 * largest.sqrt())),
            false => REACH,
        };
        all.clear();
        let small = contact.sliding == Sliding::Small;
        if small && initial.is_empty() {
            initial.clear();
            let still = vec![0.0; u.len()];
            let reference = Places {
                u: &still,
                ..places
            };
            contact.pair_fully(&reference, &mut whole, &mut initial);
        }
        match small {
            true => all.append_moved(&initial, &u),
            false => contact.pair_fully(&places, &mut whole, &mut all),
        }
        near.reopen();
        let given = Near {
            start: way.short.then_some(&start),
            first: 0,
            reach: REACH,
            step: way.short.then_some(Step {
                begins: lost,
                at_end: true,
            }),
            inside: &|point| gaps[point] < 0.0,
            initial: &initial,
            own: way.some.then_some(OwnPart {
                points: &own,
                nodes: &own_nodes,
            }),
        };
        contact.pair_near(&places, &mut search, &given, &mut near);
        seen.projections[0] += search.projections();
        seen.projections[1] += whole.projections();
        assert!(near.near().is_sorted());
        for point in 0..contact.points.len() {
            let [found, wanted] = [&near, &all].map(|pairing| pairing.rows.gap(point));
            let at = format!("step {step}, point {point}: {found} for {wanted}");
            assert_eq!(
                found <= reach,
                near.near().contains(&(point as u32)),
                "{at}"
            );
            gaps[point] = found;
            if way.some && point % 3 != 0 {
                assert_eq!(found, f64::INFINITY, "{at}");
                assert_eq!(near.rows.row(point), (&[][..], &[][..]), "{at}");
                continue;
            }
            if wanted > reach + SAME {
                seen.far += 1;
                assert_eq!(found, f64::INFINITY, "{at}");
                assert_eq!(near.rows.row(point), (&[][..], &[][..]), "{at}");
                continue;
            }
            if found == f64::INFINITY && wanted > reach - SAME {
                continue;
            }
            seen.near += 1;
            assert_eq!(found, wanted, "{at}");
            assert_eq!(near.areas[point], all.areas[point], "{at}");
            let pools = [
                (&near.rows, &all.rows),
                (&near.tangents[0], &all.tangents[0]),
            ];
            for (near, all) in pools
                .into_iter()
                .chain([(&near.tangents[1], &all.tangents[1])])
            {
                assert_eq!(near.row(point), all.row(point), "{at}");
                assert_eq!(near.normal(point), all.normal(point), "{at}");
                assert_eq!(near.resultant(point), all.resultant(point), "{at}");
                assert_eq!(near.rate(point), all.rate(point), "{at}");
            }
        }
    }
    seen
}

fn check(scene: &Scene, contact: &Contact, first: usize) -> Seen {
    let seen = compare(scene, contact, first, Way::default());
    assert!(
        seen.near > 300 && seen.far > 300,
        "{} {}",
        seen.near,
        seen.far
    );
    let forgets = Way {
        forgets: true,
        ..Way::default()
    };
    compare(scene, contact, first, forgets);
    let short = Way {
        short: true,
        ..forgets
    };
    let seen = compare(scene, contact, first, short);
    assert!(seen.near > 300, "{}", seen.near);
    seen
}

fn two_sheets() -> Scene {
    let mut scene = Scene::default();
    scene.add(6, [0.0; 3], true);
    scene.add(5, [0.4, 0.3, 3.0], false);
    scene
}

fn nodes_of(scene: &Scene, sheet: usize) -> Vec<Point> {
    let end = scene
        .sheets
        .get(sheet + 1)
        .copied()
        .unwrap_or(scene.x.len());
    let nodes = scene.sheets[sheet] as u32..end as u32;
    nodes.map(|node| Point::at_node(node, 1.0, 1.0)).collect()
}

/// Fewer projections onto faces than where all points are looked at.
fn assert_fewer(seen: &Seen) {
    let [near, all] = seen.projections;
    assert!(near < all, "{near} {all}");
}

#[test]
fn nodes_on_faces() {
    let scene = two_sheets();
    let contact = contact(Target::Surface(scene.of(0)), nodes_of(&scene, 1));
    let seen = check(&scene, &contact, scene.sheets[1]);
    assert_fewer(&seen);
}

#[test]
fn nodes_on_faces_of_small_sliding() {
    let scene = two_sheets();
    let contact = Contact {
        sliding: Sliding::Small,
        ..contact(Target::Surface(scene.of(0)), nodes_of(&scene, 1))
    };
    check(&scene, &contact, scene.sheets[1]);
}

#[test]
fn multipliers_on_faces_and_around_them() {
    for radius in [None, Some(0.1)] {
        let mut scene = two_sheets();
        scene.faces.iter_mut().for_each(|face| face.radius = radius);
        let (mortar, points) = Mortar::new(scene.of(1), &scene.x, |_| 1.0);
        let contact = Contact {
            integration: Integration::Mortar { basis: Basis::Dual },
            mortar: Some(mortar),
            ..contact(Target::Surface(scene.of(0)), points)
        };
        check(&scene, &contact, scene.sheets[1]);
    }
}

/// A ball of radius 3 with this height of its centre, below the middle of the sheets.
fn ball(height: f64) -> carom_contact::Obstacle {
    let obstacle = carom_contact::Obstacle::from(Sphere {
        centre: [2.5, 2.5, height],
        radius: 3.0,
        side: carom_contact::Side::Outside,
    });
    assert!(matches!(obstacle.shape, Shape::Sphere(_)));
    obstacle
}

#[test]
fn nodes_on_a_sphere() {
    let scene = two_sheets();
    let mut target = ball(-3.0);
    target.motion = carom_contact::Motion {
        translation: Some(carom_contact::Translation::Velocity([50.0; 3])),
        turn: None,
    };
    let contact = contact(Target::Rigid(target), nodes_of(&scene, 1));
    check(&scene, &contact, scene.sheets[1]);
}

#[test]
fn some_nodes_on_a_sphere() {
    let scene = two_sheets();
    let contact = contact(Target::Rigid(ball(-0.2)), nodes_of(&scene, 1));
    for (forgets, short) in [(false, false), (true, true)] {
        let way = Way {
            forgets,
            short,
            some: true,
        };
        let seen = compare(&scene, &contact, scene.sheets[1], way);
        assert!(
            seen.near > 50 && seen.far > 50,
            "{} {}",
            seen.near,
            seen.far
        );
    }
}

/// Two plates whose thickness is less than the reach, each with both its sides, and their contact with themselves and each other.
fn two_plates() -> (Scene, Contact) {
    let mut scene = Scene::default();
    scene.add(6, [0.0, 0.0, -0.5], false);
    scene.add(6, [0.0; 3], true);
    scene.add(5, [0.4, 0.3, 3.0], false);
    scene.add(5, [0.4, 0.3, 3.5], true);
    let points = (0..4)
        .flat_map(|sheet| nodes_of(&scene, sheet))
        .collect::<Vec<_>>();
    let sight = Sight::new((&points, &scene.faces), &scene.faces, &scene.x, None);
    let contact = Contact {
        sight: Some(sight),
        ..contact(Target::Surface(scene.faces.clone()), points)
    };
    (scene, contact)
}

#[test]
fn a_surface_on_itself() {
    let (scene, contact) = two_plates();
    let seen = check(&scene, &contact, scene.sheets[2]);
    assert_fewer(&seen);
}

/// An iteration that leads nowhere leaves nothing behind.
#[test]
fn places_that_are_no_numbers_do_no_harm_to_those_after_them() {
    let scene = two_sheets();
    let contact = contact(Target::Surface(scene.of(0)), nodes_of(&scene, 1));
    let unknowns = Unknowns::translations(3, scene.x.len());
    let (mut search, mut near) = (Search::default(), Pairing::default());
    near.open_all(std::slice::from_ref(&contact), 3);
    let nodes = scene.x.len();
    // the upper sheet stays 3 above the lower one, is nowhere, and is 0.1 above it
    let down = |way: f64| {
        let at = |k: usize| {
            if k / 3 >= scene.sheets[1] && k % 3 == 2 {
                way
            } else {
                0.0
            }
        };
        (0..3 * nodes).map(at).collect::<Vec<f64>>()
    };
    let ways = [0.0, 0.0, f64::NAN, f64::NAN, -2.9, -2.9];
    let found = ways.map(|way| {
        let u = if way.is_nan() {
            vec![way; 3 * nodes]
        } else {
            down(way)
        };
        near.reopen();
        let given = Near {
            start: None,
            first: 0,
            reach: REACH,
            step: None,
            inside: &|_| false,
            initial: &Pairing::default(),
            own: None,
        };
        contact.pair_near(
            &places(&unknowns, &scene, &u),
            &mut search,
            &given,
            &mut near,
        );
        near.near().len()
    });
    assert_eq!(found[..2], [0, 0]);
    assert_eq!(found[4..], [36, 36]);
}

/// The bound of the motion is that against the drift.
#[test]
fn sheets_that_fly_together_are_looked_at_once() {
    let scene = two_sheets();
    let contact = contact(Target::Surface(scene.of(0)), nodes_of(&scene, 1));
    let unknowns = Unknowns::translations(3, scene.x.len());
    let (mut search, mut near) = (Search::default(), Pairing::default());
    near.open_all(std::slice::from_ref(&contact), 3);
    for step in 0..20 {
        let u = vec![f64::from(step); 3 * scene.x.len()];
        let places = places(&unknowns, &scene, &u);
        near.reopen();
        let given = Near {
            start: None,
            first: 0,
            reach: REACH,
            step: None,
            inside: &|_| false,
            initial: &Pairing::default(),
            own: None,
        };
        contact.pair_near(&places, &mut search, &given, &mut near);
        // the drift is that of the step before: in the second step nothing is known of it, in the third all are looked at again
        assert_eq!(search.projections() > 0, step < 2, "{step}");
    }
}

/// Boxes are refitted and points looked at in chunks that do not depend on the threads.
#[test]
fn near_points_have_the_same_bits_on_any_number_of_threads() {
    let mut scene = Scene::default();
    // more faces than one thread takes at a time, and several blocks of points
    scene.add(70, [0.0; 3], true);
    scene.add(20, [20.4, 20.3, 0.3], false);
    let contact = contact(Target::Surface(scene.of(0)), nodes_of(&scene, 1));
    let unknowns = Unknowns::translations(3, scene.x.len());
    let run = |threads: usize| {
        let (mut search, mut near) = (Search::default(), Pairing::default());
        near.open_all(std::slice::from_ref(&contact), 3);
        let mut random = Random(5);
        let mut u = vec![0.0; 3 * scene.x.len()];
        let mut found = Vec::new();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            for step in 0..20 {
                displacement(
                    &scene,
                    scene.sheets[1],
                    0.2 * f64::from(step),
                    &mut random,
                    &mut u,
                );
                let places = places(&unknowns, &scene, &u);
                near.reopen();
                let given = Near {
                    start: None,
                    first: 0,
                    reach: REACH,
                    step: None,
                    inside: &|_| true,
                    initial: &Pairing::default(),
                    own: None,
                };
                contact.pair_near(&places, &mut search, &given, &mut near);
                let tangents = near.tangents.clone();
                found.push((near.near().to_vec(), near.rows.clone(), tangents));
            }
        });
        found
    };
    let one = run(1);
    assert!(one.iter().map(|(near, ..)| near.len()).sum::<usize>() > 1000);
    for threads in [2, 4] {
        assert!(run(threads) == one, "{threads}");
    }
}
