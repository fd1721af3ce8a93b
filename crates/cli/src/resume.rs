//! `carom resume`.

use std::path::{Path, PathBuf};

use carom_case::{NotResumed, Resume};
use carom_output::Error;
use carom_pages::plot::quantity;
use carom_ranks::Ranks;

use crate::exit::{BAD_INPUT, FAILED};
use crate::load::{refuse, warn_of_ranks};
use crate::ranks::all_have;
use crate::run::{end, until_stopped};
use crate::terminal::{err, line};

/// Arguments of `carom resume`.
#[derive(clap::Args)]
pub struct Arguments {
    /// The results folder of the run
    folder: PathBuf,
    /// Another end of the run: `--until "2 ms"`
    #[arg(long, value_name = "TIME")]
    until: Option<String>,
    /// Replace a value of the case that the model does not depend on: `--set output.fields.every="1 us"`
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Show no progress bar
    #[arg(long)]
    quiet: bool,
    /// Print `summary.json` in place of a text
    #[arg(long)]
    json: bool,
}

/// Goes on with a run; returns the exit code.
pub fn resume(arguments: &Arguments, ranks: &Ranks) -> u8 {
    let until = arguments.until.iter().map(|end| format!("time.end={end}"));
    let overrides: Vec<String> = arguments.set.iter().cloned().chain(until).collect();
    let run = match all_have(ranks, open_on(ranks, &arguments.folder, &overrides)) {
        Ok(run) => run,
        Err(code) => return code,
    };
    let (step, time) = run.instant();
    let time = quantity(time, "s");
    err!("going on from the checkpoint of step {step} at {time}");
    let quiet = arguments.quiet || !ranks.is_first();
    let ended = until_stopped(run.end(), quiet, |progress, stop| match ranks.count() {
        1 => run.run(progress, stop).map(Some),
        _ => run.run_on_ranks(ranks, progress, stop),
    });
    end(ended, &arguments.folder, arguments.json)
}

/// As [`open`], on each of several ranks if there are.
fn open_on(ranks: &Ranks, folder: &Path, overrides: &[String]) -> Result<Resume, u8> {
    let run = match ranks.is_first() {
        true => open(folder, overrides)?,
        false => Resume::open_beside(folder, overrides).map_err(|_| BAD_INPUT)?,
    };
    warn_of_ranks(ranks, run.built.as_ref());
    Ok(run)
}

/// The run of a results folder at its newest checkpoint that can be used; else the exit code, after the cause is told.
pub fn open(folder: &Path, overrides: &[String]) -> Result<Resume, u8> {
    let run = match Resume::open(folder, overrides) {
        Ok(run) => run,
        Err(NotResumed::Case(sources, problems)) => return Err(refuse(&sources, &problems)),
        Err(NotResumed::Folder(error)) => {
            err!("error: {}", line(&error.to_string()));
            return Err(match error {
                Error::Busy { .. } => FAILED,
                _ => BAD_INPUT,
            });
        }
    };
    for error in &run.unusable {
        err!("warning: {}", line(&error.to_string()));
    }
    Ok(run)
}
