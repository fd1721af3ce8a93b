//! The internal-force sweep allocates on its first call only.

use carom_bodies::{Formulation, Kinematics, Placement, Scratch};
use carom_materials::{Law, NeoHooke};
use carom_mesh::generate;
use carom_testing::allocations;

use crate::sample::{MATERIAL, Sample, plain_and_weighted};

/// On the one thread of a pool, so that all of it is counted: the threads' own queues are rayon's.
#[test]
fn internal_force_allocates_nothing_after_its_first_call() {
    let cube = generate::box_("b", [0.0; 3], [1.0; 3], [9; 3], false);
    let large = Sample::new("hex8 in chunks", cube, Kinematics::Solid);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    for sample in plain_and_weighted().into_iter().chain([large]) {
        let count = pool.install(|| {
            let (u, mut f) = (vec![1e-3; sample.n], vec![0.0; sample.n]);
            let mut scratch = Scratch::default();
            sample.body.internal_force(&u, &mut scratch, &mut f);
            let before = allocations();
            for _ in 0..10 {
                sample.body.internal_force(&u, &mut scratch, &mut f);
            }
            allocations() - before
        });
        assert_eq!(count, 0, "{}", sample.name);
    }
}

/// On one thread, as above. Histories are read and written where they lie.
#[test]
fn forces_at_finite_strain_allocate_nothing_after_the_first_call() {
    let law = Law::NeoHooke(NeoHooke { initial: MATERIAL });
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    for formulation in [
        Formulation::Full,
        Formulation::BBar,
        Formulation::Reduced { hourglass: 0.1 },
    ] {
        let cube = generate::box_("b", [0.0; 3], [1.0; 3], [5; 3], false);
        let sample = Sample::of("cube", cube, Kinematics::Solid, law, formulation);
        let (u, still) = (vec![1e-3; sample.n], vec![0.0; sample.n]);
        for from in [None, Some(&still[..])] {
            let count = pool.install(|| {
                let mut f = vec![0.0; sample.n];
                let mut scratch = Scratch::default();
                let at = Placement {
                    u: &u,
                    v: &[],
                    from,
                    frames: &[],
                    dt: 1.0,
                    old: &[],
                };
                let mut force = || sample.body.force(&at, &mut [], &mut scratch, &mut f);
                force().unwrap();
                let before = allocations();
                for _ in 0..10 {
                    force().unwrap();
                }
                allocations() - before
            });
            assert_eq!(count, 0, "{formulation:?}");
        }
    }
}
