//! Patch tests of the overlap of a shell and a solid.
//!
//! Problem: a plate of length 8 h and width 2 h in two models, to the left a solid, to the right a shell, which overlap over 2 h. Its left end is
//! held along x; forces or moments act on the right one. Three fields:
//! - tension, u = ε x, v = -ν ε y, w = -ν ε z, the sides free;
//! - bending, u = -κ x z, v = ν κ y z, w = κ/2 (x² - ν y² + ν z²), the sides free;
//! - cylindrical bending, u = -κ x z, v = 0, w = κ/2 (x² + ν/(1 - ν) z²), the sides planes of symmetry.
//!
//! The shell has their mean over the thickness: its deflection has ν κ h²/24 besides, over 1 - ν in the third. The second and the third need no
//! special state of load: plane stress in the thickness is the same in both models.
//!
//! Linear cells have the first field, quadratic ones all, and linear weights with the mediator of a shell keep them: the multiplier is σ
//! times the slope of the weights, (σ, 0, 0) and (-c z, 0, 0). Tolerance 1e-9 of the largest displacement, as it is asked: the condition of the matrices, 1e6, times
//! rounding, with room. Where the shell ends within hexahedra the products of their weights and z are not in their space: that is tested with tetrahedra. Shape functions
//! of distorted quadrilaterals are no polynomials of the place, and pieces of them are not integrated exactly: 1e-6, a regression, bound 1e-5.
//!
//! Controls, which must fail. Constant weights: no mediator of functions holds the jump of the weight. Rotations of the mediator tied to the slope of its
//! translations: (-c z, 0, 0) is not in it. Bounds 1e-3, regressions, from below.
//!
//! Transitions, the edge of the shell on the end of the solid without an overlap, every other node of the solid: one that distributes has the tractions of all three fields, and keeps
//! them. With nodes inside of faces these are integrated across kinks: bound 1e-3, a regression. Rigid sections stop the contraction of the thickness and must fail.

use carom_arlequin::{Profile, Row as Coupled, Term, Weighting};
use carom_dynamics::{
    Amplitude, Driver, Model, ModelConstraint, NodalLoad, Order, Preload, Support,
};
use carom_materials::Elastic;
use carom_mesh::Mesh;

use crate::Error;
use crate::beam_solid::Joint;
use crate::beams::held;
use crate::build::newmark;
use crate::check::{Check, Row, Size};
use crate::shell_solid::{Cells, Plate};

const MATERIAL: Elastic = Elastic {
    density: 7800.0,
    young: 2.1e11,
    poisson: 0.3,
};
const THICKNESS: f64 = 0.1;
/// Strain of the tension, and curvature (1/m) of the bending.
const STRAIN: f64 = 1e-4;
const CURVATURE: f64 = 1e-3;

/// Which field.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Patch {
    Tension,
    Bending,
    Cylindrical,
}

/// What of the coupling is changed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Change {
    None,
    ConstantWeights,
    TiedRotations,
    Transition(Joint),
}

fn plate(kind: Cells, quadratic: bool, complete: bool) -> Plate {
    Plate {
        thickness: THICKNESS,
        width: 2.0 * THICKNESS,
        solid: [0.0, 5.0 * THICKNESS],
        shell: [3.0 * THICKNESS, 8.0 * THICKNESS],
        cells: [10, 4, 2],
        kind,
        quadratic,
        complete,
        elements: [5, 2],
        triangles: false,
        distorted: 0.0,
        material: MATERIAL,
        weighting: Weighting::default(),
    }
}

/// The exact displacement of the solid at a place, and of the shell.
fn exact(patch: Patch, x: &[f64; 3], on_shell: bool) -> [f64; 3] {
    let (nu, [x, y, z]) = (MATERIAL.poisson, *x);
    let inside = match on_shell {
        true => THICKNESS * THICKNESS / 12.0,
        false => z * z,
    };
    match patch {
        Patch::Tension => [STRAIN * x, -nu * STRAIN * y, -nu * STRAIN * z],
        Patch::Bending => [
            -CURVATURE * x * z,
            nu * CURVATURE * y * z,
            0.5 * CURVATURE * (x * x - nu * y * y + nu * inside),
        ],
        Patch::Cylindrical => [
            -CURVATURE * x * z,
            0.0,
            0.5 * CURVATURE * (x * x + nu / (1.0 - nu) * inside),
        ],
    }
}

/// Force along x and moment about y per length of the right end.
fn load(patch: Patch) -> [f64; 2] {
    let inertia = THICKNESS.powi(3) / 12.0;
    match patch {
        Patch::Tension => [MATERIAL.young * THICKNESS * STRAIN, 0.0],
        Patch::Bending => [0.0, -MATERIAL.young * inertia * CURVATURE],
        Patch::Cylindrical => {
            let plane = MATERIAL.young / (1.0 - MATERIAL.poisson.powi(2));
            [0.0, -plane * inertia * CURVATURE]
        }
    }
}

fn supports(patch: Patch, plate: &Plate, mesh: &Mesh) -> Vec<Support> {
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
    let left = plate.of_solid(mesh, &|x| near(x[0], 0.0));
    let middle = plate.of_solid(mesh, &|x| x.iter().all(|x| near(*x, 0.0)));
    let above = plate.of_solid(mesh, &|x| {
        near(x[0], 0.0) && near(x[1], 0.0) && near(x[2], 0.5 * THICKNESS)
    });
    let mut supports = vec![
        held(left, [true, false, false], [false; 3]),
        held(middle, [true; 3], [false; 3]),
        held(above, [true, true, false], [false; 3]),
    ];
    if patch == Patch::Cylindrical {
        supports.extend(plate.symmetric(mesh));
    }
    supports
}

fn loads(patch: Patch, plate: &Plate, mesh: &Mesh) -> Vec<NodalLoad> {
    let grid = plate.grid();
    let [force, moment] = load(patch);
    let share = plate.width / grid.m as f64;
    let end = grid.column(grid.n);
    let nodes = end.iter().enumerate().map(|(j, &node)| {
        let part = if j == 0 || j == grid.m { 0.5 } else { 1.0 };
        NodalLoad {
            name: format!("end {j}"),
            nodes: plate.of_shell(mesh, &[node]),
            force: [part * share * force, 0.0, 0.0],
            moment: [0.0, part * share * moment, 0.0],
            amplitude: Amplitude::constant(1.0),
        }
    });
    nodes.collect()
}

/// Largest error of a displacement over the largest displacement.
fn error(patch: Patch, plate: &Plate, change: Change) -> Result<f64, Error> {
    let weighting = match change {
        Change::ConstantWeights => Weighting {
            stiffness: Profile::Constant(0.5),
            ..plate.weighting
        },
        _ => plate.weighting,
    };
    let plate = Plate {
        weighting,
        ..*plate
    };
    let mesh = plate.mesh()?;
    let (bodies, rows) = match change {
        Change::Transition(joint) => plate.on_face(&mesh, joint)?,
        _ => {
            let (bodies, glued) = plate.glued(&mesh)?;
            (bodies, glued.rows)
        }
    };
    let mut rows = rows.rows;
    if change == Change::TiedRotations {
        rows = tied(&rows, &plate, &mesh);
    }
    let mut model = Model {
        supports: supports(patch, &plate, &mesh),
        constraints: vec![ModelConstraint::of_rows("overlap", &rows, 3)],
        ..Model::new(bodies.to_vec(), mesh.clone(), newmark(0.25, 0.5), 1e-3)
    };
    model.nonlinear.nodal = loads(patch, &plate, &mesh);
    model.nonlinear.preload = Some(Preload { end: 1.0, steps: 1 });
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    driver.step()?;
    let system = driver.system();
    let first = plate.first(&mesh) as usize;
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for (node, x) in mesh.nodes.iter().enumerate() {
        let number = system.number[node];
        if number == u32::MAX {
            continue;
        }
        let found = system.of_node(number, &driver.state().motion, Order::Displacement);
        let expected = exact(patch, x, node >= first);
        for i in 0..3 {
            worst = worst.max((found[i] - expected[i]).abs());
            largest = largest.max(expected[i].abs());
        }
    }
    Ok(worst / largest)
}

/// Rows of a mediator whose rotations are the slopes of its translations, by differences between its nodes.
fn tied(rows: &[Coupled], plate: &Plate, mesh: &Mesh) -> Vec<Coupled> {
    let (grid, first) = (plate.grid(), plate.first(mesh));
    let find = |node: u32, component: u32| {
        let mut rows = rows.iter();
        rows.find(|row| row.node == node && row.component == component)
    };
    let gyration = THICKNESS / 12.0_f64.sqrt();
    let mut all = Vec::new();
    for row in rows.iter().filter(|row| row.component < 3) {
        let mut sum = row.clone();
        let place = (row.node - first) as usize;
        let (i, j) = (place % (grid.n + 1), place / (grid.n + 1));
        // a slope along x turns about -y, one along y about x
        let before = (i > 0).then(|| grid.node(i - 1, j) + first);
        let after = (i < grid.n).then(|| grid.node(i + 1, j) + first);
        let left = (j > 0).then(|| grid.node(i, j - 1) + first);
        let right = (j < grid.m).then(|| grid.node(i, j + 1) + first);
        for (other, component, sign) in [
            (before, 4, -1.0),
            (after, 4, 1.0),
            (left, 3, 1.0),
            (right, 3, -1.0),
        ] {
            let rotation = other.and_then(|other| find(other, component));
            let (Some(rotation), 2) = (rotation, row.component) else {
                continue;
            };
            let [x, y] = [rotation.node, row.node].map(|node| mesh.nodes[node as usize]);
            let way = (x[0] - y[0]).abs() + (x[1] - y[1]).abs();
            let factor = sign * gyration / (2.0 * way);
            for (to, from) in [
                (&mut sum.inner, &rotation.inner),
                (&mut sum.outer, &rotation.outer),
            ] {
                to.extend(from.iter().map(|term| Term {
                    coefficient: factor * term.coefficient,
                    ..*term
                }));
            }
        }
        all.push(sum);
    }
    all
}

/// The edge of the shell on the end of the solid. Shape functions of the edge have kinks at its nodes: faces that have one inside are not integrated exactly.
fn transitions() -> Result<Vec<Row>, Error> {
    let butt = |across| Plate {
        solid: [0.0, 4.0 * THICKNESS],
        shell: [4.0 * THICKNESS, 8.0 * THICKNESS],
        cells: [8, 4, 2],
        elements: [4, across],
        ..plate(Cells::Hexahedra, true, false)
    };
    let mut rows = Vec::new();
    for patch in [Patch::Tension, Patch::Bending, Patch::Cylindrical] {
        let of = |joint, across| error(patch, &butt(across), Change::Transition(joint));
        let label = format!("hex20, {patch:?}, distributing transition: error");
        rows.push(Row::at_most(label, of(Joint::Distributing, 2)?, 1e-9));
        let label =
            format!("hex20, {patch:?}, distributing transition, nodes inside of faces: error");
        rows.push(Row::at_most(label, of(Joint::Distributing, 3)?, 1e-3).regression());
        // sides that are held have no rows to spare for rigid sections
        if patch != Patch::Cylindrical {
            let label = format!("hex20, {patch:?}, rigid transition: error");
            rows.push(Row::at_least(label, of(Joint::Rigid, 2)?, 1e-3).regression());
        }
    }
    Ok(rows)
}

fn rows(size: Size) -> Result<Vec<Row>, Error> {
    use Cells::{Hexahedra, Tetrahedra, Wedges};
    let mut rows = Vec::new();
    let mut add = |name: &str, patch: Patch, plate: &Plate| -> Result<(), Error> {
        let label = format!("{name}, {patch:?}: error / largest displacement");
        let found = error(patch, plate, Change::None)?;
        rows.push(Row::at_most(label, found, 1e-9));
        Ok(())
    };
    for (name, kind) in [
        ("hex8", Hexahedra),
        ("tet4", Tetrahedra),
        ("wedge6", Wedges),
    ] {
        add(name, Patch::Tension, &plate(kind, false, false))?;
    }
    let hex20 = plate(Hexahedra, true, false);
    let all = [Patch::Tension, Patch::Bending, Patch::Cylindrical];
    for patch in all {
        add("hex20", patch, &hex20)?;
    }
    for (name, kind, complete) in [
        ("tet10", Tetrahedra, false),
        ("hex27", Hexahedra, true),
        ("wedge15", Wedges, false),
    ] {
        let patches: &[Patch] = match size {
            Size::Quick => &[Patch::Bending],
            Size::Full => &all,
        };
        for &patch in patches {
            add(name, patch, &plate(kind, true, complete))?;
        }
    }
    let finer = |of: Plate| Plate {
        elements: [7, 3],
        ..of
    };
    let distorted = Plate {
        distorted: 0.2,
        ..finer(hex20)
    };
    let triangles = Plate {
        triangles: true,
        ..finer(hex20)
    };
    // the end of the shell within cells
    let shifted = |of: Plate| Plate {
        shell: [3.13 * THICKNESS, 8.0 * THICKNESS],
        ..finer(of)
    };
    let coarse = Plate {
        cells: [5, 2, 2],
        elements: [20, 8],
        ..hex20
    };
    for patch in [Patch::Tension, Patch::Cylindrical] {
        add("hex20, shell not matching", patch, &finer(hex20))?;
        add("hex20, triangles", patch, &triangles)?;
        add("hex20, shell finer than the solid", patch, &coarse)?;
        let tet10 = shifted(plate(Tetrahedra, true, false));
        add("tet10, shell ending in cells", patch, &tet10)?;
    }
    for patch in [Patch::Tension, Patch::Cylindrical] {
        let label = format!("hex20, shell distorted, {patch:?}: error");
        let found = error(patch, &distorted, Change::None)?;
        rows.push(Row::at_most(label, found, 1e-5).regression());
    }
    for patch in [Patch::Tension, Patch::Bending] {
        let label = format!("{patch:?}, constant weights: error");
        let found = error(patch, &hex20, Change::ConstantWeights)?;
        rows.push(Row::at_least(label, found, 1e-3).regression());
    }
    rows.extend(transitions()?);
    let found = error(Patch::Bending, &hex20, Change::TiedRotations)?;
    rows.push(Row::at_least("Bending, rotations tied: error", found, 1e-3).regression());
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "shell-solid-patch",
    fact: "an overlap of a shell and a solid keeps uniform tension, pure and cylindrical bending",
    run: rows,
};
