//! Weak gaps where a face of the secondary surface is steep over the primary one.

use carom_algebra::unknowns::Unknowns;
use carom_contact::Pairing;
use carom_elements::Kind;
use carom_mesh::Face;

use crate::fixture::{face, full};
use crate::pairs::{BASES, Pair};

/// A sharp edge over a flat surface, `gap` above it: one face looks straight down, the other rises from the edge by `angle`.
/// In the plane, or with one face along the edge in space.
fn edge(dim: usize, angle: f64, gap: f64) -> Pair {
    let (rise, back) = angle.sin_cos();
    let across: &[f64] = if dim == 2 { &[0.0] } else { &[0.0, 1.0] };
    let profile = [[-back, gap + rise], [0.0, gap], [1.0, gap]];
    let floor = [[-1.5, 0.0], [-0.4, 0.0], [0.3, 0.0], [1.5, 0.0]];
    let mut x = Vec::new();
    let mut strip = |line: &[[f64; 2]], up: bool| -> Vec<Face> {
        let first = x.len() as u32;
        for y in across {
            x.extend(line.iter().map(|p| match dim {
                2 => [p[0], p[1], 0.0],
                _ => [p[0], *y, p[1]],
            }));
        }
        let n = line.len() as u32;
        let faces = (first..first + n - 1).map(|k| match (dim, up) {
            (2, true) => face(Kind::Bar2, &[k + 1, k]),
            (2, false) => face(Kind::Bar2, &[k, k + 1]),
            (_, true) => face(Kind::Quad4, &[k, k + 1, k + 1 + n, k + n]),
            (_, false) => face(Kind::Quad4, &[k, k + n, k + 1 + n, k + 1]),
        });
        faces.collect()
    };
    let (secondary, primary) = (strip(&profile, false), strip(&floor, true));
    Pair {
        dim,
        unknowns: Unknowns::translations(dim, x.len()),
        x,
        secondary,
        primary,
    }
}

#[test]
fn a_face_that_turns_away_leaves_the_means_without_a_jump() {
    // The steep side of the edge turns from 20 to 80 degrees in steps of 1e-3: the weight of its shadow changes by 1.5/0.366
    // of the change of a cosine at most, the places that it takes out of the means are up to 1 m away, and dual functions are
    // up to 2; so gap and rows change by some ten times the step. Where the last of its weight goes, below a part of 1e-6 of
    // a multiplier, the multiplier itself leaves.
    const STEP: f64 = 1e-3;
    for (dim, basis) in [2, 3].into_iter().flat_map(|dim| BASES.map(|b| (dim, b))) {
        for gap in [1e-3, 0.05] {
            let mut last: Option<Pairing> = None;
            let angles = (0..).map(|k| 0.35 + STEP * f64::from(k));
            for angle in angles.take_while(|angle| *angle < 1.4) {
                let pair = edge(dim, angle, gap);
                let now = pair.pairing(basis);
                let n = dim * pair.x.len();
                for point in 0..now.len() {
                    let Some(last) = &last else { continue };
                    let [one, other] = [last, &now].map(|pairing| pairing.rows.gap(point));
                    if one.is_infinite() || other.is_infinite() {
                        // the far end of the steep face, which has no other
                        let node = pair.contact(basis, 1.0).points[point].node();
                        assert!(pair.x[node as usize][0] < 0.0, "{dim} {basis:?} {angle}");
                        continue;
                    }
                    assert!((one - other).abs() < 30.0 * STEP, "{angle} {one} {other}");
                    let [one, other] = [last, &now].map(|pairing| full(pairing, point, n));
                    for (one, other) in one.iter().zip(&other) {
                        assert!((one - other).abs() < 30.0 * STEP, "{angle} {one} {other}");
                    }
                }
                last = Some(now);
            }
        }
    }
}
