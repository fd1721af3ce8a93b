//! Reduced bodies against the full ones.
//!
//! Problems: a cantilever of 20 beam elements, and a bracket of hexahedra (legs of 100 mm, 10 mm thick, 40 mm wide, clamped at the top of its
//! vertical leg), with one stop at the free end, which the end meets at 1 m/s. The stop has the stiffness 10 m ω₁² at the beam and m ω₁² at the
//! bracket. Over one period of the first mode in 400 steps. Reference: the full body, its run with the same scheme and step.
//!
//! The stop of a solid must be softer than the mesh about its node, E h. A stop of 10 m ω₁² on a thick bracket of two elements (0.3 E h)
//! excites the node against its neighbours, at frequencies above all modes kept: the force history was then off by 12 % with 20 modes,
//! and 8 % with 100. The history of such a force is a matter of the mesh.
//!
//! 1. All modes kept, which is a change of unknowns, of the beam and of a thick bracket: the force of the stop over its peak, and the
//!    displacement of a node that is not retained over its largest, agree to 1e-8 (solving with K loses the digits of its condition, about 1e7).
//! 2. Under a force at the retained node the displacement is that of the full body whatever the modes, 1e-10 (condition of K).
//! 3. Frequencies of the band within 0.1 %. The band is that of the estimate of each frequency's error, which leaves out terms of second
//!    order: errors above rounding, 1e-8, are at most 1.1 of it in the band. Without mass at the retained nodes all modes kept are exact,
//!    with an estimate of zero.
//! 4. Force of the stop with 40 modes, 1 % of the norm of its history. With 5 modes it is worse at least ten times, since the error falls at least
//!    as the square of the highest frequency kept, which is 8 times as high for the bracket and more for the beam.
//! 5. A free beam with retained ends, struck at one by a stop: momentum and energy balance to rounding, 1e-11, since the static
//!    responses hold the rigid motions. A modal body in gravity falls as a rigid one: mean velocity g t, 1e-10.
//! 6. The bracket with its stop under base acceleration along all axes, full and reduced to 5 modes, which hold no rigid motion: energy, momentum
//!    and angular momentum balance to rounding, 1e-11, by every rule of the step, since moments are about undeformed places.

use carom_algebra::solver::Cholesky;
use carom_bodies::{BeamTheory, BodySpec, Kinematics, MassKind};
use carom_contact::law::{Adhesion, Crush, Curve, Stop};
use carom_contact::{Law, Plane};
use carom_dynamics::{
    Amplitude, Driver, Model, ModelBody, ModelContact, ModelTarget, Order, Scheme, System, scheme,
};
use carom_materials::Elastic;
use carom_mesh::{ElementId, Surface, generate};
use carom_reduction::{Keep, Matrices, modes, reduce};

use crate::Error;
use crate::beams::{held, section, straight};
use crate::build::newmark;
use crate::check::{Check, Row, Size};
use crate::points::balances;

const SPEED: f64 = 1.0;

/// A model without its contact, the node that the stop meets with its cell, the direction of its motion, and a node inside.
struct Problem {
    model: Model,
    node: u32,
    cell: ElementId,
    axis: usize,
    inside: u32,
    /// Stiffness of the stop, over m ω₁².
    stop: f64,
}

/// Modes kept, and modes that are too few.
const MODES: [usize; 2] = [40, 5];

/// Steps in a period of the first mode.
const STEPS: usize = 400;

/// Error of a frequency in the band.
const BAND: f64 = 1e-3;

/// Rounding of a frequency: that of ω² is some 1e-16 of the highest ω², 1e8 times the lowest.
const ROUNDING: f64 = 1e-8;

fn beam() -> Result<Problem, Error> {
    let elements = 20;
    let given = section(0.02, BeamTheory::EulerBernoulli);
    let (mesh, body) = straight([[0.0; 3], [1.0, 0.0, 0.0]], elements, 2, given)?;
    Ok(Problem {
        cell: body.spec.cells[elements - 1],
        node: elements as u32,
        axis: 1,
        inside: elements as u32 / 2,
        stop: 10.0,
        model: Model {
            supports: vec![held(vec![0], [true; 3], [true; 3])],
            ..Model::new(vec![body], mesh, newmark(0.25, 0.5), 1.0)
        },
    })
}

/// `legs`: length, width and thickness, m; `cells`: over the thickness.
fn bracket(legs: [f64; 3], cells: usize, stop: f64) -> Problem {
    let material = Elastic {
        density: 2700.0,
        young: 7e10,
        poisson: 0.33,
    };
    let [long, wide, thick] = legs;
    let along = |length: f64| (length / thick * cells as f64).round() as usize;
    let counts = [along(long), along(wide), along(long)];
    let mesh = generate::box_("bracket", [0.0; 3], [long, wide, long], counts, false);
    let mean = |cell: ElementId, axis: usize| {
        let nodes = mesh.element_nodes(cell);
        nodes
            .iter()
            .map(|&node| mesh.nodes[node as usize][axis])
            .sum::<f64>()
            / nodes.len() as f64
    };
    let all = mesh.groups["bracket"].elements.iter().copied();
    let kept: Vec<ElementId> = all
        .filter(|&cell| mean(cell, 0) < thick || mean(cell, 2) < thick)
        .collect();
    let at = |place: [f64; 3]| {
        let off = |x: &[f64; 3]| (0..3).map(|i| (x[i] - place[i]).powi(2)).sum::<f64>();
        let nodes = mesh.nodes.iter().enumerate();
        let nearest = nodes.min_by(|(_, a), (_, b)| off(a).total_cmp(&off(b)));
        nearest.map_or(0, |(node, _)| node as u32)
    };
    let node = at([long, 0.5 * wide, 0.0]);
    let cell = kept
        .iter()
        .copied()
        .find(|&cell| mesh.element_nodes(cell).contains(&node));
    let top = mesh.nodes.iter().enumerate();
    let top = top.filter(|(_, x)| x[2] > long - 1e-9 && x[0] < thick + 1e-9);
    let top = top.map(|(node, _)| node as u32).collect();
    let mut body = ModelBody::new(BodySpec::new("bracket", kept, Kinematics::Solid, material));
    body.mass = MassKind::Lumped;
    Problem {
        cell: cell.unwrap_or(mesh.groups["bracket"].elements[0]),
        node,
        axis: 2,
        inside: at([0.5 * thick, 0.5 * wide, 0.5 * thick]),
        stop,
        model: Model {
            supports: vec![held(top, [true; 3], [false; 3])],
            ..Model::new(vec![body], mesh, newmark(0.25, 0.5), 1.0)
        },
    }
}

impl Problem {
    /// The model with its stop of this stiffness (N/m) at no distance, and the step (s).
    fn with_stop(&self, stiffness: f64, dt: f64) -> Result<Model, Error> {
        let mut down = [0.0; 3];
        down[self.axis] = -1.0;
        let law = Law::Stop(Stop {
            clearance: 0.0,
            curve: Curve::new(&[[1.0, stiffness]])?,
            crush: Crush::Recovered,
            damping: 0.0,
            adhesion: Adhesion::Clip,
        });
        let target = ModelTarget::rigid(Plane {
            point: self.model.mesh.nodes[self.node as usize],
            normal: down.map(|n| -n),
        });
        let points = Surface::of_points(&[(self.node, self.cell)], down);
        let mut model = self.model.clone();
        model.bodies[0].velocity = down.map(|n| SPEED * n);
        model.contacts = vec![ModelContact::new("stop", points, target, law)];
        model.dt = dt;
        Ok(model)
    }
}

/// Forces of the stop, and displacements of the node inside, at the ends of the steps.
fn run(model: &Model, inside: u32, steps: usize) -> Result<[Vec<f64>; 2], Error> {
    let system = crate::witness::system(model.clone())?;
    let inside = system.number[inside as usize];
    let mut driver = Driver::new(system)?;
    let (mut forces, mut places) = (Vec::new(), Vec::new());
    for _ in 0..steps {
        driver.step()?;
        forces.push(driver.report().contacts[0].force);
        let motion = &driver.state().motion;
        places.push(driver.system().of_node(inside, motion, Order::Displacement));
    }
    Ok([forces, places.into_iter().flatten().collect()])
}

/// |a - b| over |b|.
fn off(a: &[f64], b: &[f64]) -> f64 {
    let square = |terms: &mut dyn Iterator<Item = f64>| terms.map(|x| x * x).sum::<f64>();
    let difference = square(&mut a.iter().zip(b).map(|(a, b)| a - b));
    (difference / square(&mut b.iter().copied())).sqrt()
}

fn frequencies(model: &Model, count: usize) -> Result<Vec<f64>, Error> {
    let system = crate::witness::system(model.clone())?;
    let found = modes(&system, count, &mut |_, _| {})?;
    let all = found
        .iter()
        .flat_map(|part| (0..part.len()).map(|mode| part.frequency(mode)));
    Ok(all.collect())
}

/// The displacement of the node of the stop under a unit force on it, m/N.
fn flexibility(problem: &Problem, model: &Model) -> Result<f64, Error> {
    let system = System::whole(model.clone())?;
    let stiffness = Matrices::new(&system)?.stiffness;
    let held = stiffness.with_identity(&system.fixed);
    let unknown = system.unknowns.first(system.number[problem.node as usize]) + problem.axis;
    let mut x = vec![0.0; system.unknowns()];
    x[unknown] = 1.0;
    Cholesky::new(&held, system.unknowns.node_of_each())?.solve(&mut x);
    Ok(x[unknown])
}

/// What a problem is compared with: its model with the stop, and the forces and places of its run.
struct Reference {
    full: Model,
    forces: Vec<f64>,
    places: Vec<f64>,
}

impl Reference {
    fn new(problem: &Problem) -> Result<Reference, Error> {
        let first = frequencies(&problem.model, 1)?[0];
        let mass = System::whole(problem.model.clone())?.body_mass(0);
        let stiffness = problem.stop * mass * (std::f64::consts::TAU * first).powi(2);
        let full = problem.with_stop(stiffness, 1.0 / first / STEPS as f64)?;
        let [forces, places] = run(&full, problem.inside, STEPS)?;
        Ok(Reference {
            full,
            forces,
            places,
        })
    }

    fn reduced(&self, modes: usize, massless: bool) -> Result<Model, Error> {
        let mut model = self.full.clone();
        let keep = Keep {
            modes,
            massless,
            ..Keep::default()
        };
        reduce(&mut model, 0, &keep)?;
        Ok(model)
    }
}

fn all_modes(name: &str, problem: &Problem) -> Result<Vec<Row>, Error> {
    let given = Reference::new(problem)?;
    let system = System::whole(given.full.clone())?;
    let held = system.fixed.iter().filter(|fixed| **fixed).count();
    let node = system.unknowns.of(system.number[problem.node as usize]);
    let model = given.reduced(system.unknowns() - held - node.len(), false)?;
    let [own, inner] = run(&model, problem.inside, STEPS)?;
    let [force, place] = [off(&own, &given.forces), off(&inner, &given.places)];
    let place_name = format!("{name}, all modes: displacement inside");
    Ok(vec![
        Row::at_most(format!("{name}, all modes: force"), force, 1e-8),
        Row::at_most(place_name, place, 1e-8),
    ])
}

fn rows(name: &str, problem: &Problem) -> Result<Vec<Row>, Error> {
    let given = Reference::new(problem)?;
    let exact = frequencies(&given.full, MODES[0])?;
    let flexible = flexibility(problem, &given.full)?;
    let mut rows = Vec::new();
    for (how, massless) in [("Craig-Bampton", false), ("massless", true)] {
        let [model, poor] = [
            given.reduced(MODES[0], massless)?,
            given.reduced(MODES[1], massless)?,
        ];
        let off = |model: &Model| -> Result<f64, Error> {
            Ok(off(&run(model, problem.inside, STEPS)?[0], &given.forces))
        };
        let name = |what: &str| format!("{name}, {how}, {what}");
        let [many, few] = [off(&model)?, off(&poor)?];
        let row = format!("{} modes: force of the stop", MODES[0]);
        rows.push(Row::at_most(name(&row), many, 1e-2));
        let row = format!("error with {} modes over that with {}", MODES[1], MODES[0]);
        rows.push(Row::at_least(name(&row), few / many, 10.0));
        let row = format!("{} modes: static displacement", MODES[1]);
        let own = flexibility(problem, &poor)?;
        rows.push(Row::relative(name(&row), own / flexible, 1.0, 1e-10));
        let prefix = name(&format!("{} modes", MODES[0]));
        rows.extend(band(&prefix, &model, &exact)?);
    }
    Ok(rows)
}

/// Frequencies of a reduced body in its band.
fn band(prefix: &str, model: &Model, exact: &[f64]) -> Result<Vec<Row>, Error> {
    let found = frequencies(model, MODES[0])?;
    let reduced = model.bodies[0].reduced.as_ref();
    let estimates = reduced.and_then(|reduced| reduced.estimates.clone());
    let count = reduced.and_then(|reduced| reduced.band(BAND));
    let count = count.map_or(0, |(count, _)| count.min(exact.len()));
    let errors: Vec<f64> = (0..count)
        .map(|k| (found[k] / exact[k] - 1.0).abs())
        .collect();
    let worst = errors.iter().copied().fold(0.0, f64::max);
    let estimates = estimates.unwrap_or_default();
    let pairs = errors.iter().zip(&estimates);
    let pairs = pairs.filter(|(error, _)| **error > ROUNDING);
    let over = pairs.map(|(error, [_, estimate])| error / (estimate + ROUNDING));
    let over = over.fold(0.0, f64::max);
    let name = |what: &str| format!("{prefix}: {what}");
    Ok(vec![
        // a quarter of the modes kept
        Row::at_least(name("frequencies in the band"), count as f64, 10.0),
        Row::at_most(name("error in the band"), worst, BAND),
        Row::at_most(name("error over its estimate"), over, 1.1),
    ])
}

/// A beam without supports whose ends are retained, thrown against a stop at one of them; in gravity without contact.
fn free() -> Result<Vec<Row>, Error> {
    let mut problem = beam()?;
    problem.model.supports.clear();
    let mut rows = Vec::new();
    for massless in [false, true] {
        let mut model = problem.with_stop(1e6, 1e-5)?;
        let keep = Keep {
            modes: 12,
            nodes: vec![0],
            massless,
            ratio: 0.01,
            ..Keep::default()
        };
        reduce(&mut model, 0, &keep)?;
        let mut driver = Driver::new(crate::witness::system(model)?)?;
        for _ in 0..2000 {
            driver.step()?;
        }
        let name = if massless {
            "free beam without mass at its ends"
        } else {
            "free beam"
        };
        rows.extend(balances(name, driver.state(), 0.0));
    }
    let mut model = problem.model.clone();
    (model.dt, model.gravity) = (1e-4, [0.0, -10.0, 0.0]);
    let keep = Keep {
        modes: 8,
        ..Keep::default()
    };
    reduce(&mut model, 0, &keep)?;
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    for _ in 0..100 {
        driver.step()?;
    }
    let velocity = driver.system().mean_velocity(0, &driver.state().motion.v)[1];
    rows.push(Row::relative(
        "modal body in gravity: velocity, m/s",
        velocity,
        -0.1,
        1e-10,
    ));
    let middle = driver.system().number[problem.inside as usize];
    let fallen = driver
        .system()
        .of_node(middle, &driver.state().motion, Order::Velocity)[1];
    rows.push(Row::relative(
        "modal body in gravity: velocity of a node, m/s",
        fallen,
        -0.1,
        1e-8,
    ));
    rows.extend(balances("modal body in gravity", driver.state(), 0.0));
    Ok(rows)
}

/// The bracket on a shaken base, full and reduced.
fn shaken(problem: &Problem) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    let alpha = Scheme::GeneralisedAlpha(scheme::GeneralisedAlpha { rho_inf: 0.8 });
    for scheme in [newmark(0.25, 0.5), alpha] {
        let mut full = problem.with_stop(1e6, 1e-5)?;
        full.scheme = scheme;
        for axis in 0..3 {
            let points = [[0.0, 0.0], [2e-4, 900.0], [6e-4, -1200.0], [1e-3, 300.0]];
            let points = points.map(|[t, a]| [t, a * (1.0 + axis as f64)]);
            full.nonlinear.base[axis] = Some(Amplitude::new(points.to_vec())?);
        }
        for (name, massless) in [
            ("full", None),
            ("Craig-Bampton", Some(false)),
            ("massless", Some(true)),
        ] {
            let mut model = full.clone();
            if let Some(massless) = massless {
                let keep = Keep {
                    modes: 5,
                    massless,
                    ..Keep::default()
                };
                reduce(&mut model, 0, &keep)?;
            }
            let mut driver = Driver::new(crate::witness::system(model)?)?;
            for _ in 0..150 {
                driver.step()?;
            }
            let ledger = &driver.state().ledger;
            let name = format!("shaken bracket, {name}, {}", scheme.get().name());
            let angular = ledger.largest_angular_residual / ledger.largest_angular_momentum;
            rows.extend(balances(&name, driver.state(), 0.0));
            let name = format!("{name}: angular momentum residual");
            rows.push(Row::at_most(name, angular, 1e-11));
        }
    }
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "reduced-bodies",
    fact: "bodies reduced to modes have the frequencies and the impact forces of the full ones, all of them with all modes, and their balances",
    run: |size| {
        // 3159 or 19 635 unknowns
        let cells = match size {
            Size::Quick => 2,
            Size::Full => 4,
        };
        let mut all = all_modes("beam", &beam()?)?;
        all.extend(all_modes(
            "thick bracket",
            &bracket([0.3, 0.1, 0.1], 2, 10.0),
        )?);
        all.extend(rows("beam", &beam()?)?);
        all.extend(rows("bracket", &bracket([0.1, 0.04, 0.01], cells, 1.0))?);
        all.extend(free()?);
        all.extend(shaken(&bracket([0.1, 0.04, 0.01], 2, 1.0))?);
        Ok(all)
    },
};
