//! An overlap that turns a corner: ∇δ is not constant there, and non-matching meshes miss a constant strain by an amount
//! that falls with the size of the outer cells.

use carom_arlequin::{Coupling, Overlap, Region, Warning, Weighting};

use crate::support::{Pair, at_rest, gradient_error, keep, plate};

/// Mean and largest error of a unit gradient on a square of side 4 with an inner model on [0, 2]² and an outer one outside
/// [0, 1]²; `n` outer cells per unit.
fn errors(n: usize) -> (f64, f64) {
    let inner = plate([0.0, 0.0], [2.0, 2.0], [5 * n, 5 * n], true);
    let outer = plate([0.0, 0.0], [4.0, 4.0], [4 * n, 4 * n], false);
    let pair = Pair::new(inner, keep(outer, |x| x[0] > 1.0 || x[1] > 1.0));
    let overlap = Overlap::new(pair.models(), &Region::Intersection).unwrap();
    assert!((overlap.measure() - 3.0).abs() < 1e-12 && !overlap.is_strip());
    let weights = overlap.weights(&Weighting::default()).unwrap();
    assert_eq!(weights.warnings, [Warning::NotPatchExact]);
    let rows = overlap.rows(&Coupling::default()).unwrap();
    let deltas = [&weights.inner.stiffness[..], &weights.outer.stiffness];
    let u = at_rest(&overlap, deltas, &rows, |_, x| {
        let side = |x: f64| x == 0.0 || x == 4.0;
        (side(x[0]) || side(x[1])).then_some(x[0] + 0.5 * x[1])
    });
    let (worst, mean) = gradient_error(&overlap, &u, [1.0, 0.5, 0.0]);
    (mean, worst)
}

#[test]
fn the_error_at_a_corner_is_small_and_falls_with_the_outer_cells() {
    let errors = [2, 4].map(errors);
    for (n, (mean, worst)) in [2, 4].iter().zip(&errors) {
        println!("h_s = 1/{n}: mean error of the gradient {mean:.2e}, largest {worst:.2e}");
    }
    assert!(errors[0].0 < 0.02 && errors[1].0 > 1e-6);
    // First order in the size of the outer cells, of a field that errs in a corner of that size.
    assert!(errors[1].0 < 0.7 * errors[0].0);
}
