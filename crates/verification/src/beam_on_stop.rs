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
//! decides, which both have alike. The cantilever in two zones, its last fifth in ten steps to one of the rest, tied in place and
//! rotation: the same bounds. Balances: round-off.

use carom_arlequin::trace;
use carom_bodies::{BeamTheory, Kinematics, MassKind};
use carom_contact::law::{Adhesion, Crush, Curve, Stop};
use carom_contact::{Initial, Law, Plane};
use carom_dynamics::{
    Driver, Model, ModelBody, ModelContact, ModelLink, ModelTarget, Scheme, Stepper, Support,
    System,
};
use carom_exact::beam_on_stop::BeamOnStop;
use carom_mesh::{Mesh, Surface, generate};
use carom_zones::{LinkKind, ModelZone, Whole, Zoned};

use crate::Error;
use crate::beams::{STEEL, exact, held, section, straight};
use crate::build::{body, newmark, theta};
use crate::check::{Check, Row, Size};
use crate::points::{Point, balances};

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
    let numbers = [stiffness, gap, period];
    let mut found = vec![(String::new(), run(place, elements, steps, numbers)?)];
    if place.is_cantilever() {
        let run = in_zones(elements, steps, numbers)?;
        found.push((", in two zones".to_string(), run));
    }
    for (how, (forces, state)) in found {
        let found = totals(&forces, period / forces.len() as f64);
        for k in 0..2 {
            let name = format!("{}{how}: {}", place.name, names[k]);
            rows.push(Row::relative(name, found[k], fine[k], 1e-2));
        }
        rows.extend(balances(&format!("{}{how}", place.name), &state, 0.0));
    }
    Ok(rows)
}

impl Place {
    fn is_cantilever(&self) -> bool {
        self.deflection == 1.0 / 8.0
    }
}

type Run = (Vec<f64>, carom_dynamics::State);

/// The beam from the left to the right, with a node of it over the stop: mesh, bodies, place of the stop.
fn model(
    (mesh, bodies): (Mesh, Vec<ModelBody>),
    (last, supports): (Point, Vec<Support>),
    [stiffness, gap]: [f64; 2],
    (scheme, dt): (Scheme, f64),
) -> Result<Model, Error> {
    let law = Law::Stop(Stop {
        clearance: 0.0,
        curve: Curve::new(&[[1.0, stiffness]])?,
        crush: Crush::Recovered,
        damping: 0.0,
        adhesion: Adhesion::Clip,
    });
    let down = [0.0, -1.0, 0.0];
    let target = ModelTarget::rigid(Plane {
        point: mesh.nodes[last.0 as usize],
        normal: [0.0, 1.0, 0.0],
    });
    let points = Surface::of_points(&[last], down);
    let stop = ModelContact {
        initial: Initial::Gap(gap),
        ..ModelContact::new("stop", points, target, law)
    };
    Ok(Model {
        supports,
        gravity: down.map(|n| n * GRAVITY),
        contacts: vec![stop],
        ..Model::new(bodies, mesh, scheme, dt)
    })
}

/// Forces of the stop at the ends of the steps.
fn run(
    place: &Place,
    elements: usize,
    steps: usize,
    [stiffness, gap, period]: [f64; 3],
) -> Result<Run, Error> {
    let section = section(HEIGHT, BeamTheory::EulerBernoulli);
    let ends = [[0.0; 3], [LENGTH, 0.0, 0.0]];
    let (mesh, body) = straight(ends, elements, 2, section)?;
    let (last, supports) = match place.is_cantilever() {
        true => (elements, clamp()),
        false => {
            let both = vec![0, elements as u32];
            (elements / 2, held(both, [true; 3], [false; 3]))
        }
    };
    let point = (last as u32, body.spec.cells[last - 1]);
    let time = (newmark(0.25, 0.5), period / steps as f64);
    let held = (point, vec![supports]);
    let model = model((mesh, vec![body]), held, [stiffness, gap], time)?;
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    history(&mut driver, steps)
}

/// The cantilever in two zones: its last fifth takes the steps of the single one, the rest takes one in ten of them.
fn in_zones(
    elements: usize,
    steps: usize,
    [stiffness, gap, period]: [f64; 3],
) -> Result<Run, Error> {
    let section = section(HEIGHT, BeamTheory::EulerBernoulli);
    let (border, head) = (0.8 * LENGTH, elements / 5);
    let line = |name: &str, from: f64, to: f64, elements: usize| {
        generate::line(name, [from, 0.0, 0.0], [to, 0.0, 0.0], elements, 2)
    };
    let mut mesh = line("foot", 0.0, border, elements - head);
    mesh.merge("head", line("head", border, LENGTH, head))?;
    let beam = |name: &str| -> Result<ModelBody, Error> {
        let mut made = body(&mesh, name, Kinematics::Beam(section), STEEL)?;
        made.mass = MassKind::Consistent;
        Ok(made)
    };
    let bodies = vec![beam("foot")?, beam("head")?];
    let nodes = |name: &str| mesh.group_nodes(&mesh.groups[name]);
    let links = trace(&mesh, &nodes("head"), &nodes("foot"), 1e-9)?.with_rotations(2);
    let zone = |body: usize, substeps: u32| {
        ModelZone::new(
            bodies[body].spec.name.clone(),
            vec![body],
            (theta(0.5), substeps),
        )
    };
    let zones = vec![zone(0, 1), zone(1, INNER as u32)];
    let last = bodies[1].spec.cells[head - 1];
    let held = ((nodes("head.right")[0], last), vec![clamp()]);
    let time = (theta(0.5), period / steps as f64 * INNER as f64);
    let numbers = [stiffness, gap];
    let model = model((mesh, bodies), held, numbers, time)?;
    let whole = System::whole(model.clone())?;
    let joint = ModelLink {
        name: "joint".to_string(),
        zones: [1, 0],
        rows: links.rows,
    };
    let zoned = Zoned {
        zones,
        links: vec![joint],
        kind: LinkKind::PrakashHjelmstad,
        model,
    };
    history(&mut Whole::new(&zoned, whole)?, steps / INNER)
}

/// Inner steps in one of the foot.
const INNER: usize = 10;

fn clamp() -> Support {
    held(vec![0], [true; 3], [true; 3])
}

fn history(stepper: &mut impl Stepper, steps: usize) -> Result<Run, Error> {
    let mut forces = Vec::new();
    for _ in 0..steps {
        stepper.step()?;
        forces.push(stepper.report().contacts[0].force);
    }
    Ok((forces, stepper.state().clone()))
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
