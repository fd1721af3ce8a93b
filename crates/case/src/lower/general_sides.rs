//! The sides of the general contact: bodies with their outer sides, or several of one material together.

use std::collections::BTreeMap;

use carom_bodies::{Kinematics, Rotations, height};
use carom_dynamics::{ModelBody, ModelContact};
use carom_mesh::{ElementId, Face, Group, Mesh, Surface};

use super::context::Context;
use super::joints::Joints;
use super::plan::Plan;
use super::problems::Problems;
use super::shells::around_shells;

/// What the general contact is of.
pub(super) struct Scope<'a> {
    pub(super) context: &'a Context<'a>,
    pub(super) mesh: &'a Mesh,
    pub(super) bodies: &'a [ModelBody],
    /// Cells of each body.
    pub(super) cells: &'a [Vec<ElementId>],
    /// Contacts that the case names.
    pub(super) named: &'a [ModelContact],
    pub(super) joints: &'a Joints,
}

/// A body that takes part, or several that one contact takes together.
pub(super) struct Part<'a> {
    /// Of several the first.
    pub(super) body: &'a ModelBody,
    /// Their numbers, ascending.
    pub(super) bodies: Vec<usize>,
    /// What its contacts are called by.
    pub(super) name: String,
    pub(super) material: String,
    pub(super) surface: Surface,
    /// Least thickness of the cells at its outer sides, m.
    pub(super) thickness: f64,
    /// Mean length of the edges of its outer sides, m.
    pub(super) length: f64,
}

impl<'a> Part<'a> {
    fn new(
        mesh: &Mesh,
        (body, material): (&'a ModelBody, String),
        bodies: Vec<usize>,
        surface: Surface,
    ) -> Part<'a> {
        let faces = &surface.faces;
        let thickness = |face: &Face| match face.radius {
            Some(radius) => 2.0 * radius,
            None => height(mesh, face.parent, face.kind, face.corners()),
        };
        let lengths: f64 = faces.iter().map(|face| face.length(&mesh.nodes)).sum();
        Part {
            body,
            bodies,
            name: body.spec.name.clone(),
            material,
            thickness: faces.iter().map(thickness).fold(f64::INFINITY, f64::min),
            length: lengths / faces.len() as f64,
            surface,
        }
    }

    /// Whether the surface is around axes of beams or middles of shells.
    pub(super) fn is_round(&self) -> bool {
        self.surface.faces.iter().any(Face::is_round)
    }

    pub(super) fn is_axis(&self) -> bool {
        matches!(self.body.spec.kinematics, Kinematics::Beam(_))
    }

    pub(super) fn is_shell(&self) -> bool {
        matches!(self.body.spec.kinematics, Kinematics::Shell(_))
    }

    /// Whether it is the outer side of cells that fill the space.
    pub(super) fn is_solid(&self) -> bool {
        self.surface.faces.iter().all(|face| face.radius.is_none())
    }

    /// Whether one contact takes the bodies of both.
    fn goes_with(&self, other: &Part, plan: &Plan) -> bool {
        let [one, two] = [self, other].map(|part| &part.body.spec);
        let zones = [self, other].map(|part| plan.zone_of(part.bodies[0]));
        self.material == other.material
            && one.kinematics == two.kinematics
            && zones[0] == zones[1]
            && one.deletion.is_none()
            && two.deletion.is_none()
    }
}

/// Bodies with an outer side; a warning names the others.
pub(super) fn parts<'a>(scope: &Scope<'a>, problems: &mut Problems) -> Vec<Part<'a>> {
    let Scope { mesh, bodies, .. } = *scope;
    let mut parts = Vec::new();
    for (number, body) in bodies.iter().enumerate() {
        let name = &body.spec.name;
        let given = scope.context.case.body.get(name);
        let material = given.map(|given| given.material.to_string());
        let side = outer_side(mesh, bodies, (body.spec.kinematics, &body.spec.cells));
        let side = side.and_then(|side| outside(side, scope.joints));
        let (material, surface) = match (material, side) {
            (Some(material), Ok(surface)) => (material, surface),
            (_, cause) => {
                let cause = cause.err().unwrap_or("no material");
                problems.doubt(format!(
                    "general-contact: body `{name}` takes no part: {cause}; name its contacts"
                ));
                continue;
            }
        };
        parts.push(Part::new(mesh, (body, material), vec![number], surface));
    }
    parts
}

/// Puts bodies together that one contact takes: of one material, one section and one zone.
pub(super) fn by_materials<'a>(
    scope: &Scope<'a>,
    parts: Vec<Part<'a>>,
    problems: &mut Problems,
) -> Vec<Part<'a>> {
    let Scope { mesh, bodies, .. } = *scope;
    let mut together: Vec<Vec<Part>> = Vec::new();
    for part in parts {
        let mut known = together.iter_mut();
        match known.find(|others| others[0].goes_with(&part, scope.context.plan)) {
            Some(others) => others.push(part),
            None => together.push(vec![part]),
        }
    }
    let mut used: BTreeMap<String, usize> = BTreeMap::new();
    let mut merged = Vec::new();
    for mut others in together {
        let (body, material) = (others[0].body, others[0].material.clone());
        let count = used.entry(material.clone()).or_default();
        *count += 1;
        let name = match count {
            1 => material.clone(),
            _ => format!("{material}-{count}"),
        };
        let one = match others.len() {
            1 => others.remove(0),
            _ => {
                let numbers: Vec<usize> = others.iter().map(|part| part.bodies[0]).collect();
                let cells = numbers.iter().flat_map(|&body| &bodies[body].spec.cells);
                let mut cells: Vec<ElementId> = cells.copied().collect();
                cells.sort_unstable();
                // bodies that share nodes have no outer side between them
                let whole = outer_side(mesh, bodies, (body.spec.kinematics, &cells));
                match whole.and_then(|whole| outside(whole, scope.joints)) {
                    Ok(surface) => Part::new(mesh, (body, material), numbers, surface),
                    Err(cause) => {
                        problems.doubt(format!(
                            "general-contact: the bodies of `{material}` take no part: {cause}"
                        ));
                        continue;
                    }
                }
            }
        };
        merged.push(Part { name, ..one });
    }
    merged
}

/// The whole outer side of a body: of cells that fill the space their faces, of shells and beams what is around them.
///
/// # Errors
/// Why there is none.
fn outer_side(
    mesh: &Mesh,
    bodies: &[ModelBody],
    (kinematics, cells): (Kinematics, &[ElementId]),
) -> Result<Surface, &'static str> {
    let none = Err("it has no outer sides");
    let group = |dim: usize| Group {
        dim,
        elements: cells.to_vec(),
    };
    match kinematics {
        _ if mesh.dim == 1 => none,
        Kinematics::Bar { .. } => none,
        Kinematics::Shell(_) => around_shells(mesh, bodies, &group(2)).map_or(none, Ok),
        Kinematics::Beam(section) if section.offset != [0.0; 2] => {
            Err("the axis of its beams is beside their nodes")
        }
        Kinematics::Beam(section) => match section.radius {
            Some(radius) if radius > 0.0 => {
                Surface::of_axes(mesh, &group(1), cells, |_| radius).or(none)
            }
            _ => Err("the section of its beams has no `radius`"),
        },
        _ => Ok(Surface::outer(mesh, cells)),
    }
}

/// The faces of an outer side whose cells are in no overlap.
///
/// # Errors
/// Where all are.
fn outside(side: Surface, joints: &Joints) -> Result<Surface, &'static str> {
    let is_out = |face: &Face| !joints.inside.contains_key(&face.parent);
    if side.faces.iter().all(is_out) {
        return Ok(side);
    }
    let faces: Vec<Face> = side.faces.into_iter().filter(is_out).collect();
    match faces.is_empty() {
        true => Err("all its outer sides are in an overlap"),
        false => Ok(Surface::of_faces(faces)),
    }
}

/// Whether a body changes its shape so much that it may touch itself.
pub(super) fn folds(body: &ModelBody) -> bool {
    if body.rigid.is_some() {
        return false;
    }
    let turns = body.spec.kinematics.rotations() == Some(Rotations::Finite);
    turns || body.spec.kinematics.rotations().is_none() && body.spec.material.finite().is_some()
}
