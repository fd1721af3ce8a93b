//! Energy by which linear quadrilaterals and hexahedra lock in bending, against its closed form.

use carom_bodies::{Bending, Formulation, Kinematics};
use carom_materials::{Law, NeoHooke};
use carom_mesh::{Mesh, generate};
use carom_testing::allocations;

use crate::sample::{MATERIAL, Sample, continua};

/// Length of the strip; its height is one.
const LENGTH: f64 = 6.0;
const CURVATURE: f64 = 1e-6;

fn strip(elements: [usize; 2]) -> Mesh {
    generate::rectangle("b", [-0.5 * LENGTH, -0.5], [LENGTH, 1.0], elements, false)
}

/// Pure bending, u = κ (x y, -½ (x² + ν y²)).
fn bend(sample: &Sample, poisson: f64) -> Bending {
    let u = sample.field(|x| {
        [
            CURVATURE * x[0] * x[1],
            -0.5 * CURVATURE * (x[0] * x[0] + poisson * x[1] * x[1]),
            0.0,
        ]
    });
    sample.body.bending(&u).unwrap()
}

/// Of a dozen products and sums of thousands of elements.
const ROUNDING: f64 = 1e-9;

#[test]
fn in_pure_bending_the_energy_beyond_that_of_bending_is_the_one_of_the_theory() {
    for kinematics in [
        Kinematics::PlaneStress { thickness: 1.0 },
        Kinematics::PlaneStrain { thickness: 1.0 },
    ] {
        // plane strain is plane stress with other constants
        let (young, poisson) = match kinematics {
            Kinematics::PlaneStress { .. } => (MATERIAL.young, MATERIAL.poisson),
            _ => (
                MATERIAL.young / (1.0 - MATERIAL.poisson.powi(2)),
                MATERIAL.poisson / (1.0 - MATERIAL.poisson),
            ),
        };
        for (along, across) in [(3, 1), (6, 1), (24, 1), (6, 2), (48, 8)] {
            let sample = Sample::new("strip", strip([along, across]), kinematics);
            let found = bend(&sample, poisson);
            // ½ E I κ² L
            let exact = 0.5 * young / 12.0 * CURVATURE.powi(2) * LENGTH;
            let left = found.energy - found.locked;
            assert!((left / exact - 1.0).abs() < ROUNDING, "{left} {exact}");
            // 1/(1 - ν²) (1 + ½ (1 - ν) (L/h)²) of one layer, whose excess is divided by the square of the number of layers
            let slender = LENGTH / along as f64 * across as f64;
            let too_stiff =
                (1.0 + 0.5 * (1.0 - poisson) * slender.powi(2)) / (1.0 - poisson.powi(2));
            let expected = (too_stiff - 1.0) / (across as f64).powi(2);
            let excess = found.locked / left;
            assert!(
                (excess / expected - 1.0).abs() < ROUNDING,
                "{}, {along} x {across}: {excess} {expected}",
                sample.name
            );
        }
    }
}

#[test]
fn hexahedra_lock_as_quadrilaterals_in_a_plane_do() {
    // without Poisson's ratio bending in space is that in the plane
    let material = Law::Elastic(carom_materials::Elastic {
        poisson: 0.0,
        ..MATERIAL
    });
    let mesh = generate::box_(
        "b",
        [-0.5 * LENGTH, -0.5, 0.0],
        [LENGTH, 1.0, 2.0],
        [6, 2, 2],
        false,
    );
    let sample = Sample::of("box", mesh, Kinematics::Solid, material, Formulation::Full);
    let found = bend(&sample, 0.0);
    let expected = 0.5 * 2.0_f64.powi(2) / 4.0;
    let excess = found.locked / (found.energy - found.locked);
    assert!((excess / expected - 1.0).abs() < ROUNDING, "{excess}");
}

#[test]
fn constant_strains_do_not_lock_and_the_energy_is_that_of_the_elements() {
    for sample in continua() {
        let h = [
            [0.03, 0.02, -0.01],
            [-0.01, -0.05, 0.04],
            [0.02, 0.01, 0.02],
        ];
        let dim = sample.dim();
        let u = sample.field(|x| [0, 1, 2].map(|i| (0..dim).map(|j| h[i][j] * x[j]).sum::<f64>()));
        let linear = ["quad4", "hex8"]
            .iter()
            .any(|kind| sample.name.starts_with(kind));
        let found = sample.body.bending(&u);
        if !linear {
            let has_some = sample.name.contains("quad4") || sample.name.contains("hex8");
            assert_eq!(found.is_some(), has_some, "{}", sample.name);
            continue;
        }
        let found = found.unwrap();
        assert!(
            found.locked.abs() < 1e-12 * found.energy,
            "{}: {found:?}",
            sample.name
        );
        let round = sample.body.kinematics() == Kinematics::Axisymmetric;
        let mut scratch = carom_bodies::Scratch::default();
        let energy = sample
            .body
            .internal_force(&u, &mut scratch, &mut vec![0.0; sample.n]);
        // of a distorted element the map of the centre has the area in the plane, and in space all but some percent of the volume; the
        // hoop strain u_r/r varies
        let tolerance = match (dim, round) {
            (2, false) => 1e-12,
            _ => 0.03,
        };
        let apart = (found.energy / energy - 1.0).abs();
        assert!(apart < tolerance, "{}: {apart:e}", sample.name);
    }
}

#[test]
fn a_strip_that_has_turned_locks_as_much() {
    let law = || Law::NeoHooke(NeoHooke { initial: MATERIAL });
    let kinematics = Kinematics::PlaneStrain { thickness: 1.0 };
    let poisson = MATERIAL.poisson / (1.0 - MATERIAL.poisson);
    let small = bend(&Sample::new("strip", strip([6, 1]), kinematics), poisson);
    let sample = Sample::of("strip", strip([6, 1]), kinematics, law(), Formulation::Full);
    let (s, c) = 0.8_f64.sin_cos();
    let u = sample.field(|x| {
        let bent = [
            x[0] + CURVATURE * x[0] * x[1],
            x[1] - 0.5 * CURVATURE * (x[0] * x[0] + poisson * x[1] * x[1]),
        ];
        [
            c * bent[0] - s * bent[1] - x[0],
            s * bent[0] + c * bent[1] - x[1],
            0.0,
        ]
    });
    let turned = sample.body.bending(&u).unwrap();
    // Green's strain differs from the small one by its product with the strain and the rotation of elements, of some 1e-5
    for (one, other) in [(turned.energy, small.energy), (turned.locked, small.locked)] {
        assert!((one / other - 1.0).abs() < 1e-4, "{one} {other}");
    }
    let one_point = Formulation::Reduced { hourglass: 0.05 };
    let sample = Sample::of("strip", strip([6, 1]), kinematics, law(), one_point);
    assert_eq!(sample.body.bending(&u), None);
}

#[test]
fn mean_dilatation_is_not_told_for_what_it_does_not_lock_by() {
    // all stiffness against the change of the volume in full integration, none with mean dilatation
    let initial = carom_materials::Elastic {
        poisson: 0.4999,
        ..MATERIAL
    };
    let kinematics = Kinematics::PlaneStrain { thickness: 1.0 };
    let share = |formulation| {
        let law = Law::NeoHooke(NeoHooke { initial });
        let sample = Sample::of("strip", strip([48, 8]), kinematics, law, formulation);
        let found = bend(&sample, 0.4999 / 0.5001);
        found.locked / found.energy
    };
    // of 64 (2 layers: a quarter, and so on) of E/(1 - ν²) against λ + 2μ, a factor of some 1250
    let full = share(Formulation::Full);
    assert!(full > 0.9, "{full}");
    let mean = share(Formulation::BBar);
    assert!(mean < 0.02, "{mean}");
}

#[test]
fn it_allocates_nothing_and_is_the_same_for_any_number_of_threads() {
    let sample = Sample::new(
        "strip",
        strip([96, 64]),
        Kinematics::PlaneStress { thickness: 1.0 },
    );
    let u = sample.field(|x| [x[0] * x[1], (3.0 * x[0]).sin(), 0.0]);
    let measure = || sample.body.bending(&u).unwrap();
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
    assert_eq!(counted, 0);
}
