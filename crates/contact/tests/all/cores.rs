//! Two cores that move, against the distances of all their triangles by another way, at many instants.

use carom_contact::certificate::{Core, Look, Moved, Room, look, overlap};
use carom_elements::Kind;
use carom_testing::Random;

use crate::certificate::{Vec3, distance};

/// Distance that is kept from each, m.
const KEPT: f64 = 5e-3;

const TRIANGLES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

/// A tetrahedron whose vertices are nodes.
fn tetrahedron() -> Core {
    let vertices: Vec<(Vec<(u32, f64)>, f64)> =
        (0..4).map(|node| (vec![(node, 1.0)], KEPT)).collect();
    let patches = TRIANGLES.map(|corners| (Kind::Tri3, corners.to_vec()));
    Core::new(&vertices, &patches, |node| {
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]][node as usize]
    })
}

fn corners(random: &mut Random, about: Vec3) -> [Vec3; 4] {
    [0; 4].map(|_| [0, 1, 2].map(|i| about[i] + random.next()))
}

fn at(ends: &[[Vec3; 4]; 2], t: f64) -> [Vec3; 4] {
    [0, 1, 2, 3].map(|k| [0, 1, 2].map(|i| (1.0 - t) * ends[0][k][i] + t * ends[1][k][i]))
}

/// Distance of the surfaces of two tetrahedra.
fn apart(one: &[Vec3; 4], other: &[Vec3; 4]) -> f64 {
    let faces = |of: &[Vec3; 4]| TRIANGLES.map(|corners| corners.map(|k| of[k as usize]));
    let mut least = f64::INFINITY;
    for a in faces(one) {
        for b in faces(other) {
            least = least.min(distance(&a, &b));
        }
    }
    least
}

fn found(core: &Core, one: &[[Vec3; 4]; 2], other: &[[Vec3; 4]; 2]) -> Look {
    let sides = [one, other].map(|ends| Moved {
        core,
        before: &ends[0],
        after: &ends[1],
        part: 1.0,
    });
    look(sides, 3, &mut Room::default())
}

/// Two that come as near as they are to keep at any of many instants have met; two that have not may move towards each other by less than their
/// distance at the end; and what flies along with both changes nothing.
#[test]
fn cores_that_have_not_met_stayed_apart() {
    let (core, mut random) = (tetrahedron(), Random(17));
    let (mut met, mut clear, mut alarms) = (0, 0, 0);
    for round in 0..240 {
        let away: Vec3 = [0; 3].map(|_| 2.5 * random.next());
        let away = away.map(|x| x + 1.2 * x.signum());
        let one = [corners(&mut random, [0.0; 3]); 2];
        let start = corners(&mut random, away);
        let speed = [0.3, 1.0, 2.5][round % 3];
        let turns = [0.0, 0.5][round % 2];
        let end = start.map(|x| [0, 1, 2].map(|i| x[i] - speed * away[i] + turns * random.next()));
        let other = [start, end];
        if apart(&one[0], &other[0]) < 3.0 * KEPT {
            continue;
        }
        let look = found(&core, &one, &other);
        let least = (0..=24).map(|k| {
            let t = f64::from(k) / 24.0;
            apart(&at(&one, t), &at(&other, t))
        });
        let least = least.fold(f64::INFINITY, f64::min);
        match look.met {
            Some(meeting) => {
                met += 1;
                let near = apart(&at(&one, meeting.part), &at(&other, meeting.part));
                alarms += usize::from(near > 2.2 * KEPT * (1.0 + 1e-6));
            }
            None => {
                clear += 1;
                assert!(least >= 2.0 * KEPT, "round {round}: {least}");
                let left = apart(&one[1], &other[1]);
                assert!(
                    look.apart <= left,
                    "round {round}: {} of {left}",
                    look.apart
                );
            }
        }
        let shift = [40.0, -7.0, 11.0];
        let along = |ends: &[[Vec3; 4]; 2]| {
            let moved = ends[1].map(|x| [0, 1, 2].map(|i| x[i] + shift[i]));
            [ends[0], moved]
        };
        let beside = found(&core, &along(&one), &along(&other));
        assert_eq!(beside.met.is_some(), look.met.is_some(), "round {round}");
        assert!((beside.apart - look.apart).abs() < 1e-10, "round {round}");
    }
    assert!(met > 40 && clear > 40, "{met} met, {clear} clear");
    assert_eq!(alarms, 0, "of {met}");
}

/// Cores far apart are not looked at, and may move by what their boxes are apart.
#[test]
fn boxes_tell_of_cores_that_are_far() {
    let (core, mut random) = (tetrahedron(), Random(3));
    let one = [corners(&mut random, [0.0; 3]); 2];
    let other = [corners(&mut random, [100.0, 0.0, 0.0]); 2];
    let look = found(&core, &one, &other);
    assert_eq!((look.met, look.tested), (None, 0));
    assert!(look.apart > 97.0 && look.apart < apart(&one[1], &other[1]));
}

/// Tetrahedra of which an edge goes through a face of the other overlap, without a node near a face; one that is wholly inside another does not.
#[test]
fn an_edge_through_a_face_is_an_overlap() {
    let core = tetrahedron();
    let large = [
        [0.0, 0.0, 0.0],
        [9.0, 0.0, 0.0],
        [0.0, 9.0, 0.0],
        [0.0, 0.0, 9.0],
    ];
    let moved = |shift: Vec3, size: f64| -> [Vec3; 4] {
        let unit = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        unit.map(|x| [0, 1, 2].map(|i| shift[i] + size * x[i]))
    };
    let mut room = Room::default();
    for (shift, size, overlaps) in [
        ([1.0, 1.0, -0.5], 1.0, true),
        ([1.0, 1.0, 1.0], 1.0, false),
        ([1.0, 1.0, -1.5], 1.0, false),
        ([-2.0, -2.0, -2.0], 1.0, false),
    ] {
        let small = moved(shift, size);
        let cores = [&large, &small].map(|at| Moved {
            core: &core,
            before: at,
            after: at,
            part: 1.0,
        });
        assert_eq!(overlap(cores, 3, &mut room), overlaps, "{shift:?}");
    }
}
