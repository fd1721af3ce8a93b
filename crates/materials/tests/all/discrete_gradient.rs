//! The algorithmic stress of a step: its work is the change of energy, whatever the step.

use carom_algebra::tensor::Mat3;
use carom_materials::{Material, Response, Want};
use carom_testing::Random;

use crate::support::{for_each, random_f, random_rotation, step, tangent_error, times};

fn between(law: &dyn Material, f_0: &Mat3, f_1: &Mat3) -> Option<Response> {
    law.between(f_0, f_1, Want::Tangent)
        .map(|answer| answer.unwrap())
}

fn stored(law: &dyn Material, f: &Mat3) -> f64 {
    step(law, f, &[], Want::Stress).unwrap().0.stored
}

/// Steps of one size, some of them with a rotation.
fn steps(random: &mut Random, size: f64) -> Vec<(Mat3, Mat3)> {
    let mut list = Vec::new();
    for _ in 0..4 {
        let f_0 = random_f(random, 0.25);
        let f_1 = f_0 + Mat3::from_fn(|_, _| size * random.next());
        list.push((f_0, f_1));
        list.push((f_0, random_rotation(random) * f_1));
    }
    list
}

/// Steps of all sizes.
fn all_steps(random: &mut Random) -> Vec<(Mat3, Mat3)> {
    let sizes = [0.3, 1e-2, 1e-4, 1e-7, 1e-10, 1e-14];
    sizes
        .into_iter()
        .flat_map(|size| steps(random, size))
        .collect()
}

#[test]
fn its_work_is_the_change_of_the_stored_energy() {
    for_each(|name, law| {
        for (f_0, f_1) in all_steps(&mut Random(21)) {
            let Some(response) = between(law, &f_0, &f_1) else {
                return;
            };
            let (psi_0, psi_1) = (stored(law, &f_0), stored(law, &f_1));
            assert_eq!(response.stored, psi_1, "{name}");
            let work = response.stress.dot(&(f_1 - f_0));
            let error = (work - (psi_1 - psi_0)).abs();
            // energies of order 0.1 to 1, sums of nine terms of that order
            assert!(error < 1e-14, "{name}: {error:e}");
        }
    });
}

#[test]
fn a_step_of_no_size_gives_the_stress_there_and_half_of_the_tangent() {
    for_each(|name, law| {
        let mut random = Random(22);
        for _ in 0..4 {
            let f = random_f(&mut random, 0.25);
            let Some(response) = between(law, &f, &f) else {
                return;
            };
            let here = step(law, &f, &[], Want::Tangent).unwrap().0;
            assert!((response.stress - here.stress).amax() < 1e-15, "{name}");
            let (a, b) = (response.tangent.unwrap(), here.tangent.unwrap());
            let entries = a.iter().flatten().zip(b.iter().flatten());
            let error = entries
                .map(|(a, b)| (a - 0.5 * b).abs())
                .fold(0.0, f64::max);
            assert!(error < 1e-14, "{name}");
        }
    });
}

#[test]
fn a_tiny_step_brings_no_noise_into_the_stress() {
    for_each(|name, law| {
        let mut random = Random(23);
        for size in [1e-5, 1e-7, 1e-9, 1e-12, 1e-15] {
            let f_0 = random_f(&mut random, 0.25);
            let f_1 = f_0 + Mat3::from_fn(|_, _| size * random.next());
            let Some(response) = between(law, &f_0, &f_1) else {
                return;
            };
            let middle = step(law, &((f_0 + f_1) * 0.5), &[], Want::Stress)
                .unwrap()
                .0;
            // both are second-order means of the step, and differ by its square and round-off
            let error = (response.stress - middle.stress).amax();
            assert!(
                error < 10.0 * size * size + 1e-15,
                "{name}: {error:e} at {size:e}"
            );
        }
    });
}

#[test]
fn it_turns_with_both_ends_and_keeps_the_moment() {
    for_each(|name, law| {
        let mut random = Random(24);
        for (f_0, f_1) in all_steps(&mut Random(25)) {
            let q = random_rotation(&mut random);
            let Some(here) = between(law, &f_0, &f_1) else {
                return;
            };
            let turned = between(law, &(q * f_0), &(q * f_1)).unwrap();
            assert!((turned.stress - q * here.stress).amax() < 1e-14, "{name}");
            // P_alg F_mᵀ symmetric: the angular momentum of the mid-point rule is kept
            let moment = here.stress * (f_0 + f_1).transpose();
            assert!((moment - moment.transpose()).amax() < 1e-15, "{name}");
        }
    });
}

#[test]
fn its_tangent_is_its_derivative_by_the_end() {
    for_each(|name, law| {
        let mut random = Random(26);
        // D x/(D:D) has a kink at D = 0: differences stay well on one side of it, or reach as far on both
        for (size, h) in [
            (0.3, 1e-3),
            (1e-2, 1e-4),
            (1e-4, 2e-6),
            (1e-10, 1e-3),
            (1e-14, 1e-3),
        ] {
            for (f_0, f_1) in steps(&mut random, size) {
                let Some(response) = between(law, &f_0, &f_1) else {
                    return;
                };
                let stress = |f: &Mat3| between(law, &f_0, f).unwrap().stress;
                let error = tangent_error(&response.tangent.unwrap(), &f_1, h, stress);
                // (h/size)⁴ of a part as large as the step, and round-off 1e-16/h
                assert!(error < 1e-8, "{name}: {error:e} at {size:e}");
            }
        }
    });
}

#[test]
fn strains_alone_give_the_same_stress_and_tangent() {
    for_each(|name, law| {
        for (f_0, f_1) in all_steps(&mut Random(27)) {
            let f_m = (f_0 + f_1) * 0.5;
            let product = f_m.transpose() * (f_1 - f_0);
            let d = (product + product.transpose()) * 0.5;
            let e_1 = (f_1.transpose() * f_1 - Mat3::identity()) * 0.5;
            let strains = law.between_strains(&e_1, &d, Want::Tangent);
            let response = between(law, &f_0, &f_1);
            assert_eq!(strains.is_some(), response.is_some(), "{name}");
            let (Some(Ok(strains)), Some(response)) = (strains, response) else {
                return;
            };
            let s = strains.stress;
            assert!((f_m * s - response.stress).amax() < 1e-14, "{name}");
            assert!((strains.stored - response.stored).abs() < 1e-15, "{name}");
            // δP = δF S/2 + F_m 𝕂:sym(F_1ᵀ δF)
            let (moduli, tangent) = (strains.moduli.unwrap(), response.tangent.unwrap());
            for kl in 0..9 {
                let mut h = Mat3::zeros();
                h[(kl / 3, kl % 3)] = 1.0;
                let pushed = h * s * 0.5 + f_m * times(&moduli, &(f_1.transpose() * h));
                let error = (pushed - times(&tangent, &h)).amax();
                // w is a difference of stresses over D:D: D⊗w carries their rounding over |D|, and is left out below 1e-8
                let rounding = 1e-13 + 1e-15 / d.norm().max(1e-8);
                assert!(error < rounding, "{name}: {error:e} at {:e}", d.norm());
            }
        }
    });
}

#[test]
fn an_end_inside_out_fails() {
    for_each(|name, law| {
        let mirror = Mat3::from_diagonal(&[1.0, 1.0, -0.5].into());
        for (f_0, f_1) in [(mirror, Mat3::identity()), (Mat3::identity(), mirror)] {
            if let Some(answer) = law.between(&f_0, &f_1, Want::Stress) {
                assert!(answer.is_err(), "{name}");
            }
        }
    });
}
