//! Two elastic spheres that collide.
//!
//! Problem: two whole spheres of R = 50 mm, E = 2e10 Pa, ν = 0.3, ρ = 7800 kg/m³ meet head-on at 0.5 m/s; axisymmetric
//! quadrilaterals (cases/hertz/spheres-whole.msh), 8 elements over the largest contact radius, lumped mass, 200 steps over
//! the time in contact (quick 100). Closed solution: Hertz, T = 2.868 (m*²/(R E*² v))^(1/5) = 0.883 ms with R, E*, m* of
//! the pair, F = 4255 N; 8.2 times as long as a wave takes through a sphere and back, and a/R = 0.039. Under the velocity
//! law with closure as it stands, by nodes and by mortar; under the displacement law and the trapezoid
//! with Newton's method; neo-Hookean under the energy-momentum scheme, and under central differences in 16 000 steps, 0.9 of the critical one. At 0.1 m/s (a/R = 0.020, 11.3 transits) once more.
//!
//! Tolerance: 3 % of the time, as the issue has it (1.4 % less than Hertz at any step: spheres that are not half-spaces are
//! stiffer, here by 2 % in force at equal approach, and vibrate); a step at either end is 1 % of it. Force 3 %.
//! Impulse: the spheres keep less than 1 % of it as vibration. Energy: its residual 1e-9; energy-momentum keeps all to the
//! tolerance of its iterations, 1e-8; under the theta scheme contact makes none, to 1e-9. What the velocity law loses, where
//! nodes strike one by one, and what the trapezoid makes has no closed form: regressions, to 1 % of the figure. At nodes with closure
//! as it stands the rows lag by half a step and nodes close again and again, which loses 2.6e-3.
//!
//! Under the velocity law with closure half a step ahead too: a step takes waves across 34 elements (quick 67), and rows half a
//! step ahead along the velocity would multiply the energy by more than 10 here (docs/src/theory/laws.md).

use carom_bodies::Kinematics;
use carom_contact::{Integration, Law};
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Driver, Model, ModelTarget, Scheme};
use carom_exact::hertz::{Collision, reduced_mass};
use carom_materials::{Law as Material, NeoHooke};

use crate::Error;
use crate::build::{
    CENTRAL, DISPLACEMENT, HALF, NOW, body, contact, newmark, support, surface, theta,
};
use crate::check::{Check, Row, Size};
use crate::hertz::{DUAL, MATERIAL, RADIUS, mesh, pair};

const WHOLE: &[u8] = include_bytes!("../../../cases/hertz/spheres-whole.msh");

/// One run.
#[derive(Clone, Copy)]
struct Spheres {
    name: &'static str,
    scheme: Scheme,
    law: Law,
    integration: Integration,
    material: Material,
    /// Speed of approach, m/s.
    speed: f64,
    /// Change of the energy that was found, relative; none where it must not change.
    found: Option<f64>,
}

/// Mass of a sphere, kg.
fn mass() -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3) * MATERIAL.density
}

impl Spheres {
    fn exact(&self) -> Collision {
        pair().collision(reduced_mass([mass(); 2]), self.speed)
    }

    fn model(&self, steps: f64) -> Result<Model, Error> {
        let mesh = mesh("spheres-whole.msh", WHOLE)?;
        let mut bodies = Vec::new();
        for (name, sign) in [("upper", -0.5), ("lower", 0.5)] {
            let mut ball = body(&mesh, name, Kinematics::Axisymmetric, MATERIAL)?;
            ball.velocity = [0.0, sign * self.speed, 0.0];
            ball.spec.material = self.material;
            bodies.push(ball);
        }
        let supports = vec![
            support(&mesh, "upper.axis", [true, false, false])?,
            support(&mesh, "lower.axis", [true, false, false])?,
        ];
        let secondary = surface(&mesh, "upper.contact", &bodies[0])?;
        let primary = surface(&mesh, "lower.contact", &bodies[1])?;
        let mut touch = contact(secondary, ModelTarget::Surface(primary), self.law);
        touch.integration = self.integration;
        Ok(Model {
            contacts: vec![touch],
            supports,
            ..Model::new(bodies, mesh, self.scheme, self.exact().duration / steps)
        })
    }

    fn rows(&self, steps: f64) -> Result<Vec<Row>, Error> {
        let exact = self.exact();
        let system = crate::witness::system(self.model(steps)?)?;
        let mut run = Driver::new(system)?;
        while run.state().time < 1.1 * exact.duration {
            run.step()?;
        }
        let record = &run.state().records.contacts[0];
        let ledger = &run.state().ledger;
        let span = [record.first_closing, record.last_force].map(|time| time.unwrap_or(f64::NAN));
        let energy = ledger.initial.energy();
        let row = |what: &str| format!("{}: {what}", self.name);
        let change = ledger.balance.energy() / energy - 1.0;
        let gained = matches!(self.scheme, Scheme::Theta(_));
        let gained = gained.then(|| Row::at_most(row("energy gained / E0"), change, 1e-9));
        let mut rows = vec![
            Row::relative(
                row("time in contact, s"),
                span[1] - span[0],
                exact.duration,
                0.03,
            ),
            Row::relative(
                row("largest force, N"),
                record.peak_force,
                exact.largest.force,
                0.03,
            ),
            Row::near(
                row("impulse / (m v)"),
                record.impulse() / (mass() * self.speed),
                1.0,
                0.01,
            ),
            Row::at_most(
                row("energy residual / E0"),
                ledger.largest_energy_residual / energy,
                1e-9,
            ),
            match self.found {
                Some(own) => Row::relative(row("energy / E0 - 1"), change, own, 0.01).regression(),
                None => Row::near(row("energy / E0 - 1"), change, 0.0, 1e-8),
            },
        ];
        rows.extend(gained);
        Ok(rows)
    }
}

pub(crate) const CHECK: Check = Check {
    name: "hertz-impact",
    fact: "two colliding spheres stay in contact as long as Hertz says",
    run: |size| {
        let dual = Spheres {
            name: "velocity, mortar",
            scheme: theta(0.5),
            law: NOW,
            integration: DUAL,
            material: MATERIAL.into(),
            speed: 0.5,
            found: Some(-9.55002e-5),
        };
        let node = Spheres {
            name: "velocity, node-to-face",
            integration: Integration::Node,
            found: Some(-2.62140e-3),
            ..dual
        };
        let ahead = Spheres {
            name: "velocity, half a step ahead, mortar",
            law: HALF,
            found: Some(-9.42768e-5),
            ..dual
        };
        if size == Size::Quick {
            let runs = [
                (dual, -3.68884e-4),
                (node, -1.06233e-3),
                (ahead, -3.63834e-4),
            ];
            let rows = runs.map(|(run, found)| {
                let found = Some(found);
                Spheres { found, ..run }.rows(100.0)
            });
            return Ok(rows.into_iter().collect::<Result<Vec<_>, _>>()?.concat());
        }
        let runs = [
            dual,
            node,
            ahead,
            Spheres {
                name: "velocity, half a step ahead, node-to-face",
                integration: Integration::Node,
                found: Some(-9.51801e-5),
                ..ahead
            },
            Spheres {
                name: "velocity, mortar, 0.1 m/s",
                speed: 0.1,
                found: Some(-9.65304e-5),
                ..dual
            },
            Spheres {
                name: "displacement, mortar",
                scheme: newmark(0.25, 0.5),
                law: DISPLACEMENT,
                found: Some(1.13479e-4),
                ..dual
            },
            Spheres {
                name: "neo-Hooke, energy-momentum, mortar",
                scheme: Scheme::EnergyMomentum(EnergyMomentum {}),
                material: Material::NeoHooke(NeoHooke { initial: MATERIAL }),
                found: None,
                ..dual
            },
        ];
        let explicit = Spheres {
            name: "neo-Hooke, central differences, mortar",
            scheme: CENTRAL,
            material: Material::NeoHooke(NeoHooke { initial: MATERIAL }),
            ..dual
        };
        let mut all = Vec::new();
        for run in runs {
            all.extend(run.rows(200.0)?);
        }
        let explicit = [
            Spheres {
                found: Some(-4.16460e-7),
                ..explicit
            },
            Spheres {
                name: "neo-Hooke, central differences, node-to-face",
                integration: Integration::Node,
                found: Some(-4.12582e-7),
                ..explicit
            },
        ];
        for run in explicit {
            all.extend(run.rows(16_000.0)?);
        }
        Ok(all)
    },
};
