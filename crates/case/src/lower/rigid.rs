//! Rigid bodies: mass, centre and moments of inertia, and what goes with them.

use carom_algebra::rotation::Rotation;
use carom_bodies::{BodySpec, Inertia, Kinematics};
use carom_dynamics::ModelRigid;
use carom_mesh::Mesh;
use carom_pages::plot::quantity;
use carom_quantities::MomentOfInertia;

use super::oscillators;
use super::problems::{Problems, Refusal};
use crate::error::Problem;
use crate::schema::{Body, Mass, Rigid};

/// What a body is as a rigid one; `None` for one that deforms.
pub(super) fn lower(
    mesh: &Mesh,
    path: &str,
    body: &Body,
    spec: &BodySpec,
    problems: &mut Problems,
) -> Option<ModelRigid> {
    let spin = body
        .initial
        .as_ref()
        .and_then(|initial| initial.spin.as_ref());
    let Some(rigid) = &body.rigid else {
        return None;
    };
    suits_rigid(path, body, problems);
    let turns = mesh.dim > 1 && spec.kinematics != Kinematics::Axisymmetric;
    let spin = spin.map_or([0.0; 3], |vector| match (vector.given(), mesh.dim) {
        (1, 2) => [0.0, 0.0, vector.si()[0]],
        _ => vector.si(),
    });
    let along = |spin: &[f64; 3]| spin[0] == 0.0 && spin[1] == 0.0;
    if spin != [0.0; 3] && (!turns || mesh.dim == 2 && !along(&spin)) {
        let message = match turns {
            true => "in the plane a body turns about z only",
            false => "here a rigid body does not turn",
        };
        let problem = Problem::new(format!("{path}.initial.spin"), message);
        let accepted = if turns {
            "one component, about z"
        } else {
            "no spin"
        };
        problems.push(problem.found(format!("{spin:?}")).accepted([accepted]));
    }
    // what is unfit has been told
    let of_cells = Inertia::of_cells(mesh, spec).ok()?;
    let inertia = inertia(mesh, path, rigid, of_cells, problems)?;
    if rigid.inertia.is_some() {
        warn_of_size(mesh, path, spec, &inertia, problems);
    }
    Some(ModelRigid { inertia, spin })
}

/// Warns of a moment of inertia that is larger than that of all of the mass at the node that is furthest from the centre.
fn warn_of_size(
    mesh: &Mesh,
    path: &str,
    spec: &BodySpec,
    inertia: &Inertia,
    problems: &mut Problems,
) {
    let nodes = spec.cells.iter().flat_map(|cell| mesh.element_nodes(*cell));
    let squares = nodes.map(|node| {
        let x = mesh.nodes[*node as usize];
        (0..3)
            .map(|i| (x[i] - inertia.centre[i]).powi(2))
            .sum::<f64>()
    });
    let most = inertia.mass * squares.fold(0.0, f64::max);
    let axes = if mesh.dim == 3 { 0..3 } else { 2..3 };
    let given = axes.map(|axis| inertia.moments[axis]).fold(0.0, f64::max);
    // what people round
    if given > most * (1.0 + 1e-3) {
        let [given, most] = [given, most].map(|moment| quantity(moment, "kg m²"));
        problems.warn(format!(
            "{path}.rigid.inertia: {given} is more than its mass has anywhere in the body, {most} at the node that is furthest from the centre: are units and axes the ones that are meant?"
        ));
    }
}

/// Mass, centre and moments as given, and those of the cells where they are not.
fn inertia(
    mesh: &Mesh,
    path: &str,
    rigid: &Rigid,
    of_cells: Inertia,
    problems: &mut Problems,
) -> Option<Inertia> {
    let mut inertia = of_cells;
    if let Some(mass) = rigid.mass {
        inertia.moments = inertia.moments.map(|moment| moment * mass.0 / inertia.mass);
        inertia.mass = mass.0;
    }
    if let Some(centre) = &rigid.centre {
        inertia.centre = problems.vector(mesh, &format!("{path}.rigid.centre"), centre);
    }
    if let Some(given) = &rigid.inertia {
        let path = format!("{path}.rigid.inertia");
        inertia.moments = moments(mesh.dim, &path, given, problems)?;
        inertia.axes = Rotation::IDENTITY;
    }
    Some(inertia)
}

/// Moments of inertia about the axes of coordinates, kg m².
pub(super) fn moments(
    dim: usize,
    path: &str,
    moments: &[MomentOfInertia],
    problems: &mut Problems,
) -> Option<[f64; 3]> {
    let needed = if dim == 3 { 3 } else { 1 };
    if moments.len() != needed {
        let message = "a wrong number of moments of inertia";
        let problem = Problem::new(path, message);
        let accepted = match needed {
            3 => "three, about the axes of coordinates",
            _ => "one, about z",
        };
        let problem = problem.found(moments.len().to_string());
        return problems.refuse(problem.accepted([accepted]));
    }
    let moments = match moments[..] {
        [x, y, z] => [x.0, y.0, z.0],
        _ => [moments[0].0; 3],
    };
    oscillators::warn_of_moments(path, moments, problems);
    Some(moments)
}

/// Refuses keys of bodies that deform.
fn suits_rigid(path: &str, body: &Body, problems: &mut Problems) {
    let table = [
        Refusal {
            is: body.damping.is_some(),
            key: "damping",
            message: "a rigid body has no damping",
            accepted: &["no `damping`"],
        },
        Refusal {
            is: body.mass == Some(Mass::Consistent),
            key: "mass",
            message: "a rigid body has one mass, and no mass matrix of its cells",
            accepted: &["no `mass`"],
        },
    ];
    problems.refuse_each(path, &table);
}
