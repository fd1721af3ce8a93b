//! The system of a case, and what is looked at in it.

use carom_output::expectations::Expected;
use std::sync::Arc;

use carom_dynamics::{Model, ModelLink, System};
use carom_zones::Zoned;

use super::added::AddedForce;
use super::built::Built;
use super::context::Context;
use super::model::{self};
use super::problems::Problems;
use super::{
    allowables, contact_checks, contacts, levels, nonlinear, oscillators, penetration, probes,
    reference, refused, signals, time,
};

/// What a case amounts to, without its warnings.
pub(super) fn lower(
    context: &Context,
    forces: &[AddedForce],
    problems: &mut Problems,
) -> Option<Built> {
    let modelled = model::lower(context, forces, problems)?;
    let nodes = modelled.model.mesh.nodes.clone();
    let Assembled {
        system,
        zoned,
        apart,
    } = assembled(context, modelled.model, modelled.joints.links, problems)?;
    signals::warn_of_steps(context, system.dt, problems);
    contact_checks::able_to_act(&system, problems);
    contact_checks::with_area(context, &system, problems);
    probes::fine_enough(context, system.dt, problems);
    oscillators::check(context, &system, problems);
    penetration::at_start(context, &system, problems);
    penetration::moved(context, &system, &nodes, problems);
    nonlinear::startable(context, &system, problems);
    contact_checks::advise(context, &system, &modelled.springs, problems);
    let levels = levels::lower(context, &system, problems);
    let allowables = allowables::lower(context, &system, problems);
    probes::at_contacts(&modelled.probes, &system, problems);
    let probes = probes::weighed(context, modelled.probes, &system, problems);
    let time = &context.case.time;
    let reference = reference::lower(context, &system, time.end.0, problems);
    Some(Built {
        system,
        zoned,
        apart,
        overlaps: modelled.joints.overlaps,
        end: time.end.0,
        stage: time.stage.map(|stage| (stage.end.0, stage.steps)),
        levels,
        allowables,
        expected: Expected::default(),
        probes,
        reference,
        warnings: std::mem::take(&mut problems.warnings),
        doubts: std::mem::take(&mut problems.doubts),
        reductions: modelled.reductions,
        signals: context.signals.words.clone(),
    })
}

/// The system, with its zones if the case has some.
struct Assembled {
    system: Arc<System>,
    zoned: Option<Zoned>,
    /// Whether the zones step apart.
    apart: bool,
}

/// Gives a model its step, and builds its system.
fn assembled(
    context: &Context,
    model: Model,
    links: Vec<ModelLink>,
    problems: &mut Problems,
) -> Option<Assembled> {
    let (model, zoned) = match context.plan.zones.is_empty() {
        true => (in_one(context, model, problems)?, None),
        false => {
            let (whole, zoned) = in_zones(context, model, links, problems)?;
            (whole, Some(zoned))
        }
    };
    if !problems.is_empty() {
        return None;
    }
    let system = match &zoned {
        None => System::new(model)
            .map(|system| (system, false))
            .map_err(carom_zones::Error::from),
        Some(zoned) => of_zones(zoned, model),
    };
    match system {
        Ok((system, apart)) => Some(Assembled {
            system,
            zoned,
            apart,
        }),
        Err(error) => problems.refuse(refused::by_zones(context, &error)),
    }
}

/// The model of a case without zones, with its step.
fn in_one(context: &Context, model: Model, problems: &mut Problems) -> Option<Model> {
    let mut model = model::in_one(context, model);
    let system = || Ok(vec![System::new(model.clone())?]);
    model.dt = time::step(context, &model.mesh, &model.bodies, system, problems)?;
    model.adaptive = time::adaptive(context, model.dt, problems);
    Some(model)
}

/// The model of a case in zones as a whole and by zones, with their step.
fn in_zones(
    context: &Context,
    mut model: Model,
    links: Vec<ModelLink>,
    problems: &mut Problems,
) -> Option<(Model, Zoned)> {
    let mut zoned = Zoned {
        model: model.clone(),
        zones: context.plan.model_zones(),
        links,
        kind: context.plan.kind,
    };
    let far = zoned.slide_far();
    for contacts in [&mut model.contacts, &mut zoned.model.contacts] {
        contacts::default_sliding(context, contacts, &far);
    }
    let systems = || zoned.systems();
    model.dt = time::step(context, &model.mesh, &model.bodies, systems, problems)?;
    zoned.model.dt = model.dt;
    zoned.model.adaptive = time::adaptive(context, model.dt, problems);
    Some((model, zoned))
}

/// The system of a model in zones, and whether these step apart.
fn of_zones(zoned: &Zoned, model: Model) -> Result<(Arc<System>, bool), carom_zones::Error> {
    // errors that lie in one zone name it
    zoned.systems()?;
    match zoned.together()? {
        Some(system) => Ok((system, false)),
        None => {
            zoned.check_stage()?;
            let links = zoned.links.clone();
            Ok((System::whole(Model { links, ..model })?, true))
        }
    }
}
