//! Bodies whose points remember: plasticity and viscosity.

use super::{Step, displacement, inelastic, probes, samples};
use crate::sample::{Sample, largest};

const STEP: f64 = 1e-5;

/// A second step, after one that has flowed.
fn second<'a>(sample: &'a Sample) -> Step<'a> {
    let mut step = Step::new(sample);
    step.old = step.run(&displacement(sample, 81)).unwrap().2;
    assert!(step.old.iter().all(|h| h.is_finite()), "all is written");
    step
}

/// The return of the metal is the minimum of what is stored and dissipated, at the plastic strain that it finds.
#[test]
fn the_force_of_a_metal_is_the_derivative_of_what_is_stored_and_dissipated() {
    for sample in samples(&inelastic()[0]) {
        let step = second(&sample);
        let u = displacement(&sample, 82);
        let (f, stored, _) = step.run(&u).unwrap();
        assert!(stored.dissipated > 0.0 && stored.hardening > 0.0);
        for i in probes(sample.n) {
            let at = |side: f64| {
                let mut moved = u.clone();
                moved[i] += side * STEP;
                step.potential(&moved)
            };
            let error = ((at(1.0) - at(-1.0)) / (2.0 * STEP) - f[i]).abs();
            // central differences, as for elastic laws; the return has corners where it turns on
            assert!(error < 1e-7 * largest(&f), "{}: {error}", sample.name);
        }
    }
}

#[test]
fn tangents_after_a_step_are_the_derivatives_of_the_force() {
    for sample in inelastic().iter().flat_map(samples) {
        let step = second(&sample);
        let u = displacement(&sample, 82);
        let (k, n) = (step.tangent(&u), sample.n);
        for i in probes(n) {
            let at = |side: f64| {
                let mut moved = u.clone();
                moved[i] += side * STEP;
                step.force(&moved)
            };
            let (above, below) = (at(1.0), at(-1.0));
            for row in 0..n {
                let slope = (above[row] - below[row]) / (2.0 * STEP);
                let error = (slope - k[row * n + i]).abs();
                assert!(error < 1e-7 * largest(&k), "{}: {error}", sample.name);
            }
        }
    }
}

/// Without time and motion nothing more happens: the stress of a step is that of its end.
#[test]
fn a_step_of_no_time_and_no_motion_changes_nothing() {
    for sample in inelastic().iter().flat_map(samples) {
        let u = displacement(&sample, 83);
        let (f, stored, new) = second(&sample).run(&u).unwrap();
        let mut again = Step::new(&sample);
        again.old = new;
        let mut at = again.at(&u);
        at.dt = 0.0;
        let (mut f_again, mut history) = (vec![0.0; sample.n], again.old.clone());
        let body = &sample.body;
        let kept = body
            .force(&at, &mut history, &mut Default::default(), &mut f_again)
            .unwrap();
        let error = crate::sample::distance(&f, &f_again);
        // the elastic trial state is recovered from the history to round-off
        assert!(error < 1e-12 * largest(&f), "{}: {error}", sample.name);
        assert!((kept.strain - stored.strain).abs() < 1e-12 * stored.strain);
        assert!(kept.dissipated.abs() < 1e-12 * stored.dissipated);
    }
}

#[test]
fn plastic_strain_is_read_from_the_history() {
    let laws = inelastic();
    for sample in samples(&laws[0]) {
        let fresh = Step::new(&sample);
        let zero = sample.body.plastic_strains(&fresh.old).unwrap();
        assert!(zero.iter().all(|strain| *strain == 0.0));
        let strains = sample.body.plastic_strains(&second(&sample).old).unwrap();
        assert_eq!(strains.len(), sample.body.cells().len());
        // the hardening energy is ∫ H ε_p²/2 dV, at least that of the mean strains
        let hardening = fresh.run(&displacement(&sample, 81)).unwrap().1.hardening;
        let volumes = sample.body.stresses(&vec![0.0; sample.n], &fresh.old);
        let means: f64 = strains
            .iter()
            .zip(&volumes)
            .map(|(strain, (volume, _))| 0.1 * strain * strain * volume)
            .sum();
        let ratio = means / hardening;
        assert!(
            ratio > 0.5 && ratio < 1.0 + 1e-12,
            "{}: {ratio}",
            sample.name
        );
    }
    for sample in samples(&laws[1]) {
        let history = Step::new(&sample).old;
        assert!(sample.body.plastic_strains(&history).is_none());
    }
}
