//! Two elastic rings that collide.
//!
//! Problem: `cases/rings`: two rings in the plane, outer radius 1 m, thickness 0.1 m, plane strain, neo-Hooke, E = 1 MPa, ν = 0.3,
//! ρ = 1000 kg/m³; the first flies at 1.5 m/s along x against the second, which is free, at rest, and 0.5 m off the line. They flatten
//! by a third of their radius, slide over each other and leave turning. Mortar, standard basis, dt = 0.01 s, 300 steps.
//! Closed facts: linear momentum, angular momentum, energy. Reference: none beyond these; with another scheme and another
//! law, the impulse of the run that keeps them.
//! Tolerances: momenta 1e-10 and energy 1e-8 with energy-momentum, as the issue states (iterations end at 1e-11 of the
//! forces: 1e-12 is found). The ledger of every run closes to the iterations, 1e-10 of the energy. Displacement law: no
//! gap beyond 1e-9 m, that of the iterations. Velocity law: the bound of its viability, with the speed of the approach. Damped law:
//! its k_p = E / thickness gives way, which is shown. Impulses agree to 3 %, a second formulation: schemes and laws differ
//! by O(dt) in when a point closes. The largest mean force over 0.1 s follows them with 15 %, a step being a tenth of the window in
//! which the points of an element close one after the other. What the trapezoid gains under the displacement law is shown.
//! Iterations: a regression, a tenth above what was found (9.4).
//! Penalty law with the same stiffness, theta: the spring is held where the scheme takes internal forces, and its work over a
//! step is that of a gap linearised there, while rows turn. What contact makes is of second order in the step; between a
//! quarter and an eighth of dt on the coarse mesh a ratio of 3 is asked for, three quarters of the exponent and a little more.
//! Sizes: quick 2 x 32 elements in each ring, the first 60 steps; full 3 x 96.

use carom_bodies::Kinematics;
use carom_contact::law::{Adhesion, Damped, Penalty};
use carom_contact::{Basis, Integration, Law};
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Driver, Model, Scheme, State};
use carom_exact::closed_forms::{penetration_bound_half, penetration_bound_now};
use carom_materials::Elastic;

use crate::Error;
use crate::build::{DISPLACEMENT, HALF, NOW, damped, newmark, theta};
use crate::check::{Check, Row, Size};
use crate::collision::Collision;
use crate::kept::Kept;

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.3,
};
const THICKNESS: f64 = 0.1;
const SPEED: f64 = 1.5;
const STEP: f64 = 0.01;
/// When the rings have parted, s.
const PARTED: f64 = 1.5;
/// Part of the impulse within which schemes and laws agree.
const IMPULSE: f64 = 0.03;
/// Part of the largest mean force within which they agree.
const FORCE: f64 = 0.15;
/// Steps of the window over which the force is averaged: 0.1 s.
const WINDOW: usize = 10;

/// What a collision did.
struct Collided {
    kept: Kept,
    /// Total force of each step, N.
    forces: Vec<f64>,
    drift: GapDrift,
    /// Largest strain energy over the energy at the start.
    strained: f64,
    /// Iterations a step.
    iterations: f64,
    end: State,
}

impl Collided {
    /// Largest mean of the force over the window, N.
    fn mean_force(&self) -> f64 {
        let means = self.forces.windows(WINDOW);
        let means = means.map(|forces| forces.iter().sum::<f64>() / WINDOW as f64);
        means.fold(0.0, f64::max)
    }

    fn impulse(&self) -> f64 {
        self.end.records.contacts[0].impulse()
    }

    fn penetration(&self) -> f64 {
        self.end.records.contacts[0].penetration
    }

    /// Largest residual of the energy balance over the energy at the start.
    fn residual(&self) -> f64 {
        let ledger = &self.end.ledger;
        ledger.largest_energy_residual / ledger.initial.energy()
    }

    /// Energy at the end over that at the start, less one.
    fn gain(&self) -> f64 {
        let ledger = &self.end.ledger;
        ledger.balance.energy() / ledger.initial.energy() - 1.0
    }
}

/// How far the gap of a point moves while it carries a force without a pause.
struct GapDrift {
    /// Least and largest gap of each point since its force began, m.
    range: Vec<Option<[f64; 2]>>,
    /// Largest difference of the two so far, m.
    largest: f64,
}

impl GapDrift {
    fn follow(&mut self, state: &State) {
        let interface = &state.interface;
        let points = interface.force.iter().zip(&interface.gap);
        for (range, (&force, &gap)) in self.range.iter_mut().zip(points) {
            *range = (force > 0.0).then(|| {
                let [least, most] = range.unwrap_or([gap; 2]);
                [least.min(gap), most.max(gap)]
            });
            if let Some([least, most]) = range {
                self.largest = self.largest.max(*most - *least);
            }
        }
    }
}

fn model(mesh: &'static str, scheme: Scheme, law: Law, dt: f64) -> Result<Model, Error> {
    let rings = Collision {
        mesh,
        bodies: ["ring1", "ring2"],
        kinematics: Kinematics::PlaneStrain { thickness: 1.0 },
        material: RUBBER,
        velocity: [SPEED, 0.0, 0.0],
        integration: Integration::Mortar {
            basis: Basis::Standard,
        },
        depth: THICKNESS,
    };
    rings.model(scheme, law, dt)
}

fn collide(mesh: &'static str, steps: usize, scheme: Scheme, law: Law) -> Result<Collided, Error> {
    let mut newton = Driver::new(crate::witness::system(model(mesh, scheme, law, STEP)?)?)?;
    let mut kept = Kept::new(newton.system(), newton.state());
    let mut drift = GapDrift {
        range: vec![None; newton.system().points()],
        largest: 0.0,
    };
    let (mut forces, mut strained, mut iterations) = (Vec::new(), 0.0_f64, 0);
    let energy = newton.state().ledger.initial.energy();
    for _ in 0..steps {
        newton.step()?;
        kept.follow(newton.state());
        drift.follow(newton.state());
        let report = newton.report();
        forces.push(report.contacts[0].force);
        strained = strained.max(report.balance.strain / energy);
        iterations += newton.residuals().len();
    }
    Ok(Collided {
        kept,
        forces,
        drift,
        strained,
        iterations: iterations as f64 / steps as f64,
        end: newton.state().clone(),
    })
}

/// The laws 1, 2 and 3 with the schemes beside energy-momentum.
fn runs() -> [(&'static str, &'static str, Scheme, Law); 6] {
    let soft = damped(&RUBBER, THICKNESS, 0.5, Adhesion::Clip);
    let (trapezoid, middle) = (newmark(0.25, 0.5), theta(0.5));
    [
        ("newmark", "displacement", trapezoid, DISPLACEMENT),
        ("newmark", "damped", trapezoid, soft),
        ("newmark", "velocity", trapezoid, NOW),
        ("theta", "displacement", middle, DISPLACEMENT),
        ("theta", "damped", middle, soft),
        ("theta", "velocity", middle, HALF),
    ]
}

fn energy_momentum(mesh: &'static str, steps: usize) -> Result<Collided, Error> {
    collide(mesh, steps, Scheme::EnergyMomentum(EnergyMomentum {}), NOW)
}

/// Facts of the run that keeps everything.
fn conserved(run: &Collided) -> Vec<Row> {
    let row = |what: &str| format!("energy-momentum, velocity: {what}");
    vec![
        Row::at_most(row("change of momentum, relative"), run.kept.linear, 1e-10),
        Row::at_most(
            row("change of angular momentum, relative"),
            run.kept.angular,
            1e-10,
        ),
        Row::at_most(row("change of energy, relative"), run.kept.energy, 1e-8),
        Row::at_least(row("largest strain energy / energy"), run.strained, 0.1),
        Row::at_most(row("iterations a step"), run.iterations, 10.5).regression(),
    ]
}

/// Facts of a law under another scheme.
fn side_by_side(name: &str, law: Law, run: &Collided, reference: &Collided) -> Vec<Row> {
    let row = |what: &str| format!("{name}: {what}");
    let largest = match law {
        Law::Displacement(_) => Some(1e-9),
        Law::Damped(_) => None,
        _ if law == HALF => Some(penetration_bound_half(0.5, SPEED, STEP)),
        _ => Some(penetration_bound_now(0.5, SPEED, STEP)),
    };
    let deep = |what: &str, value| match largest {
        Some(bound) => Row::at_most(row(what), value, bound),
        None => Row::shown(row(what), value),
    };
    let mut rows = vec![
        Row::at_most(row("ledger residual / energy"), run.residual(), 1e-10),
        Row::at_most(row("change of momentum, relative"), run.kept.linear, 1e-10),
        deep("penetration, m", run.penetration()),
        deep("gap drift of closed points, m", run.drift.largest),
    ];
    if name == "newmark, displacement" {
        rows.push(Row::shown(row("energy gained, relative"), run.gain()));
    } else {
        let impulse = run.impulse() / reference.impulse();
        rows.push(
            Row::near(
                row("impulse / that of energy-momentum"),
                impulse,
                1.0,
                IMPULSE,
            )
            .second_formulation(),
        );
        let force = run.mean_force() / reference.mean_force();
        rows.push(
            Row::near(
                row("force over 0.1 s / that of energy-momentum"),
                force,
                1.0,
                FORCE,
            )
            .second_formulation(),
        );
    }
    rows
}

pub(crate) const CHECK: Check = Check {
    name: "rings",
    fact: "two rings that collide keep momenta and energy with energy-momentum, and other laws and schemes give the same impulse",
    run: |size| {
        let (mesh, steps) = match size {
            Size::Quick => ("rings/rings-coarse.msh", 60),
            Size::Full => ("rings/rings.msh", 300),
        };
        let reference = energy_momentum(mesh, steps)?;
        let mut rows = conserved(&reference);
        for (scheme, law, run, of) in runs() {
            let run = collide(mesh, steps, run, of)?;
            let name = format!("{scheme}, {law}");
            rows.extend(side_by_side(&name, of, &run, &reference));
        }
        if size == Size::Full {
            rows.push(sliding_springs()?);
        }
        Ok(rows)
    },
};

/// The penalty law in sliding contact: what contact makes at most, with a step and with half of it.
fn sliding_springs() -> Result<Row, Error> {
    let law = Law::Penalty(Penalty(Damped {
        stiffness: RUBBER.young / THICKNESS,
        damping: 0.0,
        adhesion: Adhesion::Clip,
    }));
    let made = |parts: f64| -> Result<f64, Error> {
        let model = model("rings/rings-coarse.msh", theta(0.5), law, STEP / parts)?;
        let mut newton = Driver::new(crate::witness::system(model)?)?;
        let mut largest = 0.0_f64;
        while newton.state().time < PARTED {
            newton.step()?;
            largest = largest.max(newton.state().ledger.balance.work_contact);
        }
        Ok(largest / newton.state().ledger.initial.energy())
    };
    let [coarse, fine] = [made(4.0)?, made(8.0)?];
    Ok(Row::at_least(
        format!("theta, penalty: work of contact, {coarse:.2e} E0 at dt / 4, over that at dt / 8"),
        coarse / fine,
        3.0,
    ))
}

/// The table of the manual: force, penetration, gap drift and ledger of the laws side by side, as Markdown.
///
/// # Errors
/// A mesh file that cannot be read, a step that fails.
pub fn table() -> Result<String, Error> {
    let (mesh, steps) = ("rings/rings.msh", 300);
    let mut text = String::from(
        "| scheme | law | force over 0.1 s, N | largest force, N | impulse, N s | penetration, mm | gap drift, mm | energy, % | ledger residual |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    let mut push = |scheme: &str, law: &str, run: &Collided| {
        text += &format!(
            "| {scheme} | {law} | {:.0} | {:.0} | {:.1} | {:.3} | {:.3} | {:+.2} | {:.0e} |\n",
            run.mean_force(),
            run.end.records.contacts[0].peak_force,
            run.impulse(),
            1e3 * run.penetration(),
            1e3 * run.drift.largest,
            100.0 * run.gain(),
            run.residual(),
        );
    };
    push(
        "energy-momentum",
        "velocity",
        &energy_momentum(mesh, steps)?,
    );
    for (scheme, law, run, of) in runs() {
        push(scheme, law, &collide(mesh, steps, run, of)?);
    }
    Ok(text)
}
