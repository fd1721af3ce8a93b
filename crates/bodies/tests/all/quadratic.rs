//! What quadratic elements hold exactly, how fast they converge, and their lumped masses.

use std::f64::consts::TAU;

use carom_bodies::Kinematics;
use carom_elements::Kind;
use carom_mesh::{Mesh, generate, raise};

use crate::sample::{MATERIAL, Sample, THICKNESS, cholesky, interior, largest, solve, wedges};

const SOLID: Kinematics = Kinematics::Solid;
const PLANE: Kinematics = Kinematics::PlaneStress {
    thickness: THICKNESS,
};

/// A box or a rectangle of each quadratic kind; its map is affine in every cell, but not its axes those of space.
fn sheared() -> Vec<Sample> {
    let square = |tri| generate::rectangle("b", [0.0; 2], [1.0, 0.8], [2, 2], tri);
    let cube = |tets| generate::box_("b", [0.0; 3], [1.0, 0.8, 1.2], [2, 1, 2], tets);
    let meshes = [
        ("tri6", square(true), false, PLANE),
        ("quad8", square(false), false, PLANE),
        ("quad9", square(false), true, PLANE),
        ("tet10", cube(true), false, SOLID),
        (
            "hex20",
            generate::box_("b", [0.0; 3], [1.0, 0.8, 1.2], [2, 2, 2], false),
            false,
            SOLID,
        ),
        ("hex27", cube(false), true, SOLID),
        (
            "wedge15",
            wedges(&generate::box_(
                "b",
                [0.0; 3],
                [1.0, 0.8, 1.2],
                [2, 2, 1],
                false,
            )),
            false,
            SOLID,
        ),
    ];
    let sample = |(name, mesh, complete, kinematics): (_, Mesh, _, _)| {
        let mut mesh = raise(&mesh, complete).unwrap();
        for x in &mut mesh.nodes {
            *x = [x[0] + 0.3 * x[1] - 0.2 * x[2], x[1] + 0.1 * x[2], x[2]];
        }
        Sample::new(name, mesh, kinematics)
    };
    meshes.into_iter().map(sample).collect()
}

/// Saint-Venant: u = (x y, -(x² + ν (y² - z²))/2, -ν y z), of which the only stress is σ_x = E y. The field is quadratic, so
/// affine cells hold it, and no force is left inside.
#[test]
fn pure_bending_is_exact_on_affine_cells() {
    let nu = MATERIAL.poisson;
    let bending = |x: &[f64; 3]| {
        let [x, y, z] = *x;
        [x * y, -0.5 * (x * x + nu * (y * y - z * z)), -nu * y * z]
    };
    for sample in sheared() {
        let (f, energy) = sample.force(&sample.field(bending));
        // in coordinates in which the body is a box
        let unsheared: Vec<[f64; 3]> = sample
            .x
            .iter()
            .map(|x| {
                let y = x[1] - 0.1 * x[2];
                [x[0] - 0.3 * y + 0.2 * x[2], y, x[2]]
            })
            .collect();
        let inside = interior(&unsheared, sample.dim());
        assert!(inside.iter().any(|inside| *inside), "{}", sample.name);
        for (node, inside) in inside.into_iter().enumerate() {
            let force = largest(&f[sample.dim() * node..][..sample.dim()]);
            assert!(
                !inside || force < 1e-13 * largest(&f),
                "{}: {force}",
                sample.name
            );
        }
        // ½ ∫ E y² dV, y = Y + 0.1 Z over the box of (X, Y, Z): ∫ Y² = 0.64/3, ∫ Z² = 0.48, ∫ Y Z = 0.4 · 0.6, per volume
        let exact = match sample.dim() {
            2 => 0.5 * MATERIAL.young * THICKNESS * 0.8 * 0.64 / 3.0,
            _ => 0.5 * MATERIAL.young * 0.96 * (0.64 / 3.0 + 0.01 * 0.48 + 0.2 * 0.24),
        };
        assert!(
            (energy / exact - 1.0).abs() < 1e-12,
            "{}: {energy}",
            sample.name
        );
    }
}

/// Displacement at the inner radius of a ring from 1 to 2 m under unit inner pressure, held along its axis.
fn inner_displacement(n: usize, triangles: bool, complete: bool) -> f64 {
    let mesh = generate::rectangle("ring", [1.0, 0.0], [1.0, 0.5], [n, 1], triangles);
    let mesh = raise(&mesh, complete).unwrap();
    let ring = Sample::new("ring", mesh, Kinematics::Axisymmetric);
    let stiffness = ring.matrix(1.0, 0.0);
    let nodes = ring.n / 2;
    let radial: Vec<f64> = (0..nodes * nodes)
        .map(|k| stiffness[2 * (k / nodes) * ring.n + 2 * (k % nodes)])
        .collect();
    // Simpson's shares of the three nodes of the inner side
    let share = |x: &[f64; 3]| match (x[0] < 1.0 + 1e-9, (x[1] - 0.25).abs() < 1e-9) {
        (false, _) => 0.0,
        (true, true) => 4.0 / 6.0,
        (true, false) => 1.0 / 6.0,
    };
    let shares: Vec<f64> = ring.x.iter().map(share).collect();
    let load: Vec<f64> = shares.iter().map(|s| TAU * 0.5 * s).collect();
    let u = solve(&cholesky(&radial).0, &load);
    u.iter().zip(&shares).map(|(u, s)| u * s).sum()
}

/// The mean displacement under the load is twice the energy, whose error falls with the fourth power of the size: twice the
/// degree. Lamé (1852), as in `axisymmetry.rs`: u = (1 + ν)/(3 E) ((1 - 2ν) r + 4/r).
#[test]
fn pressurised_ring_converges_with_the_fourth_power_of_the_size() {
    let nu = MATERIAL.poisson;
    let exact = (1.0 + nu) / (3.0 * MATERIAL.young) * (5.0 - 2.0 * nu);
    for (triangles, complete) in [(true, false), (false, false), (false, true)] {
        let error = |n| (inner_displacement(n, triangles, complete) / exact - 1.0).abs();
        let (coarse, fine) = (error(12), error(24));
        assert!(fine < 1e-7, "{fine}");
        let order = (coarse / fine).log2();
        assert!((3.6..4.4).contains(&order), "{order}");
    }
}

/// Shares of the corner, of the middle of an edge, of a face and of the cell in the mass of a cell, lumped by diagonal scaling.
/// Plane kinds: Cook, Malkus, Plesha and Witt (2002), section 11.3. Solid ones from the diagonals of the mass on the unit
/// cell: tetrahedron 1/420 and 4/105 of the volume each; triquadratic hexahedron the cube of 1 : 4 : 1 on a line.
#[test]
fn lumped_masses_of_quadratic_cells_are_the_scaled_diagonal() {
    let cases: [(Kind, [f64; 4]); 5] = [
        (Kind::Tri6, [3.0 / 57.0, 16.0 / 57.0, 0.0, 0.0]),
        (Kind::Quad8, [3.0 / 76.0, 16.0 / 76.0, 0.0, 0.0]),
        (Kind::Quad9, [1.0 / 36.0, 4.0 / 36.0, 0.0, 16.0 / 36.0]),
        (Kind::Tet10, [1.0 / 36.0, 4.0 / 27.0, 0.0, 0.0]),
        (Kind::Hex27, [1.0, 4.0, 16.0, 64.0].map(|s| s / 216.0)),
    ];
    for (kind, shares) in cases {
        let table = kind.table();
        let mut mesh = Mesh::new(table.dim);
        mesh.nodes.extend(table.reference);
        mesh.push(kind, &(0..table.nodes as u32).collect::<Vec<_>>());
        let sample = Sample::new(table.name, mesh, if table.dim == 2 { PLANE } else { SOLID });
        let mass = sample.lumped_mass();
        let total: f64 = mass.iter().step_by(table.dim).sum();
        for (node, xi) in sample.x.iter().enumerate() {
            let a = table.reference.iter().position(|x| x == xi).unwrap();
            let rank = match table.linear {
                Kind::Tri3 | Kind::Tet4 => usize::from(a > table.dim),
                // as many coordinates are zero as the entity has dimensions; the centre of a square counts as a cell
                _ => match xi[..table.dim].iter().filter(|x| **x == 0.0).count() {
                    n if n == table.dim => 3,
                    n => n,
                },
            };
            let found = mass[table.dim * node] / total;
            assert!(
                (found - shares[rank]).abs() < 1e-14,
                "{} {a}: {found}",
                table.name
            );
        }
    }
}
