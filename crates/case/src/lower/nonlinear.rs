//! Damping, a static stage, the rules of the iterations, and where they are refused.

use std::collections::BTreeSet;
use std::sync::Arc;

use carom_dynamics::{
    Damping, Driver, Iteration, Model, ModelBody, Nonlinear, Preload, Solver, System,
};
use carom_mesh::ElementId;

use super::context::Context;
use super::problems::Problems;
use super::refused;
use crate::error::Problem;
use crate::schema;

/// Damping, static stage and the rules of the iteration.
pub(super) fn lower(context: &Context) -> Nonlinear {
    let time = &context.case.time;
    let damping = |body: &crate::schema::Body| {
        body.damping
            .as_ref()
            .map_or(Damping::default(), |damping| Damping {
                mass: damping.mass.map_or(0.0, |rate| rate.0),
                stiffness: damping.stiffness.map_or(0.0, |time| time.0),
            })
    };
    Nonlinear {
        damping: context.case.body.iter().map(|(_, b)| damping(b)).collect(),
        preload: time.stage.map(|stage| Preload {
            end: stage.end.0,
            steps: u64::from(stage.steps),
        }),
        iteration: Iteration {
            tolerance: time.newton.tolerance,
            passes: time.newton.passes as usize,
            halvings: time.newton.halvings,
            solver: match time.solver {
                schema::Solver::Auto => Solver::Auto,
                schema::Solver::Direct => Solver::Direct,
                schema::Solver::Iterative => Solver::Iterative,
            },
        },
        ..Nonlinear::default()
    }
}

/// Nodes that are held over the static stage, ascending.
pub(super) fn waiting(context: &Context, model: &Model, problems: &mut Problems) -> Vec<u32> {
    let case = context.case;
    let mut cells: Vec<ElementId> = Vec::new();
    let bodies = case.body.iter().zip(&model.bodies);
    for ((name, body), built) in bodies.filter(|((_, body), _)| body.hold) {
        if body.reduction.is_some() {
            let message = "a reduced body is not held: its modes have no place";
            let problem = Problem::new(format!("body.{name}.hold"), message);
            problems.push(problem.accepted(["a body without `reduction`"]));
        }
        cells.extend(&built.spec.cells);
    }
    // discrete elements begin with the masses, in the order of the case
    let masses = case.mass.iter().zip(&model.discrete);
    for (_, built) in masses.filter(|((_, mass), _)| mass.hold) {
        cells.extend(&built.spec.cells);
    }
    let nodes = cells
        .iter()
        .flat_map(|&cell| model.mesh.element_nodes(cell));
    let nodes: BTreeSet<u32> = nodes.copied().collect();
    if !nodes.is_empty() && case.time.stage.is_none() {
        let message =
            "a body that is held waits for the end of a static stage, and the case has none";
        let problem = Problem::new("time", message);
        problems.push(problem.accepted(["a static stage", "no `hold`"]));
    }
    nodes.into_iter().collect()
}

/// Refuses, of a scheme that takes stresses between two states, bodies that have none.
pub(super) fn stresses_between(context: &Context, bodies: &[ModelBody], problems: &mut Problems) {
    if context.case.time.is_static() {
        return;
    }
    for (number, body) in bodies.iter().enumerate() {
        let scheme = context.scheme_of(number);
        if !scheme.get().is_between() {
            continue;
        }
        let path = format!("body.{}", body.spec.name);
        let message = "the scheme conserves energy by a stress between the two ends of a step";
        let name = scheme.get().name();
        if body.spec.material.dissipates() {
            let problem = Problem::new(format!("{path}.material"), message);
            let problem = problem.found(format!("{name} with a material that dissipates"));
            problems.push(match body.spec.kinematics.dim() {
                1 => problem.accepted(["elastic", "another scheme, such as newmark"]),
                _ => problem.accepted(["st-venant-kirchhoff", "neo-hooke", "mooney-rivlin"]),
            });
        }
    }
}

/// Refuses what the solver refuses to start with: a static stage of a body that nothing holds, cells without stress.
pub(super) fn startable(context: &Context, system: &Arc<System>, problems: &mut Problems) {
    if !problems.is_empty() || !context.plan.zones.is_empty() || !system.is_nonlinear() {
        return;
    }
    if let Err(error) = Driver::new(Arc::clone(system)) {
        let problem = refused::by_step(context, &error);
        problems.push(problem);
    }
}
