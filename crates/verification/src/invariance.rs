//! The same impact in other elements, other units and another size.
//!
//! Problem: two bars of the set "slow", Poisson's ratio zero, theta ½, velocity law, CFL 0.5, n elements in each bar: as
//! bars, as plane-strain quadrilaterals and as hexahedra; in metres, kilograms and seconds, in millimetres, tonnes and
//! seconds, and as a model 1000 times smaller. Closed solution: the uniform motion over the section makes the three
//! kinds one recursion; a change of units changes no ratio; lengths and times / 1000 with the same velocity leave
//! F / F0 as it is. Reference: the bar in SI units, a second formulation. Tolerance: 1e-9 of F0, a thousand times the round-off of some
//! thousand steps. Only with the velocity law: the displacement law with the trapezoid below CFL 1 amplifies round-off.
//! Sizes: quick n = 50, full n = 200.

use crate::bars::{Elements, Run, SLOW, Set};
use crate::check::{Check, Row, Size};
use crate::figures::run;
use crate::kind::Kind;
use crate::shapes::largest_difference;

/// Millimetres, tonnes, seconds.
const MILLIMETRES: Set = Set {
    length: 1e3 * SLOW.length,
    area: 1e6 * SLOW.area,
    young: 1e-6 * SLOW.young,
    density: 1e-12 * SLOW.density,
    speed: 1e3 * SLOW.speed,
};

/// A model 1:1000.
const MODEL: Set = Set {
    length: 1e-3 * SLOW.length,
    area: 1e-6 * SLOW.area,
    ..SLOW
};

pub(crate) const CHECK: Check = Check {
    name: "invariance",
    fact: "elements, units and scale do not change the force of two bars",
    run: |size| {
        let base = Run::slow(match size {
            Size::Quick => 50,
            Size::Full => 200,
        });
        let ratios = |case: Run| -> Result<Vec<f64>, crate::Error> {
            let (history, _) = run(&case)?;
            Ok(history
                .force
                .iter()
                .map(|force| force / case.force())
                .collect())
        };
        let reference = ratios(base)?;
        let peak = reference.iter().fold(0.0_f64, |m, f| m.max(*f));
        let mut rows = vec![Row::printed(
            Kind::OtherCode,
            "bars: overshoot",
            peak - 1.0,
            "0.118",
        )];
        for (kind_name, kind) in [
            ("bars", Elements::Bar2),
            ("quadrilaterals", Elements::Quad4),
            ("hexahedra", Elements::Hex8),
        ] {
            for (set_name, set) in [("m", SLOW), ("mm", MILLIMETRES), ("1:1000", MODEL)] {
                let difference =
                    largest_difference(&reference, &ratios(Run { set, kind, ..base })?);
                let name = format!("{kind_name}, {set_name}: difference of force / F0");
                rows.push(Row::at_most(name, difference, 1e-9).second_formulation());
            }
        }
        Ok(rows)
    },
};
