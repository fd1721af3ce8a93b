//! What overlaps of thin bodies with finite rotations and solids at finite strain are asked.

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::{Mat3, Vec3};
use carom_algebra::unknowns::Kind;
use carom_bodies::MassKind;
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{
    Amplitude, Driver, Load, LoadKind, Model, ModelBody, ModelConstraint, ModelLink, NodalLoad,
    Scheme, System,
};
use carom_materials::Elastic;
use carom_mesh::Mesh;
use carom_zones::{Glued, LinkKind, ModelZone, Zoned};

use crate::Error;
use crate::build::{newmark, surface};
use crate::check::{Row, Size};

pub(crate) const CONSERVING: Scheme = Scheme::EnergyMomentum(EnergyMomentum {});
/// Residual of the iterations over the largest of the forces that balance.
const TOLERANCE: f64 = 1e-12;

/// How the rows are taken.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Joined {
    Turning,
    SmallAngles,
}

/// A model of both bodies, the solid first, and what joins them.
pub(crate) fn model(
    (mesh, bodies, glued): (Mesh, [ModelBody; 2], Glued),
    (scheme, dt): (Scheme, f64),
    joined: Joined,
) -> Model {
    let rows = glued.rows.rows;
    let dim = mesh.dim;
    let mut model = Model::new(bodies.to_vec(), mesh, scheme, dt);
    if scheme.get().needs_lumped_mass() {
        let bodies = model.bodies.iter_mut();
        bodies.for_each(|body| body.mass = MassKind::Lumped);
    }
    match joined {
        Joined::Turning => {
            model.links = vec![ModelLink {
                name: "overlap".into(),
                zones: [0, 0],
                rows,
            }];
        }
        Joined::SmallAngles => {
            model.constraints = vec![ModelConstraint::of_rows("overlap", &rows, dim)];
        }
    }
    model.nonlinear.iteration.tolerance = TOLERANCE;
    model
}

/// A body along x, turned by 100° and stretched along its turned axis, free, under the forces of this strain at both ends: it stays where it is.
pub(crate) struct TurnedPatch {
    /// About which it is turned.
    pub(crate) axis: Vec3,
    pub(crate) material: Elastic,
    /// Along x, y and z, m.
    pub(crate) size: [f64; 3],
}

impl TurnedPatch {
    const STRAIN: f64 = 1e-6;
    const STEPS: usize = 20;

    /// Speed of a wave, m/s.
    fn speed(&self) -> f64 {
        (self.material.young / self.material.density).sqrt()
    }

    /// The step, s.
    pub(crate) fn step(&self) -> f64 {
        self.size[0] / self.speed() / Self::STEPS as f64
    }

    /// Largest speed over c ε while a wave runs through the body, and the energy without the strain over that of a strain of one. `end`: nodes at the
    /// end of the thin body, and their parts of the force; the solid has the group `solid.left`.
    pub(crate) fn run(&self, mut model: Model, end: &[(u32, f64)]) -> Result<[f64; 2], Error> {
        let Elastic { young, .. } = self.material;
        let [length, height, width] = self.size;
        self.load(&mut model, end)?;
        let mut driver = Driver::new(crate::witness::system(model)?)?;
        let rest = vec![0.0; driver.system().unknowns()];
        let start = self.turned(driver.system(), 0.0);
        driver.restart(&start, &rest)?;
        let whole = 0.5 * young * height * width * length;
        let energy = driver.state().ledger.balance.strain / whole;
        let start = self.turned(driver.system(), Self::STRAIN);
        driver.restart(&start, &rest)?;
        let mut fastest = 0.0_f64;
        for _ in 0..Self::STEPS {
            driver.step()?;
            fastest = fastest.max(fastest_node(&driver));
        }
        Ok([fastest / (self.speed() * Self::STRAIN), energy])
    }

    /// Largest speed over c ε while a wave runs through the body, in zones that step apart.
    pub(crate) fn run_apart(&self, mut zoned: Zoned, end: &[(u32, f64)]) -> Result<f64, Error> {
        self.load(&mut zoned.model, end)?;
        let mut zones = crate::witness::zones(&zoned)?;
        let start = zones.drivers().iter().map(|driver| {
            let u = self.turned(driver.system(), Self::STRAIN);
            let rest = vec![0.0; u.len()];
            [u, rest]
        });
        let start: Vec<[Vec<f64>; 2]> = start.collect();
        zones.restart(&start)?;
        let mut fastest = 0.0_f64;
        for _ in 0..Self::STEPS {
            zones.step()?;
            fastest = zones
                .drivers()
                .iter()
                .map(fastest_node)
                .fold(fastest, f64::max);
        }
        Ok(fastest / (self.speed() * Self::STRAIN))
    }

    /// The turn, as an increment and as a matrix.
    fn turn(&self) -> (Vec3, Mat3) {
        let increment = self.axis.normalize() * Rotation::increment(100.0_f64.to_radians());
        (increment, Rotation::cayley(&increment).matrix())
    }

    /// Pulls at both ends with the force of the strain.
    fn load(&self, model: &mut Model, end: &[(u32, f64)]) -> Result<(), Error> {
        let (_, turn) = self.turn();
        let [_, height, width] = self.size;
        let along = turn * Vec3::x() * (self.material.young * Self::STRAIN);
        let load = |&(node, part): &(u32, f64)| NodalLoad {
            name: "right".into(),
            nodes: vec![node],
            force: (along * (height * width * part)).into(),
            moment: [0.0; 3],
            amplitude: Amplitude::constant(1.0),
        };
        model.nonlinear.nodal = end.iter().map(load).collect();
        model.nonlinear.loads = vec![Load {
            name: "left".into(),
            surface: surface(&model.mesh, "solid.left", &model.bodies[0])?,
            kind: LoadKind::Traction((-along).into()),
            amplitude: Amplitude::constant(1.0),
        }];
        Ok(())
    }

    /// Displacements of the turned body with a strain, m, and increments of its rotations, rad.
    fn turned(&self, system: &System, strain: f64) -> Vec<f64> {
        let (increment, turn) = self.turn();
        let of = |unknown: usize| {
            let x = Vec3::from(system.x[system.unknowns.node(unknown) as usize]);
            let across = -self.material.poisson * strain;
            let stretched = x + Vec3::new(strain * x.x, across * x.y, across * x.z);
            match system.unknowns.kind(unknown) {
                Kind::Translation(axis) => (turn * stretched - x)[axis],
                Kind::Rotation(axis) => increment[axis],
                Kind::Amplitude(_) => 0.0,
            }
        };
        (0..system.unknowns()).map(of).collect()
    }
}

/// Largest speed of a node, m/s.
fn fastest_node(driver: &Driver) -> f64 {
    let (system, motion) = (driver.system(), &driver.state().motion);
    let speed = |node| Vec3::from(system.unknowns.vector(node, &motion.v)).norm();
    (0..system.x.len() as u32).map(speed).fold(0.0, f64::max)
}

/// The two bodies of a model as zones: the solid with so many steps of its scheme in one of Newmark's of the thin body.
pub(crate) fn apart(mut model: Model, (scheme, substeps): (Scheme, u32)) -> Zoned {
    let mut links = std::mem::take(&mut model.links);
    links.iter_mut().for_each(|link| link.zones = [0, 1]);
    if scheme.get().needs_lumped_mass() {
        model.bodies[0].mass = MassKind::Lumped;
    }
    let zone =
        |name: &str, body, scheme, substeps| ModelZone::new(name, vec![body], (scheme, substeps));
    Zoned {
        zones: vec![
            zone("solid", 0, scheme, substeps),
            zone("thin", 1, newmark(0.25, 0.5), 1),
        ],
        links,
        kind: LinkKind::PrakashHjelmstad,
        model,
    }
}

/// The tip of a cantilever of length L under a force F across its end: what is `found` along and across it, over L, for F L²/(E I), beside the
/// elastica (Mattiasson 1981, Int. J. Num. Meth. Eng. 17, 145). Tolerance 0.01.
pub(crate) fn elastica(
    size: Size,
    found: impl Fn(f64) -> Result<[f64; 2], Error>,
) -> Result<Vec<Row>, Error> {
    let published: &[(f64, [f64; 2])] = match size {
        Size::Quick => &[(2.0, [0.16064, 0.49346])],
        Size::Full => &[(2.0, [0.16064, 0.49346]), (5.0, [0.38763, 0.71379])],
    };
    let mut rows = Vec::new();
    for &(load, exact) in published {
        let found = found(load)?;
        for (k, along) in ["along", "across"].into_iter().enumerate() {
            let label = format!("elastica, F L²/(E I) = {load}: displacement {along} / L");
            rows.push(Row::near(label, found[k], exact[k], 0.01).published());
        }
    }
    Ok(rows)
}

/// Velocities of a body that spins about all axes of its `centre` and drifts, m/s and rad/s.
pub(crate) fn spin(system: &System, centre: Vec3) -> Vec<f64> {
    let (spin, drift) = (Vec3::new(6.0, 4.0, 12.0), Vec3::new(0.3, -0.2, 0.1));
    let of = |unknown: usize| {
        let x = Vec3::from(system.x[system.unknowns.node(unknown) as usize]);
        match system.unknowns.kind(unknown) {
            Kind::Translation(axis) => (drift + spin.cross(&(x - centre)))[axis],
            Kind::Rotation(axis) => spin[axis],
            Kind::Amplitude(_) => 0.0,
        }
    };
    (0..system.unknowns()).map(of).collect()
}

/// A free body that spins about two axes of its `centre` and tumbles, with the conserving scheme: its balances over so many steps. Bounds of
/// what iterations leave that end at 1e-12 of the forces: of energy and works 1e-8, of both momenta `of_momenta`; it bends, which is bounded from below.
pub(crate) fn tumbling(
    name: &str,
    model: Model,
    centre: Vec3,
    (steps, of_momenta): (usize, f64),
) -> Result<Vec<Row>, Error> {
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let v = spin(driver.system(), centre);
    let rest = vec![0.0; v.len()];
    driver.restart(&rest, &v)?;
    let (mut strain, mut work) = (0.0_f64, 0.0_f64);
    for _ in 0..steps {
        driver.step()?;
        let balance = &driver.state().ledger.balance;
        strain = strain.max(balance.strain);
        work = work.max(balance.work_links.abs());
    }
    let ledger = &driver.state().ledger;
    let bound =
        |what: &str, value: f64, most: f64| Row::at_most(format!("{name}: {what}"), value, most);
    let made = ledger.balance.dissipation_scheme.abs();
    let residual = ledger.largest_energy_residual;
    Ok(vec![
        Row::at_least(
            format!("{name}: largest strain energy over the kinetic energy"),
            strain / ledger.initial.kinetic,
            1e-3,
        ),
        bound("energy residual", residual / ledger.largest_energy, 1e-8),
        bound(
            "energy that the scheme made",
            made / ledger.largest_energy,
            1e-8,
        ),
        bound("work of the overlap", work / ledger.largest_energy, 1e-8),
        bound(
            "momentum residual",
            ledger.largest_momentum_residual / ledger.largest_momentum,
            of_momenta,
        ),
        bound(
            "angular momentum residual",
            ledger.largest_angular_residual / ledger.largest_angular_momentum,
            of_momenta,
        ),
    ])
}
