//! Plates, thick and thin, on distorted meshes: deflections and frequencies.
//!
//! Problems: a square plate of side L = 1, ν = 0.3, under its weight q per area.
//! - Simply supported, with rotations along the edges held: the series of Navier with shear, Σ 16 q/(π² m n D λ²) (1 + D λ/(κ G h)) sin sin over odd m
//!   and n, λ = π² (m² + n²)/L². Thickness 0.001 and 0.1, mesh of 16 by 16 quadrilaterals whose inner nodes are moved by up to a quarter of their size.
//! - Clamped, thin: 0.00126532 q L⁴/D (Taylor and Govindjee 2004, Commun. Numer. Methods Eng. 20, 757).
//! - Frequencies of the first, thickness 0.01 and 0.1: the lower root of (D λ + κ G h - ρ I ω²)(κ G h λ - ρ h ω²) = (κ G h)² λ of Mindlin's plate with
//!   the rotary inertia ρ I = ρ h³/12. Modes that are symmetric about both middles, on a quarter; the first also on a mesh whose inner nodes are moved by up to a quarter of their size.
//!
//! Tolerance: 1 % of deflections, 2 % of the clamped plate, whose curvature is largest at its border, on 24 by 24; 0.5 % of frequencies, as it is asked of plates, on a
//! quarter of 24 by 24 elements: the error of the third mode is (k h)²/12, 0.3 % of the stiffness and of the mass each. Triangles take a shear
//! stiffness that falls with their size: 2 % of deflections; of frequencies 0.94 % with 16 by 16, of second order, so 0.42 % with 24 by 24. Quick sizes have 10 by 10, and 1 % for triangles.

use carom_bodies::Rotations;
use carom_materials::Elastic;

use crate::Error;
use crate::beams::{frequencies, held};
use crate::build::newmark;
use crate::check::{Check, Row, Size};
use crate::shells::{Grid, Held, deflection, shell};

const STEEL: Elastic = Elastic {
    density: 7800.0,
    young: 2e11,
    poisson: 0.3,
};

const SHEAR: f64 = 5.0 / 6.0;

/// E h³/(12 (1 - ν²)), N m.
fn bending(thickness: f64) -> f64 {
    STEEL.young * thickness.powi(3) / (12.0 * (1.0 - STEEL.poisson.powi(2)))
}

/// κ G h, N/m.
fn shear(thickness: f64) -> f64 {
    SHEAR * STEEL.shear_modulus() * thickness
}

/// Deflection of the middle of the simply supported plate over q L⁴/D.
fn navier(thickness: f64) -> f64 {
    let (d, s) = (bending(thickness), shear(thickness));
    let pi = std::f64::consts::PI;
    let odd = || (0..200).map(|k| 2.0 * f64::from(k) + 1.0);
    let mut sum = 0.0;
    for m in odd() {
        for n in odd() {
            let square = pi * pi * (m * m + n * n);
            let sign = if (m + n) % 4.0 == 0.0 { -1.0 } else { 1.0 };
            sum += sign * 16.0 / (pi * pi * m * n * square * square) * (1.0 + d * square / s);
        }
    }
    sum
}

/// Angular frequency with m and n half waves, rad/s.
fn mindlin(thickness: f64, [m, n]: [f64; 2]) -> f64 {
    let (d, s) = (bending(thickness), shear(thickness));
    let (mass, inertia) = (
        STEEL.density * thickness,
        STEEL.density * thickness.powi(3) / 12.0,
    );
    let square = std::f64::consts::PI.powi(2) * (m * m + n * n);
    // inertia mass x² - (mass (d λ + s) + inertia s λ) x + d s λ² = 0
    let b = mass * (d * square + s) + inertia * s * square;
    let c = d * s * square * square;
    let x = 2.0 * c / (b + (b * b - 4.0 * inertia * mass * c).sqrt());
    x.sqrt()
}

/// The plate or a part of it, of this side, with inner nodes moved.
fn distorted(grid: &Grid, side: f64) -> carom_mesh::Mesh {
    let mut mesh = grid.mesh(&|s, t| [side * s, side * t, 0.0]);
    let border = grid.border();
    let middle = grid.node(grid.n / 2, grid.m / 2);
    let size = 0.25 * side / grid.n as f64;
    for node in 0..mesh.nodes.len() as u32 {
        // without order, and the same in every run
        let by = [
            size * (12.9 * f64::from(node)).sin(),
            size * (78.2 * f64::from(node)).sin(),
        ];
        if node != middle && border.binary_search(&node).is_err() {
            for (x, by) in mesh.nodes[node as usize].iter_mut().zip(by) {
                *x += by;
            }
        }
    }
    mesh
}

/// Deflection of the middle over q L⁴/D.
fn middle(grid: &Grid, thickness: f64, clamped: bool) -> Result<f64, Error> {
    let mesh = distorted(grid, 1.0);
    let made = shell(&mesh, thickness, Rotations::Small, STEEL)?;
    let mut supports = vec![held(grid.border(), [true; 3], [clamped; 3])];
    // an edge along x has no slope along x: no rotation about y
    for row in [0, grid.m] {
        supports.push(held(grid.row(row), [true; 3], [clamped, true, clamped]));
    }
    for column in [0, grid.n] {
        supports.push(held(
            grid.column(column),
            [true; 3],
            [true, clamped, clamped],
        ));
    }
    let load = Held {
        supports,
        gravity: [0.0, 0.0, -1.0],
        ..Held::default()
    };
    let node = grid.node(grid.n / 2, grid.m / 2);
    let found = -deflection((mesh, made), load, node)?[2];
    Ok(found * bending(thickness) / (STEEL.density * thickness))
}

/// Frequencies of the symmetric modes of the simply supported plate, ascending, rad/s.
fn symmetric(grid: &Grid, thickness: f64, is_distorted: bool) -> Result<Vec<f64>, Error> {
    let mesh = match is_distorted {
        true => distorted(grid, 0.5),
        false => grid.mesh(&|s, t| [0.5 * s, 0.5 * t, 0.0]),
    };
    let all: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
    let made = shell(&mesh, thickness, Rotations::Small, STEEL)?;
    let supports = vec![
        held(all, [true, true, false], [false, false, true]),
        held(grid.row(0), [true; 3], [false, true, true]),
        held(grid.column(0), [true; 3], [true, false, true]),
        held(grid.row(grid.m), [true, true, false], [true, false, true]),
        held(
            grid.column(grid.n),
            [true, true, false],
            [false, true, true],
        ),
    ];
    frequencies((mesh, made), supports, newmark(0.25, 0.5))
}

fn run(size: Size) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for triangles in [false, true] {
        let (kind, part) = match triangles {
            true => ("tri3", 0.02),
            false => ("quad4", 0.01),
        };
        let (n, m) = (16, 16);
        let grid = Grid { n, m, triangles };
        for thickness in [0.001, 0.1] {
            let found = middle(&grid, thickness, false)?;
            let name = format!("{kind}, simply supported, h/L = {thickness}: deflection, q L^4/D");
            rows.push(Row::relative(name, found, navier(thickness), part));
        }
        let (n, m) = (24, 24);
        let found = middle(&Grid { n, m, triangles }, 0.001, true)?;
        let name = format!("{kind}, clamped, h/L = 0.001: deflection, q L^4/D");
        rows.push(Row::relative(name, found, 0.00126532, 0.02).published());
        let (quarter, of_frequencies) = match size {
            Size::Quick => (10, 0.5 * part),
            Size::Full => (24, 0.005),
        };
        let (n, m) = (quarter, quarter);
        let grid = Grid { n, m, triangles };
        for thickness in [0.01, 0.1] {
            let found = symmetric(&grid, thickness, false)?;
            let modes = [[1.0, 1.0], [1.0, 3.0], [3.0, 1.0]];
            for (found, mode) in found.into_iter().zip(modes) {
                let name = format!(
                    "{kind}, h/L = {thickness}: frequency {} {}, rad/s",
                    mode[0], mode[1]
                );
                let exact = mindlin(thickness, mode);
                rows.push(match mode == [1.0, 1.0] || size == Size::Full {
                    true => Row::relative(name, found, exact, of_frequencies),
                    false => Row::shown(name, found / exact),
                });
            }
            let found = symmetric(&grid, thickness, true)?;
            let name = format!("{kind}, distorted, h/L = {thickness}: frequency 1 1, rad/s");
            let first = found.first().copied().unwrap_or(f64::NAN);
            let exact = mindlin(thickness, [1.0, 1.0]);
            rows.push(Row::relative(name, first, exact, of_frequencies));
        }
    }
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "plates",
    fact: "thick and thin plates on distorted meshes have the deflections and frequencies of Mindlin's theory",
    run,
};
