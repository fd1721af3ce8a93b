//! Force is the gradient of energy, stiffness that of force. Energies are quadratic, so central differences with large
//! steps are exact but for rounding.

use crate::sample::{distance, dot, largest, multiply, plain_and_weighted};
use carom_testing::Random;

#[test]
fn force_is_the_derivative_of_energy() {
    for sample in plain_and_weighted() {
        let mut random = Random(11);
        let u = random.vector(sample.n);
        let f = sample.force(&u).0;
        let step = 0.5;
        for i in 0..sample.n {
            let mut moved = u.clone();
            moved[i] = u[i] + step;
            let above = sample.force(&moved).1;
            moved[i] = u[i] - step;
            let below = sample.force(&moved).1;
            let slope = (above - below) / (2.0 * step);
            let error = (slope - f[i]).abs();
            assert!(error < 1e-11 * largest(&f), "{}: {error}", sample.name);
        }
    }
}

#[test]
fn stiffness_is_the_derivative_of_force() {
    for sample in plain_and_weighted() {
        let mut random = Random(12);
        let u = random.vector(sample.n);
        let k = sample.matrix(1.0, 0.0);
        for i in 0..sample.n {
            let mut moved = u.clone();
            moved[i] += 1.0;
            let above = sample.force(&moved).0;
            moved[i] -= 2.0;
            let below = sample.force(&moved).0;
            let slope: Vec<f64> = above
                .iter()
                .zip(&below)
                .map(|(a, b)| (a - b) / 2.0)
                .collect();
            let column: Vec<f64> = (0..sample.n).map(|row| k[row * sample.n + i]).collect();
            let error = distance(&slope, &column);
            assert!(error < 1e-12 * largest(&k), "{}: {error}", sample.name);
        }
    }
}

#[test]
fn force_and_energy_of_the_batched_kernels_are_those_of_the_stiffness() {
    for sample in plain_and_weighted() {
        let k = sample.matrix(1.0, 0.0);
        for seed in 0..5 {
            let u = Random(seed).vector(sample.n);
            let (f, energy) = sample.force(&u);
            let product = multiply(&k, &u);
            assert!(
                distance(&f, &product) < 1e-13 * largest(&f),
                "{}: {} of {}",
                sample.name,
                distance(&f, &product),
                largest(&f)
            );
            let half = 0.5 * dot(&u, &product);
            assert!((energy - half).abs() < 1e-13 * half, "{}", sample.name);
        }
    }
}

#[test]
fn forces_are_added_to_what_is_there_and_energies_start_afresh() {
    for sample in plain_and_weighted() {
        let u = Random(5).vector(sample.n);
        let (f, energy) = sample.force(&u);
        let mut scratch = carom_bodies::Scratch::default();
        let mut twice = vec![0.0; sample.n];
        sample.body.internal_force(&u, &mut scratch, &mut twice);
        let again = sample.body.internal_force(&u, &mut scratch, &mut twice);
        assert_eq!(again, energy, "{}", sample.name);
        let doubled: Vec<f64> = f.iter().map(|f| f + f).collect();
        let error = distance(&twice, &doubled);
        assert!(error < 1e-14 * largest(&f), "{}: {error}", sample.name);
    }
}
