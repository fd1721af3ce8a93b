//! Two equal bars, each a zone of its own, in contact with each other.
//!
//! Problem: set "slow" as in `bars-theta`. With one scheme in both zones the run is that of the single model: the project's table of
//! bars in impact, from an independent implementation, n = 200 in each bar, to a unit of the last digit printed. With two
//! schemes, and with four steps of one zone to one of the other, both sides get the same impulse in each step, so that the momentum
//! stays to round-off; a wave front crosses from one bar to the other with the force Z v0 / 2 of the exact solution (mean over
//! the middle of the contact: 1 %, since the oscillations behind the front have a mean that falls as 1/n).
//!
//! With adaptive steps the bars fly through a gap of 12.37 ways of a step first. The force begins where the step of the single model that
//! closes begins (a second formulation, to round-off of the flight: 1e-10 of the contact), which is within a step of the instant gap/v0 of the
//! exact solution, and the cut outer steps leave momentum and impulse as they are.

use carom_dynamics::scheme::{CentralDifference, Newmark};
use carom_dynamics::{Adaptive, Closing, Driver, Model, Scheme, State, Stepper};
use carom_zones::{LinkKind, ModelZone, Whole, Zoned};

use crate::Error;
use crate::bars::Run;
use crate::build::{HALF, NOW, theta};
use crate::check::{Check, Row};
use crate::figures::{Figures, History, run_stepper};

pub(crate) const CHECK: Check = Check {
    name: "zones-in-contact",
    fact: "a contact between two zones is that of one model, and keeps the momentum between schemes and steps",
    run: |_| {
        let half = Run {
            law: HALF,
            ..Run::slow(200)
        };
        let printed = ["0.0470", "0.118", "-0.001398", "1", "0.9904", "0.500", ""];
        let (_, figures, _) = in_zones(&half, [half.scheme; 2], 1)?;
        let name = "theta 0.5 in both zones";
        let mut rows = figures.against(name, printed);
        rows.extend(figures.balances(name));
        let newmark = Scheme::Newmark(Newmark::default());
        let explicit = Scheme::CentralDifference(CentralDifference {});
        let pairs = [
            ("theta 0.5 and 1", [theta(0.5), theta(1.0)], 1),
            ("newmark and central difference", [newmark, explicit], 1),
            ("theta 0.5, four steps to one", [theta(0.5); 2], 4),
            ("newmark, four steps to one", [newmark; 2], 4),
            ("central difference, four steps to one", [explicit; 2], 4),
            (
                "newmark and central difference, four steps to one",
                [newmark, explicit],
                4,
            ),
            (
                "theta 0.5 and 1, four steps to one",
                [theta(0.5), theta(1.0)],
                4,
            ),
        ];
        for (name, schemes, substeps) in pairs {
            let case = Run {
                law: if substeps == 1 { NOW } else { HALF },
                ..Run::slow(200)
            };
            let (history, figures, state) = in_zones(&case, schemes, substeps)?;
            rows.extend(figures.balances(name));
            let duration = case.set.duration();
            let middle = |time: &f64| (0.1..0.9).contains(&(time / duration));
            let inside = history.time.iter().zip(&history.force);
            let inside: Vec<f64> = inside.filter(|(t, _)| middle(t)).map(|(_, f)| *f).collect();
            let mean = inside.iter().sum::<f64>() / inside.len() as f64;
            rows.push(Row::near(
                format!("{name}: mean force / F0"),
                mean / case.force(),
                1.0,
                0.01,
            ));
            let [before, after] = [&state.ledger.initial, &state.ledger.balance];
            let [before, after] = [before, after].map(|balance| balance.momentum.linear[0]);
            let change = (after / before - 1.0).abs();
            rows.push(Row::at_most(
                format!("{name}: change of the momentum"),
                change,
                1e-12,
            ));
            rows.push(Row::shown(
                format!("{name}: energy change"),
                figures.energy_change,
            ));
            rows.push(Row::shown(
                format!("{name}: restitution"),
                figures.restitution,
            ));
        }
        for (name, schemes) in [
            ("theta 0.5, four steps to one, adaptive", [theta(0.5); 2]),
            (
                "theta 0.5 and 1, four steps to one, adaptive",
                [theta(0.5), theta(1.0)],
            ),
        ] {
            rows.extend(adaptive(name, schemes)?);
        }
        Ok(rows)
    },
};

/// Ways of a step that the bars fly before the contact.
const FLOWN: f64 = 12.37;

/// Rows of a run with adaptive outer steps, four inner ones of the second bar in each.
fn adaptive(name: &str, schemes: [Scheme; 2]) -> Result<Vec<Row>, Error> {
    let mut case = Run::slow(200);
    case.gap = FLOWN * case.set.speed * case.dt();
    let mut model = case.model()?;
    model.adaptive = Some(Adaptive {
        smallest: case.dt() / 64.0,
        closing: Closing::Cut,
        growth: None,
        patience: 10,
    });
    let zoned = zoned(model.clone(), schemes, 4);
    let mut whole = Whole::new(&zoned, zoned.whole()?)?;
    let mut single = Driver::new(crate::witness::system(model)?)?;
    let (history, figures) = run_stepper(&case, &mut whole)?;
    run_stepper(&case, &mut single)?;
    let record = |state: &State| state.records.contacts[0].clone();
    let (own, of_single) = (record(whole.state()), record(single.state()));
    let [closing, reference] =
        [&own, &of_single].map(|record| record.first_closing.unwrap_or(f64::INFINITY));
    let duration = case.set.duration();
    let exact = case.gap / case.set.speed;
    let inside = history.time.iter().zip(&history.force);
    let middle = |time: &f64| (0.1..0.9).contains(&((time - exact) / duration));
    let inside: Vec<f64> = inside.filter(|(t, _)| middle(t)).map(|(_, f)| *f).collect();
    let mean = inside.iter().sum::<f64>() / inside.len() as f64;
    let ledger = &whole.state().ledger;
    let [before, after] = [&ledger.initial, &ledger.balance].map(|b| b.momentum.linear[0]);
    let sums = own.impulse_of_forces() / own.impulse();
    let name = |what: &str| format!("{name}: {what}");
    let mut rows = figures.balances(&name("balances")).to_vec();
    rows.extend([
        Row::at_most(
            name("closing against the single model / duration"),
            (closing - reference).abs() / duration,
            1e-10,
        )
        .second_formulation(),
        Row::at_most(
            name("closing against gap / v0, in steps"),
            (closing - exact).abs() / case.dt(),
            1.0,
        ),
        Row::at_least(
            name("outer steps cut"),
            whole.state().control.cut as f64,
            1.0,
        ),
        Row::near(name("mean force / F0"), mean / case.force(), 1.0, 0.01),
        Row::at_most(
            name("change of the momentum"),
            (after / before - 1.0).abs(),
            1e-12,
        ),
        Row::near(name("sum of force times step / impulse"), sums, 1.0, 1e-12),
    ]);
    Ok(rows)
}

/// The run with a zone for each bar, of which the second takes `substeps` steps to one of the first.
fn in_zones(
    case: &Run,
    schemes: [Scheme; 2],
    substeps: u32,
) -> Result<(History, Figures, State), Error> {
    let model = case.model()?;
    let zoned = zoned(model.clone(), schemes, substeps);
    let mut stepper: Box<dyn Stepper> = match (zoned.together()?, substeps) {
        (Some(system), 1) => Box::new(Driver::new(system)?),
        (None, 1) => return Err(Error::Apart),
        _ => Box::new(Whole::new(&zoned, zoned.whole()?)?),
    };
    let (history, figures) = run_stepper(case, &mut *stepper)?;
    Ok((history, figures, stepper.state().clone()))
}

/// A zone for each bar, of which the second takes `substeps` steps to one of the first.
fn zoned(model: Model, schemes: [Scheme; 2], substeps: u32) -> Zoned {
    let zone = |(body, scheme): (usize, Scheme)| {
        ModelZone::new(
            model.bodies[body].spec.name.clone(),
            vec![body],
            (scheme, if body == 1 { substeps } else { 1 }),
        )
    };
    Zoned {
        zones: schemes.into_iter().enumerate().map(zone).collect(),
        links: Vec::new(),
        kind: LinkKind::PrakashHjelmstad,
        model,
    }
}
