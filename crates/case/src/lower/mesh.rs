//! The mesh of a case: its file, generated parts, and both refined.

use std::path::Path;

use carom_mesh::{Mesh, Placement, generate, halve_bars, read, refine};
use carom_quantities::{Vector, units};
use carom_ranks::memory::room_for;

use super::context::Context;
use super::discrete;
use super::problems::{Problems, dimensions};
use crate::error::Problem;
use crate::input::names_in;
use crate::rules::{MOST_NODES, nodes_of};
use crate::schema::{Count, Part, Placed};

/// Bytes of a node with its share of the elements, of all that is kept of them in a run at the least. A run with hexahedra takes some five times as
/// many without a factor.
const NODE: f64 = 100.0;

/// A part of the mesh.
struct MeshPart {
    /// Its key.
    path: String,
    name: String,
    mesh: Mesh,
}

/// The mesh in metres.
pub(super) fn lower(context: &Context, problems: &mut Problems) -> Option<Mesh> {
    let mut parts = parts(context, problems)?;
    if let Some(dimension) = context.case.mesh.dimension {
        for part in &mut parts {
            raise(&mut part.mesh, dimension as usize, problems);
        }
    }
    let mut parts = parts.into_iter();
    let Some(first) = parts.next() else {
        if let Some(mesh) = discrete::empty_mesh(context) {
            return Some(mesh);
        }
        let problem = Problem::new("mesh", "no mesh");
        return problems.refuse(problem.accepted(["`file`", "`part`", "`generate`"]));
    };
    let mut whole = first.mesh;
    for MeshPart { path, name, mesh } in parts {
        let all = dimensions(whole.dim);
        if mesh.dim != whole.dim {
            let first = &first.name;
            let message = format!("`{first}` has {all}, this part another number");
            let problem = Problem::new(path, message).found(dimensions(mesh.dim));
            problems.push(problem.accepted([format!("{all}, as before")]));
        } else if let Err(error) = whole.merge(&name, mesh) {
            let problem = Problem::new(path, error.to_string());
            problems.push(problem.accepted(["a name that no other group has"]));
        }
    }
    if problems.is_empty() {
        let bodies = context.case.body.iter();
        halve_bars(&mut whole, bodies.map(|(_, body)| body.region.as_str()));
        refined(context, whole, problems)
    } else {
        None
    }
}

/// Those of files, then those that are generated.
fn parts(context: &Context, problems: &mut Problems) -> Option<Vec<MeshPart>> {
    let given = &context.case.mesh;
    let mut parts = Vec::new();
    if let Some(file) = &given.file {
        let scale = units::length_of_unit(&given.unit.0).unwrap_or(1.0);
        parts.push(MeshPart {
            path: "mesh.file".to_string(),
            name: file.clone(),
            mesh: read("mesh.file", context.folder, file, scale, problems)?,
        });
    }
    for (name, part) in given.part.iter() {
        let path = format!("mesh.part.{name}");
        let mesh = placed(&path, name, part, context.folder, problems)?;
        let name = name.to_string();
        parts.push(MeshPart { path, name, mesh });
    }
    for (name, part) in given.generate.iter() {
        let path = format!("mesh.generate.{name}");
        let elements = match part {
            Part::Line(line) => std::slice::from_ref(&line.elements),
            Part::Rectangle(rectangle) => &rectangle.elements[..],
            Part::Box(part) => &part.elements[..],
        };
        has_room(&path, nodes_of(elements), problems)?;
        let mesh = generated(name, part);
        let name = name.to_string();
        parts.push(MeshPart { path, name, mesh });
    }
    Some(parts)
}

/// Gives a part the dimension that the case asks for.
fn raise(part: &mut Mesh, dimension: usize, problems: &mut Problems) {
    if part.dim > dimension {
        let message = format!("the mesh has {}", dimensions(part.dim));
        let problem = Problem::new("mesh.dimension", message).found(dimension);
        problems.push(problem.accepted([format!("at least {}", part.dim)]));
        return;
    }
    part.dim = dimension;
}

/// The mesh with every element cut as often as the case says.
fn refined(context: &Context, mut mesh: Mesh, problems: &mut Problems) -> Option<Mesh> {
    let times = context.case.mesh.refine;
    let nodes = mesh.nodes.len() as f64 * 2f64.powi(mesh.dim as i32 * times as i32);
    if times > 0 && nodes > MOST_NODES {
        let problem = Problem::new("mesh.refine", "too many elements");
        let problem = problem.found(format!("about {nodes:.0e} nodes"));
        return problems.refuse(problem.accepted([format!("at most {MOST_NODES:e} nodes")]));
    }
    if times > 0 {
        has_room("mesh.refine", nodes, problems)?;
    }
    for _ in 0..times {
        match refine(&mesh) {
            Ok(finer) => mesh = finer,
            Err(error) => {
                return problems.refuse(Problem::new("mesh.refine", error.to_string()));
            }
        }
    }
    Some(mesh)
}

/// Nothing where this machine has no memory for so many nodes, after a problem.
fn has_room(path: &str, nodes: f64, problems: &mut Problems) -> Option<()> {
    let room = room_for(
        format_args!("a mesh of {nodes:.1e} nodes"),
        (NODE * nodes) as u64,
    );
    if let Err(short) = room {
        let problem = Problem::new(path, short.to_string());
        return problems.refuse(Problem {
            lacks_memory: true,
            ..problem.accepted(["fewer elements"])
        });
    }
    Some(())
}

/// A part from a file where it belongs.
fn placed(
    path: &str,
    name: &str,
    part: &Placed,
    folder: &Path,
    problems: &mut Problems,
) -> Option<Mesh> {
    let unit = units::length_of_unit(&part.unit.0).unwrap_or(1.0);
    let scale = unit * part.scale.unwrap_or(1.0);
    let mut mesh = read(&format!("{path}.file"), folder, &part.file, scale, problems)?;
    let mut turn = ([0.0, 0.0, 1.0], 0.0);
    if let Some(given) = &part.turn {
        turn.1 = given.angle.0;
        if let Some(axis) = &given.axis {
            let axis = axis.components();
            let length = axis.iter().map(|a| a * a).sum::<f64>().sqrt();
            turn.0 = axis.map(|a| a / length);
        }
    }
    mesh.place(&Placement {
        turn,
        shift: part.shift.as_ref().map_or([0.0; 3], Vector::si),
    });
    mesh.prefix(name);
    Some(mesh)
}

/// `key`: where the case names the file.
fn read(key: &str, folder: &Path, file: &str, scale: f64, problems: &mut Problems) -> Option<Mesh> {
    let path = folder.join(file);
    match carom_med::read(&path) {
        Ok(mut mesh) => {
            mesh.scale(scale);
            Some(mesh)
        }
        Err(error) => {
            let problem = Problem::new(key, error.to_string());
            let others = if path.exists() {
                Vec::new()
            } else {
                beside(&path)
            };
            problems.refuse(match others.is_empty() {
                true => problem,
                false => problem.unknown(file, others.iter().map(String::as_str)),
            })
        }
    }
}

/// Names of the meshes in the folder of a file, in their order.
fn beside(path: &Path) -> Vec<String> {
    let mut names = path.parent().map_or(Vec::new(), names_in);
    let is_mesh = |name: &String| {
        let extension = Path::new(name).extension().unwrap_or_default();
        let extension = extension.to_string_lossy().to_lowercase();
        read::EXTENSIONS.contains(&extension.as_str())
    };
    names.retain(is_mesh);
    names
}

fn generated(name: &str, part: &Part) -> Mesh {
    let counts = |elements: &[Count]| elements.iter().map(|count| count.0).collect::<Vec<_>>();
    match part {
        Part::Line(line) => generate::line(
            name,
            line.from.si(),
            line.to.si(),
            line.elements.0,
            line.from.given(),
        ),
        Part::Rectangle(part) => {
            let n = counts(&part.elements);
            let (origin, size) = (part.origin.map(|x| x.0), part.size.map(|x| x.0));
            generate::rectangle(name, origin, size, [n[0], n[1]], part.triangles)
        }
        Part::Box(part) => {
            let n = counts(&part.elements);
            let (origin, size) = (part.origin.map(|x| x.0), part.size.map(|x| x.0));
            generate::box_(name, origin, size, [n[0], n[1], n[2]], part.tetrahedra)
        }
    }
}
