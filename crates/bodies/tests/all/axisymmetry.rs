//! Rings.

use std::f64::consts::TAU;

use carom_bodies::Kinematics;
use carom_mesh::generate;

use crate::sample::{MATERIAL, Sample, cholesky, solve};

const INNER: f64 = 1.0;
const OUTER: f64 = 2.0;
const HEIGHT: f64 = 0.5;

/// Radial displacement at the inner radius of a thick ring under unit inner pressure, held along its axis.
fn inner_displacement(n: usize, triangles: bool) -> f64 {
    let size = [OUTER - INNER, HEIGHT];
    let mesh = generate::rectangle("ring", [INNER, 0.0], size, [n, 1], triangles);
    let ring = Sample::new("ring", mesh, Kinematics::Axisymmetric);
    let stiffness = ring.matrix(1.0, 0.0);
    let nodes = ring.n / 2;
    let radial: Vec<f64> = (0..nodes * nodes)
        .map(|k| stiffness[2 * (k / nodes) * ring.n + 2 * (k % nodes)])
        .collect();
    let at_inner = |x: &[f64; 3]| x[0] < INNER + 1e-9;
    let load = |x: &[f64; 3]| f64::from(at_inner(x)) * TAU * INNER * HEIGHT / 2.0;
    let load: Vec<f64> = ring.x.iter().map(load).collect();
    let u = solve(&cholesky(&radial).0, &load);
    let inner = (0..nodes).filter(|&node| at_inner(&ring.x[node]));
    inner.map(|node| u[node]).sum::<f64>() / 2.0
}

/// Lamé (1852): u = A r + B / r with σ_r = 0 outside and -1 inside, plane strain.
fn exact() -> f64 {
    let nu = MATERIAL.poisson;
    let factor = (1.0 + nu) / MATERIAL.young * INNER.powi(2) / (OUTER.powi(2) - INNER.powi(2));
    factor * ((1.0 - 2.0 * nu) * INNER + OUTER.powi(2) / INNER)
}

#[test]
fn pressurised_ring_converges_with_the_square_of_the_size() {
    for triangles in [false, true] {
        let error = |n| (inner_displacement(n, triangles) / exact() - 1.0).abs();
        let (coarse, fine) = (error(8), error(16));
        assert!(fine < 2e-3, "{fine}");
        let order = (coarse / fine).log2();
        assert!((1.8..2.2).contains(&order), "{order}");
    }
}

/// A triangle with a corner on the axis, and quadrilaterals with a side on it.
#[test]
fn elements_on_the_axis_have_finite_forces_and_full_mass() {
    for triangles in [false, true] {
        let mesh = generate::rectangle("disc", [0.0; 2], [1.0, HEIGHT], [4, 1], triangles);
        let disc = Sample::new("disc", mesh, Kinematics::Axisymmetric);
        let u = disc.field(|x| [x[0] * x[0], x[1], 0.0]);
        assert!(disc.force(&u).0.iter().all(|f| f.is_finite()));
        let mass: f64 = disc.lumped_mass().iter().step_by(2).sum();
        let exact = MATERIAL.density * TAU / 2.0 * HEIGHT;
        assert!((mass - exact).abs() < 1e-13 * exact);
    }
}
