//! `carom resume`.

use std::path::{Path, PathBuf};

use carom_case::{NotResumed, Resume};
use carom_output::Error;
use carom_output::plot::quantity;

use crate::exit::{BAD_INPUT, FAILED};
use crate::load::refuse;
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
pub fn resume(arguments: &Arguments) -> u8 {
    let until = arguments.until.iter().map(|end| format!("time.end={end}"));
    let overrides: Vec<String> = arguments.set.iter().cloned().chain(until).collect();
    let run = match open(&arguments.folder, &overrides) {
        Ok(run) => run,
        Err(code) => return code,
    };
    let (step, time) = run.instant();
    let time = quantity(time, "s");
    err!("going on from the checkpoint of step {step} at {time}");
    let ended = until_stopped(run.built.end, arguments.quiet, |progress, stop| {
        run.run(progress, stop)
    });
    end(ended, &arguments.folder, arguments.json)
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
