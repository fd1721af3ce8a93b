//! Two bars with fine tips glued to a coarse rest.
//!
//! Problem: the set "slow", tips of 2 m with elements of 0.05 m in velocities (theta), the rest with elements of 0.2 m in
//! displacements (trapezoid, or central differences), overlap 0.8 m, linear weights, L2 mediator on the coarse mesh.
//! Closed solution: F = Z v0 / 2 up to 2 L / c. Reference: the project's table of bars, from an independent
//! implementation. Tolerance: one unit of the printed digit. Passes: two a step, and a tenth more for steps in which the
//! contact closes or opens. Mean force: 2 % for the momentum that spread fronts hold back, 1 - restitution = 0.025 of two bars as
//! coarse as the rest. Forces of the single mesh, of the other form of the links, and of four inner steps always: second
//! formulations, to the rounding of their steps; so is the cost, half of the single fine mesh at most.

use carom_arlequin::{Profile, Weighting};
use carom_zones::LinkKind;

use crate::Error;
use crate::bars::{Run, SLOW};
use crate::build::{CENTRAL, NOW, newmark, theta};
use crate::check::{Check, Row};
use crate::figures::{drive, run};
use crate::glued::{Glued, swept};
use crate::kind::Kind;

pub(crate) const CHECK: Check = Check {
    name: "arlequin-bars",
    fact: "bars with glued fine tips give the exact force as well as the table says, and the links close their balances",
    run: |_| {
        let trapezoid = newmark(0.25, 0.5);
        let lines = [
            (
                "trapezoid, gc, 1",
                trapezoid,
                0.2,
                1,
                ["0.125", "0.32"],
                ["0.069", "0.053", "-0.0108"],
            ),
            (
                "explicit, gc, 1",
                CENTRAL,
                0.9,
                1,
                ["0.065", "0.03"],
                ["0.075", "0.016", "-0.0221"],
            ),
            (
                "explicit, ph, 4",
                CENTRAL,
                0.8,
                4,
                ["0.101", "0.24"],
                ["0.062", "0.053", "-0.0105"],
            ),
        ];
        let mut rows = Vec::new();
        for (name, outer, courant, substeps, half, more) in lines {
            for (theta, printed) in [(0.5, &half[..]), (0.6, &more[..])] {
                let run = Glued::slow(theta, outer, courant, substeps);
                let figures = run.run_to(1.5 * SLOW.duration())?;
                let name = format!("{name}, theta {theta}");
                let values = [
                    figures.force_error,
                    figures.overshoot,
                    figures.energy_change,
                ];
                let what = ["force error", "overshoot", "energy change"];
                rows.push(Row::at_most(
                    format!("{name}: energy residual"),
                    figures.residual,
                    1e-11,
                ));
                rows.push(Row::at_most(
                    format!("{name}: momentum residual"),
                    figures.momentum,
                    1e-11,
                ));
                rows.push(Row::at_most(
                    format!("{name}: passes to a step"),
                    figures.passes,
                    2.2,
                ));
                for ((what, value), printed) in what.iter().zip(values).zip(printed) {
                    rows.push(Row::printed(
                        Kind::OtherCode,
                        format!("{name}: {what}"),
                        value,
                        printed,
                    ));
                }
            }
        }
        rows.extend(same_mesh()?);
        rows.extend(two_forms()?);
        rows.extend(cheaper()?);
        rows.extend(pairs_of_schemes()?);
        rows.extend(far_and_near()?);
        Ok(rows)
    },
};

/// Matching meshes, theta ½ in the tips, trapezoid in the rest, one step: the single mesh, whatever the weights.
fn same_mesh() -> Result<Vec<Row>, Error> {
    let single = Run {
        courant: 0.5,
        ..Run::slow(100)
    };
    let (history, _) = run(&single)?;
    let mut rows = Vec::new();
    let profiles = [
        ("linear", Profile::Linear, 0.0),
        ("smooth", Profile::Smooth, 0.0),
        ("constant", Profile::Constant(0.3), 0.0),
        ("linear with floor", Profile::Linear, 0.1),
    ];
    for (name, profile, floor) in profiles {
        let glued = Glued {
            sizes: [0.1, 0.1],
            dt: single.dt(),
            weighting: Weighting {
                inertia: profile,
                stiffness: profile,
                floor,
            },
            ..Glued::slow(0.5, newmark(0.25, 0.5), 0.5, 1)
        };
        let figures = glued.run_to(1.5 * SLOW.duration())?;
        let pairs = history.force.iter().zip(&figures.force);
        let worst = pairs.fold(0.0, |m: f64, (one, (_, other))| m.max((one - other).abs()));
        rows.push(
            Row::at_most(
                format!("same mesh, {name} weights: largest force difference / F0"),
                worst / single.force(),
                1e-10,
            )
            .second_formulation(),
        );
        rows.push(Row::count(
            format!("same mesh, {name} weights: steps compared"),
            figures.force.len(),
            history.force.len(),
        ));
    }
    // a control: with four steps to one the force is another one
    let glued = Glued {
        sizes: [0.1, 0.1],
        dt: 4.0 * single.dt(),
        substeps: 4,
        kind: LinkKind::PrakashHjelmstad,
        ..Glued::slow(0.5, newmark(0.25, 0.5), 0.5, 4)
    };
    let figures = glued.run_to(1.5 * SLOW.duration())?;
    let pairs = history.force.iter().zip(&figures.force);
    let worst = pairs.fold(0.0, |m: f64, (one, (_, other))| m.max((one - other).abs()));
    rows.push(Row::shown(
        "same mesh, four inner steps: largest force difference / F0",
        worst / single.force(),
    ));
    rows.push(Row::count(
        "same mesh, four inner steps: steps of the tips in one of the rest",
        figures.force.len(),
        4 * history.force.len().div_ceil(4),
    ));
    Ok(rows)
}

/// The dense condensed form against the rows joined to the factor of the tips.
fn two_forms() -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for (name, outer, courant) in [
        ("trapezoid", newmark(0.25, 0.5), 0.2),
        ("explicit", CENTRAL, 0.9),
    ] {
        let dense = Glued::slow(0.5, outer, courant, 1);
        let joined = Glued {
            joined: true,
            ..dense
        };
        let end = 1.5 * SLOW.duration();
        let [one, other] = [dense.run_to(end)?, joined.run_to(end)?];
        let pairs = one.force.iter().zip(&other.force);
        let worst = pairs.fold(0.0, |m: f64, (a, b)| m.max((a.1 - b.1).abs()));
        let f0 = 0.5 * SLOW.impedance() * SLOW.speed;
        rows.push(
            Row::at_most(
                format!("{name}: joined and condensed forms, largest force difference / F0"),
                worst / f0,
                1e-11,
            )
            .second_formulation(),
        );
        rows.push(Row::at_most(
            format!("{name}: passes to a step in the joined form"),
            other.passes,
            2.2,
        ));
    }
    Ok(rows)
}

/// Bars that fly before they meet, with one inner step while they cannot touch and four in the shock, against four always.
fn far_and_near() -> Result<Vec<Row>, Error> {
    let always = Glued {
        gap: 20.3 * SLOW.speed * Glued::slow(0.6, CENTRAL, 0.8, 4).dt,
        ..Glued::slow(0.6, CENTRAL, 0.8, 4)
    };
    let chosen = Glued {
        far: Some(1),
        ..always
    };
    let end = 1.2 * SLOW.duration();
    let [one, other] = [always.run_to(end)?, chosen.run_to(end)?];
    let f0 = 0.5 * SLOW.impedance() * SLOW.speed;
    // the instants of the shock are those of both
    let worst = other.force.iter().fold(0.0, |m: f64, (time, force)| {
        let same = one
            .force
            .iter()
            .find(|(t, _)| (t - time).abs() < 1e-3 * always.dt);
        m.max(same.map_or(f64::INFINITY, |(_, f)| (f - force).abs()))
    });
    Ok(vec![
        Row::at_most(
            "one inner step in flight: largest force difference / F0",
            worst / f0,
            1e-9,
        )
        .second_formulation(),
        Row::at_least(
            "one inner step in flight: inner steps saved in 18 outer steps of flight",
            one.inner_steps as f64 - other.inner_steps as f64,
            3.0 * 18.0,
        ),
        Row::at_most(
            "one inner step in flight: energy residual",
            other.residual,
            1e-11,
        ),
        Row::at_most(
            "one inner step in flight: momentum residual",
            other.momentum,
            1e-11,
        ),
    ])
}

/// Force error and counted cost of glued tips (explicit rest, four inner steps, θ = 0.6) against the single fine mesh with the
/// scheme and the step of the tips.
fn cheaper() -> Result<Vec<Row>, Error> {
    let glued = Glued::slow(0.6, CENTRAL, 0.8, 4).run_to(1.5 * SLOW.duration())?;
    let single = Run {
        scheme: theta(0.6),
        law: NOW,
        courant: 0.8,
        ..Run::slow(200)
    };
    let (_, figures) = run(&single)?;
    let (driver, _) = drive(&single)?;
    let costs = driver.costs();
    Ok(vec![
        Row::printed(
            Kind::OtherCode,
            "single fine mesh, theta 0.6: force error",
            figures.force_error,
            "0.091",
        ),
        Row::at_most(
            "glued / single fine mesh, theta 0.6: force error",
            glued.force_error / figures.force_error,
            1.0,
        )
        .second_formulation(),
        Row::at_most(
            "glued / single fine mesh: element updates",
            glued.element_updates / costs.element_updates as f64,
            0.5,
        )
        .second_formulation(),
        Row::at_most(
            "glued / single fine mesh: entries of factors swept",
            glued.swept / swept(&costs),
            0.5,
        )
        .second_formulation(),
    ])
}

/// Every pair of schemes that links take, with one and with four inner steps, by both links: balances, and the mean force.
fn pairs_of_schemes() -> Result<Vec<Row>, Error> {
    let schemes = [
        ("theta", theta(0.6)),
        ("trapezoid", newmark(0.25, 0.5)),
        ("damped newmark", newmark(0.3025, 0.6)),
        ("central", CENTRAL),
    ];
    let f0 = 0.5 * SLOW.impedance() * SLOW.speed;
    let kinds = [LinkKind::GravouilCombescure, LinkKind::PrakashHjelmstad];
    let mut rows = Vec::new();
    for (inner, of_tips) in schemes {
        for (outer, of_rest) in schemes {
            for (kind, substeps) in [(kinds[0], 1), (kinds[0], 4), (kinds[1], 4)] {
                // the step is that of the fine mesh where both take the same
                let courant = if substeps == 1 { 0.2 } else { 0.8 };
                let glued = Glued {
                    schemes: [of_tips, of_rest],
                    kind,
                    ..Glued::slow(0.6, of_rest, courant, substeps)
                };
                let figures = glued.run_to(0.9 * SLOW.duration())?;
                let name = format!("{inner} in {outer}, {kind:?}, {substeps}");
                rows.push(Row::at_most(
                    format!("{name}: energy residual"),
                    figures.residual,
                    1e-11,
                ));
                rows.push(Row::at_most(
                    format!("{name}: momentum residual"),
                    figures.momentum,
                    1e-11,
                ));
                // the impulse converges where single forces ring: momentum of the bars, with what the fronts are wide
                let mean: f64 = figures.force.iter().map(|(_, force)| force).sum();
                let mean = mean / figures.force.len() as f64 / f0;
                rows.push(Row::near(
                    format!("{name}: mean force / F0"),
                    mean,
                    1.0,
                    0.02,
                ));
            }
        }
    }
    Ok(rows)
}
