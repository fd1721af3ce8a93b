//! Oscillators and frames whose supports move.
//!
//! Problems: (a) an oscillator, 1 Hz, damping ratio 2 %, under the base acceleration A sin Ωt, Ω = 0.7 ω, and under a tabulated
//! record with 50 points per second; (b) three equal masses in a row, with equal springs between them and to two supports, which
//! move differently, A (1 - cos Ωt) with two amplitudes and frequencies; (c) a chain of three masses that hangs on one support and
//! meets a stop at the other, both supports under one record: as motion of the supports, and as base acceleration in the relative
//! frame; (d) the same of a bar with consistent mass; (e) a mass that falls on a floor under gravity, and in a frame that is
//! accelerated upwards, by every scheme with each kind of contact law.
//!
//! Closed solutions: (a) transient and steady oscillation; of the record the exact recursion of Nigam and Jennings (1969). (b) sum
//! over the modes ω_j = 2 √(k/m) sin(j π/8), φ_j(i) = sin(i j π/4). (c), (d), (e) the other formulation.
//!
//! Tolerances: (a), (b) 1e-6 of the largest displacement. The trapezoidal rule is exact for what is linear in time; it lengthens a
//! period by x²/12, x = ω Δt, so the phase is wrong by ω t x²/12 and amplitudes by less than x²: the step is chosen so that (ω T/12 + 1) x²
//! is 5e-7 for the fastest motion. (c), (d) 1e-8: the second difference of the exact displacement is the mean acceleration that
//! the trapezoidal rule takes, except at the points of the record (h apart), where a change of slope s makes the acceleration of
//! a step differ by s Δt/12: the part (Δt/h)²/12 of an impulse of the record. The bar with h = 8192 Δt: 1.2e-9 for each of at
//! most five points. The chain with h = 65536 Δt: 1.9e-11 for each point; the force of the stop has a penetration that is some tenth
//! of the displacement, and impacts may amplify it tenfold, 1e-8. That it is this difference and no other: it falls with Δt², to a
//! quarter at half the step, within 5 %. (e) 1e-12 of the largest displacement: the same forces. Balances: round-off.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use carom_bodies::{Curve, Kinematics, MassKind};
use carom_contact::law::Level;
use carom_contact::{Law, Plane};
use carom_dynamics::{
    Amplitude, Driver, Model, ModelBody, ModelTarget, Prescribed, Scheme, Support,
};
use carom_materials::Elastic;
use carom_mesh::generate;
use carom_signals::{Oscillator, Record};

use crate::Error;
use crate::build::{DISPLACEMENT, NOW, body, newmark};
use crate::check::{Check, Row, Size};
use crate::points::{Points, balances};

const X: [f64; 3] = [1.0, 0.0, 0.0];
const REST: [[f64; 3]; 2] = [[0.0; 3]; 2];

/// Steps of equal size to `end` for which the trapezoidal rule meets 5e-7 at the circular frequency `omega`.
fn fine_steps(omega: f64, end: f64) -> f64 {
    let x = (5e-7 / (omega * end / 12.0 + 1.0)).sqrt();
    (end * omega / x).ceil()
}

/// A record with points `h` apart that begins and ends with zero.
fn record(h: f64, count: usize) -> Result<Record, Error> {
    let a = |k: f64| 3.0 * (2.1 * k).sin() + 2.0 * (0.7 * k * k).sin();
    let inside = |k: usize| if k == count { 0.0 } else { a(k as f64) };
    let points = (0..=count).map(|k| [h * k as f64, inside(k)]);
    Ok(Record::new(points.collect())?)
}

const OSCILLATOR: Oscillator = Oscillator {
    omega: TAU,
    damping: 0.02,
};

/// Largest distance of displacement and absolute acceleration from `exact`, over the largest exact values, and the balances.
fn oscillator(
    name: &str,
    (base, dt, steps): (Amplitude, f64, usize),
    exact: impl Fn(usize) -> Option<[f64; 2]>,
) -> Result<Vec<Row>, Error> {
    let Oscillator { omega, damping } = OSCILLATOR;
    let mut points = Points::new(1);
    let mass = points.mass(2.0, [0.0; 3], REST);
    points.spring(mass, X, Curve::line(2.0 * omega * omega));
    points.dashpot(mass, 2.0 * 2.0 * damping * omega);
    let mut model = points.model(newmark(0.25, 0.5), dt);
    model.nonlinear.base[0] = Some(base);
    let system = crate::witness::system(model)?;
    let mut run = Driver::new(Arc::clone(&system))?;
    let (mut error, mut most) = ([0.0_f64; 2], [0.0_f64; 2]);
    for step in 1..=steps {
        run.step()?;
        let Some(exact) = exact(step) else { continue };
        let motion = &run.state().motion;
        let frame = system.frame_acceleration(run.state().time, dt)[0];
        let found = [motion.u[0], motion.a[0] + frame];
        for k in 0..2 {
            error[k] = error[k].max((found[k] - exact[k]).abs());
            most[k] = most[k].max(exact[k].abs());
        }
    }
    let row =
        |what: &str, k: usize| Row::at_most(format!("{name}: {what}"), error[k] / most[k], 1e-6);
    let mut rows = vec![
        row("relative displacement", 0),
        row("absolute acceleration", 1),
    ];
    rows.extend(balances(name, run.state(), 0.0));
    Ok(rows)
}

fn harmonic(end: f64) -> Result<Vec<Row>, Error> {
    let Oscillator { omega, damping } = OSCILLATOR;
    let (size, drive) = (1.5, 0.7 * omega);
    let steps = fine_steps(omega, end);
    let dt = end / steps;
    let acceleration = |t: f64| size * (drive * t).sin();
    let table = (0..=steps as usize).map(|k| [dt * k as f64, acceleration(dt * k as f64)]);
    let [spread, loss] = [omega * omega - drive * drive, 2.0 * damping * omega * drive];
    let square = spread * spread + loss * loss;
    let [sine, cosine] = [-size * spread / square, size * loss / square];
    let turn = omega * (1.0 - damping * damping).sqrt();
    let (a, decay) = (-cosine, damping * omega);
    let b = (decay * a - sine * drive) / turn;
    let exact = |step: usize| {
        let t = dt * step as f64;
        let [(s, c), (st, ct)] = [(drive * t).sin_cos(), (turn * t).sin_cos()];
        let fade = (-decay * t).exp();
        let u = sine * s + cosine * c + fade * (a * ct + b * st);
        let v = drive * (sine * c - cosine * s)
            + fade * ((turn * b - decay * a) * ct - (turn * a + decay * b) * st);
        Some([u, -2.0 * decay * v - omega * omega * u])
    };
    let base = Amplitude::new(table.collect())?;
    oscillator("harmonic", (base, dt, steps as usize), exact)
}

fn tabulated(end: f64) -> Result<Vec<Row>, Error> {
    let h = 0.02;
    let count = (end / h).round();
    let pieces = (fine_steps(OSCILLATOR.omega, end) / count).ceil() as usize;
    let record = record(h, count as usize)?;
    let response = OSCILLATOR.response(&record);
    let exact = |step: usize| {
        let at = response[step / pieces];
        step.is_multiple_of(pieces)
            .then(|| [at.u, OSCILLATOR.acceleration(at)])
    };
    let run = (
        record.acceleration(),
        h / pieces as f64,
        count as usize * pieces,
    );
    oscillator("tabulated", run, exact)
}

/// Three masses between two supports that move by A (1 - cos Ωt).
fn frame(end: f64) -> Result<Vec<Row>, Error> {
    const STIFFNESS: f64 = 400.0;
    let drives: [[f64; 2]; 2] = [[0.01, 11.0], [-0.02, 29.0]];
    let omega = |j: usize| 2.0 * STIFFNESS.sqrt() * (j as f64 * PI / 8.0).sin();
    let steps = fine_steps(omega(3), end);
    let dt = end / steps;
    let mut points = Points::new(1);
    let nodes = [0, 1, 2, 3, 4].map(|k| points.mass(1.0, [f64::from(k), 0.0, 0.0], REST));
    for pair in nodes.windows(2) {
        points.between([pair[0], pair[1]], X, Curve::line(STIFFNESS));
    }
    let mut model = points.model(newmark(0.25, 0.5), dt);
    for ([size, drive], node) in drives.iter().zip([nodes[0].0, nodes[4].0]) {
        let motion = |k: usize| {
            let t = dt * k as f64;
            [t, size * (1.0 - (drive * t).cos())]
        };
        let table = Amplitude::new((0..=steps as usize).map(motion).collect())?;
        model.nonlinear.motions.push(Prescribed {
            nodes: vec![node],
            displacement: [Some(table), None, None],
        });
    }
    let system = crate::witness::system(model)?;
    let mut run = Driver::new(Arc::clone(&system))?;
    let exact = |t: f64| -> [f64; 3] {
        let mut u = [0.0; 3];
        for j in 1..=3 {
            let shape = |i: usize| (i as f64 * j as f64 * PI / 4.0).sin();
            let w = omega(j);
            let mut amplitude = 0.0;
            for ([size, drive], next) in drives.iter().zip([1, 3]) {
                // q̈ + ω² q = φ(next) k A (1 - cos Ωt) / m_j, with m_j = Σ φ² = 2
                let force = shape(next) * STIFFNESS * size / 2.0;
                amplitude += force
                    * ((1.0 - (w * t).cos()) / (w * w)
                        - ((drive * t).cos() - (w * t).cos()) / (w * w - drive * drive));
            }
            for (i, u) in u.iter_mut().enumerate() {
                *u += amplitude * shape(i + 1);
            }
        }
        u
    };
    let (mut error, mut most) = (0.0_f64, 0.0_f64);
    for step in 1..=steps as usize {
        run.step()?;
        let exact = exact(dt * step as f64);
        for (i, exact) in exact.iter().enumerate() {
            let node = system.number[nodes[i + 1].0 as usize];
            let found = run.state().motion.u[system.unknowns.first(node)];
            error = error.max((found - exact).abs());
            most = most.max(exact.abs());
        }
    }
    let mut rows = vec![Row::at_most(
        "two supports: displacement",
        error / most,
        1e-6,
    )];
    rows.extend(balances("two supports", run.state(), 0.0));
    Ok(rows)
}

/// How the supports move.
#[derive(Clone, Copy, PartialEq)]
enum Frame {
    /// By the double integral of the record.
    Absolute,
    /// They are at rest, and the base is accelerated.
    Relative,
}

/// Lets the nodes of a model be shaken.
fn shake(model: &mut Model, frame: Frame, nodes: Vec<u32>, record: &Record) {
    match frame {
        Frame::Absolute => model.nonlinear.motions.push(Prescribed {
            nodes,
            displacement: [Some(record.displacement()), None, None],
        }),
        Frame::Relative => {
            model.nonlinear.base[0] = Some(record.acceleration());
            model.supports.push(Support {
                nodes,
                fix: [true, false, false],
                fix_rotations: [false; 3],
            });
        }
    }
}

/// Time between the points of the record of (c) and (d), s, and the steps in it.
const H: f64 = 0.1;
const OF_CHAIN: usize = 65536;
const OF_BAR: usize = 8192;

/// The displacement of a node relative to the first support, and the force of the first contact if there is one, after each
/// step.
fn relative(model: Model, [node, support]: [u32; 2], steps: usize) -> Result<Vec<[f64; 2]>, Error> {
    let system = crate::witness::system(model)?;
    let place = |node: u32| system.unknowns.first(system.number[node as usize]);
    let [node, support] = [node, support].map(place);
    let mut run = Driver::new(Arc::clone(&system))?;
    let mut all = Vec::with_capacity(steps);
    for _ in 0..steps {
        run.step()?;
        let u = &run.state().motion.u;
        let force = run
            .report()
            .contacts
            .first()
            .map_or(0.0, |contact| contact.force);
        all.push([u[node] - u[support], force]);
    }
    Ok(all)
}

/// Largest differences of the two formulations in displacement and force, over the largest values of the first.
fn differences(run: impl Fn(Frame) -> Result<Vec<[f64; 2]>, Error>) -> Result<[f64; 2], Error> {
    let (one, other) = (run(Frame::Absolute)?, run(Frame::Relative)?);
    Ok([0, 1].map(|k| {
        let most = one.iter().fold(0.0_f64, |m, at| m.max(at[k].abs()));
        let pairs = one.iter().zip(&other);
        pairs.fold(0.0_f64, |m, (a, b)| m.max((a[k] - b[k]).abs())) / most
    }))
}

/// A chain on one support against a stop on the other.
fn chain(frame: Frame, record: &Record) -> Result<Vec<[f64; 2]>, Error> {
    let mut points = Points::new(1);
    let nodes = [0, 1, 2, 3, 4].map(|k| points.mass(1.0, [f64::from(k), 0.0, 0.0], REST));
    for pair in nodes[..4].windows(2) {
        points.between([pair[0], pair[1]], X, Curve::line(1e4));
    }
    points.stop((nodes[3], Some(nodes[4])), X, 2e-4, [1e5, 0.0])?;
    let mut model = points.model(newmark(0.25, 0.5), H / OF_CHAIN as f64);
    shake(&mut model, frame, vec![nodes[0].0, nodes[4].0], record);
    let steps = (record.points().len() - 1) * OF_CHAIN;
    relative(model, [nodes[3].0, nodes[0].0], steps)
}

/// A bar of four elements with consistent mass, whose left end is shaken.
fn bar(frame: Frame, record: &Record, pieces: usize) -> Result<Vec<[f64; 2]>, Error> {
    let mesh = generate::line("bar", [0.0; 3], X, 4, 1);
    let [left, right] = [0, 4];
    let material = Elastic {
        density: 1e3,
        young: 4e4,
        poisson: 0.0,
    };
    let body = ModelBody {
        mass: MassKind::Consistent,
        ..body(&mesh, "bar", Kinematics::Bar { area: 1e-2 }, material)?
    };
    let dt = H / pieces as f64;
    let mut model = Model::new(vec![body], mesh, newmark(0.25, 0.5), dt);
    shake(&mut model, frame, vec![left], record);
    let steps = (record.points().len() - 1) * pieces;
    relative(model, [right, left], steps)
}

/// A mass that falls on a plane under gravity, and the same in a frame whose acceleration is minus that of gravity, by every scheme
/// with a law in the gap, a law in the rate, and a stop: largest difference of the displacements over the largest displacement.
fn falls() -> Result<Vec<Row>, Error> {
    const GRAVITY: f64 = 9.81;
    let fall = |scheme: Scheme, law: Option<Law>, in_frame: bool| {
        let mut points = Points::new(1);
        let mass = points.mass(2.0, [1e-3, 0.0, 0.0], REST);
        let floor = Plane {
            point: [0.0; 3],
            normal: X,
        };
        match law {
            Some(law) => points.contact(mass, ModelTarget::rigid(floor), law, 0.0),
            None => points.stop((mass, None), [-1.0, 0.0, 0.0], 1e-3, [1e5, 10.0])?,
        }
        let mut model = points.model(scheme, 2e-4);
        match in_frame {
            true => model.nonlinear.base[0] = Some(Amplitude::constant(GRAVITY)),
            false => model.gravity[0] = -GRAVITY,
        }
        let mut run = Driver::new(crate::witness::system(model)?)?;
        let mut u = Vec::new();
        for _ in 0..150 {
            run.step()?;
            u.push(run.state().motion.u[0]);
        }
        Ok::<_, Error>(u)
    };
    let mut rows = Vec::new();
    for scheme in Scheme::registered() {
        let mut error = 0.0_f64;
        let gap = scheme.get().takes(Level::Gap).then_some(Some(DISPLACEMENT));
        let rate = scheme.get().takes(Level::Rate).then_some(Some(NOW));
        let both = scheme.get().takes(Level::GapAndRate).then_some(None);
        for law in [gap, rate, both].into_iter().flatten() {
            let (one, other) = (fall(scheme, law, false)?, fall(scheme, law, true)?);
            let most = one.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
            let pairs = one.iter().zip(&other);
            error = pairs.fold(error, |m, (a, b)| m.max((a - b).abs() / most));
        }
        let what = format!("{scheme:?}: gravity and an accelerated frame differ by");
        rows.push(Row::at_most(what, error, 1e-12));
    }
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "base-motion",
    fact: "oscillators and frames on moving supports: closed forms; the same in the relative frame, with a stop",
    run: |size| {
        let (end, points) = match size {
            Size::Quick => (1.5, 3),
            Size::Full => (6.0, 5),
        };
        let mut rows = harmonic(end)?;
        rows.extend(tabulated(end)?);
        rows.extend(frame(0.5 * end)?);
        let record = record(H, points)?;
        let of_chain = differences(|frame| chain(frame, &record))?;
        let [of_bar, coarse, half] = [OF_BAR, 64, 128]
            .map(|pieces| differences(|frame| bar(frame, &record, pieces)).map(|of| of[0]));
        for (what, found) in [
            ("chain against a stop: relative displacement", of_chain[0]),
            ("chain against a stop: force of the stop", of_chain[1]),
            ("bar of consistent mass: relative displacement", of_bar?),
        ] {
            rows.push(Row::at_most(what, found, 1e-8));
        }
        let what = "bar of consistent mass: difference with 64 steps in h over that with 128";
        rows.push(Row::near(what, coarse? / half?, 4.0, 0.2));
        rows.extend(falls()?);
        Ok(rows)
    },
};
