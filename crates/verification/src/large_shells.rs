//! Shells with finite rotations.
//!
//! Problems:
//! - The problems 3.1, 3.2, 3.3, 3.5 and 3.8 of Sze, Liu and Lo (2004, Finite Elem. Anal. Des. 40, 1551), with their tables: cantilever under a force at its end,
//!   rolled up by a moment (closed form), slit annular plate, cylinder pulled out, and roof of 12.7 mm between hinges that snaps through, here with the
//!   displacement of its middle given.
//! - A soft plate that flies and tumbles, energy-momentum: momentum, angular momentum and energy are kept, in the full size over 1000 revolutions.
//!
//! Tolerance: 2 %, the width of a drawn curve: of published displacements, and of the first largest load for loads. Of the closed form 1 %. Of the balances 1e-8:
//! what the iterations leave, 1e-12 of the forces in each of up to 1e5 steps, adds up to less; of both momenta 1e-10.

use carom_bodies::Rotations;
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Driver, Model, ModelBody, Preload, Prescribed, PrescribedTurn, Scheme};
use carom_materials::Elastic;
use carom_mesh::Mesh;
use carom_signals::Amplitude;

use crate::Error;
use crate::beams::held;
use crate::build::newmark;
use crate::check::{Check, Row, Size};
use crate::shells::{Grid, Held, force, loaded, moved, section_of, shell};

fn material(young: f64, poisson: f64) -> Elastic {
    Elastic {
        density: 1.0,
        young,
        poisson,
    }
}

fn published(name: &str, value: f64, reference: f64) -> Row {
    Row::relative(name, value, reference, 0.02).published()
}

/// A table of a problem: part of the load, and displacements, m.
struct Table<const N: usize> {
    names: [&'static str; N],
    rows: &'static [(f64, [f64; N])],
}

/// Compares displacements with a table at the parts of the load that it has. `of`: the displacements in the order of the table.
fn along<const N: usize>(
    made: (Mesh, ModelBody),
    load: Held,
    steps: u64,
    table: &Table<N>,
    of: &dyn Fn(&Driver) -> [f64; N],
) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    loaded(made, load, steps, &mut |part, driver| {
        let near = |row: &&(f64, [f64; N])| (row.0 - part).abs() < 1e-9;
        let Some((_, reference)) = table.rows.iter().find(near) else {
            return;
        };
        for ((name, value), reference) in table.names.iter().zip(of(driver)).zip(reference) {
            rows.push(published(
                &format!("{name}, load {part:.3}"),
                value,
                *reference,
            ));
        }
    })?;
    Ok(rows)
}

/// E = 1.2e6, L = 10, b = 1, h = 0.1, ν = 0, force 4.
fn cantilever() -> Result<Vec<Row>, Error> {
    let grid = Grid::new(16, 1);
    let mesh = grid.mesh(&|s, t| [10.0 * s, t, 0.0]);
    let made = shell(&mesh, 0.1, Rotations::Finite, material(1.2e6, 0.0))?;
    let load = Held {
        supports: vec![held(grid.column(0), [true; 3], [true; 3])],
        loads: vec![force(grid.column(grid.n), [0.0, 0.0, 2.0])],
        ..Held::default()
    };
    let table = Table {
        names: ["cantilever: back", "cantilever: along the force"],
        rows: &[
            (0.2, [0.381, 2.493]),
            (0.5, [1.604, 4.933]),
            (1.0, [3.286, 6.698]),
        ],
    };
    along((mesh, made), load, 10, &table, &|driver| {
        let end = moved(driver, grid.node(grid.n, 0));
        [-end[0], end[2]]
    })
}

/// E = 1.2e6, L = 12, b = 1, h = 0.1, ν = 0: a strip whose end is turned by φ has the curvature φ/L everywhere, and the moment EI φ/L. The moment of straight
/// elements errs by (φ/n)²/6, with n of them.
fn roll_up(elements: usize, steps: u64) -> Result<Vec<Row>, Error> {
    let (length, bending) = (12.0, 1.2e6 * 0.1_f64.powi(3) / 12.0);
    let grid = Grid::new(elements, 1);
    let mesh = grid.mesh(&|s, t| [length * s, t, 0.0]);
    let made = shell(&mesh, 0.1, Rotations::Finite, material(1.2e6, 0.0))?;
    let mut model = Model {
        supports: vec![held(grid.column(0), [true; 3], [true; 3])],
        ..Model::new(vec![made], mesh, newmark(0.25, 0.5), 1.0 / steps as f64)
    };
    model.nonlinear.preload = Some(Preload { end: 1.0, steps });
    let end = grid.column(elements);
    for &node in &end {
        model.nonlinear.turns.push(PrescribedTurn {
            node,
            axis: 1,
            angle: Amplitude::new(vec![[0.0, 0.0], [1.0, -std::f64::consts::TAU]])?,
        });
    }
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let mut rows = Vec::new();
    for step in 1..=steps {
        driver.step()?;
        if 4 * step % steps != 0 {
            continue;
        }
        let angle = std::f64::consts::TAU * step as f64 / steps as f64;
        let expected = [
            length * (angle.sin() / angle - 1.0),
            length * (1.0 - angle.cos()) / angle,
        ];
        let moved = moved(&driver, end[0]);
        for (name, found, expected) in [("x", moved[0], expected[0]), ("z", moved[2], expected[1])]
        {
            let name =
                format!("strip rolled up by {angle:.2}: displacement {name} over the length");
            rows.push(Row::near(&name, found / length, expected / length, 0.01));
        }
        let (system, state) = (driver.system(), driver.state());
        let moment = end.iter().map(|&node| {
            let first = system.unknowns.first(system.number[node as usize]);
            -state.motion.internal_force[first + 4]
        });
        let name = format!("strip rolled up by {angle:.2}: moment");
        rows.push(Row::relative(
            &name,
            moment.sum(),
            bending * angle / length,
            0.01,
        ));
    }
    Ok(rows)
}

/// E = 2.1e7, radii 6 and 10, h = 0.03, ν = 0, force 0.8 per length of one side of the slit; the other is clamped.
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
    let table = Table {
        names: [
            "slit annular plate: inner end",
            "slit annular plate: outer end",
        ],
        rows: &[
            (0.1, [4.277, 5.876]),
            (0.25, [7.602, 10.288]),
            (0.5, [10.468, 13.768]),
            (1.0, [13.891, 17.528]),
        ],
    };
    along((mesh, made), load, steps, &table, &|driver| {
        [edge[0], edge[m]].map(|node| moved(driver, node)[2])
    })
}

/// An eighth of a cylinder, E = 1.05e7, R = 4.953, L = 10.35, h = 0.094, ν = 0.3125, two forces 4e4: A is under the force, B opposite at the middle, C at the end.
fn cylinder([n, m]: [usize; 2], steps: u64) -> Result<Vec<Row>, Error> {
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
    let table = Table {
        names: [
            "pulled cylinder: loaded point",
            "pulled cylinder: side of the middle",
            "pulled cylinder: side of the end",
        ],
        rows: &[
            (0.1, [1.707, 2.217, 2.293]),
            (0.25, [2.180, 3.087, 3.310]),
            (0.5, [2.473, 3.653, 3.718]),
            (1.0, [2.768, 4.551, 3.269]),
        ],
    };
    along((mesh, made), load, steps, &table, &|driver| {
        let (b, c) = (grid.node(n, 0), grid.node(n, m));
        [
            moved(driver, point)[2],
            -moved(driver, b)[0],
            -moved(driver, c)[0],
        ]
    })
}

/// A quarter of a roof, E = 3102.75, R = 2540, 508 by 508 on the ground, angle 0.2, h = 12.7, ν = 0.3, straight edges on hinges, force at the middle, in units of 3000.
const ROOF: [[f64; 2]; 11] = [
    [3.087, 0.3473],
    [5.802, 0.5647],
    [8.237, 0.6908],
    [10.358, 0.7412],
    [12.141, 0.7286],
    [14.188, 0.6182],
    [16.125, 0.3830],
    [18.299, 0.1940],
    [19.852, 0.1729],
    [22.875, 0.2950],
    [28.663, 0.9643],
];

fn roof(n: usize) -> Result<Vec<Row>, Error> {
    let grid = Grid::new(n, n);
    let mesh = grid.mesh(&|s, t| {
        let angle = 0.1 * s;
        let up = 2540.0 * (angle.cos() - 0.1_f64.cos());
        [2540.0 * angle.sin(), 254.0 * t, up]
    });
    let mut made = shell(&mesh, 12.7, Rotations::Finite, material(3102.75, 0.3))?;
    made.velocity = [0.0; 3];
    let middle = grid.node(0, 0);
    let steps = ROOF.len() as u64;
    let mut points = vec![[0.0, 0.0]];
    points.extend(
        (1..)
            .zip(ROOF)
            .map(|(k, [w, _]): (u32, _)| [f64::from(k) / steps as f64, -w]),
    );
    let down = Amplitude::new(points)?;
    let mut model = Model {
        supports: vec![
            held(grid.column(0), [true, false, false], [false, true, true]),
            held(grid.row(0), [false, true, false], [true, false, true]),
            held(grid.column(n), [true; 3], [true, false, true]),
        ],
        ..Model::new(vec![made], mesh, newmark(0.25, 0.5), 1.0 / steps as f64)
    };
    model.nonlinear.preload = Some(Preload { end: 1.0, steps });
    model.nonlinear.motions.push(Prescribed {
        nodes: vec![middle],
        displacement: [None, None, Some(down)],
    });
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let largest = ROOF.iter().map(|[_, load]| *load).fold(0.0, f64::max);
    let mut rows = Vec::new();
    for [down, load] in ROOF {
        driver.step()?;
        let (system, state) = (driver.system(), driver.state());
        let own = system.number[middle as usize];
        let found = system.unknowns.vector(own, &state.motion.internal_force)[2];
        let name = format!("roof between hinges: load at {down} over the largest");
        let of_all = -4.0 * found / 3000.0;
        rows.push(Row::near(&name, of_all / largest, load / largest, 0.02).published());
    }
    Ok(rows)
}

/// Residual of the iterations over the largest of the forces that balance.
const TOLERANCE: f64 = 1e-12;

/// Rows of a soft plate, its middle beside its nodes by `offset` (m), in so many steps.
pub(crate) fn tumbling(
    [n, m]: [usize; 2],
    offset: f64,
    (dt, steps): (f64, usize),
) -> Result<Vec<Row>, Error> {
    let grid = Grid::new(n, m);
    let mesh = grid.mesh(&|s, t| [s, 0.6 * t, 0.0]);
    let soft = Elastic {
        density: 1000.0,
        young: 1e7,
        poisson: 0.3,
    };
    let mut made = shell(&mesh, 0.01, Rotations::Finite, soft)?;
    section_of(&mut made, &|section| section.offset = offset);
    (made.spin, made.velocity) = ([6.0, 4.0, 12.0], [0.3, -0.2, 0.1]);
    let scheme = Scheme::EnergyMomentum(EnergyMomentum {});
    let mut model = Model::new(vec![made], mesh, scheme, dt);
    model.nonlinear.iteration.tolerance = TOLERANCE;
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let mut strain = 0.0_f64;
    for _ in 0..steps {
        driver.step()?;
        strain = strain.max(driver.state().ledger.balance.strain);
    }
    let ledger = &driver.state().ledger;
    let turned = 14.0 * dt * steps as f64 / std::f64::consts::TAU;
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
            "flying plate: momentum residual",
            ledger.largest_momentum_residual / ledger.largest_momentum,
            1e-10,
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
            Size::Quick => {
                rows.extend(roll_up(32, 20)?);
                rows.extend(roof(8)?);
                rows.extend(tumbling([3, 2], 0.0, (2e-3, 300))?);
            }
            Size::Full => {
                rows.extend(roll_up(32, 20)?);
                rows.extend(annulus([60, 8], 60)?);
                rows.extend(cylinder([24, 16], 100)?);
                rows.extend(roof(8)?);
                rows.extend(tumbling([4, 3], 0.0, (2e-3, 2000))?);
                rows.extend(tumbling([2, 2], 0.0, (2e-2, 22_500))?);
            }
        }
        Ok(rows)
    },
};
