//! The interface problem of the weak form.

use carom_contact::Point;
use carom_elements::Kind;
use carom_laws::Status;
use carom_mesh::{ElementId, Face, Rim, face_nodes};
use carom_nonsmooth::Weak;
use carom_nonsmooth::interface::{Candidate, InterfaceProblem};
use carom_testing::Random;

/// Gauss points of a surface, and the places of its nodes.
type Patch = (Vec<Point>, Vec<[f64; 3]>);

fn patch<const N: usize>(kind: Kind, nodes: &[[u32; N]], x: Vec<[f64; 3]>) -> Patch {
    let face = |nodes: &[u32; N]| Face {
        kind,
        nodes: face_nodes(nodes),
        parent: ElementId { block: 0, index: 0 },
        axis: [0.0; 3],
        radius: None,
        rim: Rim::default(),
    };
    let faces: Vec<Face> = nodes.iter().map(face).collect();
    (Point::of_faces(&faces, &x, |_| 1.0), x)
}

/// A row of n segments of random sizes, about 1 m long.
fn strip(n: usize, random: &mut Random) -> Patch {
    let x = (0..=n).map(|k| [(k as f64 + 0.3 * random.next()) / n as f64, 0.0, 0.0]);
    let x = x.collect();
    let nodes: Vec<[u32; 2]> = (0..n as u32).map(|k| [k, k + 1]).collect();
    patch(Kind::Bar2, &nodes, x)
}

/// n x n quadrilaterals of random shapes on about 1 m x 1 m.
fn grid(n: usize, random: &mut Random) -> Patch {
    let across = n + 1;
    let mut at = |k: usize| (k as f64 + 0.2 * random.next()) / n as f64;
    let x = (0..across * across).map(|k| [at(k % across), at(k / across), 0.0]);
    let x = x.collect();
    let nodes = (0..n * n).map(|k| {
        let (first, across) = ((k % n + across * (k / n)) as u32, across as u32);
        [first, first + 1, first + across + 1, first + across]
    });
    let nodes: Vec<[u32; 4]> = nodes.collect();
    patch(Kind::Quad4, &nodes, x)
}

/// The weak form as the step hands it on, `compliance` being D + G / (r s) and `factor` s.
fn problem(q: &[f64], compliance: Vec<f64>, factor: f64) -> InterfaceProblem {
    InterfaceProblem {
        step: 0,
        names: Vec::new(),
        candidates: q.iter().copied().map(Candidate::unilateral).collect(),
        compliance,
        factors: [factor, 0.0],
    }
}

/// Solution of a dense system by Gauss's elimination with pivots; `None` if it is singular.
fn eliminate(n: usize, a: &mut [f64], b: &mut [f64]) -> Option<()> {
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i * n + k].abs().total_cmp(&a[j * n + k].abs()))?;
        if a[pivot * n + k].abs() < 1e-13 {
            return None;
        }
        (0..n).for_each(|j| a.swap(k * n + j, pivot * n + j));
        b.swap(k, pivot);
        for i in (0..n).filter(|i| *i != k) {
            let factor = a[i * n + k] / a[k * n + k];
            (k..n).for_each(|j| a[i * n + j] -= factor * a[k * n + j]);
            b[i] -= factor * b[k];
        }
    }
    (0..n).for_each(|k| b[k] /= a[k * n + k]);
    Some(())
}

/// The equations of the weak form as they stand, for one pattern of signs: forces of the points and p̂, if the pattern has
/// one solution. Unknowns: P of each point, then p of each node.
fn by_pattern(
    points: &[Point],
    (d, q, r): (&[f64], &[f64], f64),
    signs: u32,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let m = points.len();
    let nodes = 1 + points
        .iter()
        .flat_map(|point| point.carriers())
        .map(|(a, _)| a)
        .max()? as usize;
    let n = m + nodes;
    let (mut matrix, mut rhs) = (vec![0.0; n * n], vec![0.0; n]);
    for (i, point) in points.iter().enumerate() {
        let closed = signs >> i & 1 == 1;
        // P_i = w S (Σ φ p - r (q + D P)_i)
        matrix[i * n + i] += 1.0;
        if closed {
            for j in 0..m {
                matrix[i * n + j] += point.area * r * d[i * m + j];
            }
            for (a, phi) in point.carriers() {
                matrix[i * n + m + a as usize] -= point.area * phi;
            }
            rhs[i] = -point.area * r * q[i];
        }
        // Σ_closed w φ_a (q + D P) + Σ_open (w / r) φ_a Σ φ_b p_b = 0
        for (a, phi) in point.carriers() {
            let row = m + a as usize;
            if closed {
                for j in 0..m {
                    matrix[row * n + j] += point.area * phi * d[i * m + j];
                }
                rhs[row] -= point.area * phi * q[i];
            } else {
                for (b, other) in point.carriers() {
                    matrix[row * n + m + b as usize] += point.area / r * phi * other;
                }
            }
        }
    }
    eliminate(n, &mut matrix, &mut rhs)?;
    let augmented = |i: usize| {
        let p: f64 = points[i]
            .carriers()
            .map(|(a, phi)| phi * rhs[m + a as usize])
            .sum();
        let end: f64 = q[i] + (0..m).map(|j| d[i * m + j] * rhs[j]).sum::<f64>();
        p - r * end
    };
    Some((rhs[..m].to_vec(), (0..m).map(augmented).collect()))
}

#[test]
fn random_weak_forms_have_the_solution_that_all_patterns_of_signs_tell() {
    let mut random = Random(3);
    let mut mixed = 0;
    for trial in 0..200 {
        let (points, _) = match trial % 5 {
            0 => grid(1, &mut random),
            segments => strip(segments, &mut random),
        };
        let m = points.len();
        let b: Vec<f64> = (0..m * m).map(|_| random.next()).collect();
        let mut d = vec![0.0; m * m];
        for (at, entry) in d.iter_mut().enumerate() {
            let (i, j) = (at / m, at % m);
            *entry = (0..m).map(|k| b[i * m + k] * b[j * m + k]).sum::<f64>();
            *entry += if i == j { 0.05 } else { 0.0 };
        }
        let q: Vec<f64> = (0..m).map(|_| random.next() - 0.2).collect();
        let r = 10.0_f64.powf(random.next());
        let factor = 0.5 + random.next().abs();
        let carried = points.iter().map(|point| (point.carriers(), point.area));
        let weak = Weak::new(carried, r).unwrap();
        let entry = |(at, d): (usize, &f64)| (d + weak.compliance(at / m, at % m)) / factor;
        let compliance = d.iter().enumerate().map(entry).collect();
        let solution = problem(&q, compliance, factor).solve().unwrap();
        let fits = |signs: u32| {
            let (forces, augmented) = by_pattern(&points, (&d, &q, r), signs)?;
            let agree = |i: usize| (signs >> i & 1 == 1) == (augmented[i] > 0.0);
            (0..m).all(agree).then_some((signs, forces))
        };
        let found: Vec<_> = (0..1u32 << m).filter_map(fits).collect();
        let [(signs, forces)] = &found[..] else {
            panic!("trial {trial}: {} patterns of {m} points fit", found.len())
        };
        mixed += usize::from(*signs != 0 && *signs != (1 << m) - 1);
        let size = 1.0 + forces.iter().fold(0.0_f64, |size, force| size.max(*force));
        for (i, (force, expected)) in solution.forces.iter().zip(forces).enumerate() {
            // eliminations of a condition of up to 1e5
            assert!(
                (force - expected).abs() < 1e-9 * size,
                "trial {trial}: {force} {expected}"
            );
            let closed = solution.statuses[i] != Status::Open;
            assert_eq!(closed, signs >> i & 1 == 1);
        }
    }
    assert!(mixed > 100, "the problems are not trivial");
}

#[test]
fn large_weak_forms_on_a_flat_obstacle_are_solved() {
    let mut random = Random(11);
    for trial in 0..40 {
        let (points, x) = match trial % 2 {
            0 => strip(5 + 2 * trial, &mut random),
            _ => grid(3 + trial / 6, &mut random),
        };
        let (m, nodes) = (points.len(), x.len());
        // rows of N are the shape functions: without G the compliance of the points has the rank of the nodes
        let length = 0.1 * 30.0_f64.powf(random.next().abs());
        let distance = |a: u32, b: u32| {
            let [a, b] = [a, b].map(|node| x[node as usize]);
            (a[0] - b[0]).hypot(a[1] - b[1])
        };
        let area: f64 = points.iter().map(|point| point.area).sum();
        let r = 10.0_f64.powf(2.0 * random.next()) * nodes as f64 / area;
        let carried = points.iter().map(|point| (point.carriers(), point.area));
        let weak = Weak::new(carried, r).unwrap();
        let mut compliance = vec![0.0; m * m];
        for (at, entry) in compliance.iter_mut().enumerate() {
            *entry = weak.compliance(at / m, at % m);
            for (a, one) in points[at / m].carriers() {
                for (b, other) in points[at % m].carriers() {
                    *entry += one * other * (-distance(a, b) / length).exp();
                }
            }
        }
        let waves = [0, 1, 2].map(|_| 6.0 * random.next());
        let gap = |point: &Point| {
            let at =
                |i: usize| -> f64 { point.carriers().map(|(a, n)| n * x[a as usize][i]).sum() };
            (waves[0] * at(0) + waves[1] * at(1) + waves[2]).sin() + 0.3 * random.next()
        };
        let q: Vec<f64> = points.iter().map(gap).collect();
        let problem = problem(&q, compliance, 1.0);
        let solution = problem.solve().unwrap();
        let forces = &solution.forces;
        let size = forces.iter().fold(1.0_f64, |size, force| size.max(*force));
        for i in 0..m {
            let row = problem.compliance[i * m..(i + 1) * m].iter().zip(forces);
            let end = q[i] + row.map(|(d, force)| d * force).sum::<f64>();
            // the complementarity of the laboratory, 1e-10; gaps are of size 1
            let error = (forces[i] / size).min(end).abs();
            assert!(error < 1e-10, "trial {trial}: {} {end}", forces[i]);
        }
    }
}
