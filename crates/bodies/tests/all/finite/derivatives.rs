//! Force is the gradient of energy, tangent that of force.
//!
//! Central differences of step h err by about h² f''/6 and by 1e-16 f/h: 1e-9 for h = 1e-5, relative to the largest entry.

use carom_bodies::CellWeights;

use super::{Step, displacement, elastic, probes, samples};
use crate::sample::{Sample, largest};

const STEP: f64 = 1e-5;

/// All bodies, and those of one law with weights of inertia and internal work besides.
fn bodies() -> Vec<Sample> {
    let weighted = samples(&elastic()[0]).into_iter().map(|sample| {
        // linear, so that serendipity elements keep their mass positive
        let weights = CellWeights {
            inertia: sample.at_cells(|x| 0.2 + 0.1 * x[0]),
            stiffness: sample.at_cells(|x| 0.9 - 0.3 * x[0]),
        };
        sample.weighted(weights)
    });
    let plain = elastic().iter().flat_map(samples).collect::<Vec<_>>();
    plain.into_iter().chain(weighted).collect()
}

#[test]
fn force_is_the_derivative_of_what_is_stored() {
    for sample in bodies() {
        let step = Step::new(&sample);
        let u = displacement(&sample, 11);
        let f = step.force(&u);
        for i in probes(sample.n) {
            let at = |side: f64| {
                let mut moved = u.clone();
                moved[i] += side * STEP;
                step.potential(&moved)
            };
            let error = ((at(1.0) - at(-1.0)) / (2.0 * STEP) - f[i]).abs();
            assert!(error < 1e-8 * largest(&f), "{}: {error}", sample.name);
        }
    }
}

#[test]
fn tangent_is_the_derivative_of_force_and_symmetric() {
    for sample in bodies() {
        let step = Step::new(&sample);
        let u = displacement(&sample, 12);
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
                assert!(error < 1e-8 * largest(&k), "{}: {error}", sample.name);
                assert_eq!(k[row * n + i], k[i * n + row], "{}", sample.name);
            }
        }
    }
}
