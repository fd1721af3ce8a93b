//! Shells: sections, and what shells refuse.

use std::collections::BTreeMap;

use carom_bodies::{
    Kinematics, Ply, Rotations, SHELL_LAYERS, ShellDefect, ShellSection, shell_defects,
};
use carom_dynamics::ModelBody;
use carom_materials::Law;
use carom_mesh::{ElementId, Group, Mesh, Surface};

use super::context::Context;
use super::problems::Problems;
use super::thickness;
use crate::error::Problem;
use crate::offenders::Offenders;
use crate::schema::{self, Body, Section};

/// What a section of shells makes of a body.
pub(super) struct BuiltShell {
    pub(super) kinematics: Kinematics,
    pub(super) plies: Vec<Ply>,
    /// A material of it, one that flows if any does.
    pub(super) material: Law,
    /// Thickness at each node of the mesh, m, if it changes.
    pub(super) nodal_thickness: Option<Vec<f64>>,
}

/// Shells on these cells with this section. `material`: of the body; `path`: of the body.
pub(super) fn shell(
    context: &Context,
    (mesh, cells): (&Mesh, &[ElementId]),
    path: &str,
    (given, material): (&schema::ShellSection, Law),
    materials: &BTreeMap<String, Law>,
    problems: &mut Problems,
) -> Option<BuiltShell> {
    let plies = plies(path, (given, material), materials, problems)?;
    let laws: Vec<Law> = match plies.is_empty() {
        true => vec![material],
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
        problems.push(problem.found(rubber.key()).accepted(accepted));
        return None;
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
    Some(BuiltShell {
        kinematics: Kinematics::Shell(section),
        plies,
        material,
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
    problems.push(problem.found(found).accepted([accepted]));
    None
}

/// The plies of a section; none of one material.
fn plies(
    path: &str,
    (given, material): (&schema::ShellSection, Law),
    materials: &BTreeMap<String, Law>,
    problems: &mut Problems,
) -> Option<Vec<Ply>> {
    let path = format!("{path}.section.shell");
    thickness::one_thickness(&path, given, problems)?;
    let Some(plies) = &given.plies else {
        return Some(Vec::new());
    };
    let mut all = Vec::with_capacity(plies.len());
    for (number, ply) in plies.iter().enumerate() {
        let named = ply.material.as_ref();
        let Some(&law) = named.map_or(Some(&material), |name| materials.get(name)) else {
            let at = format!("{path}.plies[{number}].material");
            let problem = Problem::new(at, "no material of this name");
            let found = ply.material.as_deref().unwrap_or_default();
            problems.push(problem.unknown(found, materials.keys().map(String::as_str)));
            return None;
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
        refuse_cells(
            context,
            mesh,
            (&format!("body.{name}.region"), name),
            &found,
            problems,
        );
    }
    let all: Vec<ElementId> = shell_cells(bodies);
    if sound && shells.len() > 1 {
        let found = shell_defects(mesh, &all);
        let owner = found.first().and_then(|first| {
            let has = |body: &&&ModelBody| body.spec.cells.contains(&first.cell);
            shells.iter().find(has)
        });
        if let Some(body) = owner {
            let name = &body.spec.name;
            refuse_cells(
                context,
                mesh,
                (&format!("body.{name}.region"), name),
                &found,
                problems,
            );
        }
    }
}

/// A problem with all cells that no shell can be on.
fn refuse_cells(
    context: &Context,
    mesh: &Mesh,
    (path, name): (&str, &str),
    found: &[ShellDefect],
    problems: &mut Problems,
) {
    let Some(first) = found.first() else {
        return;
    };
    let nodes = mesh.element_nodes(first.cell);
    let mean = |i: usize| {
        let sum: f64 = nodes.iter().map(|&node| mesh.nodes[node as usize][i]).sum();
        sum / nodes.len() as f64
    };
    let more = match found.len() {
        1 => String::new(),
        count => format!("; no shell can be on {count} cells in all"),
    };
    let message = format!(
        "the cell about ({:.6}, {:.6}, {:.6}) m {}{more}",
        mean(0),
        mean(1),
        mean(2),
        first.why
    );
    let cells: Vec<ElementId> = found.iter().map(|defect| defect.cell).collect();
    let offenders = Offenders::new(format!("shell-{name}"), mesh, &cells);
    let file = offenders.path(&context.file);
    let note = format!(
        "`carom check --cells` writes the cells to {}",
        file.display()
    );
    let accepted = "flat convex cells, all of a shell with their normals to the same side";
    let problem = Problem::new(path, message).accepted([accepted]).note(note);
    problems.push(Problem {
        offenders: Some(offenders),
        ..problem
    });
}

/// Refuses keys that shells do not take.
pub(super) fn suits_shells(path: &str, body: &Body, problems: &mut Problems) {
    if let Some(Section::Shell(section)) = &body.section
        && matches!(body.formulation, schema::Formulation::With(_))
        && section.rotations == schema::Rotations::Small
    {
        let message = "shells with one point have finite rotations";
        let problem = Problem::new(format!("{path}.formulation"), message);
        problems
            .push(problem.accepted(["section.shell.rotations = \"finite\"", "no `formulation`"]));
    }
    if is_shell(body) && body.rigid.is_some() {
        let message = "a rigid body of shells has no cells from which its inertia follows";
        let problem = Problem::new(format!("{path}.rigid"), message);
        problems.push(problem.accepted(["a rigid body of solid cells", "no `rigid`"]));
    }
    if is_shell(body) && body.reduction.is_some() {
        let message = "shells are not reduced";
        let problem = Problem::new(format!("{path}.reduction"), message);
        problems.push(problem.accepted(["solids and beams", "no `reduction`"]));
    }
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
