//! Algorithmic forces between two displacements: exact work, no resultant, no moment.

use carom_bodies::{Error, Formulation, Kinematics};
use carom_materials::{Elastic, Law, NeoHooke};
use carom_testing::Random;

use super::{Step, displacement, elastic, inelastic, rotation, samples};
use crate::sample::{MATERIAL, Sample, distance, dot, largest};

/// A displacement turned by 0.4 from the other one, and strained otherwise, by a fifth on the whole.
fn ends(sample: &Sample) -> (Vec<f64>, Vec<f64>) {
    let begin = displacement(sample, 21);
    let mut end = displacement(sample, 22);
    let strain = sample.field(|x| [0.2 * x[0], -0.15 * x[1], 0.1 * x[2]]);
    end.iter_mut().zip(strain).for_each(|(u, more)| *u += more);
    if sample.body.kinematics() != Kinematics::Axisymmetric {
        let turn = rotation(sample, 0.4);
        end.iter_mut().zip(turn).for_each(|(u, turn)| *u += turn);
    }
    (begin, end)
}

/// Every law, a nearly incompressible one too.
fn laws() -> Vec<(&'static str, Law)> {
    let initial = Elastic {
        poisson: 0.499,
        ..MATERIAL
    };
    let nearly = ("nearly incompressible", Law::NeoHooke(NeoHooke { initial }));
    elastic().into_iter().chain([nearly]).collect()
}

/// Every law, kind and formulation, plain and with random weights.
fn conserving() -> Vec<Sample> {
    let all = laws();
    let weighted = all.iter().flat_map(samples).map(|sample| {
        let weights = sample.random_weights(25);
        sample.weighted(weights)
    });
    all.iter().flat_map(samples).chain(weighted).collect()
}

#[test]
fn work_over_a_step_is_the_change_of_energy() {
    for sample in conserving() {
        let (begin, end) = ends(&sample);
        let (f, stored, _) = Step::between(&sample, &begin).run(&end).unwrap();
        let before = Step::new(&sample).potential(&begin);
        let move_: Vec<f64> = end.iter().zip(&begin).map(|(u, from)| u - from).collect();
        let error = (dot(&f, &move_) - (stored.strain - before)).abs();
        // sums of some hundred terms of the size of the energies
        assert!(
            error < 1e-13 * (stored.strain + before),
            "{}: {error}",
            sample.name
        );
    }
}

#[test]
fn algorithmic_forces_have_no_resultant_and_no_moment_at_the_middle() {
    for sample in conserving() {
        if sample.body.kinematics() == Kinematics::Axisymmetric {
            continue;
        }
        let (begin, end) = ends(&sample);
        let f = Step::between(&sample, &begin).force(&end);
        let dim = sample.dim();
        let (mut sum, mut moment) = ([0.0; 3], [0.0; 3]);
        for (node, x) in sample.x.iter().enumerate() {
            let (mut middle, mut force) = (*x, [0.0; 3]);
            for i in 0..dim {
                let k = dim * node + i;
                middle[i] += 0.5 * (begin[k] + end[k]);
                force[i] = f[k];
                sum[i] += f[k];
            }
            let arm = crate::sample::cross(&middle, &force);
            moment
                .iter_mut()
                .zip(arm)
                .for_each(|(sum, arm)| *sum += arm);
        }
        let scale = 1e-14 * sample.n as f64 * largest(&f);
        assert!(largest(&sum) < scale, "{}: {sum:?}", sample.name);
        assert!(largest(&moment) < scale, "{}: {moment:?}", sample.name);
    }
}

#[test]
fn tangent_is_the_derivative_by_the_end() {
    // single slopes have all of the third derivative that a mean of two halves loses: a third of the step of those below
    const STEP: f64 = 3e-6;
    for sample in conserving().iter().filter(|sample| sample.dim() == 2) {
        let (begin, end) = ends(sample);
        let step = Step::between(sample, &begin);
        let (k, n) = (step.tangent(&end), sample.n);
        let columns = (0..n).flat_map(|i| {
            let at = |side: f64| {
                let mut moved = end.clone();
                moved[i] += side * STEP;
                step.force(&moved)
            };
            let slope = at(1.0).into_iter().zip(at(-1.0));
            slope
                .map(|(a, b)| (a - b) / (2.0 * STEP))
                .collect::<Vec<_>>()
        });
        let slopes: Vec<f64> = columns.collect();
        let whole: Vec<f64> = (0..n * n).map(|k| slopes[k % n * n + k / n]).collect();
        let error = distance(&k, &whole);
        // central differences, as in the derivatives at one displacement
        assert!(error < 1e-8 * largest(&k), "{}: {error}", sample.name);
    }
}

#[test]
fn tangent_in_space_has_the_slopes_along_two_directions() {
    const STEP: f64 = 1e-5;
    for sample in conserving().iter().filter(|sample| sample.dim() == 3) {
        let (begin, end) = ends(sample);
        let step = Step::between(sample, &begin);
        let [v, w] = [26, 27].map(|seed| Random(seed).vector(sample.n));
        let slope = |of: &[f64], along: &[f64]| {
            let at = |side: f64| -> Vec<f64> {
                let moved = end.iter().zip(along);
                moved.map(|(u, v)| u + side * STEP * v).collect()
            };
            (dot(of, &step.force(&at(1.0))) - dot(of, &step.force(&at(-1.0)))) / (2.0 * STEP)
        };
        let k = step.tangent(&end);
        let rows = k.chunks_exact(sample.n).zip(&v);
        let found: f64 = rows.map(|(row, v)| v * dot(row, &w)).sum();
        // as above, of a sum of random signs
        let scale = largest(&k) * (sample.n as f64).sqrt();
        let error = (found - slope(&v, &w)).abs();
        assert!(error < 1e-7 * scale, "{}: {error}", sample.name);
    }
}

fn with(formulation: Formulation) -> Vec<Sample> {
    let all = laws();
    let all = all.iter().flat_map(samples);
    all.filter(|sample| sample.formulation == formulation)
        .collect()
}

#[test]
fn mean_dilatation_has_half_its_tangent_in_a_step_of_no_size_and_no_noise_in_a_small_one() {
    for sample in with(Formulation::BBar) {
        let u = displacement(&sample, 23);
        let here = Step::new(&sample);
        let still = Step::between(&sample, &u);
        let (f, scale) = (here.force(&u), largest(&here.tangent(&u)));
        // strains and stresses of a tenth, rounded, times moduli
        let rounding = 1e-15 * scale;
        let error = distance(&still.force(&u), &f);
        assert!(error < rounding, "{}: {error:e}", sample.name);
        if sample.dim() == 2 {
            let half: Vec<f64> = here.tangent(&u).iter().map(|k| 0.5 * k).collect();
            let error = distance(&still.tangent(&u), &half);
            assert!(error < 1e-14 * scale, "{}: {error:e}", sample.name);
        }
        for size in [1e-3, 1e-6, 1e-9, 1e-12] {
            let along = Random(24).vector(sample.n);
            let at = |share: f64| -> Vec<f64> {
                let moved = u.iter().zip(&along);
                moved.map(|(u, more)| u + share * size * more).collect()
            };
            let between = Step::between(&sample, &u).force(&at(1.0));
            // both are means of the step of second order; gradients are up to ten times the displacement
            let error = distance(&between, &here.force(&at(0.5)));
            let bound = 1e3 * scale * size * size + rounding;
            assert!(error < bound, "{}: {error:e} at {size:e}", sample.name);
        }
    }
}

#[test]
fn mean_dilatation_between_affine_motions_is_full_integration() {
    let pairs = with(Formulation::Full)
        .into_iter()
        .zip(with(Formulation::BBar));
    for (full, dilated) in pairs {
        // in axisymmetry those that keep the volume ratio the same at all radii
        let shear = match full.body.kinematics() {
            Kinematics::Axisymmetric => 0.0,
            _ => 0.3,
        };
        let begin = full.field(|x| [0.1 * x[0] - shear * x[1], 0.2 * x[1], -0.1 * x[2]]);
        let end = full.field(|x| [-0.05 * x[0], 0.1 * x[1] + shear * x[0], 0.2 * x[2]]);
        let f = Step::between(&full, &begin).force(&end);
        let error = distance(&Step::between(&dilated, &begin).force(&end), &f);
        // sums of the forces of the elements around a node
        let bound = 1e-14 * full.n as f64 * largest(&f);
        assert!(error < bound, "{}: {error:e}", dilated.name);
    }
}

#[test]
fn laws_that_dissipate_have_no_conserving_stress_and_say_so() {
    for law in inelastic() {
        for sample in samples(&law) {
            let from = vec![0.0; sample.n];
            let step = Step::between(&sample, &from);
            let error = step.run(&from).unwrap_err();
            assert!(matches!(error, Error::NoBetween { .. }), "{error}");
            let mut matrix = sample.pattern();
            let added = sample.body.add_tangent(&step.at(&from), 1.0, &mut matrix);
            assert!(matches!(added, Err(Error::NoBetween { .. })));
        }
    }
}
