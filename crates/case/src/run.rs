//! The run of a built case, from the first factorisation to the results folder.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use carom_dynamics::{Driver, Observer, Outcome, Stepper, march};
use carom_output::summary::Zones;
use carom_output::{Ending, Fields, Probe, Reference, Results, Settings, Summary, Zoning};
use carom_zones::{ModelZone, Whole};
use thiserror::Error as ThisError;

use crate::build::Built;
use crate::describe::entries;
use crate::input::Input;
use crate::schema::{Case, Field, Motion, Scheme};

/// How a run ended.
#[derive(Debug)]
pub struct Finished {
    /// What `summary.json` holds.
    pub summary: Summary,
    /// Whether somebody stopped it before its end time.
    pub interrupted: bool,
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

/// Runs a case into a results folder. `progress` sees every accepted state; `stop` is asked before every step.
///
/// # Errors
/// The folder cannot be written, or a step fails. The folder then holds all that was computed before.
pub fn run(
    (input, case, built): (&Input, &Case, &Built),
    folder: PathBuf,
    progress: &mut dyn Observer,
    stop: &dyn Fn() -> bool,
) -> Result<Finished, Failed> {
    let begin = Instant::now();
    let system = || Arc::clone(&built.system);
    match &built.zoned {
        zoned if !built.apart => {
            let mut driver = Driver::new(system()).map_err(Failed::Start)?;
            let mut results = Results::create(settings(input, case, built, folder), system())?;
            let observers: &mut [&mut dyn Observer] = &mut [&mut results, progress];
            let outcome = march(&mut driver, built.end, observers, stop);
            let zones = zoned.as_ref().map(|zoned| Zones::together(&driver, zoned));
            conclude(results, outcome, (&driver, zones), begin)
        }
        None => unreachable!("only zones step apart"),
        Some(zoned) => {
            let mut whole =
                Whole::new(zoned, system()).map_err(|error| Failed::Start(error.into()))?;
            let mut results = Results::create(settings(input, case, built, folder), system())?;
            let observers: &mut [&mut dyn Observer] = &mut [&mut results, progress];
            let outcome = march(&mut whole, built.end, observers, stop);
            conclude(results, outcome, (&whole, Some(Zones::of(&whole))), begin)
        }
    }
}

/// Writes what is written after the run.
fn conclude(
    mut results: Results,
    outcome: Result<Outcome, carom_dynamics::Error>,
    (run, zones): (&dyn Stepper, Option<Zones>),
    begin: Instant,
) -> Result<Finished, Failed> {
    let unfinished = match &outcome {
        Ok(Outcome::Done) => None,
        Ok(Outcome::Interrupted) => Some("the run was interrupted".to_string()),
        Err(error) => Some(error.to_string()),
    };
    let kept = match run.failed_problem() {
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
    })
}

fn settings(input: &Input, case: &Case, built: &Built, folder: PathBuf) -> Settings {
    let set = input.sources.iter().filter(|source| source.name == "--set");
    let overrides: String = set
        .map(|source| format!("# --set {}\n", in_a_comment(source.text.trim())))
        .collect();
    let file = input
        .sources
        .first()
        .map_or(String::new(), |source| source.text.clone());
    Settings {
        folder,
        title: case.title.clone().unwrap_or_else(|| {
            input
                .sources
                .first()
                .map_or_else(String::new, |s| s.name.clone())
        }),
        case_text: overrides + &file,
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
        probes: built
            .probes
            .iter()
            .map(|probe| {
                let has = |motion| probe.record.contains(&motion);
                Probe {
                    name: probe.name.clone(),
                    nodes: probe.nodes.clone(),
                    displacement: has(Motion::Displacement),
                    velocity: has(Motion::Velocity),
                    acceleration: has(Motion::Acceleration),
                    absolute_acceleration: has(Motion::AbsoluteAcceleration),
                    spectrum: probe.spectrum.clone(),
                }
            })
            .collect(),
        levels: built.levels.clone(),
        history_every: case.output.histories.map(|histories| histories.every.0),
        fields: case.output.fields.as_ref().map(|fields| {
            let has = |field| fields.record.contains(&field);
            Fields {
                every: fields.every.0,
                displacement: has(Field::Displacement),
                velocity: has(Field::Velocity),
                acceleration: has(Field::Acceleration),
                stress: has(Field::Stress),
                rotation: has(Field::Rotation),
                section_forces: has(Field::SectionForces),
            }
        }),
        reference: reference(built),
        zoning: built.zoned.as_ref().map(Zoning::of),
        warnings: built.warnings.clone(),
    }
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
