//! The same bits for any number of threads.

use carom_bodies::{Kinematics, Scratch};
use carom_mesh::generate;
use carom_testing::Random;

use crate::sample::{Sample, all};

/// Bodies of several chunks, the last one short.
fn large() -> Vec<Sample> {
    let plane = Kinematics::PlaneStress { thickness: 0.1 };
    let square = |triangles| generate::rectangle("b", [1.0, 0.0], [1.0; 2], [53, 41], triangles);
    let cube = |n, tets| generate::box_("b", [0.0; 3], [1.0; 3], [n; 3], tets);
    vec![
        Sample::new(
            "bars",
            generate::line("b", [0.0; 3], [1.0, 2.0, 0.5], 10_001, 3),
            Kinematics::Bar { area: 1.0 },
        ),
        Sample::new("tri3", square(true), plane),
        Sample::new("quad4", square(false), Kinematics::Axisymmetric),
        Sample::new("tet4", cube(7, true), Kinematics::Solid),
        Sample::new("hex8", cube(11, false), Kinematics::Solid),
    ]
}

#[test]
fn forces_and_energies_have_the_same_bits_on_any_number_of_threads() {
    let weighted = large().into_iter().map(|sample| {
        let weights = sample.random_weights(33);
        sample.weighted(weights)
    });
    for sample in large().into_iter().chain(weighted).chain(all()) {
        let u = Random(31).vector(sample.n);
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| {
                let (mut scratch, mut f) = (Scratch::default(), vec![0.0; sample.n]);
                let mut energies = Vec::new();
                for _ in 0..3 {
                    energies.push(sample.body.internal_force(&u, &mut scratch, &mut f));
                }
                (f, energies)
            })
        };
        let one = run(1);
        assert!(one.1.iter().all(|energy| energy.is_finite()));
        for threads in [2, 3] {
            assert_eq!(one, run(threads), "{} on {threads}", sample.name);
        }
    }
}

/// Forces of a large body balance: what the chunks share is added up.
#[test]
fn forces_of_a_large_body_are_in_balance() {
    for sample in large() {
        if sample.body.kinematics() == Kinematics::Axisymmetric {
            continue;
        }
        let u = Random(32).vector(sample.n);
        let f = sample.force(&u).0;
        for motion in sample.rigid_motions() {
            let work: f64 = f.iter().zip(&motion).map(|(f, r)| f * r).sum();
            let scale: f64 = f.iter().zip(&motion).map(|(f, r)| (f * r).abs()).sum();
            assert!(
                work.abs() < 1e-12 * scale,
                "{}: {work} of {scale}",
                sample.name
            );
        }
    }
}
