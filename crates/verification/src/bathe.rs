//! Bathe's scheme: two bars, a bar on a wall, and a stiff plate that spins.
//!
//! Problem: set "slow", all ends free, lumped and consistent mass, CFL 0.25 to 4, velocity law; a square plate of steel of 0.1 m, plane strain, neo-Hooke,
//! four quadrilaterals, that spins at one revolution per second, 64 steps a revolution: a wave crosses it some 800 times in a step. Closed solution: F = Z v0 / 2
//! (Z v0 on the wall) for 2 L / c; the plate keeps its energy and its angular momentum. Reference: the formulas. The plate is in the manner of the
//! rotating plate of Bathe (2007), whose text was not at hand.
//!
//! Tolerances. Bars: the force errs by n^-1/3, 1 - restitution by n^-2/3, the energy lost, that of the end nodes, is like 1/n (see `bars-convergence`);
//! from n = 100 to 200 three quarters of each exponent are asked for. The mean over 0.7 of the contact has what a swing of F0 of the last elements leaves,
//! a few tenths of 1/n: 2e-3. The displacement law is shown: it chatters below CFL 2. Plate: it starts without its centripetal acceleration, which takes
//! Ω² of the energy in the first step, Ω = 2π/64; then each step at most what it takes from an oscillator of this frequency, 2 · 0.0037 Ω⁴. That the
//! energy grows in no step holds for linear bodies and is shown here; the angular momentum of a rigid motion goes as the root of the energy.

use carom_bodies::{BodySpec, Kinematics, MassKind};
use carom_contact::law::Capture;
use carom_dynamics::scheme::Bathe;
use carom_dynamics::{Driver, Model, ModelBody, Scheme};
use carom_materials::{Elastic, Law, NeoHooke};
use carom_mesh::generate;

use crate::Error;
use crate::bars::{Against, Run};
use crate::build::{DISPLACEMENT, group, newmark, velocity};
use crate::check::{Check, Row, Size};
use crate::figures::{History, converging, run};
use crate::kept::Kept;

/// The scheme with its default.
fn bathe(gamma: f64) -> Scheme {
    Scheme::Bathe(Bathe { gamma })
}

const STEEL: Elastic = Elastic {
    density: 8000.0,
    young: 2e11,
    poisson: 0.3,
};
const SIDE: f64 = 0.1;
const SPIN: f64 = 2.0 * std::f64::consts::PI;
/// Steps a revolution.
const STEPS: usize = 64;

/// Mean of the force over the middle of the contact, relative to the exact one.
fn mean_force(history: &History, case: &Run) -> f64 {
    let duration = case.set.duration();
    let inside = |t: f64| t > 0.2 * duration && t < 0.9 * duration;
    let both = history.time.iter().zip(&history.force);
    let forces: Vec<f64> = both.filter(|(t, _)| inside(**t)).map(|(_, f)| *f).collect();
    forces.iter().sum::<f64>() / forces.len() as f64 / case.force()
}

/// What one mesh leaves: error of the force, loss of speed, loss of energy.
fn bars(case: &Run, rows: &mut Vec<Row>) -> Result<[f64; 3], Error> {
    let (history, figures) = run(case)?;
    let name = case.name();
    let row = |what: &str| format!("{name}, n = {}: {what}", case.elements);
    rows.extend([
        Row::near(
            row("mean force / exact"),
            mean_force(&history, case),
            1.0,
            2e-3,
        ),
        Row::at_most(row("restitution"), figures.restitution, 1.0),
        Row::at_most(row("change of the energy / E0"), figures.energy_change, 0.0),
        Row::shown(row("overshoot"), figures.overshoot),
        Row::shown(row("changes after the closing"), figures.switches as f64),
    ]);
    rows.extend(figures.balances(&row("balances")));
    Ok([
        figures.force_error,
        1.0 - figures.restitution,
        -figures.energy_change,
    ])
}

/// What the displacement law does.
fn chatter(case: &Run) -> Result<[Row; 3], Error> {
    let (_, figures) = run(case)?;
    let row = |what: &str| format!("{}, displacement law: {what}", case.name());
    Ok([
        Row::shown(row("force error"), figures.force_error),
        Row::shown(row("changes after the closing"), figures.switches as f64),
        Row::shown(row("change of the energy / E0"), figures.energy_change),
    ])
}

/// The plate.
fn plate(scheme: Scheme) -> Result<Driver, Error> {
    let mesh = generate::rectangle("plate", [-0.5 * SIDE; 2], [SIDE; 2], [2, 2], false);
    let mut model = Model::new(
        vec![ModelBody::new(BodySpec::new(
            "plate",
            group(&mesh, "plate")?.elements.clone(),
            Kinematics::PlaneStrain { thickness: 1.0 },
            Law::NeoHooke(NeoHooke { initial: STEEL }),
        ))],
        mesh,
        scheme,
        1.0 / STEPS as f64,
    );
    model.nonlinear.iteration.halvings = 0;
    let system = crate::witness::system(model)?;
    let spin = |node: &[f64; 3]| [-SPIN * node[1], SPIN * node[0]];
    let velocity: Vec<f64> = system.x.iter().flat_map(spin).collect();
    let mut driver = Driver::new(system)?;
    let still = vec![0.0; velocity.len()];
    driver.restart(&still, &velocity)?;
    Ok(driver)
}

/// Steps that the plate takes of these revolutions, what it kept, and the largest growth of its energy in a step over that at the start.
fn spin(scheme: Scheme, revolutions: usize) -> Result<(usize, Kept, f64), Error> {
    let mut driver = plate(scheme)?;
    let mut kept = Kept::new(driver.system(), driver.state()).scaled_by(1.0);
    let first = driver.state().ledger.balance.energy();
    let (mut last, mut growth) = (first, 0.0_f64);
    for step in 0..STEPS * revolutions {
        if driver.step().is_err() {
            return Ok((step, kept, growth));
        }
        kept.follow(driver.state());
        let energy = driver.state().ledger.balance.energy();
        growth = growth.max((energy - last) / first);
        last = energy;
    }
    Ok((STEPS * revolutions, kept, growth))
}

fn plates(revolutions: usize) -> Result<Vec<Row>, Error> {
    let all = STEPS * revolutions;
    let angle = SPIN / STEPS as f64;
    let lost = angle.powi(2) + 2.0 * 0.0037 * angle.powi(4) * all as f64;
    let mut rows = Vec::new();
    for gamma in [Bathe::default().gamma, 0.5] {
        let (steps, kept, growth) = spin(bathe(gamma), revolutions)?;
        let row = |what: &str| format!("plate, gamma = {gamma:.4}: {what}");
        rows.extend([
            Row::count(row("steps taken"), steps, all),
            Row::shown(row("largest growth of the energy in a step / E0"), growth),
            Row::at_most(
                row("largest change of the energy, relative"),
                kept.energy,
                lost,
            ),
            Row::at_most(
                row("largest change of the angular momentum, relative"),
                kept.angular,
                0.5 * lost,
            ),
        ]);
    }
    let (steps, ..) = spin(newmark(0.25, 0.5), revolutions)?;
    let what = "plate, trapezoidal rule: steps before one fails";
    rows.push(Row::shown(what, steps as f64));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "bathe",
    fact: "Bathe's scheme: bars strike with the exact mean force, converge and lose energy only; a stiff plate spins where the trapezoidal rule fails",
    run: |size| {
        let mut rows = Vec::new();
        for against in [Against::Bar, Against::Wall] {
            for mass in [MassKind::Lumped, MassKind::Consistent] {
                for courant in [0.25, 0.5, 1.0, 2.0, 4.0] {
                    let case = Run {
                        scheme: bathe(Bathe::default().gamma),
                        law: velocity(Capture::Half),
                        against,
                        mass,
                        courant,
                        ..Run::slow(100)
                    };
                    // the impact on a wall is that of two bars by symmetry
                    if size == Size::Full || against == Against::Bar && courant >= 1.0 {
                        rows.extend(converging(&case, bars)?);
                    }
                    if against == Against::Bar {
                        let law = DISPLACEMENT;
                        rows.extend(chatter(&Run { law, ..case })?);
                    }
                }
            }
        }
        let revolutions = match size {
            Size::Quick => 2,
            Size::Full => 20,
        };
        rows.extend(plates(revolutions)?);
        Ok(rows)
    },
};
