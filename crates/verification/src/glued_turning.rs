//! What overlaps of thin bodies with finite rotations and solids at finite strain are asked.

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::Vec3;
use carom_algebra::unknowns::Kind;
use carom_bodies::MassKind;
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{
    Amplitude, Driver, Load, LoadKind, Model, ModelBody, ModelConstraint, ModelLink, NodalLoad,
    Scheme, System,
};
use carom_materials::Elastic;
use carom_mesh::Mesh;
use carom_zones::Glued;

use crate::Error;
use crate::build::surface;
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
        let increment = self.axis.normalize() * Rotation::increment(100.0_f64.to_radians());
        let turn = Rotation::cayley(&increment).matrix();
        let Elastic { young, poisson, .. } = self.material;
        let [length, height, width] = self.size;
        let along = turn * Vec3::x() * (young * Self::STRAIN);
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
        let mut driver = Driver::new(System::new(model)?)?;
        let rest = vec![0.0; driver.system().unknowns()];
        let turned = |system: &System, strain: f64| -> Vec<f64> {
            let of = |unknown: usize| {
                let x = Vec3::from(system.x[system.unknowns.node(unknown) as usize]);
                let across = -poisson * strain;
                let stretched = x + Vec3::new(strain * x.x, across * x.y, across * x.z);
                match system.unknowns.kind(unknown) {
                    Kind::Translation(axis) => (turn * stretched - x)[axis],
                    Kind::Rotation(axis) => increment[axis],
                    Kind::Amplitude(_) => 0.0,
                }
            };
            (0..rest.len()).map(of).collect()
        };
        let start = turned(driver.system(), 0.0);
        driver.restart(&start, &rest)?;
        let whole = 0.5 * young * height * width * length;
        let energy = driver.state().ledger.balance.strain / whole;
        let start = turned(driver.system(), Self::STRAIN);
        driver.restart(&start, &rest)?;
        let mut fastest = 0.0_f64;
        for _ in 0..Self::STEPS {
            driver.step()?;
            let (system, motion) = (driver.system(), &driver.state().motion);
            for node in 0..system.x.len() as u32 {
                let v = Vec3::from(system.unknowns.vector(node, &motion.v));
                fastest = fastest.max(v.norm());
            }
        }
        Ok([fastest / (self.speed() * Self::STRAIN), energy])
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

/// A free body that spins about two axes of its `centre` and tumbles, with the conserving scheme: its balances over so many steps. Bounds of
/// what iterations leave that end at 1e-12 of the forces: of energy and works 1e-8, of both momenta `of_momenta`; it bends, which is bounded from below.
pub(crate) fn tumbling(
    name: &str,
    model: Model,
    centre: Vec3,
    (steps, of_momenta): (usize, f64),
) -> Result<Vec<Row>, Error> {
    let mut driver = Driver::new(System::new(model)?)?;
    let system = driver.system();
    let spin = Vec3::new(6.0, 4.0, 12.0);
    let mut v = vec![0.0; system.unknowns()];
    for (unknown, v) in v.iter_mut().enumerate() {
        let x = Vec3::from(system.x[system.unknowns.node(unknown) as usize]);
        *v = match system.unknowns.kind(unknown) {
            Kind::Translation(axis) => {
                let drift = Vec3::new(0.3, -0.2, 0.1);
                (drift + spin.cross(&(x - centre)))[axis]
            }
            Kind::Rotation(axis) => spin[axis],
            Kind::Amplitude(_) => 0.0,
        };
    }
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
