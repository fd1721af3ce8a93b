//! A free bar that spins.
//!
//! Problem: a bar of 1 m by 0.1 m in the plane, neo-Hooke, E = 1e6 Pa, ν = 0.3, ρ = 1000 kg/m³, spins at one revolution per
//! second about its centre, free and at first unstretched: the spin stretches it by about one per cent, and it goes on to vibrate
//! along its axis. Large steps: 20 a revolution.
//! Closed facts: linear momentum, angular momentum and energy stay. Reference: Simo, Tarnow (1992), whose scheme keeps them; the
//! trapezoid and the mid-point rule, neutral for linear systems, do not.
//! Tolerance: 1e-10 of the momenta and 1e-8 of the energy over the whole run, as the issue states for tolerance 1e-12 of an
//! iteration: what the iterations leave adds up over 20000 steps.

use carom_bodies::{BodySpec, Formulation, Kinematics, MassKind};
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Model, ModelBody, Newton, Nonlinear, Scheme, System};
use carom_materials::{Elastic, Law, NeoHooke};
use carom_mesh::generate;

use crate::Error;
use crate::build::{group, newmark, theta};
use crate::check::{Check, Row, Size};
use crate::kept::Kept;

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.3,
};
const LENGTH: f64 = 1.0;
const HEIGHT: f64 = 0.1;
const SPIN: f64 = 2.0 * std::f64::consts::PI;

fn newton(scheme: Scheme, steps: usize) -> Result<Newton, Error> {
    let corner = [-0.5 * LENGTH, -0.5 * HEIGHT];
    let mesh = generate::rectangle("bar", corner, [LENGTH, HEIGHT], [10, 1], false);
    let model = Model {
        bodies: vec![ModelBody {
            spec: BodySpec {
                name: "bar".to_string(),
                cells: group(&mesh, "bar")?.elements.clone(),
                kinematics: Kinematics::PlaneStrain { thickness: 1.0 },
                material: Law::NeoHooke(NeoHooke { initial: RUBBER }),
                formulation: Formulation::Full,
                weights: None,
            },
            mass: MassKind::Lumped,
            velocity: [0.0; 3],
            displacement: [0.0; 3],
        }],
        supports: Vec::new(),
        gravity: [0.0; 3],
        contacts: Vec::new(),
        scheme,
        dt: 1.0 / steps as f64,
        adaptive: None,
        nonlinear: Nonlinear::default(),
        mesh,
    };
    let mut model = model;
    model.nonlinear.iteration.tolerance = 1e-12;
    let system = System::new(model)?;
    let spin = |node: &[f64; 3]| [-SPIN * node[1], SPIN * node[0]];
    let velocity: Vec<f64> = system.x.iter().flat_map(spin).collect();
    let mut newton = Newton::new(system)?;
    let still = vec![0.0; velocity.len()];
    newton.restart(&still, &velocity)?;
    Ok(newton)
}

/// What a run of the bar did.
struct Spun {
    kept: Kept,
    /// Revolutions until the run ended or found no equilibrium.
    revolutions: f64,
    failed: bool,
}

fn spin(scheme: Scheme, steps: usize, revolutions: usize) -> Result<Spun, Error> {
    let mut newton = newton(scheme, steps)?;
    let mass = newton.system().body_mass(0);
    let kept = Kept::new(newton.system(), newton.state());
    let mut kept = kept.scaled_by(mass * SPIN * 0.25 * LENGTH);
    let mut failed = false;
    for _ in 0..steps * revolutions {
        if newton.step().is_err() {
            failed = true;
            break;
        }
        kept.follow(newton.state());
    }
    let revolutions = newton.state().time;
    Ok(Spun { kept, revolutions, failed })
}

pub(crate) const CHECK: Check = Check {
    name: "spinning-bar",
    fact: "a spinning bar keeps momenta and energy over a thousand revolutions with energy-momentum, and not with the trapezoid",
    run: |size| {
        let revolutions = match size {
            Size::Quick => 20,
            Size::Full => 1000,
        };
        let mut rows = Vec::new();
        for (name, scheme) in [
            ("energy-momentum", Scheme::EnergyMomentum(EnergyMomentum)),
            ("newmark", newmark(0.25, 0.5)),
            ("theta 0.5", theta(0.5)),
            ("theta 0.6", theta(0.6)),
        ] {
            let begin = std::time::Instant::now();
            let spun = spin(scheme, 20, revolutions)?;
            println!("{name}: {:e} {:e} {:e} {} {} {:?}", spun.kept.linear, spun.kept.angular, spun.kept.energy, spun.revolutions, spun.failed, begin.elapsed());
            rows.push(Row::at_most(format!("{name}: energy"), spun.kept.energy, 1e-8));
        }
        Ok(rows)
    },
};
