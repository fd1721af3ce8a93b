//! What joins beams to each other, to the ground and to a fluid: hinges, elastic foundation, added mass, rigid links, damping.
//!
//! Problems and closed forms, steel, L = 1 m, Euler-Bernoulli where frequencies are of the exact beam:
//! - Hinge: two beams of L, clamped at their far ends, joined by a hinge. Modes that are symmetric about the hinge are those of a
//!   cantilever (no moment and no shear force there), β L = 1.875104, 4.694091; the others have no displacement there and are those of a
//!   beam that is clamped and simply supported, β L = 3.926602, 7.068583. ω = β² √(E I/ρA).
//! - Elastic foundation, simply supported: ω² = (k + E I q⁴)/ρA, q = nπ/L.
//! - Added mass m_a per length, simply supported: ω² = E I q⁴/(ρA + m_a); the force of gravity on its supports is that of the beam alone.
//! - Two rods, one in the other, simply supported, with a fluid between them: the roots of
//!   det(diag(E I_k) q⁴ - ω² (diag(ρA_k) + M)) = 0, M Fritz's matrix per length: in phase and out of phase.
//! - Damping proportional to the mass: a free rod that a torque turns about its axis, ω = T/(α J) (1 - e^(-α t)).
//! - Rigid links: two halves of a free beam whose ends are linked move like one beam; with an arm between the ends energy, momentum and
//!   angular momentum are conserved, and the link keeps the distance of its nodes.
//!
//! Tolerances: frequencies 1e-3 with 20 elements, as `beam-frequencies`; damping by the second order of the step; linked beams by round-off.

use carom_bodies::{
    BeamSection, BeamTheory, DiscreteKind, DiscreteSpec, FluidGap, Kinematics, MassKind, Release,
    SectionShape,
};
use carom_dynamics::{Damping, Driver, Model, ModelBody, ModelConstraint, ModelDiscrete};
use carom_dynamics::{NodalLoad, Order};
use carom_elements::Kind;
use carom_mesh::{Mesh, generate};
use carom_signals::Amplitude;

use crate::Error;
use crate::beams::{STEEL, frequencies_of, held};
use crate::build::{body, newmark};
use crate::check::{Check, Row, Size};
use crate::points::balances;

const DIAMETER: f64 = 0.02;

fn rod(diameter: f64, theory: BeamTheory) -> BeamSection {
    let shape = SectionShape::Circle { diameter };
    BeamSection::new(theory, shape.properties(STEEL.poisson))
}

/// E I in N m² and ρA in kg/m.
fn of(section: &BeamSection) -> [f64; 2] {
    let properties = &section.properties;
    [
        STEEL.young * properties.second_moments[1],
        STEEL.density * properties.area,
    ]
}

fn beam(mesh: &Mesh, name: &str, section: BeamSection) -> Result<ModelBody, Error> {
    let mut made = body(mesh, name, Kinematics::Beam(section), STEEL)?;
    made.mass = MassKind::Consistent;
    Ok(made)
}

/// A simply supported beam in the plane.
fn supported(elements: usize, section: BeamSection) -> Result<Model, Error> {
    let mesh = generate::line("beam", [0.0; 3], [1.0, 0.0, 0.0], elements, 2);
    let made = beam(&mesh, "beam", section)?;
    let last = elements as u32;
    Ok(Model {
        supports: vec![
            held(vec![0, last], [false, true, false], [false; 3]),
            held(vec![0], [true, false, false], [false; 3]),
        ],
        ..Model::new(vec![made], mesh, newmark(0.25, 0.5), 1e-5)
    })
}

/// Compares each expected frequency with the nearest one found.
fn nearest(name: &str, expected: &[f64], found: &[f64]) -> Vec<Row> {
    let row = |(n, &expected): (usize, &f64)| {
        let off = |w: &&f64| (**w - expected).abs();
        let nearest = found.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        let found = nearest.copied().unwrap_or(f64::NAN);
        Row::relative(format!("{name}: ω{}, rad/s", n + 1), found, expected, 1e-3)
    };
    expected.iter().enumerate().map(row).collect()
}

fn hinge(elements: usize) -> Result<Vec<Row>, Error> {
    let section = rod(DIAMETER, BeamTheory::EulerBernoulli);
    let n = elements as u32;
    let mesh = generate::line("beam", [0.0; 3], [2.0, 0.0, 0.0], 2 * elements, 2);
    let mut made = beam(&mesh, "beam", section)?;
    made.spec.releases = vec![Release {
        cell: made.spec.cells[elements],
        end: 0,
        rotations: [false, false, true],
    }];
    let model = Model {
        supports: vec![held(vec![0, 2 * n], [true; 3], [true; 3])],
        ..Model::new(vec![made], mesh, newmark(0.25, 0.5), 1e-5)
    };
    let [bending, mass] = of(&section);
    let roots = [1.875_104_07, 3.926_602_31, 4.694_091_13, 7.068_582_75];
    let expected = roots.map(|root: f64| root * root * (bending / mass).sqrt());
    Ok(nearest("hinge", &expected, &frequencies_of(model)?))
}

fn bending_modes(factor: impl Fn(f64) -> f64) -> Vec<f64> {
    let q = |n: i32| f64::from(n) * std::f64::consts::PI;
    (1..=5).map(|n| factor(q(n).powi(4)).sqrt()).collect()
}

fn foundation(elements: usize) -> Result<Vec<Row>, Error> {
    let section = BeamSection {
        foundation: [0.0, 3e6, 0.0],
        ..rod(DIAMETER, BeamTheory::EulerBernoulli)
    };
    let [bending, mass] = of(&section);
    let expected = bending_modes(|q| (3e6 + bending * q) / mass);
    let found = frequencies_of(supported(elements, section)?)?;
    let mut rows = nearest("elastic foundation", &expected, &found);
    // a beam that nothing else holds falls on its foundation, with a hinge: its forces are in the balance of momentum
    let mut model = supported(elements, section)?;
    model.supports.clear();
    model.gravity = [0.0, -9.81, 0.0];
    model.bodies[0].velocity = [0.0, 0.3, 0.0];
    model.bodies[0].spec.releases = vec![Release {
        cell: model.bodies[0].spec.cells[elements / 3],
        end: 0,
        rotations: [false, false, true],
    }];
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    for _ in 0..300 {
        driver.step()?;
    }
    let (ledger, weight) = (&driver.state().ledger, mass * 9.81 * 300.0 * 1e-5);
    rows.extend(balances(
        "elastic foundation, alone",
        driver.state(),
        weight,
    ));
    rows.push(Row::at_most(
        "elastic foundation, alone: angular momentum residual",
        ledger.largest_angular_residual / ledger.largest_angular_momentum,
        1e-9,
    ));
    Ok(rows)
}

fn added_mass(elements: usize) -> Result<Vec<Row>, Error> {
    let [fluid, displaced] = FluidGap::around(1000.0, [0.5 * DIAMETER, 0.8 * DIAMETER]);
    let section = BeamSection {
        added_mass: fluid,
        displaced_mass: displaced,
        ..rod(DIAMETER, BeamTheory::EulerBernoulli)
    };
    let [bending, mass] = of(&section);
    let expected = bending_modes(|q| bending * q / (mass + fluid));
    let mut rows = nearest(
        "added mass",
        &expected,
        &frequencies_of(supported(elements, section)?)?,
    );
    let mut model = supported(elements, section)?;
    model.gravity = [0.0, -10.0, 0.0];
    let weight: f64 = {
        let system = crate::witness::system(model)?;
        let nodes = 0..system.x.len() as u32;
        nodes
            .map(|node| system.unknowns.vector(node, &system.load)[1])
            .sum()
    };
    rows.push(Row::relative(
        "added mass: weight less buoyancy, N",
        weight,
        -10.0 * (mass - displaced),
        1e-12,
    ));
    Ok(rows)
}

fn in_each_other(elements: usize) -> Result<Vec<Row>, Error> {
    let sections = [
        rod(DIAMETER, BeamTheory::EulerBernoulli),
        BeamSection::new(
            BeamTheory::EulerBernoulli,
            SectionShape::Tube {
                diameter: 0.034,
                thickness: 0.002,
            }
            .properties(STEEL.poisson),
        ),
    ];
    let radii = [0.5 * DIAMETER, 0.015];
    let ends = [[0.0; 3], [1.0, 0.0, 0.0]];
    let mut mesh = generate::line("one", ends[0], ends[1], elements, 2);
    mesh.merge("two", generate::line("two", ends[0], ends[1], elements, 2))?;
    let bodies = vec![
        beam(&mesh, "one", sections[0])?,
        beam(&mesh, "two", sections[1])?,
    ];
    let n = elements as u32;
    let length = 1.0 / f64::from(n);
    let axis = Some([1.0, 0.0, 0.0]);
    let mut gap = |name: &str, nodes: Vec<u32>, length: f64| {
        let cells = nodes
            .iter()
            .map(|&node| mesh.push(Kind::Bar2, &[node, node + n + 1]));
        ModelDiscrete::new(DiscreteSpec {
            name: name.to_owned(),
            cells: cells.collect(),
            kind: DiscreteKind::Fluid(FluidGap {
                axis,
                ..FluidGap::new(1000.0, radii, length)
            }),
        })
    };
    let discrete = vec![
        gap("inside", (1..n).collect(), length),
        gap("ends", vec![0, n], 0.5 * length),
    ];
    let model = Model {
        discrete,
        supports: vec![
            held(
                vec![0, n, n + 1, 2 * n + 1],
                [false, true, false],
                [false; 3],
            ),
            held(vec![0, n + 1], [true, false, false], [false; 3]),
        ],
        ..Model::new(bodies, mesh, newmark(0.25, 0.5), 1e-5)
    };
    let [[k1, m1], [k2, m2]] = [of(&sections[0]), of(&sections[1])];
    let [a, b, c] = FluidGap::new(1000.0, radii, 1.0).masses;
    let mut expected = Vec::new();
    for n in 1..=3 {
        let q = (f64::from(n) * std::f64::consts::PI).powi(4);
        // (K1 - λ A)(K2 - λ C) = λ² b²
        let (stiff, heavy) = ([k1 * q, k2 * q], [m1 + a, m2 + c]);
        let square = heavy[0] * heavy[1] - b * b;
        let half = 0.5 * (stiff[0] * heavy[1] + stiff[1] * heavy[0]) / square;
        let rest = (half * half - stiff[0] * stiff[1] / square).sqrt();
        expected.extend([half - rest, half + rest].map(f64::sqrt));
    }
    Ok(nearest(
        "fluid between two rods",
        &expected,
        &frequencies_of(model)?,
    ))
}

fn damping(elements: usize) -> Result<Vec<Row>, Error> {
    const RATE: f64 = 50.0;
    const TORQUE: f64 = 1e-3;
    let section = rod(DIAMETER, BeamTheory::Timoshenko);
    let n = elements as u32;
    let mesh = generate::line("beam", [0.0; 3], [1.0, 0.0, 0.0], elements, 3);
    let made = beam(&mesh, "beam", section)?;
    let load = |name: &str, nodes: Vec<u32>, share: f64| NodalLoad {
        name: name.to_owned(),
        nodes,
        force: [0.0; 3],
        moment: [TORQUE * share / f64::from(n), 0.0, 0.0],
        amplitude: Amplitude::constant(1.0),
    };
    let steps = 400;
    let dt = 2.0 / RATE / f64::from(steps);
    let mut model = Model::new(vec![made], mesh, newmark(0.25, 0.5), dt);
    model.nonlinear.nodal = vec![
        load("inside", (1..n).collect(), 1.0),
        load("ends", vec![0, n], 0.5),
    ];
    model.nonlinear.damping = vec![Damping {
        mass: RATE,
        stiffness: 0.0,
    }];
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    for _ in 0..steps {
        driver.step()?;
    }
    let inertia = STEEL.density * section.properties.second_moments.iter().sum::<f64>();
    let expected = TORQUE / (RATE * inertia) * (1.0 - (-2.0_f64).exp());
    let (map, state) = (&driver.system().unknowns, driver.state());
    let found = map.spin(n / 2, &state.motion.v)[0];
    // the trapezoidal rule: (α dt)²/12 of the exponent 2
    Ok(vec![
        Row::relative("damped rotation: ω, rad/s", found, expected, 1e-5),
        Row::at_most(
            "damped rotation: energy residual",
            state.ledger.largest_energy_residual / state.ledger.largest_energy,
            1e-11,
        ),
    ])
}

/// Free beams from 0 to 1 m and from 1 m + `apart` on, their ends linked, that are struck at the first node; or one beam.
fn struck(elements: usize, linked: Option<f64>) -> Result<Driver, Error> {
    let section = rod(DIAMETER, BeamTheory::Timoshenko);
    let n = elements as u32;
    let far = |apart: f64| {
        [
            [1.0 + apart, 0.0, 0.5 * apart],
            [2.0 + apart, 0.0, 0.5 * apart],
        ]
    };
    let mut mesh = generate::line("one", [0.0; 3], [1.0, 0.0, 0.0], elements, 3);
    let [from, to] = far(linked.unwrap_or(0.0));
    mesh.merge("two", generate::line("two", from, to, elements, 3))?;
    if linked.is_none() {
        for block in &mut mesh.blocks {
            for node in block.nodes.iter_mut().filter(|node| **node == n + 1) {
                *node = n;
            }
        }
    }
    let bodies = vec![beam(&mesh, "one", section)?, beam(&mesh, "two", section)?];
    let constraints = match linked {
        None => Vec::new(),
        Some(_) => vec![ModelConstraint::rigid_link(
            "link",
            &mesh,
            n,
            &[(n + 1, true)],
            true,
        )],
    };
    let mut model = Model {
        constraints,
        ..Model::new(bodies, mesh, newmark(0.25, 0.5), 2e-5)
    };
    model.nonlinear.nodal = vec![NodalLoad {
        name: "hammer".into(),
        nodes: vec![0],
        force: [3.0, 10.0, -20.0],
        moment: [1.0, 0.0, 0.0],
        amplitude: Amplitude::constant(1.0),
    }];
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    for _ in 0..200 {
        driver.step()?;
    }
    Ok(driver)
}

fn links(elements: usize) -> Result<Vec<Row>, Error> {
    let end = |driver: &Driver| {
        let (system, n) = (driver.system(), elements as u32);
        let node = system.number[2 * n as usize + 1];
        system.of_node(node, &driver.state().motion, Order::Displacement)
    };
    let (one, two) = (struck(elements, None)?, struck(elements, Some(0.0))?);
    let (expected, found) = (end(&one), end(&two));
    let size = expected.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    let off = (0..3)
        .map(|i| (expected[i] - found[i]).abs())
        .fold(0.0, f64::max);
    let mut rows = vec![
        Row::at_least("rigid link: displacement of the far end, m", size, 1e-6),
        Row::at_most("rigid link: difference from one beam", off / size, 1e-8),
    ];
    let arm = struck(elements, Some(0.2))?;
    let (system, state) = (arm.system(), arm.state());
    let node = |node: usize| system.number[node];
    let [a, b] = [node(elements), node(elements + 1)];
    let (map, u) = (&system.unknowns, &state.motion.u);
    let (moved, turned) = (map.vector(a, u), map.spin(a, u));
    let arm = [0.2, 0.0, 0.1];
    let follows = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        moved[i] + turned[j] * arm[k] - turned[k] * arm[j]
    };
    let off = (0..3).map(|i| (map.vector(b, u)[i] - follows(i)).abs());
    let largest = u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    rows.push(Row::at_most(
        "rigid link with an arm: what its nodes leave",
        off.fold(0.0, f64::max) / largest,
        1e-10,
    ));
    let ledger = &state.ledger;
    rows.push(Row::at_most(
        "rigid link with an arm: work of the link over the energy",
        ledger.balance.work_links.abs() / ledger.largest_energy,
        1e-10,
    ));
    rows.extend(balances("rigid link with an arm", state, 0.0));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "beam-joints",
    fact: "hinges, elastic foundations, added mass, fluid gaps, damping of rotations and rigid links of beams have their closed forms",
    run: |size| {
        let elements = match size {
            Size::Quick => 10,
            Size::Full => 20,
        };
        let mut rows = hinge(elements)?;
        rows.extend(foundation(elements)?);
        rows.extend(added_mass(elements)?);
        rows.extend(in_each_other(elements)?);
        rows.extend(damping(elements)?);
        rows.extend(links(elements)?);
        Ok(rows)
    },
};
