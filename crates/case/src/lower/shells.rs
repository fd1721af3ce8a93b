//! Shells: sections, and what shells refuse.

use std::collections::BTreeMap;

use carom_bodies::{
    Kinematics, Ply, Rotations, SHELL_LAYERS, ShellDefect, ShellSection, shell_defects,
};
use carom_dynamics::ModelBody;
use carom_materials::Law;
use carom_mesh::{ElementId, Group, Mesh, Surface};

use super::context::Context;
use super::problems::{Problems, Refusal, place, with_cells};
use super::{lookup, thickness};
use crate::error::Problem;
use crate::offenders::Offenders;
use crate::schema::{self, Body, Section};

/// What a section makes of a body.
pub(super) struct Sectioned {
    pub(super) kinematics: Kinematics,
    /// Of plies one that flows if any does.
    pub(super) material: Option<Law>,
    pub(super) plies: Vec<Ply>,
    /// Thickness at each node of the mesh, m, if it changes.
    pub(super) nodal_thickness: Option<Vec<f64>>,
}

/// A section of shells, as a body gives it.
pub(super) struct GivenShell<'a> {
    /// Of the body.
    pub(super) path: &'a str,
    pub(super) section: &'a schema::ShellSection,
    /// Of the body.
    pub(super) material: Law,
    /// All of the case.
    pub(super) materials: &'a BTreeMap<String, Law>,
}

/// Shells on these cells.
pub(super) fn shell(
    context: &Context,
    (mesh, cells): (&Mesh, &[ElementId]),
    of: &GivenShell,
    problems: &mut Problems,
) -> Option<Sectioned> {
    let plies = plies(of, problems)?;
    let (path, given) = (of.path, of.section);
    let laws: Vec<Law> = match plies.is_empty() {
        true => vec![of.material],
        false => plies.iter().map(|ply| ply.material).collect(),
    };
    let flows = |law: &&Law| law.plane_stress().is_some();
    let material = *laws.iter().find(flows).or(laws.first())?;
    let rubber = laws
        .iter()
        .find(|law| law.finite().is_some() && !flows(law));
    if let Some(rubber) = rubber {
        let problem = Problem::new(
            format!("{path}.material"),
            "shells have small strains; with rotations = \"finite\" they turn by any angle",
        );
        let accepted = ["elastic", "j2", "j2-table", "johnson-cook"];
        return problems.refuse(problem.found(rubber.key()).accepted(accepted));
    }
    let layers = shell_layers(path, given, material, problems)?;
    let rotations = match given.rotations {
        schema::Rotations::Small => Rotations::Small,
        schema::Rotations::Finite => Rotations::Finite,
    };
    let (thickness, nodal_thickness) = match plies.is_empty() {
        true => thickness::thickness(context, (mesh, cells), path, given, problems)?,
        false => (plies.iter().map(|ply| ply.thickness).sum(), None),
    };
    let section = ShellSection {
        rotations,
        offset: given.offset.map_or(0.0, |offset| offset.0),
        layers,
        ..ShellSection::new(thickness)
    };
    Some(Sectioned {
        kinematics: Kinematics::Shell(section),
        plies,
        material: Some(material),
        nodal_thickness,
    })
}

/// Layers through the thickness.
fn shell_layers(
    path: &str,
    given: &schema::ShellSection,
    material: Law,
    problems: &mut Problems,
) -> Option<u32> {
    let flows = material.plane_stress().is_some();
    let Some(layers) = given.layers else {
        return Some(SHELL_LAYERS);
    };
    let (message, found, accepted) = match (&given.plies, flows) {
        (Some(_), _) => (
            "each ply is one layer",
            layers.to_string(),
            "no `layers`, and thinner plies",
        ),
        (None, true) if layers % 2 == 0 => return Some(layers),
        (None, true) => (
            "no layer may lie across the middle of the section",
            layers.to_string(),
            "an even number",
        ),
        (None, false) => (
            "the section of an elastic shell has no layers",
            material.key().to_owned(),
            "a material that flows: j2, j2-table, johnson-cook",
        ),
    };
    let problem = Problem::new(format!("{path}.section.shell.layers"), message);
    problems.refuse(problem.found(found).accepted([accepted]))
}

/// The plies of a section; none of one material.
fn plies(of: &GivenShell, problems: &mut Problems) -> Option<Vec<Ply>> {
    let (given, materials) = (of.section, of.materials);
    let path = format!("{}.section.shell", of.path);
    thickness::one_thickness(&path, given, problems)?;
    let Some(plies) = &given.plies else {
        return Some(Vec::new());
    };
    let mut all = Vec::with_capacity(plies.len());
    for (number, ply) in plies.iter().enumerate() {
        let named = ply.material.as_ref();
        let Some(&law) = named.map_or(Some(&of.material), |name| materials.get(name)) else {
            let at = format!("{path}.plies[{number}].material");
            let problem = Problem::new(at, "no material of this name");
            let found = ply.material.as_deref().unwrap_or_default();
            return problems.refuse(problem.unknown(found, materials.keys().map(String::as_str)));
        };
        all.push(Ply {
            material: law,
            thickness: ply.thickness.0,
        });
    }
    Some(all)
}

/// Refuses cells that no shell can be on, of one body, and normals of bodies that share edges.
pub(super) fn sound_shells(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    problems: &mut Problems,
) {
    let is_shell = |body: &&ModelBody| matches!(body.spec.kinematics, Kinematics::Shell(_));
    let shells: Vec<&ModelBody> = bodies.iter().filter(is_shell).collect();
    let mut sound = true;
    for body in &shells {
        let name = &body.spec.name;
        let found = shell_defects(mesh, &body.spec.cells);
        sound &= found.is_empty();
        refuse_cells(context, mesh, name, &found, problems);
    }
    let all: Vec<ElementId> = shell_cells(bodies);
    if sound && shells.len() > 1 {
        let found = shell_defects(mesh, &all);
        let owner = found.first().and_then(|first| {
            let has = |body: &&&ModelBody| body.spec.cells.contains(&first.cell);
            shells.iter().find(has)
        });
        if let Some(body) = owner {
            refuse_cells(context, mesh, &body.spec.name, &found, problems);
        }
    }
}

/// A problem with all cells of a body that no shell can be on.
fn refuse_cells(
    context: &Context,
    mesh: &Mesh,
    name: &str,
    found: &[ShellDefect],
    problems: &mut Problems,
) {
    let Some(first) = found.first() else {
        return;
    };
    let at = place(lookup::middle(mesh, mesh.element_nodes(first.cell)));
    let more = match found.len() {
        1 => String::new(),
        count => format!("; no shell can be on {count} cells in all"),
    };
    let message = format!("the cell about {at} {}{more}", first.why);
    let cells: Vec<ElementId> = found.iter().map(|defect| defect.cell).collect();
    let offenders = Offenders::new(format!("shell-{name}"), mesh, &cells);
    let accepted = "flat convex cells, all of a shell with their normals to the same side";
    let problem = Problem::new(format!("body.{name}.region"), message).accepted([accepted]);
    problems.push(with_cells(problem, offenders, context.file));
}

/// Refuses keys that shells do not take.
pub(super) fn suits_shells(path: &str, body: &Body, problems: &mut Problems) {
    let Some(Section::Shell(section)) = &body.section else {
        return;
    };
    let one_point = matches!(body.formulation, schema::Formulation::With(_));
    let table = [
        Refusal {
            is: one_point && section.rotations == schema::Rotations::Small,
            key: "formulation",
            message: "shells with one point have finite rotations",
            accepted: &["section.shell.rotations = \"finite\"", "no `formulation`"],
        },
        Refusal {
            is: body.rigid.is_some(),
            key: "rigid",
            message: "a rigid body of shells has no cells from which its inertia follows",
            accepted: &["a rigid body of solid cells", "no `rigid`"],
        },
        Refusal {
            is: body.reduction.is_some(),
            key: "reduction",
            message: "shells are not reduced",
            accepted: &["solids and beams", "no `reduction`"],
        },
    ];
    problems.refuse_each(path, &table);
}

/// The surface around a group of cells of shells, at half their thickness on both sides and around their edges. None if the group is anything
/// else.
pub(super) fn around_shells(mesh: &Mesh, bodies: &[ModelBody], group: &Group) -> Option<Surface> {
    let cells = shell_cells(bodies);
    let surface = Surface::of_axes(mesh, group, &cells, |cell| {
        let owner = bodies.iter().find(|body| {
            matches!(body.spec.kinematics, Kinematics::Shell(_)) && body.spec.cells.contains(&cell)
        });
        match owner.map(|body| (body.spec.kinematics, &body.spec)) {
            Some((Kinematics::Shell(section), spec)) => {
                0.5 * spec.mean_thickness(&section, mesh.element_nodes(cell))
            }
            _ => 0.0,
        }
    });
    surface.ok().filter(|_| group.dim == 2 && mesh.dim == 3)
}

/// The cells of all shells.
pub(super) fn shell_cells(bodies: &[ModelBody]) -> Vec<ElementId> {
    let shells = bodies
        .iter()
        .filter(|body| matches!(body.spec.kinematics, Kinematics::Shell(_)));
    shells
        .flat_map(|body| body.spec.cells.iter().copied())
        .collect()
}

/// Whether a body is one of shells.
pub(super) fn is_shell(body: &Body) -> bool {
    matches!(body.section, Some(Section::Shell(_)))
}
