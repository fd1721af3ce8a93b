//! Bars in one dimension: the patch test by a static solve, and its negative controls.

use carom_arlequin::{
    Bracket, Coupling, Integration, Mediator, Model, Overlap, Profile, Region, Warning, Weighting,
};

use crate::support::{Pair, at_rest, gradient_error, line};

/// Largest error of a unit strain in a bar held at one end and moved at the other: impact zone from 0 to 2, overlap of
/// 0.8, outer cells of 0.2, inner ones of 0.2/ratio.
fn strain_error(ratio: f64, weighting: &Weighting, coupling: &Coupling) -> f64 {
    let n = (2.0 / (0.2 / ratio)).round() as usize;
    let pair = Pair::new(line(0.0, 2.0, n), line(1.2, 10.0, 44));
    let overlap = Overlap::new(pair.models(), &Region::Intersection).unwrap();
    let weights = overlap.weights(weighting).unwrap();
    let rows = overlap.rows(coupling).unwrap();
    let deltas = [&weights.inner.stiffness[..], &weights.outer.stiffness];
    let u = at_rest(&overlap, deltas, &rows, |_, x| {
        (x[0] == 0.0 || x[0] == 10.0).then_some(x[0])
    });
    gradient_error(&overlap, &u, [1.0, 0.0, 0.0]).0
}

fn same(profile: Profile) -> Weighting {
    Weighting {
        inertia: profile,
        stiffness: profile,
        floor: 0.0,
    }
}

#[test]
fn linear_weights_pass_the_patch_test_nested_or_not_with_any_mediator_and_bracket() {
    for ratio in [4.0, 2.5, 1.0, 0.5] {
        for mediator in [
            Mediator::Coarser,
            Mediator::Of(Model::Inner),
            Mediator::Of(Model::Outer),
        ] {
            for bracket in [Bracket::L2, Bracket::H1 { kappa: None }] {
                let coupling = Coupling {
                    mediator,
                    bracket,
                    ..Coupling::default()
                };
                let error = strain_error(ratio, &Weighting::default(), &coupling);
                // Round-off of a dense solve with some 70 unknowns of condition 1e4.
                assert!(error < 1e-11, "{ratio} {mediator:?} {bracket:?}: {error}");
            }
        }
    }
}

#[test]
fn other_weights_fail_it_with_the_coarse_mediator_by_the_known_amount() {
    for (profile, expected) in [(Profile::Constant(0.5), 0.634), (Profile::Smooth, 0.15)] {
        let error = strain_error(4.0, &same(profile), &Coupling::default());
        println!("{profile:?}: {error}");
        // The reference figures are given to three and two digits.
        assert!((error - expected).abs() < 0.01, "{profile:?}: {error}");
    }
}

#[test]
fn quadrature_on_one_mesh_fails_it() {
    for (integration, ratio) in [(Integration::InnerOnly, 2.5), (Integration::OuterOnly, 4.0)] {
        let coupling = Coupling {
            integration,
            ..Coupling::default()
        };
        let error = strain_error(ratio, &Weighting::default(), &coupling);
        println!("{integration:?}: {error}");
        assert!(error > 1e-3, "{integration:?}: {error}");
    }
}

#[test]
fn weights_say_when_they_do_not_pass() {
    let pair = Pair::new(line(0.0, 2.0, 40), line(1.2, 10.0, 44));
    let overlap = Overlap::new(pair.models(), &Region::Intersection).unwrap();
    let warnings = |weighting: &Weighting| overlap.weights(weighting).unwrap().warnings;
    assert!(warnings(&Weighting::default()).is_empty());
    assert_eq!(warnings(&same(Profile::Smooth)), [Warning::NotPatchExact]);
    let unequal = Weighting {
        inertia: Profile::Constant(0.999),
        stiffness: Profile::Constant(0.5),
        floor: 0.0,
    };
    // √(1e-3/0.5) = 0.0447 where S fills an outer cell.
    let found = warnings(&unequal);
    assert!(found.contains(&Warning::NotPatchExact));
    let step = |w: &Warning| match w {
        Warning::SmallStep {
            model: Model::Outer,
            factor,
        } => Some(*factor),
        _ => None,
    };
    let factor = found.iter().find_map(step).unwrap();
    assert!((factor - 0.002f64.sqrt()).abs() < 1e-12, "{factor}");
}
