//! Bulk viscosity and mass scaling: what they are made of, and where they are refused.

use carom_bodies::{BulkViscosity, Kinematics, MassScaling};
use carom_dynamics::ModelBody;

use super::Builder;
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

impl Builder<'_> {
    /// Refuses bulk viscosity and mass scaling where they mean nothing.
    pub(super) fn explicit_alone(&mut self, bodies: &[ModelBody]) {
        for (number, body) in bodies.iter().enumerate() {
            let zone = self.plan.zone_of(number);
            let scheme = zone.map_or(self.case.time.scheme(), |zone| self.plan.zones[zone].scheme);
            let explicit = scheme.get().is_explicit() && !self.case.time.is_static();
            let spec = &body.spec;
            let solid = body.rigid.is_none() && body.reduced.is_none();
            let beam = matches!(spec.kinematics, Kinematics::Beam(_));
            let path = format!("body.{}", spec.name);
            for (key, given) in [
                ("bulk-viscosity", spec.viscosity.is_some()),
                ("mass-scaling", spec.scaling.is_some()),
            ] {
                let path = format!("{path}.{key}");
                if given && !explicit {
                    let problem = Problem::new(path, "only explicit schemes know it");
                    let problem = problem.found(format!("the scheme {}", scheme.get().name()));
                    self.problems
                        .push(problem.accepted(["time.scheme = { central-difference = {} }"]));
                } else if given && (!solid || beam) {
                    let problem = Problem::new(path, "only solids, plane cells and bars have it");
                    self.problems.push(
                        problem
                            .accepted(["a body without `section.beam`, `rigid` and `reduction`"]),
                    );
                }
            }
            if spec.viscosity.is_none() {
                continue;
            }
            let path = format!("{path}.bulk-viscosity");
            if spec.material.finite().is_none() {
                let message = "bulk viscosity is for materials at finite strain";
                let problem = Problem::new(path, message).found(spec.material.key());
                self.problems
                    .push(problem.accepted(["st-venant-kirchhoff", "neo-hooke", "j2"]));
            } else if self.case.time.stage.is_some() {
                let message = "a static stage has no rates, on which bulk viscosity depends";
                let problem = Problem::new(path, message).found("`time.static`");
                self.problems.push(problem.accepted(["no static stage"]));
            }
        }
    }
}
