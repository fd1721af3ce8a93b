//! A beam that falls on a stop.
//!
//! Problem: a steel beam of Euler-Bernoulli, L = 1 m, 2 cm high, under its weight from rest and straight, falls on a stop: a cantilever on
//! a stop at its tip, g = half of its static deflection, k = 100 times 3 E I/L³; a simply supported beam on a stop at mid-span, g =
//! half of its static deflection, k = 100 times 48 E I/L³. The run has the length of one period of the beam and has several
//! contacts. Reference: a sum of exact modes (`carom_exact::beam_on_stop`), whose convergence is shown: 20 and 40 modes, and half
//! the step.
//!
//! Tolerances: the reference changes by less than 2e-3 between 20 and 40 modes and with half its step, and the model is within 1 %
//! of it, peak of the force and impulse, with 40 elements; of the third to fifth contact the order of impacts of the higher modes
//! decides, which both have alike. Balances: round-off.

use carom_bodies::BeamTheory;
use carom_contact::law::{Adhesion, Crush, Curve, Stop};
use carom_contact::{Initial, Law, Plane};
use carom_dynamics::{Driver, Model, ModelContact, ModelTarget, Support, System};
use carom_exact::beam_on_stop::BeamOnStop;
use carom_mesh::Surface;

use crate::Error;
use crate::beams::{exact, held, section, straight};
use crate::build::newmark;
use crate::check::{Check, Row, Size};
use crate::points::balances;

const LENGTH: f64 = 1.0;
const HEIGHT: f64 = 0.02;
const GRAVITY: f64 = 9.81;

/// A way to hold the beam and its stop.
struct Place {
    name: &'static str,
    /// Stiffness of the beam where the stop is, in E I/L³, and static deflection there, in m a L⁴/(E I).
    stiffness: f64,
    deflection: f64,
    reference: fn([f64; 3], f64, [f64; 2], usize) -> BeamOnStop,
}

const PLACES: [Place; 2] = [
    Place {
        name: "cantilever, stop at the tip",
        stiffness: 3.0,
        deflection: 1.0 / 8.0,
        reference: BeamOnStop::cantilever,
    },
    Place {
        name: "simply supported, stop at mid-span",
        stiffness: 48.0,
        deflection: 5.0 / 384.0,
        reference: BeamOnStop::simply_supported,
    },
];

/// Largest force, and sum of forces times the step.
fn totals(forces: &[f64], dt: f64) -> [f64; 2] {
    let peak = forces.iter().copied().fold(0.0, f64::max);
    [peak, forces.iter().sum::<f64>() * dt]
}

fn rows(place: &Place, elements: usize, steps: usize) -> Result<Vec<Row>, Error> {
    let section = section(HEIGHT, BeamTheory::EulerBernoulli);
    let beam = exact(LENGTH, &section, 0);
    let gap = 0.5 * place.deflection * beam.mass * GRAVITY * LENGTH.powi(4) / beam.bending;
    let stiffness = 100.0 * place.stiffness * beam.bending / LENGTH.powi(3);
    let given = [beam.bending, beam.mass, LENGTH];
    let reference = |modes| (place.reference)(given, GRAVITY, [stiffness, gap], modes);
    let period = 2.0 * std::f64::consts::PI / reference(1).lowest();
    let history = |modes, steps: usize| {
        let dt = period / steps as f64;
        totals(&reference(modes).forces(dt, steps), dt)
    };
    let fine = history(40, 40_000);
    let mut rows = Vec::new();
    let names = ["peak force, N", "impulse, N s"];
    for (other, how) in [
        (history(20, 40_000), "20 modes"),
        (history(40, 20_000), "twice the step"),
    ] {
        for k in 0..2 {
            let name = format!("{}: reference with {how}: {}", place.name, names[k]);
            rows.push(Row::relative(name, other[k], fine[k], 2e-3));
        }
    }
    let (forces, state) = run(place, elements, steps, [stiffness, gap, period])?;
    let found = totals(&forces, period / steps as f64);
    for k in 0..2 {
        let name = format!("{}: {}", place.name, names[k]);
        rows.push(Row::relative(name, found[k], fine[k], 1e-2));
    }
    rows.extend(balances(place.name, &state, 0.0));
    Ok(rows)
}

/// Forces of the stop at the ends of the steps.
fn run(
    place: &Place,
    elements: usize,
    steps: usize,
    [stiffness, gap, period]: [f64; 3],
) -> Result<(Vec<f64>, carom_dynamics::State), Error> {
    let section = section(HEIGHT, BeamTheory::EulerBernoulli);
    let ends = [[0.0; 3], [LENGTH, 0.0, 0.0]];
    let (mesh, body) = straight(ends, elements, 2, section)?;
    let clamped = place.deflection == 1.0 / 8.0;
    let (last, supports): (u32, Vec<Support>) = match clamped {
        true => (elements as u32, vec![held(vec![0], [true; 3], [true; 3])]),
        false => {
            let both = vec![0, elements as u32];
            (elements as u32 / 2, vec![held(both, [true; 3], [false; 3])])
        }
    };
    let cell = body.spec.cells[last as usize - 1];
    let law = Law::Stop(Stop {
        clearance: 0.0,
        curve: Curve::new(&[[1.0, stiffness]])?,
        crush: Crush::Recovered,
        damping: 0.0,
        adhesion: Adhesion::Clip,
    });
    let down = [0.0, -1.0, 0.0];
    let target = ModelTarget::rigid(Plane {
        point: mesh.nodes[last as usize],
        normal: [0.0, 1.0, 0.0],
    });
    let points = Surface::of_points(&[(last, cell)], down);
    let stop = ModelContact {
        initial: Initial::Gap(gap),
        ..ModelContact::new("stop", points, target, law)
    };
    let system = System::new(Model {
        supports,
        gravity: down.map(|n| n * GRAVITY),
        contacts: vec![stop],
        ..Model::new(vec![body], mesh, newmark(0.25, 0.5), period / steps as f64)
    })?;
    let mut driver = Driver::new(system)?;
    let mut forces = Vec::new();
    for _ in 0..steps {
        driver.step()?;
        forces.push(driver.report().contacts[0].force);
    }
    Ok((forces, driver.state().clone()))
}

pub(crate) const CHECK: Check = Check {
    name: "beam-on-stop",
    fact: "a beam on a stop at its tip or at mid-span has the peak force and the impulse of a modal solution that has converged",
    run: |size| {
        let (elements, steps) = match size {
            Size::Quick => (20, 8_000),
            Size::Full => (40, 40_000),
        };
        let mut all = Vec::new();
        for place in &PLACES {
            all.extend(rows(place, elements, steps)?);
        }
        Ok(all)
    },
};
