//! What `carom compare` and `carom study` share: runs one after another, Ctrl-C, outcomes as exit codes.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};

use carom_case::{Sweep, SweepError};
use carom_dynamics::Observer;
use carom_output::Absent;
use carom_studies::compare::{Outcome, Variant};

use crate::exit::{FAILED, INTERRUPTED};
use crate::load;
use crate::progress::Progress;
use crate::signals;
use crate::terminal::{err, line, out};

/// Letters in a line of a table.
pub const WIDTH: usize = 120;

/// Arguments of both commands.
#[derive(clap::Args)]
pub struct Arguments {
    /// The case file
    pub case: PathBuf,
    /// Replace a value of the case in every run: `--set time.end="200 us"`
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Common results folder; default: the name of the case file with the ending `.compare` or `.study`, beside it
    #[arg(long, value_name = "FOLDER")]
    pub results: Option<PathBuf>,
    /// The contact whose force is compared; default: that of the exact solution, otherwise the first one
    #[arg(long, value_name = "NAME")]
    pub contact: Option<String>,
    /// Number of runs at a time; wall times are comparable only with 1
    #[arg(long, default_value_t = 1, value_name = "N")]
    pub jobs: usize,
    /// Show no progress bar
    #[arg(long)]
    pub quiet: bool,
}

impl Arguments {
    /// The results folder: the one given, or the case with this ending.
    pub fn folder(&self, ending: &str) -> PathBuf {
        let given = self.results.clone();
        given.unwrap_or_else(|| self.case.with_extension(ending))
    }

    /// Gives `work` the way to make the runs: with a progress bar each, until Ctrl-C.
    pub fn sweep<T>(&self, folder: &Path, work: impl FnOnce(&Sweep) -> T) -> T {
        let interrupt = signals::interrupt("a table");
        let hidden = self.quiet || self.jobs > 1 || !std::io::stderr().is_terminal();
        let watch = |name: &str, end: f64| -> Box<dyn Observer> {
            if !hidden {
                err!("{name}");
            }
            Box::new(Progress::new(end, hidden, interrupt.clone()))
        };
        work(&Sweep {
            folder,
            contact: self.contact.as_deref(),
            jobs: self.jobs,
            watch: &watch,
            stop: &|| interrupt.is_set(),
        })
    }
}

/// Prints why there is no table; returns the exit code.
pub fn refuse(error: &SweepError) -> u8 {
    match error {
        SweepError::Input { sources, problems } => load::refuse(sources, problems),
        SweepError::Output(error) => {
            err!("error: {error}");
            FAILED
        }
    }
}

/// The contact that a table looks at, in a sentence: which one is a choice where there are several.
pub fn contact(name: Option<&str>) -> String {
    name.map_or(String::new(), |name| format!("Contact `{name}`. "))
}

/// Prints the reasons of what is not good.
pub fn reasons<'a>(variants: impl Iterator<Item = &'a Variant>) {
    for variant in variants {
        let (verdict, reason) = variant.verdict();
        if !reason.is_empty() {
            out!("  {} {verdict}: {}", variant.name, line(&reason));
        }
    }
}

/// Prints why cells are empty.
pub fn absent(cells: &[Absent]) {
    for cell in cells {
        out!("  – {}", line(&cell.text()));
    }
}

/// Exit code: interrupted, failed in running, or done.
pub fn code<'a>(variants: impl Iterator<Item = &'a Variant>) -> u8 {
    let code = |variant: &Variant| match &variant.outcome {
        Outcome::Stopped => INTERRUPTED,
        Outcome::Failed(_) => FAILED,
        Outcome::Done(_) | Outcome::Refused(_) => 0,
    };
    variants.map(code).max().unwrap_or(0)
}
