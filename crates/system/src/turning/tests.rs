//! Tests of the rows that turn.

use carom_algebra::unknowns::NodeKind;
use carom_arlequin::Term;

use super::*;

/// Where rows are taken at the end of a step.
fn at<'a>(frames: &'a [Rotation], u: &'a [f64]) -> Turned<'a> {
    Turned {
        frames,
        u,
        from: None,
    }
}

const POINTS: [[f64; 3]; 4] = [
    [0.1, 0.3, -0.2],
    [0.4, -0.25, 0.35],
    [0.7, 0.2, 0.15],
    [0.9, -0.3, -0.1],
];

/// Nodes of a solid at four points, and two nodes of a beam along x; each point has a weight in the sums. The rows of the first node of the beam.
fn link() -> (ModelLink, Unknowns, Vec<[f64; 3]>) {
    let mut x = POINTS.to_vec();
    x.extend([[0.0; 3], [1.0, 0.0, 0.0]]);
    let kinds = [NodeKind::Translations; 4].into_iter();
    let unknowns = Unknowns::new(3, kinds.chain([NodeKind::Turning; 2]));
    let term = |node: u32, component: usize, coefficient: f64| Term {
        node,
        component: component as u32,
        coefficient,
    };
    let mut rows = Vec::new();
    for mode in 0..6 {
        let (mut inner, mut outer) = (Vec::new(), BTreeMap::new());
        for (p, point) in POINTS.iter().enumerate() {
            let r = Vec3::new(0.0, point[1], point[2]);
            let mut mu = Vec3::zeros();
            mu[mode % 3] = 1.0;
            if mode > 2 {
                mu = mu.cross(&r);
            }
            mu *= (1.0 - point[0]) * (1.0 + 0.3 * p as f64);
            inner.extend((0..3).map(|i| term(p as u32, i, mu[i])));
            for (node, n, sign) in [(4, 1.0 - point[0], 1.0), (5, point[0], -1.0)] {
                // bends without shear
                let bent = Vec3::x() * (0.5 * sign * point[0] * (1.0 - point[0]));
                let turned = (r * n + bent).cross(&mu);
                for i in 0..3 {
                    *outer.entry((node, i)).or_insert(0.0) += n * mu[i];
                    *outer.entry((node, 3 + i)).or_insert(0.0) += turned[i];
                }
            }
        }
        rows.push(Row {
            node: 4,
            component: mode as u32,
            inner,
            outer: outer.into_iter().map(|((n, k), c)| term(n, k, c)).collect(),
            ..Row::default()
        });
    }
    let name = "overlap".to_owned();
    let zones = [0, 0];
    (ModelLink { name, zones, rows }, unknowns, x)
}

fn made() -> (TurningRows, Vec<LinkRow>, Unknowns, ModelLink) {
    let (link, unknowns, x) = link();
    let (mut turning, mut rows) = (TurningRows::default(), Vec::new());
    let number: Vec<u32> = (0..x.len() as u32).collect();
    turning
        .add(&link, (&number, &unknowns, &x), &mut rows)
        .unwrap();
    (turning, rows, unknowns, link)
}

fn some(count: usize, seed: f64, size: f64) -> Vec<f64> {
    let value = |k: usize| size * (12.9 * k as f64 + seed).sin();
    (0..count).map(value).collect()
}

#[test]
fn rows_in_the_reference_position_are_those_of_small_turns() {
    let (_, rows, unknowns, link) = made();
    for (row, given) in rows.iter().zip(&link.rows) {
        let mut found = vec![0.0; unknowns.len()];
        row.iter().for_each(|&(i, c)| found[i as usize] += c);
        for (terms, sign) in [(&given.inner, 1.0), (&given.outer, -1.0)] {
            for t in terms {
                let unknown = unknowns.first(t.node) + t.component as usize;
                found[unknown] -= sign * t.coefficient;
            }
        }
        assert!(found.iter().all(|off| off.abs() < 1e-14), "{found:?}");
    }
}

#[test]
fn the_row_over_a_step_times_the_motion_is_the_change_of_h() {
    let (turning, mut rows, unknowns, _) = made();
    let frames = [0.4, -1.1].map(|s| Rotation::cayley(&Vec3::new(s, 0.3, 2.0 * s)));
    let n = unknowns.len();
    let mut from = some(n, 0.3, 0.5);
    for node in [4, 5] {
        from[unknowns.rotations_of(node)].fill(0.0);
    }
    let u = some(n, 1.7, 0.8);
    let over = Turned {
        from: Some(&from),
        ..at(&frames, &u)
    };
    turning.coefficients(&unknowns, &over, &mut rows);
    let [before, after] = [at(&frames, &from), at(&frames, &u)];
    let change = turning
        .values(&unknowns, &after)
        .zip(turning.values(&unknowns, &before));
    let way: Vec<f64> = u.iter().zip(&from).map(|(u, v)| u - v).collect();
    for ((row, after), (_, before)) in change {
        let found = crate::link_row::on(&rows[row], &way);
        assert!((found - (after - before)).abs() < 1e-13, "{row}");
    }
}

#[test]
fn the_row_is_the_derivative_and_its_rate_that_of_the_motion() {
    let (turning, mut rows, unknowns, _) = made();
    let frames = [0.4, -1.1].map(|s| Rotation::cayley(&Vec3::new(s, 0.3, 2.0 * s)));
    let n = unknowns.len();
    let mut u = some(n, 0.3, 0.5);
    for node in [4, 5] {
        u[unknowns.rotations_of(node)].fill(0.0);
    }
    turning.coefficients(&unknowns, &at(&frames, &u), &mut rows);
    let v = some(n, 2.9, 1.0);
    let step = 1e-4;
    let moved = |t: f64| -> Vec<f64> {
        let moved = u.iter().zip(&v).map(|(u, v)| u + t * v);
        let u: Vec<f64> = moved.collect();
        let rows: Vec<(usize, f64)> = turning.values(&unknowns, &at(&frames, &u)).collect();
        rows.into_iter().map(|(_, h)| h).collect()
    };
    let [before, now, after] = [moved(-step), moved(0.0), moved(step)];
    let second: Vec<(usize, f64)> = turning
        .centripetal(&unknowns, &at(&frames, &u), &v)
        .collect();
    for (row, own) in second {
        let slope = (after[row] - before[row]) / (2.0 * step);
        let bend = (after[row] - 2.0 * now[row] + before[row]) / (step * step);
        // differences err by the third and fourth derivatives
        assert!(
            (slope - crate::link_row::on(&rows[row], &v)).abs() < 1e-6,
            "{row}"
        );
        assert!((bend - own).abs() < 1e-5, "{row}: {bend} {own}");
    }
}

#[test]
fn h_stays_zero_where_all_turn() {
    let (turning, _, unknowns, _) = made();
    let (_, _, x) = link();
    let increment = Vec3::new(0.7, -1.9, 0.4);
    let turn = Rotation::cayley(&increment).matrix();
    let mut u = vec![0.0; unknowns.len()];
    for (unknown, u) in u.iter_mut().enumerate() {
        let x = Vec3::from(x[unknowns.node(unknown) as usize]);
        *u = match unknowns.kind(unknown) {
            Kind::Translation(i) => (turn * x - x)[i] + 0.3,
            Kind::Rotation(i) => increment[i],
            Kind::Amplitude(_) => 0.0,
        };
    }
    let at = Turned {
        frames: &[],
        u: &u,
        from: None,
    };
    for (row, h) in turning.values(&unknowns, &at) {
        assert!(h.abs() < 1e-14, "{row}: {h}");
    }
}
