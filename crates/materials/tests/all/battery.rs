//! Facts about the stress and the tangent of every law.

use carom_algebra::tensor::Mat3;
use carom_materials::{Failure, MAX_KEPT, Plane, Want};
use carom_testing::{Random, allocations};

use crate::support::{
    INITIAL, asymmetry, for_each, random_f, random_rotation, start, step, tangent_error, times,
};

/// Deformations of a start with all its eigenvalues equal, two of them, none.
fn deformations(random: &mut Random) -> Vec<Mat3> {
    let stretch = Mat3::from_diagonal(&[1.2, 0.9, 0.9].into());
    let mut list = vec![
        Mat3::identity(),
        Mat3::identity() * 1.1,
        stretch,
        random_rotation(random) * stretch,
    ];
    list.extend((0..8).map(|_| random_f(random, 0.25)));
    list
}

#[test]
fn the_stress_is_the_derivative_of_the_stored_energy() {
    for_each(|name, law| {
        if law
            .between(&Mat3::identity(), &Mat3::identity(), Want::Stress)
            .is_none()
        {
            return;
        }
        let mut random = Random(11);
        for f in deformations(&mut random) {
            let stored = |f: &Mat3| step(law, f, &[], Want::Stress).unwrap().0.stored;
            let stress = step(law, &f, &[], Want::Stress).unwrap().0.stress;
            for ij in 0..9 {
                let mut unit = Mat3::zeros();
                unit[(ij / 3, ij % 3)] = 1.0;
                let central =
                    |h: f64| (stored(&(f + unit * h)) - stored(&(f - unit * h))) / (2.0 * h);
                let difference = (4.0 * central(1e-3) - central(2e-3)) / 3.0;
                // the fourth-order difference errs by h⁴ = 1e-12 times a fifth derivative, of order 10 to 100
                assert!(
                    (difference - stress[(ij / 3, ij % 3)]).abs() < 1e-9,
                    "{name}"
                );
            }
        }
    });
}

#[test]
fn the_tangent_is_the_derivative_of_the_stress() {
    for_each(|name, law| {
        let mut random = Random(12);
        let old = start(law);
        for f in deformations(&mut random) {
            let response = step(law, &f, &old, Want::Tangent).unwrap().0;
            let stress = |f: &Mat3| step(law, f, &old, Want::Stress).unwrap().0.stress;
            let error = tangent_error(&response.tangent.unwrap(), &f, 1e-3, stress);
            // h⁴ = 1e-12 times a fifth derivative, of order 10 to 1000 where a direction is pressed to 0.6
            assert!(error < 2e-9, "{name}: {error:e} at {f}");
        }
    });
}

#[test]
fn the_tangent_has_major_symmetry() {
    for_each(|name, law| {
        let mut random = Random(13);
        let old = start(law);
        for f in deformations(&mut random) {
            let tangent = step(law, &f, &old, Want::Tangent)
                .unwrap()
                .0
                .tangent
                .unwrap();
            // entries are of order one to ten
            assert!(asymmetry(&tangent) < 1e-13, "{name}");
        }
    });
}

#[test]
fn the_stress_turns_with_the_body_and_the_kirchhoff_stress_is_symmetric() {
    for_each(|name, law| {
        let mut random = Random(14);
        let old = start(law);
        for f in deformations(&mut random) {
            let q = random_rotation(&mut random);
            let (here, new_here) = step(law, &f, &old, Want::Stress).unwrap();
            let (turned, new_turned) = step(law, &(q * f), &old, Want::Stress).unwrap();
            assert!((turned.stress - q * here.stress).amax() < 1e-14, "{name}");
            assert!((turned.stored - here.stored).abs() < 1e-14, "{name}");
            let kirchhoff = here.stress * f.transpose();
            assert!((kirchhoff - kirchhoff.transpose()).amax() < 1e-15, "{name}");
            for (a, b) in new_here.iter().zip(&new_turned) {
                assert!((a - b).abs() < 1e-14, "{name}");
            }
        }
    });
}

#[test]
fn a_history_has_room_in_the_kernels() {
    for_each(|name, law| assert!(law.history_len() <= MAX_KEPT, "{name}"));
}

#[test]
fn an_undeformed_point_has_neither_stress_nor_energy() {
    for_each(|name, law| {
        let (response, new) = step(law, &Mat3::identity(), &start(law), Want::Stress).unwrap();
        assert_eq!(response.stress, Mat3::zeros(), "{name}");
        assert_eq!(response.stored, 0.0, "{name}");
        assert_eq!(new, start(law), "{name}");
    });
}

#[test]
fn a_small_strain_gives_linear_elasticity_to_all_its_digits() {
    for_each(|name, law| {
        let mut random = Random(15);
        let initial = law.initial();
        assert_eq!(initial.density, INITIAL.density, "{name}");
        // so few digits that I + 2⁻³⁰ g holds them all
        let g = Mat3::from_fn(|_, _| (random.next() * 1024.0).round() / 1024.0);
        let strain = (g + g.transpose()) * 0.5;
        let mut new = start(law);
        // no time passes: a viscous law answers with all its branches
        let mut respond = |f: &Mat3| {
            law.update(f, 0.0, (&start(law), &mut new), Want::Tangent)
                .unwrap()
        };
        let linear = initial.stress(Plane::Full, &strain);
        let tangent = respond(&Mat3::identity()).tangent.unwrap();
        assert!((times(&tangent, &g) - linear).amax() < 1e-14, "{name}");
        // the energy has the relative error of the strain, and none from round-off
        let h = 2f64.powi(-30);
        let stored = respond(&(Mat3::identity() + strain * h)).stored;
        let expected = 0.5 * h * h * linear.dot(&strain);
        assert!((stored - expected).abs() < 1e-8 * expected, "{name}");
    });
}

#[test]
fn a_stress_allocates_nothing_and_a_tangent_itself() {
    for_each(|name, law| {
        let f = random_f(&mut Random(16), 0.2);
        let (old, mut new) = (start(law), start(law));
        for (want, expected) in [(Want::Stress, 0), (Want::Tangent, 1)] {
            let before = allocations();
            let response = law.update(&f, 0.1, (&old, &mut new), want).unwrap();
            assert_eq!(allocations() - before, expected, "{name}");
            drop(response);
        }
    });
}

#[test]
fn a_volume_turned_inside_out_fails() {
    for_each(|name, law| {
        let mirror = Mat3::from_diagonal(&[1.0, 1.0, -0.5].into());
        let flat = Mat3::from_diagonal(&[1.0, 1.0, 0.0].into());
        let nothing = Mat3::from_diagonal(&[1.0, 1.0, f64::NAN].into());
        let answer = step(law, &mirror, &start(law), Want::Stress).unwrap_err();
        assert_eq!(answer, Failure::Inverted { determinant: -0.5 }, "{name}");
        for f in [flat, nothing] {
            assert!(step(law, &f, &start(law), Want::Stress).is_err(), "{name}");
        }
    });
}
