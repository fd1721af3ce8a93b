//! General contact: the outer sides of all bodies, each with each other and with itself.

use std::collections::{BTreeMap, BTreeSet};

use carom_contact::{Initial, Integration, Part as PartOfFace, Parts, Sliding};
use carom_dynamics::{ModelContact, ModelTarget};
use carom_mesh::{ElementId, Surface};

use super::contacts::{has_quadratic_faces, mortar};
use super::context::Context;
use super::general_sides::{self, Part, Scope, folds};
use super::laws::{self, sides};
use super::problems::Problems;
use super::zones;
use crate::error::Problem;
use crate::schema::{Basis, Friction, GeneralBy, GeneralContact, GivenLaw};

/// Contacts from which on a warning says that they are many: each looks for its points in each step.
const MANY: usize = 100;

/// What is in no contact with each other.
struct Apart {
    /// The body of each cell.
    owners: BTreeMap<ElementId, usize>,
    /// Pairs of bodies that something else joins, ascending.
    joined: BTreeSet<[usize; 2]>,
    /// Pairs of bodies that share nodes of their outer sides, ascending.
    shared: BTreeSet<[usize; 2]>,
}

/// The contacts of the general contact; it leaves out pairs that other contacts and joints join.
pub(super) fn lower(scope: &Scope, problems: &mut Problems) -> Vec<ModelContact> {
    let Some(given) = &scope.context.case.general_contact else {
        return Vec::new();
    };
    check_pairs(scope.context, given, problems);
    let mut parts = general_sides::parts(scope, problems);
    let apart = kept_apart(scope, &parts);
    if takes_materials(given, parts.len(), problems) {
        parts = general_sides::by_materials(scope, parts, problems);
    }
    let mut contacts = Vec::new();
    for (k, one) in parts.iter().enumerate() {
        for other in &parts[k..] {
            contacts.extend(between(scope, given, [one, other], &apart, problems));
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

/// Whether one contact takes all bodies of two materials: where the case says so, and where it says nothing and bodies are many.
fn takes_materials(given: &GeneralContact, bodies: usize, problems: &mut Problems) -> bool {
    let pairs = bodies * bodies.saturating_sub(1) / 2;
    if given.by.is_none() && pairs > MANY {
        problems.warn(format!(
            "general-contact: {pairs} pairs of bodies, so one contact takes all bodies of two materials; by = \"bodies\" tells what each two do to each other, with a search each"
        ));
    }
    match given.by {
        Some(by) => by == GeneralBy::Materials,
        None => pairs > MANY,
    }
}

/// What is in no contact with each other.
fn kept_apart(scope: &Scope, parts: &[Part]) -> Apart {
    let case = scope.context.case;
    let cells = scope.cells.iter().enumerate();
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
    for contact in scope.named {
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
        let group = scope.mesh.groups.get(group);
        let of_group = group
            .map(|group| scope.mesh.group_nodes(group))
            .unwrap_or_default();
        let known = of_group.iter().flat_map(|node| {
            let first = nodes.partition_point(|(other, _)| other < node);
            nodes[first..]
                .iter()
                .take_while(move |(other, _)| other == node)
        });
        known.map(|(_, body)| *body).collect()
    };
    for (_, given) in case.transition.iter() {
        match (&given.surfaces, &given.end, &given.face) {
            (Some([one, other]), _, _) | (None, Some(one), Some(other)) => {
                join(&with(one), &with(other));
            }
            _ => {}
        }
    }
    let body = |name: &String| -> BTreeSet<usize> {
        let place = case.body.names().position(|one| one == name);
        place.into_iter().collect()
    };
    for (_, given) in case.arlequin.iter() {
        join(&body(&given.inner), &body(&given.outer));
    }
    for (_, given) in case.interface.iter() {
        join(&body(&given.inner), &body(&given.outer));
    }
    Apart {
        owners,
        joined,
        shared,
    }
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

/// The contact between two bodies, or of a body with itself where it can fold; none between bodies that share nodes or that something
/// else joins. Of several bodies on a side those that do not touch are left out by pairs.
fn between(
    scope: &Scope,
    given: &GeneralContact,
    [one, other]: [&Part; 2],
    apart: &Apart,
    problems: &mut Problems,
) -> Option<ModelContact> {
    let case = scope.context.case;
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
    if case.contact.get(&name).is_some() || case.stop.get(&name).is_some() {
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
    let both = sides(scope.mesh, scope.bodies, &secondary.surface, &target);
    let first = secondary.surface.faces.first().map(|face| face.parent);
    let scheme = zones::scheme_at(scope.context, first, scope.cells);
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
    let plan = scope.context.plan;
    let zones = [one, other].map(|part| plan.zone_of(part.bodies[0]));
    let both_ways = (itself || zones[0] == zones[1])
        && !quadratic
        && !law.get().is_of_the_whole()
        && ([one, other].iter().any(|part| part.is_solid())
            || [one, other].iter().all(|part| part.is_shell()));
    let parts = many.then(|| apart.parts((secondary, primary), |body| folds(&scope.bodies[body])));
    Some(ModelContact {
        parts,
        sliding: Sliding::Finite,
        integration: match quadratic && !round {
            true => mortar(Basis::default()),
            false => Integration::Node,
        },
        friction: friction.unwrap_or_default(),
        initial: Initial::Touch,
        near_only: !deletes,
        both_ways: both_ways && !deletes,
        // surfaces around axes and middles have none, one that faces itself has its own
        depth: match round {
            true => None,
            false => depth.or((!itself && !deletes).then_some(thin)),
        },
        ..ModelContact::new(name, secondary.surface.clone(), target, law)
    })
}

impl Apart {
    /// The parts of a contact whose sides have several bodies. `folds`: whether a body may touch itself.
    fn parts(&self, (secondary, primary): (&Part, &Part), folds: impl Fn(usize) -> bool) -> Parts {
        let of = |part: &Part| -> Vec<PartOfFace> {
            let faces = part.surface.faces.iter();
            let owners = faces.map(|face| self.owners.get(&face.parent));
            let numbers = owners.map(|body| body.map_or(u32::MAX, |&body| body as u32));
            numbers.map(PartOfFace::of).collect()
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
