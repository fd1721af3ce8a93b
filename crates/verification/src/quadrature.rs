//! The weak form of the exact laws: a multiplier at the nodes, a sign at each Gauss point.
//!
//! Problem 1: a square block of 1 m, E = 1e9 Pa, ν = 0.3, ρ = 1000 kg/m³, plane strain of 1 m, n x n quadrilaterals, comes
//! down at 5 m/s on a rigid plane that rises by 1 % to one side, in touch with one corner: the contact runs along the
//! edge at 500 m/s while waves run at 1160 m/s and more. CFL 0.5, for twice the way of a wave through the block.
//! Theta = 1/2 with the velocity law, Newmark (0.49, 0.9) with the displacement law; r as the case file has it by default,
//! ρ c and E/h, a tenth and ten times of it; collocation at the nodes for comparison. Closed solution: none; facts of the
//! method instead. Nodes between the closed and the open part have mixed supports: there p depends on r. The front covers a
//! part h of the edge, so the relative L² difference of the force histories is O(h): four times the elements must at least
//! halve it, a quarter being that of first order. The differences over h are shown.
//! Problem 2: the blocks of `blocks`, with meshes that do not match, paired anew at each step: momentum stays, forces and
//! work balance. Tolerance: 1e-11 of the initial energy, 1e-12 of the momentum, round-off.
//! Sizes: quick n = 8 and 32, full n = 16 and 64 and three times the elements in the blocks.

use carom_bodies::Kinematics;
use carom_contact::{Integration, Law, Plane as Wall, Sliding};
use carom_dynamics::{Driver, Model, ModelTarget, Scheme};
use carom_materials::Plane;
use carom_mesh::generate;

use crate::Error;
use crate::blocks::{Blocks, RUBBER, SMALLEST};
use crate::build::{DISPLACEMENT, HALF, body, contact, newmark, surface, theta};
use crate::check::{Check, Row, Size};

const SPEED: f64 = 5.0;
const SLOPE: f64 = 1e-2;

/// A scheme and a law for it.
#[derive(Clone, Copy)]
struct Choice {
    scheme: Scheme,
    law: Law,
}

fn choices() -> [(&'static str, Choice); 2] {
    let velocity = Choice {
        scheme: theta(0.5),
        law: HALF,
    };
    let displacement = Choice {
        scheme: newmark(0.49, 0.9),
        law: DISPLACEMENT,
    };
    [
        ("theta 0.5, velocity law", velocity),
        ("Newmark (0.49, 0.9), displacement law", displacement),
    ]
}

impl Choice {
    /// The weak form with `part` of the default r. `size`: of an element, m.
    fn weak(&self, part: f64, size: f64) -> Integration {
        let r = match self.law {
            HALF => RUBBER.density * RUBBER.wave_speed(Plane::Full),
            _ => RUBBER.young / size,
        };
        Integration::Weak { r: part * r }
    }
}

fn tilted(n: usize, choice: Choice, integration: Integration) -> Result<Model, Error> {
    let mesh = generate::rectangle("block", [0.0; 2], [1.0; 2], [n; 2], false);
    let kinematics = Kinematics::PlaneStrain { thickness: 1.0 };
    let mut block = body(&mesh, "block", kinematics, RUBBER)?;
    block.velocity = [0.0, -SPEED, 0.0];
    let bottom = surface(&mesh, "block.bottom", &block)?;
    let along = 1.0 / SLOPE.hypot(1.0);
    let wall = ModelTarget::rigid(Wall {
        point: [0.0; 3],
        normal: [SLOPE * along, along, 0.0],
    });
    let mut shock = contact(bottom, wall, choice.law);
    shock.integration = integration;
    Ok(Model {
        contacts: vec![shock],
        ..Model::new(
            vec![block],
            mesh,
            choice.scheme,
            0.5 / n as f64 / RUBBER.wave_speed(Plane::Full),
        )
    })
}

/// The contact force of each step in N, and the block after it.
fn history(
    n: usize,
    choice: Choice,
    integration: Integration,
) -> Result<(Vec<f64>, Driver), Error> {
    let mut driver = Driver::new(crate::witness::system(tilted(n, choice, integration)?)?)?;
    let mut forces = Vec::new();
    for _ in 0..4 * n {
        driver.step()?;
        forces.push(driver.report().contacts[0].force);
    }
    Ok((forces, driver))
}

/// Relative L² distance of two histories.
fn distance(one: &[f64], other: &[f64]) -> f64 {
    let squares = one.iter().zip(other).map(|(a, b)| (a - b).powi(2));
    let size: f64 = one.iter().map(|a| a * a).sum();
    (squares.sum::<f64>() / size).sqrt()
}

fn on_the_slope(name: &str, choice: Choice, sizes: [usize; 2]) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    let mut by_size = Vec::new();
    for n in sizes {
        let size = 1.0 / n as f64;
        let row = |what: &str| format!("{name}, n = {n}: {what}");
        let (forces, driver) = history(n, choice, choice.weak(1.0, size))?;
        let compared = [
            ("a tenth of r", choice.weak(0.1, size)),
            ("ten times r", choice.weak(10.0, size)),
            ("nodes", Integration::Node),
        ];
        let mut distances = [0.0; 3];
        for (distance_of, (what, integration)) in distances.iter_mut().zip(compared) {
            *distance_of = distance(&forces, &history(n, choice, integration)?.0);
            let what = format!("force with {what}, difference / h");
            rows.push(Row::shown(row(&what), *distance_of / size));
        }
        by_size.push(distances);
        let (ledger, record) = (&driver.state().ledger, &driver.state().records.contacts[0]);
        let energy = ledger.largest_energy_residual / ledger.initial.energy();
        let momentum = ledger.largest_momentum_residual / ledger.largest_momentum;
        rows.extend([
            Row::at_least(row("nodes with mixed supports"), record.mixed as f64, 1.0),
            Row::at_most(row("energy residual / E0"), energy, 1e-11),
            Row::at_most(row("momentum residual / largest"), momentum, 1e-11),
        ]);
    }
    for (k, what) in ["a tenth of r", "ten times r", "nodes"]
        .into_iter()
        .enumerate()
    {
        let quantity = format!("{name}: difference with {what}, fine over coarse");
        rows.push(Row::at_most(quantity, by_size[1][k] / by_size[0][k], 0.5).second_formulation());
    }
    Ok(rows)
}

fn between_blocks(name: &str, choice: Choice, blocks: Blocks) -> Result<Vec<Row>, Error> {
    let mut model = blocks.model(choice.scheme, choice.law, Sliding::Finite)?;
    model.contacts[0].integration = choice.weak(1.0, 0.2);
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let end = 2.4 / RUBBER.wave_speed(Plane::Full);
    while driver.state().time < end {
        driver.step()?;
    }
    let (ledger, record) = (&driver.state().ledger, &driver.state().records.contacts[0]);
    let (start, now) = (&ledger.initial, &ledger.balance);
    let change = (0..3)
        .map(|i| (now.momentum.linear[i] - start.momentum.linear[i]).abs())
        .fold(0.0, f64::max);
    let momentum = ledger.largest_momentum;
    let energy = ledger.largest_energy_residual / start.energy();
    let row = |what: &str| format!("{name}: {what}");
    Ok(vec![
        Row::at_least(row("impulse / momentum"), record.impulse() / momentum, 0.5),
        Row::at_most(
            row("change of momentum / largest"),
            change / momentum,
            1e-12,
        ),
        Row::at_most(row("energy residual / E0"), energy, 1e-11),
        Row::at_most(
            row("largest energy / E0 - 1"),
            ledger.largest_energy / start.energy() - 1.0,
            1e-11,
        ),
    ])
}

pub(crate) const CHECK: Check = Check {
    name: "quadrature",
    fact: "the weak form depends on r only where signs differ within a support, less and less with smaller elements",
    run: |size| {
        let (sizes, refinement) = match size {
            Size::Quick => ([8, 32], 1),
            Size::Full => ([16, 64], 3),
        };
        let mut rows = Vec::new();
        for (name, choice) in choices() {
            rows.extend(on_the_slope(name, choice, sizes)?);
            for (elements, simplices) in [
                ("hexahedra", [false, false]),
                ("tetrahedra above", [true, false]),
            ] {
                let blocks = Blocks {
                    elements: SMALLEST.elements.map(|n| n.map(|n| n * refinement)),
                    simplices,
                    ..SMALLEST
                };
                let name = format!("{name}, blocks of {elements}");
                rows.extend(between_blocks(&name, choice, blocks)?);
            }
        }
        Ok(rows)
    },
};
