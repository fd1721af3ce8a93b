//! The run of a built case, from the first factorisation to the results folder.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use carom_dynamics::{Observer, Outcome, RankShare, Stepper, go_on, is_at_end, march};
use carom_output::checkpoint::Checkpoint;
use carom_output::summary::Zones;
use carom_output::{
    Checkpoints, Ending, Fields, Folder, Probe, Reference, Results, Settings, Summary, Zoning,
};
use carom_zones::ModelZone;
use thiserror::Error as ThisError;

use crate::convergence;
use crate::describe::entries;
use crate::expect::expected;
use crate::input::Input;
use crate::lower::Built;
use crate::origin::Origin;
use crate::schema::{Case, Field, Motion, Scheme};
use crate::stepping::Stepping;

/// How a run ended.
#[derive(Debug)]
pub struct Finished {
    /// What `summary.json` holds.
    pub summary: Summary,
    /// Whether somebody stopped it before its end time.
    pub interrupted: bool,
    /// What the busiest of several ranks had and sent; none of one process.
    pub ranks: Option<RankShare>,
}

/// Why a run did not come to its end.
#[derive(Debug, ThisError)]
pub enum Failed {
    /// Nothing was computed.
    #[error(transparent)]
    Start(carom_dynamics::Error),
    /// The results could not be written.
    #[error(transparent)]
    Output(#[from] carom_output::Error),
    /// A step failed, or its results could not be written; what was written before is complete.
    #[error(transparent)]
    Step(carom_dynamics::Error),
}

/// From where a run begins.
pub(crate) enum Begin {
    /// From the start.
    Start,
    /// From a checkpoint in an open results folder.
    Checkpoint(Box<Checkpoint>, Folder),
    /// The same, to take no step and write its report.
    Review(Box<Checkpoint>, Folder),
}

/// Runs a case into a results folder. `progress` sees every accepted state, and what interrupts it ends the step under way too; `stop` is asked
/// before every step.
///
/// # Errors
/// The folder cannot be written, or a step fails. The folder then holds all that was computed before.
pub fn run(
    (input, case, built): (&Input, &Case, &Built),
    folder: PathBuf,
    progress: &mut dyn Observer,
    stop: &dyn Fn() -> bool,
) -> Result<Finished, Failed> {
    let origin = Origin::of(input, case, &folder);
    let settings = settings((input, case, built), folder, &origin);
    march_from((built, settings), Begin::Start, progress, stop)
}

/// Takes all steps to the end of the case.
pub(crate) fn march_from(
    (built, settings): (&Built, Settings),
    begin: Begin,
    progress: &mut dyn Observer,
    stop: &dyn Fn() -> bool,
) -> Result<Finished, Failed> {
    let now = Instant::now();
    let mut run = match &begin {
        Begin::Start => Stepping::new(built, None).map_err(Failed::Start)?,
        Begin::Checkpoint(saved, _) | Begin::Review(saved, _) => {
            let mut run = Stepping::new(built, Some(&saved.state)).map_err(Failed::Start)?;
            run.add_earlier(&saved.costs()?);
            run
        }
    };
    let outcome = observed((run.get_mut(), built), (settings, begin), progress, stop)?;
    conclude(outcome, (run.get(), run.zones(built)), (now, built.end))
}

/// The results, and how the steps ended.
pub(crate) type Observed = (Results, Result<Outcome, carom_dynamics::Error>);

/// Takes the steps with the results and `progress` as observers.
fn observed(
    (run, built): (&mut dyn Stepper, &Built),
    (settings, begin): (Settings, Begin),
    progress: &mut dyn Observer,
    stop: &dyn Fn() -> bool,
) -> Result<Observed, Failed> {
    let system = Arc::clone(&built.system);
    let (mut results, march, end): (Results, March, f64) = match begin {
        Begin::Start => (Results::create(settings, system)?, march, built.end),
        Begin::Checkpoint(saved, folder) => {
            let results = Results::resume(folder, &saved, settings, system)?;
            (results, go_on, built.end)
        }
        Begin::Review(saved, folder) => {
            let results = Results::review(folder, &saved, settings, system)?;
            (results, go_on, f64::NEG_INFINITY)
        }
    };
    if let Some(interrupt) = progress.interrupt() {
        run.heed(interrupt);
    }
    let observers: &mut [&mut dyn Observer] = &mut [&mut results, progress];
    let outcome = march(run, end, observers, stop);
    Ok((results, outcome))
}

/// [`march`] or [`go_on`].
pub(crate) type March = fn(
    &mut dyn Stepper,
    f64,
    &mut [&mut dyn Observer],
    &dyn Fn() -> bool,
) -> Result<Outcome, carom_dynamics::Error>;

/// Writes what is written after the run.
pub(crate) fn conclude(
    (mut results, outcome): Observed,
    (run, zones): (&dyn Stepper, Option<Zones>),
    (begin, end): (Instant, f64),
) -> Result<Finished, Failed> {
    let unfinished = match &outcome {
        // a report of a run that was cut is one of its checkpoint
        Ok(Outcome::Done) => (!is_at_end(run, end)).then(|| {
            format!(
                "the run has not come to its end: this is its checkpoint of step {} at {:.6e} s",
                run.state().step,
                run.state().time
            )
        }),
        Ok(Outcome::Interrupted) => Some("the run was interrupted".to_string()),
        Err(error) => Some(error.to_string()),
    };
    // that of a step which somebody ended early is none
    let failed = outcome.is_err().then(|| run.failed_problem());
    let kept = match failed.flatten() {
        Some(problem) => {
            let text =
                serde_json::to_string_pretty(&problem).unwrap_or_else(|cause| cause.to_string());
            results.attach(&format!("interface-{}.json", problem.step()), &text)
        }
        None => Ok(()),
    };
    let ending = Ending {
        unfinished,
        costs: &run.costs(),
        zones,
        wall: begin.elapsed(),
    };
    let summary = results.conclude(&ending);
    // the first cause is the one to report
    let outcome = outcome.map_err(Failed::Step)?;
    kept?;
    Ok(Finished {
        summary: summary?,
        interrupted: outcome == Outcome::Interrupted,
        ranks: None,
    })
}

/// What the output is told of a run.
pub(crate) fn settings(
    (input, case, built): (&Input, &Case, &Built),
    folder: PathBuf,
    origin: &Origin,
) -> Settings {
    let file = input.sources.first();
    let file = file.map_or("", |source| &source.text);
    let checkpoint = case.output.checkpoint.unwrap_or_default();
    Settings {
        folder,
        title: origin.title.clone(),
        case_text: comments(&origin.overrides) + file,
        version: env!("CARGO_PKG_VERSION").to_string(),
        scheme: match &built.zoned {
            None if case.time.is_static() => "static".to_string(),
            None => scheme(&case.time.scheme()),
            Some(zoned) => zoned
                .zones
                .iter()
                .map(of_zone)
                .collect::<Vec<_>>()
                .join(", "),
        },
        study: convergence::study((&origin.file, case), &built.system.mesh, &origin.overrides),
        end: built.end,
        probes: built
            .probes
            .iter()
            .map(|probe| {
                let has = |motion| probe.record.contains(&motion);
                Probe {
                    name: probe.name.clone(),
                    nodes: probe.nodes.clone(),
                    cell: probe.cell,
                    section: probe.section,
                    displacement: has(Motion::Displacement),
                    velocity: has(Motion::Velocity),
                    acceleration: has(Motion::Acceleration),
                    absolute_acceleration: has(Motion::AbsoluteAcceleration),
                    contact: has(Motion::Contact),
                    spectrum: probe.spectrum.clone(),
                    filters: probe.filters.clone(),
                }
            })
            .collect(),
        contact_filters: case
            .contact
            .iter()
            .filter(|(_, contact)| !contact.filter.is_empty())
            .map(|(name, contact)| {
                let classes = contact.filter.iter().map(|class| class.frequency());
                (name.to_owned(), classes.collect())
            })
            .collect(),
        levels: built.levels.clone(),
        allowables: built.allowables.clone(),
        expected: expected(&built.expected, &origin.overrides),
        history_every: case.output.histories.map(|histories| histories.every.0),
        compress_histories: case.output.compress_histories,
        piece: None,
        fields: case.output.fields.as_ref().map(|fields| {
            let has = |field| fields.record.contains(&field);
            Fields {
                every: fields.every.0,
                displacement: has(Field::Displacement),
                velocity: has(Field::Velocity),
                acceleration: has(Field::Acceleration),
                stress: has(Field::Stress),
                strain: has(Field::Strain),
                principal_stress: has(Field::PrincipalStress),
                nodal_stress: has(Field::NodalStress),
                rotation: has(Field::Rotation),
                section_forces: has(Field::SectionForces),
                vtkhdf: fields.vtkhdf,
            }
        }),
        reference: reference(built),
        zoning: built.zoned.as_ref().map(Zoning::of),
        warnings: built.warnings.clone(),
        doubts: built.doubts.clone(),
        checkpoints: Checkpoints {
            every: checkpoint.every.map(|every| every.0),
            wall: checkpoint.least_wall().map(Duration::from_secs_f64),
            keep: checkpoint.keep as usize,
            origin: origin.to_json(),
        },
    }
}

/// Overrides as they stand before the text of the case in the results folder.
pub(crate) fn comments(overrides: &[String]) -> String {
    let one = |text: &String| format!("# --set {}\n", in_a_comment(text.trim()));
    overrides.iter().map(one).collect()
}

/// A text for a comment of TOML, which holds no line feed and no other control character: each becomes an escape.
fn in_a_comment(text: &str) -> String {
    let escaped = |letter: char| -> String {
        match letter.is_control() {
            true => letter.escape_default().collect(),
            false => letter.into(),
        }
    };
    text.chars().map(escaped).collect()
}

fn of_zone(zone: &ModelZone) -> String {
    format!("{}: {}", zone.name, zone.scheme.get().name())
}

/// The exact solution of a built case, for the output.
pub(crate) fn reference(built: &Built) -> Option<Reference> {
    built.reference.as_ref().map(|reference| Reference {
        name: reference.name.to_string(),
        solution: reference.solution.clone(),
        contact: reference.contact,
        axis: reference.axis,
    })
}

/// Name and parameters of a scheme, as the case file has them.
fn scheme(scheme: &Scheme) -> String {
    let mut text = scheme.get().name().to_owned();
    let value = serde_json::to_value(scheme).unwrap_or_default();
    for (key, value) in entries(&value, scheme.get().name()) {
        // a number without the ending `.0` of JSON
        let value = value.as_f64().map_or(value.to_string(), |x| x.to_string());
        text += &format!(", {key} = {value}");
    }
    text
}
