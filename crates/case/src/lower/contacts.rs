//! Contacts: surfaces on the bodies, no penetration at the start, advice.

use std::collections::{BTreeMap, BTreeSet};

use carom_bodies::Kinematics;
use carom_contact::law::Level;
use carom_contact::law::{Reading, Restitution, Side, Velocity};
use carom_contact::{Initial, Integration, Law, Shape, Sliding, Target};
use carom_dynamics::{ModelBody, ModelContact, ModelTarget, System};
use carom_mesh::{CellsByNode, ElementId, Face, Mesh, Surface};

use super::context::Context;
use super::laws::{self, Spring, sides};
use super::problems::Problems;
use super::{advice, discrete, obstacles, surfaces, zones};
use crate::accelerations::accelerations;
use crate::error::Problem;
use crate::facts::approach;
use crate::schema::{self, Basis, Friction, IntegrationName, IntegrationWith, Penetration, Scheme};

/// The contacts. `of`: cells of each body.
pub(super) fn lower(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    of: &[Vec<ElementId>],
    problems: &mut Problems,
) -> Vec<ModelContact> {
    let mut contacts = Vec::new();
    let cells = of.concat();
    let cells = CellsByNode::new(mesh, &cells);
    for (name, contact) in context.case.contact.iter() {
        let path = format!("contact.{name}");
        let mass = discrete::mass_surface(context, mesh, &contact.secondary);
        let at_point = mass.is_some();
        let secondary = mass.or_else(|| {
            let path = format!("{path}.secondary");
            surfaces::contact_surface(mesh, (bodies, &cells), &path, &contact.secondary, problems)
        });
        let primary = match (&contact.primary, &contact.obstacle) {
            (Some(primary), _) => surfaces::contact_surface(
                mesh,
                (bodies, &cells),
                &format!("{path}.primary"),
                primary,
                problems,
            )
            .map(ModelTarget::Surface),
            (None, Some(obstacle)) => obstacles::obstacle(context, mesh, &path, obstacle, problems)
                .map(ModelTarget::Rigid),
            // the schema lets pass nothing else than a surface that faces itself
            (None, None) => secondary.clone().map(ModelTarget::Surface),
        };
        let (Some(secondary), Some(primary)) = (secondary, primary) else {
            continue;
        };
        if contact.depth.is_some() && secondary.faces.iter().any(Face::is_round) {
            let message =
                "a depth means nothing to surfaces around axes of beams and middles of shells";
            let problem = Problem::new(format!("{path}.depth"), message);
            problems.push(problem.accepted(["no `depth`"]));
            continue;
        }
        let sides = sides(mesh, bodies, &secondary, &primary);
        let scheme = zones::scheme_at(context, secondary.faces.first().map(|face| face.parent), of);
        let Some(law) = laws::law(name, &contact.law, (&sides, &scheme), problems) else {
            continue;
        };
        if at_point && !discrete::acts_at_a_point(&path, &law, problems) {
            continue;
        }
        warn_of_areas(name, &law, sections(bodies, &secondary, &primary), problems);
        let sliding = match contact.sliding {
            // the default waits for what makes the steps linear or not
            Some(schema::Sliding::Small) | None => Sliding::Small,
            Some(schema::Sliding::Finite) => Sliding::Finite,
        };
        let quadratic = has_quadratic_faces(&secondary, &primary);
        warn_of_nodes(name, contact.integration, quadratic, problems);
        let integration = match contact.integration {
            Some(given) => integration(given, &law, &sides),
            None if quadratic => mortar(Basis::default()),
            None => Integration::Node,
        };
        let moment_about = contact.moment_about.as_ref();
        let moment_about =
            moment_about.map(|point| problems.vector(mesh, &format!("{path}.moment-about"), point));
        contacts.push(ModelContact {
            name: name.to_string(),
            secondary,
            primary,
            law,
            sliding,
            integration,
            massless: contact.nodes == schema::Nodes::Massless,
            friction: contact
                .friction
                .map_or(0.0, |Friction::Coulomb(coefficient)| coefficient),
            // a contact that may not penetrate is looked at here, where more can be said
            initial: match contact.initial {
                Penetration::Refuse => Initial::Touch,
                Penetration::Keep => Initial::Keep,
                Penetration::Offset => Initial::Offset,
                Penetration::Remove => Initial::Remove,
            },
            depth: contact.depth.map(|depth| depth.0),
            near_only: false,
            parts: None,
            moment_about,
            merge_within: contact.merge_within.map(|time| time.0),
        });
    }
    contacts
}

/// Warns where a step is too long for the spring of a damped law: 2 sqrt(k h/E) CFL > 2. An explicit scheme has its
/// critical step.
fn warn_of_springs(system: &System, springs: &[Spring], problems: &mut Problems) {
    for Spring { contact, rate } in springs {
        let value = rate * system.dt;
        // h / c, the step of Courant number 1, is at the bound for the default stiffness
        if value > 2.0 * (1.0 + 1e-9) && !system.scheme.get().is_explicit() {
            problems.doubt(format!(
                "contact `{contact}`: the damped law is too stiff for the step, 2 sqrt(k h/E) CFL = {value:.3} instead of at most 2; take a step of at most {:.4e} s or a stiffness {:.3} times as large",
                system.dt * 2.0 / value,
                (2.0 / value).powi(2)
            ));
        }
    }
}

/// Warns where bodies come nearer in a step by more than an element: nothing is looked at within a step, and what has left
/// a thin body on its far side faces it no more.
fn warn_of_speed(context: &Context, system: &System, problems: &mut Problems) {
    let (fastest, accelerations) = (fastest(system), accelerations(system));
    for (k, &(secondary, _)) in system.sides.iter().enumerate() {
        let zone = context.plan.zone_of(secondary);
        let parts = zone.map_or(1, |zone| context.plan.zones[zone].substeps);
        let dt = system.dt / f64::from(parts);
        let smallest = system.bodies[secondary].smallest_size();
        let middles = system.contacts[k].distance_of_middles();
        let thick = middles.unwrap_or(f64::INFINITY);
        let (element, what) = match thick < smallest {
            true => (thick, "distance of the middles that touch"),
            false => (smallest, "smallest element"),
        };
        let (element, what) = match round(&system.contacts[k].target) {
            Some(diameter) if diameter < element => (diameter, "diameter of the obstacle"),
            _ => (element, what),
        };
        // both sides at the speed of the fastest node: most cases need no pairing to tell
        if !system.contacts[k].moves() && 2.0 * fastest * dt <= element {
            continue;
        }
        let start = &system.initial_displacement;
        let way = approach(system, &accelerations, (k, start)).speed * dt;
        if way > element {
            problems.doubt(format!(
                "contact `{}`: in a step its sides approach by {way:.4e} m, more than the {what} of `{}` ({element:.4e} m), and may pass through each other; take a step of at most {:.4e} s",
                system.contacts[k].name,
                system.bodies[secondary].name(),
                system.dt * element / way
            ));
        }
    }
}

/// Warns where a law per area acts on the larger of two sections: the areas are those of the secondary side.
fn warn_of_areas(name: &str, law: &Law, sections: Option<[f64; 2]>, problems: &mut Problems) {
    let per_area = matches!(law, Law::Damped(_) | Law::Penalty(_) | Law::Compliance(_));
    if let Some([secondary, primary]) = sections
        && per_area
        && secondary > primary * (1.0 + 1e-9)
    {
        problems.doubt(format!(
            "contact `{name}`: the {} law is per area, and its area is that of the secondary side, which is {:.4} times that of the primary one; make the side of the smaller section the secondary one, or give the law {:.4} times the value",
            law.get().name(),
            secondary / primary,
            primary / secondary
        ));
    }
}

/// Warns where forces at the nodes of quadratic faces are asked for: a uniform pressure gives the corners of a segment 1/6 of its
/// force and the middle 4/6, where they stand for 1/4 and 1/2 of its length; corners in space get nothing, or tension.
fn warn_of_nodes(
    name: &str,
    given: Option<schema::Integration>,
    quadratic: bool,
    problems: &mut Problems,
) {
    if quadratic && given == Some(schema::Integration::Named(IntegrationName::Node)) {
        problems.doubt(format!(
            "contact `{name}`: integration = \"node\" on quadratic faces: pressures oscillate by a third and more between corner and midside nodes; remove the key, or use integration = \"mortar\""
        ));
    }
}

/// Gives contacts that do not say how far they slide their default: finite where their sides may move far.
pub(super) fn default_sliding(context: &Context, contacts: &mut [ModelContact], far: &[bool]) {
    for (contact, far) in contacts.iter_mut().zip(far) {
        let given = context.case.contact.get(&contact.name);
        if *far && given.is_some_and(|given| given.sliding.is_none()) {
            contact.sliding = Sliding::Finite;
        }
    }
}

/// Refuses contacts between faces that another contact joins in the same way: their stiffnesses add up, and their
/// constraints are the same twice. Warns where the sides are exchanged.
pub(super) fn listed_twice(contacts: &[ModelContact], problems: &mut Problems) {
    let sides = Sides::of(contacts);
    for (k, contact) in contacts.iter().enumerate() {
        for other in sides
            .that_meet(contact, k)
            .into_iter()
            .map(|k| &contacts[k])
        {
            let same = shares_faces(&contact.secondary, &other.secondary)
                && match (&contact.primary, &other.primary) {
                    (ModelTarget::Rigid(one), ModelTarget::Rigid(two)) => one == two,
                    (ModelTarget::Surface(one), ModelTarget::Surface(two)) => {
                        shares_faces(one, two)
                    }
                    _ => false,
                };
            if same {
                let message = format!("the contact `{}` joins the same faces already", other.name);
                let problem = Problem::new(format!("contact.{}", contact.name), message);
                let problem = problem.found(format!("`{}` and `{}`", other.name, contact.name));
                problems.push(problem.accepted(["one contact for a pair of faces"]));
            } else if let (ModelTarget::Surface(one), ModelTarget::Surface(two)) =
                (&contact.primary, &other.primary)
                && shares_faces(&contact.secondary, two)
                && shares_faces(one, &other.secondary)
            {
                problems.warn(format!(
                    "contact `{}`: the contact `{}` joins the same faces with secondary and primary exchanged: stiffnesses of penalty laws add up, and constraints may have no unique forces",
                    contact.name, other.name
                ));
            }
        }
    }
}

/// Refuses contacts whose secondary surface has no area: forces per area and shares of it mean nothing there.
pub(super) fn with_area(context: &Context, system: &System, problems: &mut Problems) {
    for contact in &system.contacts {
        if contact.points.iter().any(|point| point.area > 0.0) {
            continue;
        }
        let path = format!("contact.{}.secondary", contact.name);
        let problem = Problem::new(
            path,
            "a surface without area: it lies on the axis of an axisymmetric body",
        );
        let problem = match context.case.contact.get(&contact.name) {
            Some(given) => problem.found(&given.secondary),
            None => problem,
        };
        problems.push(problem.accepted(["a surface off the axis"]));
    }
}

/// Refuses contacts that can never act: points that face nothing at their reference places face nothing ever, unless they slide
/// or the obstacle moves.
pub(super) fn able_to_act(system: &System, problems: &mut Problems) {
    let at_rest = vec![0.0; system.unknowns()];
    for (k, contact) in system.contacts.iter().enumerate() {
        if contact.sliding == Sliding::Finite || contact.moves() {
            continue;
        }
        // without motion all accelerations are zero too
        if approach(system, &at_rest, (k, &at_rest)).gap < f64::INFINITY {
            continue;
        }
        let message = "this contact can never act: at the start no point of the secondary surface has an opposite face, and small sliding does not pair points again";
        let problem = Problem::new(format!("contact.{}", contact.name), message);
        let problem = problem.found("sliding = \"small\"");
        problems.push(problem.accepted(["sliding = \"finite\"", "surfaces that face each other"]));
    }
}

/// What is strange about contacts and schemes, without being wrong.
pub(super) fn advise(
    context: &Context,
    system: &System,
    springs: &[Spring],
    problems: &mut Problems,
) {
    if context.plan.zones.is_empty() {
        warn_of_springs(system, springs, problems);
    }
    warn_of_speed(context, system, problems);
    for (contact, (secondary, _)) in system.contacts.iter().zip(&system.sides) {
        let name = &contact.name;
        let scheme = context.scheme_of(*secondary);
        if let Law::Velocity(Velocity {
            reading: Reading::AsPrinted,
            ..
        }) = contact.law
        {
            problems.doubt(format!(
                "contact `{name}`: with sign = \"as-printed\" bodies pass through each other"
            ));
        }
        if let (Law::Restitution(Restitution { coefficient, .. }), Scheme::Theta(theta)) =
            (contact.law, &scheme)
            && theta.theta * (1.0 + coefficient) > 1.0
        {
            problems.warn(format!(
                "contact `{name}`: impacts can gain energy where theta is above 1 / (1 + e) = {:.4}",
                1.0 / (1.0 + coefficient)
            ));
        }
        if !context.case.time.is_static() {
            let given = context.case.contact.get(name);
            let massless = given.is_some_and(|of| of.nodes == schema::Nodes::Massless);
            let against = advice::against(&scheme, &contact.law, massless);
            for reason in against {
                problems.warn(format!(
                    "contact `{name}`: {reason}; use the velocity law with the theta scheme"
                ));
            }
        }
    }
}

/// Diameter of an obstacle that a body may pass on its far side, m.
fn round(target: &Target) -> Option<f64> {
    match target {
        Target::Rigid(obstacle) => match &obstacle.shape {
            Shape::Sphere(sphere) => Some(2.0 * sphere.radius),
            Shape::Cylinder(cylinder) => Some(2.0 * cylinder.radius),
            Shape::Plane(_) | Shape::Profile(_) | Shape::Surface(_) => None,
        },
        Target::Surface(_) => None,
    }
}

/// The section of a bar (m²) or the thickness of a plane body (m) on both sides of a contact; none on an obstacle, and where
/// bodies have none.
fn sections(bodies: &[ModelBody], secondary: &Surface, primary: &ModelTarget) -> Option<[f64; 2]> {
    let ModelTarget::Surface(primary) = primary else {
        return None;
    };
    let section = |surface: &Surface| {
        let parent = surface.faces.first()?.parent;
        let owner = |body: &&ModelBody| body.spec.cells.binary_search(&parent).is_ok();
        match bodies.iter().find(owner)?.spec.kinematics {
            Kinematics::Axisymmetric | Kinematics::Solid => None,
            other => Some(other.surface_factor(&[0.0; 3])),
        }
    };
    Some([section(secondary)?, section(primary)?])
}

/// Whether two surfaces have a face in common.
fn shares_faces(one: &Surface, two: &Surface) -> bool {
    let of_one: BTreeSet<Vec<u32>> = one.faces.iter().map(sorted_nodes).collect();
    let mut of_two = two.faces.iter().map(sorted_nodes);
    of_two.any(|face| of_one.contains(&face))
}

fn sorted_nodes(face: &Face) -> Vec<u32> {
    let mut nodes = face.corners().to_vec();
    nodes.sort_unstable();
    nodes
}

/// Contacts by the faces of their sides.
struct Sides(BTreeMap<Vec<u32>, Vec<usize>>);

impl Sides {
    fn of(contacts: &[ModelContact]) -> Sides {
        let mut sides = BTreeMap::new();
        for (k, contact) in contacts.iter().enumerate() {
            let primary = match &contact.primary {
                ModelTarget::Surface(surface) => &surface.faces[..],
                ModelTarget::Rigid(_) => &[],
            };
            for face in contact.secondary.faces.iter().chain(primary) {
                let of: &mut Vec<usize> = sides.entry(sorted_nodes(face)).or_default();
                if of.last() != Some(&k) {
                    of.push(k);
                }
            }
        }
        Sides(sides)
    }

    /// Contacts before the `k`-th that have a face of its secondary side, ascending.
    fn that_meet(&self, contact: &ModelContact, k: usize) -> BTreeSet<usize> {
        let faces = contact.secondary.faces.iter().map(sorted_nodes);
        let of = faces.filter_map(|face| self.0.get(&face));
        of.flatten().copied().filter(|other| *other < k).collect()
    }
}

/// Whether a side of a contact has quadratic faces.
pub(super) fn has_quadratic_faces(secondary: &Surface, primary: &ModelTarget) -> bool {
    let primary = match primary {
        ModelTarget::Surface(surface) => &surface.faces[..],
        ModelTarget::Rigid(_) => &[],
    };
    let mut faces = secondary.faces.iter().chain(primary);
    faces.any(|face| face.kind.table().is_quadratic())
}

/// Where the law holds: at Gauss points in its weak form if there is a multiplier, r from the softer side unless given.
fn integration(given: schema::Integration, law: &Law, sides: &[Side]) -> Integration {
    let given = match given {
        schema::Integration::Named(IntegrationName::Node) => return Integration::Node,
        schema::Integration::Named(IntegrationName::Quadrature) => None,
        schema::Integration::With(IntegrationWith::Quadrature(quadrature)) => Some(quadrature),
        schema::Integration::Named(IntegrationName::Mortar) => return mortar(Basis::default()),
        schema::Integration::With(IntegrationWith::Mortar(mortared)) => {
            return mortar(mortared.basis);
        }
    };
    if law.is_function() {
        return Integration::Points;
    }
    let soft = &sides[0];
    let r = match law.get().level() {
        Level::Gap | Level::GapAndRate => given
            .and_then(|quadrature| quadrature.r)
            .map_or(soft.young / soft.size, |r| r.0),
        Level::Rate => given
            .and_then(|quadrature| quadrature.r_v)
            .map_or(soft.impedance, |r| r.0),
    };
    Integration::Weak { r }
}

pub(super) fn mortar(basis: Basis) -> Integration {
    Integration::Mortar {
        basis: match basis {
            Basis::Dual => carom_contact::Basis::Dual,
            Basis::Standard => carom_contact::Basis::Standard,
        },
    }
}

/// Speed of the fastest node at the start, m/s; infinite where nodes turn.
fn fastest(system: &System) -> f64 {
    let unknowns = &system.unknowns;
    let dim = system.dim;
    if (0..=unknowns.nodes()).any(|node| unknowns.first(node as u32) != dim * node) {
        return f64::INFINITY;
    }
    let square = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>();
    let nodes = system.initial_velocity.chunks(dim.max(1));
    nodes.map(square).fold(0.0, f64::max).sqrt()
}
