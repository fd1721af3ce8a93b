//! Problems of a lumped mass, whose compliance is the product of sparse rows: nodes of a surface on the faces of another one that
//! does not match it.

use carom_nonsmooth::coulomb::{
    Coulomb, FrictionProblem, FrictionSolution, Posed, Slip, Tangential,
};
use carom_nonsmooth::interface::{Candidate, Interface, InterfaceProblem};
use carom_nonsmooth::{Compliance, Lumped, Unknown};
use carom_testing::Random;

/// n × n nodes at distances of 1 upon as many faces of the size `size`; per point its four nodes and their shares.
pub(crate) fn surface(n: usize, size: f64) -> Vec<[(usize, f64); 4]> {
    let across = (n as f64 / size).ceil() as usize + 2;
    let on_faces = |k: usize| {
        let [x, y] = [k % n, k / n].map(|i| (i as f64 + 0.3) / size);
        let (i, j) = (x.floor(), y.floor());
        let (s, t) = (x - i, y - j);
        let node = |a: usize, b: usize| (j as usize + b) * across + i as usize + a;
        [
            (node(0, 0), (1.0 - s) * (1.0 - t)),
            (node(1, 0), s * (1.0 - t)),
            (node(1, 1), s * t),
            (node(0, 1), (1.0 - s) * t),
        ]
    };
    (0..n * n).map(on_faces).collect()
}

/// The rows of these points on nodes of mass 1 above and of mass `size`² below, three unknowns each.
pub(crate) fn rows(points: &[[(usize, f64); 4]], size: f64, tangents: usize) -> Lumped {
    let below = 3 * points.len() as u32;
    let of_point = |(k, point): (usize, &[(usize, f64); 4])| -> Vec<Row> {
        let along = |axis: usize| {
            let face = point.iter();
            let face = face.map(|&(node, share)| (below + (3 * node + axis) as u32, -share));
            let own = std::iter::once(((3 * k + axis) as u32, 1.0));
            own.chain(face).unzip()
        };
        (0..=tangents).map(|row| along((row + 2) % 3)).collect()
    };
    let inverse = |unknown: u32| match unknown < below {
        true => 1.0,
        false => size.powi(-2),
    };
    let candidates = points.iter().enumerate().map(of_point);
    filled(candidates, 1 + tangents, inverse)
}

/// Unknowns and entries of a row.
type Row = (Vec<u32>, Vec<f64>);

/// The rows of candidates on nodes of three unknowns; `inverse`: mass of an unknown.
fn filled(
    candidates: impl Iterator<Item = Vec<Row>>,
    width: usize,
    inverse: impl Fn(u32) -> f64,
) -> Lumped {
    let mut lumped = Lumped::default();
    lumped.clear(width);
    for rows in candidates {
        let rows = rows
            .iter()
            .map(|(unknowns, entries)| (&unknowns[..], &entries[..]));
        lumped.push(rows, |unknown| Unknown {
            first: unknown - unknown % 3,
            inverse: inverse(unknown),
        });
    }
    lumped.finish();
    lumped
}

fn candidates(count: usize, random: &mut Random) -> Vec<Candidate> {
    let candidate = |_| Candidate::unilateral(random.between(-1.5, 0.5));
    (0..count).map(candidate).collect()
}

fn sliding(count: usize, random: &mut Random) -> Vec<Tangential> {
    let one = |_| Tangential {
        mu: 0.3,
        free: [random.between(-0.5, 0.5), random.between(-0.5, 0.5)],
        slip: Slip::Open,
        force: [0.0; 2],
        pressed: 0.0,
        sliding: None,
    };
    (0..count).map(one).collect()
}

fn entries(lumped: &Lumped) -> Vec<f64> {
    let mut entries = Vec::new();
    lumped.dense(&mut entries);
    entries
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most, value| f64::max(most, value.abs()))
}

/// Conjugate gradients and the dense factor find the same forces, to the rounding of both.
#[test]
fn the_forces_of_sparse_rows_are_those_of_the_matrix() {
    let mut random = Random(5);
    for (n, size) in [(2, 1.3), (5, 0.7), (9, 2.6)] {
        let lumped = rows(&surface(n, size), size, 0);
        let candidates = candidates(n * n, &mut random);
        let mut interface = Interface::default();
        let compliance = (Compliance::Lumped(&lumped), 1);
        interface
            .solve(&candidates, compliance, [1.0, 0.0])
            .unwrap();
        let dense = InterfaceProblem {
            step: 0,
            names: Vec::new(),
            candidates,
            compliance: entries(&lumped),
            factors: [1.0, 0.0],
        };
        let solution = dense.solve().unwrap();
        assert_eq!(interface.statuses, solution.statuses);
        let size = largest(solution.forces.iter().copied());
        for (one, other) in interface.forces.iter().zip(&solution.forces) {
            assert!((one - other).abs() < 1e-12 * size, "{n}: {one} {other}");
        }
    }
}

/// Sweeps solve the problem with friction, as code that knows no solver measures it on the whole matrix.
#[test]
fn sweeps_on_sparse_rows_solve_the_problem_with_friction() {
    let mut random = Random(6);
    for (n, size) in [(2, 1.3), (5, 0.7), (9, 2.6)] {
        let lumped = rows(&surface(n, size), size, 2);
        let candidates = candidates(n * n, &mut random);
        let friction = sliding(n * n, &mut random);
        let mut coulomb = Coulomb::default();
        let posed = Posed {
            candidates: &candidates,
            friction: &friction,
            tangents: 2,
            d: Compliance::Lumped(&lumped),
            s: [1.0; 3],
            tolerance: 1e-12,
        };
        coulomb.solve(&posed).unwrap();
        let problem = FrictionProblem {
            step: 0,
            names: Vec::new(),
            candidates,
            friction,
            tangents: 2,
            compliance: entries(&lumped),
            factors: [1.0; 3],
            tolerance: 1e-12,
        };
        let solution = FrictionSolution {
            forces: coulomb.forces.clone(),
            tangential: coulomb.tangential.clone(),
            statuses: coulomb.statuses.clone(),
            slips: coulomb.slips.clone(),
            passes: coulomb.passes,
            sweeps: coulomb.sweeps,
        };
        assert!(problem.defect(&solution) < 1e-11, "{n}");
    }
}

/// 10 000 points that all touch one another through shared nodes: no matrix with more than 100 numbers a point, and as many sweeps
/// as 81 points need.
#[test]
fn ten_thousand_points_have_no_dense_matrix() {
    let mut random = Random(7);
    let mut sweeps = [0; 2];
    for (sweeps, n) in sweeps.iter_mut().zip([9, 100]) {
        let (candidates, friction) = (candidates(n * n, &mut random), sliding(n * n, &mut random));
        let points = surface(n, 0.9);
        let frictionless = rows(&points, 0.9, 0);
        assert!(frictionless.numbers() <= 10 * n * n);
        let mut interface = Interface::default();
        let compliance = (Compliance::Lumped(&frictionless), 1);
        interface
            .solve(&candidates, compliance, [1.0, 0.0])
            .unwrap();
        let lumped = rows(&points, 0.9, 2);
        assert!(lumped.numbers() <= 100 * n * n, "{}", lumped.numbers());
        let mut coulomb = Coulomb::default();
        let posed = Posed {
            candidates: &candidates,
            friction: &friction,
            tangents: 2,
            d: Compliance::Lumped(&lumped),
            s: [1.0; 3],
            tolerance: 1e-12,
        };
        coulomb.solve(&posed).unwrap();
        *sweeps = coulomb.sweeps;
    }
    assert!(sweeps[1] <= 2 * sweeps[0], "{sweeps:?}");
}

/// A row of bodies between two that are pushed together by a force of one: each contact carries it. Sweeps alone take some
/// n² log(10¹²)/π², 4·10⁴ of them; after some hundred passes take over.
#[test]
fn a_row_of_bodies_pressed_together_is_solved_by_passes() {
    const BODIES: usize = 120;
    let between = |k: usize| -> Vec<Row> {
        let along = |axis: usize| {
            let unknown = |body: usize| (3 * body + axis) as u32;
            (vec![unknown(k + 1), unknown(k)], vec![1.0, -1.0])
        };
        [2, 0, 1].map(along).into()
    };
    let lumped = filled((0..BODIES - 1).map(between), 3, |_| 1.0);
    let mut random = Random(8);
    let mut candidates = candidates(BODIES - 1, &mut random);
    for candidate in &mut candidates {
        candidate.local.gap_free = 0.0;
    }
    candidates[0].local.gap_free = -1.0;
    candidates[BODIES - 2].local.gap_free = -1.0;
    let mut friction = sliding(BODIES - 1, &mut random);
    friction.iter_mut().for_each(|point| point.free = [0.0; 2]);
    let mut coulomb = Coulomb::default();
    let posed = Posed {
        candidates: &candidates,
        friction: &friction,
        tangents: 2,
        d: Compliance::Lumped(&lumped),
        s: [1.0; 3],
        tolerance: 1e-12,
    };
    coulomb.solve(&posed).unwrap();
    assert!(coulomb.passes > 0 && coulomb.sweeps < 1000);
    // rounding times n², the condition of D
    let off = largest(coulomb.forces.iter().map(|force| force - 1.0));
    assert!(off < 1e-15 * (BODIES * BODIES) as f64, "{off:e}");
    let rubbing = coulomb.tangential.iter().flatten().copied();
    assert!(largest(rubbing) < 1e-15 * (BODIES * BODIES) as f64);
}
