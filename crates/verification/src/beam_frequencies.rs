//! Frequencies of beams.
//!
//! Problem: steel beams of 20 elements with consistent mass, section 1 : 0.6, of slenderness L/h = 50 (Euler-Bernoulli) and 10
//! (Timoshenko, where shear and rotary inertia lower the fifth frequency by a third), in the plane and, at an angle to all axes, in
//! space: simply supported, clamped, clamped at one end, and free. Reference: the zeros of the determinant of the boundary
//! conditions (`carom_exact::beam`). The discrete frequencies are the eigenvalues of the assembled K and M.
//!
//! Tolerance: 0.1 %, as a beam of 20 elements must have it for its first five frequencies. (The prototype of the element in
//! another language had 1e-4 at the fifth of a clamped one.) Beams in space have in addition the frequencies of extension,
//! torsion and bending about the other axis: each reference is compared with the nearest frequency found, and the free beam has
//! six of zero; they are below 1e-4 of the first of bending, since rounding of K leaves √ε of the largest frequency.

use carom_bodies::{BeamSection, BeamTheory, DiscreteKind, DiscreteSpec, PointMass};
use carom_dynamics::{Model, ModelDiscrete};
use carom_elements::Kind;
use carom_exact::beam::End;

use crate::Error;
use crate::beams::{exact, frequencies, frequencies_of, held, section, straight};
use crate::build::newmark;
use crate::check::{Check, Row, Size};

const LENGTH: f64 = 1.0;

/// Translations and rotations that an end holds, in the plane.
fn of_end(end: End) -> ([bool; 3], [bool; 3]) {
    match end {
        End::Pinned => ([true; 3], [false; 3]),
        End::Clamped => ([true; 3], [true; 3]),
        End::Free => ([false; 3], [false; 3]),
    }
}

fn name(end: End) -> &'static str {
    match end {
        End::Pinned => "pinned",
        End::Clamped => "clamped",
        End::Free => "free",
    }
}

/// A beam in the plane at an angle, or along the diagonal of space.
fn model(
    dim: usize,
    elements: usize,
    section: BeamSection,
    ends: [End; 2],
) -> Result<Vec<f64>, Error> {
    let to = match dim {
        2 => [0.6, 0.8, 0.0],
        _ => [2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0],
    };
    let given = BeamSection {
        orientation: (dim == 3).then_some([3.0, 6.0, -2.0]),
        ..section
    };
    let made = straight([[0.0; 3], to.map(|x| x * LENGTH)], elements, dim, given)?;
    let nodes = [0, elements as u32];
    let supports = nodes.iter().zip(ends).map(|(&node, end)| {
        let (fix, fix_rotations) = of_end(end);
        held(vec![node], fix, fix_rotations)
    });
    frequencies(made, supports.collect(), newmark(0.25, 0.5))
}

fn rows(dim: usize, theory: BeamTheory, elements: usize) -> Result<Vec<Row>, Error> {
    let (size, label) = match theory {
        BeamTheory::EulerBernoulli => (0.02, "euler-bernoulli"),
        BeamTheory::Timoshenko => (0.1, "timoshenko"),
    };
    let section = section(size, theory);
    let mut rows = Vec::new();
    use End::{Clamped, Free, Pinned};
    let all = [[Pinned; 2], [Clamped; 2], [Clamped, Free], [Free; 2]];
    for ends in all {
        let found = model(dim, elements, section, ends)?;
        let [one, other] = ends.map(name);
        for along in 0..dim - 1 {
            let references = exact(LENGTH, &section, along).frequencies(ends, 5);
            for (k, reference) in references.into_iter().enumerate() {
                let off = |f: &f64| (f - reference).abs();
                let nearest = found
                    .iter()
                    .copied()
                    .min_by(|a, b| off(a).total_cmp(&off(b)));
                let axis = ["y", "z"][along];
                rows.push(Row::relative(
                    format!(
                        "{dim}D {label}, {one}-{other}: frequency {} along {axis}, rad/s",
                        k + 1
                    ),
                    nearest.unwrap_or(f64::NAN),
                    reference,
                    1e-3,
                ));
            }
        }
        if ends == [Free; 2] {
            let rigid = if dim == 2 { 3 } else { 6 };
            let first = exact(LENGTH, &section, dim - 2).frequencies(ends, 1)[0];
            let name = format!("{dim}D {label}, free: frequency of rigid motions over the first");
            rows.push(Row::at_most(name, found[rigid - 1] / first, 1e-4));
        }
    }
    Ok(rows)
}

/// The two lowest frequencies of a cantilever without weight that carries a disc at its end: those of the 2 x 2 matrices of
/// the force and the moment at the end, `E I / L³ (12, -6 L; -6 L, 4 L²)`, and of mass and moment of inertia. The weight of
/// the beam is 2e-6 of that of the disc: tolerance 1e-5.
fn disc() -> Result<Vec<Row>, Error> {
    let (mass, inertia) = (1e6, 1e5);
    let given = section(0.02, BeamTheory::EulerBernoulli);
    let (mut mesh, body) = straight([[0.0; 3], [0.6 * LENGTH, 0.8 * LENGTH, 0.0]], 1, 2, given)?;
    let cell = mesh.push(Kind::Point1, &[1]);
    let disc = DiscreteSpec {
        name: "disc".to_string(),
        cells: vec![cell],
        kind: DiscreteKind::Mass(PointMass {
            mass,
            inertia: [0.0, 0.0, inertia],
        }),
    };
    let found = frequencies_of(Model {
        discrete: vec![ModelDiscrete::new(disc)],
        supports: vec![held(vec![0], [true; 3], [true; 3])],
        ..Model::new(vec![body], mesh, newmark(0.25, 0.5), 1e-6)
    })?;
    let k = exact(LENGTH, &given, 0).bending / LENGTH.powi(3);
    let (a, b, c) = (12.0 * k, 6.0 * k * LENGTH, 4.0 * k * LENGTH * LENGTH);
    // m J w^4 - (a J + c m) w^2 + a c - b^2 = 0
    let sum = a * inertia + c * mass;
    let root = (sum * sum - 4.0 * mass * inertia * (a * c - b * b)).sqrt();
    let squares = [sum - root, sum + root].map(|sum| sum / (2.0 * mass * inertia));
    let row = |(k, square): (usize, f64)| {
        let off = |f: &&f64| (**f - square.sqrt()).abs();
        let nearest = found.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        let name = format!(
            "disc at the end of a cantilever: frequency {}, rad/s",
            k + 1
        );
        Row::relative(
            name,
            nearest.copied().unwrap_or(f64::NAN),
            square.sqrt(),
            1e-5,
        )
    };
    Ok(squares.into_iter().enumerate().map(row).collect())
}

pub(crate) const CHECK: Check = Check {
    name: "beam-frequencies",
    fact: "beams of 20 elements have the first five frequencies of Euler-Bernoulli's and Timoshenko's beams",
    run: |size| {
        let dims: &[usize] = match size {
            Size::Quick => &[2],
            Size::Full => &[2, 3],
        };
        let mut all = disc()?;
        for &dim in dims {
            for theory in [BeamTheory::EulerBernoulli, BeamTheory::Timoshenko] {
                all.extend(rows(dim, theory, 20)?);
            }
        }
        Ok(all)
    },
};
