//! Beams: sections from shapes and properties, and what beams refuse.

use carom_bodies::{
    BeamSection, BeamTheory, BodySpec, Extremes, Kinematics, LAYERS, Rotations, SectionProperties,
    SectionShape,
};
use carom_materials::Law;
use carom_mesh::Mesh;

use super::context::Context;
use super::problems::{Problems, Refusal, dimensions};
use super::shells::is_shell;
use super::{fluids, lookup};
use crate::error::Problem;
use crate::schema::{self, BeamShape, Body, Mass, NormalVector, Section};

/// The kinematics of beams with this section; `path`: of the body.
pub(super) fn beam(
    mesh: &Mesh,
    path: &str,
    given: &schema::BeamSection,
    material: Law,
    problems: &mut Problems,
) -> Option<Kinematics> {
    let path = format!("{path}.section.beam");
    let theory = match given.theory {
        schema::BeamTheory::Timoshenko => BeamTheory::Timoshenko,
        schema::BeamTheory::EulerBernoulli => BeamTheory::EulerBernoulli,
    };
    let shape = shape(&path, &given.shape, problems)?;
    let layers = layers(&path, given, material, problems)?;
    let properties = match (shape, &given.shape) {
        (Some(shape), _) => shape.properties(material.initial().poisson),
        (None, BeamShape::Properties(given)) => properties(mesh, &path, given, theory, problems)?,
        (None, _) => return None,
    };
    let orientation = match &given.orientation {
        None => None,
        Some(given) => Some(orientation(mesh, &path, given, problems)?),
    };
    let offset = given.offset.map_or([0.0; 2], |offset| offset.map(|e| e.0));
    if mesh.dim == 2 && offset[1] != 0.0 {
        let message = "an offset out of the plane";
        let problem = Problem::new(format!("{path}.offset[1]"), message);
        problems.push(problem.found(format!("{} m", offset[1])).accepted(["0"]));
    }
    let diameter = match &given.shape {
        BeamShape::Circle(circle) => Some(circle.diameter.0),
        BeamShape::Tube(tube) => Some(tube.diameter.0),
        _ => None,
    };
    let extremes = match &given.shape {
        BeamShape::Properties(given) => extremes(mesh, &path, given, problems)?,
        _ => None,
    };
    let [added_mass, displaced_mass] =
        fluids::added_mass(&path, given.added_mass, diameter, problems)?;
    let round = shape.and_then(|shape| shape.radius(mesh.dim));
    Some(Kinematics::Beam(BeamSection {
        shape,
        extremes,
        layers,
        orientation,
        offset,
        radius: given.radius.map(|radius| radius.0).or(round),
        foundation: fluids::foundation(mesh, &path, given.foundation, problems)?,
        added_mass,
        displaced_mass,
        rotations: match given.rotations {
            schema::Rotations::Small => Rotations::Small,
            schema::Rotations::Finite => Rotations::Finite,
        },
        ..BeamSection::new(theory, properties)
    }))
}

/// The shape of a section, `Some(None)` of properties alone; `path`: of the section.
fn shape(path: &str, given: &BeamShape, problems: &mut Problems) -> Option<Option<SectionShape>> {
    Some(Some(match given {
        BeamShape::Properties(_) => return Some(None),
        BeamShape::Circle(circle) => SectionShape::Circle {
            diameter: circle.diameter.0,
        },
        BeamShape::Tube(tube) => {
            let (diameter, thickness) = (tube.diameter.0, tube.thickness.0);
            let path = format!("{path}.shape.tube.thickness");
            let most = (0.5 * diameter, "half of `diameter`");
            below(&path, thickness, most, problems)?;
            SectionShape::Tube {
                diameter,
                thickness,
            }
        }
        BeamShape::Rectangle(rectangle) => SectionShape::Rectangle {
            height: rectangle.height.0,
            width: rectangle.width.0,
        },
        BeamShape::I(shape) => {
            let [height, width, web, flange] =
                [shape.height, shape.width, shape.web, shape.flange].map(|size| size.0);
            let path = format!("{path}.shape.i");
            let most = (0.5 * height, "half of `height`");
            below(&format!("{path}.flange"), flange, most, problems)?;
            // a web as wide as the flanges is a rectangle
            let most = (width * (1.0 + f64::EPSILON), "`width`");
            below(&format!("{path}.web"), web, most, problems)?;
            SectionShape::I {
                height,
                width,
                web,
                flange,
            }
        }
    }))
}

/// A direction in the plane of the first axis of a section.
fn orientation(
    mesh: &Mesh,
    path: &str,
    given: &NormalVector,
    problems: &mut Problems,
) -> Option<[f64; 3]> {
    let path = format!("{path}.orientation");
    if mesh.dim == 3 {
        return lookup::normal(mesh, &path, given, problems);
    }
    let problem = Problem::new(path, "in the plane the axes of a section are known");
    let problem = problem.found(format!("{:?}", given.components()));
    problems.refuse(problem.accepted(["no `orientation`"]))
}

/// Layers of fibres of a section that flows. Refuses sections without a shape there, and layers where nothing flows.
fn layers(
    path: &str,
    given: &schema::BeamSection,
    material: Law,
    problems: &mut Problems,
) -> Option<u32> {
    let flows = material.uniaxial().is_some();
    if let (true, BeamShape::Properties(_)) = (flows, &given.shape) {
        let message = "a section that flows is divided into fibres, for which its shape is needed";
        let problem = Problem::new(format!("{path}.shape.properties"), message);
        let problem = problem.found(format!("properties, with the material {}", material.key()));
        return problems.refuse(problem.accepted(["circle", "tube", "rectangle", "i"]));
    }
    let Some(layers) = given.layers else {
        return Some(LAYERS);
    };
    let (message, found, accepted) = match (flows, layers % 2) {
        (true, 0) => return Some(layers),
        (true, _) => (
            "no layer of fibres may lie across the middle of the section",
            layers.to_string(),
            "an even number",
        ),
        (false, _) => (
            "the section of an elastic beam has no fibres",
            material.key().to_owned(),
            "a material that flows: j2, j2-table, johnson-cook",
        ),
    };
    let problem = Problem::new(format!("{path}.layers"), message).found(found);
    problems.refuse(problem.accepted([accepted]))
}

/// Refuses a size that is not below another.
fn below(path: &str, size: f64, (most, name): (f64, &str), problems: &mut Problems) -> Option<()> {
    if size < most {
        return Some(());
    }
    let problem = Problem::new(path, "the section has no such shape");
    let problem = problem.found(format!("{size} m"));
    problems.refuse(problem.accepted([format!("less than {most} m, {name}")]))
}

/// Properties as they are given; those that the plane does not need are that of the others.
fn properties(
    mesh: &Mesh,
    path: &str,
    given: &schema::SectionProperties,
    theory: BeamTheory,
    problems: &mut Problems,
) -> Option<SectionProperties> {
    let (space, shears) = (mesh.dim == 3, theory == BeamTheory::Timoshenko);
    let needed = [
        ("inertia-z", given.inertia_z.is_none()),
        ("inertia-y", space && given.inertia_y.is_none()),
        ("torsion", space && given.torsion.is_none()),
        ("shear-area-y", shears && given.shear_area_y.is_none()),
        (
            "shear-area-z",
            shears && space && given.shear_area_z.is_none(),
        ),
    ];
    let missing: Vec<String> = needed
        .iter()
        .filter(|(_, missing)| *missing)
        .map(|(key, _)| format!("`{key}`"))
        .collect();
    if !missing.is_empty() {
        let theory = match theory {
            BeamTheory::Timoshenko => "timoshenko",
            BeamTheory::EulerBernoulli => "euler-bernoulli",
        };
        let message = format!(
            "beams of the theory {theory} in {} need {}",
            dimensions(mesh.dim),
            missing.join(", ")
        );
        return problems.refuse(Problem::new(format!("{path}.shape.properties"), message));
    }
    let z = given.inertia_z?.0;
    let along_y = given.shear_area_y.unwrap_or(given.area).0;
    Some(SectionProperties {
        area: given.area.0,
        second_moments: [given.inertia_y.map_or(z, |y| y.0), z],
        torsion: given.torsion.map_or(z, |torsion| torsion.0),
        shear_areas: [along_y, given.shear_area_z.map_or(along_y, |area| area.0)],
    })
}

/// Where a section given by its properties has its largest stresses; `Some(None)`: not known.
fn extremes(
    mesh: &Mesh,
    path: &str,
    given: &schema::SectionProperties,
    problems: &mut Problems,
) -> Option<Option<Extremes>> {
    let own = [given.extreme_y, given.extreme_z].map(|extreme| extreme.map(|c| c.0));
    let torsion = given.torsion_distance.map(|r| r.0);
    let fibres = match (own, mesh.dim) {
        ([Some(y), Some(z)], _) => [y, z],
        ([Some(y), None], 2) => [y, 0.0],
        ([None, None], _) if torsion.is_none() => return Some(None),
        ([y, _], _) => {
            let missing = if y.is_none() {
                "extreme-y"
            } else {
                "extreme-z"
            };
            let message =
                "stresses of bending need the distances of the extreme fibres along both axes";
            let problem = Problem::new(format!("{path}.shape.properties.{missing}"), message);
            return problems.refuse(problem.found("nothing"));
        }
    };
    let torsion = torsion.unwrap_or(fibres[0].max(fibres[1]));
    Some(Some(Extremes { fibres, torsion }))
}

/// Refuses keys that beams do not take.
pub(super) fn suits_beams(path: &str, body: &Body, problems: &mut Problems) {
    let Some(Section::Beam(section)) = &body.section else {
        return;
    };
    let damping = body.damping.as_ref();
    let damped = damping.is_some_and(|damping| damping.stiffness.is_some());
    let table = [
        Refusal {
            is: section.foundation.is_some() && damped,
            key: "damping.stiffness",
            message: "damping proportional to the stiffness would also be one of the foundation",
            accepted: &["damping.mass", "no `foundation`"],
        },
        Refusal {
            is: body.rigid.is_some(),
            key: "rigid",
            message: "a rigid body of beams has no cells from which its inertia follows",
            accepted: &["a rigid body of solid cells", "no `rigid`"],
        },
    ];
    problems.refuse_each(path, &table);
}

/// Initial angular velocity of beams and of solids at finite strain, about their centre of mass, rad/s.
pub(super) fn initial_spin(
    mesh: &Mesh,
    (path, body): (&str, &Body),
    spec: &BodySpec,
    problems: &mut Problems,
) -> [f64; 3] {
    let initial = body.initial.as_ref();
    let given = initial.and_then(|initial| initial.spin.as_ref());
    let (None, Some(given)) = (&body.rigid, given) else {
        return [0.0; 3];
    };
    let spin = match (given.given(), mesh.dim) {
        (1, 2) => [0.0, 0.0, given.si()[0]],
        _ => given.si(),
    };
    let flat = mesh.dim == 3 || spin[0] == 0.0 && spin[1] == 0.0;
    let (turns, message, accepted) = match spec.kinematics {
        Kinematics::Beam(section) => (
            section.rotations == Rotations::Finite,
            "beams with small rotations do not spin",
            "rotations = \"finite\"",
        ),
        Kinematics::Shell(section) => (
            section.rotations == Rotations::Finite,
            "shells with small rotations do not spin",
            "rotations = \"finite\"",
        ),
        Kinematics::Axisymmetric | Kinematics::Bar { .. } => {
            (false, "here a body does not turn", "no spin")
        }
        _ => (
            spec.material.finite().is_some(),
            "a body at small strain does not turn",
            "a material at finite strain, or rigid = {}",
        ),
    };
    let (message, accepted) = match (turns, flat) {
        (true, true) => return spin,
        (false, _) => (message, accepted),
        (true, false) => (
            "in the plane a body turns about z only",
            "one component, about z",
        ),
    };
    let problem = Problem::new(format!("{path}.initial.spin"), message);
    problems.push(problem.found(format!("{spin:?}")).accepted([accepted]));
    [0.0; 3]
}

/// The mass of a body: that of beams and shells is consistent where nothing else is said and its scheme takes it.
pub(super) fn mass_of(context: &Context, number: usize, body: &Body) -> Mass {
    let scheme = || context.scheme_of(number);
    match body.mass {
        Some(mass) => mass,
        None if has_rotations(body) && !scheme().get().needs_lumped_mass() => Mass::Consistent,
        None => Mass::Lumped,
    }
}

/// Nodes of all beams and shells, sorted.
pub(super) fn nodes_with_rotations(context: &Context, mesh: &Mesh) -> Vec<u32> {
    let bodies = context
        .case
        .body
        .iter()
        .filter(|(_, body)| has_rotations(body));
    let groups = bodies.filter_map(|(_, body)| mesh.groups.get(&body.region));
    let mut nodes: Vec<u32> = groups.flat_map(|group| mesh.group_nodes(group)).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Whether the nodes of a body have rotations.
fn has_rotations(body: &Body) -> bool {
    is_beam(body) || is_shell(body)
}

/// Whether a body is one of beams.
pub(super) fn is_beam(body: &Body) -> bool {
    matches!(body.section, Some(Section::Beam(_)))
}
