//! The overlap of a beam with finite rotations and a solid at finite strain.
//!
//! Problems:
//! - Turned patch, in the plane and in space: the bar of `beam-solid-patch` is turned by 100°, in space about an oblique axis, stretched along its turned axis by 1e-6, and pulled there at
//!   both ends with the force of this strain. It is free, and stays where it is: the largest speed over the c ε of a wave of this strain, in the time in which one runs through the bar. Closed form: zero.
//!   Tolerance 1e-5: the field is that of small strains, whose terms left out are of the order of the strain; rounding of places is 1e-10 of the displacement. Turned without strain the bar has
//!   no energy: 1e-20 of that of a strain of one. With rows of small angles, as a control, the bar must move.
//!   The same in the plane under every other scheme that is not refused; explicit ones, which know places before forces, must be.
//! - Elastica: a cantilever, L/h = 100, clamped at the end of the beam, under a force F along the first normal at the end of the solid, overlap in the middle. Closed form: displacements of the tip for
//!   F L²/(E I) = 2 and 5 (Mattiasson 1981, Int. J. Num. Meth. Eng. 17, 145). Tolerance 1 % of the length: strains to 2.5 %, which neo-Hooke's material and the element feel, shear, and 20
//!   elements.
//! - A free bar in space that spins and tumbles, energy-momentum: energy, momentum and angular momentum are kept, and the overlap does no work. Tolerance 1e-8, of iterations that leave 1e-12 of
//!   the forces in each of 5000 steps; the bar bends, which is bounded from below.

use carom_algebra::tensor::Vec3;
use carom_arlequin::Weighting;
use carom_bodies::BeamTheory;
use carom_dynamics::{Amplitude, Driver, Load, LoadKind, Model, Order, Preload, Scheme};
use carom_materials::Elastic;

use crate::Error;
use crate::beam_solid::Spliced;
use crate::beams::held;
use crate::build::{newmark, surface};
use crate::check::{Check, Row, Size};
use crate::glued_turning::{self, CONSERVING, Joined, TurnedPatch};

/// A model of both bodies and what joins them.
pub(crate) fn model(
    bar: &Spliced,
    stepping: (Scheme, f64),
    joined: Joined,
) -> Result<Model, Error> {
    let mesh = bar.mesh()?;
    let (bodies, glued) = bar.glued_turning(&mesh)?;
    Ok(glued_turning::model(
        (mesh, bodies, glued),
        stepping,
        joined,
    ))
}

const STEEL: Elastic = Elastic {
    density: 7800.0,
    young: 2.1e11,
    poisson: 0.3,
};

/// The bar of the patch.
pub(crate) fn patch_bar(dim: usize) -> Spliced {
    const H: f64 = 0.1;
    Spliced {
        dim,
        section: [H, 0.06],
        solid: [0.0, 5.0 * H],
        beam: [3.0 * H, 8.0 * H],
        cells: [10, 2, 2],
        elements: 5,
        simplices: false,
        quadratic: true,
        complete: false,
        theory: BeamTheory::Timoshenko,
        material: Elastic {
            // plane strain is plane stress then
            poisson: if dim == 2 { 0.0 } else { STEEL.poisson },
            ..STEEL
        },
        weighting: Weighting::default(),
    }
}

/// The patch that a bar is.
pub(crate) fn patch_of(bar: &Spliced) -> TurnedPatch {
    let ([height, width], length) = (bar.section, bar.beam[1]);
    TurnedPatch {
        axis: match bar.dim {
            2 => Vec3::z(),
            _ => Vec3::new(1.0, 2.0, 3.0),
        },
        material: bar.material,
        size: [length, height, width],
    }
}

/// Largest speed of a turned and stretched bar over c ε, and the energy without the strain over that of a strain of one.
fn turned_patch(dim: usize, scheme: Scheme, joined: Joined) -> Result<[f64; 2], Error> {
    let bar = patch_bar(dim);
    let patch = patch_of(&bar);
    // explicit steps are below the critical one
    let step = if scheme.get().is_explicit() { 0.1 } else { 1.0 } * patch.step();
    let model = model(&bar, (scheme, step), joined)?;
    let last = model.mesh.nodes.len() as u32 - 1;
    patch.run(model, &[(last, 1.0)])
}

/// Largest speed over c ε of the turned patch in the plane under all schemes that take it, how many there are, and how many take explicit steps.
fn patch_of_schemes() -> Result<[f64; 3], Error> {
    let (mut fastest, mut taken, mut explicit) = (0.0_f64, 0, 0);
    for scheme in Scheme::registered() {
        match turned_patch(2, scheme, Joined::Turning) {
            Ok([speed, _]) => {
                fastest = fastest.max(speed);
                taken += 1;
                explicit += u32::from(scheme.get().is_explicit());
            }
            Err(Error::System(carom_system::Error::Nonlinear { .. })) => {}
            Err(error) => return Err(error),
        }
    }
    Ok([fastest, f64::from(taken), f64::from(explicit)])
}

/// Displacement of the tip of a cantilever over its length, along the axis and across, under F L²/(E I).
fn elastica(load: f64, steps: u64) -> Result<[f64; 2], Error> {
    let (length, height) = (1.0, 0.01);
    let material = Elastic {
        poisson: 0.0,
        ..STEEL
    };
    let bar = Spliced {
        section: [height, 0.01],
        solid: [0.0, 0.5 * length + height],
        beam: [0.5 * length - height, length],
        cells: [51, 1, 0],
        elements: 26,
        material,
        ..patch_bar(2)
    };
    let mut model = model(
        &bar,
        (newmark(0.25, 0.5), 1.0 / steps as f64),
        Joined::Turning,
    )?;
    let last = model.mesh.nodes.len() as u32 - 1;
    model.supports = vec![held(vec![last], [true; 3], [true; 3])];
    let bending = material.young * bar.section[1] * height.powi(3) / 12.0;
    let traction = load * bending / (length * length) / (height * bar.section[1]);
    model.nonlinear.loads = vec![Load {
        name: "tip".into(),
        surface: surface(&model.mesh, "solid.left", &model.bodies[0])?,
        kind: LoadKind::Traction([0.0, traction, 0.0]),
        amplitude: Amplitude::constant(1.0),
    }];
    model.nonlinear.preload = Some(Preload { end: 1.0, steps });
    let middle = (0..model.mesh.nodes.len())
        .find(|&node| model.mesh.nodes[node].iter().all(|x| x.abs() < 1e-9))
        .unwrap_or(0);
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    for _ in 0..steps {
        driver.step()?;
    }
    let system = driver.system();
    let number = system.number[middle];
    let [u, v, _] = system.of_node(number, &driver.state().motion, Order::Displacement);
    Ok([u / length, v / length])
}

/// A soft bar of 1 m.
pub(crate) fn soft_bar() -> Spliced {
    Spliced {
        section: [0.08, 0.06],
        solid: [0.0, 0.6],
        beam: [0.4, 1.0],
        cells: [6, 1, 1],
        elements: 6,
        material: Elastic {
            density: 1000.0,
            young: 2e7,
            poisson: 0.3,
        },
        ..patch_bar(3)
    }
}

/// A soft bar that spins about two axes and tumbles.
fn spinning(steps: usize) -> Result<Vec<Row>, Error> {
    let model = model(&soft_bar(), (CONSERVING, 4e-3), Joined::Turning)?;
    glued_turning::tumbling("spinning bar", model, Vec3::x() * 0.5, (steps, 1e-8))
}

fn rows(size: Size) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for dim in [2, 3] {
        let [speed, energy] = turned_patch(dim, CONSERVING, Joined::Turning)?;
        let label = format!("turned patch in {dim}D: largest speed / c ε");
        rows.push(Row::at_most(label, speed, 1e-5));
        let label = format!("turned patch in {dim}D: energy without load");
        rows.push(Row::at_most(label, energy, 1e-20));
    }
    let [speed, _] = turned_patch(2, CONSERVING, Joined::SmallAngles)?;
    let label = "turned patch in 2D, rows of small angles: largest speed / c ε";
    rows.push(Row::at_least(label, speed, 1e-2).regression());
    let [speed, taken, explicit] = patch_of_schemes()?;
    let label = format!("turned patch in 2D, {taken} schemes: largest speed / c ε");
    rows.push(Row::at_most(label, speed, 1e-5));
    let label = "turned patch in 2D: explicit schemes that take it";
    rows.push(Row::at_most(label, explicit, 0.0));
    rows.extend(glued_turning::elastica(size, |load| elastica(load, 10))?);
    let steps = match size {
        Size::Quick => 100,
        Size::Full => 5000,
    };
    rows.extend(spinning(steps)?);
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "beam-solid-large",
    fact: "an overlap of a beam with finite rotations and a solid at finite strain turns, bends as the elastica and keeps energy and momenta",
    run: rows,
};
