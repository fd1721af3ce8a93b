//! Shells with finite rotations.
//!
//! Problems:
//! - Cantilever under a force at its end, slit annular plate and cylinder pulled out: problems 3.1, 3.2 and 3.5 of Sze, Liu and Lo (2004, Finite Elem. Anal. Des.
//!   40, 1551), E = 1.2e6, L = 10, b = 1, h = 0.1, ν = 0, force 4: displacements 3.286 back and 6.698 down; E = 2.1e7, radii 6 and 10, h = 0.03, ν = 0, force 0.8 per
//!   length of one side of the slit, the other is clamped: 13.891 and 17.528 at its inner and outer end; E = 1.05e7, R = 4.953, L = 10.35, h = 0.094,
//!   ν = 0.3125, two forces 4e4: the loaded points move by 2.768.
//! - A soft plate that flies and tumbles, energy-momentum: momentum, angular momentum and energy are kept.
//!
//! Tolerance: 2 % of published displacements, the width of a drawn curve. Of the balances 1e-8: what the iterations leave, 1e-12 of the forces in each of up to
//! 1e5 steps, adds up to less.

use carom_bodies::Rotations;
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Driver, Model, Scheme, System};
use carom_materials::Elastic;

use crate::Error;
use crate::beams::held;
use crate::check::{Check, Row, Size};
use crate::shells::{Grid, Held, force, loaded, moved, shell};

fn material(young: f64, poisson: f64) -> Elastic {
    Elastic {
        density: 1.0,
        young,
        poisson,
    }
}

/// Displacements of nodes under the whole load.
fn at_end(
    made: (carom_mesh::Mesh, carom_dynamics::ModelBody),
    load: Held,
    steps: u64,
    nodes: &[u32],
) -> Result<Vec<[f64; 3]>, Error> {
    let mut found = Vec::new();
    loaded(made, load, steps, &mut |_, driver| {
        found = nodes.iter().map(|&node| moved(driver, node)).collect();
    })?;
    Ok(found)
}

fn published(name: &str, value: f64, reference: f64) -> Row {
    Row::relative(name, value, reference, 0.02).published()
}

fn cantilever() -> Result<Vec<Row>, Error> {
    let grid = Grid::new(16, 1);
    let mesh = grid.mesh(&|s, t| [10.0 * s, t, 0.0]);
    let made = shell(&mesh, 0.1, Rotations::Finite, material(1.2e6, 0.0))?;
    let load = Held {
        supports: vec![held(grid.column(0), [true; 3], [true; 3])],
        loads: vec![force(grid.column(grid.n), [0.0, 0.0, 2.0])],
        ..Held::default()
    };
    let end = at_end((mesh, made), load, 10, &[grid.node(grid.n, 0)])?[0];
    Ok(vec![
        published("cantilever: displacement back", -end[0], 3.286),
        published("cantilever: displacement along the force", end[2], 6.698),
    ])
}

fn annulus([n, m]: [usize; 2], steps: u64) -> Result<Vec<Row>, Error> {
    let grid = Grid::new(n, m);
    let mesh = grid.mesh(&|s, t| {
        let (angle, radius) = (std::f64::consts::TAU * s, 6.0 + 4.0 * t);
        [radius * angle.cos(), radius * angle.sin(), 0.0]
    });
    let made = shell(&mesh, 0.03, Rotations::Finite, material(2.1e7, 0.0))?;
    let edge = grid.column(n);
    let part = 0.8 * 4.0 / m as f64;
    let load = Held {
        supports: vec![held(grid.column(0), [true; 3], [true; 3])],
        loads: vec![
            force(edge[1..m].to_vec(), [0.0, 0.0, part]),
            force(vec![edge[0], edge[m]], [0.0, 0.0, 0.5 * part]),
        ],
        ..Held::default()
    };
    let found = at_end((mesh, made), load, steps, &[edge[0], edge[m]])?;
    Ok(vec![
        published("slit annular plate: inner end", found[0][2], 13.891),
        published("slit annular plate: outer end", found[1][2], 17.528),
    ])
}

/// An eighth: the force at x = 0, y = 0, z = R.
fn cylinder([n, m]: [usize; 2], steps: u64) -> Result<Row, Error> {
    let grid = Grid::new(n, m);
    let radius = 4.953;
    let mesh = grid.mesh(&|s, t| {
        let angle = (90.0 * s).to_radians();
        [radius * angle.sin(), 0.5 * 10.35 * t, radius * angle.cos()]
    });
    let made = shell(&mesh, 0.094, Rotations::Finite, material(1.05e7, 0.3125))?;
    let point = grid.node(0, 0);
    let load = Held {
        supports: vec![
            held(grid.row(0), [false, true, false], [true, false, true]),
            held(grid.column(0), [true, false, false], [false, true, true]),
            held(grid.column(n), [false, false, true], [true, true, false]),
        ],
        loads: vec![force(vec![point], [0.0, 0.0, 1e4])],
        ..Held::default()
    };
    let found = at_end((mesh, made), load, steps, &[point])?;
    Ok(published(
        "pulled cylinder: loaded point",
        found[0][2],
        2.768,
    ))
}

/// Residual of the iterations over the largest of the forces that balance.
const TOLERANCE: f64 = 1e-12;

fn flying([n, m]: [usize; 2], steps: usize) -> Result<Vec<Row>, Error> {
    let grid = Grid::new(n, m);
    let mesh = grid.mesh(&|s, t| [s, 0.6 * t, 0.0]);
    let soft = Elastic {
        density: 1000.0,
        young: 1e7,
        poisson: 0.3,
    };
    let mut made = shell(&mesh, 0.01, Rotations::Finite, soft)?;
    (made.spin, made.velocity) = ([6.0, 4.0, 12.0], [0.3, -0.2, 0.1]);
    let scheme = Scheme::EnergyMomentum(EnergyMomentum {});
    let mut model = Model::new(vec![made], mesh, scheme, 2e-3);
    model.nonlinear.iteration.tolerance = TOLERANCE;
    let mut driver = Driver::new(System::new(model)?)?;
    let mut strain = 0.0_f64;
    for _ in 0..steps {
        driver.step()?;
        strain = strain.max(driver.state().ledger.balance.strain);
    }
    let ledger = &driver.state().ledger;
    let turned = 14.0 * 2e-3 * steps as f64 / std::f64::consts::TAU;
    Ok(vec![
        Row::shown("flying plate: revolutions", turned),
        Row::at_least(
            "flying plate: largest strain energy over the kinetic energy",
            strain / ledger.initial.kinetic,
            1e-3,
        ),
        Row::at_most(
            "flying plate: energy residual",
            ledger.largest_energy_residual / ledger.largest_energy,
            1e-8,
        ),
        Row::at_most(
            "flying plate: energy that the scheme made",
            ledger.balance.dissipation_scheme.abs() / ledger.largest_energy,
            1e-8,
        ),
        Row::at_most(
            "flying plate: angular momentum residual",
            ledger.largest_angular_residual / ledger.largest_angular_momentum,
            1e-10,
        ),
    ])
}

pub(crate) const CHECK: Check = Check {
    name: "large-shells",
    fact: "shells with finite rotations bend as published, and keep energy and angular momentum in free motion",
    run: |size| {
        let mut rows = cantilever()?;
        match size {
            Size::Quick => rows.extend(flying([3, 2], 300)?),
            Size::Full => {
                rows.extend(annulus([60, 8], 60)?);
                rows.push(cylinder([24, 16], 100)?);
                rows.extend(flying([4, 3], 20_000)?);
            }
        }
        Ok(rows)
    },
};
