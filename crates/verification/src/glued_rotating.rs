//! A rotating bar of two zones glued by an oblique overlap.

use std::f64::consts::PI;

use carom_bodies::Kinematics;
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{LinkKind, Model, ModelLink, ModelZone, Nonlinear, Scheme, Zoned, Zones};
use carom_materials::{Elastic, Law, NeoHooke};
use carom_mesh::{Mesh, generate};

use crate::Error;
use crate::build::{CENTRAL, glued, newmark, plane_motion, theta};
use crate::check::{Check, Row, Size};

const BETWEEN: Scheme = Scheme::EnergyMomentum(EnergyMomentum);

const MATERIAL: Elastic = Elastic {
    density: 1.0,
    young: 1.0,
    poisson: 0.3,
};

/// Length of the bar in sizes of the coarse elements, which is 1.
const LENGTH: f64 = 9.0;
const HEIGHT: f64 = 2.0;
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
        let dt: f64 = std::env::var("DT").ok().and_then(|s| s.parse().ok()).unwrap_or(1.0);
        for (name, schemes) in [
            ("em", [BETWEEN; 2]),
            ("theta", [theta(0.5); 2]),
            ("em theta", [BETWEEN, theta(0.5)]),
            ("trapezoid", [newmark(0.25, 0.5); 2]),
            ("theta trapezoid", [theta(0.5), newmark(0.25, 0.5)]),
            ("theta .6", [theta(0.6), newmark(0.25, 0.5)]),
        ] {
            let begin = std::time::Instant::now();
            let spin = Spin { speed: 0.08, schemes, dt };
            match spin.run(revolutions) {
                Ok(kept) => println!("{name}: {kept:?} {:?}", begin.elapsed()),
                Err(error) => println!("{name}: {error}"),
            }
        }
        println!("{:?}", patch([theta(0.5); 2])?);
        println!("{:?}", patch([BETWEEN; 2])?);
        println!("{:?}", patch([theta(0.6), CENTRAL])?);
        Ok(Vec::<Row>::new())
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
    let zone = |body: usize| ModelZone {
        name: ["fine", "coarse"][body].to_string(),
        bodies: vec![body],
        scheme: schemes[body],
        substeps: 1,
        far: None,
    };
    let mut nonlinear = Nonlinear::default();
    nonlinear.iteration.tolerance = 1e-12;
    Ok(Zones::new(&Zoned {
        zones: vec![zone(0), zone(1)],
        links: vec![ModelLink {
            name: "bar".to_string(),
            zones: [0, 1],
            rows: rows.rows,
        }],
        kind: LinkKind::GravouilCombescure,
        model: Model {
            mesh,
            bodies: bodies.into(),
            supports: Vec::new(),
            gravity: [0.0; 3],
            contacts: Vec::new(),
            scheme: theta(0.5),
            dt,
            adaptive: None,
            nonlinear,
        },
    })?)
}

/// A free rotation, started without the stretch that goes with it.
struct Spin {
    /// 1/s.
    speed: f64,
    schemes: [Scheme; 2],
    dt: f64,
}

/// Largest changes of what a spin keeps, relative.
#[derive(Debug, Default)]
struct Kept {
    linear: f64,
    angular: f64,
    energy: f64,
    /// Work of the link over the energy.
    link: f64,
    passes: f64,
    most: usize,
}

impl Spin {
    fn run(&self, revolutions: f64) -> Result<Kept, Error> {
        let mut zones = zones(self.schemes, self.dt)?;
        let flight = 0.1;
        let start = plane_motion(&zones, |x| {
            [[0.0; 2], [flight - self.speed * x[1], self.speed * x[0]]]
        });
        zones.restart(&start)?;
        let start = zones.balance();
        let mut kept = Kept::default();
        let size = |a: [f64; 3]| a.iter().map(|a| a * a).sum::<f64>().sqrt();
        let change = |a: [f64; 3], b: [f64; 3]| size([0, 1, 2].map(|i| a[i] - b[i])) / size(b);
        while zones.time() < 2.0 * PI / self.speed * revolutions {
            zones.step()?;
            let now = zones.balance();
            let [p, q] = [&now.momentum, &start.momentum];
            kept.linear = kept.linear.max(change(p.linear, q.linear));
            kept.angular = kept.angular.max(change(p.angular, q.angular));
            kept.energy = kept.energy.max((now.energy() / start.energy() - 1.0).abs());
            kept.link = kept.link.max(now.work_links.abs() / start.energy());
            kept.most = kept.most.max(zones.passes());
        }
        kept.passes = zones.all_passes() as f64 / zones.outer_step() as f64;
        Ok(kept)
    }
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
