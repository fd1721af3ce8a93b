//! Maxwell viscoelasticity: relaxation and creep against their exponentials, and where the work goes.

use carom_algebra::tensor::Mat3;
use carom_materials::{Branch, Material, Maxwell, Response, Want};
use carom_testing::Random;

use crate::support::{INITIAL, POLYMER, random_f, start};

fn respond(law: &Maxwell, f: &Mat3, dt: f64, old: &mut Vec<f64>) -> Response {
    let mut new = vec![f64::NAN; old.len()];
    let response = law.update(f, dt, (old, &mut new), Want::Stress).unwrap();
    *old = new;
    response
}

/// A symmetric F with the Green-Lagrange strain `e`, by Newton's square root of I + 2E.
fn stretch(e: &Mat3) -> Mat3 {
    let c = Mat3::identity() + e * 2.0;
    let mut u = Mat3::identity();
    for _ in 0..40 {
        u = (u + u.try_inverse().unwrap() * c) * 0.5;
    }
    u
}

fn shear(gamma: f64) -> Mat3 {
    let mut e = Mat3::zeros();
    (e[(0, 1)], e[(1, 0)]) = (gamma, gamma);
    stretch(&e)
}

/// S_12 of a stress P at F.
fn shear_stress(f: &Mat3, response: &Response) -> f64 {
    (f.try_inverse().unwrap() * response.stress)[(0, 1)]
}

#[test]
fn a_held_strain_relaxes_as_its_exponentials_whatever_the_steps() {
    let mu = INITIAL.shear_modulus();
    let f = shear(0.1);
    for dt in [1e-3, 0.07, 1.0] {
        let mut old = start(&POLYMER);
        respond(&POLYMER, &f, 0.0, &mut old);
        let mut time = 0.0;
        for _ in 0..20 {
            let response = respond(&POLYMER, &f, dt, &mut old);
            time += dt;
            let left = 0.3 + 0.4 * f64::exp(-time / 0.1) + 0.3 * f64::exp(-time / 2.0);
            let expected = 2.0 * mu * left * 0.1;
            assert!((shear_stress(&f, &response) - expected).abs() < 1e-15);
        }
    }
}

#[test]
fn one_step_of_an_even_strain_is_many_small_ones() {
    let mut random = Random(41);
    let g = random_f(&mut random, 0.1) - Mat3::identity();
    let (rate, held) = (
        g + g.transpose(),
        Mat3::from_diagonal(&[0.05, 0.0, -0.02].into()),
    );
    for dt in [1e-3, 0.05, 3.0, 1e3] {
        let mut many = start(&POLYMER);
        respond(&POLYMER, &stretch(&held), 0.1, &mut many);
        let mut one = many.clone();
        let end = stretch(&(held + rate));
        let last = respond(&POLYMER, &end, dt, &mut one);
        let mut dissipated = 0.0;
        for k in 1..=50 {
            let f = stretch(&(held + rate * (f64::from(k) / 50.0)));
            let response = respond(&POLYMER, &f, dt / 50.0, &mut many);
            assert!(response.dissipated >= 0.0);
            dissipated += response.dissipated;
            if k == 50 {
                // round-off of 50 steps of strains of 0.1
                assert!((response.stress - last.stress).amax() < 1e-14);
                assert!((response.stored - last.stored).abs() < 1e-15);
            }
        }
        assert!((dissipated - last.dissipated).abs() < 1e-15);
    }
}

#[test]
fn infinite_time_leaves_the_lasting_spring() {
    let f = shear(0.1);
    let mut old = start(&POLYMER);
    let response = respond(&POLYMER, &f, f64::INFINITY, &mut old);
    let expected = 2.0 * INITIAL.shear_modulus() * 0.3 * 0.1;
    assert!((shear_stress(&f, &response) - expected).abs() < 1e-16);
    // nothing of the branches is left, and an infinitely slow strain dissipates nothing
    assert!(old[6..].iter().all(|&x| x == 0.0));
    assert_eq!(response.dissipated, 0.0);
}

/// One branch, g = 0.6, τ = 0.5 s.
const SOLID: Maxwell = Maxwell {
    initial: INITIAL,
    branches: [
        Some(Branch {
            ratio: 0.6,
            time: 0.5,
        }),
        None,
        None,
        None,
    ],
};

/// Creep under S_12 = `stress` from t = 0 to 1 s in equal steps: the strain at the end and the part of the work that is
/// neither stored nor dissipated.
fn creep(stress: f64, steps: usize) -> (f64, f64) {
    let mu = INITIAL.shear_modulus();
    let dt = 1.0 / steps as f64;
    let mut old = start(&SOLID);
    let mut gamma = stress / (2.0 * mu);
    let mut stored = respond(&SOLID, &shear(gamma), 0.0, &mut old).stored;
    let mut rest = 0.0;
    for _ in 0..steps {
        // the stress is linear in the strain of the end: two trials give it
        let at = |gamma: f64| {
            let f = shear(gamma);
            shear_stress(&f, &respond(&SOLID, &f, dt, &mut old.clone()))
        };
        let (s_0, s_1) = (at(gamma), at(gamma + 0.01));
        let next = gamma + 0.01 * (stress - s_0) / (s_1 - s_0);
        let response = respond(&SOLID, &shear(next), dt, &mut old);
        rest += 2.0 * stress * (next - gamma) - (response.stored - stored) - response.dissipated;
        (gamma, stored) = (next, response.stored);
    }
    (gamma, rest)
}

#[test]
fn a_held_stress_creeps_as_the_standard_solid_and_its_work_is_stored_or_dissipated() {
    let mu = INITIAL.shear_modulus();
    let (stress, lasting) = (0.05, 0.4);
    let last = 1.0 / lasting;
    let exact = stress / (2.0 * mu) * (last - (last - 1.0) * f64::exp(-lasting * 1.0 / 0.5));
    let (coarse, fine) = (creep(stress, 20), creep(stress, 40));
    // strain even over a step: second order, 1/4 when the step halves
    let ratio = (fine.0 - exact) / (coarse.0 - exact);
    assert!((ratio - 0.25).abs() < 0.01, "{ratio}");
    assert!((fine.0 - exact).abs() < 1e-3 * exact);
    // the stress within a step departs from the held one by the square of the step: so does the balance
    let ratio = fine.1 / coarse.1;
    assert!((ratio - 0.25).abs() < 0.02, "{ratio}");
    assert!(fine.1.abs() < 1e-3 * stress * exact);
}
