//! A tube of rubber that hardly changes its volume breathes, and spins.
//!
use std::f64::consts::PI;

use carom_bodies::{Formulation, Kinematics};
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Model, Newton, Nonlinear, Scheme, System};
use carom_materials::{Elastic, Law, NeoHooke};
use carom_mesh::{Mesh, generate};

use crate::Error;
use crate::build::body;
use crate::check::{Check, Row, Size};
use crate::kept::Kept;

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.499,
};
const INNER: f64 = 0.5;
const OUTER: f64 = 1.0;
/// Speed of the inner wall at the start, m/s.
const SPEED: f64 = 6.0;

/// Energy, over 2π, of the tube without inertia whose inner radius is `a`, J.
fn stored(a: f64) -> f64 {
    let mu = RUBBER.young / (2.0 * (1.0 + RUBBER.poisson));
    let n = 200;
    let h = (OUTER - INNER) / n as f64;
    (0..n)
        .map(|k| {
            let r0 = INNER + (k as f64 + 0.5) * h;
            let stretch = (r0 * r0 + a * a - INNER * INNER).sqrt() / r0;
            0.5 * mu * (stretch - 1.0 / stretch).powi(2) * r0 * h
        })
        .sum()
}

fn inertia(a: f64) -> f64 {
    let b = (OUTER * OUTER + a * a - INNER * INNER).sqrt();
    RUBBER.density * a * a * (b / a).ln()
}

/// Largest inner radius and its time.
fn exact() -> (f64, f64) {
    let energy = 0.5 * inertia(INNER) * SPEED * SPEED;
    let (mut lo, mut hi) = (INNER, 10.0 * INNER);
    for _ in 0..60 {
        let mid = 0.5 * (lo + hi);
        if stored(mid) < energy {
            lo = mid
        } else {
            hi = mid
        }
    }
    let n = 400;
    let h = 0.5 * PI / n as f64;
    let time = (0..n)
        .map(|k| {
            let (sin, cos) = ((k as f64 + 0.5) * h).sin_cos();
            let a = INNER + (lo - INNER) * sin;
            (lo - INNER) * cos * h / (2.0 * (energy - stored(a)) / inertia(a)).sqrt()
        })
        .sum();
    (lo, time)
}

fn tube(n: [usize; 2]) -> Mesh {
    let mut mesh = generate::rectangle(
        "tube",
        [INNER, 0.0],
        [OUTER - INNER, 2.0 * PI],
        n,
        false,
    );
    for x in &mut mesh.nodes {
        let [r, angle, _] = *x;
        *x = [r * angle.cos(), r * angle.sin(), 0.0];
    }
    crate::ring_sector::welded(mesh)
}

fn newton(formulation: Formulation, n: [usize; 2], spin: f64, dt: f64) -> Result<Newton, Error> {
    let mesh = tube(n);
    let mut body = body(
        &mesh,
        "tube",
        Kinematics::PlaneStrain { thickness: 1.0 },
        RUBBER,
    )?;
    body.spec.material = Law::NeoHooke(NeoHooke { initial: RUBBER });
    body.spec.formulation = formulation;
    let mut model = Model {
        bodies: vec![body],
        supports: Vec::new(),
        gravity: [0.0; 3],
        contacts: Vec::new(),
        scheme: Scheme::EnergyMomentum(EnergyMomentum),
        dt,
        adaptive: None,
        nonlinear: Nonlinear::default(),
        mesh,
    };
    model.nonlinear.iteration.tolerance = 1e-13;
    model.nonlinear.iteration.passes = 200;
    let system = System::new(model)?;
    let velocity: Vec<f64> = system
        .x
        .iter()
        .flat_map(|x| {
            let out = SPEED * INNER / (x[0] * x[0] + x[1] * x[1]);
            [out * x[0] - spin * x[1], out * x[1] + spin * x[0]]
        })
        .collect();
    let mut newton = Newton::new(system)?;
    newton.restart(&vec![0.0; velocity.len()], &velocity)?;
    Ok(newton)
}

pub(crate) const CHECK: Check = Check {
    name: "breathing-tube",
    fact: "a nearly incompressible tube keeps momenta and energy with mean dilatation and does not lock",
    run: |size| {
        let (a, t) = exact();
        eprintln!("exact {a} {t}");
        let steps = 40;
        for (formulation, spin) in [
            (Formulation::BBar, 0.0),
            (Formulation::Full, 0.0),
            (Formulation::BBar, 4.0),
            (Formulation::Full, 4.0),
            (Formulation::BBar, 20.0),
            (Formulation::Full, 20.0),
        ] {
            for per in [10, 20, 40] {
                let begin = std::time::Instant::now();
                let mut newton = newton(formulation, [3, 32], spin, t / per as f64)?;
                let mut kept = Kept::new(newton.system(), newton.state());
                let node = newton.system().x.iter().position(|x| (x[0] - INNER).abs() < 1e-9).unwrap_or(0);
                let mut iterations = Vec::new();
                let mut best = (0.0, 0.0);
                for k in 0..300 {
                    if let Err(error) = newton.step() { eprintln!("{error}"); break; }
                    kept.follow(newton.state());
                    iterations.push(newton.residuals().len());
                    let u = &newton.state().motion.u;
                    let a = f64::hypot(INNER + u[2 * node], u[2 * node + 1]);
                    if a > best.0 && k < per * 2 { best = (a, newton.state().time); }
                }
                let costs = newton.costs();
                eprintln!("{formulation:?} spin {spin} per {per}: L {:.1e} A {:.1e} E {:.1e}; a {:.4} t {:.5}; iterations {:.1} max {} halved {} {:?} fact {} wall {:?}", kept.linear, kept.angular, kept.energy, best.0, best.1,
                   iterations.iter().sum::<usize>() as f64 / iterations.len() as f64, iterations.iter().max().unwrap_or(&0), newton.state().step, newton.state().time, costs.work.factorisations, begin.elapsed());
            }
        }
        let _ = (size, steps);
        Ok(vec![Row::at_most("x", 0.0, 1.0)])
    },
};
