//! Surfaces that are tied to each other, whose nodes do not match.
//!
//! Problem: a bar of two blocks of hexahedra, of 2 x 2 and of 3 x 3 over the section, tied where they meet (mortar rows, as `[transition]` with
//! `surfaces` has them); Poisson's ratio zero, lumped mass.
//!
//! *A plane wave.* Velocities that depend on x alone are given to both. Fact: the row of planes of nodes that each block is moves as
//! one mesh over the whole length does. Lumped masses and nodal forces of a plane are shares of the same areas, a uniform traction on one side of the
//! tie gives shares of areas on both (∫ φ_A dΓ, and Σ_A ∫ φ_A N_B dΓ = ∫ N_B dΓ), and so there is nothing that a mesh over the section could see.
//! Tolerance: rounding, 1e-11 of the largest displacement after some hundred steps of sums over some hundred rows. For explicit and implicit steps,
//! small and finite strain.
//!
//! *A spin.* The same bar flies, turns and vibrates at finite strain, in explicit steps. Fact: rows over flat surfaces keep linear fields,
//! Σ c x = 0, so that they hold in every rotation, and their forces have no resultant and no moment: energy, momentum and angular momentum balance to rounding,
//! 1e-11 of the largest over some thousand steps. Central differences keep the angular momentum itself.

use std::sync::Arc;

use carom_bodies::{BodySpec, Kinematics};
use carom_dynamics::{Driver, Model, ModelBody, ModelConstraint, Scheme, System};
use carom_materials::{Elastic, Law, Plane, StVenantKirchhoff};
use carom_mesh::{Mesh, Surface, generate};
use carom_zones::mortar_rows;

use crate::Error;
use crate::build::{CENTRAL, group, newmark, theta};
use crate::check::{Check, Row, Size};

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e7,
    poisson: 0.0,
};
/// Elements along each block of 1 m.
const ALONG: usize = 8;
/// Height and width of the bar, m.
const SIDE: f64 = 0.4;
/// Part of the time in which a wave crosses an element that a step takes.
const COURANT: f64 = 0.3;

fn block(name: &str, from: f64, length: usize, across: usize) -> Mesh {
    let size = [length as f64, SIDE, SIDE];
    let elements = [ALONG * length, across, across];
    generate::box_(name, [from, 0.0, 0.0], size, elements, false)
}

/// The bar of two blocks, or of one mesh.
fn bar(tied: bool, law: Law, scheme: Scheme) -> Result<Arc<System>, Error> {
    let mut mesh = block("one", 0.0, if tied { 1 } else { 2 }, 2);
    let mut names = vec!["one"];
    if tied {
        mesh.merge("two", block("two", 1.0, 1, 3))?;
        names.push("two");
    }
    let mut bodies = Vec::new();
    for name in names {
        let cells = group(&mesh, name)?.elements.clone();
        bodies.push(ModelBody::new(BodySpec::new(
            name,
            cells,
            Kinematics::Solid,
            law,
        )));
    }
    let mut constraints = Vec::new();
    if tied {
        let cells: Vec<_> = bodies
            .iter()
            .flat_map(|body| &body.spec.cells)
            .copied()
            .collect();
        let surface = |name: &str| -> Result<Surface, Error> {
            Ok(Surface::new(&mesh, group(&mesh, name)?, &cells)?)
        };
        let rows = mortar_rows(&mesh, &surface("one.right")?, &surface("two.left")?, |_| {
            1.0
        });
        constraints.push(ModelConstraint::of_rows("tie", &rows.rows, mesh.dim));
    }
    let dt = COURANT / ALONG as f64 / RUBBER.wave_speed(Plane::Uniaxial);
    Ok(crate::witness::system(Model {
        constraints,
        ..Model::new(bodies, mesh, scheme, dt)
    })?)
}

/// A driver that begins with velocities by place.
fn started(system: Arc<System>, velocity: impl Fn(&[f64; 3]) -> [f64; 3]) -> Result<Driver, Error> {
    let velocities: Vec<f64> = system.x.iter().flat_map(velocity).collect();
    let mut driver = Driver::new(system)?;
    driver.restart(&vec![0.0; velocities.len()], &velocities)?;
    Ok(driver)
}

/// The largest difference of the displacements of two bars at the same x, over the largest displacement.
fn wave(law: Law, scheme: Scheme, steps: usize) -> Result<f64, Error> {
    let pulse = |x: &[f64; 3]| [(-((x[0] - 0.5) / 0.15).powi(2)).exp(), 0.0, 0.0];
    let mut planes = [0.0; 2 * ALONG + 1];
    let (mut difference, mut largest) = (0.0_f64, 0.0_f64);
    for tied in [false, true] {
        let mut driver = started(bar(tied, law, scheme)?, pulse)?;
        for _ in 0..steps {
            driver.step()?;
        }
        let u = driver.state().motion.u.chunks_exact(3);
        for (x, u) in driver.system().x.iter().zip(u) {
            let plane = &mut planes[(x[0] * ALONG as f64).round() as usize];
            match tied {
                false => *plane = u[0],
                true => difference = difference.max((u[0] - *plane).abs()),
            }
            largest = largest.max(u[0].abs());
            difference = difference.max(u[1].abs()).max(u[2].abs());
        }
    }
    Ok(difference / largest)
}

fn spin(steps: usize) -> Result<Vec<Row>, Error> {
    let law = Law::StVenantKirchhoff(StVenantKirchhoff { initial: RUBBER });
    let turning = |x: &[f64; 3]| {
        let shake = (4.0 * x[0]).sin();
        [1.0 - 20.0 * (x[1] - 0.2), 20.0 * (x[0] - 1.0) + 0.5, shake]
    };
    let mut driver = started(bar(true, law, CENTRAL)?, turning)?;
    for _ in 0..steps {
        driver.step()?;
    }
    let ledger = &driver.state().ledger;
    let row = |what: &str, residual: f64, size: f64| {
        Row::at_most(format!("spin: residual of {what}"), residual / size, 1e-11)
    };
    let angular = ledger.largest_angular_momentum;
    let difference = (0..3)
        .map(|i| (ledger.balance.momentum.angular[i] - ledger.initial.momentum.angular[i]).abs());
    let turns = 20.0 * driver.state().time / std::f64::consts::TAU;
    Ok(vec![
        Row::at_least("spin: turns, about", turns, 0.5),
        row(
            "energy",
            ledger.largest_energy_residual,
            ledger.largest_energy,
        ),
        row(
            "momentum",
            ledger.largest_momentum_residual,
            ledger.largest_momentum,
        ),
        row("angular momentum", ledger.largest_angular_residual, angular),
        row(
            "the angular momentum kept",
            difference.fold(0.0, f64::max),
            angular,
        ),
    ])
}

pub(crate) const CHECK: Check = Check {
    name: "tied-surfaces",
    fact: "surfaces tied by mortar rows, whose nodes do not match, let a plane wave pass as one mesh does, and keep momenta",
    run: |size| {
        let small = Law::Elastic(RUBBER);
        let finite = Law::StVenantKirchhoff(StVenantKirchhoff { initial: RUBBER });
        let runs = [
            ("central differences, small strain", small, CENTRAL),
            ("central differences, finite strain", finite, CENTRAL),
            ("trapezoidal rule, small strain", small, newmark(0.25, 0.5)),
            ("theta, small strain", small, theta(0.6)),
        ];
        let mut rows = Vec::new();
        for (name, law, scheme) in runs {
            let difference = wave(law, scheme, 100)?;
            let what = format!("plane wave, {name}: difference from one mesh");
            rows.push(Row::at_most(what, difference, 1e-11));
        }
        rows.extend(spin(match size {
            Size::Quick => 500,
            Size::Full => 5000,
        })?);
        Ok(rows)
    },
};
