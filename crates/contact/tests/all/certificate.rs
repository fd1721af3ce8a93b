//! Pieces of surfaces that move along straight lines, against distances by another way: the least of |Σ λ_i a_i - Σ μ_j b_j| over all faces of
//! both pieces, at many instants.

use carom_contact::certificate::{Moving, meeting};
use carom_testing::Random;

pub(crate) type Vec3 = [f64; 3];

fn sub(a: &Vec3, b: &Vec3) -> Vec3 {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn dot(a: &Vec3, b: &Vec3) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// Distance of the hulls of some points: for each choice of corners of both the least distance of the flats through them, where its place lies
/// inside both.
pub(crate) fn distance(one: &[Vec3], other: &[Vec3]) -> f64 {
    let subsets =
        |n: usize| (1..1usize << n).map(move |bits| (0..n).filter(move |k| bits >> k & 1 == 1));
    let mut least = f64::INFINITY;
    for a in subsets(one.len()) {
        let a: Vec<&Vec3> = a.map(|k| &one[k]).collect();
        for b in subsets(other.len()) {
            let b: Vec<&Vec3> = b.map(|k| &other[k]).collect();
            let base = sub(a[0], b[0]);
            let own = a[1..].iter().map(|x| sub(x, a[0]));
            let theirs = b[1..].iter().map(|x| sub(b[0], x));
            let ways: Vec<Vec3> = own.chain(theirs).collect();
            let Some(parts) = least_squares(&ways, &base) else {
                continue;
            };
            let (own, theirs) = parts.split_at(a.len() - 1);
            let inside =
                |parts: &[f64]| parts.iter().all(|x| *x >= 0.0) && parts.iter().sum::<f64>() <= 1.0;
            if inside(own) && inside(theirs) {
                let left = [0, 1, 2].map(|i| {
                    base[i]
                        + ways
                            .iter()
                            .zip(&parts)
                            .map(|(way, x)| x * way[i])
                            .sum::<f64>()
                });
                least = least.min(dot(&left, &left).sqrt());
            }
        }
    }
    least
}

/// The x with the least |base + Σ x_k ways_k|; nothing where the ways depend on each other.
fn least_squares(ways: &[Vec3], base: &Vec3) -> Option<Vec<f64>> {
    let n = ways.len();
    let mut a: Vec<Vec<f64>> = ways
        .iter()
        .map(|one| {
            ways.iter()
                .map(|other| dot(one, other))
                .chain([-dot(one, base)])
                .collect()
        })
        .collect();
    let scale = (0..n).map(|k| a[k][k]).fold(0.0, f64::max);
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))?;
        a.swap(k, pivot);
        if a[k][k].abs() <= 1e-12 * scale {
            return None;
        }
        let row = a[k].clone();
        for (i, other) in a.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = other[k] / row[k];
            other
                .iter_mut()
                .zip(&row)
                .for_each(|(x, y)| *x -= factor * y);
            let _ = i;
        }
    }
    Some((0..n).map(|k| a[k][n] / a[k][k]).collect())
}

fn place(random: &mut Random, size: f64) -> Vec3 {
    [0; 3].map(|_| size * random.next())
}

/// A piece of so many corners about a place, which moves by `motion` and turns and stretches by `change` of its size.
fn piece(
    random: &mut Random,
    corners: usize,
    (about, size): (Vec3, f64),
    (motion, change): (Vec3, f64),
) -> Vec<Moving> {
    let corner = |_| {
        let from = place(random, size);
        let more = place(random, change * size);
        Moving {
            start: [0, 1, 2].map(|i| about[i] + from[i]),
            end: [0, 1, 2].map(|i| about[i] + from[i] + motion[i] + more[i]),
        }
    };
    (0..corners).map(corner).collect()
}

fn at(piece: &[Moving], t: f64) -> Vec<Vec3> {
    piece.iter().map(|corner| corner.at(t)).collect()
}

/// Pieces: node and triangle, triangle and node, two edges, node and edge, two nodes.
const KINDS: [[usize; 2]; 5] = [[1, 3], [3, 1], [2, 2], [1, 2], [1, 1]];

/// No pair that stays apart comes nearer than asked at any of many instants, and one that is told to meet is as near as told at its instant:
/// pieces of all sizes, slow and fast, in flat and sharp shapes, far from the origin.
#[test]
fn pieces_that_stay_apart_do_and_those_that_meet_are_near() {
    let mut random = Random(41);
    let (mut met, mut alarms, mut apart) = (0, 0, 0);
    for round in 0..4000 {
        let [a, b] = KINDS[round % KINDS.len()];
        let flat = round % 7 == 0;
        let far = if round % 11 == 0 { 1e3 } else { 0.0 };
        let delta = [1e-2, 1e-3, 1e-5][round % 3];
        let spread = [1.0, 3.0][round % 2];
        let change = [0.0, 0.3, 3.0][(round / 3) % 3];
        let middle = place(&mut random, 1.0).map(|x| spread * x);
        let motion = middle.map(|x| -2.0 * x + 0.3 * random.next());
        let mut one = piece(&mut random, a, ([far; 3], 1.0), ([0.0; 3], change));
        let mut other = piece(
            &mut random,
            b,
            ([0, 1, 2].map(|i| far + middle[i]), 1.0),
            (motion, change),
        );
        if flat {
            for corner in one.iter_mut().chain(&mut other) {
                (corner.start[2], corner.end[2]) = (far, far);
            }
        }
        let found = meeting(&one, &other, delta);
        let near = |t: f64| distance(&at(&one, t), &at(&other, t));
        match found {
            None => {
                apart += 1;
                let least = (0..=400)
                    .map(|k| near(k as f64 / 400.0))
                    .fold(f64::INFINITY, f64::min);
                assert!(
                    least >= delta * (1.0 - 1e-9) - 1e-10,
                    "round {round}: {least:e} of {delta:e}"
                );
            }
            Some(t) => {
                met += 1;
                if near(t) > 1.1 * delta * (1.0 + 1e-6) + 1e-9 {
                    alarms += 1;
                }
            }
        }
    }
    // both kinds come up, and alarms are those of pairs that never come to an end
    assert!(apart > 300 && met > 300, "{apart} apart, {met} met");
    assert!(alarms * 100 < met, "{alarms} false alarms of {met}");
}

/// A node that crosses a triangle in one step, an edge that crosses another, and the same pieces that just miss each other.
#[test]
fn what_crosses_in_one_step_meets_and_what_misses_does_not() {
    let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Moving::still);
    let node = |x: f64| {
        [Moving {
            start: [x, 0.2, 1.0],
            end: [x, 0.2, -9.0],
        }]
    };
    let t = meeting(&node(0.2), &triangle, 1e-3).expect("it crosses");
    assert!((t - 0.1).abs() <= 1.2e-4, "{t}");
    assert_eq!(meeting(&node(1.2), &triangle, 1e-3), None);
    let [one, other] = [
        [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
        [[0.0, -1.0, 1.0], [0.0, 1.0, 1.0]],
    ];
    let falls = |shift: f64| {
        other.map(|place: Vec3| Moving {
            start: [place[0] + shift, place[1], place[2]],
            end: [place[0] + shift, place[1], -1.0],
        })
    };
    let edge = one.map(Moving::still);
    let t = meeting(&edge, &falls(0.0), 1e-3).expect("they cross");
    assert!((t - 0.5).abs() <= 1e-3, "{t}");
    assert_eq!(meeting(&edge, &falls(1.2), 1e-3), None);
    // sliding along each other, as far apart as twice what is asked
    let slides = |place: Vec3| Moving {
        start: [place[0], place[1], 2e-3],
        end: [place[0] + 5.0, place[1], 2e-3],
    };
    assert_eq!(meeting(&[slides([0.2, 0.2, 0.0])], &triangle, 1e-3), None);
}
