//! Masses: totals, and products of fields.

use std::f64::consts::PI;

use carom_bodies::Kinematics;
use carom_mesh::generate;

use crate::sample::{
    AREA, MATERIAL, Sample, THICKNESS, all, cholesky, continua, dot, largest, multiply,
};

/// Volume of the samples of `sample.rs`, whose sides are not distorted.
fn volume(sample: &Sample) -> f64 {
    match sample.body.kinematics() {
        // beams and shells have samples of their own
        Kinematics::Beam(_) | Kinematics::Shell(_) => f64::NAN,
        Kinematics::Bar { area } => {
            let nodes = sample.x.windows(2).map(|x| {
                let d = [0, 1, 2].map(|i| x[1][i] - x[0][i]);
                dot(&d, &d).sqrt()
            });
            area * nodes.sum::<f64>()
        }
        Kinematics::PlaneStrain { thickness } | Kinematics::PlaneStress { thickness } => {
            1.2 * thickness
        }
        Kinematics::Axisymmetric => PI * (1.5f64.powi(2) - 0.5f64.powi(2)) * 1.2,
        Kinematics::Solid => 1.0 * 0.9 * 1.2,
    }
}

#[test]
fn total_mass_is_density_times_volume_lumped_and_consistent() {
    for sample in all() {
        let exact = MATERIAL.density * volume(&sample);
        let lumped = sample.lumped_mass();
        let consistent = sample.matrix(0.0, 1.0);
        for i in 0..sample.dim() {
            let unit = sample.field(|_| [0, 1, 2].map(|j| f64::from(i == j)));
            let errors = [
                dot(&lumped, &unit) - exact,
                dot(&unit, &multiply(&consistent, &unit)) - exact,
            ];
            assert!(
                largest(&errors) < 1e-13 * exact,
                "{}: {errors:?}",
                sample.name
            );
        }
        let stressed: f64 = sample
            .body
            .stresses(&vec![0.0; sample.n], &[])
            .iter()
            .map(|(v, _)| v)
            .sum();
        assert!((MATERIAL.density * stressed - exact).abs() < 1e-13 * exact);
    }
}

/// Whether the cells have nodes besides their corners.
fn is_quadratic(sample: &Sample) -> bool {
    let mut kinds = sample.mesh.blocks.iter();
    kinds.any(|block| block.kind.table().is_quadratic())
}

#[test]
fn lumped_mass_is_the_row_sum_of_the_consistent_mass_and_positive() {
    for sample in all().into_iter().filter(|sample| !is_quadratic(sample)) {
        let sums = multiply(&sample.matrix(0.0, 1.0), &vec![1.0; sample.n]);
        for (sum, mass) in sums.iter().zip(sample.lumped_mass()) {
            assert!(mass > 0.0 && (sum - mass).abs() < 1e-14, "{}", sample.name);
        }
    }
}

#[test]
fn consistent_mass_is_positive_definite() {
    for sample in all() {
        let matrix = sample.matrix(0.0, 1.0);
        assert!(
            cholesky(&matrix).1 > 1e-3 * largest(&matrix),
            "{}",
            sample.name
        );
    }
}

/// vᵀ M v = ∫ ρ v² for linear v, on parallelograms and parallelepipeds, where the rules are exact.
#[test]
fn consistent_mass_integrates_products_of_linear_fields() {
    let plane = Kinematics::PlaneStrain {
        thickness: THICKNESS,
    };
    let square = |triangles| generate::rectangle("b", [0.0; 2], [1.0; 2], [2, 3], triangles);
    let cube = |tets| generate::box_("b", [0.0; 3], [1.0; 3], [2, 3, 2], tets);
    let bar = generate::line("b", [0.0; 3], [1.0, 0.0, 0.0], 4, 1);
    for (name, mut mesh, kinematics, section) in [
        ("bar2", bar, Kinematics::Bar { area: AREA }, AREA),
        ("tri3", square(true), plane, THICKNESS),
        ("quad4", square(false), plane, THICKNESS),
        ("tet4", cube(true), Kinematics::Solid, 1.0),
        ("hex8", cube(false), Kinematics::Solid, 1.0),
    ] {
        // x = A X, det A = 1, and v = g · X in the coordinates X of the unit cube
        let unit = mesh.nodes.clone();
        for x in &mut mesh.nodes {
            *x = [x[0] + 0.4 * x[1] - 0.2 * x[2], x[1] + 0.3 * x[2], x[2]];
        }
        let dim = mesh.dim;
        let sample = Sample::new(name, mesh, kinematics);
        let g = [1.3, -0.7, 0.4];
        let mut v = vec![0.0; sample.n];
        for (node, x) in unit.iter().enumerate() {
            v[dim * sample.number[node] as usize] = dot(&g, x);
        }
        // ∫ (g · X)² over the unit cube: Σ g_i g_j / 4, and g_i² / 12 more on the diagonal
        let sum: f64 = g[..dim].iter().sum();
        let exact = sum * sum / 4.0 + dot(&g[..dim], &g[..dim]) / 12.0;
        let product = dot(&v, &multiply(&sample.matrix(0.0, 1.0), &v));
        let error = product - MATERIAL.density * section * exact;
        assert!(error.abs() < 1e-13, "{name}: {error}");
    }
}

/// Linear momentum of a rotation about the centre of mass is zero: first moments are exact too.
#[test]
fn lumped_mass_has_the_centre_of_mass_of_the_box() {
    for sample in continua() {
        if sample.body.kinematics() == Kinematics::Axisymmetric {
            continue;
        }
        let mass = sample.lumped_mass();
        let centre = [1.0, if sample.dim() == 2 { 0.6 } else { 0.45 }, 0.6];
        for i in 0..sample.dim() {
            let position = sample.field(|x| [0, 1, 2].map(|j| f64::from(i == j) * x[i]));
            let first = dot(&mass, &position);
            let exact = MATERIAL.density * volume(&sample) * centre[i];
            // exact where the rule integrates x N_a: not quite on distorted hexahedra
            assert!((first - exact).abs() < 1e-3 * exact, "{}", sample.name);
        }
    }
}
