//! A rotating bar of two zones glued by an oblique overlap.
//!
//! Problem: a free bar of 9 h by 2 h in plane strain, neo-Hookean with E = ρ = 1 and ν = 0.3, in two zones whose meshes do not
//! match (h / 1.5 and h), sheared by 30 degrees and with them the borders of the overlap; linear weights, coarse L2 mediator.
//! (1) It flies and spins at 0.08 c / h, where the centrifugal strain is a twentieth, with steps of h / c, for one revolution or
//! five. (2) Turned by a radian as it lies, it goes on turning at 10⁻⁵ c / L for 50 steps.
//!
//! Closed solution: (1) linear and angular momentum stay; with the energy-momentum scheme the energy, too. The rows hold for
//! velocities at both ends of each step, hence for displacements where a zone moves by dt times the mean of the two, and
//! with them the moment of the multipliers vanishes in the middle of the step. There energy-momentum and theta ½ have all
//! their forces: 10⁻¹⁰ is the rounding of 400 steps against rows that hold to 10⁻¹². The trapezoid has its forces at the
//! ends and keeps no angular momentum, glued or not: what it loses is shown.
//! (2) No stress but the centrifugal one, (10⁻⁵)²/8 E = 1.2·10⁻¹¹ E: 10⁻⁹ E is the figure of the requirement.

use std::f64::consts::PI;

use carom_bodies::Kinematics;
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Model, ModelLink, Nonlinear, Scheme};
use carom_materials::{Elastic, Law, NeoHooke};
use carom_mesh::{Mesh, generate};
use carom_zones::{LinkKind, ModelZone, Zoned, Zones};

use crate::Error;
use crate::build::{glued, newmark, plane_motion, theta};
use crate::check::{Check, Row, Size};

const BETWEEN: Scheme = Scheme::EnergyMomentum(EnergyMomentum {});

const MATERIAL: Elastic = Elastic {
    density: 1.0,
    young: 1.0,
    poisson: 0.3,
};

/// Length of the bar in sizes of the coarse elements, which is 1.
const LENGTH: f64 = 9.0;
const HEIGHT: f64 = 2.0;
/// Angular velocity, 1/s, and velocity along the bar, m/s.
const SPIN: f64 = 0.08;
const FLIGHT: f64 = 0.1;
/// tan 30°.
const SHEAR: f64 = 0.577_350_269_189_625_8;

pub(crate) const CHECK: Check = Check {
    name: "glued-rotating",
    fact: "a rotating bar glued by an oblique overlap keeps its momenta and its patch",
    run: |size| {
        let revolutions = match size {
            Size::Quick => 1.0,
            Size::Full => 5.0,
        };
        let mut rows = Vec::new();
        for (name, schemes) in [
            ("energy-momentum", [BETWEEN; 2]),
            ("theta 0.5", [theta(0.5); 2]),
            ("energy-momentum and theta 0.5", [BETWEEN, theta(0.5)]),
        ] {
            let kept = spin(schemes, revolutions)?;
            rows.push(Row::at_most(
                format!("{name}: momentum"),
                kept.linear,
                1e-10,
            ));
            let angular = format!("{name}: angular momentum");
            rows.push(Row::at_most(angular, kept.angular, 1e-10));
            if schemes == [BETWEEN; 2] {
                rows.push(Row::at_most(format!("{name}: energy"), kept.energy, 1e-9));
            }
            let [multiplier, force] = patch(schemes)?;
            let patch = format!("{name}: turned, L h / E");
            rows.push(Row::at_most(patch, multiplier, 1e-9));
            rows.push(Row::at_most(
                format!("{name}: turned, f / (E h)"),
                force,
                1e-9,
            ));
        }
        let kept = spin([newmark(0.25, 0.5); 2], revolutions)?;
        rows.push(Row::at_most("trapezoid: momentum", kept.linear, 1e-10));
        let lost = kept.angular;
        rows.push(Row::shown("trapezoid: angular momentum", lost));
        Ok(rows)
    },
};

fn mesh() -> Result<Mesh, Error> {
    let part = |name: &str, from: f64, to: f64, n: [usize; 2]| {
        generate::rectangle(name, [from, 0.0], [to - from, HEIGHT], n, false)
    };
    let mut mesh = part("fine", 0.0, 4.0, [6, 3]);
    mesh.merge("bar", part("coarse", 2.0, LENGTH, [7, 2]))?;
    for x in &mut mesh.nodes {
        x[0] += SHEAR * x[1] - 0.5 * (LENGTH + SHEAR * HEIGHT);
        x[1] -= 0.5 * HEIGHT;
    }
    Ok(mesh)
}

fn zones(schemes: [Scheme; 2], dt: f64) -> Result<Zones, Error> {
    let mesh = mesh()?;
    let kinematics = Kinematics::PlaneStrain { thickness: 1.0 };
    let (mut bodies, rows) = glued(&mesh, ["fine", "coarse"], kinematics, MATERIAL)?;
    for body in &mut bodies {
        body.spec.material = Law::NeoHooke(NeoHooke { initial: MATERIAL });
    }
    let zone =
        |body: usize| ModelZone::new(["fine", "coarse"][body], vec![body], (schemes[body], 1));
    let mut nonlinear = Nonlinear::default();
    nonlinear.iteration.tolerance = 1e-12;
    Ok(crate::witness::zones(&Zoned {
        zones: vec![zone(0), zone(1)],
        links: vec![ModelLink {
            name: "bar".to_string(),
            zones: [0, 1],
            rows: rows.rows,
        }],
        kind: LinkKind::GravouilCombescure,
        model: Model {
            nonlinear,
            ..Model::new(bodies.into(), mesh, theta(0.5), dt)
        },
    })?)
}

/// Largest changes of what a spin keeps, relative.
#[derive(Default)]
struct Kept {
    linear: f64,
    angular: f64,
    energy: f64,
}

/// Flies and turns, started without the stretch that goes with it.
fn spin(schemes: [Scheme; 2], revolutions: f64) -> Result<Kept, Error> {
    let mut zones = zones(schemes, 1.0)?;
    let start = plane_motion(&zones, |x| [[0.0; 2], [FLIGHT - SPIN * x[1], SPIN * x[0]]]);
    zones.restart(&start)?;
    let start = zones.balance();
    let mut kept = Kept::default();
    let size = |a: [f64; 3]| a.iter().map(|a| a * a).sum::<f64>().sqrt();
    let change = |a: [f64; 3], b: [f64; 3]| size([0, 1, 2].map(|i| a[i] - b[i])) / size(b);
    while zones.time() < 2.0 * PI / SPIN * revolutions {
        zones.step()?;
        let now = zones.balance();
        let [p, q] = [&now.momentum, &start.momentum];
        kept.linear = kept.linear.max(change(p.linear, q.linear));
        kept.angular = kept.angular.max(change(p.angular, q.angular));
        let energy = (now.energy() / start.energy() - 1.0).abs();
        kept.energy = kept.energy.max(energy);
    }
    Ok(kept)
}

/// Largest multiplier times h over E, and internal force over E h, of a bar turned by a radian that goes on turning
/// slowly, over 50 steps.
fn patch(schemes: [Scheme; 2]) -> Result<[f64; 2], Error> {
    let mut zones = zones(schemes, 0.2)?;
    let (sine, cosine) = 1.0f64.sin_cos();
    let slow = 1e-5 / LENGTH;
    let start = plane_motion(&zones, |x| {
        let turned = [cosine * x[0] - sine * x[1], sine * x[0] + cosine * x[1]];
        [
            [turned[0] - x[0], turned[1] - x[1]],
            [-slow * turned[1], slow * turned[0]],
        ]
    });
    zones.restart(&start)?;
    let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let (mut multiplier, mut force) = (0.0_f64, 0.0_f64);
    for _ in 0..50 {
        zones.step()?;
        multiplier = multiplier.max(largest(zones.multipliers()));
        for driver in zones.drivers() {
            force = force.max(largest(&driver.state().motion.internal_force));
        }
    }
    Ok([multiplier, force])
}
