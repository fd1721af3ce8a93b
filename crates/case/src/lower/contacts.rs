//! Contacts: surfaces on the bodies, no penetration at the start, advice.

use std::collections::{BTreeMap, BTreeSet};

use carom_bodies::Kinematics;
use carom_contact::law::Level;
use carom_contact::law::{Reading, Restitution, Side, Velocity};
use carom_contact::{Initial, Integration, Law, Shape, Sliding, Target};
use carom_dynamics::{ModelBody, ModelContact, ModelTarget, System};
use carom_mesh::{CellsByNode, ElementId, Face, Mesh, Surface};

use super::laws::sides;
use super::{Builder, advice};
use crate::accelerations::accelerations;
use crate::error::Problem;
use crate::facts::approach;
use crate::schema::{self, Basis, Friction, IntegrationName, IntegrationWith, Penetration, Scheme};

impl Builder<'_> {
    /// The contacts. `of`: cells of each body.
    pub(super) fn contacts(
        &mut self,
        mesh: &Mesh,
        bodies: &[ModelBody],
        of: &[Vec<ElementId>],
    ) -> Vec<ModelContact> {
        let mut contacts = Vec::new();
        let cells = of.concat();
        let cells = CellsByNode::new(mesh, &cells);
        for (name, contact) in self.case.contact.iter() {
            let path = format!("contact.{name}");
            let mass = self.mass_surface(mesh, &contact.secondary);
            let at_point = mass.is_some();
            let secondary = mass.or_else(|| {
                let path = format!("{path}.secondary");
                self.contact_surface(mesh, (bodies, &cells), &path, &contact.secondary)
            });
            let primary = match (&contact.primary, &contact.obstacle) {
                (Some(primary), _) => self
                    .contact_surface(mesh, (bodies, &cells), &format!("{path}.primary"), primary)
                    .map(ModelTarget::Surface),
                (None, Some(obstacle)) => {
                    self.obstacle(mesh, &path, obstacle).map(ModelTarget::Rigid)
                }
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
                self.problems.push(problem.accepted(["no `depth`"]));
                continue;
            }
            let sides = sides(mesh, bodies, &secondary, &primary);
            let scheme = self.scheme_at(secondary.faces.first().map(|face| face.parent), of);
            let Some(law) = self.law(name, &contact.law, (&sides, &scheme)) else {
                continue;
            };
            if at_point && !self.acts_at_a_point(&path, &law) {
                continue;
            }
            self.warn_of_areas(name, &law, sections(bodies, &secondary, &primary));
            let sliding = match contact.sliding {
                // the default waits for what makes the steps linear or not
                Some(schema::Sliding::Small) | None => Sliding::Small,
                Some(schema::Sliding::Finite) => Sliding::Finite,
            };
            let quadratic = has_quadratic_faces(&secondary, &primary);
            self.warn_of_nodes(name, contact.integration, quadratic);
            let integration = match contact.integration {
                Some(given) => integration(given, &law, &sides),
                None if quadratic => mortar(Basis::default()),
                None => Integration::Node,
            };
            let moment_about = contact.moment_about.as_ref();
            let moment_about =
                moment_about.map(|point| self.vector(mesh, &format!("{path}.moment-about"), point));
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

    pub(super) fn surface(
        &mut self,
        mesh: &Mesh,
        cells: &[ElementId],
        path: &str,
        name: &str,
    ) -> Option<Surface> {
        let group = self.group(mesh, path, name)?;
        // beams beside solids: only cells of one dimension more can have the sides
        let dim = |cell: &&ElementId| mesh.kind(**cell).table().dim == group.dim + 1;
        let over: Vec<ElementId> = cells.iter().filter(dim).copied().collect();
        let over = if over.is_empty() { cells } else { &over };
        match Surface::new(mesh, group, over) {
            Ok(surface) => Some(surface),
            Err(error) => {
                let problem = Problem::new(path, error.to_string()).found(name);
                self.problems
                    .push(problem.accepted(["a group of outer sides of bodies"]));
                None
            }
        }
    }

    /// Warns where a step is too long for the spring of a damped law: 2 sqrt(k h/E) CFL > 2. An explicit scheme has its
    /// critical step.
    fn warn_of_springs(&mut self, system: &System) {
        for (name, rate) in std::mem::take(&mut self.springs) {
            let value = rate * system.dt;
            // h / c, the step of Courant number 1, is at the bound for the default stiffness
            if value > 2.0 * (1.0 + 1e-9) && !system.scheme.get().is_explicit() {
                self.doubt(format!(
                    "contact `{name}`: the damped law is too stiff for the step, 2 sqrt(k h/E) CFL = {value:.3} instead of at most 2; take a step of at most {:.4e} s or a stiffness {:.3} times as large",
                    system.dt * 2.0 / value,
                    (2.0 / value).powi(2)
                ));
            }
        }
    }

    /// Warns where bodies come nearer in a step by more than an element: nothing is looked at within a step, and what has left
    /// a thin body on its far side faces it no more.
    fn warn_of_speed(&mut self, system: &System) {
        let (fastest, accelerations) = (fastest(system), accelerations(system));
        for (k, &(secondary, _)) in system.sides.iter().enumerate() {
            let zone = self.plan.zone_of(secondary);
            let parts = zone.map_or(1, |zone| self.plan.zones[zone].substeps);
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
                self.doubt(format!(
                    "contact `{}`: in a step its sides approach by {way:.4e} m, more than the {what} of `{}` ({element:.4e} m), and may pass through each other; take a step of at most {:.4e} s",
                    system.contacts[k].name,
                    system.bodies[secondary].name(),
                    system.dt * element / way
                ));
            }
        }
    }

    /// Warns where a law per area acts on the larger of two sections: the areas are those of the secondary side.
    fn warn_of_areas(&mut self, name: &str, law: &Law, sections: Option<[f64; 2]>) {
        let per_area = matches!(law, Law::Damped(_) | Law::Penalty(_) | Law::Compliance(_));
        if let Some([secondary, primary]) = sections
            && per_area
            && secondary > primary * (1.0 + 1e-9)
        {
            self.doubt(format!(
                "contact `{name}`: the {} law is per area, and its area is that of the secondary side, which is {:.4} times that of the primary one; make the side of the smaller section the secondary one, or give the law {:.4} times the value",
                law.get().name(),
                secondary / primary,
                primary / secondary
            ));
        }
    }

    /// Warns where forces at the nodes of quadratic faces are asked for: a uniform pressure gives the corners of a segment 1/6 of its
    /// force and the middle 4/6, where they stand for 1/4 and 1/2 of its length; corners in space get nothing, or tension.
    fn warn_of_nodes(&mut self, name: &str, given: Option<schema::Integration>, quadratic: bool) {
        if quadratic && given == Some(schema::Integration::Named(IntegrationName::Node)) {
            self.doubt(format!(
                "contact `{name}`: integration = \"node\" on quadratic faces: pressures oscillate by a third and more between corner and midside nodes; remove the key, or use integration = \"mortar\""
            ));
        }
    }

    /// Gives contacts that do not say how far they slide their default: finite where their sides may move far.
    pub(super) fn default_sliding(&self, contacts: &mut [ModelContact], far: &[bool]) {
        for (contact, far) in contacts.iter_mut().zip(far) {
            let given = self.case.contact.get(&contact.name);
            if *far && given.is_some_and(|given| given.sliding.is_none()) {
                contact.sliding = Sliding::Finite;
            }
        }
    }

    /// Refuses contacts between faces that another contact joins in the same way: their stiffnesses add up, and their
    /// constraints are the same twice. Warns where the sides are exchanged.
    pub(super) fn listed_twice(&mut self, contacts: &[ModelContact]) {
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
                    let message =
                        format!("the contact `{}` joins the same faces already", other.name);
                    let problem = Problem::new(format!("contact.{}", contact.name), message);
                    self.problems.push(
                        problem
                            .found(format!("`{}` and `{}`", other.name, contact.name))
                            .accepted(["one contact for a pair of faces"]),
                    );
                } else if let (ModelTarget::Surface(one), ModelTarget::Surface(two)) =
                    (&contact.primary, &other.primary)
                    && shares_faces(&contact.secondary, two)
                    && shares_faces(one, &other.secondary)
                {
                    self.warnings.push(format!(
                        "contact `{}`: the contact `{}` joins the same faces with secondary and primary exchanged: stiffnesses of penalty laws add up, and constraints may have no unique forces",
                        contact.name, other.name
                    ));
                }
            }
        }
    }

    /// Refuses contacts whose secondary surface has no area: forces per area and shares of it mean nothing there.
    pub(super) fn with_area(&mut self, system: &System) {
        for contact in &system.contacts {
            if contact.points.iter().any(|point| point.area > 0.0) {
                continue;
            }
            let path = format!("contact.{}.secondary", contact.name);
            let problem = Problem::new(
                path,
                "a surface without area: it lies on the axis of an axisymmetric body",
            );
            let problem = match self.case.contact.get(&contact.name) {
                Some(given) => problem.found(&given.secondary),
                None => problem,
            };
            self.problems
                .push(problem.accepted(["a surface off the axis"]));
        }
    }

    /// Refuses contacts that can never act: points that face nothing at their reference places face nothing ever, unless they slide
    /// or the obstacle moves.
    pub(super) fn able_to_act(&mut self, system: &System) {
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
            self.problems.push(
                problem
                    .found("sliding = \"small\"")
                    .accepted(["sliding = \"finite\"", "surfaces that face each other"]),
            );
        }
    }

    /// What is strange about contacts and schemes, without being wrong.
    pub(super) fn advise(&mut self, system: &System) {
        if self.plan.zones.is_empty() {
            self.warn_of_springs(system);
        }
        self.warn_of_speed(system);
        for (contact, (secondary, _)) in system.contacts.iter().zip(&system.sides) {
            let name = &contact.name;
            let zone = self.plan.zone_of(*secondary);
            let scheme = zone.map_or(self.case.time.scheme(), |zone| self.plan.zones[zone].scheme);
            if let Law::Velocity(Velocity {
                reading: Reading::AsPrinted,
                ..
            }) = contact.law
            {
                self.doubt(format!(
                    "contact `{name}`: with sign = \"as-printed\" bodies pass through each other"
                ));
            }
            if let (Law::Restitution(Restitution { coefficient, .. }), Scheme::Theta(theta)) =
                (contact.law, &scheme)
                && theta.theta * (1.0 + coefficient) > 1.0
            {
                self.warnings.push(format!(
                    "contact `{name}`: impacts can gain energy where theta is above 1 / (1 + e) = {:.4}",
                    1.0 / (1.0 + coefficient)
                ));
            }
            if !self.case.time.is_static() {
                let given = self.case.contact.get(name);
                let massless = given.is_some_and(|of| of.nodes == schema::Nodes::Massless);
                let against = advice::against(&scheme, &contact.law, massless);
                let told = against.map(|reason| {
                    format!(
                        "contact `{name}`: {reason}; use the velocity law with the theta scheme"
                    )
                });
                self.warnings.extend(told);
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
