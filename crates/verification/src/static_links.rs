//! A static stage of bodies that constraints alone hold.
//!
//! Problem: a cantilever of length 2 L under its weight, in two halves of L. Only a rigid link joins the second half to the first: nothing else
//! holds it. Static stage, then 200 steps of dynamics under the same weight.
//!
//! Closed form (Euler-Bernoulli): the tip sinks by w = q (2 L)⁴/(8 E I); the link carries the force q L and the moment q L²/2. Cubic elements with the
//! consistent weight have the exact displacement at their nodes, so that the tolerance is round-off times the condition of the matrix: 1e-8.
//! Afterwards nothing moves: velocities below 1e-8 of w ω₁, under every implicit scheme that takes a consistent mass.
//!
//! The same with finite rotations, where the tip sinks by a third of the length, against one beam without a link: a second formulation, equal to the
//! tolerance of the iterations.

use carom_bodies::{BeamSection, BeamTheory, Kinematics, MassKind, Rotations, SectionShape};
use carom_dynamics::{Driver, Model, ModelBody, ModelConstraint, Order, Preload, Scheme};
use carom_mesh::{Mesh, generate};

use crate::Error;
use crate::beams::{STEEL, held};
use crate::build::{body, newmark};
use crate::check::{Check, Row, Size};

const DIAMETER: f64 = 0.02;
const GRAVITY: f64 = 10.0;

fn section() -> BeamSection {
    let shape = SectionShape::Circle { diameter: DIAMETER };
    BeamSection::new(BeamTheory::EulerBernoulli, shape.properties(STEEL.poisson))
}

fn beam(mesh: &Mesh, name: &str, section: BeamSection) -> Result<ModelBody, Error> {
    let mut made = body(mesh, name, Kinematics::Beam(section), STEEL)?;
    made.mass = MassKind::Consistent;
    Ok(made)
}

/// The cantilever of two halves with a link, or of one beam.
fn cantilever(
    elements: usize,
    linked: bool,
    section: BeamSection,
    (scheme, gravity): (Scheme, f64),
) -> Result<Driver, Error> {
    let n = elements as u32;
    let middle = [1.0, 0.0, 0.0];
    let mut mesh = generate::line("one", [0.0; 3], middle, elements, 2);
    mesh.merge(
        "two",
        generate::line("two", middle, [2.0, 0.0, 0.0], elements, 2),
    )?;
    if !linked {
        for block in &mut mesh.blocks {
            for node in block.nodes.iter_mut().filter(|node| **node == n + 1) {
                *node = n;
            }
        }
    }
    let bodies = vec![beam(&mesh, "one", section)?, beam(&mesh, "two", section)?];
    let link = || ModelConstraint::rigid_link("link", &mesh, n, &[(n + 1, true)], true);
    let constraints = if linked { vec![link()] } else { Vec::new() };
    let mut model = Model {
        constraints,
        supports: vec![held(vec![0], [true; 3], [true; 3])],
        gravity: [0.0, -gravity, 0.0],
        ..Model::new(bodies, mesh, scheme, 1e-4)
    };
    model.nonlinear.preload = Some(Preload {
        end: 1e-3,
        steps: 2,
    });
    Ok(Driver::new(crate::witness::system(model)?)?)
}

fn tip(driver: &Driver, elements: usize, order: Order) -> f64 {
    let system = driver.system();
    let node = system.number[2 * elements + 1];
    system.of_node(node, &driver.state().motion, order)[1]
}

fn small(elements: usize) -> Result<Vec<Row>, Error> {
    let section = section();
    let stiffness = STEEL.young * section.properties.second_moments[1];
    let weight = STEEL.density * section.properties.area * GRAVITY;
    let expected = -weight * 2.0_f64.powi(4) / (8.0 * stiffness);
    let first = 1.875_104_07_f64.powi(2) / 4.0 * (stiffness * GRAVITY / weight).sqrt();
    let mut rows = Vec::new();
    let mut schemes = Scheme::registered();
    schemes.retain(|scheme| !scheme.get().is_explicit() && !scheme.get().needs_lumped_mass());
    for scheme in schemes {
        let name = scheme.get().name();
        let mut driver = cantilever(elements, true, section, (scheme, GRAVITY))?;
        for _ in 0..2 {
            driver.step()?;
        }
        rows.push(Row::relative(
            format!("{name}: displacement of the tip, m"),
            tip(&driver, elements, Order::Displacement),
            expected,
            1e-8,
        ));
        let carried = driver.multipliers().iter().map(|l| l.abs());
        rows.push(Row::relative(
            format!("{name}: largest multiplier, the force of the link, N"),
            carried.fold(0.0, f64::max),
            weight,
            1e-8,
        ));
        let mut fastest = 0.0_f64;
        for _ in 0..200 {
            driver.step()?;
            fastest = fastest.max(tip(&driver, elements, Order::Velocity).abs());
        }
        rows.push(Row::at_most(
            format!("{name}: velocity of the tip afterwards, over w ω₁"),
            fastest / (expected.abs() * first),
            1e-8,
        ));
    }
    Ok(rows)
}

fn large(elements: usize) -> Result<Vec<Row>, Error> {
    let section = BeamSection {
        rotations: Rotations::Finite,
        ..section()
    };
    let sunk = |linked| -> Result<f64, Error> {
        let chosen = (newmark(0.25, 0.5), 40.0 * GRAVITY);
        let mut driver = cantilever(elements, linked, section, chosen)?;
        for _ in 0..2 {
            driver.step()?;
        }
        Ok(tip(&driver, elements, Order::Displacement))
    };
    let (one, two) = (sunk(false)?, sunk(true)?);
    Ok(vec![
        Row::at_most("finite rotations: the tip sinks, m", one, -0.5),
        Row::relative(
            "finite rotations: displacement of the tip, m",
            two,
            one,
            1e-7,
        )
        .second_formulation(),
    ])
}

pub(crate) const CHECK: Check = Check {
    name: "static-links",
    fact: "a static stage holds what constraints alone hold: deflection, force of the link, and rest afterwards",
    run: |size| {
        let elements = match size {
            Size::Quick => 4,
            Size::Full => 20,
        };
        let mut rows = small(elements)?;
        rows.extend(large(elements)?);
        Ok(rows)
    },
};
