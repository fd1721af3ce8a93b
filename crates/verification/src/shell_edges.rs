//! Contacts of shells at their edges.
//!
//! Problems:
//! - Edge on edge in a plane: two strips of ν = 0, L = 1 m, b = 0.1 m, h = 10 mm, one at rest, one with v = 1 m/s along both, are two equal bars. Closed form: the mean force over the time
//!   2 L/c of the impact is ρ c b h v/2, and the strips exchange their velocities.
//! - Edges that cross between nodes: two square plates, one turned by 90° about z, fly at each other along z with v/2 each. By symmetry the places where the edges touch stay at z = 0, and each plate moves as one
//!   that hits the rigid plane z = 0 with the two nodes of the element of the edge that is crossed, and with no other: a second formulation.
//! - The same with a plate that flies across, spins and meets the other one askew, energy-momentum: momenta and energy are kept.
//!
//! Tolerances: of the bars 2 % for 40 elements along each: the front of the force is as wide as some elements, and the velocity law passes on in a step. The crossing 1e-9: the same equations, solved to 1e-12.
//! Balances as in `shell-self-contact`: momenta 1e-10, energy 1e-8.

use carom_bodies::Rotations;
use carom_contact::Law;
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Driver, Model, ModelBody, ModelTarget, Scheme};
use carom_materials::Elastic;
use carom_mesh::{Group, Mesh, Surface};

use crate::Error;
use crate::build::{NOW, contact, group, plane, theta};
use crate::check::{Check, Row, Size};
use crate::kept::Kept;
use crate::shells::{Grid, shell};

const SOFT: Elastic = Elastic {
    density: 1000.0,
    young: 1e8,
    poisson: 0.0,
};
const THICKNESS: f64 = 0.01;

/// Two shells, and the surface around each.
pub(crate) struct Pair {
    mesh: Mesh,
    bodies: [ModelBody; 2],
    around: [Surface; 2],
}

impl Pair {
    /// Of two grids, in the groups `one` and `other`, of the same thickness, rotations and material.
    pub(crate) fn new(
        [one, other]: [Mesh; 2],
        (thickness, rotations, material): (f64, Rotations, Elastic),
    ) -> Result<Pair, Error> {
        let mut mesh = one;
        let own = mesh.groups.remove("shell");
        mesh.groups
            .extend(own.map(|group| ("one".to_owned(), group)));
        let mut second = other;
        let own = second.groups.remove("shell");
        second
            .groups
            .extend(own.map(|group| ("other".to_owned(), group)));
        mesh.merge("second", second)?;
        let made = |name: &str| -> Result<(ModelBody, Surface), Error> {
            let mut named = mesh.clone();
            let of = group(&mesh, name)?.clone();
            named.groups.insert("shell".into(), of.clone());
            let mut body = shell(&named, thickness, rotations, material)?;
            body.spec.name = name.into();
            let radius = |_| 0.5 * thickness;
            let around = Surface::of_axes(&mesh, &of, &body.spec.cells, radius)?;
            Ok((body, around))
        };
        let [(one, around_one), (other, around_other)] = [made("one")?, made("other")?];
        Ok(Pair {
            mesh,
            bodies: [one, other],
            around: [around_one, around_other],
        })
    }

    /// Both in contact, the nodes of the first on the second.
    pub(crate) fn model(self, law: Law, (scheme, dt): (Scheme, f64)) -> Model {
        let [one, other] = self.around;
        Model {
            contacts: vec![contact(one, ModelTarget::Surface(other), law)],
            ..Model::new(self.bodies.to_vec(), self.mesh, scheme, dt)
        }
    }
}

fn section(rotations: Rotations) -> (f64, Rotations, Elastic) {
    (THICKNESS, rotations, SOFT)
}

/// Mean force over that of two bars, and velocities of the strips at the end over that of the first at the start.
fn strips(elements: usize) -> Result<[f64; 3], Error> {
    const SPEED: f64 = 1.0;
    let (length, width) = (1.0, 0.1);
    let grid = Grid::new(elements, 2);
    let at = |from: f64| grid.mesh(&move |s, t| [from + s * length, t * width, 0.0]);
    let wave = (SOFT.young / SOFT.density).sqrt();
    let dt = length / elements as f64 / wave;
    let gap = 1e-3 * THICKNESS;
    let pair = Pair::new(
        [at(0.0), at(length + THICKNESS + gap)],
        section(Rotations::Small),
    )?;
    let mut model = pair.model(NOW, (theta(0.5), dt));
    model.bodies[0].velocity = [SPEED, 0.0, 0.0];
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let steps = 4 * elements;
    let mut impulse = 0.0;
    for _ in 0..steps {
        driver.step()?;
        let force = force_on(&driver, &|x| x[0] > length + 0.5 * THICKNESS);
        impulse += dt * force[0];
    }
    let mass = SOFT.density * THICKNESS * width * length;
    let exact = 0.5 * SOFT.density * wave * width * THICKNESS * SPEED;
    let mean = impulse / (2.0 * length / wave) / exact;
    let system = driver.system();
    let mut moving = vec![0.0; system.unknowns()];
    system.mass.multiply(&driver.state().motion.v, &mut moving);
    let momentum = |first: bool| -> f64 {
        let nodes = (0..system.x.len() as u32)
            .filter(|&node| (system.x[node as usize][0] < length + 0.5 * THICKNESS) == first);
        let all = nodes.map(|node| moving[system.unknowns.first(node)]);
        all.sum::<f64>() / (mass * SPEED)
    };
    Ok([mean, momentum(true), momentum(false)])
}

/// Sum of the contact forces on some nodes, N.
fn force_on(driver: &Driver, on: &dyn Fn(&[f64; 3]) -> bool) -> [f64; 3] {
    let system = driver.system();
    let nodes = (0..system.x.len()).filter(|&node| on(&system.x[node]));
    let mut sum = [0.0; 3];
    for node in nodes {
        let first = system.unknowns.first(node as u32);
        (0..3).for_each(|i| sum[i] += driver.state().motion.contact_force[first + i]);
    }
    sum
}

const SIDE: f64 = 0.3;
const HEIGHT: f64 = 0.2;

/// A plate with its edge at z = `at`, which goes up or down from there, along x or along y; 5 elements along the edge, so that its middle is between nodes.
fn upright(along_y: bool, at: f64, up: f64) -> Mesh {
    Grid::new(5, 3).mesh(&move |s, t| {
        let along = (s - 0.5) * SIDE;
        let z = at + up * t * HEIGHT;
        match along_y {
            true => [0.0, along, z],
            false => [along, 0.0, z],
        }
    })
}

/// Largest difference of the force of the crossing and of the plate on the plane, over the largest.
fn crossing() -> Result<[f64; 2], Error> {
    const SPEED: f64 = 0.5;
    let (dt, gap) = (2e-5, 1e-4);
    let conserving = || Scheme::EnergyMomentum(EnergyMomentum {});
    let beside = 0.5 * (THICKNESS + gap);
    let [upper, lower] = [upright(false, beside, 1.0), upright(true, -beside, -1.0)];
    let pair = Pair::new([upper.clone(), lower], section(Rotations::Finite))?;
    let mut model = pair.model(NOW, (conserving(), dt));
    model.nonlinear.iteration.tolerance = 1e-12;
    model.bodies[0].velocity = [0.0, 0.0, -SPEED];
    model.bodies[1].velocity = [0.0, 0.0, SPEED];
    let mut both = Driver::new(crate::witness::system(model)?)?;
    // the two nodes of the element of the edge that is crossed
    let alone = shell(&upper, THICKNESS, Rotations::Finite, SOFT)?;
    let mut mesh = upper;
    let touching: Vec<u32> = (0..mesh.nodes.len() as u32)
        .filter(|&node| {
            let x = mesh.nodes[node as usize];
            (x[2] - beside).abs() < 1e-9 && x[0].abs() < 0.11 * SIDE
        })
        .collect();
    let points = touching
        .iter()
        .map(|&node| mesh.push(carom_elements::Kind::Point1, &[node]));
    let points = Group::new(0, points.collect());
    let radius = |_| 0.5 * THICKNESS;
    let around = Surface::of_axes(&mesh, &points, &alone.spec.cells, radius)?;
    let mut model = Model {
        contacts: vec![contact(around, plane(2, 1.0), NOW)],
        ..Model::new(vec![alone], mesh, conserving(), dt)
    };
    model.nonlinear.iteration.tolerance = 1e-12;
    model.bodies[0].velocity = [0.0, 0.0, -SPEED];
    let mut half = Driver::new(crate::witness::system(model)?)?;
    let (mut apart, mut largest) = (0.0_f64, 0.0_f64);
    for _ in 0..100 {
        both.step()?;
        half.step()?;
        let [one, other] = [&both, &half].map(|driver| force_on(driver, &|x| x[2] > 0.0)[2]);
        apart = apart.max((one - other).abs());
        largest = largest.max(other.abs());
    }
    Ok([apart / largest, largest])
}

/// What a plate that meets another one askew keeps.
fn askew(steps: usize) -> Result<Vec<Row>, Error> {
    let beside = 0.5 * (THICKNESS + 1e-3);
    let [upper, lower] = [upright(false, beside, 1.0), upright(true, -beside, -1.0)];
    let pair = Pair::new([upper, lower], section(Rotations::Finite))?;
    let conserving = Scheme::EnergyMomentum(EnergyMomentum {});
    let mut model = pair.model(NOW, (conserving, 1e-4));
    model.nonlinear.iteration.tolerance = 1e-12;
    let system = crate::witness::system(model)?;
    let spin = [3.0, 5.0, -4.0];
    let mut velocity = vec![0.0; system.unknowns()];
    for (node, x) in system.x.iter().enumerate().filter(|(_, x)| x[2] > 0.0) {
        let first = system.unknowns.first(node as u32);
        let arm = [x[0], x[1], x[2] - 0.5 * HEIGHT];
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            velocity[first + i] = spin[j] * arm[k] - spin[k] * arm[j];
            velocity[first + 3 + i] = spin[i];
        }
        velocity[first + 2] -= 1.0;
        velocity[first] += 0.3;
    }
    let mut driver = Driver::new(system)?;
    driver.restart(&vec![0.0; velocity.len()], &velocity)?;
    let mut kept = Kept::new(driver.system(), driver.state());
    let mut impulse = 0.0;
    for _ in 0..steps {
        driver.step()?;
        kept.follow(driver.state());
        impulse += 1e-4 * force_on(&driver, &|x| x[2] > 0.0)[2];
    }
    let momentum = SOFT.density * THICKNESS * SIDE * HEIGHT;
    Ok(vec![
        Row::at_least("askew: impulse over the momentum", impulse / momentum, 0.1),
        Row::at_most("askew: change of momentum, relative", kept.linear, 1e-10),
        Row::at_most(
            "askew: change of angular momentum, relative",
            kept.angular,
            1e-10,
        ),
        Row::at_most("askew: change of energy, relative", kept.energy, 1e-8),
    ])
}

pub(crate) const CHECK: Check = Check {
    name: "shell-edges",
    fact: "plates that meet edge on edge are bars; edges that cross between nodes carry the force of a plane between them and keep momenta and energy",
    run: |size| {
        let (elements, steps) = match size {
            Size::Quick => (40, 100),
            Size::Full => (80, 1000),
        };
        let [mean, one, other] = strips(elements)?;
        let mut rows = vec![
            Row::relative("strips: mean force over that of bars", mean, 1.0, 0.02),
            Row::near("strips: momentum of the first at the end", one, 0.0, 0.02),
            Row::near(
                "strips: momentum of the second at the end",
                other,
                1.0,
                0.02,
            ),
        ];
        let [apart, largest] = crossing()?;
        rows.push(Row::at_least("crossing: largest force, N", largest, 1e-3));
        let label = "crossing, with the other plate - with the plane / largest force";
        rows.push(Row::at_most(label, apart, 1e-9).second_formulation());
        rows.extend(askew(steps)?);
        Ok(rows)
    },
};
