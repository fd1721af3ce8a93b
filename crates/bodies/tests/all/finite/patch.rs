//! Displacements that the elements hold exactly.

use carom_algebra::tensor::Mat3;
use carom_bodies::Kinematics;
use carom_materials::Want;

use super::{Step, displacement, elastic, rotation, samples, turn};
use crate::sample::{Sample, distance, interior, largest};

/// A stretch and shear of tenths, and its F; in axisymmetry u_r = 0.2 r, u_z = -0.1 z.
fn affine(sample: &Sample) -> (Vec<f64>, Mat3) {
    let mut h = Mat3::new(0.2, 0.15, -0.1, -0.25, -0.1, 0.05, 0.1, 0.12, 0.3);
    if sample.body.kinematics() == Kinematics::Axisymmetric {
        h = Mat3::from_diagonal(&[0.2, -0.1, 0.0].into());
    }
    let u = sample.field(|x| [0, 1, 2].map(|i| (0..sample.dim()).map(|j| h[(i, j)] * x[j]).sum()));
    let mut f = Mat3::identity();
    for i in 0..sample.dim() {
        for j in 0..sample.dim() {
            f[(i, j)] += h[(i, j)];
        }
    }
    if sample.body.kinematics() == Kinematics::Axisymmetric {
        f[(2, 2)] = f[(0, 0)];
    }
    (u, f)
}

#[test]
fn an_affine_motion_has_the_stress_of_the_law_everywhere_and_no_force_inside() {
    for (name, law) in elastic() {
        for sample in samples(&(name, law)) {
            let (u, deformation) = affine(&sample);
            let response = law.finite().unwrap();
            let response = response.update(&deformation, 0.0, (&[], &mut []), Want::Stress);
            let response = response.unwrap();
            let exact = response.stress * deformation.transpose() / deformation.determinant();
            for (_, stress) in sample.body.stresses(&u, &[]) {
                let error = (stress - exact).norm();
                assert!(error < 1e-13 * exact.norm(), "{}: {error}", sample.name);
            }
            let (f, stored, _) = Step::new(&sample).run(&u).unwrap();
            let volume: f64 = sample.body.stresses(&u, &[]).iter().map(|(v, _)| v).sum();
            let energy = response.stored * volume / deformation.determinant();
            assert!(
                (stored.strain - energy).abs() < 1e-13 * energy,
                "{}",
                sample.name
            );
            let inside = interior(&sample.x, sample.dim());
            for (node, _) in inside.iter().enumerate().filter(|(_, inside)| **inside) {
                let force = largest(&f[sample.dim() * node..][..sample.dim()]);
                assert!(
                    force < 1e-14 * largest(&f).max(1.0),
                    "{}: {force}",
                    sample.name
                );
            }
        }
    }
}

#[test]
fn a_rigid_motion_has_no_force_and_no_energy() {
    for sample in elastic().iter().flat_map(samples) {
        if sample.body.kinematics() == Kinematics::Axisymmetric {
            continue;
        }
        let u = rotation(&sample, 2.0);
        let (f, stored, _) = Step::new(&sample).run(&u).unwrap();
        // strains of round-off, 1e-15 or so, and moduli of order one
        assert!(largest(&f) < 1e-13, "{}: {f:?}", sample.name);
        assert!(stored.strain.abs() < 1e-27, "{}: {stored:?}", sample.name);
    }
}

#[test]
fn the_force_turns_with_the_body() {
    for sample in elastic().iter().flat_map(samples) {
        if sample.body.kinematics() == Kinematics::Axisymmetric {
            continue;
        }
        let turn = turn(&sample, 1.1);
        let u = displacement(&sample, 31);
        let x = sample.field(|x| *x);
        let place: Vec<f64> = x.iter().zip(&u).map(|(x, u)| x + u).collect();
        let moved: Vec<f64> = turned(&sample, &turn, &place)
            .iter()
            .zip(&x)
            .map(|(place, x)| place - x)
            .collect();
        let f = Step::new(&sample).force(&u);
        let error = distance(
            &Step::new(&sample).force(&moved),
            &turned(&sample, &turn, &f),
        );
        // displacements of the size of the body, strains of a tenth
        assert!(error < 1e-13, "{}: {error}", sample.name);
    }
}

/// R of each node's vector.
fn turned(sample: &Sample, turn: &[[f64; 3]; 3], vectors: &[f64]) -> Vec<f64> {
    let dim = sample.dim();
    let entry = |k: usize| {
        let vector = &vectors[k / dim * dim..][..dim];
        let row = &turn[k % dim];
        vector.iter().zip(row).map(|(v, r)| v * r).sum()
    };
    (0..sample.n).map(entry).collect()
}
