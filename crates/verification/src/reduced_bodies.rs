//! Reduced bodies against the full ones.
//!
//! Problems: a cantilever of 20 beam elements, and a bracket of hexahedra (an L of three by one by three, clamped at the top of its
//! vertical leg), both with one stop of stiffness 10 m ω₁² at the free end, which the end meets at 1 m/s. Over one period of the first
//! mode. Reference: the run of the full body with the same scheme and step.
//!
//! 1. All modes kept, which is a change of unknowns: frequencies, the force of the stop over its peak, and the displacement of a
//!    node that is not retained over its largest agree to 1e-8 (solving with K loses the digits of its condition, about 1e7).
//! 2. Frequencies with 20 modes, 0.1 %: of Craig and Bampton's basis up to 0.3 of the highest mode kept, without mass at the
//!    retained node of all modes kept. Force of the stop, 1 % of the norm of its history, with the number of modes in the name of the
//!    row, of the beam. Of the bracket it is shown only: 12 and 7 % with 20 modes, 8 and 5 % with 100, for a reason not
//!    known. 2 modes must be worse at least twice.
//! 3. A free beam with retained ends, struck at one by a stop: momentum and energy balance to rounding, 1e-12, since the static
//!    responses hold the rigid motions. A modal body in gravity falls as a rigid one: mean velocity g t, 1e-10.

use carom_bodies::{BeamTheory, BodySpec, Kinematics, MassKind};
use carom_contact::law::{Adhesion, Crush, Curve, Stop};
use carom_contact::{Law, Plane};
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, Order, System};
use carom_materials::Elastic;
use carom_mesh::{ElementId, Surface, generate};
use carom_reduction::{Keep, modes, reduce};

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
    /// Number of modes with which the force of the stop is right.
    modes: usize,
    is_beam: bool,
}

fn beam() -> Result<Problem, Error> {
    let elements = 20;
    let given = section(0.02, BeamTheory::EulerBernoulli);
    let (mesh, body) = straight([[0.0; 3], [1.0, 0.0, 0.0]], elements, 2, given)?;
    Ok(Problem {
        cell: body.spec.cells[elements - 1],
        node: elements as u32,
        axis: 1,
        inside: elements as u32 / 2,
        modes: 30,
        is_beam: true,
        model: Model {
            supports: vec![held(vec![0], [true; 3], [true; 3])],
            ..Model::new(vec![body], mesh, newmark(0.25, 0.5), 1.0)
        },
    })
}

/// `cells`: across the legs.
fn bracket(cells: usize) -> Problem {
    const SIDE: f64 = 0.1;
    let material = Elastic {
        density: 2700.0,
        young: 7e10,
        poisson: 0.33,
    };
    let [long, wide] = [3.0 * SIDE, SIDE];
    let counts = [3 * cells, cells, 3 * cells];
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
        .filter(|&cell| mean(cell, 0) < SIDE || mean(cell, 2) < SIDE)
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
    let top = top.filter(|(_, x)| x[2] > long - 1e-9 && x[0] < SIDE + 1e-9);
    let top = top.map(|(node, _)| node as u32).collect();
    let mut body = ModelBody::new(BodySpec::new("bracket", kept, Kinematics::Solid, material));
    body.mass = MassKind::Lumped;
    Problem {
        cell: cell.unwrap_or(mesh.groups["bracket"].elements[0]),
        node,
        axis: 2,
        inside: at([0.5 * SIDE, 0.5 * wide, 0.5 * SIDE]),
        modes: 20,
        is_beam: false,
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
    let system = System::new(model.clone())?;
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
    let system = System::new(model.clone())?;
    let found = modes(&system, count, &mut |_, _| {})?;
    let all = found
        .iter()
        .flat_map(|part| (0..part.len()).map(|mode| part.frequency(mode)));
    Ok(all.collect())
}

fn rows(name: &str, problem: &Problem, steps: usize, all: bool) -> Result<Vec<Row>, Error> {
    let first = frequencies(&problem.model, 1)?[0];
    let mass = System::whole(problem.model.clone())?.body_mass(0);
    let stiffness = 10.0 * mass * (std::f64::consts::TAU * first).powi(2);
    let full = problem.with_stop(stiffness, 1.0 / first / steps as f64)?;
    let [forces, places] = run(&full, problem.inside, steps)?;
    let mut rows = Vec::new();
    let reduced = |count: usize, massless: bool| -> Result<Model, Error> {
        let mut model = full.clone();
        let keep = Keep {
            modes: count,
            massless,
            ..Keep::default()
        };
        reduce(&mut model, 0, &keep)?;
        Ok(model)
    };
    if all {
        let node = full.mesh.dim.max(if full.bodies[0].spec.name == "beam" {
            3
        } else {
            0
        });
        let system = System::whole(full.clone())?;
        let held = system.fixed.iter().filter(|fixed| **fixed).count();
        let model = reduced(system.unknowns() - held - node, false)?;
        let [own, inner] = run(&model, problem.inside, steps)?;
        rows.push(Row::at_most(
            format!("{name}, all modes: force"),
            off(&own, &forces),
            1e-8,
        ));
        let name = format!("{name}, all modes: displacement inside");
        rows.push(Row::at_most(name, off(&inner, &places), 1e-8));
    }
    for (how, massless) in [("Craig-Bampton", false), ("massless", true)] {
        let force = |count: usize| -> Result<f64, Error> {
            let [own, _] = run(&reduced(count, massless)?, problem.inside, steps)?;
            Ok(off(&own, &forces))
        };
        let [few, many] = [force(2)?, force(problem.modes)?];
        let count = problem.modes;
        let row = format!("{name}, {how}, {count} modes: force of the stop");
        rows.push(match problem.is_beam {
            true => Row::at_most(row, many, 1e-2),
            false => Row::shown(row, many),
        });
        rows.push(Row::at_least(
            format!("{name}, {how}: error with 2 modes over that with {count}"),
            few / many,
            2.0,
        ));
        let model = reduced(20, massless)?;
        let kept = model.bodies[0].reduced.as_ref();
        let highest = kept.and_then(|kept| kept.frequencies.last());
        let part = if massless { 1.0 } else { 0.3 };
        let highest = part * highest.copied().unwrap_or(0.0);
        let found = frequencies(&model, 20)?;
        let exact = frequencies(&full, 20)?;
        let band = found.iter().zip(&exact);
        let band = band.take_while(|(_, exact)| **exact < (1.0 - 1e-9) * highest);
        let worst = band
            .clone()
            .map(|(found, exact)| (found / exact - 1.0).abs());
        rows.push(Row::at_least(
            format!("{name}, {how}, 20 modes: frequencies compared"),
            band.count() as f64,
            5.0,
        ));
        rows.push(Row::at_most(
            format!("{name}, {how}, 20 modes: frequencies of the band"),
            worst.fold(0.0, f64::max),
            1e-3,
        ));
    }
    Ok(rows)
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
        let mut driver = Driver::new(System::new(model)?)?;
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
    let mut driver = Driver::new(System::new(model)?)?;
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

pub(crate) const CHECK: Check = Check {
    name: "reduced-bodies",
    fact: "bodies reduced to modes have the frequencies and the impact forces of the full ones, all of them with all modes, and their balances",
    run: |size| {
        let (cells, steps) = match size {
            Size::Quick => (2, 200),
            Size::Full => (11, 200),
        };
        let mut all = rows("beam", &beam()?, 400, true)?;
        all.extend(rows("small bracket", &bracket(2), 200, true)?);
        if cells > 2 {
            all.extend(rows("bracket", &bracket(cells), steps, false)?);
        }
        all.extend(free()?);
        Ok(all)
    },
};
