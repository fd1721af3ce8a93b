//! Quadrilaterals of shells with one point and hourglass control.
//!
//! Problems:
//! - Those of `shell-benchmarks` on the same meshes, under a thousandth of their loads, with the default of elastic materials, the stiffness of full integration against hourglass modes, κ = 1; with
//!   the default of metals, κ = 0.05, shown on the same meshes, and the roof and the twisted beams checked on meshes twice as fine.
//! - A soft plate that flies and tumbles under central differences, κ = 0.05, in its nodes and beside them.
//!
//! Tolerance: 2 %, the spread of published values, as for full integration. With κ = 0.05 a member of n elements over its height is bent in its plane with 1 - 0.95/n² of
//! its stiffness, 1.5 % with 8; 3 %. Momenta: rounding of 10⁴ steps, 1e-10. Energy: central differences keep it to (ω dt)²/4 of the vibration, here 1e-3 of all; 1e-3.

use carom_bodies::{Formulation, MassKind, Rotations};
use carom_dynamics::{Driver, Model};
use carom_materials::Elastic;

use crate::Error;
use crate::build::CENTRAL;
use crate::check::{Check, Row, Size};
use crate::shell_benchmarks::{cylinder, hemisphere, hook, roof, twisted};
use crate::shells::{Grid, Loaded, section_of, shell};

/// Factors of the stiffness against hourglass modes that a case has without a word of its own: of elastic materials and of metals.
const ELASTIC: f64 = 1.0;
const METAL: f64 = 0.05;

/// Part of the loads: rotations are small.
const PART: f64 = 1e-3;

/// What is computed, its published displacement, and the mesh.
type Problem<'a> = (
    &'a str,
    f64,
    [usize; 2],
    &'a dyn Fn(&Grid) -> Result<Loaded, Error>,
);

/// Those without a part are shown alone.
fn rows(problems: &[Problem], hourglass: f64, part: Option<f64>) -> Result<Vec<Row>, Error> {
    let of = |(name, published, [n, m], solve): &Problem| {
        let found = solve(&Grid::new(*n, *m))?.with_one_point(hourglass, PART)?;
        let name = format!("{name}, {n} x {m}, factor {hourglass}: displacement");
        Ok(match part {
            Some(part) => Row::relative(name, found, *published, part).published(),
            None => Row::shown(format!("{name}, over the published one"), found / published),
        })
    };
    problems.iter().map(of).collect()
}

/// A plate of density 1000, E = 1e7, 1 by 0.6 by 0.01, with a velocity and a spin that bends it.
fn flying(offset: f64, steps: usize) -> Result<Vec<Row>, Error> {
    let mesh = Grid::new(4, 3).mesh(&|s, t| [s, 0.6 * t, 0.0]);
    let soft = Elastic {
        density: 1000.0,
        young: 1e7,
        poisson: 0.3,
    };
    let mut made = shell(&mesh, 0.01, Rotations::Finite, soft)?;
    made.mass = MassKind::Lumped;
    section_of(&mut made, &|section| section.offset = offset);
    made.spec.formulation = Formulation::Reduced { hourglass: METAL };
    (made.spin, made.velocity) = ([6.0, 4.0, 12.0], [0.3, -0.2, 0.1]);
    let dt = 2e-4;
    let mut driver = Driver::new(crate::witness::system(Model::new(
        vec![made],
        mesh,
        CENTRAL,
        dt,
    ))?)?;
    let mut strain = 0.0_f64;
    for _ in 0..steps {
        driver.step()?;
        strain = strain.max(driver.state().ledger.balance.strain);
    }
    let ledger = &driver.state().ledger;
    let name = |what: &str| format!("plate beside its nodes by {offset} m: {what}");
    let turned = 14.0 * dt * steps as f64 / std::f64::consts::TAU;
    Ok(vec![
        Row::shown(name("revolutions"), turned),
        Row::at_least(
            name("largest strain energy over the kinetic energy"),
            strain / ledger.initial.kinetic,
            1e-3,
        ),
        Row::at_most(
            name("momentum residual"),
            ledger.largest_momentum_residual / ledger.largest_momentum,
            1e-10,
        ),
        Row::at_most(
            name("angular momentum residual"),
            ledger.largest_angular_residual / ledger.largest_angular_momentum,
            1e-10,
        ),
        Row::at_most(
            name("energy residual"),
            ledger.largest_energy_residual / ledger.largest_energy,
            1e-3,
        ),
        Row::at_most(
            name("energy of hourglass modes over the strain energy"),
            ledger.largest_hourglass / strain,
            0.1,
        ),
    ])
}

fn run(size: Size) -> Result<Vec<Row>, Error> {
    let thick = |axis: usize| move |grid: &Grid| twisted(grid, 0.32, 1.0, axis);
    let thin = |axis: usize| move |grid: &Grid| twisted(grid, 0.0032, 1e-6, axis);
    let all: [Problem; 8] = [
        ("Scordelis-Lo roof", 0.3024, [16, 16], &roof),
        ("pinched cylinder", 1.8248e-5, [32, 32], &cylinder),
        ("hemisphere", 0.0940, [16, 16], &hemisphere),
        (
            "twisted beam, h = 0.32, in plane",
            5.424e-3,
            [24, 4],
            &thick(2),
        ),
        (
            "twisted beam, h = 0.32, across",
            1.754e-3,
            [24, 4],
            &thick(1),
        ),
        (
            "twisted beam, h = 0.0032, in plane",
            5.256e-3,
            [24, 4],
            &thin(2),
        ),
        (
            "twisted beam, h = 0.0032, across",
            1.294e-3,
            [24, 4],
            &thin(1),
        ),
        ("Raasch's hook", 4.9352, [36, 8], &hook),
    ];
    let mut found = rows(&all, ELASTIC, Some(0.02))?;
    if size == Size::Full {
        let finer = [0, 3, 4, 5, 6].map(|k: usize| {
            let (name, published, [n, m], solve) = all[k];
            (name, published, [2 * n, 2 * m], solve)
        });
        found.extend(rows(&all, METAL, None)?);
        found.extend(rows(&finer, METAL, Some(0.03))?);
    }
    let steps = if size == Size::Full { 10_000 } else { 1000 };
    found.extend(flying(0.0, steps)?);
    found.extend(flying(0.01, steps)?);
    Ok(found)
}

pub(crate) const CHECK: Check = Check {
    name: "one-point-shells",
    fact: "shells with one point deflect as published, and keep their momenta under central differences",
    run,
};
