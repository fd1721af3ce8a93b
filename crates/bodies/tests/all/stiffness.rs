//! Symmetry, rigid motions and frame indifference.

use carom_bodies::Kinematics;
use carom_testing::Random;

use crate::sample::{
    MATERIAL, Sample, all, bars, cholesky, continua, distance, dot, largest, multiply,
};

#[test]
fn stiffness_and_mass_are_symmetric() {
    for sample in all() {
        let n = sample.n;
        let matrix = sample.matrix(1.0, 0.3);
        for (i, j) in (0..n).flat_map(|i| (0..i).map(move |j| (i, j))) {
            let error = (matrix[i * n + j] - matrix[j * n + i]).abs();
            assert!(
                error <= 1e-14 * largest(&matrix),
                "{}: {error}",
                sample.name
            );
        }
    }
}

#[test]
fn rigid_motions_cost_nothing() {
    for sample in all() {
        let k = sample.matrix(1.0, 0.0);
        for motion in sample.rigid_motions() {
            let force = multiply(&k, &motion);
            assert!(largest(&force) < 1e-14 * largest(&k), "{}", sample.name);
            let (force, energy) = sample.force(&motion);
            assert!(largest(&force) < 1e-14 * largest(&k), "{}", sample.name);
            assert!(energy.abs() < 1e-14 * largest(&k), "{}", sample.name);
        }
    }
}

/// With K r = 0 known, K + Σ r rᵀ positive definite says that K is so beside the rigid motions.
#[test]
fn everything_else_costs_energy() {
    let line = bars().swap_remove(0);
    for sample in continua().into_iter().chain([line]) {
        let n = sample.n;
        let mut matrix = sample.matrix(1.0, 0.0);
        let scale = largest(&matrix);
        for motion in sample.rigid_motions() {
            let norm = dot(&motion, &motion);
            for k in 0..n * n {
                matrix[k] += scale * motion[k / n] * motion[k % n] / norm;
            }
        }
        let smallest = cholesky(&matrix).1;
        assert!(smallest > 1e-4 * scale, "{}: {smallest}", sample.name);
    }
}

/// u -> Q u on the body Q x turns the forces: f -> Q f.
#[test]
fn a_turned_body_has_turned_forces_and_the_same_energy() {
    for sample in all() {
        let dim = sample.dim();
        if dim == 1 || sample.body.kinematics() == Kinematics::Axisymmetric {
            continue;
        }
        let turn = |v: &[f64; 3]| rotation(dim, v);
        let mut mesh = sample.mesh.clone();
        // the node that belongs to nobody is added anew
        mesh.nodes.pop();
        mesh.nodes.iter_mut().for_each(|x| *x = turn(x));
        let turned = Sample::new(&sample.name, mesh, sample.body.kinematics());
        let turn_all = |v: &[f64]| -> Vec<f64> {
            let nodes = v.chunks(dim).map(|v| {
                let mut three = [0.0; 3];
                three[..dim].copy_from_slice(v);
                turn(&three)[..dim].to_vec()
            });
            nodes.flatten().collect()
        };
        let u = Random(21).vector(sample.n);
        let (f, energy) = sample.force(&u);
        let (turned_f, turned_energy) = turned.force(&turn_all(&u));
        assert!(
            distance(&turned_f, &turn_all(&f)) < 1e-13 * largest(&f),
            "{}",
            sample.name
        );
        assert!((turned_energy - energy).abs() < 1e-13 * energy);
    }
}

/// A turn about the third axis, and in space then about the first.
fn rotation(dim: usize, v: &[f64; 3]) -> [f64; 3] {
    let (s, c) = 0.9f64.sin_cos();
    let v = [c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]];
    if dim == 2 {
        return v;
    }
    [v[0], c * v[1] - s * v[2], s * v[1] + c * v[2]]
}

/// With the modulus E (1 - ν) / ((1 + ν)(1 - 2ν)) and no lateral motion, all bodies are columns.
#[test]
fn confined_column_has_the_oedometric_modulus() {
    let (e, nu) = (MATERIAL.young, MATERIAL.poisson);
    let modulus = e * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    for sample in continua() {
        let strain = 1e-2;
        let axial = sample.field(|x| [0.0, strain * x[1], 0.0]);
        let expected = match sample.body.kinematics() {
            // free in the third direction
            Kinematics::PlaneStress { .. } => e / (1.0 - nu * nu),
            _ => modulus,
        };
        let volume: f64 = sample
            .body
            .stresses(&axial, &[])
            .iter()
            .map(|(v, _)| v)
            .sum();
        let energy = sample.force(&axial).1;
        let exact = 0.5 * expected * strain * strain * volume;
        assert!((energy - exact).abs() < 1e-13 * exact, "{}", sample.name);
    }
}
