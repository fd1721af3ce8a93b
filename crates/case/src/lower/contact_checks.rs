//! Contacts of a built system: what can never act, and what is strange without being wrong.

use carom_contact::law::{Reading, Restitution, Velocity};
use carom_contact::{Law, Shape, Sliding, Target};
use carom_dynamics::{Certificate, System};

use super::advice;
use super::context::Context;
use super::laws::Spring;
use super::problems::Problems;
use crate::accelerations::accelerations;
use crate::error::Problem;
use crate::facts::approach;
use crate::schema::{self, Scheme};

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
    for (k, contact) in system.contacts.iter().enumerate() {
        let secondary = contact.secondary_body;
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
        let start = &system.initial.displacement;
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

/// Warns where bodies fly towards each other and meet in the run, with no contact between them.
fn warn_of_meetings(context: &Context, system: &System, problems: &mut Problems) {
    let time = &context.case.time;
    if time.is_static() {
        return;
    }
    let ahead = Certificate::ahead(system, time.end.0);
    let Some((names, when)) = ahead.first() else {
        return;
    };
    let more = match ahead.len() {
        1 => String::new(),
        count => format!(", and {} more pairs", count - 1),
    };
    problems.warn(format!(
        "{names} meet at {when:.4e} s if they go on as they start{more}, and no contact is between them; give them a [contact.<name>], or take [general-contact]"
    ));
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
    warn_of_meetings(context, system, problems);
    for contact in &system.contacts {
        let name = &contact.name;
        let scheme = context.scheme_of(contact.secondary_body);
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

/// Speed of the fastest node at the start, m/s; infinite where nodes turn.
fn fastest(system: &System) -> f64 {
    let unknowns = &system.unknowns;
    let dim = system.dim;
    if (0..=unknowns.nodes()).any(|node| unknowns.first(node as u32) != dim * node) {
        return f64::INFINITY;
    }
    let square = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>();
    let nodes = system.initial.velocity.chunks(dim.max(1));
    nodes.map(square).fold(0.0, f64::max).sqrt()
}
