//! Eigenmodes of the parts of a model.
//!
//! 1. A solid bar of 24 hexahedra along its axis, 4 by 4 across, without Poisson's effect, held at one end. A longitudinal motion
//!    constant over the section is an exact solution of the discrete equations, so its frequencies are those of a chain of n
//!    elements of length h: ω = 2 c/h sin(θ/2) with lumped mass, ω = c/h √(6 (1 - cos θ)/(2 + cos θ)) with consistent mass,
//!    θ = (2k - 1) π / 2n. They stand among frequencies of bending and torsion, those of bending twice by symmetry.
//!    Tolerance 1e-9: the residuals of the eigensolver bound relative errors by 1e-10.
//! 2. The same bar without supports: six frequencies are zero, their ω² rounding of the largest, below 1e-8 of the first other
//!    one; the number of frequencies up to the last by inertia is that found.
//! 3. A cantilever of 20 beam elements: Euler and Bernoulli's frequencies, 0.1 % as in `beam-frequencies`; effective masses of
//!    the first three modes 61.31, 18.83 and 6.47 % of the mass (Clough and Penzien, Dynamics of Structures, chapter 18: those of
//!    a uniform cantilever), 0.1 points. The sum over all modes is the mass without what the clamped node carries, which is less
//!    than the mass of an element.
//! 4. Two equal oscillators on springs k with a spring κ between them, κ = 0 in one model of two parts:
//!    ω² = k/m and (k + 2 κ)/m; 1e-12.

use std::f64::consts::{PI, TAU};

use carom_bodies::{
    BeamTheory, Curve, DiscreteKind, DiscreteSpec, Kinematics, Link, MassKind, PointMass,
};
use carom_dynamics::{Model, ModelDiscrete};
use carom_elements::Kind;
use carom_exact::beam::End;
use carom_materials::Elastic;
use carom_mesh::{Mesh, generate};
use carom_reduction::{Modes, modes};

use crate::Error;
use crate::beams::{exact, held, section, straight};
use crate::build::{body, newmark, support};
use crate::check::{Check, Row, Size};

const SOLID: Elastic = Elastic {
    density: 1000.0,
    young: 1e9,
    poisson: 0.0,
};

const ALONG: usize = 24;

fn of(model: Model, count: usize) -> Result<Vec<Modes>, Error> {
    let system = crate::witness::system(model)?;
    Ok(modes(&system, count, &mut |_, _| {})?)
}

fn bar(mass: MassKind, across: usize, is_held: bool) -> Result<Modes, Error> {
    let mesh = generate::box_(
        "bar",
        [0.0; 3],
        [1.0, 0.2, 0.2],
        [ALONG, across, across],
        false,
    );
    let mut made = body(&mesh, "bar", Kinematics::Solid, SOLID)?;
    made.mass = mass;
    let mut supports = Vec::new();
    if is_held {
        supports.push(support(&mesh, "bar.left", [true; 3])?);
    }
    let model = Model {
        supports,
        ..Model::new(vec![made], mesh, newmark(0.25, 0.5), 1e-6)
    };
    let mut found = of(model, 24)?;
    Ok(found.remove(0))
}

fn counted(name: &str, found: &Modes) -> Row {
    let count = found.count();
    let missing = count.exist as f64 - count.found as f64;
    Row::at_most(
        format!("{name}: modes that inertia counts and the search lacks"),
        missing.abs(),
        0.0,
    )
}

fn bars(size: Size) -> Result<Vec<Row>, Error> {
    let across = match size {
        Size::Quick => 2,
        Size::Full => 4,
    };
    let mut rows = Vec::new();
    let (speed, h) = ((SOLID.young / SOLID.density).sqrt(), 1.0 / ALONG as f64);
    for (mass, name) in [
        (MassKind::Lumped, "lumped"),
        (MassKind::Consistent, "consistent"),
    ] {
        let found = bar(mass, across, true)?;
        rows.push(counted(&format!("held bar, {name}"), &found));
        for k in 1..=2 {
            let angle = (2 * k - 1) as f64 * PI / (2 * ALONG) as f64;
            let reference = match mass {
                MassKind::Lumped => 2.0 * speed / h * (0.5 * angle).sin(),
                MassKind::Consistent => {
                    speed / h * (6.0 * (1.0 - angle.cos()) / (2.0 + angle.cos())).sqrt()
                }
            };
            let off = |f: &f64| (f - reference).abs();
            let all = (0..found.len()).map(|mode| TAU * found.frequency(mode));
            let nearest = all.min_by(|a, b| off(a).total_cmp(&off(b)));
            rows.push(Row::relative(
                format!("held bar, {name}: longitudinal frequency {k}, rad/s"),
                nearest.unwrap_or(f64::NAN),
                reference,
                1e-9,
            ));
        }
        let free = bar(mass, across, false)?;
        rows.push(counted(&format!("free bar, {name}"), &free));
        let zero = (0..6)
            .map(|mode| free.square(mode).abs())
            .fold(0.0, f64::max);
        rows.push(Row::at_most(
            format!("free bar, {name}: largest of six ω² over the seventh"),
            zero / free.square(6),
            1e-8,
        ));
    }
    Ok(rows)
}

fn cantilever() -> Result<Vec<Row>, Error> {
    let elements = 20;
    let given = section(0.02, BeamTheory::EulerBernoulli);
    let (mesh, made) = straight([[0.0; 3], [1.0, 0.0, 0.0]], elements, 2, given)?;
    let model = Model {
        supports: vec![held(vec![0], [true; 3], [true; 3])],
        ..Model::new(vec![made], mesh, newmark(0.25, 0.5), 1e-6)
    };
    let found = of(model, 3 * elements)?.remove(0);
    let references = exact(1.0, &given, 0).frequencies([End::Clamped, End::Free], 3);
    let mut rows = Vec::new();
    for (k, (reference, share)) in references
        .into_iter()
        .zip([0.6131, 0.1883, 0.0647])
        .enumerate()
    {
        rows.push(Row::relative(
            format!("cantilever: frequency {}, rad/s", k + 1),
            TAU * found.frequency(k),
            reference,
            1e-3,
        ));
        rows.push(Row::near(
            format!("cantilever: effective mass of mode {} over the mass", k + 1),
            found.participation[k].effective_mass()[1] / found.mass[1],
            share,
            1e-3,
        ));
    }
    let sum: f64 = found
        .participation
        .iter()
        .map(|p| p.effective_mass()[1])
        .sum();
    let held = 1.0 - sum / found.mass[1];
    rows.push(Row::at_most(
        "cantilever: mass that no mode has, over that of an element",
        held * elements as f64,
        1.0,
    ));
    Ok(rows)
}

/// Two masses m on springs k, with κ between them.
fn oscillators() -> Result<Vec<Row>, Error> {
    let (m, k, between) = (2.0, 50.0, 30.0);
    let mut rows = Vec::new();
    for coupled in [false, true] {
        let mut mesh = Mesh::new(1);
        mesh.nodes = vec![[0.0; 3], [1.0, 0.0, 0.0]];
        let points = [0, 1].map(|node| mesh.push(Kind::Point1, &[node]));
        let line = mesh.push(Kind::Bar2, &[0, 1]);
        let mass = PointMass {
            mass: m,
            inertia: [0.0; 3],
        };
        let spring = |stiffness: f64| {
            DiscreteKind::Spring(Link {
                curve: Curve::line(stiffness),
                axis: Some([1.0, 0.0, 0.0]),
            })
        };
        let mut specs = vec![
            ("masses", points.to_vec(), DiscreteKind::Mass(mass)),
            ("ground", points.to_vec(), spring(k)),
        ];
        if coupled {
            specs.push(("between", vec![line], spring(between)));
        }
        let discrete = specs.into_iter().map(|(name, cells, kind)| {
            ModelDiscrete::new(DiscreteSpec {
                name: name.to_owned(),
                cells,
                kind,
            })
        });
        let model = Model {
            discrete: discrete.collect(),
            ..Model::new(Vec::new(), mesh, newmark(0.25, 0.5), 1e-3)
        };
        let found = of(model, 2)?;
        let mut squares: Vec<f64> = found
            .iter()
            .flat_map(|part| (0..part.len()).map(|mode| part.square(mode)))
            .collect();
        squares.sort_by(f64::total_cmp);
        let second = if coupled { k + 2.0 * between } else { k };
        for (j, reference) in [k / m, second / m].into_iter().enumerate() {
            let name = if coupled { "coupled" } else { "two" };
            rows.push(Row::relative(
                format!("{name} oscillators: ω² of mode {}, 1/s²", j + 1),
                squares.get(j).copied().unwrap_or(f64::NAN),
                reference,
                1e-12,
            ));
        }
    }
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "modes",
    fact: "solids, beams and oscillators have the modes of their closed forms, multiple and rigid ones too, and none is missed",
    run: |size| {
        let mut rows = bars(size)?;
        rows.extend(cantilever()?);
        rows.extend(oscillators()?);
        Ok(rows)
    },
};
