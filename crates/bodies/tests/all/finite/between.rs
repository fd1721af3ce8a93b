//! Algorithmic forces between two displacements: exact work, no resultant, no moment.

use carom_bodies::Kinematics;

use super::{Step, displacement, elastic, rotation, samples};
use crate::sample::{Sample, distance, dot, largest};

/// A displacement turned by 0.4 from the other one, and strained otherwise.
fn ends(sample: &Sample) -> (Vec<f64>, Vec<f64>) {
    let begin = displacement(sample, 21);
    let mut end = displacement(sample, 22);
    if sample.body.kinematics() != Kinematics::Axisymmetric {
        let turn = rotation(sample, 0.4);
        end.iter_mut().zip(turn).for_each(|(u, turn)| *u += turn);
    }
    (begin, end)
}

fn conserving() -> Vec<Sample> {
    elastic().iter().flat_map(samples).collect()
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
fn tangent_is_the_symmetric_part_of_the_derivative_by_the_end() {
    const STEP: f64 = 1e-5;
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
        let part: Vec<f64> = (0..n * n)
            .map(|k| 0.5 * (slopes[k] + slopes[k % n * n + k / n]))
            .collect();
        let error = distance(&k, &part);
        // central differences, as in the derivatives at one displacement
        assert!(error < 1e-8 * largest(&k), "{}: {error}", sample.name);
    }
}
