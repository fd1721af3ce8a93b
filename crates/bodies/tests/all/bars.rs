//! A straight bar, wherever it points, is the bar of one dimension.

use carom_bodies::Kinematics;
use carom_mesh::generate;

use crate::sample::{AREA, MATERIAL, Sample, distance, dot, largest};

const ENDS: [[f64; 3]; 3] = [[-2.0, 0.0, 0.0], [1.2, -1.6, 0.0], [1.2, 0.96, -1.28]];

fn bar(dim: usize, n: usize) -> (Sample, [f64; 3]) {
    let mesh = generate::line("b", [0.0; 3], ENDS[dim - 1], n, dim);
    let axis = ENDS[dim - 1].map(|x| x / 2.0);
    (
        Sample::new("bar", mesh, Kinematics::Bar { area: AREA }),
        axis,
    )
}

#[test]
fn uniform_strain_gives_the_tension_along_the_axis() {
    for dim in 1..=3 {
        let (sample, axis) = bar(dim, 7);
        let strain = 2e-3;
        let u = sample.field(|x| x.map(|x| strain * x));
        let (f, energy) = sample.force(&u);
        let tension = MATERIAL.young * AREA * strain;
        // numbered backwards: the last node comes first
        let mut exact = vec![0.0; sample.n];
        for i in 0..dim {
            exact[i] = tension * axis[i];
            exact[sample.n - dim + i] = -tension * axis[i];
        }
        assert!(distance(&f, &exact) < 1e-14, "{dim}D");
        assert!((energy - 0.5 * tension * strain * 2.0).abs() < 1e-16);
        for (volume, stress) in sample.body.stresses(&u, &[]) {
            assert!((volume - AREA * 2.0 / 7.0).abs() < 1e-15);
            for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
                let exact = MATERIAL.young * strain * axis[i] * axis[j];
                assert!((stress[(i, j)] - exact).abs() < 1e-15);
            }
        }
    }
}

#[test]
fn motion_across_the_axis_is_free() {
    for dim in 2..=3 {
        let (sample, axis) = bar(dim, 5);
        let across = [axis[1], -axis[0], 0.0];
        let u = sample.field(|x| across.map(|d| d * (3.0 * x[0]).sin()));
        let (f, energy) = sample.force(&u);
        assert!(largest(&f) < 1e-14 && energy < 1e-14);
    }
}

/// Numbers of elements around the width of a batch, and of several chunks.
#[test]
fn any_number_of_bars_in_series_is_a_spring() {
    for n in (1..40).chain([4095, 4096, 4097, 9000]) {
        let (sample, axis) = bar(3, n);
        let u = sample.field(|x| {
            let pull = if dot(x, x).sqrt() > 2.0 - 1e-9 {
                1.0
            } else {
                0.0
            };
            axis.map(|a| a * pull)
        });
        let (f, energy) = sample.force(&u);
        let stiffness = MATERIAL.young * AREA * n as f64 / 2.0;
        assert!(
            (dot(&f[..3], &axis) - stiffness).abs() < 1e-11 * stiffness,
            "{n}"
        );
        assert!((energy - 0.5 * stiffness).abs() < 1e-11 * stiffness, "{n}");
    }
}
