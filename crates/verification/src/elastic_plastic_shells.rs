//! Shells of metal.
//!
//! Problem: a strip of L = 1 m, b = 0.1 m, h = 0.01 m under a moment M at one end; the other does not turn along the strip and is free to bend across. Ideal plasticity,
//! σ_y = 300 MPa, ν = 0.4999: the strip bends across by -κ/2 where it flows and where it does not, without stress across. Closed form of a rectangle: with M_y = σ_y b h²/6
//! and κ_y = 2 σ_y/(E h), κ = κ_y M/M_y up to M_y, then κ = κ_y/√(3 - 2 M/M_y); the end turns by κ L.
//!
//! The same of a tenth of the length with finite rotations, whose end is turned: M/M_p = κ/(1.5 κ_y) up to κ_y, then 1 - (κ_y/κ)²/3, up to 4 κ_y or 0.98 M_p, where the slope of ideal plasticity is 2 %
//! of the elastic one. With full integration of elements ten and twenty times as wide as long; with one point an element ten times: of twenty, the stiffness against hourglass modes of 0.05 does not hold the last
//! one where it flows, and static iterations end without equilibrium at 2.87 κ_y; with a stiffness of 0.3, or two elements across, they do not.
//!
//! Tolerance: constant curvature is exact in these elements, so that the elastic rotation is exact but for the iterations, 1e-6. At 0.8 M_p and beyond 1 %: the rule with N layers errs by
//! 0.24/N² in M, and κ by 0.5 M/(M_p - M) times that: with 50 layers 0.5 % at 0.99 M_p; M of the 16 of finite rotations errs by 0.1 %; the volume changes by 2e-4 of the strain. With finite rotations strains of Green and Lagrange differ by their
//! squares, 1.5e-3 of them at yield: 2e-3 where nothing flows.

use carom_bodies::{Formulation, Kinematics, MassKind, Rotations, ShellSection};
use carom_dynamics::{Driver, Model, NodalLoad, Preload, PrescribedTurn};
use carom_materials::{Elastic, J2Plasticity, Law};
use carom_signals::Amplitude;

use crate::Error;
use crate::beams::held;
use crate::build::{body, newmark};
use crate::check::{Check, Row, Size};
use crate::shells::{Grid, Held, loaded};

const YIELD: f64 = 3e8;
const STEEL: Elastic = Elastic {
    density: 7800.0,
    young: 2e11,
    poisson: 0.4999,
};
const SIZES: [f64; 3] = [1.0, 0.1, 0.01];

/// Rotation of the end under a part of M_p.
fn rotation(grid: &Grid, part: f64) -> Result<f64, Error> {
    let [length, width, thickness] = SIZES;
    let mesh = grid.mesh(&|s, t| [length * s, width * t, 0.0]);
    let section = ShellSection {
        rotations: Rotations::Small,
        layers: 50,
        ..ShellSection::new(thickness)
    };
    let mut made = body(&mesh, "shell", Kinematics::Shell(section), STEEL)?;
    made.mass = MassKind::Consistent;
    made.spec.material = Law::J2Plasticity(J2Plasticity {
        initial: STEEL,
        yield_stress: YIELD,
        hardening: 0.0,
    });
    let whole = YIELD * width * thickness * thickness / 4.0;
    let end = grid.column(grid.n);
    let load = NodalLoad {
        name: "moment".into(),
        nodes: end.clone(),
        force: [0.0; 3],
        moment: [0.0, -part * whole / 2.0, 0.0],
        amplitude: Amplitude::constant(1.0),
    };
    let supports = vec![held(grid.column(0), [true; 3], [false, true, true])];
    let mut found = 0.0;
    let given = Held {
        supports,
        loads: vec![load],
        ..Held::default()
    };
    loaded((mesh, made), given, 25, &mut |_, driver| {
        let (system, state) = (driver.system(), driver.state());
        let own = system.number[end[0] as usize];
        found = -system.unknowns.spin(own, &state.motion.u)[1];
    })?;
    Ok(found)
}

/// The closed form.
fn exact(part: f64) -> f64 {
    let first = 2.0 * YIELD / (STEEL.young * SIZES[2]);
    let ratio = 1.5 * part;
    let curvature = match ratio <= 1.0 {
        true => ratio * first,
        false => first / (3.0 - 2.0 * ratio).sqrt(),
    };
    curvature * SIZES[0]
}

/// Moment over M_p of a strip of these elements, a tenth as long, whose end is turned until its curvature is `ratio` of that of yield.
fn moment(grid: &Grid, formulation: Formulation, ratio: f64) -> Result<f64, Error> {
    let [length, width, thickness] = [0.1 * SIZES[0], SIZES[1], SIZES[2]];
    let mesh = grid.mesh(&|s, t| [length * s, width * t, 0.0]);
    let section = ShellSection {
        rotations: Rotations::Finite,
        layers: 16,
        ..ShellSection::new(thickness)
    };
    let mut made = body(&mesh, "shell", Kinematics::Shell(section), STEEL)?;
    made.mass = MassKind::Consistent;
    made.spec.formulation = formulation;
    made.spec.material = Law::J2Plasticity(J2Plasticity {
        initial: STEEL,
        yield_stress: YIELD,
        hardening: 0.0,
    });
    let steps = 40;
    let mut model = Model {
        supports: vec![held(grid.column(0), [true; 3], [false, true, true])],
        ..Model::new(vec![made], mesh, newmark(0.25, 0.5), 1.0 / steps as f64)
    };
    model.nonlinear.preload = Some(Preload { end: 1.0, steps });
    let angle = ratio * 2.0 * YIELD / (STEEL.young * thickness) * length;
    let end = grid.column(grid.n);
    for &node in &end {
        model.nonlinear.turns.push(PrescribedTurn {
            node,
            axis: 1,
            angle: Amplitude::new(vec![[0.0, 0.0], [1.0, -angle]])?,
        });
    }
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    for _ in 0..steps {
        driver.step()?;
    }
    let (system, state) = (driver.system(), driver.state());
    let moments = end.iter().map(|&node| {
        let first = system.unknowns.first(system.number[node as usize]);
        -state.motion.internal_force[first + 4]
    });
    Ok(moments.sum::<f64>() / (YIELD * width * thickness * thickness / 4.0))
}

fn run(size: Size) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for triangles in [false, true] {
        let (n, m) = (20, 1);
        let grid = Grid { n, m, triangles };
        let kind = if triangles { "tri3" } else { "quad4" };
        for (part, tolerance) in [(0.3, 1e-6), (0.8, 0.01), (0.9, 0.01), (0.99, 0.01)] {
            let name = format!("{kind}: rotation of the end at {part} M_p, rad");
            let found = rotation(&grid, part)?;
            rows.push(Row::relative(name, found, exact(part), tolerance));
        }
    }
    let one_point = Formulation::Reduced { hourglass: 0.05 };
    for (kind, grid, formulation) in [
        ("one point", Grid::new(10, 1), one_point),
        ("four points", Grid::new(10, 1), Formulation::Full),
        ("four points, 1:20", Grid::new(20, 1), Formulation::Full),
    ] {
        let all = [(4.0_f64, 0.01), (0.5, 2e-3), (1.2, 0.01), (1.8, 0.01)];
        let taken = match size {
            Size::Quick => &all[..1],
            Size::Full => &all[..],
        };
        for &(ratio, tolerance) in taken {
            let exact = match ratio <= 1.0 {
                true => ratio / 1.5,
                false => 1.0 - ratio.powi(-2) / 3.0,
            };
            let name = format!("{kind}: moment at {ratio} of the curvature of yield, M_p");
            let found = moment(&grid, formulation, ratio)?;
            rows.push(Row::relative(name, found, exact, tolerance));
        }
    }
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "elastic-plastic-shells",
    fact: "a strip of shells of metal bends as the closed form of a rectangle says",
    run,
};
