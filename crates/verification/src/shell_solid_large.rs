//! The overlap of a shell with finite rotations and a solid at finite strain.
//!
//! Problems:
//! - Turned patch: the plate of the tension of `shell-solid-patch` is turned by 100° about an oblique axis, stretched along its turned axis by 1e-6, and pulled there at both ends with the
//!   force of this strain, with hexahedra and tetrahedra, quadrilaterals and triangles, meshes that match and that do not. It is free, and stays where it is: the largest speed over the c ε of a wave
//!   of this strain, in the time in which one runs through the plate. Closed form: zero. Tolerance 1e-5: the field is that of small strains, whose terms left out are of the order of
//!   the strain; rounding of places is 1e-10 of the displacement. Turned without strain the plate has no energy: 1e-20 of that of a strain of one. With rows of small angles, as a
//!   control, the plate must move.
//! - Elastica: a strip, L/h = 100, ν = 0, clamped at the end of the shell, under a force F across it at the end of the solid, overlap in the middle. Closed form: displacements of the tip for
//!   F L²/(E I) = 2 and 5 (Mattiasson 1981, Int. J. Num. Meth. Eng. 17, 145). Tolerance 1 % of the length: strains to 2.5 %, which neo-Hooke's material feels, shear, and 20 elements.
//! - A free plate that spins and tumbles, energy-momentum: energy, momentum and angular momentum are kept, and the overlap does no work. Tolerance 1e-8 of energies and works, 1e-10 of both
//!   momenta, of iterations that leave 1e-12 of the forces in each step; the plate bends, which is bounded from below.

use carom_algebra::tensor::Vec3;
use carom_arlequin::Weighting;
use carom_dynamics::{Amplitude, Driver, Load, LoadKind, Model, Order, Preload, Scheme};
use carom_materials::Elastic;
use carom_mesh::Mesh;

use crate::Error;
use crate::beams::held;
use crate::build::{newmark, surface};
use crate::check::{Check, Row, Size};
use crate::glued_turning::{self, CONSERVING, Joined, TurnedPatch};
use crate::shell_solid::{Cells, Plate};

const STEEL: Elastic = Elastic {
    density: 7800.0,
    young: 2.1e11,
    poisson: 0.3,
};

/// The plate of the patch.
pub(crate) fn patch_plate() -> Plate {
    const H: f64 = 0.1;
    Plate {
        thickness: H,
        width: 2.0 * H,
        solid: [0.0, 5.0 * H],
        shell: [3.0 * H, 8.0 * H],
        cells: [10, 4, 2],
        kind: Cells::Hexahedra,
        quadratic: false,
        complete: false,
        elements: [5, 2],
        triangles: false,
        distorted: 0.0,
        material: STEEL,
        weighting: Weighting::default(),
    }
}

pub(crate) fn model(
    plate: &Plate,
    stepping: (Scheme, f64),
    joined: Joined,
) -> Result<Model, Error> {
    let mesh = plate.mesh()?;
    let (bodies, glued) = plate.glued_turning(&mesh)?;
    Ok(glued_turning::model(
        (mesh, bodies, glued),
        stepping,
        joined,
    ))
}

/// The patch that a plate is.
pub(crate) fn patch_of(plate: &Plate) -> TurnedPatch {
    TurnedPatch {
        axis: Vec3::new(1.0, 2.0, 3.0),
        material: plate.material,
        size: [plate.shell[1], plate.width, plate.thickness],
    }
}

/// Nodes at the end of the shell, and their parts of its force.
pub(crate) fn end_of(plate: &Plate, mesh: &Mesh) -> Vec<(u32, f64)> {
    let grid = plate.grid();
    let nodes = plate.of_shell(mesh, &grid.column(grid.n));
    let last = nodes.len() - 1;
    let part = |k: usize| if k == 0 || k == last { 0.5 } else { 1.0 };
    let end = nodes.iter().enumerate();
    end.map(|(k, &node)| (node, part(k) / last as f64))
        .collect()
}

/// Largest speed of a turned and stretched plate over c ε, and the energy without the strain over that of a strain of one.
fn turned_patch(plate: &Plate, joined: Joined) -> Result<[f64; 2], Error> {
    let patch = patch_of(plate);
    let model = model(plate, (CONSERVING, patch.step()), joined)?;
    let end = end_of(plate, &model.mesh);
    patch.run(model, &end)
}

/// Displacement of the tip of a strip over its length, along the axis and across, under F L²/(E I).
fn elastica(load: f64, steps: u64) -> Result<[f64; 2], Error> {
    let (length, height) = (1.0, 0.01);
    let strip = Plate {
        thickness: height,
        width: 0.02,
        solid: [0.0, 0.5 * length + height],
        shell: [0.5 * length - height, length],
        cells: [51, 1, 1],
        quadratic: true,
        elements: [26, 1],
        material: Elastic {
            poisson: 0.0,
            ..STEEL
        },
        ..patch_plate()
    };
    let mut model = model(
        &strip,
        (newmark(0.25, 0.5), 1.0 / steps as f64),
        Joined::Turning,
    )?;
    let grid = strip.grid();
    let clamped = strip.of_shell(&model.mesh, &grid.column(grid.n));
    model.supports = vec![held(clamped, [true; 3], [true; 3])];
    let bending = strip.material.young * strip.width * height.powi(3) / 12.0;
    let traction = load * bending / (length * length) / (height * strip.width);
    model.nonlinear.loads = vec![Load {
        name: "tip".into(),
        surface: surface(&model.mesh, "solid.left", &model.bodies[0])?,
        kind: LoadKind::Traction([0.0, 0.0, traction]),
        amplitude: Amplitude::constant(1.0),
    }];
    model.nonlinear.preload = Some(Preload { end: 1.0, steps });
    let corner = |x: &[f64; 3]| x[0] == 0.0 && x[2].abs() < 1e-9;
    let tip = strip.of_solid(&model.mesh, &corner)[0];
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    for _ in 0..steps {
        driver.step()?;
    }
    let system = driver.system();
    let number = system.number[tip as usize];
    let [u, _, w] = system.of_node(number, &driver.state().motion, Order::Displacement);
    Ok([u / length, w / length])
}

/// A soft plate of 1 m.
pub(crate) fn soft_plate() -> Plate {
    Plate {
        thickness: 0.06,
        width: 0.4,
        solid: [0.0, 0.6],
        shell: [0.4, 1.0],
        cells: [6, 3, 1],
        quadratic: true,
        elements: [6, 4],
        material: Elastic {
            density: 1000.0,
            young: 2e7,
            poisson: 0.3,
        },
        ..patch_plate()
    }
}

/// A soft plate that spins about two axes and tumbles.
fn tumbling(steps: usize) -> Result<Vec<Row>, Error> {
    let model = model(&soft_plate(), (CONSERVING, 4e-3), Joined::Turning)?;
    glued_turning::tumbling("tumbling plate", model, Vec3::x() * 0.5, (steps, 1e-10))
}

fn rows(size: Size) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    let plate = patch_plate();
    let others = [
        ("hex8, matching", plate),
        (
            "hex8, not matching",
            Plate {
                elements: [7, 3],
                ..plate
            },
        ),
        (
            "tet4 and triangles",
            Plate {
                kind: Cells::Tetrahedra,
                triangles: true,
                ..plate
            },
        ),
    ];
    for (name, plate) in &others {
        let [speed, energy] = turned_patch(plate, Joined::Turning)?;
        let label = format!("turned patch, {name}: largest speed / c ε");
        rows.push(Row::at_most(label, speed, 1e-5));
        let label = format!("turned patch, {name}: energy without load");
        rows.push(Row::at_most(label, energy, 1e-20));
    }
    let [speed, _] = turned_patch(&plate, Joined::SmallAngles)?;
    let label = "turned patch, rows of small angles: largest speed / c ε";
    rows.push(Row::at_least(label, speed, 1e-2).regression());
    rows.extend(glued_turning::elastica(size, |load| elastica(load, 10))?);
    let steps = match size {
        Size::Quick => 50,
        Size::Full => 2000,
    };
    rows.extend(tumbling(steps)?);
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "shell-solid-large",
    fact: "an overlap of a shell with finite rotations and a solid at finite strain turns, bends as the elastica and keeps energy and momenta",
    run: rows,
};
