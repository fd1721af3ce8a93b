//! Order of convergence of the schemes with finite strain.
//!
//! Problem: a free strip of 1 m x 0.25 m in plane strain, 4 x 1 elements, E = 1 MPa, ν = 0.3, ρ = 1000 kg/m³, starts with velocities that
//! turn, stretch and bend it, up to 20 m/s and a turn of half a radian, for 20 ms, most of a period of its bending; neo-Hooke, and viscoelastic
//! with a relaxation of 10 ms; a traction on one end grows evenly to 20 kPa. Closed solution: the error of a step of size dt is C dt^p with the order p that the scheme states.
//! Reference: runs with halved steps, u and v / ω at the end in the Euclidean norm, ω = 100/s. Tolerance: 0.05 of the order between 160, 320 and 640 steps,
//! where terms of the next order are of ω dt = 0.03 for the fastest mode, and halve.

use carom_bodies::Kinematics;
use carom_dynamics::{Amplitude, Driver, Load, LoadKind, Model, Scheme};
use carom_materials::{Branch, Law as Material, Maxwell, NeoHooke};
use carom_mesh::generate;

use crate::Error;
use crate::build::{body, surface};
use crate::check::{Check, Row};
use crate::features::{label, schemes};
use crate::hairpin::RUBBER;

/// End of the runs, s.
const END: f64 = 0.02;
/// Rate by which velocities are divided, 1/s.
const RATE: f64 = 100.0;

/// Displacement and velocity over [`RATE`] at the end, after so many steps.
fn end(scheme: Scheme, material: Material, steps: u64) -> Result<Vec<f64>, Error> {
    let mesh = generate::rectangle("strip", [0.0; 2], [1.0, 0.25], [4, 1], false);
    let kinematics = Kinematics::PlaneStrain { thickness: 1.0 };
    let mut strip = body(&mesh, "strip", kinematics, RUBBER)?;
    strip.spec.material = material;
    let loaded = surface(&mesh, "strip.right", &strip)?;
    let mut model = Model::new(vec![strip], mesh, scheme, END / steps as f64);
    model.nonlinear.loads = vec![Load {
        name: "pull".to_string(),
        surface: loaded,
        kind: LoadKind::Traction([0.0, 2e4, 0.0]),
        amplitude: Amplitude::new(vec![[0.0, 0.0], [END, 1.0]])?,
    }];
    model.nonlinear.iteration.tolerance = 1e-12;
    let system = crate::witness::system(model)?;
    let velocity: Vec<f64> = system
        .x
        .iter()
        .flat_map(|x| {
            let (x, y) = (x[0] - 0.5, x[1] - 0.125);
            [10.0 * x * x - 20.0 * y + 6.0 * x, 20.0 * x + 10.0 * x * y]
        })
        .collect();
    let mut driver = Driver::new(system)?;
    driver.restart(&vec![0.0; velocity.len()], &velocity)?;
    for _ in 0..steps {
        driver.step()?;
    }
    let motion = &driver.state().motion;
    let velocities = motion.v.iter().map(|v| v / RATE);
    Ok(motion.u.iter().copied().chain(velocities).collect())
}

fn distance(one: &[f64], other: &[f64]) -> f64 {
    let squares = one.iter().zip(other).map(|(a, b)| (a - b).powi(2));
    squares.sum::<f64>().sqrt()
}

pub(crate) const CHECK: Check = Check {
    name: "order-features",
    fact: "every scheme converges in the step with the order that it states at finite strain too",
    run: |_| {
        let branch = Branch {
            ratio: 0.3,
            time: 0.01,
        };
        let materials = [
            (
                "neo-Hooke",
                Material::NeoHooke(NeoHooke { initial: RUBBER }),
            ),
            (
                "viscoelastic",
                Material::Maxwell(Maxwell {
                    initial: RUBBER,
                    branches: [Some(branch), None, None, None],
                }),
            ),
        ];
        let mut rows = Vec::new();
        for scheme in schemes() {
            for (name, material) in materials {
                if scheme.get().is_between() && material.dissipates() {
                    continue; // refused
                }
                let [coarse, middle, fine] = [160, 320, 640].map(|n| end(scheme, material, n));
                let (coarse, middle, fine) = (coarse?, middle?, fine?);
                let order = (distance(&coarse, &middle) / distance(&middle, &fine)).log2();
                rows.push(Row::near(
                    format!("{}, {name}: order", label(scheme)),
                    order,
                    f64::from(scheme.get().order()),
                    0.05,
                ));
            }
        }
        Ok(rows)
    },
};
