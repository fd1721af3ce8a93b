//! Elements of a body shared out give the forces, energies and histories of all of them together.

use carom_bodies::{Formulation, Kinematics, Placement, Scratch, Share, Stored};
use carom_materials::{J2Plasticity, Law, NeoHooke};
use carom_mesh::generate;
use carom_testing::Random;

use crate::sample::{MATERIAL, Sample};

/// Every third element, the next ones, and the others; of 512 elements these are several chunks of each.
fn shares(sample: &Sample) -> Vec<Share> {
    let count = sample.body.cells().len() as u32;
    let of = |first: u32| (first..count).step_by(3).collect();
    (0..3).map(|first| sample.body.share(of(first))).collect()
}

#[test]
fn the_forces_of_shares_are_those_of_the_body() {
    let plastic = J2Plasticity {
        initial: MATERIAL,
        yield_stress: 0.02,
        hardening: 0.1,
    };
    let laws = [
        (MATERIAL.into(), Formulation::Full),
        (
            Law::NeoHooke(NeoHooke { initial: MATERIAL }),
            Formulation::BBar,
        ),
        (Law::J2Plasticity(plastic), Formulation::Full),
    ];
    for (law, formulation) in laws {
        let cube = generate::box_("b", [0.0; 3], [1.0; 3], [8; 3], false);
        let sample = Sample::of("cube", cube, Kinematics::Solid, law, formulation);
        assert_eq!(sample.body.not_shared(), None);
        let u: Vec<f64> = Random(3)
            .vector(sample.n)
            .iter()
            .map(|u| 0.01 * u)
            .collect();
        let kept = sample.body.history_len();
        let mut old = vec![0.0; kept];
        sample.body.start_history(&mut old);
        let at = Placement {
            u: &u,
            v: &[],
            from: None,
            frames: &[],
            dt: 1.0,
            old: &old,
        };
        let (mut new, mut f) = (vec![0.0; kept], vec![0.0; sample.n]);
        let whole = sample
            .body
            .force(&at, &mut new, &mut Scratch::default(), &mut f)
            .unwrap();
        let (mut found, mut sum) = (vec![f64::NAN; kept], vec![0.0; sample.n]);
        let mut stored = Stored::default();
        for mut share in shares(&sample) {
            stored.include(&share.force(&at, &mut found, &mut sum).unwrap());
        }
        // rounding of sums of at most eight elements at a node, and of the energies of 512
        let most = f.iter().fold(0.0f64, |most, f| most.max(f.abs()));
        for (a, b) in f.iter().zip(&sum) {
            assert!((a - b).abs() < 1e-13 * most, "{law:?}: {a} {b}");
        }
        assert!(
            (whole.strain - stored.strain).abs() < 1e-13 * whole.strain,
            "{law:?}"
        );
        assert_eq!(new, found, "{law:?}");
        let elements: usize = sample.body.kept_of_elements().sum();
        assert_eq!(elements, kept);
    }
}
