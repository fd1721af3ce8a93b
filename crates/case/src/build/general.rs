//! General contact: the outer sides of all bodies, each with each other and with itself.

use std::collections::BTreeSet;

use carom_bodies::{Kinematics, Rotations, height};
use carom_contact::{Initial, Integration, Sliding};
use carom_dynamics::{ModelBody, ModelContact, ModelTarget};
use carom_mesh::{ElementId, Face, Group, Mesh, Surface};

use super::Builder;
use super::contacts::{has_quadratic_faces, mortar};
use super::laws::sides;
use super::shells::around_shells;
use super::zones::body_of;
use crate::error::Problem;
use crate::schema::{Basis, Friction, GeneralContact, GivenLaw};

/// Contacts from which on a warning says that they are many: each looks for its points in each step.
const MANY: usize = 100;

/// A body that takes part.
struct Part<'a> {
    body: &'a ModelBody,
    material: String,
    surface: Surface,
    /// Least thickness of the cells at its outer sides, m.
    thickness: f64,
    /// Mean length of the edges of its outer sides, m.
    length: f64,
}

impl Part<'_> {
    /// Whether the surface is around axes of beams or middles of shells.
    fn is_round(&self) -> bool {
        self.surface.faces.iter().any(Face::is_round)
    }

    fn is_axis(&self) -> bool {
        matches!(self.body.spec.kinematics, Kinematics::Beam(_))
    }
}

impl Builder<'_> {
    /// The contacts of the general contact; `named`: the others, whose pairs of bodies it leaves out. `of`: cells of each body.
    pub(super) fn general_contact(
        &mut self,
        mesh: &Mesh,
        (bodies, of): (&[ModelBody], &[Vec<ElementId>]),
        named: &[ModelContact],
    ) -> Vec<ModelContact> {
        let case = self.case;
        let Some(given) = &case.general_contact else {
            return Vec::new();
        };
        if !self.plan.zones.is_empty() {
            let message = "a general contact is not available in zones, whose overlapping bodies would touch each other";
            let problem = Problem::new("general-contact", message);
            self.problems
                .push(problem.accepted(["`[contact]` for each pair", "no zones"]));
            return Vec::new();
        }
        self.check_pairs(given);
        let parts = self.parts(mesh, bodies);
        let joined: BTreeSet<[usize; 2]> = named
            .iter()
            .filter_map(|contact| pair_of(contact, of))
            .collect();
        let mut contacts = Vec::new();
        for (k, (first, one)) in parts.iter().enumerate() {
            for (second, other) in &parts[k..] {
                if joined.contains(&[*first, *second]) {
                    continue;
                }
                contacts.extend(self.between(mesh, (bodies, of), (given, one, other)));
            }
        }
        if contacts.len() > MANY {
            self.warnings.push(format!(
                "general-contact: {} pairs of bodies, each with a search of its own; name the contacts that can happen",
                contacts.len()
            ));
        }
        contacts
    }

    /// Refuses pairs of materials that are none, or that are given twice.
    fn check_pairs(&mut self, given: &GeneralContact) {
        let mut seen = BTreeSet::new();
        for (k, pair) in given.pairs.iter().enumerate() {
            let path = format!("general-contact.pairs[{k}].materials");
            for name in &pair.materials {
                if self.case.material.get(name).is_none() {
                    let problem = Problem::new(&path, "no such material").found(name);
                    let names: Vec<String> =
                        self.case.material.names().map(str::to_owned).collect();
                    self.problems.push(problem.accepted(names));
                }
            }
            if !seen.insert(sorted(&pair.materials)) {
                let problem = Problem::new(&path, "this pair of materials is given twice");
                let found = pair.materials.join("`, `");
                self.problems
                    .push(problem.found(found).accepted(["each pair once"]));
            }
        }
    }

    /// Bodies with an outer side; a warning names the others.
    fn parts<'a>(&mut self, mesh: &Mesh, bodies: &'a [ModelBody]) -> Vec<(usize, Part<'a>)> {
        let mut parts = Vec::new();
        for (number, body) in bodies.iter().enumerate() {
            let name = &body.spec.name;
            let given = self.case.body.get(name);
            let material = given.map(|given| given.material.to_string());
            let (material, surface) = match (material, outer_side(mesh, bodies, body)) {
                (Some(material), Ok(surface)) => (material, surface),
                (_, cause) => {
                    let cause = cause.err().unwrap_or("no material");
                    self.warnings.push(format!(
                        "general-contact: body `{name}` takes no part: {cause}; name its contacts"
                    ));
                    continue;
                }
            };
            let faces = &surface.faces;
            let thickness = |face: &Face| match face.radius {
                Some(radius) => 2.0 * radius,
                None => height(mesh, face.parent, face.kind, face.corners()),
            };
            let lengths: f64 = faces.iter().map(|face| face.length(&mesh.nodes)).sum();
            let part = Part {
                body,
                material,
                thickness: faces.iter().map(thickness).fold(f64::INFINITY, f64::min),
                length: lengths / faces.len() as f64,
                surface,
            };
            parts.push((number, part));
        }
        parts
    }

    /// The contact between two bodies, or of a body with itself where it can fold; none between bodies that share nodes.
    fn between(
        &mut self,
        mesh: &Mesh,
        (bodies, of): (&[ModelBody], &[Vec<ElementId>]),
        (given, one, other): (&GeneralContact, &Part, &Part),
    ) -> Option<ModelContact> {
        let [first, second] = [one, other].map(|part| part.body.spec.name.as_str());
        let itself = first == second;
        if itself && !folds(one.body) {
            return None;
        }
        if !itself && shares_nodes(&one.surface, &other.surface) {
            self.warnings.push(format!(
                "general-contact: bodies `{first}` and `{second}` share nodes and have no contact with each other"
            ));
            return None;
        }
        let name = match itself {
            true => format!("all-{first}"),
            false => format!("all-{first}-{second}"),
        };
        if self.case.contact.get(&name).is_some() || self.case.stop.get(&name).is_some() {
            let message = "the general contact has a contact of this name";
            let problem = Problem::new(format!("contact.{name}"), message);
            self.problems.push(problem.accepted(["another name"]));
            return None;
        }
        // points of axes see faces, otherwise those of the finer side the coarser one
        let order = |part: &Part| (!part.is_axis(), part.length);
        let (secondary, primary) = match order(one) <= order(other) {
            true => (one, other),
            false => (other, one),
        };
        let target = ModelTarget::Surface(primary.surface.clone());
        let both = sides(mesh, bodies, &secondary.surface, &target);
        let scheme = self.scheme_at(secondary.surface.faces.first().map(|face| face.parent), of);
        let (law, friction) = of_materials(given, [&one.material, &other.material]);
        let law = self.law(&name, law, (&both, &scheme))?;
        let round = one.is_round() || other.is_round();
        let quadratic = has_quadratic_faces(&secondary.surface, &target);
        let depth = given.depth.map(|depth| depth.0);
        let thin = one.thickness.min(other.thickness);
        // surfaces that deletion lays bare have no depth
        let deletes = [one, other]
            .iter()
            .any(|part| part.body.spec.deletion.is_some());
        Some(ModelContact {
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
}

/// The whole outer side of a body: of cells that fill the space their faces, of shells and beams what is around them.
///
/// # Errors
/// Why there is none.
fn outer_side(
    mesh: &Mesh,
    bodies: &[ModelBody],
    body: &ModelBody,
) -> Result<Surface, &'static str> {
    let cells = &body.spec.cells;
    let none = Err("it has no outer sides");
    let group = |dim: usize| Group {
        dim,
        elements: cells.clone(),
    };
    match body.spec.kinematics {
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

/// The two bodies of a contact, ascending; none on an obstacle.
fn pair_of(contact: &ModelContact, of: &[Vec<ElementId>]) -> Option<[usize; 2]> {
    let body = |surface: &Surface| body_of(surface.faces.first()?.parent, of);
    let ModelTarget::Surface(primary) = &contact.primary else {
        return None;
    };
    let mut pair = [body(&contact.secondary)?, body(primary)?];
    pair.sort_unstable();
    Some(pair)
}

fn shares_nodes(one: &Surface, other: &Surface) -> bool {
    one.nodes.iter().any(|node| other.index_of(*node).is_some())
}
