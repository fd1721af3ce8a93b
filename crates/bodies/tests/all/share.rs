//! Elements of a body shared out give the forces, energies and histories of all of them together.

use carom_bodies::{Formulation, Kinematics, Looks, Placement, Scratch, Seen, Share, Stored};
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

fn at(u: &[f64]) -> Placement<'_> {
    Placement {
        u,
        v: &[],
        from: None,
        frames: &[],
        dt: 1.0,
        old: &[],
    }
}

/// What is known of the frequencies of elements goes from shares to the body and back, and is the same: it is that of each element.
#[test]
fn the_looks_of_shares_are_those_of_the_body() {
    let law = Law::NeoHooke(NeoHooke { initial: MATERIAL });
    let cube = generate::box_("b", [0.0; 3], [1.0; 3], [8; 3], false);
    let sample = Sample::of("cube", cube, Kinematics::Solid, law, Formulation::Full);
    let pressed = |by: f64| sample.field(|x| [0.0, 0.0, -by * x[2] * x[2]]);
    let mut shares = shares(&sample);
    let (mut whole, mut own) = (Looks::default(), vec![Looks::default(); 3]);
    let mut renewed = Vec::new();
    // half of the elements change by more than is asked for at the second look
    for by in [0.0, 0.1, 0.12] {
        let u = pressed(by);
        let seen = sample.body.look(&at(&u), &mut whole, 0.1).unwrap();
        let mut sum = Seen::default();
        for (share, looks) in shares.iter_mut().zip(&mut own) {
            sum = sum.with(&share.look(&at(&u), looks, 0.1).unwrap());
        }
        sum.bound.cell = seen.bound.cell;
        assert_eq!(seen, sum);
        renewed.push(seen.is_renewed);
        let (mut gathered, mut numbers) = (Looks::default(), Vec::new());
        for (share, looks) in shares.iter().zip(&own) {
            for (element, &place) in share.places().iter().enumerate() {
                numbers.clear();
                looks.push(element, &mut numbers);
                assert_eq!(Some(numbers.len()), sample.body.numbers_of_look());
                gathered.take((place as usize, 512), &numbers);
            }
        }
        assert_eq!(gathered, whole);
    }
    assert_eq!(renewed[..2], [true, true]);
}

/// Of a body of hexahedra and tetrahedra also shares with one of the two give as many numbers of each element, and take them.
#[test]
fn looks_of_shares_with_one_kind_of_a_body_of_two_are_those_of_the_body() {
    let law = Law::NeoHooke(NeoHooke { initial: MATERIAL });
    let mut two = generate::box_("b", [0.0; 3], [1.0; 3], [2; 3], false);
    let tetrahedra = generate::box_("t", [2.0, 0.0, 0.0], [1.0; 3], [2; 3], true);
    two.merge("t", tetrahedra).unwrap();
    let sample = Sample::of("two", two, Kinematics::Solid, law, Formulation::Full);
    let (hexahedra, count) = (8, sample.body.cells().len() as u32);
    assert!(count > hexahedra);
    let u = vec![0.0; sample.n];
    let mut whole = Looks::default();
    sample.body.look(&at(&u), &mut whole, 0.1).unwrap();
    let mut gathered = Looks::default();
    for places in [0..hexahedra, hexahedra..count] {
        let mut share = sample.body.share(places.collect());
        let mut own = Looks::default();
        share.look(&at(&u), &mut own, 0.1).unwrap();
        for (element, &place) in share.places().iter().enumerate() {
            let mut numbers = Vec::new();
            own.push(element, &mut numbers);
            assert_eq!(Some(numbers.len()), sample.body.numbers_of_look());
            gathered.take((place as usize, count as usize), &numbers);
        }
    }
    assert_eq!(gathered, whole);
}
