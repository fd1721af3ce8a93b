//! An elastic block dropped on a rigid plane.
//!
//! Problem: a cube of 1 m, E = 1e9 Pa, ν = 0.3, ρ = 1000 kg/m³, n hexahedra along each side, lumped mass, hits the plane
//! z = 0 squarely at 5 m/s, in touch at the start, all other faces free; CFL 0.5 with the wave speed of the bulk, for
//! three times the way of a wave through the cube and back. Closed solution: none for the motion; facts of the method
//! instead: each effective matrix is factored once, a step with the velocity law costs two sweeps, a row that does not
//! change has its column computed once, energy and momentum are what the schemes' identities say, the plane is not
//! passed by more than the law's bound, the block leaves, and under theta it gains no energy and leaves with less
//! speed than it came with, since vibration keeps some (the trapezoid with the displacement law throws it faster). Reference: carom_exact::closed_forms for the bound. Tolerance: counts exactly;
//! balances 1e-9 of the initial energy and momentum, as the issue states (round-off gives 1e-13).
//! Sizes: quick n = 8, full n = 16; n = 32 is a benchmark.

use carom_bodies::Kinematics;
use carom_contact::Law;
use carom_contact::law::Adhesion;
use carom_dynamics::{Driver, Model, Scheme, Solver, march};
use carom_exact::closed_forms::{penetration_bound_half, penetration_bound_now};
use carom_materials::{Elastic, Plane};
use carom_mesh::generate;

use crate::Error;
use crate::build::{
    DISPLACEMENT, HALF, NOW, PAPER_SETS, body, contact, damped, newmark, plane, surface, theta,
};
use crate::check::{Check, Row, Size};

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e9,
    poisson: 0.3,
};
const SIDE: f64 = 1.0;
const SPEED: f64 = 5.0;
const BALANCE: f64 = 1e-9;

fn model(n: usize, scheme: Scheme, law: Law) -> Result<Model, Error> {
    let mesh = generate::box_("block", [0.0; 3], [SIDE; 3], [n; 3], false);
    let mut block = body(&mesh, "block", Kinematics::Solid, RUBBER)?;
    block.velocity = [0.0, 0.0, -SPEED];
    let bottom = surface(&mesh, "block.bottom", &block)?;
    let dt = 0.5 * SIDE / n as f64 / RUBBER.wave_speed(Plane::Full);
    let mut model = Model {
        contacts: vec![contact(bottom, plane(2, 1.0), law)],
        ..Model::new(vec![block], mesh, scheme, dt)
    };
    model.nonlinear.iteration.solver = Solver::Direct;
    Ok(model)
}

/// The block after its impact.
fn drop(n: usize, scheme: Scheme, law: Law) -> Result<Driver, Error> {
    let mut driver = Driver::new(crate::witness::system(model(n, scheme, law)?)?)?;
    let end = 6.0 * SIDE / RUBBER.wave_speed(Plane::Full);
    march(&mut driver, end, &mut [], &|| false)?;
    Ok(driver)
}

/// Facts of every scheme and law.
fn common(name: &str, driver: &Driver) -> Vec<Row> {
    let state = driver.state();
    let (ledger, row) = (&state.ledger, |what: &str| format!("{name}: {what}"));
    let energy = ledger.largest_energy_residual / ledger.initial.energy();
    let momentum = ledger.largest_momentum_residual / ledger.largest_momentum;
    let velocity = driver.system().mean_velocity(0, &state.motion.v)[2];
    let factor = &driver.costs().factors;
    let factorisations = factor.iter().map(|stats| stats.factorisations).sum();
    vec![
        Row::at_most(row("energy residual / E0"), energy, BALANCE),
        Row::at_most(row("momentum residual / largest"), momentum, BALANCE),
        Row::count(row("factorisations"), factorisations, 1),
        Row::at_least(row("mean velocity at the end / v0"), velocity / SPEED, 0.0),
    ]
}

/// Facts of the velocity law under theta.
fn velocity_law(name: &str, driver: &Driver, value: f64, law: Law) -> Vec<Row> {
    let (state, dt, row) = (driver.state(), driver.system().dt, |what: &str| {
        format!("{name}: {what}")
    });
    let ledger = &state.ledger;
    let costs = driver.costs();
    let sweeps = costs.work.sweeps;
    let bound = match law == HALF {
        true => penetration_bound_half(value, SPEED, dt),
        false => penetration_bound_now(value, SPEED, dt),
    };
    let record = &state.records.contacts[0];
    let velocity = driver.system().mean_velocity(0, &state.motion.v)[2];
    let gained = ledger.largest_energy / ledger.initial.energy() - 1.0;
    vec![
        Row::count(
            row("sweeps per 1000 steps"),
            1000 * sweeps / state.step as usize,
            2000,
        ),
        Row::count(
            row("columns computed"),
            costs.work.columns,
            driver.system().points(),
        ),
        Row::at_most(row("mean velocity at the end / v0"), velocity / SPEED, 1.0),
        Row::at_most(row("penetration, m"), record.penetration, bound),
        Row::at_most(row("largest energy / E0 - 1"), gained, BALANCE),
        Row::at_most(
            row("persistency defect / E0"),
            record.persistency_defect() / ledger.initial.energy(),
            1e-12,
        ),
    ]
}

pub(crate) const CHECK: Check = Check {
    name: "block-drop",
    fact: "a block on a rigid plane is factored once and its balances close",
    run: |size| {
        let n = match size {
            Size::Quick => 8,
            Size::Full => 16,
        };
        let mut rows = Vec::new();
        for (value, law) in [(0.5, HALF), (0.75, NOW)] {
            let name = format!("theta {value}, velocity law");
            let driver = drop(n, theta(value), law)?;
            rows.extend(common(&name, &driver));
            rows.extend(velocity_law(&name, &driver, value, law));
        }
        let clip = damped(&RUBBER, SIDE / n as f64, 0.5, Adhesion::Clip);
        let printed = damped(&RUBBER, SIDE / n as f64, 0.5, Adhesion::AsPrinted);
        for [beta, gamma] in PAPER_SETS {
            for (law_name, law) in [
                ("displacement law", DISPLACEMENT),
                ("damped law, clip", clip),
                ("damped law, as printed", printed),
            ] {
                let driver = drop(n, newmark(beta, gamma), law)?;
                rows.extend(common(
                    &format!("Newmark ({beta}, {gamma}), {law_name}"),
                    &driver,
                ));
            }
        }
        Ok(rows)
    },
};
