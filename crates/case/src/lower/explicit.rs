//! Bulk viscosity, mass scaling and deletion: what they are made of, and where they are refused.

use carom_bodies::{BulkViscosity, MassScaling};
use carom_contact::Integration;
use carom_dynamics::{ModelBody, ModelContact, ModelTarget};
use carom_materials::{Law, Material};
use carom_mesh::Surface;

use super::context::Context;
use super::lookup;
use super::problems::Problems;
use crate::error::Problem;
use crate::schema;

impl From<schema::BulkViscosity> for BulkViscosity {
    fn from(given: schema::BulkViscosity) -> BulkViscosity {
        BulkViscosity {
            linear: given.linear,
            quadratic: given.quadratic,
        }
    }
}

impl From<schema::MassScaling> for MassScaling {
    fn from(given: schema::MassScaling) -> MassScaling {
        match given {
            schema::MassScaling::Factor(factor) => MassScaling::Factor(factor),
            schema::MassScaling::Step(step) => MassScaling::Step(step.0),
        }
    }
}

/// Refuses deletion where there is no plastic strain, and in zones.
fn deletes(context: &Context, path: &str, material: &Law, problems: &mut Problems) {
    let mut history = vec![0.0; material.finite().map_or(0, Material::history_len)];
    if let Some(law) = material.finite() {
        law.start(&mut history);
    }
    if material.finite().is_none() || material.plastic_strain(&history).is_none() {
        let message = "cells are deleted at a plastic strain, and this material has none";
        let problem = Problem::new(path, message).found(material.key());
        problems.push(problem.accepted(["j2", "j2-table", "johnson-cook"]));
    } else if !context.plan.zones.is_empty() {
        let message = "cells are not deleted in runs with zones";
        let problem = Problem::new(path, message);
        problems.push(problem.accepted(["no `zone`"]));
    }
}

/// Refuses contacts that deletion leaves without faces or areas.
pub(super) fn check_contacts(
    context: &Context,
    bodies: &[ModelBody],
    contacts: &[ModelContact],
    problems: &mut Problems,
) {
    let deletes = |surface: &Surface| {
        let body = lookup::body_behind(bodies, surface)?;
        body.spec.deletion.map(|_| body.spec.name.clone())
    };
    for contact in contacts {
        let path = format!("contact.{}", contact.name);
        let primary = match &contact.primary {
            ModelTarget::Surface(primary) => deletes(primary),
            ModelTarget::Rigid(_) => None,
        };
        let secondary = deletes(&contact.secondary);
        if let Some(body) = primary {
            // the default is `finite` where cells are deleted
            let given = context.case.contact.get(&contact.name);
            let small =
                |given: &schema::Contact| matches!(given.sliding, Some(schema::Sliding::Small));
            let refused = if contact.depth.is_some() {
                Some(("has no `depth`", "no `depth`"))
            } else if given.is_some_and(small) {
                Some(("cannot be paired once", "sliding = \"finite\""))
            } else if matches!(contact.integration, Integration::Mortar { .. }) {
                Some(("has no mortar method", "integration = \"node\""))
            } else {
                None
            };
            if let Some((cause, accepted)) = refused {
                let message = format!(
                    "cells of body `{body}` are deleted, so that its surface changes and {cause}"
                );
                let problem = Problem::new(path, message);
                problems.push(problem.accepted([accepted]));
                continue;
            }
        }
        let Some(body) = secondary else {
            continue;
        };
        let nodes = contact.integration == Integration::Node;
        if !nodes || contact.law.is_function() {
            let message = format!(
                "cells of body `{body}` are deleted, so that the areas of its surface change"
            );
            let problem = Problem::new(path, message);
            problems.push(problem.accepted([
                "integration = \"node\" with a law without areas: velocity, restitution, displacement",
            ]));
        }
    }
}

/// Refuses bulk viscosity, mass scaling and deletion where they mean nothing.
pub(super) fn check(context: &Context, bodies: &[ModelBody], problems: &mut Problems) {
    for (number, body) in bodies.iter().enumerate() {
        let scheme = context.scheme_of(number);
        let explicit = scheme.get().is_explicit() && !context.case.time.is_static();
        let spec = &body.spec;
        let solid = body.rigid.is_none() && body.reduced.is_none();
        let beam = spec.kinematics.rotations().is_some();
        let line = spec.kinematics.dim() == 1 || beam;
        let path = format!("body.{}", spec.name);
        for (key, given) in [
            ("bulk-viscosity", spec.viscosity.is_some()),
            ("mass-scaling", spec.scaling.is_some()),
            ("deletion", spec.deletion.is_some()),
        ] {
            let path = format!("{path}.{key}");
            if given && !explicit {
                let problem = Problem::new(path, "only explicit schemes know it");
                let problem = problem.found(format!("the scheme {}", scheme.get().name()));
                problems.push(problem.accepted(["time.scheme = { central-difference = {} }"]));
            } else if given && line && key != "mass-scaling" {
                let problem = Problem::new(path, "only solids and plane cells have it");
                let problem = problem.found(format!("section.{}", spec.kinematics.name()));
                problems.push(problem.accepted(["solid or plane cells", "no such key"]));
            } else if given && (!solid || beam) {
                let problem = Problem::new(path, "only solids, plane cells and bars have it");
                problems.push(problem.accepted([
                    "a body without `section.beam`, `section.shell`, `rigid` and `reduction`",
                ]));
            }
        }
        if line {
            continue;
        }
        if spec.deletion.is_some() {
            deletes(
                context,
                &format!("{path}.deletion"),
                &spec.material,
                problems,
            );
        }
        if spec.viscosity.is_none() {
            continue;
        }
        let path = format!("{path}.bulk-viscosity");
        if spec.material.finite().is_none() {
            let message = "bulk viscosity is for materials at finite strain";
            let problem = Problem::new(path, message).found(spec.material.key());
            problems.push(problem.accepted(["st-venant-kirchhoff", "neo-hooke", "j2"]));
        } else if context.case.time.stage.is_some() {
            let message = "a static stage has no rates, on which bulk viscosity depends";
            let problem = Problem::new(path, message).found("`time.static`");
            problems.push(problem.accepted(["no static stage"]));
        }
    }
}
