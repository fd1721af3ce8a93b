//! Rotation and strain of elements, of every kind.

use carom_algebra::tensor::Mat3;
use carom_bodies::{Distortion, Extreme, Kinematics};
use carom_testing::allocations;

use crate::sample::{Sample, bars, continua};

fn of(sample: &Sample, u: &[f64]) -> Distortion {
    let none = Distortion::default();
    let [one, other] = [0, 5].map(|point| sample.body.distortion(u, point, &none).unwrap());
    let larger = |of: fn(&Distortion) -> Extreme| match of(&one).value > of(&other).value {
        true => of(&one),
        false => of(&other),
    };
    Distortion {
        rotation: larger(|found| found.rotation),
        strain: larger(|found| found.strain),
    }
}

/// A turn about (2, 3, 6)/7, in the plane about the third axis.
fn turn(dim: usize, angle: f64) -> Mat3 {
    let axis = match dim {
        2 => [0.0, 0.0, 1.0],
        _ => [2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0],
    };
    let (s, c) = angle.sin_cos();
    let cross = Mat3::new(
        0.0, -axis[2], axis[1], axis[2], 0.0, -axis[0], -axis[1], axis[0], 0.0,
    );
    Mat3::identity() + cross * s + cross * cross * (1.0 - c)
}

/// u = H x.
fn linear(sample: &Sample, h: &Mat3) -> Vec<f64> {
    sample.field(|x| [0, 1, 2].map(|i| (0..3).map(|j| h[(i, j)] * x[j]).sum()))
}

/// Of order one, on cells of order one with a few dozen roundings each.
const ROUNDING: f64 = 1e-12;

#[test]
fn a_rotation_is_measured_whatever_its_size() {
    let round = |sample: &Sample| sample.body.kinematics() == Kinematics::Axisymmetric;
    for sample in continua().iter().filter(|sample| !round(sample)) {
        for angle in [1e-3_f64, 0.2, 1.4, 2.5] {
            let r = turn(sample.dim(), angle);
            let found = of(sample, &linear(sample, &(r - Mat3::identity())));
            let (rotation, strain) = (found.rotation.value, found.strain.value);
            assert!(
                (rotation - angle).abs() < ROUNDING,
                "{}: {rotation} {angle}",
                sample.name
            );
            // sym R - I has the principal value cos θ - 1 square to the axis, of what is no strain
            assert!(
                (strain - (1.0 - angle.cos())).abs() < ROUNDING,
                "{}: {strain}",
                sample.name
            );
        }
        // the linear motion of a body that turns at a constant rate: the antisymmetric part grows without bound, the angle to 90°
        let spin = turn(sample.dim(), 0.5) - turn(sample.dim(), -0.5);
        let spin = spin / (2.0 * 0.5_f64.sin());
        let found = of(sample, &linear(sample, &(spin * 3.0)));
        assert!(
            (found.rotation.value - 3.0_f64.atan()).abs() < ROUNDING,
            "{}",
            sample.name
        );
        assert!(found.strain.value < ROUNDING, "{}", sample.name);
    }
}

#[test]
fn the_largest_principal_strain_is_measured_and_translations_are_none() {
    for sample in continua() {
        let e = match sample.dim() {
            2 => Mat3::new(0.03, 0.02, 0.0, 0.02, -0.05, 0.0, 0.0, 0.0, 0.0),
            _ => Mat3::new(0.03, 0.02, -0.01, 0.02, -0.05, 0.04, -0.01, 0.04, 0.02),
        };
        let largest = e.symmetric_eigenvalues().amax();
        let mut u = linear(&sample, &e);
        let round = sample.body.kinematics() == Kinematics::Axisymmetric;
        if !round {
            u.iter_mut().for_each(|u| *u += 0.7);
        }
        let found = of(&sample, &u);
        // about an axis u_r/r is the radial strain where u_z does not depend on r, and less than the largest here
        let expected = match round {
            true => found.strain.value.max(largest),
            false => largest,
        };
        assert!(
            (found.strain.value - expected).abs() < ROUNDING,
            "{}",
            sample.name
        );
        assert!(found.rotation.value < ROUNDING, "{}", sample.name);
    }
    for sample in bars() {
        // a kinked line: the bar along a stretch sees it all, one across it turns by it
        let found = of(&sample, &linear(&sample, &(Mat3::identity() * 0.1)));
        assert!(
            (found.strain.value - 0.1).abs() < ROUNDING,
            "{}",
            sample.name
        );
        assert!(found.rotation.value < ROUNDING, "{}", sample.name);
        if sample.dim() > 1 {
            let r = turn(2, 0.4);
            let found = of(&sample, &linear(&sample, &(r - Mat3::identity())));
            let flat = sample.dim() == 2;
            assert!(
                !flat || (found.rotation.value - 0.4).abs() < ROUNDING,
                "{}",
                sample.name
            );
            assert!(found.rotation.value > 0.1, "{}", sample.name);
        }
    }
}

#[test]
fn what_was_larger_before_stays_and_the_cell_is_named() {
    for sample in continua() {
        let none = vec![0.0; sample.n];
        let before = Distortion {
            rotation: Extreme {
                value: 0.2,
                cell: 3,
            },
            strain: Extreme {
                value: 0.1,
                cell: 1,
            },
        };
        assert_eq!(sample.body.distortion(&none, 0, &before), Some(before));
        // one node moved: the largest is in a cell that has it
        let node = sample.number[sample.mesh.element_nodes(sample.body.cells()[2])[1] as usize];
        let mut u = none;
        u[sample.dim() * node as usize] = 0.01;
        let found = of(&sample, &u);
        for cell in [found.rotation.cell, found.strain.cell] {
            let nodes = sample
                .mesh
                .element_nodes(sample.body.cells()[cell as usize]);
            assert!(
                nodes.iter().any(|&n| sample.number[n as usize] == node),
                "{}",
                sample.name
            );
        }
        assert!(found.strain.value > 0.0, "{}", sample.name);
        let measure = || sample.body.distortion(&u, 0, &Distortion::default());
        let pool = |threads| {
            rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap()
        };
        assert_eq!(pool(1).install(measure), pool(2).install(measure));
        let counted = pool(1).install(|| {
            let before = allocations();
            measure();
            allocations() - before
        });
        assert_eq!(counted, 0, "{}", sample.name);
    }
}
