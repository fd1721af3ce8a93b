//! Integrals of products over S against closed forms.

use carom_arlequin::{Bracket, Coupling, Mediator, Model, Overlap, Region, Row, Rows};

use crate::support::{Pair, block, line, plate};

/// Σ_A Σ_b m(A) C_Ab f(b) over the rows of the first component: <m, f>_S for fields that both meshes hold exactly. For
/// the inner and for the outer model.
fn product(
    rows: &Rows,
    nodes: &[[f64; 3]],
    m: impl Fn([f64; 3]) -> f64,
    f: impl Fn([f64; 3]) -> f64,
) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for row in rows.rows.iter().filter(|row| row.component == 0) {
        let m = m(nodes[row.node as usize]);
        let field = |node: u32, k: usize| if k == 0 { f(nodes[node as usize]) } else { 0.0 };
        sums[0] += m * Row::apply(&row.inner, field);
        sums[1] += m * Row::apply(&row.outer, field);
    }
    sums
}

fn power(a: f64, b: f64, n: i32) -> f64 {
    (b.powi(n + 1) - a.powi(n + 1)) / f64::from(n + 1)
}

fn rows_of(pair: &Pair, mediator: Model, bracket: Bracket) -> (Rows, f64) {
    let overlap = Overlap::new(pair.models(), &Region::Intersection).unwrap();
    let coupling = Coupling {
        mediator: Mediator::Of(mediator),
        bracket,
        sliver: 0.0,
        ..Coupling::default()
    };
    (overlap.rows(&coupling).unwrap(), overlap.measure())
}

#[test]
fn on_a_line() {
    for n in [8, 13] {
        let pair = Pair::new(line(0.0, 2.0, n), line(1.1, 4.1, 6));
        for mediator in [Model::Inner, Model::Outer] {
            let (rows, measure) = rows_of(&pair, mediator, Bracket::L2);
            assert!((measure - 0.9).abs() < 1e-14);
            let found = product(
                &rows,
                &pair.mesh.nodes,
                |x| 1.0 + x[0],
                |x| 2.0 - 3.0 * x[0],
            );
            let exact = 2.0 * power(1.1, 2.0, 0) - power(1.1, 2.0, 1) - 3.0 * power(1.1, 2.0, 2);
            found
                .iter()
                .for_each(|f| assert!((f - exact).abs() < 1e-13));
        }
    }
}

#[test]
fn bilinear_fields_on_quadrilaterals_and_affine_ones_on_all_cells_of_the_plane() {
    for (n, triangles) in [
        ([8, 4], [false; 2]),
        ([7, 3], [false; 2]),
        ([7, 3], [true, false]),
        ([7, 3], [true; 2]),
    ] {
        let inner = plate([0.0, 0.0], [2.0, 1.0], n, triangles[0]);
        let pair = Pair::new(inner, plate([1.2, 0.0], [3.2, 1.0], [5, 2], triangles[1]));
        for mediator in [Model::Inner, Model::Outer] {
            let (rows, measure) = rows_of(&pair, mediator, Bracket::L2);
            assert!((measure - 0.8).abs() < 1e-13);
            let affine = product(&rows, &pair.mesh.nodes, |x| x[1] - 1.0, |x| x[0] + x[1]);
            let (x, y) = (|n| power(1.2, 2.0, n), |n| power(0.0, 1.0, n));
            let exact = x(1) * y(1) - x(1) * y(0) + x(0) * y(2) - x(0) * y(1);
            affine
                .iter()
                .for_each(|f| assert!((f - exact).abs() < 1e-13));
            if triangles == [false; 2] {
                let found = product(&rows, &pair.mesh.nodes, |x| x[0] * x[1], |x| x[0] * x[1]);
                found
                    .iter()
                    .for_each(|f| assert!((f - x(2) * y(2)).abs() < 1e-13));
            }
        }
    }
}

#[test]
fn trilinear_fields_on_hexahedra_and_affine_ones_on_all_cells_in_space() {
    for (n, tets) in [
        ([4, 2, 2], [false; 2]),
        ([3, 3, 2], [false; 2]),
        ([3, 2, 2], [true, false]),
        ([3, 2, 2], [true; 2]),
    ] {
        let inner = block([0.0; 3], [2.0, 1.0, 1.0], n, tets[0]);
        let pair = Pair::new(
            inner,
            block([1.0, 0.0, 0.0], [3.0, 1.0, 1.0], [4, 1, 2], tets[1]),
        );
        for mediator in [Model::Inner, Model::Outer] {
            let (rows, measure) = rows_of(&pair, mediator, Bracket::L2);
            assert!((measure - 1.0).abs() < 1e-12);
            let (x, y) = (|n| power(1.0, 2.0, n), |n| power(0.0, 1.0, n));
            let affine = product(&rows, &pair.mesh.nodes, |x| x[0] + x[2], |x| x[1]);
            let exact = x(1) * y(1) + x(0) * y(1) * y(1);
            affine
                .iter()
                .for_each(|f| assert!((f - exact).abs() < 1e-12, "{f} {exact}"));
            if tets == [false; 2] {
                let cube = |x: [f64; 3]| x[0] * x[1] * x[2];
                let found = product(&rows, &pair.mesh.nodes, cube, cube);
                let exact = x(2) * y(2) * y(2);
                found
                    .iter()
                    .for_each(|f| assert!((f - exact).abs() < 1e-12));
            }
        }
    }
}

#[test]
fn the_strain_term_of_the_bracket() {
    // L = (a + b x, 0), w = (c x + d y, 0): ∫ L·w + κ² (b c) |S|, ε_xy(L) being zero; on all components at once, with
    // L = (0, e x): ε_xy = e/2 on both sides gives κ²/2 · e · d for w = (d y, 0).
    let inner = plate([0.0, 0.0], [2.0, 1.0], [7, 3], true);
    let pair = Pair::new(inner, plate([1.2, 0.0], [3.2, 1.0], [5, 2], false));
    let kappa = 0.3;
    let (rows, measure) = rows_of(&pair, Model::Outer, Bracket::H1 { kappa: Some(kappa) });
    let (flat, _) = rows_of(&pair, Model::Outer, Bracket::L2);
    let nodes = &pair.mesh.nodes;
    let apply = |rows: &Rows, component: u32, field: &dyn Fn(u32, usize) -> f64| {
        let mut sums = [0.0; 2];
        for row in rows.rows.iter().filter(|row| row.component == component) {
            let m = 0.5 + 2.0 * nodes[row.node as usize][0];
            sums[0] += m * Row::apply(&row.inner, field);
            sums[1] += m * Row::apply(&row.outer, field);
        }
        sums
    };
    let w = |node: u32, k: usize| {
        let x = nodes[node as usize];
        if k == 0 { 3.0 * x[0] - 5.0 * x[1] } else { 0.0 }
    };
    for (component, expected) in [
        (0, kappa * kappa * 2.0 * 3.0 * measure),
        (1, kappa * kappa * 0.5 * 2.0 * -5.0 * measure),
    ] {
        let (all, plain) = (apply(&rows, component, &w), apply(&flat, component, &w));
        for of in 0..2 {
            assert!((all[of] - plain[of] - expected).abs() < 1e-13);
        }
    }
}
