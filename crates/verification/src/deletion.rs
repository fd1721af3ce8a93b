//! Cells that are deleted where their metal has flowed too far.
//!
//! Problem 1: a cube held on one side and across is pulled by its other side, which flies at 200 m/s; it is deleted in the step in which its
//! plastic strain passes 1 %. Closed solution, with x = ln λ of that instant: ε_p = (2μx - σ_y)/(3μ + H), q = 2μx - 3μ ε_p, and the
//! energy that leaves the balance is V (κx²/2 + q²/6μ + H ε_p²/2). From then on its nodes fly on with their momentum.
//! Tolerance: all is exact but for rounding, of some hundred operations in each of a hundred steps: 1e-12.
//!
//! Problem 2: a bar of five cubes whose halves fly apart; the one between, which is softer, is deleted. Closed solution: linear and angular
//! momentum of the whole are kept; from the next step on each half keeps its own momentum, and the energies balance. Tolerance: 1e-12,
//! as above.
//!
//! Problem 3: a bar of four cubes hits a wall with one end; cells are deleted, and the nodes inside that they leave behind meet the wall in
//! their place. Fact: all 20 nodes are points of the contact, and none passes the wall. Tolerance: a law in the gap rate holds a node where
//! the step of its closing ends, at most the way of a step behind the wall.
//!
//! Problem 4: a hard hammer flies at 200 m/s against a column of four cubes. The nodes of three of them are held; the fourth
//! is deleted under the blow. The hammer then flies on with its momentum and hits the face behind it, which was inside the
//! column. Facts: after the step behind the deletion it keeps its momentum until the contact closes again; it closes at the
//! bare face, within the way of a step before and behind it (the law looks half a step ahead); momentum and energy balance; a run that
//! is resumed from the bytes of the flight meets the same face, with the same bytes.
//! Tolerance: rounding, as above.
//!
//! Problem 5: the same, with the end of the column and the front of the hammer as one surface that faces itself. The same facts.

use std::sync::Arc;

use carom_bodies::{BodySpec, Formulation, Kinematics};
use carom_dynamics::{Driver, Model, ModelBody, ModelTarget, State, Stepper};
use carom_materials::{Elastic, J2Plasticity, Law, Plane};
use carom_mesh::{Mesh, Surface, generate};

use crate::Error;
use crate::build::{CENTRAL, HALF, contact, group, plane, support};
use crate::check::{Check, Row};

const STEEL: J2Plasticity = J2Plasticity {
    initial: Elastic {
        density: 7800.0,
        young: 200e9,
        poisson: 0.3,
    },
    yield_stress: 400e6,
    hardening: 1e9,
};
const EDGE: f64 = 0.1;
const SPEED: f64 = 200.0;
const LIMIT: f64 = 0.01;
/// A thousandth of the way of a wave through a cube: the step in which the limit is passed is a small one.
const STEP: f64 = 1.7e-8;
/// Bound of what only rounding leaves.
const ROUNDING: f64 = 1e-12;

fn bar(cells: usize) -> Mesh {
    let size = [EDGE * cells as f64, EDGE, EDGE];
    generate::box_("bar", [0.0; 3], size, [cells, 1, 1], false)
}

/// Some cells of the bar, all of one formulation.
fn part(
    mesh: &Mesh,
    name: &str,
    formulation: Formulation,
    has: impl Fn(f64) -> bool,
) -> Result<BodySpec, Error> {
    let middle = |cell: &carom_mesh::ElementId| {
        let nodes = mesh.element_nodes(*cell).iter();
        nodes.map(|&node| mesh.nodes[node as usize][0]).sum::<f64>() / 8.0
    };
    let cells = group(mesh, "bar")?.elements.iter().copied();
    let cells = cells.filter(|cell| has(middle(cell) / EDGE)).collect();
    Ok(BodySpec {
        formulation,
        ..BodySpec::new(name, cells, Kinematics::Solid, Law::J2Plasticity(STEEL))
    })
}

/// Steps until an element is deleted; at most this many.
fn until_deleted(driver: &mut Driver, most: usize) -> Result<(), Error> {
    for _ in 0..most {
        driver.step()?;
        if driver.state().ledger.deleted > 0 {
            break;
        }
    }
    Ok(())
}

/// Problem 1.
fn pulled(name: &str, formulation: Formulation) -> Result<Vec<Row>, Error> {
    let mesh = bar(1);
    let spec = BodySpec {
        deletion: Some(LIMIT),
        ..part(&mesh, "bar", formulation, |_| true)?
    };
    let body = ModelBody {
        velocity: [SPEED, 0.0, 0.0],
        ..ModelBody::new(spec)
    };
    let supports = vec![
        support(&mesh, "bar.left", [true, true, true])?,
        support(&mesh, "bar", [false, true, true])?,
    ];
    let right = mesh.group_nodes(group(&mesh, "bar.right")?)[0];
    let model = Model {
        supports,
        ..Model::new(vec![body], mesh, CENTRAL, STEP)
    };
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let unknown = 3 * driver.system().number[right as usize] as usize;
    until_deleted(&mut driver, 10_000)?;
    let ledger = &driver.state().ledger;
    let x = (1.0 + driver.state().motion.u[unknown] / EDGE).ln();
    let (shear, bulk) = (
        STEEL.initial.shear_modulus(),
        STEEL.initial.lame_1(Plane::Full) + STEEL.initial.shear_modulus() / 1.5,
    );
    let plastic = (2.0 * shear * x - STEEL.yield_stress) / (3.0 * shear + STEEL.hardening);
    let q = 2.0 * shear * x - 3.0 * shear * plastic;
    let density =
        0.5 * bulk * x * x + q * q / (6.0 * shear) + 0.5 * STEEL.hardening * plastic * plastic;
    let energy = density * EDGE.powi(3);
    let row = |what: &str| format!("{name}: {what}");
    let mut rows = vec![
        Row::relative(
            row("energy of the deleted cell, J"),
            ledger.balance.dissipation_deletion,
            energy,
            ROUNDING,
        ),
        Row::at_least(row("plastic strain, closed form"), plastic, LIMIT),
        Row::near(
            row("strain energy that is left, relative"),
            (ledger.balance.strain + ledger.balance.hardening) / energy,
            0.0,
            ROUNDING,
        ),
    ];
    // the force of the last step acts for half of the next one
    driver.step()?;
    let speed = driver.state().motion.v[unknown];
    for _ in 0..100 {
        driver.step()?;
    }
    let state = driver.state();
    rows.extend([
        Row::relative(
            row("speed after it over that of the first step after it"),
            state.motion.v[unknown] / speed,
            1.0,
            ROUNDING,
        ),
        Row::at_most(
            row("energy residual / E0"),
            state.ledger.largest_energy_residual / state.ledger.initial.energy(),
            ROUNDING,
        ),
    ]);
    Ok(rows)
}

/// Problem 2.
fn torn() -> Result<Vec<Row>, Error> {
    let mesh = bar(5);
    let full = Formulation::Full;
    let mut link = part(&mesh, "link", full, |x| (x - 2.5).abs() < 0.1)?;
    link.deletion = Some(LIMIT);
    let Law::J2Plasticity(ref mut soft) = link.material else {
        return Ok(Vec::new());
    };
    soft.yield_stress = 100e6;
    let ends = part(&mesh, "ends", full, |x| (x - 2.5).abs() > 0.1)?;
    let bodies = vec![ModelBody::new(link), ModelBody::new(ends)];
    let system = crate::witness::system(Model::new(bodies, mesh, CENTRAL, 20.0 * STEP))?;
    let mut driver = Driver::new(Arc::clone(&system))?;
    let velocity = |x: &[f64; 3]| {
        // they turn as well
        let place = x[0] - 2.5 * EDGE;
        [50.0 * place.signum(), 20.0 * place / EDGE, 0.0]
    };
    let velocity: Vec<f64> = system.x.iter().flat_map(velocity).collect();
    driver.restart(&vec![0.0; velocity.len()], &velocity)?;
    until_deleted(&mut driver, 5_000)?;
    driver.step()?;
    let momenta = |driver: &Driver| {
        let mut sums = [[0.0; 3]; 2];
        for (k, x) in system.x.iter().enumerate() {
            for i in 0..3 {
                let own = system.mass.lumped[3 * k + i] * driver.state().motion.v[3 * k + i];
                sums[usize::from(x[0] > 2.5 * EDGE)][i] += own;
            }
        }
        sums
    };
    let before = momenta(&driver);
    for _ in 0..500 {
        driver.step()?;
    }
    let after = momenta(&driver);
    let size = before[1].iter().fold(0.0_f64, |most, p| most.max(p.abs()));
    let changes = before.iter().flatten().zip(after.iter().flatten());
    let change = changes.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    let ledger = &driver.state().ledger;
    Ok(vec![
        Row::near("torn: deleted cells", ledger.deleted as f64, 1.0, 0.0),
        Row::at_most(
            "torn: change of the momentum of a half, relative",
            change / size,
            ROUNDING,
        ),
        Row::at_most(
            "torn: momentum residual over the momentum of a half",
            ledger.largest_momentum_residual / size,
            ROUNDING,
        ),
        Row::at_most(
            "torn: angular momentum residual, relative",
            ledger.largest_angular_residual / ledger.largest_angular_momentum,
            ROUNDING,
        ),
        Row::at_most(
            "torn: energy residual, relative",
            ledger.largest_energy_residual / ledger.initial.energy(),
            ROUNDING,
        ),
    ])
}

/// Problem 3.
fn crushed() -> Result<Vec<Row>, Error> {
    let mesh = bar(4);
    let spec = BodySpec {
        deletion: Some(0.05),
        ..part(
            &mesh,
            "bar",
            Formulation::Reduced { hourglass: 0.1 },
            |_| true,
        )?
    };
    let body = ModelBody {
        velocity: [-SPEED, 0.0, 0.0],
        ..ModelBody::new(spec)
    };
    let face = Surface::new(&mesh, group(&mesh, "bar.left")?, &body.spec.cells)?;
    let wall = contact(face, plane(0, 1.0), HALF);
    let model = Model {
        contacts: vec![wall],
        ..Model::new(vec![body], mesh, CENTRAL, 20.0 * STEP)
    };
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let (mut least, way) = (0.0_f64, SPEED * 20.0 * STEP);
    for _ in 0..1500 {
        driver.step()?;
        let state = driver.state();
        let place = |(k, x): (usize, &[f64; 3])| x[0] + state.motion.u[3 * k];
        let places = driver.system().x.iter().enumerate().map(place);
        least = places.fold(least, f64::min);
    }
    let ledger = &driver.state().ledger;
    let points = driver.system().points() as f64;
    Ok(vec![
        Row::near("crushed: points of the contact", points, 20.0, 0.0),
        Row::at_least("crushed: deleted cells", ledger.deleted as f64, 1.0),
        Row::at_least(
            "crushed: least place over the way of a step",
            least / way,
            -1.0 - ROUNDING,
        ),
        Row::at_most(
            "crushed: energy residual / E0",
            ledger.largest_energy_residual / ledger.initial.energy(),
            ROUNDING,
        ),
    ])
}

/// Problems 4 and 5, in which one surface faces itself.
fn struck(itself: bool) -> Result<Vec<Row>, Error> {
    let name = if itself { "itself" } else { "struck" };
    let mut mesh = bar(4);
    // its corners stay away from the rim of the column, beyond which they would face nothing
    let (start, size) = (
        [4.1 * EDGE, 0.25 * EDGE, 0.25 * EDGE],
        [3.0 * EDGE, 0.5 * EDGE, 0.5 * EDGE],
    );
    let hammer = generate::box_("hammer", start, size, [1; 3], false);
    mesh.merge("hammer", hammer)?;
    let mut column = part(&mesh, "column", Formulation::Full, |_| true)?;
    column.deletion = Some(LIMIT);
    let held = |node: &u32| mesh.nodes[*node as usize][0] < 3.05 * EDGE;
    let mut support = support(&mesh, "bar", [true; 3])?;
    support.nodes.retain(held);
    let hard = Law::J2Plasticity(J2Plasticity {
        yield_stress: 1e12,
        ..STEEL
    });
    let cells = group(&mesh, "hammer")?.elements.clone();
    let hammer = BodySpec::new("hammer", cells, Kinematics::Solid, hard);
    let mut top = Surface::new(&mesh, group(&mesh, "bar.right")?, &column.cells)?;
    let mut face = Surface::new(&mesh, group(&mesh, "hammer.left")?, &hammer.cells)?;
    let front = face.nodes.clone();
    if itself {
        top.faces.extend(face.faces);
        top.nodes.extend(face.nodes);
        top.nodes.sort_unstable();
        face = top.clone();
    }
    let hammer = ModelBody {
        velocity: [-SPEED, 0.0, 0.0],
        ..ModelBody::new(hammer)
    };
    let model = Model {
        supports: vec![support],
        contacts: vec![contact(face, ModelTarget::Surface(top), HALF)],
        ..Model::new(
            vec![ModelBody::new(column), hammer],
            mesh,
            CENTRAL,
            20.0 * STEP,
        )
    };
    let system = crate::witness::system(model)?;
    let mut driver = Driver::new(Arc::clone(&system))?;
    until_deleted(&mut driver, 5_000)?;
    let force = |driver: &Driver| driver.state().interface.force.iter().sum::<f64>();
    let at_deletion = force(&driver);
    // half of the force of the step of the deletion acts in this one
    driver.step()?;
    let saved = driver.saved()?;
    let momentum = |driver: &Driver| {
        let of_hammer = |k: &usize| system.x[*k][0] > 4.05 * EDGE;
        let nodes = (0..system.x.len()).filter(of_hammer);
        let v = &driver.state().motion.v;
        nodes
            .map(|k| system.mass.lumped[3 * k] * v[3 * k])
            .sum::<f64>()
    };
    let (flying, mut change, mut steps) = (momentum(&driver), 0.0_f64, 0.0);
    let mut before = flying;
    while force(&driver) == 0.0 && steps < 20_000.0 {
        change = change.max((before - flying).abs());
        before = momentum(&driver);
        driver.step()?;
        steps += 1.0;
    }
    let mut resumed = Driver::resume(Arc::clone(&system), State::from_bytes(&system, &saved)?)?;
    while resumed.state().step < driver.state().step {
        resumed.step()?;
    }
    let is_same = resumed.saved()? == driver.saved()?;
    let state = driver.state();
    let front = front
        .iter()
        .map(|&node| system.number[node as usize] as usize);
    let least = front.fold(f64::INFINITY, |least, k| {
        least.min(system.x[k][0] + state.motion.u[3 * k])
    });
    let way = SPEED * 20.0 * STEP;
    let ledger = &state.ledger;
    Ok(vec![
        Row::near(
            format!("{name}: deleted cells"),
            ledger.deleted as f64,
            1.0,
            0.0,
        ),
        Row::at_least(
            format!("{name}: force on the cell when it is deleted, N"),
            at_deletion,
            1.0,
        ),
        Row::at_least(format!("{name}: steps of flight behind it"), steps, 100.0),
        Row::at_most(
            format!("{name}: change of the momentum in flight, relative"),
            change / flying.abs(),
            ROUNDING,
        ),
        Row::near(
            format!("{name}: place of the second blow less that of the bare face, ways of a step"),
            (least - 3.0 * EDGE) / way,
            0.0,
            1.0,
        ),
        Row::at_least(
            format!("{name}: whether a run that is cut in the flight ends in the same bytes"),
            f64::from(u8::from(is_same)),
            1.0,
        ),
        Row::at_most(
            format!("{name}: momentum residual, relative"),
            ledger.largest_momentum_residual / flying.abs(),
            ROUNDING,
        ),
        Row::at_most(
            format!("{name}: energy residual, relative"),
            ledger.largest_energy_residual / ledger.initial.energy(),
            ROUNDING,
        ),
    ])
}

pub(crate) const CHECK: Check = Check {
    name: "deletion",
    fact: "a deleted cell takes the energy that it had stored out of the balance and no momentum; the nodes behind it meet the wall, and a hammer the face behind the cell that it destroyed",
    run: |_| {
        let mut rows = pulled("full integration", Formulation::Full)?;
        rows.extend(pulled("mean dilatation", Formulation::BBar)?);
        rows.extend(pulled(
            "one point",
            Formulation::Reduced { hourglass: 0.1 },
        )?);
        rows.extend(torn()?);
        rows.extend(crushed()?);
        rows.extend(struck(false)?);
        rows.extend(struck(true)?);
        Ok(rows)
    },
};
