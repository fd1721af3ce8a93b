//! `carom report`.

use std::path::PathBuf;

use carom_pages::plot::quantity;

use crate::resume::open;
use crate::run::end;
use crate::terminal::err;

/// Arguments of `carom report`.
#[derive(clap::Args)]
pub struct Arguments {
    /// The results folder of the run
    folder: PathBuf,
    /// Print `summary.json` in place of a text
    #[arg(long)]
    json: bool,
}

/// Writes the report of a results folder anew; returns the exit code.
pub fn report(arguments: &Arguments) -> u8 {
    let run = match open(&arguments.folder, &[]) {
        Ok(run) => run,
        Err(code) => return code,
    };
    let (step, time) = run.instant();
    let time = quantity(time, "s");
    err!("report of the checkpoint of step {step} at {time}");
    end(run.report().map(Some), &arguments.folder, arguments.json)
}
