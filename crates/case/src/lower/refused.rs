//! Errors of the library as problems of the case, each at its key.

use carom_dynamics::{Error, Refused};
use carom_system::Error as Refusal;

use super::context::Context;
use crate::error::Problem;
use crate::schema::{self, Section};

/// The problem behind an error of the system or of its first step.
pub(super) fn by_step(context: &Context, error: &Error) -> Problem {
    match error {
        Error::System(error) => refused_system(context, error),
        Error::Body(cause) => refused_body(cause),
        Error::WeakForm { contact, .. } => {
            Problem::new(format!("contact.{contact}.integration"), error.to_string())
        }
        Error::FreeMotion {
            body,
            motion,
            constraints,
        } => {
            let joined = match &constraints[..] {
                [] => String::new(),
                names => format!(", which constraint `{}` leaves free", names.join("`, `")),
            };
            let message = format!(
                "in a static stage the body `{body}` can {motion} without any force{joined}"
            );
            Problem::new("time.static", message).accepted([
                "supports that hold it",
                "a contact that may hold it",
                "no static stage",
            ])
        }
        other => Problem::new("time", other.to_string()),
    }
}

/// The problem behind an error of zones.
pub(super) fn by_zones(context: &Context, error: &carom_zones::Error) -> Problem {
    use carom_zones::Error;
    match error {
        Error::Dynamics(error) => by_step(context, error),
        Error::System(error) => refused_system(context, error),
        Error::AcrossZones { contact, .. } => {
            Problem::new(format!("contact.{contact}"), error.to_string()).accepted([
                "one zone for both sides",
                "zones of equal steps and of one scheme",
                "integration at nodes or by mortar, nodes with mass and no projection",
            ])
        }
        Error::Zone { zone, cause } => refused_zone(context, zone, cause),
        Error::DiscreteInZones { element, .. } => {
            let path = match context.case.spring.get(element) {
                Some(_) => format!("spring.{element}.ends"),
                None if context.case.dashpot.get(element).is_some() => {
                    format!("dashpot.{element}.ends")
                }
                None => format!("mass.{element}.on"),
            };
            let problem = Problem::new(path, error.to_string());
            problem.accepted(["nodes of one zone", "substeps = 1"])
        }
        Error::Substeps { zone, found, .. } => {
            Problem::new(format!("zone.{zone}"), error.to_string()).found(found)
        }
        Error::LinkScheme { zone, scheme, .. } => {
            let given = context.plan.zones.iter().find(|own| own.name == *zone);
            let path = given.map_or("time.scheme", |own| &own.scheme_path);
            Problem::new(path, error.to_string())
                .found(*scheme)
                .accepted(["equal steps", "another scheme"])
        }
        other => Problem::new("time", other.to_string()),
    }
}

/// The problem behind an error of building the system.
fn refused_system(context: &Context, error: &Refusal) -> Problem {
    match error {
        Refusal::Body(cause) => refused_body(cause),
        Refusal::Unstable { dt, critical } => {
            let problem = Problem::new(
                "time.step",
                "the step is above the critical step of the explicit scheme",
            );
            let [found, most] = apart(*dt, *critical);
            problem.found(format!("{found} s")).accepted([
                format!("at most {most} s"),
                "step = { critical = 0.9 }".to_string(),
            ])
        }
        Refusal::Projection { contact } => Problem::new(
            format!("contact.{contact}.law.displacement.projection"),
            error.to_string(),
        ),
        Refusal::MasslessContact { contact, .. } => {
            Problem::new(format!("contact.{contact}.nodes"), error.to_string())
        }
        Refusal::Integration { contact, .. } => {
            Problem::new(format!("contact.{contact}.integration"), error.to_string())
        }
        Refusal::MomentAbout { contact, .. } => {
            let path = format!("contact.{contact}.moment-about");
            Problem::new(path, error.to_string()).accepted(["no `moment-about`"])
        }
        Refusal::LumpedBeam { body } => {
            let problem = Problem::new(format!("body.{body}.mass"), error.to_string());
            problem.accepted(["consistent"])
        }
        Refusal::Massless { body, .. } => {
            let path = match context.case.body.get(body) {
                Some(_) => format!("body.{body}.mass"),
                None => format!("mass.{body}"),
            };
            Problem::new(path, error.to_string())
        }
        Refusal::NoMass { element, .. } => {
            let path = match context.case.spring.get(element) {
                Some(_) => format!("spring.{element}.ends"),
                None if context.case.pretension.get(element).is_some() => {
                    format!("pretension.{element}.ends")
                }
                None => format!("dashpot.{element}.ends"),
            };
            Problem::new(path, error.to_string())
        }
        Refusal::Penetration { contact, .. } => {
            Problem::new(format!("contact.{contact}.initial"), error.to_string())
        }
        Refusal::BetweenSchemes { contact, .. } => {
            Problem::new(format!("contact.{contact}"), error.to_string()).accepted([
                "one zone for both sides",
                "zones of equal steps and of one scheme",
                "integration at nodes or by mortar, nodes with mass and no projection",
            ])
        }
        Refusal::SchemesOfPart { body, .. } => {
            Problem::new(format!("body.{body}"), error.to_string())
        }
        Refusal::TurningRows { link, .. } => {
            let problem = Problem::new(path_of_link(context, link), error.to_string());
            problem.accepted(["supports that hold no node of the link in both bodies"])
        }
        Refusal::Nonlinear { what, why } => refused_nonlinear(context, what, why),
        other => Problem::new("time", other.to_string()),
    }
}

/// The problem behind what a model whose forces are not all linear does not accept.
fn refused_nonlinear(context: &Context, what: &Refused, why: &str) -> Problem {
    let path = match what {
        Refused::StaticStage => "time.static".to_string(),
        Refused::Iterative => "time.solver".to_string(),
        Refused::Integration(contact) => format!("contact.{contact}.integration"),
        Refused::Damping(body) => format!("body.{body}.damping.stiffness"),
        Refused::ModalDamping(body) => format!("body.{body}.damping.modal"),
        Refused::Motion { .. } => "support".to_string(),
        Refused::Load { .. } => "load".to_string(),
        Refused::TurningLink(link) => path_of_link(context, link),
        Refused::NodalLoad(load) => format!("load.{load}"),
        Refused::Rigid(body) => format!("body.{body}.rigid"),
        Refused::FiniteRotations(body) => {
            let shell = |body: &schema::Body| matches!(body.section, Some(Section::Shell(_)));
            let kind = match context.case.body.get(body).is_some_and(shell) {
                true => "shell",
                false => "beam",
            };
            format!("body.{body}.section.{kind}.rotations")
        }
    };
    let problem = Problem::new(path, format!("{what}: {why}"));
    match what {
        Refused::Iterative => problem.accepted(["\"auto\"", "\"direct\""]),
        _ => problem,
    }
}

fn path_of_link(context: &Context, link: &str) -> String {
    match context.case.transition.get(link) {
        Some(_) => format!("transition.{link}"),
        None => format!("arlequin.{link}"),
    }
}

/// The problem behind an error of a zone's system.
fn refused_zone(context: &Context, name: &str, cause: &Error) -> Problem {
    let zone = context.plan.zones.iter().find(|zone| zone.name == name);
    match (cause, zone) {
        (Error::System(Refusal::Unstable { dt, critical }), Some(zone)) => {
            let steps = f64::from(zone.substeps);
            let enough = (steps * dt / critical).ceil();
            let message = format!(
                "the step of the zone `{name}` is above the critical step of its explicit scheme, weights of overlaps included"
            );
            let path = match context
                .case
                .zone
                .get(name)
                .and_then(|zone| zone.substeps.as_ref())
            {
                Some(schema::Substeps::Own(_)) => format!("zone.{name}.substeps"),
                _ => "time.step".to_string(),
            };
            let [found, most] = apart(steps * dt, steps * critical);
            Problem::new(path, message)
                .found(format!("an outer step of {found} s"))
                .accepted([
                    format!("an outer step of at most {most} s"),
                    format!("zone.{name}.substeps = {enough}"),
                ])
        }
        _ => by_step(context, cause).note(format!("in the zone `{name}`")),
    }
}

/// The problem behind an error of a body.
fn refused_body(cause: &carom_bodies::Error) -> Problem {
    if let carom_bodies::Error::NoRotation { body } = cause {
        return Problem::new(format!("mass.{body}.inertia"), cause.to_string())
            .accepted(["nodes of a beam", "no inertia"]);
    }
    let path = format!("body.{}.{}", cause.body(), key(cause));
    Problem::new(path, cause.to_string())
}

/// A value and the bound below it, with the digits that tell them apart and keep the bound a bound: four decimals at least.
fn apart(value: f64, bound: f64) -> [String; 2] {
    let text = |decimals: usize| [value, bound].map(|number| format!("{number:.decimals$e}"));
    let enough = |decimals: &usize| {
        let [found, most] = text(*decimals);
        found != most && most.parse::<f64>().is_ok_and(|most| most <= bound)
    };
    text((4..17).find(enough).unwrap_or(17))
}

/// The key of a body that its error is about.
fn key(error: &carom_bodies::Error) -> &'static str {
    use carom_bodies::Error;
    match error {
        Error::FiniteKinematics { .. } => "section",
        Error::LinearFormulation { .. } | Error::NotReduced { .. } => "formulation",
        Error::NoBetween { .. } => "material",
        Error::BeamAxes { .. } => "section.beam",
        Error::ShellRefused { .. } => "section.shell",
        Error::ShellCell { .. } => "region",
        Error::NoShape { .. } => "section.beam.shape",
        Error::LargeBeam { .. } => "section.beam.rotations",
        Error::Mechanism { .. } | Error::FlowingHinges { .. } => "hinges",
        _ => "region",
    }
}
