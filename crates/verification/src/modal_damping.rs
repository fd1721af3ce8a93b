//! Bodies whose modes are damped.
//!
//! Problems: (a) a cantilever of 20 beam elements in the plane, damped by 2 %, 5 %, 1 % and 30 % in its four lowest modes, moves from a uniform
//! velocity; its motion is split into modes by φᵀ M u. (b) The same, free, with all modes below a frequency damped. (c) A cantilever of 6 elements
//! whose modes are all damped by ζ = (α/ω + β ω)/2 knocks against a stop, implicit and explicit.
//!
//! Closed solutions: (a) each mode is an oscillator of its own, u̇₀ e^(-ζωt) sin(ω_d t)/ω_d, undamped above the fourth. The trapezoidal rule has
//! the solution of its recursion, to which each mode agrees to 1e-8 (the digits of the modes). The recursion is off the closed form by
//! (ω t/12 + 1) x² at most, x = ω Δt. (b) Momentum stays: modes that deform have none; 1e-9. (c) C = α M + β K: the same motion
//! as with Rayleigh's damping, with its matrix in the factor in one and of low rank in the other run; 1e-7 of the largest displacement, since
//! impacts multiply differences. Energy and momentum balance to rounding, 1e-11.

use std::f64::consts::TAU;

use carom_bodies::{BeamTheory, MassKind};
use carom_contact::law::{Adhesion, Crush, Curve, Stop};
use carom_contact::{Law, Plane};
use carom_dynamics::{Damping, Driver, Model, ModelContact, ModelTarget, Scheme, System, scheme};
use carom_mesh::Surface;
use carom_reduction::{Ratios, damp, modes};

use crate::Error;
use crate::beams::{held, section, straight};
use crate::build::newmark;
use crate::check::{Check, Row, Size};
use crate::points::balances;

const RATIOS: [f64; 4] = [0.02, 0.05, 0.01, 0.3];
const SPEED: f64 = 0.5;

/// A cantilever of 1 m in the plane, along x, thrown across itself.
fn cantilever(elements: usize) -> Result<Model, Error> {
    let given = section(0.02, BeamTheory::EulerBernoulli);
    let (mesh, mut body) = straight([[0.0; 3], [1.0, 0.0, 0.0]], elements, 2, given)?;
    body.velocity = [0.0, -SPEED, 0.0];
    Ok(Model {
        supports: vec![held(vec![0], [true; 3], [true; 3])],
        ..Model::new(vec![body], mesh, newmark(0.25, 0.5), 1.0)
    })
}

/// Free decay of each mode.
fn decay(steps: usize) -> Result<Vec<Row>, Error> {
    let mut model = cantilever(20)?;
    let damped = damp(&mut model, 0, &Ratios::Each(RATIOS.to_vec()))?;
    // periods of the lowest mode that deforms, in which the highest damped one has some tens
    model.dt = 1.0 / damped[0][0] / steps as f64;
    let dt = model.dt;
    let system = crate::witness::system(model)?;
    let count = RATIOS.len() + 4;
    let part = modes(&system, count, &mut |_, _| {})?.remove(0);
    let mut driver = Driver::new(system.clone())?;
    let mut image = vec![0.0; system.unknowns()];
    let shapes: Vec<Vec<f64>> = (0..count)
        .map(|mode| part.shape(mode, system.unknowns()))
        .collect();
    let split = |vector: &[f64], image: &mut Vec<f64>| -> Vec<f64> {
        system.mass.multiply(vector, image);
        let parts = shapes.iter();
        parts
            .map(|shape| shape.iter().zip(&*image).map(|(a, b)| a * b).sum())
            .collect()
    };
    let start = split(&driver.state().motion.v, &mut image);
    // modes along the beam take no part
    let most = start.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let takes_part = |mode: &usize| start[*mode].abs() > 1e-6 * most;
    // the recursion of the trapezoidal rule, of each mode (u, v)
    let mut exact: Vec<[f64; 2]> = start.iter().map(|v| [0.0, *v]).collect();
    let mut errors = vec![[0.0_f64; 2]; count];
    for step in 1..=2 * steps {
        driver.step()?;
        let found = split(&driver.state().motion.u, &mut image);
        let t = dt * step as f64;
        for mode in (0..count).filter(takes_part) {
            let omega = TAU * part.frequency(mode);
            let ratio = RATIOS.get(mode).copied().unwrap_or(0.0);
            let [u, v] = exact[mode];
            let a = -omega * omega * u - 2.0 * ratio * omega * v;
            let whole = 1.0 + ratio * omega * dt + 0.25 * (omega * dt).powi(2);
            let known = omega * omega * (u + dt * v + 0.25 * dt * dt * a)
                + 2.0 * ratio * omega * (v + 0.5 * dt * a);
            let next = -known / whole;
            exact[mode] = [
                u + dt * v + 0.25 * dt * dt * (a + next),
                v + 0.5 * dt * (a + next),
            ];
            let turn = omega * (1.0 - ratio * ratio).sqrt();
            let closed = start[mode] * (-ratio * omega * t).exp() * (turn * t).sin() / turn;
            let largest = start[mode].abs() / omega;
            let x = (omega * dt).powi(2);
            let bound = (omega * t / 12.0 + 1.0) * x;
            let [to_rule, to_closed] = &mut errors[mode];
            *to_rule = to_rule.max((found[mode] - exact[mode][0]).abs() / largest);
            *to_closed = to_closed.max((found[mode] - closed).abs() / largest / bound);
        }
    }
    let mut rows = Vec::new();
    for mode in (0..count).filter(takes_part) {
        let [to_rule, to_closed] = errors[mode];
        let ratio = RATIOS.get(mode).copied().unwrap_or(0.0);
        let name = |what: &str| format!("mode {}, damping ratio {ratio}: {what}", mode + 1);
        rows.push(Row::at_most(name("off the recursion"), to_rule, 1e-8));
        rows.push(Row::at_most(
            name("off the closed form, over its bound"),
            to_closed,
            1.0,
        ));
    }
    rows.extend(balances("decay", driver.state(), 0.0));
    Ok(rows)
}

/// A free beam keeps its momentum.
fn free() -> Result<Vec<Row>, Error> {
    let mut model = cantilever(20)?;
    model.supports = Vec::new();
    model.dt = 1e-4;
    let damped = damp(
        &mut model,
        0,
        &Ratios::Below {
            ratio: 0.1,
            frequency: 2000.0,
        },
    )?;
    let system = crate::witness::system(with_stop(&model, 1e4)?)?;
    let mut driver = Driver::new(system)?;
    for _ in 0..600 {
        driver.step()?;
    }
    let balance = &driver.state().ledger.balance;
    let given = balance.impulse_contact.linear[1];
    let kept = balance.momentum.linear[1] - driver.state().ledger.initial.momentum.linear[1];
    let mut rows = vec![
        Row::at_least("free: damped modes", damped.len() as f64, 4.0),
        Row::relative(
            "free: momentum over the impulse of the stop",
            kept / given,
            1.0,
            1e-9,
        ),
        Row::at_least(
            "free: energy that damping takes, J",
            balance.dissipation_damping,
            1e-6,
        ),
    ];
    rows.extend(balances("free", driver.state(), 0.0));
    Ok(rows)
}

/// The model with a stop at the end of the beam, 1 mm below it.
fn with_stop(model: &Model, stiffness: f64) -> Result<Model, Error> {
    let cells = &model.bodies[0].spec.cells;
    let node = cells.len() as u32;
    let law = Law::Stop(Stop {
        clearance: 0.0,
        curve: Curve::new(&[[1.0, stiffness]])?,
        crush: Crush::Recovered,
        damping: 0.0,
        adhesion: Adhesion::Clip,
    });
    let target = ModelTarget::rigid(Plane {
        point: [1.0, -1e-3, 0.0],
        normal: [0.0, 1.0, 0.0],
    });
    let points = Surface::of_points(&[(node, cells[cells.len() - 1])], [0.0, -1.0, 0.0]);
    let mut model = model.clone();
    model.contacts = vec![ModelContact::new("stop", points, target, law)];
    Ok(model)
}

/// All modes damped as Rayleigh's damping does, and that damping.
fn against_rayleigh(name: &str, scheme: Scheme, mass: MassKind) -> Result<Vec<Row>, Error> {
    let (alpha, beta, elements) = (20.0, 2e-6, 6);
    let mut model = cantilever(elements)?;
    model.scheme = scheme;
    model.bodies[0].mass = mass;
    model.dt = 1e-6;
    let system = System::whole(model.clone())?;
    let held = system.fixed.iter().filter(|fixed| **fixed).count();
    let count = system.unknowns() - held;
    let mut modal = model.clone();
    let frequencies = damp(&mut modal, 0, &Ratios::Each(vec![0.0; count]))?;
    let ratio = |[f, _]: &[f64; 2]| 0.5 * (alpha / (TAU * f) + beta * TAU * f);
    let ratios = frequencies.iter().map(ratio).collect();
    damp(&mut modal, 0, &Ratios::Each(ratios))?;
    model.nonlinear.damping = vec![Damping {
        mass: alpha,
        stiffness: beta,
    }];
    let mut runs = Vec::new();
    for model in [&model, &modal] {
        runs.push(Driver::new(crate::witness::system(with_stop(
            model, 1e5,
        )?)?)?);
    }
    let (mut off, mut largest) = (0.0_f64, 0.0_f64);
    for _ in 0..20_000 {
        runs.iter_mut().try_for_each(|run| run.step().map(drop))?;
        let [one, other] = [0, 1].map(|k| &runs[k].state().motion.u);
        for (a, b) in one.iter().zip(other) {
            off = off.max((a - b).abs());
            largest = largest.max(a.abs());
        }
    }
    let impulse = runs[1].state().records.contacts[0].impulse();
    let mut rows = vec![
        Row::at_most(
            format!("{name}: off Rayleigh's damping"),
            off / largest,
            1e-7,
        ),
        Row::at_least(format!("{name}: impulse of the stop, N s"), impulse, 1e-3),
    ];
    rows.extend(balances(name, runs[1].state(), 0.0));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "modal-damping",
    fact: "each damped mode of a body decays as an oscillator of its ratio, others do not, and all modes damped as Rayleigh's damping does are that damping",
    run: |size| {
        let steps = match size {
            Size::Quick => 4000,
            Size::Full => 16_000,
        };
        let explicit = Scheme::CentralDifference(scheme::CentralDifference {});
        let mut rows = decay(steps)?;
        rows.extend(free()?);
        rows.extend(against_rayleigh(
            "trapezoid",
            newmark(0.25, 0.5),
            MassKind::Consistent,
        )?);
        rows.extend(against_rayleigh(
            "central differences",
            explicit,
            MassKind::Lumped,
        )?);
        Ok(rows)
    },
};
