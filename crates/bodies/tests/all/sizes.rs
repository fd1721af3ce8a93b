//! Sizes of cells, wave speeds and frequency bounds.

use carom_bodies::{Kinematics, height};
use carom_elements::Kind;
use carom_mesh::{Mesh, generate};

use crate::sample::{
    AREA, MATERIAL, Sample, all, cells, dot, largest, multiply, plain_and_weighted,
};

const PLANE: Kinematics = Kinematics::PlaneStrain { thickness: 1.0 };

#[test]
fn smallest_size_is_a_side_or_an_altitude() {
    let box_ = |tets| generate::box_("b", [0.0; 3], [1.0; 3], [1; 3], tets);
    let flat = |triangles| generate::rectangle("b", [0.0; 2], [3.0, 8.0], [1, 2], triangles);
    let line = generate::line("b", [0.0; 3], [3.0, 4.0, 0.0], 5, 2);
    for (mesh, kinematics, exact) in [
        (line, Kinematics::Bar { area: AREA }, 1.0),
        (flat(false), PLANE, 3.0),
        // right triangles of legs 3 and 4
        (flat(true), PLANE, 2.4),
        (box_(false), Kinematics::Solid, 1.0),
        // volume 1/6 over the face of area √2/2
        (box_(true), Kinematics::Solid, 0.5f64.sqrt()),
    ] {
        let size = Sample::new("b", mesh, kinematics).body.smallest_size();
        assert!((size - exact).abs() < 1e-14, "{size} {exact}");
    }
}

#[test]
fn height_of_a_sheared_cell_is_normal_to_its_face() {
    let mut mesh = generate::box_("b", [0.0; 3], [2.0, 1.0, 0.5], [1; 3], false);
    mesh.nodes.iter_mut().for_each(|x| x[0] += 5.0 * x[2]);
    let cell = cells(&mesh, 3)[0];
    let bottom = mesh.element_nodes(mesh.groups["b.bottom"].elements[0]);
    assert!((height(&mesh, cell, Kind::Quad4, bottom) - 0.5).abs() < 1e-14);
}

#[test]
fn wave_speed_is_the_largest_of_the_material_in_its_plane() {
    for sample in all() {
        let exact = MATERIAL.wave_speed(sample.body.kinematics().plane());
        assert_eq!(sample.body.wave_speed(), exact, "{}", sample.name);
    }
}

/// Largest eigenvalue of M⁻¹ K, from below, by power iterations with the Rayleigh quotient.
pub fn highest_frequency(sample: &Sample) -> f64 {
    let (k, mass) = (sample.matrix(1.0, 0.0), sample.lumped_mass());
    let mut v: Vec<f64> = carom_testing::Random(9).vector(sample.n);
    let mut squared = 0.0;
    for _ in 0..2000 {
        let force = multiply(&k, &v);
        let inertia: Vec<f64> = mass.iter().zip(&v).map(|(m, v)| m * v).collect();
        squared = dot(&v, &force) / dot(&v, &inertia);
        v = force.iter().zip(&mass).map(|(f, m)| f / m).collect();
        let scale = largest(&v);
        v.iter_mut().for_each(|v| *v /= scale);
    }
    squared.sqrt()
}

/// A right wedge and a pyramid over a square: heights over each face from elementary geometry.
#[test]
fn heights_of_wedges_and_pyramids_are_distances_to_what_is_opposite() {
    let half = 0.5f64.sqrt();
    for (kind, expected) in [
        // triangles 2 apart; sides 1, 1/√2 and 1 from the edges opposite
        (Kind::Wedge6, [2.0, 2.0, 1.0, half, 1.0]),
        (Kind::Wedge15, [2.0, 2.0, 1.0, half, 1.0]),
        // the top 1 above a base of side 2: its sides lean at 45°
        (
            Kind::Pyramid5,
            [1.0, 2.0 * half, 2.0 * half, 2.0 * half, 2.0 * half],
        ),
    ] {
        let table = kind.table();
        let mut mesh = Mesh::new(3);
        mesh.nodes.extend(table.reference);
        let cell = mesh.push(kind, &(0..table.nodes as u32).collect::<Vec<_>>());
        for (face, expected) in table.faces.iter().zip(expected) {
            let nodes: Vec<u32> = face.nodes.iter().map(|&a| a as u32).collect();
            let found = height(&mesh, cell, face.kind, &nodes);
            assert!(
                (found - expected).abs() < 1e-13,
                "{kind:?} {nodes:?}: {found}"
            );
        }
    }
}

/// Irons: the elements alone ring at least as fast as the assembly.
#[test]
fn frequency_bound_is_above_the_highest_frequency() {
    for sample in plain_and_weighted() {
        let (bound, exact) = (sample.body.frequency_bound(), highest_frequency(&sample));
        assert!(
            bound >= exact * (1.0 - 1e-12),
            "{}: {bound} {exact}",
            sample.name
        );
    }
}

/// Equal bars ring together. In the plane and in space the fastest motion of an element is its swelling, which
/// neighbours cannot do at once.
#[test]
fn frequency_bound_of_equal_elements_is_near_the_highest_frequency() {
    let square = |triangles| generate::rectangle("b", [0.0; 2], [1.0; 2], [6, 6], triangles);
    let cube = |tets| generate::box_("b", [0.0; 3], [1.0; 3], [4; 3], tets);
    let line = generate::line("b", [0.0; 3], [1.0, 0.0, 0.0], 20, 1);
    for (name, mesh, kinematics, slack) in [
        ("bar2", line, Kinematics::Bar { area: AREA }, 0.01),
        ("tri3", square(true), PLANE, 0.1),
        ("quad4", square(false), PLANE, 0.2),
        ("tet4", cube(true), Kinematics::Solid, 0.4),
        ("hex8", cube(false), Kinematics::Solid, 0.35),
    ] {
        let sample = Sample::new(name, mesh, kinematics);
        let excess = sample.body.frequency_bound() / highest_frequency(&sample) - 1.0;
        assert!((-1e-12..slack).contains(&excess), "{name}: {excess}");
    }
}

#[test]
fn frequency_bound_of_a_single_element_is_its_highest_frequency() {
    for kind in Kind::ALL {
        let element = kind.table();
        let kinematics = match element.dim {
            0 => continue,
            // not a bar: an edge of plane cells
            _ if kind == Kind::Bar3 => continue,
            1 => Kinematics::Bar { area: AREA },
            2 => PLANE,
            _ => Kinematics::Solid,
        };
        let mut mesh = Mesh::new(element.dim);
        mesh.nodes.extend(element.reference);
        mesh.push(kind, &(0..element.nodes as u32).collect::<Vec<_>>());
        let sample = Sample::new(element.name, mesh, kinematics);
        let ratio = sample.body.frequency_bound() / highest_frequency(&sample);
        assert!(
            (1.0 - 1e-12..1.001).contains(&ratio),
            "{}: {ratio}",
            element.name
        );
    }
}

/// Long equal bars: 2 c / h, up to the ends.
#[test]
fn critical_step_of_equal_bars_is_the_transit_time() {
    let mesh = generate::line("b", [0.0; 3], [1.0, 0.0, 0.0], 50, 1);
    let sample = Sample::new("b", mesh, Kinematics::Bar { area: AREA });
    let transit = sample.body.smallest_size() / sample.body.wave_speed();
    let ratio = 2.0 / sample.body.frequency_bound() / transit;
    assert!((0.999..1.0 + 1e-12).contains(&ratio), "{ratio}");
}
