//! Two buildings that knock against each other: balances, threads and cuts.
//!
//! Problem: stick models of five and of three storeys, a mass of 100 t on a spring in shear for each floor, dashpots on the ground, stops between floors of the
//! same height, one record of the ground of 10 Hz and 1.3 Hz in turns. Closed solution: the balances; and as sums have a fixed order and a state holds all that
//! the next step needs, the same bytes on any number of threads, cut or not. Reference: none is needed.
//!
//! Tolerance: 1e-11 of the largest energy and momentum, rounding. Bytes are equal or not. Impacts must be there.

use std::sync::Arc;

use carom_bodies::Curve;
use carom_dynamics::{Amplitude, Driver, Model, System};

use crate::Error;
use crate::battery::Battery;
use crate::build::newmark;
use crate::check::{Check, Row, Size};
use crate::points::{Point, Points, balances};
use crate::resume::cuts;
use crate::threads::{pool, run};

const X: [f64; 3] = [1.0, 0.0, 0.0];
const MASS: f64 = 1e5;
const STEP: f64 = 1e-3;

fn model(end: f64) -> Result<Model, Error> {
    let mut points = Points::new(1);
    let mut building = |floors: usize, stiffness: f64| {
        let mut all: Vec<Point> = Vec::new();
        for _ in 0..floors {
            let floor = points.mass(MASS, [0.0; 3], [[0.0; 3]; 2]);
            match all.last() {
                None => points.spring(floor, X, Curve::line(stiffness)),
                Some(below) => points.between([*below, floor], X, Curve::line(stiffness)),
            }
            points.dashpot(floor, 4e4);
            all.push(floor);
        }
        all
    };
    let (tall, low) = (building(5, 6e7), building(3, 2e8));
    for (one, other) in tall.iter().zip(&low) {
        points.stop((*one, Some(*other)), X, 0.02, [5e8, 2e6])?;
    }
    let mut model = points.model(newmark(0.25, 0.5), STEP);
    let count = (end / 0.01).ceil() as usize;
    let at = |k: usize| {
        let t = 0.01 * k as f64;
        [t, 4.0 * (8.2 * t).sin() + 2.0 * (63.0 * t).sin()]
    };
    model.nonlinear.base[0] = Some(Amplitude::new((0..=count).map(at).collect())?);
    Ok(model)
}

pub(crate) const CHECK: Check = Check {
    name: "pounding",
    fact: "two buildings knock against each other through a record: balances; the same bytes on any number of threads, cut or not",
    run: |size| {
        let (steps, whole) = match size {
            Size::Quick => (1000, 4000),
            Size::Full => (4000, 20_000),
        };
        let mut driver = Driver::new(crate::witness::system(model(whole as f64 * STEP)?)?)?;
        for _ in 0..whole {
            driver.step()?;
        }
        let impacts = driver.state().records.ended().count() as f64;
        let mut rows = vec![Row::at_least("impacts", impacts, 5.0)];
        rows.extend(balances("two buildings", driver.state(), 0.0));
        let mut battery = Battery::default();
        let [one, two] = [pool(1)?, pool(2)?];
        let given = model(steps as f64 * STEP)?;
        let again = given.clone();
        let system: Arc<System> = one.install(|| crate::witness::system(given))?;
        let second = two.install(|| crate::witness::system(again))?;
        battery.compare(&run(&one, &system, steps)?, &run(&two, &second, steps)?)?;
        let quarters = [1, 2, 3].map(|part| part * steps / 4);
        let places = [1, quarters[0], quarters[1], quarters[2]];
        cuts(&mut battery, &system, (steps, places))?;
        rows.extend(battery.rows("threads and cuts", 5));
        Ok(rows)
    },
};
