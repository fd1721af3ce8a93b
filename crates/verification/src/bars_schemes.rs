//! Two equal bars: the schemes of the literature on impact, each with the law that it is made for.
//!
//! Problem: set "slow", all ends free, lumped mass, n = 200, CFL 0.5. Closed solution: F = Z v0 / 2 for 2 L / c. Reference:
//! the project's table of bars in impact, from an independent implementation, for generalised-alpha and Paoli-Schatzman;
//! for the others what must be. Laursen-Chawla: the energy is exact and the force useless (the project's theory gives an
//! error of 142 % and hundreds of changes of status), which is shown. Second formulations: Tchamwa-Wielgosz with φ = 1 is the
//! leapfrog, as central differences are: same forces, since nothing accelerates at the start; above, it loses more energy the
//! larger φ is. HHT with α = 0 is the trapezoid. Kane with γ = 2β never gains energy and never penetrates, and its force
//! oscillates, which is shown. What HHT and Kane lose: regressions, to 1 % of the figure. Tolerance: a unit of the last digit
//! printed; 1e-11 for balances, 1e-9 for equal forces, a thousand steps of other rounding.

use carom_contact::Law;
use carom_dynamics::Scheme;
use carom_dynamics::scheme::{
    GeneralisedAlpha, Hht, Kane, LaursenChawla, PaoliSchatzman, TchamwaWielgosz,
};

use crate::Error;
use crate::bars::Run;
use crate::build::{CENTRAL, DISPLACEMENT, HALF, NOW, newmark};
use crate::check::{Check, Row};
use crate::figures::{Figures, History, run};

const ALPHA: Scheme = Scheme::GeneralisedAlpha(GeneralisedAlpha { rho_inf: 0.8 });
const PAOLI: Scheme = Scheme::PaoliSchatzman(PaoliSchatzman { restitution: 0.0 });

fn case(scheme: Scheme, law: Law) -> Run {
    Run {
        scheme,
        law,
        ..Run::slow(200)
    }
}

fn tchamwa(phi: f64) -> Run {
    case(Scheme::TchamwaWielgosz(TchamwaWielgosz { phi }), NOW)
}

/// Largest difference of the forces / F0.
fn difference(case: &Run, one: &History, other: &History) -> f64 {
    let pairs = one.force.iter().zip(&other.force);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / case.force()
}

fn table(rows: &mut Vec<Row>) -> Result<(), Error> {
    let lines = [
        (
            "generalised-alpha 0.8",
            case(ALPHA, DISPLACEMENT),
            ["0.097", "1.42", "-0.002", "", "0.99", "0.000", ""],
        ),
        (
            "Paoli-Schatzman",
            case(PAOLI, DISPLACEMENT),
            ["0.0470", "0.118", "-0.0014", "1", "0.990", "0.000", ""],
        ),
    ];
    for (name, case, printed) in lines {
        let (_, figures) = run(&case)?;
        rows.extend(figures.against(name, printed));
        rows.extend(figures.balances(name));
    }
    Ok(())
}

fn mean_rate(rows: &mut Vec<Row>) -> Result<(), Error> {
    for (name, law) in [("now", NOW), ("half", HALF)] {
        let (_, figures) = run(&case(Scheme::LaursenChawla(LaursenChawla {}), law))?;
        let name = format!("Laursen-Chawla, {name}");
        rows.extend(figures.balances(&name));
        let row = |what: &str| format!("{name}: {what}");
        let change = figures.energy_change.abs();
        rows.push(Row::at_most(row("energy change"), change, 1e-11));
        rows.push(Row::shown(row("force error"), figures.force_error));
        let switches = figures.switches as f64;
        rows.push(Row::shown(row("changes"), switches));
    }
    Ok(())
}

fn leapfrog(rows: &mut Vec<Row>) -> Result<(), Error> {
    let (history, first) = run(&tchamwa(1.0))?;
    let (central, _) = run(&case(CENTRAL, NOW))?;
    rows.push(
        Row::at_most(
            "Tchamwa-Wielgosz 1: forces against central differences / F0",
            difference(&tchamwa(1.0), &history, &central),
            1e-9,
        )
        .second_formulation(),
    );
    rows.extend(first.balances("Tchamwa-Wielgosz 1"));
    let mut last = first;
    for phi in [1.033, 1.1, 1.3] {
        let (_, figures) = run(&tchamwa(phi))?;
        let name = format!("Tchamwa-Wielgosz {phi}");
        rows.extend(figures.balances(&name));
        rows.push(
            Row::at_most(
                format!("{name}: energy change"),
                figures.energy_change,
                last.energy_change,
            )
            .second_formulation(),
        );
        last = figures;
    }
    Ok(())
}

fn averaged(rows: &mut Vec<Row>) -> Result<(), Error> {
    let hht = |alpha| case(Scheme::Hht(Hht { alpha }), DISPLACEMENT);
    let at = |run: Run| Run {
        courant: 2.0,
        ..run
    };
    let (history, _) = run(&at(hht(0.0)))?;
    let (trapezoid, _) = run(&at(case(newmark(0.25, 0.5), DISPLACEMENT)))?;
    rows.push(
        Row::at_most(
            "HHT 0, CFL 2: forces against the trapezoid / F0",
            difference(&hht(0.0), &history, &trapezoid),
            1e-9,
        )
        .second_formulation(),
    );
    for (alpha, own) in [(-0.1, -3.98145e-3), (-0.3, -3.42928e-3)] {
        let (_, figures) = run(&hht(alpha))?;
        let name = format!("HHT {alpha}");
        rows.extend(figures.balances(&name));
        rows.push(loses(&name, &figures, own));
    }
    Ok(())
}

fn implicit_forces(rows: &mut Vec<Row>) -> Result<(), Error> {
    for (beta, gamma, own) in [
        (0.25, 0.5, -1.65701e-3),
        (0.49, 0.9, -2.82165e-2),
        (0.5, 0.5, -1.87291e-3),
    ] {
        let (history, figures) = run(&case(Scheme::Kane(Kane { beta, gamma }), DISPLACEMENT))?;
        let name = format!("Kane ({beta}, {gamma})");
        rows.extend(figures.balances(&name));
        rows.push(loses(&name, &figures, own));
        let deep = figures.penetration;
        rows.push(Row::at_most(
            format!("{name}: penetration / (v0 dt)"),
            deep,
            1e-9,
        ));
        if gamma == 2.0 * beta {
            let energy = &history.energy;
            let gains = energy.windows(2).map(|pair| pair[1] / pair[0] - 1.0);
            rows.push(Row::at_most(
                format!("{name}: largest gain of energy in a step"),
                gains.fold(0.0, f64::max),
                1e-12,
            ));
            rows.push(Row::shown(
                format!("{name}: force error"),
                figures.force_error,
            ));
        }
    }
    Ok(())
}

/// The energy change that was found, to 1 % of it.
fn loses(name: &str, figures: &Figures, own: f64) -> Row {
    let name = format!("{name}: energy change");
    Row::relative(name, figures.energy_change, own, 0.01).regression()
}

pub(crate) const CHECK: Check = Check {
    name: "bars-schemes",
    fact: "two equal bars under the schemes of the literature do what the table and their theory say",
    run: |_| {
        let mut rows = Vec::new();
        table(&mut rows)?;
        mean_rate(&mut rows)?;
        leapfrog(&mut rows)?;
        averaged(&mut rows)?;
        implicit_forces(&mut rows)?;
        Ok(rows)
    },
};
