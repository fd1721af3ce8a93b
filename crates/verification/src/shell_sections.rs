//! Shells whose thickness changes, of plies, and beside their nodes.
//!
//! Problems, ν = 0:
//! - A cantilever of L = 1, b = 0.1, E = 2e11 whose thickness falls from 0.04 to 0.02, force F at its end: with ξ from the end, h = h₁ + k ξ, the deflection is
//!   12 F/(E b) ∫ ξ²/h³ dξ + 6/5 F/(G b) ∫ dξ/h = 12 F/(E b k³) [ln h + 2 h₁/h - h₁²/(2 h²)] + 6 F/(5 G b k) ln(h₀/h₁).
//! - The same with the thickness h₁ exp(k ξ): 12 F/(E b h₁³) [2/c³ - exp(-c L) (L²/c + 2 L/c² + 2/c³)] + 6 F/(5 G b k) (1/h₁ - 1/h₀), c = 3 k.
//! - A strip of two plies, E₁ = 2e11, h₁ = 3 mm below, E₂ = 7e10, h₂ = 5 mm above, moment M at its end: κ = M/(b (D - B²/A)), its middle stretches by -B/A κ, with A = Σ E h and so on; the end sinks
//!   by κ L²/2.
//! - A sandwich, faces of 1 mm with E = 7e10, a core of 20 mm with E = 7e7: the end of a cantilever of 0.5 m sinks by F L³/(3 b D) + F L/(b S). S is that of linear elasticity
//!   for thin faces, G d²/c, d between the middles of the faces, times (1 + t/(3 d) …): here the general formula is judged by it within the part that it leaves out.
//! - The same of constant thickness 0.01: moments, shear forces and stresses of its faces.
//! - A strip of one material beside its nodes by e, force N along it at its end: it is bent by N e and ends at N e L²/(2 E I) across; with small and with finite rotations.
//! - A soft plate beside its nodes flies and tumbles, energy-momentum.
//!
//! Tolerance: 1e-3 of the taper, on 16 elements: the curvature of each is that of its middle, with errors of (h'/h)²/(24 n²) and of the shape of the deflection over an element, 1/(4 n²), 1e-3 at 16; and of the exponential thickness, on 32, whose chords are up to (k L)²/(8 n²), 6e-5, too thick. 1e-6 of constant curvature, which
//! the elements have exactly; with finite rotations 1e-3, the square of the rotation and its product with the membrane force. 3 % of the sandwich: the core bends, and faces have a thickness, 1.5 % each. Balances as in
//! `large-shells`.

use carom_bodies::{Ply, Rotations};
use carom_dynamics::NodalLoad;
use carom_materials::Elastic;

use crate::Error;
use crate::beams::held;
use crate::check::{Check, Row, Size};
use crate::large_shells::tumbling;
use crate::shells::{Grid, Held, deflection, force, loaded, section_of, shell};

fn material(young: f64) -> Elastic {
    Elastic {
        density: 1000.0,
        young,
        poisson: 0.0,
    }
}

const STEEL: f64 = 2e11;
const LIGHT: f64 = 7e10;

/// A strip of `n` elements along x, clamped at x = 0, with half of a force and of a moment at each node of its end.
fn strip(
    n: usize,
    [length, width]: [f64; 2],
    [force_at_end, moment]: [[f64; 3]; 2],
) -> (Grid, carom_mesh::Mesh, Held) {
    let grid = Grid::new(n, 1);
    let mesh = grid.mesh(&|s, t| [length * s, width * t, 0.0]);
    let load = NodalLoad {
        moment: moment.map(|m| 0.5 * m),
        ..force(grid.column(n), force_at_end.map(|f| 0.5 * f))
    };
    let held = Held {
        supports: vec![held(grid.column(0), [true; 3], [true; 3])],
        loads: vec![load],
        ..Held::default()
    };
    (grid, mesh, held)
}

fn tapered() -> Result<Row, Error> {
    let [thick, thin, length, width]: [f64; 4] = [0.04, 0.02, 1.0, 0.1];
    let load = 100.0;
    let (grid, mesh, held) = strip(16, [length, width], [[0.0, 0.0, load], [0.0; 3]]);
    let mut made = shell(&mesh, thick, Rotations::Small, material(STEEL))?;
    let slope = (thick - thin) / length;
    let nodes = mesh.nodes.iter();
    made.spec.nodal_thickness = Some(nodes.map(|x| thick - slope * x[0]).collect());
    let found = deflection((mesh, made), held, grid.node(16, 0))?[2];
    let primitive = |h: f64| h.ln() + 2.0 * thin / h - thin * thin / (2.0 * h * h);
    let bent = 12.0 * load / (STEEL * width * slope.powi(3)) * (primitive(thick) - primitive(thin));
    let sheared = 1.2 * load / (0.5 * STEEL * width * slope) * (thick / thin).ln();
    Ok(Row::relative(
        "tapered cantilever: deflection",
        found,
        bent + sheared,
        1e-3,
    ))
}

fn exponential() -> Result<Row, Error> {
    let [thick, thin, length, width]: [f64; 4] = [0.04, 0.02, 1.0, 0.1];
    let load = 100.0;
    let (grid, mesh, held) = strip(32, [length, width], [[0.0, 0.0, load], [0.0; 3]]);
    let mut made = shell(&mesh, thick, Rotations::Small, material(STEEL))?;
    let rate = (thick / thin).ln() / length;
    let nodes = mesh.nodes.iter();
    made.spec.nodal_thickness = Some(nodes.map(|x| thick * (-rate * x[0]).exp()).collect());
    let found = deflection((mesh, made), held, grid.node(32, 0))?[2];
    let c = 3.0 * rate;
    let end =
        (-c * length).exp() * (length * length / c + 2.0 * length / (c * c) + 2.0 / c.powi(3));
    let bent = 12.0 * load / (STEEL * width * thin.powi(3)) * (2.0 / c.powi(3) - end);
    let sheared = 1.2 * load / (0.5 * STEEL * width * rate) * (1.0 / thin - 1.0 / thick);
    let label = "cantilever of exponential thickness: deflection";
    Ok(Row::relative(label, found, bent + sheared, 1e-3))
}

fn plies(made: &mut carom_dynamics::ModelBody, of: &[(f64, f64)]) {
    let ply = |&(young, thickness): &(f64, f64)| Ply {
        material: material(young).into(),
        thickness,
    };
    made.spec.plies = of.iter().map(ply).collect();
}

fn bimetal() -> Result<Vec<Row>, Error> {
    let (length, width, moment) = (1.0, 0.1, 10.0);
    let (grid, mesh, held) = strip(8, [length, width], [[0.0; 3], [0.0, moment, 0.0]]);
    let mut made = shell(&mesh, 0.008, Rotations::Small, material(STEEL))?;
    let of = [(STEEL, 0.003), (LIGHT, 0.005)];
    plies(&mut made, &of);
    let found = deflection((mesh, made), held, grid.node(8, 0))?;
    // sums over the plies, z from the middle
    let (mut a, mut b, mut d, mut below) = (0.0, 0.0, 0.0, -0.004_f64);
    for (young, thickness) in of {
        let above = below + thickness;
        a += young * thickness;
        b += young * (above.powi(2) - below.powi(2)) / 2.0;
        d += young * (above.powi(3) - below.powi(3)) / 3.0;
        below = above;
    }
    let curvature = moment / (width * (d - b * b / a));
    // a moment about y lowers the end
    let sinks = 0.5 * curvature * length * length;
    let stretch = -b / a * curvature * length;
    Ok(vec![
        Row::relative("bimetal strip: deflection", found[2], -sinks, 1e-6),
        Row::relative(
            "bimetal strip: elongation of the middle",
            found[0],
            stretch,
            1e-6,
        ),
    ])
}

fn sandwich() -> Result<Row, Error> {
    let (length, width, load) = (0.5, 0.1, 10.0);
    let [face, core, soft] = [0.001, 0.02, 7e7];
    let (grid, mesh, held) = strip(16, [length, width], [[0.0, 0.0, load], [0.0; 3]]);
    let mut made = shell(&mesh, core + 2.0 * face, Rotations::Small, material(LIGHT))?;
    plies(&mut made, &[(LIGHT, face), (soft, core), (LIGHT, face)]);
    let found = deflection((mesh, made), held, grid.node(16, 0))?[2];
    let between = core + face;
    let bending =
        LIGHT * (face * between * between / 2.0 + face.powi(3) / 6.0) + soft * core.powi(3) / 12.0;
    let shear = 0.5 * soft * between * between / core;
    let exact = load / width * (length.powi(3) / (3.0 * bending) + length / shear);
    Ok(Row::relative(
        "sandwich cantilever: deflection",
        found,
        exact,
        0.03,
    ))
}

fn beside(rotations: Rotations, load: f64, part: f64) -> Result<Row, Error> {
    let (length, width, thickness, offset) = (1.0, 0.1, 0.01, 0.02);
    let (grid, mesh, held) = strip(8, [length, width], [[load, 0.0, 0.0], [0.0; 3]]);
    let mut made = shell(&mesh, thickness, rotations, material(STEEL))?;
    section_of(&mut made, &|section| section.offset = offset);
    let found = deflection((mesh, made), held, grid.node(8, 0))?[2];
    let bending = STEEL * width * thickness.powi(3) / 12.0;
    // the middle is above the nodes, which are pulled: the end rises
    let exact = load * offset * length * length / (2.0 * bending);
    let name = format!("strip beside its nodes, {rotations:?} rotations: deflection");
    Ok(Row::relative(name, found, exact, part))
}

/// Moments, shear forces and stresses of the faces of a cantilever under a force F at its end, as largest errors over their largest values: M = F (L - x)/b, q = F/b, σ = ± 6 M/h².
fn resultants() -> Result<Vec<Row>, Error> {
    let (length, width, thickness, load) = (1.0, 0.1, 0.01, 10.0);
    let (_, mesh, held) = strip(16, [length, width], [[0.0, 0.0, load], [0.0; 3]]);
    let made = shell(&mesh, thickness, Rotations::Small, material(STEEL))?;
    let mut worst = [0.0_f64; 4];
    loaded((mesh, made), held, 1, &mut |_, driver| {
        let (system, state) = (driver.system(), driver.state());
        let shell = system.bodies.first().and_then(|body| body.as_shell());
        let found = shell.map(|shell| shell.resultants(&[], &state.motion.u, &[]));
        for (k, own) in found.into_iter().flatten().enumerate() {
            let x = (k as f64 + 0.5) * length / 16.0;
            // the top is in compression where the end rises
            let moment = -load * (length - x) / width;
            let stress = 6.0 * moment / (thickness * thickness);
            let largest = load * length / width;
            let errors = [
                (own.bending[(0, 0)] - moment) / largest,
                (own.shear[0] - load / width) / (load / width),
                (own.faces[0][(0, 0)] - stress) / (6.0 * largest / (thickness * thickness)),
                (own.faces[1][(0, 0)] + stress) / (6.0 * largest / (thickness * thickness)),
            ];
            for (worst, error) in worst.iter_mut().zip(errors) {
                *worst = worst.max(error.abs());
            }
        }
    })?;
    let names = [
        "moment",
        "shear force",
        "stress at the top",
        "stress at the bottom",
    ];
    let rows = names.iter().zip(worst);
    let row = |(name, worst): (&&str, f64)| {
        Row::at_most(
            format!("cantilever: largest error of the {name}"),
            worst,
            1e-6,
        )
    };
    Ok(rows.map(row).collect())
}

fn run(size: Size) -> Result<Vec<Row>, Error> {
    let mut rows = resultants()?;
    rows.extend([tapered()?, exponential()?]);
    rows.extend(bimetal()?);
    rows.push(sandwich()?);
    rows.push(beside(Rotations::Small, 100.0, 1e-6)?);
    rows.push(beside(Rotations::Finite, 0.1, 1e-3)?);
    let steps = if size == Size::Full { 2000 } else { 300 };
    rows.extend(tumbling([3, 2], 0.01, (2e-3, steps))?);
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "shell-sections",
    fact: "shells that taper, of plies and beside their nodes bend as beam theory says",
    run,
};
