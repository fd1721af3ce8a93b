//! A ring whose impact sector is a finer zone, against the ring in one mesh.

use std::f64::consts::PI;

use carom_bodies::Kinematics;
use carom_contact::Plane;
use carom_dynamics::{
    LinkKind, Model, ModelBody, ModelLink, ModelTarget, ModelZone, Newton, Nonlinear, Scheme,
    System, Zoned, Zones, mortar_rows,
};
use carom_materials::{Elastic, Law, NeoHooke};
use carom_mesh::{Mesh, generate};

use crate::Error;
use crate::build::{CENTRAL, NOW, body, contact, newmark, surface, theta};
use crate::check::{Check, Row, Size};

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.3,
};
const THICKNESS: f64 = 0.1;
const SECTOR: f64 = PI / 6.0;

fn env<T: std::str::FromStr>(name: &str, default: T) -> T {
    std::env::var(name).ok().and_then(|s| s.parse().ok()).unwrap_or(default)
}

pub(crate) const CHECK: Check = Check {
    name: "ring-sector",
    fact: "a finer zone at the impact gives the contact force of the single mesh",
    run: |size| {
        let ring = Ring {
            rest: [env("RR", 2), env("RA", 60)],
            sector: [env("SR", 4), env("SA", 24)],
            outer: match env("CENTRAL", 0) { 1 => CENTRAL, _ => newmark(0.25, 0.5) },
            dt: env("DT", 4e-3),
            end: env("END", match size { Size::Quick => 0.1, Size::Full => 1.2 }),
        };
        let begin = std::time::Instant::now();
        let one = ring.single()?;
        println!("single {:?}", begin.elapsed());
        let begin = std::time::Instant::now();
        let (two, passes) = ring.glued()?;
        println!("glued {:?} passes {passes}", begin.elapsed());
        let (mut gap, mut norm, mut impulse) = (0.0, 0.0, [0.0; 2]);
        let mut peak = [0.0_f64; 2];
        for (k, (a, b)) in one.iter().zip(&two).enumerate() {
            if env("SHOW", 0) == 1 { println!("{:.4} {:.5} {:.5}", ring.dt * (k + 1) as f64, a, b); }
            gap += (a - b).powi(2);
            norm += a * a;
            impulse = [impulse[0] + a, impulse[1] + b];
            peak = [peak[0].max(*a), peak[1].max(*b)];
        }
        println!("L2 {} impulse {} peak {}", f64::sqrt(gap / norm), impulse[1] / impulse[0] - 1.0, peak[1] / peak[0] - 1.0);
        for window in [2, 5, 10, 20] {
            let mean = |force: &[f64]| force.chunks(window).map(|c| c.iter().sum::<f64>() / c.len() as f64).collect::<Vec<_>>();
            let [a, b] = [&one, &two].map(|f| mean(f));
            let gap: f64 = a.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum();
            let norm: f64 = a.iter().map(|a| a * a).sum();
            let peak = [&a, &b].map(|f| f.iter().fold(0.0, |m: f64, f| m.max(*f)));
            println!("window {window}: L2 {} peak {}", (gap / norm).sqrt(), peak[1] / peak[0] - 1.0);
        }
        Ok(Vec::<Row>::new())
    },
};

/// A ring about the origin that flies against the wall x = 1.
struct Ring {
    /// Elements across and round of the rest.
    rest: [usize; 2],
    /// The same of the sector.
    sector: [usize; 2],
    /// Scheme of the rest.
    outer: Scheme,
    /// Outer step, s.
    dt: f64,
    end: f64,
}

const SUBSTEPS: u32 = 4;

impl Ring {
    /// A part of the ring from one angle to another.
    fn part(&self, name: &str, [from, to]: [f64; 2], n: [usize; 2]) -> Mesh {
        let mut mesh =
            generate::rectangle(name, [1.0 - THICKNESS, from], [THICKNESS, to - from], n, false);
        for x in &mut mesh.nodes {
            let [r, angle, _] = *x;
            *x = [r * angle.cos(), r * angle.sin(), 0.0];
        }
        mesh
    }

    fn body(&self, mesh: &Mesh, name: &str) -> Result<ModelBody, Error> {
        let kinematics = Kinematics::PlaneStrain { thickness: 1.0 };
        let mut body = body(mesh, name, kinematics, RUBBER)?;
        body.spec.material = Law::NeoHooke(NeoHooke { initial: RUBBER });
        body.velocity = [env("V", 0.5), 0.0, 0.0];
        Ok(body)
    }

    fn model(&self, mesh: Mesh, bodies: Vec<ModelBody>, dt: f64) -> Result<Model, Error> {
        let wall = ModelTarget::rigid(Plane {
            point: [1.0, 0.0, 0.0],
            normal: [-1.0, 0.0, 0.0],
        });
        let touch = contact(surface(&mesh, "sector.right", &bodies[0])?, wall, NOW);
        let mut nonlinear = Nonlinear::default();
        nonlinear.iteration.tolerance = env("TOL", 1e-10);
        Ok(Model {
            mesh,
            bodies,
            supports: Vec::new(),
            gravity: [0.0; 3],
            contacts: vec![touch],
            scheme: theta(env("THETA", 0.55)),
            dt,
            adaptive: None,
            nonlinear,
        })
    }

    /// Mean contact force of each outer step in one mesh as fine as the sector.
    fn single(&self) -> Result<Vec<f64>, Error> {
        let [across, round] = self.sector;
        let n = [across, 5 * round];
        let mut mesh = self.part("sector", [-SECTOR, SECTOR], self.sector);
        mesh.merge("ring", self.part("rest", [SECTOR, 2.0 * PI - SECTOR], n))?;
        let mesh = welded(mesh);
        let mut body = self.body(&mesh, "sector")?;
        body.spec.cells.extend(&mesh.groups["rest"].elements);
        let dt = self.dt / f64::from(SUBSTEPS);
        let mut newton = Newton::new(System::new(self.model(mesh, vec![body], dt)?)?)?;
        let mut forces = Vec::new();
        while forces.len() < (self.end / self.dt).round() as usize {
            let mut sum = 0.0;
            for _ in 0..SUBSTEPS {
                newton.step()?;
                sum += newton.report().contacts[0].force;
            }
            forces.push(sum / f64::from(SUBSTEPS));
        }
        Ok(forces)
    }

    /// The same in two zones.
    fn glued(&self) -> Result<(Vec<f64>, f64), Error> {
        let mut mesh = self.part("sector", [-SECTOR, SECTOR], self.sector);
        mesh.merge("ring", self.part("rest", [SECTOR, 2.0 * PI - SECTOR], self.rest))?;
        let bodies = vec![self.body(&mesh, "sector")?, self.body(&mesh, "rest")?];
        let link = |name: &str, sides: [&str; 2]| {
            let inner = surface(&mesh, sides[0], &bodies[0])?;
            let outer = surface(&mesh, sides[1], &bodies[1])?;
            Ok::<_, Error>(ModelLink {
                name: name.to_string(),
                zones: [0, 1],
                rows: mortar_rows(&mesh, &inner, &outer, |_| 1.0).rows,
            })
        };
        let links = vec![
            link("first", ["sector.bottom", "rest.top"])?,
            link("last", ["sector.top", "rest.bottom"])?,
        ];
        let zone = |body: usize, scheme, substeps| ModelZone {
            name: ["sector", "rest"][body].to_string(),
            bodies: vec![body],
            scheme,
            substeps,
            far: None,
        };
        let mut zones = Zones::new(&Zoned {
            zones: vec![
                zone(0, theta(env("THETA", 0.55)), SUBSTEPS),
                zone(1, self.outer, 1),
            ],
            links,
            kind: LinkKind::PrakashHjelmstad,
            model: self.model(mesh, bodies, self.dt)?,
        })?;
        let mut forces = Vec::new();
        while forces.len() < (self.end / self.dt).round() as usize {
            zones.step()?;
            let samples = zones.samples().iter().filter(|s| !s.contacts.is_empty());
            let sum: f64 = samples.map(|s| s.contacts[0].force).sum();
            forces.push(sum / f64::from(SUBSTEPS));
        }
        Ok((forces, zones.all_passes() as f64 / zones.outer_step() as f64))
    }
}

/// The mesh with nodes at the same place as one.
fn welded(mut mesh: Mesh) -> Mesh {
    let mut first = Vec::new();
    for (node, x) in mesh.nodes.iter().enumerate() {
        let near = |y: &[f64; 3]| (0..2).all(|i| (x[i] - y[i]).abs() < 1e-9);
        first.push(mesh.nodes[..node].iter().position(near).unwrap_or(node) as u32);
    }
    for block in &mut mesh.blocks {
        for node in &mut block.nodes {
            *node = first[*node as usize];
        }
    }
    mesh
}
