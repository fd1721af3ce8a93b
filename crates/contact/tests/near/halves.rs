//! Two processes that have the points of one half each, and the faces that these may touch.

use super::shells::shell_over;
use super::*;

/// Each of two processes has the points of one half and the faces that these may touch; the faces are found anew before a node can have moved
/// further than was assumed. `reach` and `motion`: how far points look and how far that is, in edges. Near points, the mean part of the faces that a process has, and the part of looks at
/// points that was left out.
fn compare_halves(
    scene: &Scene,
    contact: &Contact,
    first: usize,
    [reach, motion]: [f64; 2],
) -> (usize, [f64; 2]) {
    let unknowns = Unknowns::translations(3, scene.x.len());
    let mut u = vec![0.0; 3 * scene.x.len()];
    let mut since = f64::INFINITY;
    let Target::Surface(faces) = &contact.target else {
        unreachable!()
    };
    let nodes: Vec<u32> = (0..scene.x.len() as u32).collect();
    let (mut random, mut whole, mut all) = (Random(3), Search::default(), Pairing::default());
    let mut gaps = vec![1.0; contact.points.len()];
    let (mut near_points, mut kept_faces, mut looks, mut rested) = (0, 0, 0, 0);
    let mut lists: Vec<Vec<u32>> = vec![Vec::new(); contact.points.len()];
    let (mut wakes, mut travelled) = (vec![f64::NEG_INFINITY; lists.len()], 0.0);
    let mut halves: Vec<(Contact, Vec<u32>, Search)> = Vec::new();
    let parts = 8;
    for step in 0..parts * STEPS {
        let before = u.clone();
        let now = step as f64 / f64::from(parts as u32);
        displacement(scene, first, now, &mut random, &mut u);
        let ways = u.chunks(3).zip(before.chunks(3));
        let ways = ways.map(|(u, v)| u.iter().zip(v).map(|(u, v)| (u - v).powi(2)).sum::<f64>());
        let way = ways.fold(0.0, f64::max).sqrt();
        since += way;
        if since >= motion {
            since = way;
            looks += 1;
            let at = places(&unknowns, scene, &before);
            let inside = |point: usize| gaps[point] < 0.0;
            // points that are further than a look ahead are not looked at
            let due: Vec<u32> = (0..contact.points.len() as u32).collect();
            let due: Vec<u32> = due
                .into_iter()
                .filter(|&k| wakes[k as usize] <= travelled + motion)
                .collect();
            let found = contact.in_reach(
                (&at, travelled),
                &mut whole,
                [reach, REACH, motion],
                (&due, inside),
            );
            for (&k, found) in due.iter().zip(found) {
                let rests = found.faces.is_empty();
                wakes[k as usize] = travelled
                    + if rests {
                        found.clearance
                    } else {
                        f64::NEG_INFINITY
                    };
                lists[k as usize] = found.faces.into_iter().map(|(face, _)| face).collect();
            }
            rested += (contact.points.len() - due.len()) as u32;
            let half = |side: bool| {
                let own = |k: &u32| {
                    (scene.x[contact.points[*k as usize].node() as usize][0] < 2.5) == side
                };
                let looked = (0..contact.points.len() as u32).filter(own);
                let looked: Vec<u32> = looked.filter(|&k| !lists[k as usize].is_empty()).collect();
                let mut kept: Vec<u32> = looked
                    .iter()
                    .flat_map(|&k| lists[k as usize].clone())
                    .collect();
                kept.sort_unstable();
                kept.dedup();
                kept_faces += kept.len();
                (contact.with_some_faces(&kept), looked, Search::default())
            };
            halves = [true, false].map(half).into();
        }
        travelled += way;
        let now = places(&unknowns, scene, &u);
        all.open_all(std::slice::from_ref(contact), 3);
        let (inside, initial) = (|point: usize| gaps[point] < 0.0, Pairing::default());
        let near = |own| Near {
            start: None,
            first: 0,
            reach,
            step: None,
            inside: &inside,
            initial: &initial,
            own,
        };
        contact.pair_near(&now, &mut Search::default(), &near(None), &mut all);
        let mut found = Pairing::default();
        found.open_all(std::slice::from_ref(contact), 3);
        for (half, points, search) in &mut halves {
            let own = OwnPart {
                points,
                nodes: &nodes,
            };
            half.pair_near(&now, search, &near(Some(own)), &mut found);
        }
        near_points += all.near().len();
        let mut both = found.near().to_vec();
        both.sort_unstable();
        assert_eq!(both, all.near(), "step {step}");
        for &point in all.near() {
            let point = point as usize;
            assert_eq!(found.rows.gap(point), all.rows.gap(point), "step {step}");
            assert_eq!(found.rows.row(point), all.rows.row(point), "step {step}");
        }
        for (point, gap) in gaps.iter_mut().enumerate() {
            *gap = all.rows.gap(point);
        }
    }
    let mean = kept_faces as f64 / f64::from(2 * looks);
    let rested = f64::from(rested) / (f64::from(looks) * contact.points.len() as f64);
    (near_points, [mean / faces.len() as f64, rested])
}

#[test]
fn faces_in_reach_are_all_that_a_part_of_the_points_needs() {
    let scene = two_sheets();
    let sheets = contact(Target::Surface(scene.of(0)), nodes_of(&scene, 1));
    let (plates, itself) = two_plates();
    let [(block, on_block), (shell, on_shell)] = [false, true].map(shell_over);
    let cases = [
        (&scene, &sheets, scene.sheets[1]),
        (&plates, &itself, plates.sheets[2]),
        (&block, &on_block, block.sheets[2]),
        (&shell, &on_shell, shell.sheets[1]),
    ];
    for (scene, contact, first) in cases {
        for [reach, motion] in [[0.1, 0.05], [REACH, 0.2], [REACH, 0.5 * REACH]] {
            let (near, [faces, rested]) = compare_halves(scene, contact, first, [reach, motion]);
            // half of a sheet of six, what is within the distance and the motions around it, and a face that is cut; points with a sight
            // have the faces across the edges of these too
            // and middles are as far from what touches them as they are thick
            let thick = contact.thickest();
            let around = f64::sqrt(2.0) * (reach + thick) + 2.0 * motion;
            let across = if contact.sight.is_some() { 1.0 } else { 0.0 };
            let part = (3.0 + around + 1.0 + across) / 6.0;
            assert!(
                near > 1000 && (faces < part || part >= 1.0),
                "{near} {faces}"
            );
            assert!(reach == REACH || thick > 0.0 || rested > 0.1, "{rested}");
        }
    }
}
