//! Limits, refusals, threads.

use carom_algebra::unknowns::Unknowns;
use carom_bodies::{BodySpec, Error, Formulation, Kinematics, Looks, Placement, Scratch, Solid};
use carom_elements::Kind;
use carom_materials::Failure;
use carom_mesh::{Mesh, generate};

use super::{Step, displacement, elastic, samples};
use crate::sample::{Sample, cells, distance, largest, shapes};

#[test]
fn the_tangent_of_the_undeformed_body_is_the_stiffness_at_small_strain() {
    for sample in elastic().iter().flat_map(samples) {
        if sample.name.contains("Full") {
            let k = Step::new(&sample).tangent(&vec![0.0; sample.n]);
            let linear = sample.matrix(1.0, 0.0);
            let error = distance(&k, &linear);
            assert!(error < 1e-14 * largest(&k), "{}: {error}", sample.name);
        }
    }
}

#[test]
fn a_body_at_small_strain_answers_through_the_same_functions() {
    for (name, mesh, kinematics) in shapes() {
        let sample = Sample::new(name, mesh, kinematics);
        let (from, u) = (displacement(&sample, 41), displacement(&sample, 42));
        let (f, energy) = sample.force(&u);
        let step = Step::new(&sample);
        assert_eq!(step.force(&u), f);
        assert_eq!(step.run(&u).unwrap().1.strain, energy);
        assert_eq!(step.tangent(&u), sample.matrix(1.0, 0.0));
        let step = Step::between(&sample, &from);
        let (f, stored, _) = step.run(&u).unwrap();
        let work: f64 = (0..sample.n).map(|k| f[k] * (u[k] - from[k])).sum();
        let error = (work - (stored.strain - sample.force(&from).1)).abs();
        assert!(error < 1e-14 * stored.strain, "{}: {error}", sample.name);
        assert_eq!(step.tangent(&u), sample.matrix(0.5, 0.0));
    }
}

#[test]
fn an_inverted_element_is_named_with_its_point() {
    for (name, law) in elastic() {
        for formulation in [Formulation::Full, Formulation::BBar, super::HOURGLASS] {
            let mesh = generate::rectangle("b", [0.0; 2], [3.0, 1.0], [3, 1], false);
            let plane = Kinematics::PlaneStrain { thickness: 1.0 };
            let sample = Sample::of(name, mesh, plane, law, formulation);
            // the right-hand side of the last cell goes through its left-hand side
            let u = sample.field(|x| [if x[0] > 2.5 { -1.5 } else { 0.0 }, 0.0, 0.0]);
            let last = sample.body.cells()[2];
            let error = Step::new(&sample).run(&u).unwrap_err();
            assert!(
                matches!(&error, Error::NoStress { cell, point: 0, failure: Failure::Inverted { determinant }, .. }
                    if *cell == last && (determinant + 0.5).abs() < 1e-14),
                "{error}"
            );
            let mut matrix = sample.pattern();
            let at = Step::new(&sample);
            let error = sample.body.add_tangent(&at.at(&u), 1.0, &mut matrix);
            assert!(matches!(error, Err(Error::NoStress { cell, .. }) if cell == last));
        }
    }
}

#[test]
fn what_makes_no_sense_at_finite_strain_is_refused() {
    let mesh = generate::rectangle("b", [0.0; 2], [1.0; 2], [1, 1], false);
    let number: Vec<u32> = (0..4).collect();
    let refusal = |kinematics, material, formulation| {
        let spec = BodySpec {
            formulation,
            ..BodySpec::new("arm", cells(&mesh, 2), kinematics, material)
        };
        Solid::new(&mesh, spec, &number, &Unknowns::translations(2, 4)).unwrap_err()
    };
    let law = elastic()[0].1;
    let stress = Kinematics::PlaneStress { thickness: 1.0 };
    let error = refusal(stress, law, Formulation::Full);
    assert!(matches!(
        error,
        Error::FiniteKinematics {
            kinematics: "plane-stress",
            ..
        }
    ));
    let small = crate::sample::MATERIAL.into();
    let error = refusal(stress, small, Formulation::BBar);
    assert!(matches!(error, Error::LinearFormulation { .. }), "{error}");
}

#[test]
fn reduced_integration_of_a_quadratic_element_is_refused() {
    let reference = Kind::Quad8.table().reference;
    let mut mesh = Mesh::new(2);
    mesh.nodes.extend(reference);
    let number: Vec<u32> = (0..8).collect();
    mesh.push(Kind::Quad8, &number);
    let spec = BodySpec {
        formulation: super::HOURGLASS,
        ..BodySpec::new(
            "arm",
            cells(&mesh, 2),
            Kinematics::PlaneStrain { thickness: 1.0 },
            elastic()[0].1,
        )
    };
    let error = Solid::new(&mesh, spec, &number, &Unknowns::translations(2, 8)).unwrap_err();
    assert!(
        matches!(error, Error::NotReduced { found: "quad8", .. }),
        "{error}"
    );
}

#[test]
fn forces_energies_and_tangents_have_the_same_bits_on_any_number_of_threads() {
    let (name, law) = elastic()[0];
    for formulation in [Formulation::Full, Formulation::BBar, super::HOURGLASS] {
        let cube = generate::box_("b", [0.0; 3], [1.0; 3], [5, 6, 7], false);
        let sample = Sample::of(name, cube, Kinematics::Solid, law, formulation);
        let u: Vec<f64> = displacement(&sample, 51).iter().map(|u| 0.3 * u).collect();
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let pool = pool.build().unwrap();
            pool.install(|| {
                let (mut scratch, mut f) = (Scratch::default(), vec![0.0; sample.n]);
                let at = Placement {
                    u: &u,
                    v: &[],
                    from: None,
                    frames: &[],
                    dt: 1.0,
                    old: &[],
                };
                let force = |_| sample.body.force(&at, &mut [], &mut scratch, &mut f);
                let energies: Vec<f64> = (0..2).map(force).map(|s| s.unwrap().strain).collect();
                let mut matrix = sample.pattern();
                sample.body.add_tangent(&at, 2.0, &mut matrix).unwrap();
                let values: Vec<f64> = (0..sample.n)
                    .flat_map(|row| matrix.row(row).1.to_vec())
                    .collect();
                (f, energies, values)
            })
        };
        let one = run(1);
        assert_eq!(one.1[0], one.1[1], "energies start afresh");
        assert_eq!(one, run(3), "{formulation:?}");
    }
}

#[test]
fn the_frequency_bound_at_rest_is_that_of_the_undeformed_body() {
    for sample in elastic().iter().flat_map(samples) {
        if sample.name.contains("Full") {
            let at_rest = Step::new(&sample);
            let u = vec![0.0; sample.n];
            let bound = sample
                .body
                .frequency_bound_at(&at_rest.at(&u))
                .unwrap()
                .frequency;
            // two bounds within a thousandth of the same eigenvalue
            let ratio = bound / sample.body.frequency_bound();
            assert!((ratio - 1.0).abs() < 1e-3, "{}: {ratio}", sample.name);
        }
    }
}

/// The largest Rayleigh quotient found by power iteration on M⁻¹ K stays below, and not by far.
#[test]
fn the_frequency_bound_of_a_deformed_body_bounds_its_frequencies() {
    for sample in samples(&elastic()[0]) {
        let step = Step::new(&sample);
        let u = displacement(&sample, 61);
        let bound = sample
            .body
            .frequency_bound_at(&step.at(&u))
            .unwrap()
            .frequency;
        let (k, m) = (step.tangent(&u), sample.lumped_mass());
        let mut x = displacement(&sample, 62);
        let mut value = 0.0;
        for _ in 0..200 {
            let y = crate::sample::multiply(&k, &x);
            let square: f64 = (0..sample.n).map(|i| m[i] * x[i] * x[i]).sum();
            value = crate::sample::dot(&x, &y) / square;
            let scale = largest(&y);
            x = (0..sample.n).map(|i| y[i] / m[i] / scale).collect();
        }
        let ratio = value.sqrt() / bound;
        // an element that is fixed nowhere is stiffer for its mass than in its body, tetrahedra most
        assert!((0.5..1.0).contains(&ratio), "{}: {ratio}", sample.name);
    }
}

/// Shortened to λ, confined: P_11 = μ (λ - 1/λ) + λ_1 ln(λ)/λ, whose slope at λ = 1/2 is 5 μ + 4 (1 + ln 2) λ_1, beside
/// 2 μ + λ_1 at rest. With Poisson's ratio 0 the axial waves of a strip of squares are the fastest in both states.
#[test]
fn the_frequency_bound_rises_as_the_body_shortens() {
    let initial = carom_materials::Elastic {
        poisson: 0.0,
        ..crate::sample::MATERIAL
    };
    let law = carom_materials::Law::NeoHooke(carom_materials::NeoHooke { initial });
    let mesh = generate::rectangle("b", [0.0; 2], [4.0, 1.0], [4, 1], false);
    let plane = Kinematics::PlaneStrain { thickness: 1.0 };
    let sample = Sample::of("strip", mesh, plane, law, Formulation::Full);
    let bound = |shortening: f64| {
        let u = sample.field(|x| [-shortening * x[0], 0.0, 0.0]);
        let step = Step::new(&sample);
        sample
            .body
            .frequency_bound_at(&step.at(&u))
            .unwrap()
            .frequency
    };
    let ratio = bound(0.5) / bound(0.0);
    assert!((ratio * ratio - 2.5).abs() < 0.1, "{}", ratio * ratio);
}

/// A bar of 256 hexahedra. Where its last quarter is compressed by a quarter, the frequencies of that quarter are found
/// anew and are the largest: those of the rest, which is only carried along, stand. A length of 3/4 has no error in single precision.
#[test]
fn a_look_finds_frequencies_anew_where_elements_have_changed() {
    let (name, law) = elastic()[0];
    let bar = generate::box_("b", [0.0; 3], [256.0, 1.0, 1.0], [256, 1, 1], false);
    let full = Formulation::Full;
    let sample = Sample::of(name, bar, Kinematics::Solid, law, full);
    let (mut looks, step) = (Looks::default(), Step::new(&sample));
    let mut look = |shortening: f64, worth: f64| {
        let u = sample.field(|x| [-shortening * (x[0] - 192.0).max(0.0), 0.0, 0.0]);
        let seen = sample.body.look(&step.at(&u), &mut looks, worth).unwrap();
        let whole = sample.body.frequency_bound_at(&step.at(&u)).unwrap();
        (seen, whole.frequency)
    };
    let (seen, whole) = look(0.0, 0.05);
    assert!(seen.is_renewed && seen.bound.frequency == whole && seen.changed == 0.0);
    assert!((seen.shortest - 1.0).abs() < 1e-12);
    // places have an error of 256 roundings
    let (seen, _) = look(0.04, 0.05);
    assert!(!seen.is_renewed && (seen.changed - 0.04).abs() < 1e-12);
    assert_eq!(seen.bound.frequency, whole);
    let (seen, pressed) = look(0.25, 0.05);
    assert!(seen.is_renewed && seen.changed < 1e-12 && pressed > whole);
    assert_eq!(seen.bound.frequency, pressed);
    assert!((seen.shortest - 0.75).abs() < 1e-12);
    // back again, and not asked to find them anew
    let (seen, _) = look(0.0, 1.0);
    assert!(!seen.is_renewed && (seen.changed - 1.0 / 3.0).abs() < 1e-12);
    assert_eq!(seen.bound.frequency, pressed);
}

/// At yield, rounding decides whether an element flows further. The bound of its frequencies is that of unloading either way, and a fifth
/// above that of further flow, whose modulus along the bar is κ + 4μ/3 · H/(3μ + H) in place of κ + 4μ/3.
#[test]
fn the_frequency_of_an_element_at_yield_is_that_of_unloading() {
    let (name, law) = super::inelastic()[0];
    let bar = generate::box_("b", [0.0; 3], [4.0, 1.0, 1.0], [4, 1, 1], false);
    for formulation in [Formulation::Full, Formulation::BBar] {
        let sample = Sample::of(name, bar.clone(), Kinematics::Solid, law, formulation);
        let pressed = |part: f64| sample.field(|x| [-0.2 * part * x[0], 0.0, 0.0]);
        let mut step = Step::new(&sample);
        step.old = step.run(&pressed(1.0)).unwrap().2;
        let bound = |part: f64| {
            let u = pressed(part);
            let seen = sample.body.frequency_bound_at(&step.at(&u)).unwrap();
            let flows = step.run(&u).unwrap().1.dissipated > 0.0;
            (seen.frequency, flows)
        };
        let ((back, still), (on, flows)) = (bound(1.0 - 1e-9), bound(1.0 + 1e-9));
        assert!(!still && flows, "{formulation:?}");
        assert!(
            (back - on).abs() < 1e-7 * on,
            "{formulation:?}: {back} {on}"
        );
    }
}

/// Compression of the least edge h, with 4 (λ + 2μ)/(ρ h²), is the highest frequency of a brick in each formulation; hourglass
/// modes have at most 3 μ κ/(ρ h²).
#[test]
fn no_formulation_is_faster_than_full_integration_at_rest() {
    let (name, law) = elastic()[0];
    for formulation in [Formulation::BBar, Formulation::Reduced { hourglass: 1.0 }] {
        for size in [[1.0, 0.2, 3.0], [1.0; 3]] {
            let brick = generate::box_("b", [0.0; 3], size, [1, 1, 1], false);
            let sample = Sample::of(name, brick, Kinematics::Solid, law, formulation);
            let u = vec![0.0; sample.n];
            let step = Step::new(&sample);
            let found = sample
                .body
                .frequency_bound_at(&step.at(&u))
                .unwrap()
                .frequency;
            let ratio = found / sample.body.frequency_bound();
            // bounds within a thousandth of the eigenvalues
            assert!(ratio < 1.001, "{formulation:?}: {ratio}");
        }
    }
}
