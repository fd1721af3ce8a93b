//! Two equal bars made of other elements.
//!
//! Problem: set "slow", Poisson's ratio zero, theta ½, velocity law, CFL 0.5, as plane-stress triangles, tetrahedra, and
//! an axisymmetric cylinder. Closed solution: that of the bars. Reference: the same run with bar elements, n the same.
//! Tolerance: the cylinder's motion is uniform over the section, so its force is that of the bar to round-off of some
//! thousand steps, 1e-9 of F0. Triangles and tetrahedra share their mass unevenly between the nodes of an end face: the
//! end rocks. Restitution within 1/(4 n), the part of the energy that the end masses bring into the impact. Force error
//! and overshoot are decided by the last element and follow no order: regressions, to 1 % of the figure. Energy and momentum
//! balances hold to round-off. Sizes: quick n = 40, full n = 200.

use crate::bars::{Elements, Run};
use crate::check::{Check, Row, Size};
use crate::figures::run;

pub(crate) const CHECK: Check = Check {
    name: "shapes",
    fact: "bars of triangles, of tetrahedra and as a cylinder strike like bars",
    run: |size| {
        // force error and overshoot of triangles and of tetrahedra
        let (elements, found) = match size {
            Size::Quick => (40, [[0.0924560, 0.109272], [0.106269, 0.112704]]),
            Size::Full => (200, [[0.0488411, 0.102372], [0.0490415, 0.112981]]),
        };
        let case = |kind| Run {
            kind,
            ..Run::slow(elements)
        };
        let (bar, reference) = run(&case(Elements::Bar2))?;
        let (cylinder, figures) = run(&case(Elements::Cylinder))?;
        let force = case(Elements::Bar2).force();
        let difference = largest_difference(&bar.force, &cylinder.force) / force;
        let mut rows = vec![
            Row::at_most("cylinder: difference of force / F0", difference, 1e-9)
                .second_formulation(),
        ];
        rows.extend(figures.balances("cylinder"));
        for (name, kind, [error, overshoot]) in [
            ("triangles", Elements::Tri3, found[0]),
            ("tetrahedra", Elements::Tet4, found[1]),
        ] {
            let (_, figures) = run(&case(kind))?;
            let row = |quantity: &str| format!("{name}: {quantity}");
            rows.extend([
                Row::relative(row("force error"), figures.force_error, error, 0.01).regression(),
                Row::relative(row("overshoot"), figures.overshoot, overshoot, 0.01).regression(),
                Row::near(
                    row("restitution"),
                    figures.restitution,
                    reference.restitution,
                    0.25 / elements as f64,
                )
                .second_formulation(),
            ]);
            rows.extend(figures.balances(name));
        }
        Ok(rows)
    },
};

/// max |a - b|; infinite if they differ in length.
pub(crate) fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    a.iter().zip(b).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}
