//! A fuel rod that knocks in its grids through a whole record.
//!
//! Problem: a tube with the mass of its pellets, 3.85 m long, 77 beam elements with lumped mass, in eight grids; each has along x and
//! along y a spring and, on the other side, two dimples: 48 stops with gaps of 50 µm, dashpots and friction at the radius of the tube.
//! The frame shakes along x and y, and the rod is free in the gaps. Closed solution: the balance of energy and of momentum over the
//! record, with hundreds of impacts, slips and sticks; for the springs and dashpots of the stops and, in a shorter record, for each
//! exact law in their place. Reference: none is needed; the work of friction and of the stops counted contact by
//! contact is that of the balance.
//!
//! Tolerance: 1e-9 of the input work over the whole record, the bound for linear bodies: each step is solved to
//! rounding, and rounding of 1e5 steps adds up to their square root times 1e-16, or to 1e-11 at worst. With springs and dashpots the
//! rod has no damping. With an exact law it is damped as that of the case: rounding is that of the largest energy, and the exact gap
//! under Newmark's scheme makes energy (without damping the residual of the quick size was 3e-8 of the input). The sums by contact:
//! the same numbers in another order, 1e-9. It is a check of the balances, so the mesh is coarse; where impacts are counted, many
//! must be there or nothing is checked.

use std::f64::consts::{PI, TAU};

use carom_bodies::{BeamSection, BeamTheory, Kinematics, SectionShape};
use carom_contact::law::{Capture, Displacement, Reading, Restitution, Velocity};
use carom_contact::{Initial, Law, Plane};
use carom_dynamics::{Driver, Model, ModelContact, ModelTarget, Scheme};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};
use carom_signals::Amplitude;
use carom_system::Damping;

use crate::Error;
use crate::beams::held;
use crate::build::{body, newmark, theta};
use crate::check::{Check, Row, Size};
use crate::points::spring_stop;

/// Zirconium alloy with the density of tube, pellets and displaced water over the section of the tube.
const CLAD: Elastic = Elastic {
    density: 41_300.0,
    young: 75e9,
    poisson: 0.37,
};
const LENGTH: f64 = 3.85;
const ELEMENTS: usize = 77;
const RADIUS: f64 = 4.572e-3;
const WALL: f64 = 0.5715e-3;
const GAP: f64 = 50e-6;
const FRICTION: f64 = 0.3;
/// Stiffness (N/m) and dashpot (N s/m) of the springs and of the dimples.
const STOPS: [[f64; 2]; 2] = [[150e3, 5.0], [500e3, 15.0]];
/// Factor of the stiffness in the damping of the rod under an exact law, s.
const DAMPING: f64 = 1e-4;
/// Harmonics of the motion of the frame: frequency in Hz, acceleration in m/s².
const MOTION: [[f64; 2]; 4] = [[1.3, 1.0], [3.1, 2.0], [7.7, 2.0], [15.9, 1.0]];

/// An acceleration that rises and decays over `end` s; `late` shifts its phases.
fn motion(end: f64, late: f64) -> Result<Amplitude, Error> {
    let count = (200.0 * end) as usize;
    let at = |k: usize| {
        let t = end * k as f64 / count as f64;
        let sum: f64 = MOTION
            .iter()
            .map(|[f, a]| a * (TAU * f * (t + late)).sin())
            .sum();
        [t, sum * (PI * t / end).sin().powi(2)]
    };
    Ok(Amplitude::new((0..=count).map(at).collect())?)
}

/// The rod; `law`: that of all stops, in place of their springs and dashpots.
pub(crate) fn model(scheme: Scheme, law: Option<Law>, dt: f64, end: f64) -> Result<Model, Error> {
    let shape = SectionShape::Tube {
        diameter: 2.0 * RADIUS,
        thickness: WALL,
    };
    let section = BeamSection {
        orientation: Some([1.0, 0.0, 0.0]),
        offset: [0.0; 2],
        radius: Some(RADIUS),
        ..BeamSection::new(BeamTheory::EulerBernoulli, shape.properties(CLAD.poisson))
    };
    let mesh = generate::line("rod", [0.0; 3], [0.0, 0.0, LENGTH], ELEMENTS, 3);
    let mut rod = body(&mesh, "rod", Kinematics::Beam(section), CLAD)?;
    rod.mass = carom_bodies::MassKind::Lumped;
    let mut contacts = Vec::new();
    for grid in 0..8 {
        for direction in 0..2 {
            for (place, kind, sign) in [(1, 0, 1.0), (0, 1, -1.0), (2, 1, -1.0)] {
                let node = 10 * grid + place;
                let mut axis = [0.0; 3];
                axis[direction] = sign;
                let name = format!("g{grid}-{direction}-{place}");
                let law = match law {
                    Some(law) => law,
                    None => spring_stop(STOPS[kind][0], STOPS[kind][1])?,
                };
                contacts.push(stop(&name, (node, &mesh, &rod.spec.cells), axis, law));
            }
        }
    }
    let mut model = Model {
        contacts,
        supports: vec![held(vec![0], [false, false, true], [false, false, true])],
        ..Model::new(vec![rod], mesh, scheme, dt)
    };
    if law.is_some() {
        model.nonlinear.damping = vec![Damping {
            mass: 0.0,
            stiffness: DAMPING,
        }];
    }
    model.nonlinear.base = [Some(motion(end, 0.0)?), Some(motion(end, 0.37)?), None];
    Ok(model)
}

fn stop(
    name: &str,
    (node, mesh, cells): (u32, &carom_mesh::Mesh, &[carom_mesh::ElementId]),
    axis: [f64; 3],
    law: Law,
) -> ModelContact {
    let cell = cells[(node as usize).min(cells.len() - 1)];
    let mut points = Surface::of_points(&[(node, cell)], axis);
    for face in &mut points.faces {
        face.radius = Some(RADIUS);
    }
    let target = ModelTarget::rigid(Plane {
        point: mesh.nodes[node as usize],
        normal: axis.map(|n| -n),
    });
    ModelContact {
        initial: Initial::Gap(GAP),
        friction: FRICTION.into(),
        ..ModelContact::new(name, points, target, law)
    }
}

fn rows(scheme: Scheme, law: Option<Law>, [dt, end]: [f64; 2]) -> Result<Vec<Row>, Error> {
    let mut driver = Driver::new(crate::witness::system(model(scheme, law, dt, end)?)?)?;
    let mut input = 0.0_f64;
    let mut before = 0.0;
    let steps = (end / dt).round() as usize;
    for _ in 0..steps {
        driver.step()?;
        let work = driver.report().balance.work_loads;
        input += (work - before).abs();
        before = work;
    }
    let (state, balance) = (driver.state(), &driver.report().balance);
    let impacts = state.records.ended().count();
    let records = &state.records.contacts;
    let lost: f64 = records.iter().map(|record| record.friction_loss()).sum();
    let of = law.map_or("stop", |law| law.get().name());
    let name = |what: &str| format!("{}, {of} law: {what}", scheme.get().name());
    let ledger = &state.ledger;
    Ok(vec![
        Row::at_least(name("impacts"), impacts as f64, 50.0 * end),
        Row::at_most(
            name("largest energy residual / input work"),
            ledger.largest_energy_residual / input,
            1e-9,
        ),
        Row::at_most(
            name("largest momentum residual / largest momentum"),
            ledger.largest_momentum_residual / ledger.largest_momentum,
            1e-9,
        ),
        Row::near(
            name("friction of the contacts / that of the balance"),
            lost / balance.dissipation_friction,
            1.0,
            1e-9,
        ),
        Row::at_least(
            name("friction / input work"),
            balance.dissipation_friction / input,
            0.01,
        ),
    ])
}

/// The exact laws that a stop may have.
fn exact() -> [Law; 3] {
    let capture = Capture::Half;
    [
        Law::Displacement(Displacement { projection: false }),
        Law::Velocity(Velocity {
            capture,
            reading: Reading::Closed,
        }),
        Law::Restitution(Restitution {
            coefficient: 0.5,
            capture,
        }),
    ]
}

pub(crate) const CHECK: Check = Check {
    name: "rod-in-grid",
    fact: "a rod knocks and rubs in 48 stops through a record: energy balances to 1e-9 of the input work, momentum to rounding",
    run: |size| {
        // step and record of the stops, and of the exact laws
        let (compliant, exactly) = match size {
            Size::Quick => ([2e-4, 0.3], [2e-4, 0.2]),
            Size::Full => ([1e-4, 4.0], [1e-4, 0.4]),
        };
        let mut all = Vec::new();
        for scheme in [newmark(0.25, 0.5), theta(0.5)] {
            all.extend(rows(scheme, None, compliant)?);
            for law in exact() {
                all.extend(rows(scheme, Some(law), exactly)?);
            }
        }
        Ok(all)
    },
};
