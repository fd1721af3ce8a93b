//! General contact: the outer sides of all bodies, each with each other and with itself.

use std::collections::{BTreeMap, BTreeSet};

use carom_bodies::{Kinematics, Rotations, height};
use carom_contact::{Initial, Integration, Parts, Sliding};
use carom_dynamics::{ModelBody, ModelContact, ModelTarget};
use carom_mesh::{ElementId, Face, Group, Mesh, Surface};

use super::contacts::{has_quadratic_faces, mortar};
use super::context::Context;
use super::joints::Joints;
use super::laws::{self, sides};
use super::plan::Plan;
use super::problems::Problems;
use super::shells::around_shells;
use super::zones;
use crate::error::Problem;
use crate::schema::{Basis, Friction, GeneralBy, GeneralContact, GivenLaw};

/// Contacts from which on a warning says that they are many: each looks for its points in each step.
const MANY: usize = 100;

/// A body that takes part, or several that one contact takes together.
struct Part<'a> {
    /// Of several the first.
    body: &'a ModelBody,
    /// Their numbers, ascending.
    bodies: Vec<usize>,
    /// What its contacts are called by.
    name: String,
    material: String,
    surface: Surface,
    /// Least thickness of the cells at its outer sides, m.
    thickness: f64,
    /// Mean length of the edges of its outer sides, m.
    length: f64,
}

/// What is in no contact with each other.
struct Apart {
    /// The body of each cell.
    owners: BTreeMap<ElementId, usize>,
    /// Pairs of bodies that something else joins, ascending.
    joined: BTreeSet<[usize; 2]>,
    /// Pairs of bodies that share nodes of their outer sides, ascending.
    shared: BTreeSet<[usize; 2]>,
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
    fn is_round(&self) -> bool {
        self.surface.faces.iter().any(Face::is_round)
    }

    fn is_axis(&self) -> bool {
        matches!(self.body.spec.kinematics, Kinematics::Beam(_))
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

/// The contacts of the general contact; `named` and `joints`: what joins bodies besides, whose pairs it leaves out. `of`: cells of each body.
pub(super) fn lower(
    context: &Context,
    mesh: &Mesh,
    (bodies, of): (&[ModelBody], &[Vec<ElementId>]),
    (named, joints): (&[ModelContact], &Joints),
    problems: &mut Problems,
) -> Vec<ModelContact> {
    let case = context.case;
    let Some(given) = &case.general_contact else {
        return Vec::new();
    };
    check_pairs(context, given, problems);
    let mut parts = parts(context, mesh, bodies, joints, problems);
    let apart = kept_apart(context, mesh, (of, named), &parts);
    if given.by == GeneralBy::Materials {
        parts = by_materials(context, mesh, (bodies, joints), parts, problems);
    }
    let mut contacts = Vec::new();
    for (k, one) in parts.iter().enumerate() {
        for other in &parts[k..] {
            contacts.extend(between(
                context,
                mesh,
                (bodies, of),
                (given, one, other),
                &apart,
                problems,
            ));
        }
    }
    if contacts.is_empty() {
        problems.doubt(
            "general-contact: it makes no contact: no two of the bodies have surfaces that may touch"
                .to_owned(),
        );
    }
    if contacts.len() > MANY {
        problems.warn(format!(
            "general-contact: {} contacts, each with a search of its own; by = \"materials\" makes one of all bodies of two materials",
            contacts.len()
        ));
    }
    contacts
}

/// What is in no contact with each other.
fn kept_apart(
    context: &Context,
    mesh: &Mesh,
    (of, named): (&[Vec<ElementId>], &[ModelContact]),
    parts: &[Part],
) -> Apart {
    let cells = of.iter().enumerate();
    let owners: BTreeMap<ElementId, usize> = cells
        .flat_map(|(body, cells)| cells.iter().map(move |&cell| (cell, body)))
        .collect();
    let mut nodes: Vec<(u32, usize)> = parts
        .iter()
        .flat_map(|part| {
            part.surface
                .nodes
                .iter()
                .map(|&node| (node, part.bodies[0]))
        })
        .collect();
    nodes.sort_unstable();
    let mut shared = BTreeSet::new();
    for all in nodes.chunk_by(|one, other| one.0 == other.0) {
        for (k, (_, one)) in all.iter().enumerate() {
            shared.extend(all[k + 1..].iter().map(|(_, other)| [*one, *other]));
        }
    }
    let mut joined = BTreeSet::new();
    let mut join = |one: &BTreeSet<usize>, other: &BTreeSet<usize>| {
        for &a in one {
            joined.extend(other.iter().map(|&b| [a.min(b), a.max(b)]));
        }
    };
    for contact in named {
        if let ModelTarget::Surface(primary) = &contact.primary {
            let of = |surface: &Surface| {
                let faces = surface.faces.iter();
                faces
                    .filter_map(|face| owners.get(&face.parent).copied())
                    .collect()
            };
            join(&of(&contact.secondary), &of(primary));
        }
    }
    let with = |group: &String| -> BTreeSet<usize> {
        let group = mesh.groups.get(group);
        let of_group = group
            .map(|group| mesh.group_nodes(group))
            .unwrap_or_default();
        let known = of_group.iter().flat_map(|node| {
            let first = nodes.partition_point(|(other, _)| other < node);
            nodes[first..]
                .iter()
                .take_while(move |(other, _)| other == node)
        });
        known.map(|(_, body)| *body).collect()
    };
    for (_, given) in context.case.transition.iter() {
        match (&given.surfaces, &given.end, &given.face) {
            (Some([one, other]), _, _) | (None, Some(one), Some(other)) => {
                join(&with(one), &with(other));
            }
            _ => {}
        }
    }
    let body = |name: &String| -> BTreeSet<usize> {
        let place = context.case.body.names().position(|one| one == name);
        place.into_iter().collect()
    };
    for (_, given) in context.case.arlequin.iter() {
        join(&body(&given.inner), &body(&given.outer));
    }
    for (_, given) in context.case.interface.iter() {
        join(&body(&given.inner), &body(&given.outer));
    }
    Apart {
        owners,
        joined,
        shared,
    }
}

/// Puts bodies together that one contact takes: of one material, one section and one zone.
fn by_materials<'a>(
    context: &Context,
    mesh: &Mesh,
    (bodies, joints): (&[ModelBody], &Joints),
    parts: Vec<Part<'a>>,
    problems: &mut Problems,
) -> Vec<Part<'a>> {
    let mut together: Vec<Vec<Part>> = Vec::new();
    for part in parts {
        let mut known = together.iter_mut();
        match known.find(|others| others[0].goes_with(&part, &context.plan)) {
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
                match whole.and_then(|whole| outside(whole, joints)) {
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

/// Refuses pairs of materials that are none, or that are given twice.
fn check_pairs(context: &Context, given: &GeneralContact, problems: &mut Problems) {
    let mut seen = BTreeSet::new();
    for (k, pair) in given.pairs.iter().enumerate() {
        let path = format!("general-contact.pairs[{k}].materials");
        for name in &pair.materials {
            if context.case.material.get(name).is_none() {
                let problem = Problem::new(&path, "no such material").found(name);
                let names: Vec<String> = context.case.material.names().map(str::to_owned).collect();
                problems.push(problem.accepted(names));
            }
        }
        if !seen.insert(sorted(&pair.materials)) {
            let problem = Problem::new(&path, "this pair of materials is given twice");
            let found = pair.materials.join("`, `");
            problems.push(problem.found(found).accepted(["each pair once"]));
        }
    }
}

/// Bodies with an outer side; a warning names the others.
fn parts<'a>(
    context: &Context,
    mesh: &Mesh,
    bodies: &'a [ModelBody],
    joints: &Joints,
    problems: &mut Problems,
) -> Vec<Part<'a>> {
    let mut parts = Vec::new();
    for (number, body) in bodies.iter().enumerate() {
        let name = &body.spec.name;
        let given = context.case.body.get(name);
        let material = given.map(|given| given.material.to_string());
        let side = outer_side(mesh, bodies, (body.spec.kinematics, &body.spec.cells));
        let side = side.and_then(|side| outside(side, joints));
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

/// The contact between two bodies, or of a body with itself where it can fold; none between bodies that share nodes or that something
/// else joins. Of several bodies on a side those that do not touch are left out by pairs.
fn between(
    context: &Context,
    mesh: &Mesh,
    (bodies, of): (&[ModelBody], &[Vec<ElementId>]),
    (given, one, other): (&GeneralContact, &Part, &Part),
    apart: &Apart,
    problems: &mut Problems,
) -> Option<ModelContact> {
    let [first, second] = [one, other].map(|part| part.name.as_str());
    let itself = one.bodies == other.bodies;
    let many = one.bodies.len() + other.bodies.len() > 2;
    if !many {
        let pair = [one.bodies[0], other.bodies[0]];
        if apart.joined.contains(&pair) || itself && !folds(one.body) {
            return None;
        }
        if apart.shared.contains(&pair) {
            problems.warn(format!(
                "general-contact: bodies `{first}` and `{second}` share nodes and have no contact with each other"
            ));
            return None;
        }
    }
    let name = match itself {
        true => format!("all-{first}"),
        false => format!("all-{first}-{second}"),
    };
    if context.case.contact.get(&name).is_some() || context.case.stop.get(&name).is_some() {
        let message = "the general contact has a contact of this name";
        let problem = Problem::new(format!("contact.{name}"), message);
        return problems.refuse(problem.accepted(["another name"]));
    }
    // points of axes see faces, otherwise those of the finer side the coarser one
    let order = |part: &Part| (!part.is_axis(), part.length);
    let (secondary, primary) = match order(one) <= order(other) {
        true => (one, other),
        false => (other, one),
    };
    let target = ModelTarget::Surface(primary.surface.clone());
    let both = sides(mesh, bodies, &secondary.surface, &target);
    let scheme = zones::scheme_at(
        context,
        secondary.surface.faces.first().map(|face| face.parent),
        of,
    );
    let (law, friction) = of_materials(given, [&one.material, &other.material]);
    let law = laws::law(&name, law, (&both, &scheme), problems)?;
    let round = one.is_round() || other.is_round();
    let quadratic = has_quadratic_faces(&secondary.surface, &target);
    let depth = given.depth.map(|depth| depth.0);
    let thin = one.thickness.min(other.thickness);
    // surfaces that deletion lays bare have no depth
    let deletes = [one, other]
        .iter()
        .any(|part| part.body.spec.deletion.is_some());
    let parts = many.then(|| apart.parts((secondary, primary), |body| folds(&bodies[body])));
    Some(ModelContact {
        parts,
        sliding: Sliding::Finite,
        integration: match quadratic && !round {
            true => mortar(Basis::default()),
            false => Integration::Node,
        },
        friction: friction.map_or(0.0, |Friction::Coulomb(coefficient)| coefficient),
        initial: Initial::Touch,
        near_only: !deletes,
        // surfaces around axes and middles have none, one that faces itself has its own
        depth: match round {
            true => None,
            false => depth.or((!itself && !deletes).then_some(thin)),
        },
        ..ModelContact::new(name, secondary.surface.clone(), target, law)
    })
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

impl Apart {
    /// The parts of a contact whose sides have several bodies. `folds`: whether a body may touch itself.
    fn parts(&self, (secondary, primary): (&Part, &Part), folds: impl Fn(usize) -> bool) -> Parts {
        let of = |part: &Part| -> Vec<u32> {
            let faces = part.surface.faces.iter();
            faces
                .map(|face| {
                    self.owners
                        .get(&face.parent)
                        .map_or(u32::MAX, |&body| body as u32)
                })
                .collect()
        };
        let itself = secondary.bodies == primary.bodies;
        let has = |body: &usize| {
            [secondary, primary]
                .iter()
                .any(|part| part.bodies.binary_search(body).is_ok())
        };
        let of_both = |pair: &&[usize; 2]| pair.iter().all(has);
        let mut apart: BTreeSet<[u32; 2]> = BTreeSet::new();
        let mut leave_out = |pair: [usize; 2]| {
            apart.insert(pair.map(|body| body as u32));
        };
        self.joined
            .iter()
            .filter(of_both)
            .for_each(|pair| leave_out(*pair));
        match itself {
            // the sides between bodies that share nodes are no outer sides
            true => {
                let still = secondary.bodies.iter().filter(|&&body| !folds(body));
                still.for_each(|&body| leave_out([body; 2]));
            }
            false => self
                .shared
                .iter()
                .filter(of_both)
                .for_each(|pair| leave_out(*pair)),
        }
        Parts {
            secondary: of(secondary),
            primary: of(primary),
            apart,
        }
    }
}

/// Whether a body moves so much that it may touch itself.
fn folds(body: &ModelBody) -> bool {
    let turns = body.spec.kinematics.rotations() == Some(Rotations::Finite);
    turns || body.spec.kinematics.rotations().is_none() && body.spec.material.finite().is_some()
}

/// Law and friction of a pair of materials.
fn of_materials<'a>(
    given: &'a GeneralContact,
    materials: [&str; 2],
) -> (&'a GivenLaw, Option<Friction>) {
    let wanted = sorted(&materials.map(str::to_owned));
    let mut pairs = given.pairs.iter();
    let pair = pairs.find(|pair| sorted(&pair.materials) == wanted);
    let law = pair
        .and_then(|pair| pair.law.as_ref())
        .unwrap_or(&given.law);
    (law, pair.and_then(|pair| pair.friction).or(given.friction))
}

fn sorted(names: &[String; 2]) -> [String; 2] {
    let mut names = names.clone();
    names.sort();
    names
}
