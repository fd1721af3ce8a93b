//! Iterations instead of a factor.
//!
//! Problem: a block of n hexahedra along each side falls on a rigid plane at 5 m/s and slides along it, at small strain (E = 1e9 Pa, ν = 0.3, ρ =
//! 1000 kg/m³) and at finite strain (neo-Hooke). Theta ½ with the velocity
//! law, Newmark with the displacement law; Courant number 0.5 and 2. Each run is made with a factor and with conjugate gradients. Closed facts: the
//! equations are the same, so are motion, forces and statuses; no factor and no column is computed; iterations of a solve do not grow with the mesh at a
//! given Courant number, as the mass bounds the condition number of M + Δt² K/4 by about 1 + 12 (c Δt/h)². Tolerances: motion and forces 1e-9 of the
//! largest, as iterations end at 1e-12 of the load and the errors of some hundred steps add up; 1e-8 at finite strain, where steps end at 1e-10 of the
//! forces, and with the displacement law, whose force is an error of the gap over β Δt²; with this law its first 12 steps are compared, as Newmark's scheme
//! chatters with it, and any difference of two runs grows by a fifth in each step. Balances as with a factor.
//! Sizes: quick n = 6, full n = 12.

use carom_bodies::Kinematics;
use carom_contact::Law;
use carom_dynamics::{Driver, Model, Scheme, Solver};
use carom_materials::{Elastic, Plane};
use carom_mesh::generate;

use crate::Error;
use crate::build::{DISPLACEMENT, HALF, body, contact, neo_hooke, newmark, plane, surface, theta};
use crate::check::{Check, Row, Size};

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e9,
    poisson: 0.3,
};
const SPEED: f64 = 5.0;

/// What differs between runs.
#[derive(Clone, Copy)]
struct Fall {
    name: &'static str,
    finite: bool,
    scheme: fn() -> Scheme,
    law: Law,
    courant: f64,
    same: f64,
    /// Steps; three passages of a wave through the block unless given.
    steps: Option<u32>,
}

const FALLS: [Fall; 4] = [
    Fall {
        name: "theta ½",
        finite: false,
        scheme: || theta(0.5),
        law: HALF,
        courant: 0.5,
        same: 1e-9,
        steps: None,
    },
    Fall {
        name: "theta ½, Courant number 2",
        finite: false,
        scheme: || theta(0.5),
        law: HALF,
        courant: 2.0,
        same: 1e-9,
        steps: None,
    },
    Fall {
        name: "Newmark, displacement law",
        finite: false,
        scheme: || newmark(0.3025, 0.6),
        law: DISPLACEMENT,
        courant: 0.5,
        same: 1e-8,
        steps: Some(12),
    },
    Fall {
        name: "neo-Hooke",
        finite: true,
        scheme: || theta(0.5),
        law: HALF,
        courant: 0.5,
        same: 1e-8,
        steps: None,
    },
];

fn driver(n: usize, fall: &Fall, solver: Solver) -> Result<Driver, Error> {
    let mesh = generate::box_("block", [0.0; 3], [1.0; 3], [n; 3], false);
    let mut block = match fall.finite {
        true => neo_hooke(&mesh, "block", Kinematics::Solid, RUBBER)?,
        false => body(&mesh, "block", Kinematics::Solid, RUBBER)?,
    };
    block.velocity = [0.5, 0.2, -SPEED];
    let bottom = surface(&mesh, "block.bottom", &block)?;
    let step = fall.courant / n as f64 / RUBBER.wave_speed(Plane::Full);
    let mut model = Model {
        contacts: vec![contact(bottom, plane(2, 1.0), fall.law)],
        ..Model::new(vec![block], mesh, (fall.scheme)(), step)
    };
    model.nonlinear.iteration.solver = solver;
    Ok(Driver::new(crate::witness::system(model)?)?)
}

/// Rows of one fall, and the products with the matrix in a step.
fn compare(n: usize, fall: &Fall) -> Result<(Vec<Row>, f64), Error> {
    let [mut direct, mut iterated] = [
        driver(n, fall, Solver::Direct)?,
        driver(n, fall, Solver::Iterative)?,
    ];
    let steps = fall
        .steps
        .unwrap_or((3.0 * n as f64 / fall.courant).ceil() as u32);
    let (mut force, mut largest, mut statuses, mut closed) = (0.0_f64, 0.0_f64, 0, 0);
    for _ in 0..steps {
        direct.step()?;
        iterated.step()?;
        let [one, other] = [&direct, &iterated].map(|driver| &driver.state().interface);
        for (a, b) in one.force.iter().zip(&other.force) {
            force = force.max((a - b).abs());
            largest = largest.max(*a);
        }
        let differ = one.status.iter().zip(&other.status);
        statuses += differ.filter(|(a, b)| a != b).count();
        closed = closed.max(one.force.iter().filter(|force| **force > 0.0).count());
    }
    let [one, other] = [&direct, &iterated].map(|driver| &driver.state().motion);
    let most = |a: &[f64], b: &[f64]| {
        let difference = a
            .iter()
            .zip(b)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        difference / a.iter().map(|a| a.abs()).fold(0.0, f64::max)
    };
    let ledger = &iterated.state().ledger;
    let energy = ledger.largest_energy_residual / ledger.initial.energy();
    let momentum = ledger.largest_momentum_residual / ledger.largest_momentum;
    let work = iterated.costs().work;
    let row = |what: &str| format!("{}: {what}", fall.name);
    let rows = vec![
        Row::at_most(
            row("displacement, difference"),
            most(&one.u, &other.u),
            fall.same,
        ),
        Row::at_most(
            row("velocity, difference"),
            most(&one.v, &other.v),
            fall.same,
        ),
        Row::at_most(
            row("largest difference of a force"),
            force / largest,
            fall.same,
        ),
        Row::count(row("statuses that differ"), statuses, 0),
        Row::at_least(
            row("most points with a force"),
            closed as f64,
            (n * n) as f64,
        ),
        Row::count(row("factors"), work.factorisations, 0),
        Row::count(row("sweeps"), work.sweeps, 0),
        Row::at_most(row("energy residual / E0"), energy, 1e-9),
        Row::at_most(row("momentum residual / largest"), momentum, 1e-9),
    ];
    Ok((rows, work.products as f64 / f64::from(steps)))
}

pub(crate) const CHECK: Check = Check {
    name: "iterative-solver",
    fact: "conjugate gradients give the motion and the forces of a factor",
    run: |size| {
        let n = match size {
            Size::Quick => 6,
            Size::Full => 12,
        };
        let mut rows = Vec::new();
        for fall in &FALLS {
            rows.extend(compare(n, fall)?.0);
        }
        // with the square root of the condition number they would double
        let [(_, coarse), (_, fine)] = [compare(n / 2, &FALLS[0])?, compare(n, &FALLS[0])?];
        let growth = fine / coarse;
        rows.push(Row::at_most("products a step, twice as fine", growth, 1.5));
        Ok(rows)
    },
};
