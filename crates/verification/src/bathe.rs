//! Bathe's scheme: two bars, a bar on a wall, and a stiff plate that spins.

use carom_bodies::{BodySpec, Kinematics, MassKind};
use carom_dynamics::scheme::Bathe;
use carom_dynamics::{Driver, Model, ModelBody, Scheme};
use carom_materials::{Elastic, Law, NeoHooke};
use carom_mesh::generate;

use crate::Error;
use crate::bars::{Against, Run};
use crate::build::{DISPLACEMENT, group, newmark, velocity};
use crate::check::{Check, Row};
use crate::figures::{History, run};
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

/// Largest growth of the energy in a step, over its start.
fn growth(energy: &[f64], start: f64) -> f64 {
    let before = std::iter::once(&start).chain(energy);
    let steps = before.zip(energy).map(|(one, other)| other - one);
    steps.fold(0.0, f64::max) / start
}

/// Mean of the force over the middle of the contact, relative to the exact one.
fn mean_force(history: &History, case: &Run) -> f64 {
    let duration = case.set.duration();
    let inside = |t: f64| t > 0.2 * duration && t < 0.9 * duration;
    let both = history.time.iter().zip(&history.force);
    let forces: Vec<f64> = both.filter(|(t, _)| inside(**t)).map(|(_, f)| *f).collect();
    forces.iter().sum::<f64>() / forces.len() as f64 / case.force()
}

/// What one mesh leaves.
fn bars(case: &Run, rows: &mut Vec<Row>) -> Result<(), Error> {
    let (history, figures) = run(case)?;
    let Run {
        against,
        mass,
        courant,
        elements,
        set,
        law,
        ..
    } = *case;
    let name = format!(
        "{against:?}, {mass:?}, CFL {courant}, n = {elements}, {}",
        law.get().name()
    );
    let row = |what: &str| format!("{name}: {what}");
    let start = 0.5 * set.density * set.area * set.length * set.speed.powi(2);
    rows.extend([
        Row::shown(row("growth"), growth(&history.energy, start)),
        Row::shown(row("mean force"), mean_force(&history, case)),
        Row::shown(row("force error"), figures.force_error),
        Row::shown(row("overshoot"), figures.overshoot),
        Row::shown(row("switches"), figures.switches as f64),
        Row::shown(row("restitution"), figures.restitution),
        Row::shown(row("energy"), figures.energy_change),
        Row::shown(row("penetration / (v0 dt)"), figures.penetration),
    ]);
    rows.extend(figures.balances(&name));
    Ok(())
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

/// Energy of the plate after some revolutions over that of its start, and the change of the angular momentum.
fn spin(scheme: Scheme, revolutions: usize) -> Result<(Kept, usize), Error> {
    let mut driver = plate(scheme)?;
    let mut kept = Kept::new(driver.system(), driver.state()).scaled_by(1.0);
    for step in 0..STEPS * revolutions {
        if driver.step().is_err() {
            return Ok((kept, step));
        }
        kept.follow(driver.state());
    }
    Ok((kept, STEPS * revolutions))
}

pub(crate) const CHECK: Check = Check {
    name: "bathe",
    fact: "Bathe's scheme: bars and a stiff plate that spins",
    run: |_| {
        let mut rows = Vec::new();
        for law in [DISPLACEMENT, velocity(carom_contact::law::Capture::Half)] {
            for against in [Against::Bar, Against::Wall] {
                for mass in [MassKind::Lumped, MassKind::Consistent] {
                    for courant in [0.25, 0.5, 1.0, 2.0, 4.0] {
                        for elements in [100, 200] {
                            let case = Run {
                                scheme: bathe(Bathe::default().gamma),
                                law,
                                against,
                                mass,
                                courant,
                                ..Run::slow(elements)
                            };
                            bars(&case, &mut rows)?;
                        }
                    }
                }
            }
        }
        for (name, scheme) in [
            ("bathe", bathe(Bathe::default().gamma)),
            ("half", bathe(0.5)),
            ("newmark", newmark(0.25, 0.5)),
        ] {
            let (kept, steps) = spin(scheme, 20)?;
            rows.push(Row::shown(format!("{name}: steps"), steps as f64));
            rows.push(Row::shown(format!("{name}: energy"), kept.energy));
            rows.push(Row::shown(format!("{name}: angular"), kept.angular));
        }
        Ok(rows)
    },
};
