//! Patch tests of the overlap of a beam and a solid.
//!
//! Problem: a bar of length 8 h in two models, to the left a solid, to the right a beam, which overlap over 2 h. Its left end is held
//! along its axis; a normal force or a moment acts on the right one. Sections are free to contract and to bend in themselves.
//!
//! Closed form: uniaxial tension, u = ε x, v = -ν ε y, w = -ν ε z; pure bending, u = -κ x y, v = κ/2 (x² + ν (y² - z²)), w = ν κ y z
//! (plane stress: z = 0). The beam has the mean motion of the sections: its deflection has ν κ/2 (⟨y²⟩ - ⟨z²⟩) besides.
//!
//! Linear cells have the first field, quadratic ones both, and linear weights with the mediator of a beam keep them: the multiplier is σ
//! times the slope of the weights, (σ, 0, 0) and (-c y, 0, 0). Tolerance 1e-9 of the largest displacement: the condition of the matrices, 1e6,
//! times rounding, with room.
//!
//! Controls, which must fail. Constant weights: no mediator of functions holds the jump of the weight. Rotations of the mediator tied to the slope of its
//! translations: (-c y, 0, 0) is not in it.
//!
//! Transitions, the end of the beam on the end of the solid without an overlap: one that distributes has the tractions of both fields, and keeps them; a
//! rigid face stops the contraction of the section and must fail. Bounds of what must fail 1e-3, regressions, from below.

use carom_arlequin::{Profile, Row as Coupled, Weighting};
use carom_bodies::BeamTheory;
use carom_dynamics::{
    Amplitude, Driver, Model, ModelConstraint, NodalLoad, Order, Preload, Support,
};
use carom_materials::Elastic;

use crate::Error;
use crate::beam_solid::{Joint, Spliced};
use crate::build::newmark;
use crate::check::{Check, Row, Size};

const MATERIAL: Elastic = Elastic {
    density: 7800.0,
    young: 2.1e11,
    poisson: 0.3,
};
const HEIGHT: f64 = 0.1;
const WIDTH: f64 = 0.06;
/// Strain of the tension, and curvature (1/m) of the bending.
const STRAIN: f64 = 1e-4;
const CURVATURE: f64 = 1e-3;

/// Which field.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Patch {
    Tension,
    Bending,
}

/// What of the coupling is changed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Change {
    None,
    ConstantWeights,
    TiedRotations,
    Transition(Joint),
}

fn spliced(dim: usize, simplices: bool, quadratic: bool, complete: bool) -> Spliced {
    Spliced {
        dim,
        section: [HEIGHT, WIDTH],
        solid: [0.0, 5.0 * HEIGHT],
        beam: [3.0 * HEIGHT, 8.0 * HEIGHT],
        cells: [10, 2, 2],
        elements: 5,
        simplices,
        quadratic,
        complete,
        theory: BeamTheory::Timoshenko,
        material: MATERIAL,
        weighting: Weighting::default(),
    }
}

/// The exact displacement of the solid at a place, and of the axis of the beam.
fn exact(patch: Patch, bar: &Spliced, x: &[f64; 3], on_beam: bool) -> [f64; 3] {
    let (nu, [x, y, z]) = (MATERIAL.poisson, *x);
    match patch {
        Patch::Tension => [STRAIN * x, -nu * STRAIN * y, -nu * STRAIN * z],
        Patch::Bending => {
            let square = |size: f64| size * size / 12.0;
            let inside = match (on_beam, bar.dim) {
                (false, _) => y * y - z * z,
                (true, 2) => square(HEIGHT),
                (true, _) => square(HEIGHT) - square(WIDTH),
            };
            [
                -CURVATURE * x * y,
                0.5 * CURVATURE * (x * x + nu * inside),
                nu * CURVATURE * y * z,
            ]
        }
    }
}

/// Largest error of a displacement over the largest displacement.
fn error(patch: Patch, bar: &Spliced, change: Change) -> Result<f64, Error> {
    let weighting = match change {
        Change::ConstantWeights => Weighting {
            stiffness: Profile::Constant(0.5),
            ..bar.weighting
        },
        _ => bar.weighting,
    };
    let bar = Spliced { weighting, ..*bar };
    let mesh = bar.mesh()?;
    let joint = match change {
        Change::Transition(joint) => joint,
        _ => Joint::Overlap,
    };
    let (bodies, mut constraint) = bar.joined(&mesh, joint)?;
    if change == Change::TiedRotations {
        let rows = tied(&bar.glued(&mesh)?.1.rows.rows, bar.dim, &mesh.nodes);
        constraint = ModelConstraint::of_rows("tied", &rows, bar.dim);
    }
    let properties = bar.beam_section().properties;
    let young = MATERIAL.young;
    let (force, moment) = match patch {
        Patch::Tension => (young * properties.area * STRAIN, 0.0),
        Patch::Bending => (0.0, young * properties.second_moments[1] * CURVATURE),
    };
    let last = mesh.nodes.len() as u32 - 1;
    let at = |keep: &dyn Fn(&[f64; 3]) -> bool| -> Vec<u32> {
        let beam_from = mesh.nodes.len() - bar.elements - 1;
        (0..beam_from as u32)
            .filter(|&n| keep(&mesh.nodes[n as usize]))
            .collect()
    };
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
    let support = |nodes: Vec<u32>, fix: [bool; 3]| Support {
        nodes,
        fix,
        fix_rotations: [false; 3],
    };
    let mut supports = vec![
        support(at(&|x| near(x[0], 0.0)), [true, false, false]),
        support(
            at(&|x| near(x[0], 0.0) && near(x[1], 0.0) && near(x[2], 0.0)),
            [true, true, bar.dim == 3],
        ),
    ];
    if bar.dim == 3 {
        supports.push(support(
            at(&|x| near(x[0], 0.0) && near(x[1], 0.5 * HEIGHT) && near(x[2], 0.0)),
            [false, false, true],
        ));
    }
    let mut model = Model {
        supports,
        constraints: vec![constraint],
        ..Model::new(bodies.to_vec(), mesh, newmark(0.25, 0.5), 1e-3)
    };
    model.nonlinear.nodal = vec![NodalLoad {
        name: "end".into(),
        nodes: vec![last],
        force: [force, 0.0, 0.0],
        moment: [0.0, 0.0, moment],
        amplitude: Amplitude::constant(1.0),
    }];
    model.nonlinear.preload = Some(Preload { end: 1.0, steps: 1 });
    let mesh = model.mesh.clone();
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    driver.step()?;
    let system = driver.system();
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for (node, x) in mesh.nodes.iter().enumerate() {
        let number = system.number[node];
        if number == u32::MAX {
            continue;
        }
        let on_beam = node + bar.elements + 1 >= mesh.nodes.len();
        let found = system.of_node(number, &driver.state().motion, Order::Displacement);
        let expected = exact(patch, &bar, x, on_beam);
        for i in 0..bar.dim {
            worst = worst.max((found[i] - expected[i]).abs());
            largest = largest.max(expected[i].abs());
        }
    }
    Ok(worst / largest)
}

/// Rows of a mediator whose rotations are the slopes of its translations, by differences between its nodes.
fn tied(rows: &[Coupled], dim: usize, nodes: &[[f64; 3]]) -> Vec<Coupled> {
    let mut stations: Vec<u32> = rows.iter().map(|row| row.node).collect();
    stations.dedup();
    stations.sort_by(|a, b| nodes[*a as usize][0].total_cmp(&nodes[*b as usize][0]));
    let find = |node: u32, component: usize| {
        let mut rows = rows.iter();
        rows.find(|row| row.node == node && row.component as usize == component)
    };
    // rows of rotations are over the radius of gyration
    let radius = match dim {
        2 => HEIGHT / 12.0_f64.sqrt(),
        _ => HEIGHT.hypot(WIDTH) / 12.0_f64.sqrt(),
    };
    let mut all = Vec::new();
    for (i, &node) in stations.iter().enumerate() {
        for component in 0..dim {
            let Some(row) = find(node, component) else {
                continue;
            };
            let mut sum = row.clone();
            // a slope of y turns about z, one of z about -y
            let turned = match (component, dim) {
                (1, 2) => Some((2, 1.0)),
                (1, _) => Some((5, 1.0)),
                (2, _) => Some((4, -1.0)),
                _ => None,
            };
            for (j, &other) in stations.iter().enumerate() {
                let Some((axis, sign)) = turned else { continue };
                let (before, after) = (j.saturating_sub(1), (j + 1).min(stations.len() - 1));
                let x = |k: usize| nodes[stations[k] as usize][0];
                let slope = f64::from(i == after) - f64::from(i == before);
                let factor = sign * slope * radius / (x(after) - x(before));
                let Some(rotation) = find(other, axis).filter(|_| slope != 0.0) else {
                    continue;
                };
                for (to, from) in [
                    (&mut sum.inner, &rotation.inner),
                    (&mut sum.outer, &rotation.outer),
                ] {
                    to.extend(from.iter().map(|t| carom_arlequin::Term {
                        coefficient: factor * t.coefficient,
                        ..*t
                    }));
                }
            }
            all.push(sum);
        }
    }
    all
}

/// The end of the beam on the end of the solid.
fn transitions() -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    let butt = |bar: Spliced| Spliced {
        solid: [0.0, 4.0 * HEIGHT],
        beam: [4.0 * HEIGHT, 8.0 * HEIGHT],
        cells: [8, 2, 2],
        elements: 4,
        ..bar
    };
    for (name, bar) in [
        ("quad8", butt(spliced(2, false, true, false))),
        ("hex20", butt(spliced(3, false, true, false))),
    ] {
        for patch in [Patch::Tension, Patch::Bending] {
            let of = |joint| error(patch, &bar, Change::Transition(joint));
            rows.push(Row::at_most(
                format!("{name}, {patch:?}, distributing transition: error"),
                of(Joint::Distributing)?,
                1e-9,
            ));
            rows.push(
                Row::at_least(
                    format!("{name}, {patch:?}, rigid transition: error"),
                    of(Joint::Rigid)?,
                    1e-3,
                )
                .regression(),
            );
        }
    }
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "beam-solid-patch",
    fact: "an overlap of a beam and a solid keeps uniform tension and pure bending",
    run: |size| {
        let mut rows = Vec::new();
        let mut add = |name: &str, patch, bar: &Spliced| -> Result<(), Error> {
            let label = format!("{name}, {patch:?}: error / largest displacement");
            rows.push(Row::at_most(label, error(patch, bar, Change::None)?, 1e-9));
            Ok(())
        };
        for (name, simplices) in [("quad4", false), ("tri3", true)] {
            add(name, Patch::Tension, &spliced(2, simplices, false, false))?;
        }
        for (name, simplices, complete) in [
            ("quad8", false, false),
            ("quad9", false, true),
            ("tri6", true, false),
        ] {
            for patch in [Patch::Tension, Patch::Bending] {
                add(name, patch, &spliced(2, simplices, true, complete))?;
            }
        }
        for (name, simplices) in [("hex8", false), ("tet4", true)] {
            add(name, Patch::Tension, &spliced(3, simplices, false, false))?;
        }
        let quadratic: &[(&str, bool, bool)] = match size {
            Size::Quick => &[("hex20", false, false), ("tet10", true, false)],
            Size::Full => &[
                ("hex20", false, false),
                ("hex27", false, true),
                ("tet10", true, false),
            ],
        };
        for &(name, simplices, complete) in quadratic {
            for patch in [Patch::Tension, Patch::Bending] {
                add(name, patch, &spliced(3, simplices, true, complete))?;
            }
        }
        // the end of the beam within cells, and its elements across them
        let shifted = |bar: Spliced| Spliced {
            beam: [3.13 * HEIGHT, 8.0 * HEIGHT],
            elements: 7,
            ..bar
        };
        for (name, patch, bar) in [
            (
                "tri3, not matching",
                Patch::Tension,
                spliced(2, true, false, false),
            ),
            (
                "quad4, not matching",
                Patch::Tension,
                spliced(2, false, false, false),
            ),
            (
                "tri6, not matching",
                Patch::Bending,
                spliced(2, true, true, false),
            ),
            (
                "tet4, not matching",
                Patch::Tension,
                spliced(3, true, false, false),
            ),
            (
                "tet10, not matching",
                Patch::Bending,
                spliced(3, true, true, false),
            ),
        ] {
            add(name, patch, &shifted(bar))?;
        }
        let slender = Spliced {
            theory: BeamTheory::EulerBernoulli,
            ..spliced(2, false, true, false)
        };
        add("quad8, Euler-Bernoulli", Patch::Bending, &slender)?;
        let quad8 = spliced(2, false, true, false);
        for patch in [Patch::Tension, Patch::Bending] {
            rows.push(
                Row::at_least(
                    format!("{patch:?}, constant weights: error"),
                    error(patch, &quad8, Change::ConstantWeights)?,
                    1e-3,
                )
                .regression(),
            );
        }
        rows.extend(transitions()?);
        rows.push(
            Row::at_least(
                "Bending, rotations tied: error",
                error(Patch::Bending, &quad8, Change::TiedRotations)?,
                1e-3,
            )
            .regression(),
        );
        Ok(rows)
    },
};
