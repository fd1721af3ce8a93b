//! Linear parts in models that are not linear as a whole.
//!
//! Problems and references, counts and bounds stated before the run:
//! * A block of linear elasticity (full size: 18 elements a side, 20 577 unknowns) on a rigid base is struck obliquely by a small
//!   neo-Hookean cube, with friction (µ = 0.3), finite sliding, 50 steps of theta 0.75. The matrix of the block depends on the
//!   size of the step alone: it is factored once. That of the striker changes with its strain: once a step at least.
//! * A linear block on a belt under tractions in time, with Coulomb's friction, 60 steps: neither loads nor friction nor the motion of the
//!   obstacle are in its matrix: one factor for the run, and a forward and a backward sweep a step, with the two of the solve for the start.
//! * Two equal bars as plane strips without Poisson's effect, the one linear, the other of St. Venant and Kirchhoff's law, meet at
//!   v = 2e-6 c: the strain is 1e-6, and the second law differs from the first by about 3/2 of it. The force history agrees with
//!   that of two linear bars within 1e-5 in the L2 norm. (At a wave front the two differ by the shift in time, some 1e-6 of a
//!   transit, times the slope, which grows with the number of elements: shown, not judged.)
//! * Two neo-Hookean blocks that share no node strike two rigid walls, as one body and as two: forces on both walls agree to the tolerance of the iterations, 1e-8, and
//!   so do the impulses and the momentum that the body received.

use carom_bodies::Kinematics;
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Law, Motion, Obstacle, Plane, Sliding, Translation};
use carom_dynamics::{Amplitude, Driver, Load, LoadKind, Model, ModelBody, ModelTarget, Nonlinear};
use carom_materials::{Elastic, Law as Material, NeoHooke, StVenantKirchhoff};
use carom_mesh::{Mesh, generate};

use crate::Error;
use crate::build::{body, contact, plane, support, surface, theta};
use crate::check::{Check, Row, Size};

const CLOSED: Law = Law::Velocity(Velocity {
    capture: Capture::Now,
    reading: Reading::Closed,
});

fn part(
    mesh: &Mesh,
    name: &str,
    kinematics: Kinematics,
    material: Material,
) -> Result<ModelBody, Error> {
    let elastic = Elastic {
        density: 1.0,
        young: 1.0,
        poisson: 0.0,
    };
    let mut part = body(mesh, name, kinematics, elastic)?;
    part.spec.material = material;
    Ok(part)
}

/// Factorisations of the block and of the striker.
fn struck(n: usize, steps: usize) -> Result<[usize; 2], Error> {
    let soft = |young: f64| Elastic {
        density: 1000.0,
        young,
        poisson: 0.3,
    };
    let mut mesh = generate::box_("block", [0.0; 3], [1.0; 3], [n; 3], false);
    let cube = generate::box_("cube", [0.43, 0.44, 1.002], [0.15; 3], [2; 3], false);
    mesh.merge("cube", cube)?;
    let block = part(&mesh, "block", Kinematics::Solid, soft(1e8).into())?;
    let neo = Material::NeoHooke(NeoHooke { initial: soft(1e7) });
    let mut striker = part(&mesh, "cube", Kinematics::Solid, neo)?;
    striker.velocity = [2.0, 0.0, -5.0];
    let secondary = surface(&mesh, "cube.bottom", &striker)?;
    let primary = ModelTarget::Surface(surface(&mesh, "block.top", &block)?);
    let mut blow = contact(secondary, primary, CLOSED);
    blow.sliding = Sliding::Finite;
    blow.friction = 0.3.into();
    let mut driver = Driver::new(crate::witness::system(Model {
        contacts: vec![blow],
        supports: vec![support(&mesh, "block.bottom", [true; 3])?],
        ..Model::new(vec![block, striker], mesh, theta(0.75), 1e-4)
    })?)?;
    for _ in 0..steps {
        driver.step()?;
    }
    let mut factors = driver.costs().factors;
    factors.sort_by_key(|factor| factor.unknowns);
    match &factors[..] {
        [small, large] => Ok([large.factorisations, small.factorisations]),
        _ => Ok([0, 0]),
    }
}

/// Factorisations and sweeps of a block on a belt, and the largest share of friction in the normal force.
fn carried(steps: usize) -> Result<(usize, usize, f64), Error> {
    let mesh = generate::rectangle("block", [0.0; 2], [0.4, 0.2], [8, 4], false);
    let elastic = Elastic {
        density: 1000.0,
        young: 1e8,
        poisson: 0.3,
    };
    let strain = Kinematics::PlaneStrain { thickness: 0.1 };
    let block = part(&mesh, "block", strain, elastic.into())?;
    let belt = Obstacle {
        motion: Motion {
            translation: Some(Translation::Velocity([0.5, 0.0, 0.0])),
            turn: None,
        },
        ..Plane {
            point: [0.0; 3],
            normal: [0.0, 1.0, 0.0],
        }
        .into()
    };
    let foot = surface(&mesh, "block.bottom", &block)?;
    let mut rubbing = contact(foot, ModelTarget::Rigid(belt), CLOSED);
    rubbing.friction = 0.3.into();
    let press = Load {
        name: "press".into(),
        surface: surface(&mesh, "block.top", &block)?,
        kind: LoadKind::Traction([500.0, -1e4, 0.0]),
        amplitude: Amplitude::new(vec![[0.0, 0.0], [5e-3, 1.0], [1e-2, 0.4]])?,
    };
    let mut driver = Driver::new(crate::witness::system(Model {
        contacts: vec![rubbing],
        nonlinear: Nonlinear {
            loads: vec![press],
            ..Nonlinear::default()
        },
        gravity: [0.0, -9.81, 0.0],
        ..Model::new(vec![block], mesh, theta(1.0), 2e-4)
    })?)?;
    let before = driver.costs().work.sweeps;
    let mut share: f64 = 0.0;
    for _ in 0..steps {
        driver.step()?;
        let report = &driver.report().contacts[0];
        if report.force > 0.0 {
            share = share.max(report.friction / report.force);
        }
    }
    let work = driver.costs().work;
    Ok((work.factorisations, work.sweeps - before, share))
}

/// Contact forces of two bars, the second of this material, over the force of the plane wave.
fn knock(n: usize, second: fn(Elastic) -> Material) -> Result<Vec<f64>, Error> {
    let elastic = Elastic {
        density: 1.0,
        young: 1.0,
        poisson: 0.0,
    };
    let height = 1.0 / n as f64;
    let mut mesh = generate::rectangle("one", [0.0; 2], [1.0, height], [n, 1], false);
    let other = generate::rectangle("two", [1.0, 0.0], [1.0, height], [n, 1], false);
    mesh.merge("two", other)?;
    let strain = Kinematics::PlaneStrain { thickness: 1.0 };
    let mut one = part(&mesh, "one", strain, elastic.into())?;
    let two = part(&mesh, "two", strain, second(elastic))?;
    // c = 1 m/s and F = ρ c v A / 2
    one.velocity = [2e-6, 0.0, 0.0];
    let secondary = surface(&mesh, "one.right", &one)?;
    let primary = ModelTarget::Surface(surface(&mesh, "two.left", &two)?);
    let dt = 0.5 / n as f64;
    let mut driver = Driver::new(crate::witness::system(Model {
        contacts: vec![contact(secondary, primary, CLOSED)],
        ..Model::new(vec![one, two], mesh, theta(0.5), dt)
    })?)?;
    let mut forces = Vec::new();
    while driver.state().time < 2.5 {
        driver.step()?;
        forces.push(driver.report().contacts[0].force / (1e-6 * height));
    }
    Ok(forces)
}

/// Forces of two blocks on their walls, N, and what is left of the momentum that contacts gave, relative; `one`: the blocks are one body.
fn pieces(one: bool) -> Result<(Vec<f64>, f64), Error> {
    let soft = Elastic {
        density: 1000.0,
        young: 1e5,
        poisson: 0.3,
    };
    let mut mesh = generate::rectangle("lower", [0.0, 0.01], [1.0; 2], [2, 2], false);
    let upper = generate::rectangle("upper", [3.0, 0.02], [1.0; 2], [2, 2], false);
    mesh.merge("upper", upper)?;
    let law = Material::NeoHooke(NeoHooke { initial: soft });
    let strain = Kinematics::PlaneStrain { thickness: 1.0 };
    let mut bodies = [
        part(&mesh, "lower", strain, law)?,
        part(&mesh, "upper", strain, law)?,
    ];
    let walls = [0, 1].map(|k| surface(&mesh, ["lower.bottom", "upper.bottom"][k], &bodies[k]));
    for body in &mut bodies {
        body.velocity = [0.5, -1.0, 0.0];
    }
    let [mut first, second] = bodies;
    let bodies = match one {
        true => {
            first.spec.cells.extend(second.spec.cells);
            vec![first]
        }
        false => vec![first, second],
    };
    let mut contacts = Vec::new();
    for (k, wall) in walls.into_iter().enumerate() {
        let mut wall = contact(wall?, plane(1, 1.0), CLOSED);
        wall.name = ["lower", "upper"][k].into();
        contacts.push(wall);
    }
    let mut model = Model {
        contacts,
        ..Model::new(bodies, mesh, theta(0.5), 2e-3)
    };
    model.nonlinear.iteration.tolerance = 1e-12;
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let mut forces = Vec::new();
    for _ in 0..60 {
        driver.step()?;
        forces.extend(driver.report().contacts.iter().map(|contact| contact.force));
    }
    let left = driver.state().exchange.relative();
    Ok((forces, left.unwrap_or(f64::NAN)))
}

pub(crate) const CHECK: Check = Check {
    name: "connected-parts",
    fact: "the matrix of a linear part is factored once, whatever touches it; a law at finite strain tends to the linear one",
    run: |size| {
        let (n, bars) = match size {
            Size::Quick => (4, 20),
            Size::Full => (18, 80),
        };
        let [block, striker] = struck(n, 50)?;
        let (factors, sweeps, share) = carried(60)?;
        let linear = knock(bars, Material::from)?;
        let mixed = knock(bars, |initial| {
            Material::StVenantKirchhoff(StVenantKirchhoff { initial })
        })?;
        let pairs = linear.iter().zip(&mixed);
        let differences: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
        let most = differences
            .iter()
            .fold(0.0_f64, |most, d| most.max(d.abs()));
        let norm = |f: &[f64]| f.iter().map(|f| f * f).sum::<f64>().sqrt();
        let peak = linear.iter().fold(0.0, |most: f64, f| most.max(*f));
        let ((together, left), (apart, _)) = (pieces(true)?, pieces(false)?);
        let pairs = together.iter().zip(&apart);
        let other = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        let strongest = apart.iter().fold(0.0_f64, |most, f| most.max(*f));
        Ok(vec![
            Row::at_most(
                "body of two pieces: force, less that of two bodies / largest",
                other / strongest,
                1e-8,
            )
            .second_formulation(),
            Row::at_most(
                "body of two pieces: momentum received, less the impulses of its contacts / largest",
                left,
                1e-8,
            ),
            Row::count("struck block: factorisations of the block", block, 1),
            Row::at_least(
                "struck block: factorisations of the striker in 50 steps",
                striker as f64,
                50.0,
            ),
            Row::count("block on a belt: factorisations in 60 steps", factors, 1),
            Row::count("block on a belt: sweeps in 60 steps", sweeps, 120),
            Row::near(
                "block on a belt: largest friction / normal force",
                share,
                0.3,
                1e-9,
            ),
            Row::at_least("two bars: peak force / that of the plane wave", peak, 0.9),
            Row::near(
                "two bars, one of St. Venant and Kirchhoff: difference to two linear ones, L2",
                norm(&differences) / norm(&linear),
                0.0,
                1e-5,
            ),
            Row::shown(
                "two bars: largest difference at an instant / force of the plane wave",
                most,
            ),
        ])
    },
};
