//! An elastic bar dropped under gravity.
//!
//! Problem: E = 900, ρ = 1, L = 10, A = 1, dropped from 5 above a rigid plane with g = 10 (c = 30, 2L/c = 0.667): the first
//! impact at 1 s with 10 m/s. Reference: the exact delay recursion (carom_exact), in which the bar keeps its energy but
//! not its rigid motion: waves stay in it from one bounce to the next. The scheme, theta ½ with the velocity law, leaves
//! each contact a little late and slow, as its front is spread: in theory by n^-2/3 (see the convergence of two bars). The first
//! closing, after free fall, comes within the step in which the law looks half a step ahead. The others and the impulse of all
//! bounces are shown; the largest error of a closing must fall from one mesh to the other by n^-1/2 at least, three quarters of the
//! exponent. The residual of the energy: 1e-11 m g h, as for every run.
//! Sizes: quick n = 50 and 100, five bounces, since waves of the last bounce decide the next and coarse meshes lose them; full
//! 100 and 400, eight.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::Plane;
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, march};
use carom_exact::{Bar, Impact};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};

use crate::Error;
use crate::build::{HALF, group, theta};
use crate::check::{Check, Row, Size};

/// Length of the bar, m.
const LENGTH: f64 = 10.0;

/// Height of the fall, m.
const HEIGHT: f64 = 5.0;

/// Gravity, m/s².
const GRAVITY: f64 = 10.0;

pub(crate) const CHECK: Check = Check {
    name: "bar-dropped",
    fact: "the bounces of a dropped elastic bar come when the exact recursion says, the more so the finer the mesh",
    run: |size| {
        let ([coarse, fine], count) = match size {
            Size::Quick => ([50, 100], 5),
            Size::Full => ([100, 400], 8),
        };
        let (mut rows, before) = bounces(coarse, count)?;
        let (found, error) = bounces(fine, count)?;
        rows.extend(found);
        rows.push(Row::at_most(
            format!("largest error of a closing, n = {fine} / n = {coarse}"),
            error / before,
            (coarse as f64 / fine as f64).sqrt(),
        ));
        Ok(rows)
    },
};

/// Rows of one mesh, and the largest error of a closing, s.
fn bounces(elements: usize, count: usize) -> Result<(Vec<Row>, f64), Error> {
    let material = Elastic {
        density: 1.0,
        young: 900.0,
        poisson: 0.0,
    };
    let bar = Bar::new(LENGTH, 1.0, material.young, material.density).with_gravity(GRAVITY);
    let exact = carom_exact::solve(&Impact::Wall { bar, gap: HEIGHT }, 40.0)?;
    let contacts = &exact.contacts()[..count];
    let end = 0.5 * (contacts[count - 1].end + exact.contacts()[count].start);
    let impulse: f64 = contacts.iter().map(|contact| contact.impulse).sum();
    let mut driver = driver(elements, material)?;
    march(&mut driver, end, &mut [], &|| false)?;
    let state = driver.state();
    let impacts = state.impacts(driver.system());
    let row = |what: &str| format!("n = {elements}: {what}");
    let (mut rows, mut largest) = (Vec::new(), 0.0_f64);
    for (k, contact) in contacts.iter().enumerate() {
        // chatter may split a contact: its first impact is the first one from the middle of the flight before it on
        let flight = if k == 0 {
            0.0
        } else {
            0.5 * (contacts[k - 1].end + contact.start)
        };
        let start = impacts
            .iter()
            .map(|impact| impact.start)
            .find(|start| *start > flight)
            .unwrap_or(f64::NAN);
        if k == 0 {
            rows.push(Row::near(
                row("closing 1, s"),
                start,
                contact.start,
                driver.system().dt,
            ));
            continue;
        }
        let error = start - contact.start;
        largest = if error.is_nan() {
            error
        } else {
            largest.max(error.abs())
        };
        rows.push(Row::shown(
            row(&format!("closing {}, late by, s", k + 1)),
            error,
        ));
    }
    let found = state.records.contacts[0].impulse();
    rows.push(Row::shown(
        row("impulse of all bounces / exact"),
        found / impulse,
    ));
    let ledger = &state.ledger;
    let residual = ledger.largest_energy_residual / (LENGTH * GRAVITY * HEIGHT);
    rows.push(Row::at_most(
        row("energy residual / m g h"),
        residual,
        1e-11,
    ));
    Ok((rows, largest))
}

fn driver(elements: usize, material: Elastic) -> Result<Driver, Error> {
    let mesh = generate::line(
        "bar",
        [HEIGHT, 0.0, 0.0],
        [HEIGHT + LENGTH, 0.0, 0.0],
        elements,
        1,
    );
    let cells = group(&mesh, "bar")?.elements.clone();
    let model = Model {
        gravity: [-GRAVITY, 0.0, 0.0],
        contacts: vec![ModelContact::new(
            "ground",
            Surface::new(&mesh, group(&mesh, "bar.left")?, &cells)?,
            ModelTarget::rigid(Plane {
                point: [0.0; 3],
                normal: [1.0, 0.0, 0.0],
            }),
            HALF,
        )],
        ..Model::new(
            vec![ModelBody::new(BodySpec::new(
                "bar",
                cells.clone(),
                Kinematics::Bar { area: 1.0 },
                material,
            ))],
            mesh,
            theta(0.5),
            0.5 * LENGTH / elements as f64 / 30.0,
        )
    };
    Ok(Driver::new(crate::witness::system(model)?)?)
}
