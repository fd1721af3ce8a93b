//! J2 plasticity: the known curve of a tension test, flow from a state that has flowed, and where the work goes.

use carom_algebra::tensor::Mat3;
use carom_materials::{J2Plasticity, Response, Want};
use carom_testing::Random;

use crate::support::{
    INITIAL, METAL, asymmetry, random_f, random_rotation, start, step, tangent_error,
};

/// Principal stretches of a bar under uniaxial tension at the axial stretch `axial`, found by Newton on the side stress.
fn tension(law: &J2Plasticity, axial: f64, old: &[f64]) -> (Mat3, Response, Vec<f64>) {
    let mut side: f64 = 1.0;
    for _ in 0..30 {
        let f = Mat3::from_diagonal(&[axial, side, side].into());
        let (response, new) = step(law, &f, old, Want::Tangent).unwrap();
        let tangent = response.tangent.as_ref().unwrap();
        let change = response.stress[(1, 1)] / (tangent[4][4] + tangent[4][8]);
        if change.abs() < 1e-15 {
            return (f, response, new);
        }
        side -= change;
    }
    panic!("the side stress was not removed");
}

#[test]
fn tension_follows_the_closed_curve_in_logarithmic_strain() {
    // τ = E ε up to yield, then E H/(E + H) as slope: uniaxial stress in logarithmic strain is the law of small strain, and
    // the path is proportional, so that steps of any size give it to round-off
    let (young, hardening) = (INITIAL.young, METAL.hardening);
    let yielded = METAL.yield_stress / young;
    let mut old = start(&METAL);
    for strain in [0.01, 0.03, 0.05, 0.2, 0.21, 0.7] {
        let (f, response, new) = tension(&METAL, f64::exp(strain), &old);
        let slope = young * hardening / (young + hardening);
        let expected = if strain < yielded {
            young * strain
        } else {
            METAL.yield_stress + slope * (strain - yielded)
        };
        let kirchhoff = response.stress[(0, 0)] * f[(0, 0)];
        assert!((kirchhoff - expected).abs() < 1e-14, "{strain}");
        let plastic = (strain - kirchhoff / young).max(0.0);
        assert!((new[6] - plastic).abs() < 1e-14, "{strain}");
        assert!((response.hardening - 0.5 * hardening * plastic * plastic).abs() < 1e-14);
        assert!((response.stored - 0.5 * kirchhoff * kirchhoff / young).abs() < 1e-14);
        assert!((response.dissipated - METAL.yield_stress * (new[6] - old[6])).abs() < 1e-14);
        // side stretch: elastic contraction by ν, plastic one at constant volume
        let side = -INITIAL.poisson * (strain - plastic) - 0.5 * plastic;
        assert!((f[(1, 1)].ln() - side).abs() < 1e-14, "{strain}");
        old = new;
    }
}

#[test]
fn unloading_is_elastic_and_leaves_the_plastic_stretch() {
    let (_, loaded, old) = tension(&METAL, 1.5, &start(&METAL));
    let plastic = Mat3::from_diagonal(&[old[6], -0.5 * old[6], -0.5 * old[6]].map(f64::exp).into());
    let (unloaded, new) = step(&METAL, &plastic, &old, Want::Stress).unwrap();
    assert!(loaded.dissipated > 0.0 && unloaded.dissipated == 0.0);
    assert!(unloaded.stress.amax() < 1e-15 && unloaded.stored < 1e-28);
    assert_eq!(old, new);
}

/// Histories after one and after two random steps that flow.
fn histories(random: &mut Random) -> Vec<(Mat3, Vec<f64>)> {
    let mut list = Vec::new();
    for _ in 0..6 {
        let mut old = start(&METAL);
        let mut f = Mat3::identity();
        for _ in 0..2 {
            f = random_f(random, 0.2) * f;
            let (response, new) = step(&METAL, &f, &old, Want::Stress).unwrap();
            assert!(response.dissipated > 0.0);
            old = new;
            list.push((f, old.clone()));
        }
    }
    list
}

#[test]
fn flow_that_goes_on_has_an_exact_symmetric_tangent() {
    let mut random = Random(31);
    let mut flowed = 0;
    for (f, old) in histories(&mut random) {
        let next = random_f(&mut random, 0.2) * f;
        let (response, new) = step(&METAL, &next, &old, Want::Tangent).unwrap();
        // elsewhere it unloads, or the differences reach the yield surface
        if new[6] < old[6] + 1e-2 {
            continue;
        }
        flowed += 1;
        let tangent = response.tangent.unwrap();
        let stress = |f: &Mat3| step(&METAL, f, &old, Want::Stress).unwrap().0.stress;
        // as in the battery; columns of F shrink to 0.5 here
        assert!(tangent_error(&tangent, &next, 5e-4, stress) < 5e-9);
        assert!(asymmetry(&tangent) < 1e-13);
    }
    assert!(flowed >= 6);
}

#[test]
fn elastic_states_have_the_derivative_of_the_stored_energy_as_stress() {
    let mut random = Random(32);
    for (f, mut old) in histories(&mut random) {
        // hardened to stay elastic here
        old[6] += 100.0;
        let next = random_f(&mut random, 0.05) * f;
        let stored = |f: &Mat3| step(&METAL, f, &old, Want::Stress).unwrap().0.stored;
        let response = step(&METAL, &next, &old, Want::Stress).unwrap().0;
        assert_eq!(response.dissipated, 0.0);
        for ij in 0..9 {
            let mut unit = Mat3::zeros();
            unit[(ij / 3, ij % 3)] = 1.0;
            let central =
                |h: f64| (stored(&(next + unit * h)) - stored(&(next - unit * h))) / (2.0 * h);
            let difference = (4.0 * central(5e-4) - central(1e-3)) / 3.0;
            // h⁴ times a fifth derivative of order 100
            assert!((difference - response.stress[(ij / 3, ij % 3)]).abs() < 1e-10);
        }
    }
}

#[test]
fn the_stress_stays_on_the_yield_surface_and_flow_keeps_the_volume() {
    let mut random = Random(33);
    for (f, old) in histories(&mut random) {
        let next = random_f(&mut random, 0.2) * f;
        let (response, new) = step(&METAL, &next, &old, Want::Stress).unwrap();
        let kirchhoff = response.stress * next.transpose();
        let dev = kirchhoff - Mat3::identity() * (kirchhoff.trace() / 3.0);
        let yield_stress = METAL.yield_stress + METAL.hardening * new[6];
        assert!((1.5_f64.sqrt() * dev.norm() - yield_stress).abs() < 1e-14);
        let metric = Mat3::identity()
            + Mat3::new(
                new[0], new[3], new[5], new[3], new[1], new[4], new[5], new[4], new[2],
            );
        assert!((metric.determinant() - 1.0).abs() < 1e-13);
        // a rotation of the whole history of motion leaves the history of the material alone
        let q = random_rotation(&mut random);
        let turned = step(&METAL, &(q * next), &old, Want::Stress).unwrap().1;
        assert!(turned.iter().zip(&new).all(|(a, b)| (a - b).abs() < 1e-13));
    }
}

#[test]
fn the_work_of_small_steps_is_stored_hardens_and_dissipates() {
    // P:dF by the trapezoid against the three terms: the return errs in the direction of the flow only, by the angle that it turns
    // in a step; q Δε_p loses its square, and so does the trapezoid. Over the path that is of second order
    let remainder = |steps: usize| {
        let mut random = Random(34);
        let (first, gradient) = (random_f(&mut random, 0.2), random_f(&mut random, 0.5));
        let mut old = start(&METAL);
        let (mut before, new) = step(&METAL, &first, &old, Want::Stress).unwrap();
        old = new;
        let mut f = first;
        let (mut rest, mut dissipated) = (0.0, 0.0);
        for _ in 0..steps {
            let next = f + (gradient - Mat3::identity()) * f / steps as f64;
            let (after, new) = step(&METAL, &next, &old, Want::Stress).unwrap();
            let work = 0.5 * (before.stress + after.stress).dot(&(next - f));
            let kept = after.stored - before.stored + after.hardening - before.hardening;
            rest += work - kept - after.dissipated;
            dissipated += after.dissipated;
            (before, old, f) = (after, new, next);
        }
        assert!(dissipated > 0.01);
        rest
    };
    let (coarse, fine) = (remainder(400), remainder(1600));
    let ratio = fine / coarse;
    assert!((ratio - 1.0 / 16.0).abs() < 0.01, "{ratio}");
    assert!(coarse.abs() < 1e-6, "{coarse:e}");
}
