//! The public test "sdnl111" with bars.
//!
//! Problem: two bars of 1 m and 4e-4 m² with the confined modulus of E = 2e11 Pa, ν = 0.3, ρ = 7800 kg/m³; the striker at 1 m/s,
//! 1e-5 m from the target, which is clamped at its far end. Theta ½, velocity law, CFL 0.5, lumped mass, n elements in each bar.
//! Closed solution: carom_exact; displacement of the striker's contact end against its motion at five instants, mean force
//! over the contact without its first and last tenth. Reference: the project's table of an independent program: errors in per
//! cent. Tolerance: a unit of the last digit. The table does not say over which time its mean force is taken: over the
//! whole contact the width of the front at its end counts (0.57, 0.36, 0.25 %), without its ends nothing is left, so that
//! the table is a bound. Sizes: quick n = 100, full also 200 and 400.

use carom_bodies::Kinematics;
use carom_dynamics::{Driver, Model, ModelTarget};
use carom_exact::{Bar, Impact, constrained_modulus, solve};
use carom_materials::Elastic;
use carom_mesh::generate;

use crate::Error;
use crate::build::{HALF, body, contact, support, surface, theta};
use crate::check::{Check, Row, Size};
use crate::kind::Kind;

const LENGTH: f64 = 1.0;
const AREA: f64 = 4e-4;
const DENSITY: f64 = 7800.0;
const GAP: f64 = 1e-5;
const SPEED: f64 = 1.0;
const INSTANTS: [f64; 5] = [2e-4, 4e-4, 6e-4, 8e-4, 1e-3];

/// Elements, errors at the instants and of the mean force, %.
const TABLE: [(usize, [&str; 5], f64); 3] = [
    (100, ["0.3", "0.5", "1.8", "3.0", "1.0"], 0.1),
    (200, ["0.2", "0.5", "1.2", "1.9", "0.6"], 0.03),
    (400, ["0.05", "0.1", "0.3", "0.9", "0.3"], 0.005),
];

fn model(elements: usize, young: f64) -> Result<Model, Error> {
    let line = |name: &str, from: f64| {
        generate::line(
            name,
            [from, 0.0, 0.0],
            [from + LENGTH, 0.0, 0.0],
            elements,
            1,
        )
    };
    let mut mesh = line("striker", -LENGTH - GAP);
    mesh.merge("target", line("target", 0.0))?;
    let steel = Elastic {
        density: DENSITY,
        young,
        poisson: 0.0,
    };
    let bar = |name: &str| body(&mesh, name, Kinematics::Bar { area: AREA }, steel);
    let (mut striker, target) = (bar("striker")?, bar("target")?);
    striker.velocity[0] = SPEED;
    let secondary = surface(&mesh, "striker.right", &striker)?;
    let primary = ModelTarget::Surface(surface(&mesh, "target.left", &target)?);
    Ok(Model {
        contacts: vec![contact(secondary, primary, HALF)],
        supports: vec![support(&mesh, "target.right", [true; 3])?],
        ..Model::new(
            vec![striker, target],
            mesh,
            theta(0.5),
            0.5 * LENGTH / elements as f64 / (young / DENSITY).sqrt(),
        )
    })
}

fn rows((elements, errors, mean_error): (usize, [&str; 5], f64)) -> Result<Vec<Row>, Error> {
    let young = constrained_modulus(2e11, 0.3);
    let bar = Bar::new(LENGTH, AREA, young, DENSITY);
    let exact = solve(
        &Impact::TwoBars {
            secondary: bar.with_velocity(-SPEED),
            primary: bar.clamped(),
            gap: GAP,
        },
        2e-3,
    )?;
    let system = crate::witness::system(model(elements, young)?)?;
    let node = system.contacts[0].points[0].node() as usize;
    let mut driver = Driver::new(system)?;
    let (mut rows, mut last) = (Vec::new(), (0.0, 0.0));
    let span = exact.contacts()[0];
    let mut impulses: Vec<(f64, f64)> = Vec::new();
    while driver.state().time < span.end.max(INSTANTS[4]) {
        driver.step()?;
        let state = driver.state();
        let now = (state.time, state.motion.u[node]);
        if let Some(&instant) = INSTANTS.get(rows.len())
            && now.0 >= instant
        {
            let found = last.1 + (now.1 - last.1) * (instant - last.0) / (now.0 - last.0);
            // the striker's own axis points away from the contact
            let expected = -exact.motions()[0].displacement(0.0, instant);
            let printed = errors[rows.len()];
            let name = format!("n = {elements}: error at {instant:.0e} s, %");
            let error = 100.0 * (found / expected - 1.0).abs();
            rows.push(Row::printed(Kind::OtherCode, name, error, printed));
        }
        let duration = span.end - span.start;
        if (0.1..=0.9).contains(&((now.0 - span.start) / duration)) {
            impulses.push((now.0, state.records.contacts[0].impulse()));
        }
        last = now;
    }
    let mean = match (impulses.first(), impulses.last()) {
        (Some(first), Some(last)) => (last.1 - first.1) / (last.0 - first.0),
        _ => f64::NAN,
    };
    let error = 100.0 * (mean / span.peak_force - 1.0).abs();
    let name = format!("n = {elements}: error of the mean force, %");
    rows.push(Row::at_most(name, error, mean_error).other_code());
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "sdnl111-bars",
    fact: "bars in the place of the two beams err as in the table",
    run: |size| {
        let count = match size {
            Size::Quick => 1,
            Size::Full => TABLE.len(),
        };
        let all = TABLE[..count].iter().map(|line| rows(*line));
        Ok(all.collect::<Result<Vec<_>, _>>()?.concat())
    },
};
