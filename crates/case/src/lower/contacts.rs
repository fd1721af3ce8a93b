//! Contacts: surfaces on the bodies, laws, integration.

use carom_bodies::{Kinematics, height};
use carom_contact::law::Level;
use carom_contact::law::Side;
use carom_contact::{Initial, Integration, Law, Sight, Sliding};
use carom_dynamics::{Model, ModelBody, ModelContact, ModelTarget};
use carom_mesh::{CellsByNode, ElementId, Face, Mesh, Surface};

use super::context::Context;
use super::laws::{self, sides};
use super::problems::Problems;
use super::{discrete, lookup, obstacles, surfaces, zones};
use crate::error::Problem;
use crate::schema::{self, Basis, IntegrationName, IntegrationWith, Penetration};

/// The bodies on which contacts are.
struct Bodies<'a> {
    mesh: &'a Mesh,
    bodies: &'a [ModelBody],
    /// Cells of each.
    of: &'a [Vec<ElementId>],
    cells: CellsByNode<'a>,
}

/// The contacts. `of`: cells of each body.
pub(super) fn lower(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    of: &[Vec<ElementId>],
    problems: &mut Problems,
) -> Vec<ModelContact> {
    let cells = of.concat();
    let bodies = Bodies {
        mesh,
        bodies,
        of,
        cells: CellsByNode::new(mesh, &cells),
    };
    let contacts = context.case.contact.iter();
    let contacts = contacts.map(|(name, given)| contact(context, &bodies, name, given, problems));
    contacts.flatten().collect()
}

/// One contact.
fn contact(
    context: &Context,
    on: &Bodies,
    name: &str,
    given: &schema::Contact,
    problems: &mut Problems,
) -> Option<ModelContact> {
    let (mesh, bodies) = (on.mesh, on.bodies);
    let path = format!("contact.{name}");
    let mut surface = |key: &str, name: &str| {
        let path = format!("{path}.{key}");
        surfaces::contact_surface(mesh, (bodies, &on.cells), &path, name, problems)
    };
    let mass = discrete::mass_surface(context, mesh, &given.secondary);
    let at_point = mass.is_some();
    let secondary = mass.or_else(|| surface("secondary", &given.secondary));
    let primary = match (&given.primary, &given.obstacle) {
        (Some(primary), _) => surface("primary", primary).map(ModelTarget::Surface),
        (None, Some(obstacle)) => {
            obstacles::obstacle(context, mesh, &path, obstacle, problems).map(ModelTarget::Rigid)
        }
        // the schema lets pass nothing else than a surface that faces itself
        (None, None) => secondary.clone().map(ModelTarget::Surface),
    };
    let (secondary, primary) = (secondary?, primary?);
    if given.depth.is_some() && secondary.faces.iter().any(Face::is_round) {
        let message =
            "a depth means nothing to surfaces around axes of beams and middles of shells";
        let problem = Problem::new(format!("{path}.depth"), message);
        return problems.refuse(problem.accepted(["no `depth`"]));
    }
    let sides = sides(mesh, bodies, &secondary, &primary);
    let first = secondary.faces.first().map(|face| face.parent);
    let scheme = zones::scheme_at(context, first, on.of);
    let law = laws::law(name, &given.law, (&sides, &scheme), problems)?;
    if at_point && !discrete::acts_at_a_point(&path, &law, problems) {
        return None;
    }
    warn_of_areas(name, &law, sections(bodies, &secondary, &primary), problems);
    let quadratic = has_quadratic_faces(&secondary, &primary);
    warn_of_nodes(name, given.integration, quadratic, problems);
    let integration = match given.integration {
        Some(given) => integration(given, &law, &sides),
        None if quadratic => mortar(Basis::default()),
        None => Integration::Node,
    };
    let moment_about = given.moment_about.as_ref();
    let moment_about =
        moment_about.map(|point| problems.vector(mesh, &format!("{path}.moment-about"), point));
    Some(ModelContact {
        // the default waits for what makes the steps linear or not
        sliding: match given.sliding {
            Some(schema::Sliding::Small) | None => Sliding::Small,
            Some(schema::Sliding::Finite) => Sliding::Finite,
        },
        integration,
        massless: given.nodes == schema::Nodes::Massless,
        friction: given.friction.unwrap_or_default(),
        // a contact that may not penetrate is looked at here, where more can be said
        initial: match given.initial {
            Penetration::Refuse => Initial::Touch,
            Penetration::Keep => Initial::Keep,
            Penetration::Offset => Initial::Offset,
            Penetration::Remove => Initial::Remove,
        },
        depth: given.depth.map(|depth| depth.0),
        moment_about,
        merge_within: given.merge_within.map(|time| time.0),
        ..ModelContact::new(name, secondary, primary, law)
    })
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

/// Lets contacts between solids and shells that follow their motion be looked for both ways, at nodes, where no cells are deleted; in models without zones.
pub(super) fn look_both_ways(context: &Context, model: &mut Model) {
    let Model {
        contacts,
        bodies,
        mesh,
        ..
    } = model;
    let owner = |face: &Face| {
        let has = |body: &ModelBody| body.spec.cells.contains(&face.parent);
        bodies.iter().position(has)
    };
    for contact in contacts {
        let named = context.case.contact.get(&contact.name);
        let ModelTarget::Surface(primary) = &contact.primary else {
            continue;
        };
        let plain = |face: &Face| {
            let table = face.kind.table();
            let is_solid = face.radius.is_none() && table.dim > 0;
            let is_shell = face.is_round() && table.dim == 2;
            (is_solid || is_shell) && !table.is_quadratic()
        };
        let sides = [&contact.secondary, primary];
        let fits = named.is_some()
            && contact.sliding == Sliding::Finite
            && contact.integration == Integration::Node
            // the shares of the points of one side add up to the whole
            && !contact.law.get().is_of_the_whole()
            // what overlaps is let out at any depth
            && contact.initial == Initial::Touch
            && sides.iter().all(|side| side.faces.iter().all(plain))
            && !Sight::is_needed(&contact.secondary.faces, &primary.faces);
        if !fits {
            continue;
        }
        let of = sides.map(|side| side.faces.first().and_then(owner));
        let [Some(one), Some(other)] = of else {
            continue;
        };
        let deletes = [one, other]
            .iter()
            .any(|&body| bodies[body].spec.deletion.is_some());
        if deletes {
            continue;
        }
        contact.both_ways = true;
        let mut faces = sides.iter().flat_map(|side| &side.faces);
        // around middles it is left to the surfaces
        if contact.depth.is_none() && faces.all(|face| face.radius.is_none()) {
            let faces = sides.iter().flat_map(|side| &side.faces);
            let heights = faces.map(|face| height(mesh, face.parent, face.kind, face.corners()));
            contact.depth = Some(heights.fold(f64::INFINITY, f64::min));
        }
    }
}

/// The section of a bar (m²) or the thickness of a plane body (m) on both sides of a contact; none on an obstacle, and where
/// bodies have none.
fn sections(bodies: &[ModelBody], secondary: &Surface, primary: &ModelTarget) -> Option<[f64; 2]> {
    let ModelTarget::Surface(primary) = primary else {
        return None;
    };
    let section = |surface: &Surface| match lookup::body_behind(bodies, surface)?.spec.kinematics {
        Kinematics::Axisymmetric | Kinematics::Solid => None,
        other => Some(other.surface_factor(&[0.0; 3])),
    };
    Some([section(secondary)?, section(primary)?])
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
