//! Patch tests: a displacement that the elements hold exactly has exact stresses and no force inside.

use carom_algebra::tensor::Mat3;
use carom_bodies::Kinematics;

use crate::sample::{MATERIAL, Sample, continua, interior, largest};

const GRADIENT: [[f64; 3]; 3] = [
    [1e-2, 3e-3, -2e-3],
    [-4e-3, 7e-3, 5e-3],
    [6e-3, 1e-3, -8e-3],
];

/// Linear field of the sample; in axisymmetry u_r = g r, u_z = h z, the hoop strain being g.
fn linear(sample: &Sample) -> (Vec<f64>, Mat3) {
    let mut gradient = Mat3::zeros();
    let axisymmetric = sample.body.kinematics() == Kinematics::Axisymmetric;
    for i in 0..sample.dim() {
        for j in 0..sample.dim() {
            if i == j || !axisymmetric {
                gradient[(i, j)] = GRADIENT[i][j];
            }
        }
    }
    let u = sample.field(|x| [0, 1, 2].map(|i| (0..3).map(|j| gradient[(i, j)] * x[j]).sum()));
    if axisymmetric {
        gradient[(2, 2)] = gradient[(0, 0)];
    }
    (u, gradient)
}

#[test]
fn stress_of_a_linear_displacement_is_that_of_the_law_in_every_element() {
    for sample in continua() {
        let (u, gradient) = linear(&sample);
        let strain = (gradient + gradient.transpose()) * 0.5;
        let exact = MATERIAL.stress(sample.body.kinematics().plane(), &strain);
        let stresses = sample.body.stresses(&u, &[]);
        assert_eq!(stresses.len(), sample.body.cells().len());
        for (_, stress) in stresses {
            let error = (stress - exact).norm();
            assert!(error < 1e-13 * exact.norm(), "{}: {error}", sample.name);
        }
    }
}

#[test]
fn forces_of_a_linear_displacement_vanish_inside() {
    for sample in continua() {
        let f = sample.force(&linear(&sample).0).0;
        let inside = interior(&sample.x, sample.dim());
        assert!(inside.iter().any(|inside| *inside));
        for (node, inside) in inside.into_iter().enumerate() {
            let force = largest(&f[sample.dim() * node..][..sample.dim()]);
            if inside {
                assert!(
                    force < 1e-14 * largest(&f).max(1e-2),
                    "{}: {force}",
                    sample.name
                );
            }
        }
    }
}

/// ½ σ:ε times the volume, for the same field.
#[test]
fn energy_of_a_linear_displacement_is_exact() {
    for sample in continua() {
        let (u, gradient) = linear(&sample);
        let strain = (gradient + gradient.transpose()) * 0.5;
        let stress = MATERIAL.stress(sample.body.kinematics().plane(), &strain);
        let volume: f64 = sample.body.stresses(&u, &[]).iter().map(|(v, _)| v).sum();
        let exact = 0.5 * stress.component_mul(&strain).sum() * volume;
        let energy = sample.force(&u).1;
        assert!((energy - exact).abs() < 1e-13 * exact, "{}", sample.name);
    }
}
