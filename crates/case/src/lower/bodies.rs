//! Bodies: regions, sections, materials, sound elements, initial state.

use std::collections::BTreeMap;

use carom_bodies::{BodySpec, Formulation, Kinematics, MassKind};
use carom_dynamics::ModelBody;
use carom_materials::Law;
use carom_mesh::{ElementId, Mesh};

use super::beams;
use super::constraints;
use super::context::Context;
use super::problems::{Problems, dimensions, plural};
use super::rigid;
use super::shells;
use crate::error::Problem;
use crate::schema::{self, Body, FormulationName, FormulationWith, Mass, Section};

/// Defects of elements listed in one message; the others are counted.
const LISTED: usize = 3;

pub(super) fn lower(
    context: &Context,
    mesh: &Mesh,
    materials: &BTreeMap<String, Law>,
    problems: &mut Problems,
) -> Vec<ModelBody> {
    let mut bodies: Vec<ModelBody> = Vec::new();
    for (number, (name, body)) in context.case.body.iter().enumerate() {
        let path = format!("body.{name}");
        let material = materials.get(&body.material).copied();
        if material.is_none() {
            let problem = Problem::new(format!("{path}.material"), "no material of this name");
            problems.push(problem.unknown(&body.material, materials.keys().map(String::as_str)));
        }
        let Some(group) = problems.group(mesh, &format!("{path}.region"), &body.region) else {
            continue;
        };
        let (mut material, mut plies, mut nodal_thickness) = (material, Vec::new(), None);
        let kinematics = match (&body.section, material) {
            (Some(Section::Beam(section)), Some(material)) => {
                beams::beam(mesh, &path, section, material, problems)
            }
            (Some(Section::Shell(section)), Some(own)) => {
                let cells = &group.elements;
                let made = shells::shell(
                    context,
                    (mesh, cells),
                    &path,
                    (section, own),
                    materials,
                    problems,
                );
                made.map(|made| {
                    (plies, material) = (made.plies, Some(made.material));
                    nodal_thickness = made.nodal_thickness;
                    made.kinematics
                })
            }
            (Some(Section::Beam(_) | Section::Shell(_)), None) => None,
            (section, _) => Some(kinematics(section.as_ref())),
        };
        beams::suits_beams(&path, body, problems);
        shells::suits_shells(&path, body, problems);
        let Some(kinematics) = kinematics else {
            continue;
        };
        if !takes_cells(mesh, (&path, body), kinematics, group.dim, problems) {
            continue;
        }
        let cells = group.elements.clone();
        sound(mesh, &path, &cells, problems);
        apart(&path, &cells, &bodies, problems);
        let (mut velocity, mut displacement) = ([0.0; 3], [0.0; 3]);
        if let Some(initial) = &body.initial {
            if let Some(vector) = &initial.velocity {
                velocity = problems.vector(mesh, &format!("{path}.initial.velocity"), vector);
            }
            if let Some(vector) = &initial.displacement {
                displacement =
                    problems.vector(mesh, &format!("{path}.initial.displacement"), vector);
            }
        }
        let Some(material) = material else { continue };
        let spec = BodySpec {
            name: name.to_string(),
            cells,
            kinematics,
            material,
            formulation: formulation(body.formulation, (kinematics, &material)),
            weights: None,
            exact_products: false,
            viscosity: body.bulk_viscosity.map(Into::into),
            scaling: body.mass_scaling.map(Into::into),
            deletion: body.deletion.map(|deletion| deletion.plastic_strain),
            releases: Vec::new(),
            plies,
            nodal_thickness,
            tightened: Vec::new(),
            layers: Vec::new(),
        };
        let spec = constraints::hinged(mesh, (&path, body), spec, problems);
        let spin = beams::initial_spin(mesh, (&path, body), &spec, problems);
        let rigid = match kinematics {
            Kinematics::Beam(_) | Kinematics::Shell(_) => None,
            _ => rigid::rigid(mesh, &path, body, &spec, problems),
        };
        bodies.push(ModelBody {
            spec,
            mass: match beams::mass_of(context, number, body) {
                Mass::Lumped => MassKind::Lumped,
                Mass::Consistent => MassKind::Consistent,
            },
            velocity,
            displacement,
            spin,
            rigid,
            reduced: None,
            modal: None,
        });
    }
    one_plane(&bodies, problems);
    shells::sound_shells(context, mesh, &bodies, problems);
    bodies
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
        problems.push(
            problem
                .found(flat.spec.kinematics.name())
                .accepted(["section.axisymmetric"]),
        );
    }
}

/// Whether a kinematics goes with cells of dimension `dim`.
fn takes_cells(
    mesh: &Mesh,
    (path, body): (&str, &Body),
    kinematics: Kinematics,
    dim: usize,
    problems: &mut Problems,
) -> bool {
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
        let problem = Problem::new(
            format!("{path}.region"),
            format!("a body cannot be made of {} here", kind(dim)),
        );
        Some(problem.found(&body.region).accepted([format!(
            "a group of cells of a mesh of {}",
            dimensions(mesh.dim)
        )]))
    } else if kinematics.dim() == dim
        && !(mesh.dim == 1 && beams::is_beam(body))
        && (dim != 2 || shells::is_shell(body) == (mesh.dim == 3))
    {
        None
    } else if body.section.is_none() {
        let message = format!(
            "the group `{}` holds {}, which need a section",
            body.region,
            kind(dim)
        );
        Some(
            Problem::new(path, message)
                .found("no section")
                .accepted(takes.to_vec()),
        )
    } else {
        let message = format!(
            "this section does not go with the {} of the group `{}`",
            kind(dim),
            body.region
        );
        let problem = Problem::new(format!("{path}.section"), message);
        Some(problem.found(kinematics.name()).accepted(takes.to_vec()))
    };
    let sound = problem.is_none();
    problem
        .into_iter()
        .for_each(|problem| problems.push(problem));
    sound
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
        let nodes = mesh.element_nodes(element);
        let middle = [0, 1, 2].map(|i| {
            nodes
                .iter()
                .map(|&node| mesh.nodes[node as usize][i])
                .sum::<f64>()
                / nodes.len() as f64
        });
        let name = mesh.kind(element).table().name;
        let at = format!("({:.6}, {:.6}, {:.6}) m", middle[0], middle[1], middle[2]);
        problem = problem.note(format!(
            "{name} number {} about {at}: {defect}",
            element.index
        ));
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
