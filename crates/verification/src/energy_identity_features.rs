//! The energy that a scheme makes or takes, by its identity and by works.
//!
//! Problem: a block comes down on a block, plane strain, linear; every scheme with every law, as it is, and with a traction of
//! amplitude zero on its side, which makes the steps those of a model that is not linear: their energy is balanced by the works of
//! inertia and internal forces, and not by the exact identity of the scheme. Closed solution: a load of nothing changes nothing,
//! neither the motion nor the work of the contacts nor what the scheme dissipates and stores. Reference: the run without the load, a second
//! formulation. Tolerance: 1e-9 of the largest displacement, and of the largest energy: the iterations end at residuals of 1e-10 where
//! they are not exact, and the trapezoid with the displacement law multiplies what they leave.

use carom_contact::Sliding;
use carom_dynamics::{Amplitude, Driver, Load, LoadKind, Model, Scheme, State};

use crate::Error;
use crate::battery::is_senseless;
use crate::build::surface;
use crate::check::{Check, Row};
use crate::features::{Feature, label};

const STEPS: u64 = 24;

fn run(model: Model) -> Result<State, Error> {
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    while driver.state().step < STEPS {
        driver.step()?;
    }
    Ok(driver.state().clone())
}

pub(crate) const CHECK: Check = Check {
    name: "energy-identity-features",
    fact: "a load of nothing changes neither motion nor energies, whichever way the energy of a step is balanced",
    run: |_| {
        let mut rows = Vec::new();
        for scheme in Scheme::registered() {
            for (law_name, law) in Feature::FiniteSliding.laws()? {
                if is_senseless(scheme, law) {
                    continue;
                }
                let blocks = Feature::FiniteSliding.blocks(1);
                let model = blocks.model(scheme, law, Sliding::Finite)?;
                let mut loaded = model.clone();
                loaded.nonlinear.loads = vec![Load {
                    name: "nothing".to_string(),
                    surface: surface(&model.mesh, "upper.left", &model.bodies[0])?,
                    kind: LoadKind::Traction([0.0; 3]),
                    amplitude: Amplitude::constant(0.0),
                }];
                let (one, other) = (run(model)?, run(loaded)?);
                let name = format!("{}, {law_name}", label(scheme));
                let largest = |u: &[f64]| u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
                let moved: Vec<f64> = one
                    .motion
                    .u
                    .iter()
                    .zip(&other.motion.u)
                    .map(|(a, b)| a - b)
                    .collect();
                let [a, b] = [&one, &other].map(|state| &state.ledger.balance);
                let size = one.ledger.largest_energy;
                let mut row = |what: &str, value: f64| {
                    rows.push(
                        Row::at_most(format!("{name}: {what}"), value, 1e-9).second_formulation(),
                    );
                };
                row("motion apart", largest(&moved) / largest(&one.motion.u));
                row(
                    "work of contacts apart",
                    (a.work_contact - b.work_contact).abs() / size,
                );
                row(
                    "energy of the scheme apart",
                    (a.scheme_energy - b.scheme_energy).abs() / size,
                );
                row(
                    "dissipation apart",
                    (a.dissipation_scheme - b.dissipation_scheme).abs() / size,
                );
            }
        }
        Ok(rows)
    },
};
