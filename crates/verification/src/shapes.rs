//! Two equal bars made of other elements.
//!
//! Problem: set "slow", Poisson's ratio zero, theta ½, velocity law, CFL 0.5, as plane-stress triangles, tetrahedra, and
//! an axisymmetric cylinder. Closed solution: that of the bars. Reference: the same run with bar elements, n the same.
//! Tolerance: the cylinder's motion is uniform over the section, so its force is that of the bar to round-off of some
//! thousand steps, 1e-9 of F0. Triangles and tetrahedra share their mass unevenly between the nodes of an end face: the
//! end rocks, and figures that the last element decides differ: force error by 0.03 at n = 40, where elements are ten
//! times longer than wide, and 0.005 at n = 200; overshoot by 0.02, restitution by 0.001 at both. Energy and momentum
//! balances hold to round-off. Sizes: quick n = 40, full n = 200.

use crate::bars::{Elements, Run};
use crate::check::{Check, Row, Size};
use crate::figures::run;

pub(crate) const CHECK: Check = Check {
    name: "shapes",
    fact: "bars of triangles, of tetrahedra and as a cylinder strike like bars",
    run: |size| {
        let (elements, error) = match size {
            Size::Quick => (40, 0.03),
            Size::Full => (200, 0.005),
        };
        let case = |kind| Run {
            kind,
            ..Run::slow(elements)
        };
        let (bar, reference) = run(&case(Elements::Bar2))?;
        let (cylinder, figures) = run(&case(Elements::Cylinder))?;
        let force = case(Elements::Bar2).force();
        let difference = largest_difference(&bar.force, &cylinder.force) / force;
        let mut rows = vec![Row::at_most(
            "cylinder: difference of force / F0",
            difference,
            1e-9,
        )];
        rows.extend(figures.balances("cylinder"));
        for (name, kind) in [
            ("triangles", Elements::Tri3),
            ("tetrahedra", Elements::Tet4),
        ] {
            let (_, figures) = run(&case(kind))?;
            let row = |quantity: &str| format!("{name}: {quantity}");
            rows.push(Row::near(
                row("force error"),
                figures.force_error,
                reference.force_error,
                error,
            ));
            rows.push(Row::near(
                row("overshoot"),
                figures.overshoot,
                reference.overshoot,
                0.02,
            ));
            rows.push(Row::near(
                row("restitution"),
                figures.restitution,
                reference.restitution,
                0.001,
            ));
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
