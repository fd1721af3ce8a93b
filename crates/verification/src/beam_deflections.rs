//! Deflections of beams at rest.
//!
//! Problem: steel beams, L/h = 10, in a static stage: a cantilever with a force F at its tip, `F L³/(3 E I) + F L/(κ G A)`; under
//! its weight q, `q L⁴/(8 E I) + q L²/(2 κ G A)`; and the middle of a clamped one, `q L⁴/(384 E I) + q L²/(8 κ G A)`, and of a simply
//! supported one, `5 q L⁴/(384 E I) + q L²/(8 κ G A)`. Of Euler-Bernoulli the terms of shear are left out. In space a cantilever
//! at an angle to all axes has a force with a part along each axis of its section, a moment of torsion from its eccentric
//! centroid, and the end forces of statics. Reference: these formulas.
//!
//! Tolerance: 1e-9. Elements are exact under forces at nodes and under the consistent nodal forces of their weight; K has a
//! condition of about (L/h)⁴ n⁴ ε = 1e-7 at 20 elements in the worst case, of which the smooth deflection sees a small part.

use carom_bodies::{BeamSection, BeamTheory, SectionForces};
use carom_dynamics::{Amplitude, Driver, Load, LoadKind, Model, Preload, Support};
use carom_mesh::Mesh;

use crate::Error;
use crate::beams::{STEEL, held, section, straight};
use crate::build::{newmark, surface};
use crate::check::{Check, Row, Size};

const LENGTH: f64 = 2.0;
const SIZE: f64 = 0.2;
const FORCE: f64 = 1e4;
const GRAVITY: f64 = 9.81;
const ELEMENTS: usize = 20;

/// Nodes of the ends, and in the middle.
const FIRST: u32 = 0;
const LAST: u32 = ELEMENTS as u32;

/// The beam at rest under its loads: displacements by node, and forces in the sections.
fn at_rest(
    ends: [[f64; 3]; 2],
    section: BeamSection,
    supports: Vec<Support>,
    (force, gravity): ([f64; 3], [f64; 3]),
    dim: usize,
) -> Result<(Vec<[f64; 3]>, Vec<SectionForces>), Error> {
    let (mesh, body): (Mesh, _) = straight(ends, ELEMENTS, dim, section)?;
    let area = section.properties.area;
    let load = Load {
        name: "tip".into(),
        surface: surface(&mesh, "beam.right", &body)?,
        kind: LoadKind::Traction(force.map(|f| f / area)),
        amplitude: Amplitude::constant(1.0),
    };
    let mut model = Model {
        supports,
        gravity,
        ..Model::new(vec![body], mesh, newmark(0.25, 0.5), 1e-3)
    };
    model.nonlinear.loads = vec![load];
    model.nonlinear.preload = Some(Preload { end: 1.0, steps: 1 });
    let system = crate::witness::system(model)?;
    let mut driver = Driver::new(system)?;
    driver.step()?;
    let (system, u) = (driver.system(), &driver.state().motion.u);
    let moved = (0..=LAST).map(|node| {
        let own = system.number[node as usize];
        system.unknowns.vector(own, u)
    });
    let forces = system.bodies[0]
        .section_forces(u, &[], &[])
        .unwrap_or_default();
    Ok((moved.collect(), forces))
}

fn in_the_plane(theory: BeamTheory, label: &str) -> Result<Vec<Row>, Error> {
    let section = section(SIZE, theory);
    let properties = section.properties;
    let bending = STEEL.young * properties.second_moments[1];
    let shear = match theory {
        BeamTheory::EulerBernoulli => f64::INFINITY,
        BeamTheory::Timoshenko => STEEL.shear_modulus() * properties.shear_areas[0],
    };
    let ends = [[0.0; 3], [LENGTH, 0.0, 0.0]];
    let (l, q) = (LENGTH, STEEL.density * properties.area * GRAVITY);
    let clamp = |node: u32| held(vec![node], [true; 3], [true; 3]);
    let pin = |node: u32| held(vec![node], [true; 3], [false; 3]);
    let weight = ([0.0; 3], [0.0, -GRAVITY, 0.0]);
    let push = ([0.0, FORCE, 0.0], [0.0; 3]);
    let middle = ELEMENTS / 2;
    let cases = [
        (
            "cantilever, tip force",
            vec![clamp(FIRST)],
            push,
            ELEMENTS,
            FORCE * l.powi(3) / (3.0 * bending) + FORCE * l / shear,
        ),
        (
            "cantilever, weight",
            vec![clamp(FIRST)],
            weight,
            ELEMENTS,
            -q * l.powi(4) / (8.0 * bending) - q * l * l / (2.0 * shear),
        ),
        (
            "clamped, weight",
            vec![clamp(FIRST), clamp(LAST)],
            weight,
            middle,
            -q * l.powi(4) / (384.0 * bending) - q * l * l / (8.0 * shear),
        ),
        (
            "simply supported, weight",
            vec![pin(FIRST), pin(LAST)],
            weight,
            middle,
            -5.0 * q * l.powi(4) / (384.0 * bending) - q * l * l / (8.0 * shear),
        ),
    ];
    let mut rows = Vec::new();
    for (name, supports, loads, node, exact) in cases {
        let (moved, _) = at_rest(ends, section, supports, loads, 2)?;
        let name = format!("{label}, {name}: deflection, m");
        rows.push(Row::relative(name, moved[node][1], exact, 1e-9));
    }
    Ok(rows)
}

/// A cantilever along the diagonal of space, its centroid beside its nodes.
fn in_space(theory: BeamTheory, label: &str) -> Result<Vec<Row>, Error> {
    let axes = [[2.0, 3.0, 6.0], [3.0, -6.0, 2.0], [6.0, 2.0, -3.0]].map(|a| a.map(|x| x / 7.0));
    let [x, y, z] = axes;
    let offset = [0.03, -0.05];
    let section = BeamSection {
        orientation: Some([0, 1, 2].map(|i| 5.0 * y[i] + 2.0 * x[i])),
        offset,
        ..section(SIZE, theory)
    };
    let properties = section.properties;
    let f = [3.0 * FORCE, -FORCE, 2.0 * FORCE];
    let force = [0, 1, 2].map(|i| f[0] * x[i] + f[1] * y[i] + f[2] * z[i]);
    let clamp = held(vec![FIRST], [true; 3], [true; 3]);
    let ends = [[0.0; 3], x.map(|x| x * LENGTH)];
    let (moved, forces) = at_rest(ends, section, vec![clamp], (force, [0.0; 3]), 3)?;
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let tip = moved[ELEMENTS];
    // the force acts at the node: about the centroid it has the moment -e × f, e from the node to the centroid
    let l = LENGTH;
    let [second_y, second_z] = properties.second_moments.map(|i| STEEL.young * i);
    let shears = properties.shear_areas.map(|a| match theory {
        BeamTheory::EulerBernoulli => f64::INFINITY,
        BeamTheory::Timoshenko => STEEL.shear_modulus() * a,
    });
    let moment = [
        -(offset[0] * f[2] - offset[1] * f[1]),
        -(offset[1] * f[0]),
        offset[0] * f[0],
    ];
    let twist = moment[0] * l / (STEEL.shear_modulus() * properties.torsion);
    let turn_y = (moment[1] * l - f[2] * l * l / 2.0) / second_y;
    let turn_z = (moment[2] * l + f[1] * l * l / 2.0) / second_z;
    let centroid = [
        f[0] * l / (STEEL.young * properties.area),
        f[1] * l.powi(3) / (3.0 * second_z)
            + f[1] * l / shears[0]
            + moment[2] * l * l / (2.0 * second_z),
        f[2] * l.powi(3) / (3.0 * second_y) + f[2] * l / shears[1]
            - moment[1] * l * l / (2.0 * second_y),
    ];
    // u_node = u_centroid - θ × e
    let exact = [
        centroid[0] - (turn_y * offset[1] - turn_z * offset[0]),
        centroid[1] + twist * offset[1],
        centroid[2] - twist * offset[0],
    ];
    let mut rows = Vec::new();
    for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let name = format!("{label}, in space: tip along {axis} of the section, m");
        rows.push(Row::relative(name, dot(tip, axes[k]), exact[k], 1e-9));
    }
    let root = &forces[0];
    let expected = [
        ("normal force, N", root.force[0], f[0]),
        ("shear force along y, N", root.force[1], f[1]),
        ("shear force along z, N", root.force[2], f[2]),
        ("torque, N m", root.moment_first[0], moment[0]),
        (
            "moment about y at the root, N m",
            root.moment_first[1],
            moment[1] - f[2] * l,
        ),
        (
            "moment about z at the root, N m",
            root.moment_first[2],
            moment[2] + f[1] * l,
        ),
    ];
    for (what, found, exact) in expected {
        let name = format!("{label}, in space: {what}");
        rows.push(Row::relative(name, found, exact, 1e-8));
    }
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "beam-deflections",
    fact: "beams at rest have the deflections and section forces of the theory, in the plane and in space",
    run: |_: Size| {
        let mut all = Vec::new();
        for (theory, label) in [
            (BeamTheory::EulerBernoulli, "euler-bernoulli"),
            (BeamTheory::Timoshenko, "timoshenko"),
        ] {
            all.extend(in_the_plane(theory, label)?);
            all.extend(in_space(theory, label)?);
        }
        Ok(all)
    },
};
