//! Beams that touch planes, solids and each other with the radius of their section.
//!
//! Problems, all with steel rods of a round section in space:
//! - A rod lies on a plane and slides across its axis at v₀ with friction μ. Friction acts at the surface, so that it also turns the
//!   section: the rod begins to roll. The angular momentum about the line of contact is conserved, m v₀ r = m v r + m r²/2 · v/r: it
//!   rolls at 2/3 v₀, after v₀/(3 μ g), and friction has taken a third of the energy.
//! - A rod of lumped mass falls flat on a plane and stays there: the impulse is m v. (Between nodes that stop at once a consistent mass
//!   goes on.)
//! - A rod falls on a plane at an angle, with and without friction: balances. With friction moments are those about deformed places,
//!   of which linear bodies know nothing.
//! - Two rods of lumped mass side by side, one at v: both go on at v/2 after the impulse m v/2, and half of the energy is gone.
//! - A rod falls flat on a free block: the momentum of both is that of the rod; contact begins at the distance of the radius.
//! - Two rods that cross, simply supported, one over the other under their weight: with the compliances 1/k = L³/(48 E I) and
//!   deflections δ = 5 m g L³/(384 E I) of both and the stiffness k_s of the contact the force is
//!   (δ₁ - δ₂ - g)/(1/k₁ + 1/k₂ + 1/k_s). They cross at nodes, where the elements are exact, or between nodes, where the force of the
//!   contact goes to the nodes as on a bar: the error is of second order in the length of the elements.
//! - The same rods in motion, crossing at nodes: the history of forces is that of a stop between the two nodes.
//!
//! Tolerances: conserved quantities and impulses by round-off of some hundred steps; rolling by the bending vibrations that the weight
//! at the free ends begins, below 1e-3; the static force at nodes by round-off, between nodes by the second order, found with two meshes.

use carom_bodies::{BeamSection, BeamTheory, Kinematics, MassKind, SectionShape};
use carom_contact::law::{Adhesion, Capture, Crush, Curve, Damped, Penalty, Stop};
use carom_contact::{Initial, Law, Sliding};
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, Preload, State};
use carom_mesh::{ElementId, Mesh, Surface, generate};

use crate::Error;
use crate::beams::{STEEL, exact, held, straight};
use crate::build::{body, contact, group, newmark, plane, surface, theta, velocity};
use crate::check::{Check, Row, Size};
use crate::points::balances;

const GRAVITY: f64 = 9.81;

fn rod(radius: f64, theory: BeamTheory) -> BeamSection {
    let shape = SectionShape::Circle {
        diameter: 2.0 * radius,
    };
    BeamSection {
        radius: Some(radius),
        ..BeamSection::new(theory, shape.properties(STEEL.poisson))
    }
}

/// The surface around a rod.
fn around(mesh: &Mesh, name: &str, body: &ModelBody) -> Result<Surface, Error> {
    let Kinematics::Beam(section) = body.spec.kinematics else {
        return surface(mesh, name, body);
    };
    let radius = |_: ElementId| section.radius.unwrap_or(0.0);
    let cells = &body.spec.cells;
    Ok(Surface::of_axes(mesh, group(mesh, name)?, cells, radius)?)
}

fn run(model: Model, steps: usize) -> Result<(Driver, Vec<f64>), Error> {
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let mut forces = Vec::new();
    for _ in 0..steps {
        driver.step()?;
        forces.push(driver.report().contacts[0].force);
    }
    Ok((driver, forces))
}

/// Mean of an unknown's velocity over the nodes of a rod; `place`: of the unknown in its node.
fn mean(driver: &Driver, nodes: std::ops::Range<u32>, place: usize) -> f64 {
    let (map, v) = (&driver.system().unknowns, &driver.state().motion.v);
    let count = f64::from(nodes.end - nodes.start);
    nodes.map(|node| v[map.of(node).start + place]).sum::<f64>() / count
}

fn mass(section: &BeamSection, length: f64) -> f64 {
    STEEL.density * section.properties.area * length
}

/// A rod along x of 1 m that moves at `velocity` over a plane at z = 0, `slope` times x higher.
fn over_plane(
    elements: usize,
    (velocity_of, slope): ([f64; 3], f64),
    friction: f64,
) -> Result<Model, Error> {
    let section = rod(RADIUS, BeamTheory::Timoshenko);
    let ends = [[0.0, 0.0, RADIUS], [1.0, 0.0, RADIUS + slope]];
    let (mesh, mut beam) = straight(ends, elements, 3, section)?;
    beam.velocity = velocity_of;
    let own = around(&mesh, "beam", &beam)?;
    let floor = ModelContact {
        friction: friction.into(),
        ..contact(own, plane(2, 1.0), velocity(Capture::Half))
    };
    Ok(Model {
        contacts: vec![floor],
        ..Model::new(vec![beam], mesh, theta(0.5), 1e-5)
    })
}

const RADIUS: f64 = 0.02;

fn rolling(elements: usize) -> Result<Vec<Row>, Error> {
    const MU: f64 = 0.3;
    const V0: f64 = 0.12;
    let end = V0 / (3.0 * MU * GRAVITY);
    let steps = 400;
    let model = Model {
        gravity: [0.0, 0.0, -GRAVITY],
        dt: end / 300.0,
        ..over_plane(elements, ([0.0, V0, 0.0], 0.0), MU)?
    };
    let (driver, _) = run(model, steps)?;
    let nodes = 0..elements as u32 + 1;
    let (v, turn) = (mean(&driver, nodes.clone(), 1), mean(&driver, nodes, 3));
    let balance = &driver.state().ledger.balance;
    let energy = 0.5 * mass(&rod(RADIUS, BeamTheory::Timoshenko), 1.0) * V0 * V0;
    let mut rows = vec![
        Row::relative("rolling: velocity, m/s", v, 2.0 / 3.0 * V0, 1e-3),
        Row::relative("rolling: -r ω, m/s", -RADIUS * turn, 2.0 / 3.0 * V0, 1e-3),
        Row::relative(
            "rolling: work of friction over the energy",
            balance.dissipation_friction / energy,
            1.0 / 3.0,
            3e-3,
        ),
    ];
    rows.extend(balances("rolling", driver.state(), 0.0));
    Ok(rows)
}

/// Balances of energy, momentum and angular momentum.
fn closed(name: &str, state: &State) -> Vec<Row> {
    let ledger = &state.ledger;
    let angular = ledger.largest_angular_residual / ledger.largest_angular_momentum;
    let mut rows = balances(name, state, 0.0).to_vec();
    rows.push(Row::at_most(
        format!("{name}: angular momentum residual"),
        angular,
        1e-9,
    ));
    rows
}

fn falling(elements: usize) -> Result<Vec<Row>, Error> {
    let section = rod(RADIUS, BeamTheory::Timoshenko);
    let whole = mass(&section, 1.0) * 2.0;
    let mut flat = over_plane(elements, ([0.0, 0.0, -2.0], 0.0), 0.0)?;
    flat.bodies[0].mass = MassKind::Lumped;
    let (driver, _) = run(flat, 50)?;
    let impulse = driver.state().records.contacts[0].impulse();
    let mut rows = vec![Row::relative("flat: impulse, N s", impulse, whole, 1e-12)];
    let rest = driver
        .state()
        .motion
        .v
        .iter()
        .fold(0.0_f64, |m, v| m.max(v.abs()));
    rows.push(Row::at_most(
        "flat: velocity after the impact, m/s",
        rest,
        1e-12,
    ));
    rows.extend(balances("flat", driver.state(), 0.0));
    let tilted = over_plane(elements, ([0.3, 0.5, -2.0], 0.05), 0.2)?;
    let (driver, _) = run(tilted, 800)?;
    rows.push(Row::at_least(
        "at an angle, with friction: impulse over m v",
        driver.state().records.contacts[0].impulse() / whole,
        0.2,
    ));
    rows.extend(balances("at an angle, with friction", driver.state(), 0.0));
    let mut smooth = over_plane(elements, ([0.3, 0.5, -2.0], 0.05), 0.0)?;
    smooth.contacts[0].sliding = Sliding::Small;
    let (driver, _) = run(smooth, 800)?;
    rows.extend(closed("at an angle, without friction", driver.state()));
    Ok(rows)
}

/// Two meshes of rods as one, with their bodies.
fn pair(
    [one, two]: [([[f64; 3]; 2], usize, BeamSection); 2],
) -> Result<(Mesh, [ModelBody; 2]), Error> {
    let mut mesh = generate::line("one", one.0[0], one.0[1], one.1, 3);
    mesh.merge("two", generate::line("two", two.0[0], two.0[1], two.1, 3))?;
    let made = |name, section| {
        let mut made = body(&mesh, name, Kinematics::Beam(section), STEEL)?;
        made.mass = MassKind::Consistent;
        Ok::<_, Error>(made)
    };
    let bodies = [made("one", one.2)?, made("two", two.2)?];
    Ok((mesh, bodies))
}

fn side_by_side(elements: usize) -> Result<Vec<Row>, Error> {
    let section = rod(RADIUS, BeamTheory::Timoshenko);
    let high = 2.0 * RADIUS + 5e-6;
    let (mesh, [mut one, two]) = pair([
        ([[0.0, 0.0, high], [1.0, 0.0, high]], elements, section),
        ([[0.0; 3], [1.0, 0.0, 0.0]], elements, section),
    ])?;
    one.velocity = [0.0, 0.0, -1.0];
    let [one, two] = [one, two].map(|rod| ModelBody {
        mass: MassKind::Lumped,
        ..rod
    });
    let own = around(&mesh, "one", &one)?;
    let other = ModelTarget::Surface(around(&mesh, "two", &two)?);
    let model = Model {
        contacts: vec![contact(own, other, velocity(Capture::Half))],
        ..Model::new(vec![one, two], mesh, theta(0.5), 1e-6)
    };
    let (driver, _) = run(model, 60)?;
    let whole = mass(&section, 1.0);
    let impulse = driver.state().records.contacts[0].impulse();
    let n = elements as u32 + 1;
    let speeds = [mean(&driver, 0..n, 2), mean(&driver, n..2 * n, 2)];
    let mut rows = vec![Row::relative(
        "side by side: impulse, N s",
        impulse,
        0.5 * whole,
        1e-10,
    )];
    for (speed, name) in speeds.into_iter().zip(["one", "other"]) {
        let name = format!("side by side: velocity of the {name}, m/s");
        rows.push(Row::near(name, speed, -0.5, 1e-10));
    }
    rows.extend(closed("side by side", driver.state()));
    Ok(rows)
}

fn on_a_block(elements: usize) -> Result<Vec<Row>, Error> {
    let section = rod(RADIUS, BeamTheory::Timoshenko);
    const HEIGHT: f64 = 2e-5;
    let high = RADIUS + HEIGHT;
    let mut mesh = generate::line("one", [0.0, 0.0, high], [0.2, 0.0, high], elements, 3);
    let block = generate::box_(
        "two",
        [-0.05, -0.05, -0.1],
        [0.3, 0.1, 0.1],
        [6, 2, 2],
        false,
    );
    mesh.merge("two", block)?;
    let mut one = body(&mesh, "one", Kinematics::Beam(section), STEEL)?;
    one.mass = MassKind::Consistent;
    one.velocity = [0.0, 0.0, -1.0];
    let two = body(&mesh, "two", Kinematics::Solid, STEEL)?;
    let own = around(&mesh, "one", &one)?;
    let other = ModelTarget::Surface(surface(&mesh, "two.top", &two)?);
    let dt = 1e-6;
    let model = Model {
        contacts: vec![contact(own, other, velocity(Capture::Half))],
        ..Model::new(vec![one, two], mesh, theta(0.5), dt)
    };
    let (driver, forces) = run(model, 100)?;
    let first = forces.iter().position(|force| *force > 0.0).unwrap_or(0);
    let mut rows = vec![Row::near(
        "on a block: begin of contact, s",
        first as f64 * dt,
        HEIGHT,
        dt,
    )];
    rows.extend(closed("on a block", driver.state()));
    Ok(rows)
}

/// Rods of 1 m that cross at right angles in the middle, the upper one of a radius of 8 mm, the lower one of 15 mm, `gap` apart.
struct Crossed {
    mesh: Mesh,
    bodies: [ModelBody; 2],
    sections: [BeamSection; 2],
    elements: usize,
}

const RADII: [f64; 2] = [0.008, 0.015];
const GAP: f64 = 1e-4;
const STIFFNESS: f64 = 1e6;

impl Crossed {
    fn new(elements: usize) -> Result<Crossed, Error> {
        let sections = RADII.map(|radius| rod(radius, BeamTheory::EulerBernoulli));
        let high = RADII[0] + RADII[1] + GAP;
        let (mesh, bodies) = pair([
            ([[-0.5, 0.0, high], [0.5, 0.0, high]], elements, sections[0]),
            ([[0.0, -0.5, 0.0], [0.0, 0.5, 0.0]], elements, sections[1]),
        ])?;
        Ok(Crossed {
            mesh,
            bodies,
            sections,
            elements,
        })
    }

    fn law() -> Result<Law, Error> {
        Ok(Law::Stop(Stop {
            clearance: 0.0,
            curve: Curve::new(&[[1.0, STIFFNESS]])?,
            crush: Crush::Recovered,
            damping: 0.0,
            adhesion: Adhesion::Clip,
        }))
    }

    /// Area of the point where they meet: of a node, or of a crossing between nodes, m².
    fn area(&self) -> f64 {
        let diameter = 2.0 * RADII[0];
        match self.elements % 2 {
            0 => diameter / self.elements as f64,
            _ => diameter * diameter,
        }
    }

    /// Contact of the surfaces around both.
    fn surfaces(&self) -> Result<ModelContact, Error> {
        let [one, two] = [0, 1].map(|k| around(&self.mesh, ["one", "two"][k], &self.bodies[k]));
        Ok(ModelContact::new(
            "crossing",
            one?,
            ModelTarget::Surface(two?),
            Law::Penalty(Penalty(Damped {
                stiffness: STIFFNESS / self.area(),
                damping: 0.0,
                adhesion: Adhesion::Clip,
            })),
        ))
    }

    /// A stop between their middle nodes.
    fn stop(&self) -> Result<ModelContact, Error> {
        let (n, half) = (self.elements as u32 + 1, self.elements as u32 / 2);
        let cells = [0, 1].map(|k| self.bodies[k].spec.cells[half as usize]);
        let up = [0.0, 0.0, 1.0];
        Ok(ModelContact {
            initial: Initial::Gap(GAP),
            ..ModelContact::new(
                "stop",
                Surface::of_points(&[(half, cells[0])], up.map(|n| -n)),
                ModelTarget::Surface(Surface::of_points(&[(n + half, cells[1])], up)),
                Crossed::law()?,
            )
        })
    }

    fn model(self, contact: ModelContact, dt: f64) -> Model {
        let n = self.elements as u32 + 1;
        let ends = vec![0, n - 1, n, 2 * n - 1];
        // free to bend, held in torsion
        let mut torsion = vec![held(vec![0], [false; 3], [true, false, false])];
        torsion.push(held(vec![n], [false; 3], [false, true, false]));
        torsion.push(held(ends, [true; 3], [false; 3]));
        Model {
            supports: torsion,
            gravity: [0.0, 0.0, -GRAVITY],
            contacts: vec![contact],
            ..Model::new(self.bodies.into(), self.mesh, newmark(0.25, 0.5), dt)
        }
    }
}

/// The static force of the crossing.
fn force_at_rest(elements: usize) -> Result<(f64, f64), Error> {
    let crossed = Crossed::new(elements)?;
    let contact = crossed.surfaces()?;
    let [upper, lower] = crossed.sections.map(|section| {
        let beam = exact(1.0, &section, 0);
        let compliance = 1.0 / (48.0 * beam.bending);
        [
            compliance,
            5.0 * beam.mass * GRAVITY / (384.0 * beam.bending),
        ]
    });
    let expected = (upper[1] - lower[1] - GAP) / (upper[0] + lower[0] + 1.0 / STIFFNESS);
    let mut model = crossed.model(contact, 1.0);
    model.nonlinear.preload = Some(Preload { end: 1.0, steps: 1 });
    let (_, forces) = run(model, 1)?;
    Ok((forces[0], expected))
}

fn crossing(elements: usize) -> Result<Vec<Row>, Error> {
    let (found, expected) = force_at_rest(elements)?;
    let mut rows = vec![Row::relative(
        "crossing at nodes: force, N",
        found,
        expected,
        1e-9,
    )];
    let errors = [15, 45].map(|elements| {
        force_at_rest(elements).map(|(found, expected)| (found / expected - 1.0).abs())
    });
    let [coarse, fine] = errors;
    let (coarse, fine) = (coarse?, fine?);
    rows.push(Row::at_most(
        "crossing between nodes: error of 15 elements",
        fine,
        0.02,
    ));
    rows.push(Row::near(
        "crossing between nodes: order of the error",
        (coarse / fine).ln() / 3.0_f64.ln(),
        2.0,
        0.2,
    ));
    let history = |stop: bool| {
        let crossed = Crossed::new(elements)?;
        let contact = match stop {
            true => crossed.stop()?,
            false => crossed.surfaces()?,
        };
        let (driver, forces) = run(crossed.model(contact, 2e-5), 1_500)?;
        Ok::<_, Error>((driver.state().clone(), forces))
    };
    let ((state, surfaces), (_, stop)) = (history(false)?, history(true)?);
    let peak = stop.iter().copied().fold(0.0, f64::max);
    let pairs = surfaces.iter().zip(&stop);
    let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    rows.push(Row::at_least(
        "crossing in motion: peak force, N",
        peak,
        1.0,
    ));
    rows.push(Row::at_most(
        "crossing in motion: difference from a stop, over the peak",
        apart / peak,
        1e-9,
    ));
    rows.extend(balances("crossing in motion", &state, 0.0));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "beam-contact",
    fact: "beams touch planes, solids and each other at the radius of their section, and friction turns it",
    run: |size| {
        let elements = match size {
            Size::Quick => 4,
            Size::Full => 20,
        };
        let mut rows = rolling(elements)?;
        rows.extend(falling(elements)?);
        rows.extend(side_by_side(elements)?);
        rows.extend(on_a_block(elements)?);
        rows.extend(crossing(elements)?);
        Ok(rows)
    },
};
