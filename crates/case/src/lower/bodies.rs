//! Bodies: regions, sections, materials, sound elements, initial state.

use std::collections::BTreeMap;

use carom_bodies::{BodySpec, Formulation, Kinematics, MassKind};
use carom_dynamics::ModelBody;
use carom_materials::Law;
use carom_mesh::{ElementId, Group, Mesh};

use super::context::Context;
use super::problems::{Problems, dimensions, place, plural};
use super::shells::{GivenShell, Sectioned};
use super::{beams, constraints, lookup, rigid, shells};
use crate::error::Problem;
use crate::schema::{self, Body, FormulationName, FormulationWith, Mass, Section, Vector};

/// Defects of elements listed in one message; the others are counted.
const LISTED: usize = 3;

/// The bodies of a case, in the order of their names.
pub(super) fn lower(
    context: &Context,
    mesh: &Mesh,
    materials: &BTreeMap<String, Law>,
    problems: &mut Problems,
) -> Vec<ModelBody> {
    let mut bodies = Vec::new();
    for (number, (name, given)) in context.case.body.iter().enumerate() {
        let of = &GivenBody {
            number,
            name,
            path: format!("body.{name}"),
            given,
        };
        let body = body(context, mesh, of, (materials, &bodies), problems);
        bodies.extend(body);
    }
    one_plane(&bodies, problems);
    shells::sound_shells(context, mesh, &bodies, problems);
    bodies
}

/// A body of the case.
struct GivenBody<'a> {
    number: usize,
    name: &'a str,
    path: String,
    given: &'a Body,
}

/// One body. `before`: those of the names before it.
fn body(
    context: &Context,
    mesh: &Mesh,
    of: &GivenBody,
    (materials, before): (&BTreeMap<String, Law>, &[ModelBody]),
    problems: &mut Problems,
) -> Option<ModelBody> {
    let GivenBody { path, given, .. } = of;
    if !materials.contains_key(&given.material) {
        let problem = Problem::new(format!("{path}.material"), "no material of this name");
        problems.push(problem.unknown(&given.material, materials.keys().map(String::as_str)));
    }
    let group = problems.group(mesh, &format!("{path}.region"), &given.region)?;
    let section = section(context, (mesh, group), of, materials, problems);
    beams::suits_beams(path, given, problems);
    shells::suits_shells(path, given, problems);
    let Sectioned {
        kinematics,
        material,
        plies,
        nodal_thickness,
    } = section?;
    takes_cells(mesh, (path, given), kinematics, group.dim, problems)?;
    let cells = group.elements.clone();
    sound(mesh, path, &cells, problems);
    apart(path, &cells, before, problems);
    let initial = given.initial.as_ref();
    let velocity = initial.and_then(|initial| initial.velocity.as_ref());
    let velocity = start(
        mesh,
        &format!("{path}.initial.velocity"),
        velocity,
        problems,
    );
    let displacement = initial.and_then(|initial| initial.displacement.as_ref());
    let displacement = start(
        mesh,
        &format!("{path}.initial.displacement"),
        displacement,
        problems,
    );
    let material = material?;
    let spec = BodySpec {
        name: of.name.to_string(),
        cells,
        kinematics,
        material,
        formulation: formulation(given.formulation, (kinematics, &material)),
        weights: None,
        exact_products: false,
        viscosity: given.bulk_viscosity.map(Into::into),
        scaling: given.mass_scaling.map(Into::into),
        deletion: given.deletion.map(|deletion| deletion.plastic_strain),
        releases: Vec::new(),
        plies,
        nodal_thickness,
        tightened: Vec::new(),
        layers: Vec::new(),
    };
    let spec = constraints::hinged(mesh, (path, given), spec, problems);
    let spin = beams::initial_spin(mesh, (path, given), &spec, problems);
    let rigid = match kinematics {
        Kinematics::Beam(_) | Kinematics::Shell(_) => None,
        _ => rigid::lower(mesh, path, given, &spec, problems),
    };
    Some(ModelBody {
        spec,
        mass: match beams::mass_of(context, of.number, given) {
            Mass::Lumped => MassKind::Lumped,
            Mass::Consistent => MassKind::Consistent,
        },
        velocity,
        displacement,
        spin,
        rigid,
        reduced: None,
        modal: None,
    })
}

/// An initial value; zero where none is given.
fn start<Q: Copy + Into<f64>>(
    mesh: &Mesh,
    path: &str,
    given: Option<&Vector<Q>>,
    problems: &mut Problems,
) -> [f64; 3] {
    given.map_or([0.0; 3], |given| problems.vector(mesh, path, given))
}

/// What the section of a body makes of it; none of beams and shells without a material.
fn section(
    context: &Context,
    (mesh, group): (&Mesh, &Group),
    of: &GivenBody,
    materials: &BTreeMap<String, Law>,
    problems: &mut Problems,
) -> Option<Sectioned> {
    let GivenBody { path, given, .. } = of;
    let material = materials.get(&given.material).copied();
    let kinematics = match &given.section {
        Some(Section::Beam(section)) => beams::beam(mesh, path, section, material?, problems)?,
        Some(Section::Shell(section)) => {
            let of = GivenShell {
                path,
                section,
                material: material?,
                materials,
            };
            return shells::shell(context, (mesh, &group.elements), &of, problems);
        }
        section => kinematics(section.as_ref()),
    };
    Some(Sectioned {
        kinematics,
        material,
        plies: Vec::new(),
        nodal_thickness: None,
    })
}

/// Refuses axisymmetric bodies beside plane ones: the same coordinate would be a radius and none.
fn one_plane(bodies: &[ModelBody], problems: &mut Problems) {
    let turns = |body: &&ModelBody| body.spec.kinematics == Kinematics::Axisymmetric;
    let (round, flat) = (
        bodies.iter().find(turns),
        bodies.iter().find(|body| !turns(body)),
    );
    if let (Some(round), Some(flat)) = (round, flat) {
        let message = format!(
            "body `{}` is axisymmetric, this one is not",
            round.spec.name
        );
        let problem = Problem::new(format!("body.{}.section", flat.spec.name), message);
        let problem = problem.found(flat.spec.kinematics.name());
        problems.push(problem.accepted(["section.axisymmetric"]));
    }
}

/// Refuses a kinematics that does not go with cells of dimension `dim`.
fn takes_cells(
    mesh: &Mesh,
    (path, body): (&str, &Body),
    kinematics: Kinematics,
    dim: usize,
    problems: &mut Problems,
) -> Option<()> {
    let kind = |dim: usize| ["points", "bars", "plane cells", "solid cells"][dim.min(3)];
    let takes: &[&str] = match dim {
        1 if mesh.dim == 1 => &["section.bar"],
        1 => &["section.bar", "section.beam"],
        2 if mesh.dim == 3 => &["section.shell"],
        2 if shells::is_shell(body) => &[
            "section.shell with mesh.dimension = 3, since all nodes of the file lie in a plane",
            "section.plane-strain",
            "section.plane-stress",
        ],
        2 => &[
            "section.plane-strain",
            "section.plane-stress",
            "section.axisymmetric",
        ],
        _ => &["no section"],
    };
    let problem = if dim == 0 {
        let message = format!("a body cannot be made of {} here", kind(dim));
        let problem = Problem::new(format!("{path}.region"), message).found(&body.region);
        let dimensions = dimensions(mesh.dim);
        problem.accepted([format!("a group of cells of a mesh of {dimensions}")])
    } else if kinematics.dim() == dim
        && !(mesh.dim == 1 && beams::is_beam(body))
        && (dim != 2 || shells::is_shell(body) == (mesh.dim == 3))
    {
        return Some(());
    } else if body.section.is_none() {
        let (region, kind) = (&body.region, kind(dim));
        let message = format!("the group `{region}` holds {kind}, which need a section");
        let problem = Problem::new(path, message).found("no section");
        problem.accepted(takes.to_vec())
    } else {
        let (region, kind) = (&body.region, kind(dim));
        let message = format!("this section does not go with the {kind} of the group `{region}`");
        let problem = Problem::new(format!("{path}.section"), message);
        problem.found(kinematics.name()).accepted(takes.to_vec())
    };
    problems.refuse(problem)
}

pub(super) fn sound(mesh: &Mesh, path: &str, cells: &[ElementId], problems: &mut Problems) {
    let defects = mesh.check(cells);
    if defects.is_empty() {
        return;
    }
    let message = match defects.len() {
        1 => "one element of the region is unfit".to_string(),
        count => format!("{count} elements of the region are unfit"),
    };
    let mut problem = Problem::new(format!("{path}.region"), message);
    for defect in defects.iter().take(LISTED) {
        let element = defect.element();
        let at = place(lookup::middle(mesh, mesh.element_nodes(element)));
        let (name, number) = (mesh.kind(element).table().name, element.index);
        problem = problem.note(format!("{name} number {number} about {at}: {defect}"));
    }
    if defects.len() > LISTED {
        problem = problem.note(format!("and {} more", defects.len() - LISTED));
    }
    problems.push(problem);
}

/// Refuses cells that a body before has.
fn apart(path: &str, cells: &[ElementId], bodies: &[ModelBody], problems: &mut Problems) {
    for other in bodies {
        let shared = cells
            .iter()
            .filter(|cell| other.spec.cells.binary_search(cell).is_ok())
            .count();
        if shared > 0 {
            let message = format!(
                "{} of this region belong to the body `{}` too",
                plural(shared, "cell"),
                other.spec.name
            );
            problems.push(
                Problem::new(format!("{path}.region"), message).accepted(["a region of its own"]),
            );
        }
    }
}

/// The kinematics of a section that is neither one of beams nor one of shells.
fn kinematics(section: Option<&Section>) -> Kinematics {
    match section {
        None | Some(Section::Beam(_) | Section::Shell(_)) => Kinematics::Solid,
        Some(Section::Bar(bar)) => Kinematics::Bar { area: bar.area.0 },
        Some(Section::PlaneStrain(plane)) => Kinematics::PlaneStrain {
            thickness: plane.thickness.0,
        },
        Some(Section::PlaneStress(plane)) => Kinematics::PlaneStress {
            thickness: plane.thickness.0,
        },
        Some(Section::Axisymmetric(_)) => Kinematics::Axisymmetric,
    }
}

/// Factor of the stiffness against hourglass modes where nothing else is said: of elastic shells that of full integration, with which they
/// meet the published displacements on the usual meshes (`one-point-shells`), where a twentieth bends in its plane with a twentieth of the
/// stiffness that one element over the height has; of metals a small one, as it does not flow with the metal.
fn hourglass(kinematics: Kinematics, material: &Law) -> f64 {
    let is_shell = matches!(kinematics, Kinematics::Shell(_));
    match is_shell && matches!(material, Law::Elastic(_)) {
        true => 1.0,
        false => 0.05,
    }
}

fn formulation(
    given: schema::Formulation,
    (kinematics, material): (Kinematics, &Law),
) -> Formulation {
    match given {
        schema::Formulation::Named(FormulationName::Full) => Formulation::Full,
        schema::Formulation::Named(FormulationName::MeanDilatation) => Formulation::BBar,
        schema::Formulation::With(FormulationWith::Reduced(reduced)) => Formulation::Reduced {
            hourglass: reduced
                .hourglass
                .unwrap_or_else(|| hourglass(kinematics, material)),
        },
    }
}
