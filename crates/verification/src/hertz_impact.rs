//! x
use carom_bodies::Kinematics;
use carom_contact::{Integration, Law};
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Driver, Model, ModelTarget, Newton, Scheme, Stepper, System};
use carom_exact::hertz::reduced_mass;
use carom_materials::{Law as Material, NeoHooke, Plane};

use crate::Error;
use crate::build::{DISPLACEMENT, HALF, NOW, body, contact, newmark, support, surface, theta};
use crate::check::{Check, Row, Size};
use crate::hertz::{DUAL, MATERIAL, RADIUS, mesh, pair};

const WHOLE: &[u8] = include_bytes!("../../../cases/hertz/spheres-whole.msh");

fn model(scheme: Scheme, law: Law, integration: Integration, material: Material, speed: f64, dt: f64) -> Result<Model, Error> {
    let mesh = mesh("spheres-whole.msh", WHOLE)?;
    let mut bodies = Vec::new();
    for (name, sign) in [("upper", -0.5), ("lower", 0.5)] {
        let mut ball = body(&mesh, name, Kinematics::Axisymmetric, MATERIAL)?;
        ball.velocity = [0.0, sign * speed, 0.0];
        ball.spec.material = material;
        bodies.push(ball);
    }
    let supports = vec![
        support(&mesh, "upper.axis", [true, false, false])?,
        support(&mesh, "lower.axis", [true, false, false])?,
    ];
    let secondary = surface(&mesh, "upper.contact", &bodies[0])?;
    let primary = surface(&mesh, "lower.contact", &bodies[1])?;
    let mut touch = contact(secondary, ModelTarget::Surface(primary), law);
    touch.integration = integration;
    if std::env::var("SMALL").is_ok() { touch.sliding = carom_contact::Sliding::Small; }
    Ok(Model {
        contacts: vec![touch],
        bodies,
        supports,
        gravity: [0.0; 3],
        scheme,
        dt,
        adaptive: None,
        nonlinear: carom_dynamics::Nonlinear::default(),
        mesh,
    })
}

pub(crate) const CHECK: Check = Check {
    name: "hertz-impact",
    fact: "x",
    run: |_size| {
        let mut rows = Vec::new();
        let mass = 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3) * MATERIAL.density;
        let speed: f64 = std::env::var("V").map_or(0.5, |v| v.parse().unwrap());
        let steps: f64 = std::env::var("N").map_or(200.0, |v| v.parse().unwrap());
        let exact = pair().collision(reduced_mass([mass; 2]), speed);
        let transit = 4.0 * RADIUS / MATERIAL.wave_speed(Plane::Full);
        println!("a/R {} T {} T/transit {}", exact.largest.radius / RADIUS, exact.duration, exact.duration / transit);
        let dt = exact.duration / steps;
        let neo: Material = Material::NeoHooke(NeoHooke { initial: MATERIAL });
        let em = Scheme::EnergyMomentum(EnergyMomentum);
        let node = Integration::Node;
        let linear = MATERIAL.into();
        for (name, newton, scheme, law, integration, material) in [
            ("driver theta half node", false, theta(0.5), HALF, node, linear),
            ("driver theta now node", false, theta(0.5), NOW, node, linear),
            ("driver theta now dual", false, theta(0.5), NOW, DUAL, linear),
            ("driver theta half dual", false, theta(0.5), HALF, DUAL, linear),
            ("driver theta 0.55 half dual", false, theta(0.55), HALF, DUAL, linear),
            ("newton theta half node", true, theta(0.5), HALF, node, linear),
            ("newton theta now dual", true, theta(0.5), NOW, DUAL, linear),
            ("newton trapezoid displacement dual", true, newmark(0.25, 0.5), DISPLACEMENT, DUAL, linear),
            ("newton theta 0.6 displacement dual", true, theta(0.6), DISPLACEMENT, DUAL, linear),
            ("newton newmark .49 .9 displacement dual", true, newmark(0.49, 0.9), DISPLACEMENT, DUAL, linear),
            ("neo-hooke theta half dual", true, theta(0.5), HALF, DUAL, neo),
            ("neo-hooke em half dual", true, em, HALF, DUAL, neo),
            ("neo-hooke trapezoid displacement dual", true, newmark(0.25, 0.5), DISPLACEMENT, DUAL, neo),
        ] {
            let only = std::env::var("ONLY").unwrap_or_default();
            if !name.contains(&only) { continue; }
            let begin = std::time::Instant::now();
            let system = System::new(model(scheme, law, integration, material, speed, dt)?)?;
            let mut run: Box<dyn Stepper> = match newton {
                true => Box::new(Newton::new(system)?),
                false => Box::new(Driver::new(system)?),
            };
            let end = 1.2 * exact.duration;
            let mut passes = 0;
            let mut result = Ok(());
            while run.state().time < end && result.is_ok() {
                result = run.step();
                passes += run.report().passes;
                if std::env::var("SHOW").is_ok() { let r = run.report(); println!("{:.4} {:.5} {:.6} {} {}", r.time / exact.duration, r.contacts[0].force / exact.largest.force, r.balance.energy() / run.state().ledger.initial.energy(), r.contacts[0].closed, r.contacts[0].gap); }
            }
            if let Err(e) = result { println!("{e}"); }
            let record = &run.state().records.contacts[0];
            let duration = record.last_force.unwrap_or(0.0) - record.first_closing.unwrap_or(0.0);
            let momentum = 0.5 * speed * mass;
            let costs = run.costs();
            println!("{name} {:.2} s {:?} {:?} passes {passes}", begin.elapsed().as_secs_f64(), costs.phases, costs.work);
            rows.push(Row::relative(format!("{name} duration"), duration, exact.duration, 0.03));
            rows.push(Row::relative(format!("{name} peak"), record.peak_force, exact.largest.force, 0.03));
            rows.push(Row::relative(format!("{name} impulse"), record.impulse(), 2.0 * momentum, 0.03));
            let ledger = &run.state().ledger;
            rows.push(Row::at_most(format!("{name} energy residual"), ledger.largest_energy_residual / ledger.initial.energy(), 1e-9));
            rows.push(Row::near(format!("{name} energy"), ledger.balance.energy() / ledger.initial.energy(), 1.0, 1e-2));
        }
        Ok(rows)
    },
};
