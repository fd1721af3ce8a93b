//! Steps that adapt themselves to events, with friction, finite strain and the like.
//!
//! Problem: a block of 0.6 m x 0.4 m, plane strain, 3 x 2 elements, flies at 5 m/s and 1 m/s sideways at a rigid plane through gaps of 3.3 and 3.8
//! v0 dt and comes back; friction, neo-Hooke, plasticity, viscoelasticity, pairing at every step, mortar; every scheme with one of the laws that it takes,
//! closings cut. Closed solution: a cut puts the closing at the same place of a step wherever the block starts, so that the first
//! forces of both flights are the same; balances hold whatever the steps are. Reference: the other flight, a second formulation; the
//! ledger's own terms. Tolerance: forces 1e-6 of ρ c v0 A, as for bars; balances 1e-11 of the largest energy and momentum and what the
//! iterations may leave over, at most 1e-7.

use carom_contact::{Basis, Integration, Law, Sliding};
use carom_dynamics::{Adaptive, Closing, Driver, Model, ModelTarget, Scheme};
use carom_materials::Plane;

use crate::Error;
use crate::blocks::{FACE, RUBBER};
use crate::build::plane;
use crate::check::{Check, Row};
use crate::combinations::Balances;
use crate::features::{Feature, label, schemes};
use crate::reasons::reason;

const FEATURES: [Feature; 6] = [
    Feature::Friction,
    Feature::FiniteStrain,
    Feature::Plasticity,
    Feature::Viscosity,
    Feature::FiniteSliding,
    Feature::Mortar,
];
/// Forces of two flights that are compared.
const COMPARED: usize = 5;
/// Largest time of a flight, in steps.
const END: f64 = 30.0;

fn model(feature: Feature, scheme: Scheme, law: Law, flight: f64) -> Result<Model, Error> {
    let mut model = feature.blocks(1).model(scheme, law, Sliding::Finite)?;
    let target: ModelTarget = plane(1, 1.0);
    model.contacts[0].primary = target;
    model.bodies.truncate(1);
    let upper = &mut model.bodies[0];
    upper.spec.material = feature.material();
    upper.displacement[1] = -flight * model.dt * upper.velocity[1];
    match feature {
        Feature::Friction => model.contacts[0].friction = 0.3.into(),
        Feature::Mortar => {
            model.contacts[0].integration = Integration::Mortar {
                basis: Basis::Standard,
            }
        }
        _ => {}
    }
    model.adaptive = Some(Adaptive {
        smallest: model.dt / 16.0,
        closing: Closing::Cut,
        growth: None,
        patience: 10,
    });
    Ok(model)
}

/// The first forces, N, and what is left over.
fn fly(model: Model) -> Result<(Vec<f64>, Balances), Error> {
    let end = END * model.dt;
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let mut forces = Vec::new();
    while driver.state().time < end {
        driver.step()?;
        let force: f64 = driver.state().interface.force.iter().sum();
        if forces.len() < COMPARED && (force != 0.0 || !forces.is_empty()) {
            forces.push(force);
        }
    }
    Ok((forces, Balances::of(driver.state())))
}

pub(crate) const CHECK: Check = Check {
    name: "adaptive-features",
    fact: "steps are cut where contacts close and balances hold with friction, large strain, mortar and the like too",
    run: |_| {
        let size = RUBBER.density * RUBBER.wave_speed(Plane::Full) * 5.0 * FACE.sqrt();
        let mut rows = Vec::new();
        for (k, feature) in FEATURES.into_iter().enumerate() {
            let laws = feature.laws()?;
            for (j, scheme) in schemes().into_iter().enumerate() {
                for i in 0..laws.len() {
                    let (law_name, law) = laws[(i + j + k) % laws.len()];
                    let [one, other] =
                        [3.3, 3.8].map(|gap| model(feature, scheme, law, gap).and_then(fly));
                    let (one, other) = match (one, other) {
                        (Ok(one), Ok(other)) => (one, other),
                        (Err(error), _) | (_, Err(error)) => {
                            if reason(&error).is_some() {
                                continue;
                            }
                            return Err(error);
                        }
                    };
                    let name = format!("{}, {}, {law_name}", feature.name(), label(scheme));
                    let pairs = one.0.iter().zip(&other.0);
                    let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                    let counted = one.0.len().min(other.0.len());
                    rows.push(Row::count(format!("{name}: forces"), counted, COMPARED));
                    let what =
                        format!("{name}: first forces of two flights, difference / (rho c v0 A)");
                    rows.push(Row::at_most(what, apart / size, 1e-6).second_formulation());
                    for balances in [one.1, other.1] {
                        rows.push(balances.row(&name));
                    }
                    break;
                }
            }
        }
        Ok(rows)
    },
};
