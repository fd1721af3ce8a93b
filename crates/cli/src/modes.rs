//! `carom modes`.

use std::io::IsTerminal;
use std::path::PathBuf;

use carom_case::ModesError;
use indicatif::{ProgressBar, ProgressDrawTarget};

use crate::exit::{BAD_INPUT, FAILED};
use crate::load::load;
use crate::sweep::WIDTH;
use crate::terminal::{err, line, out};

/// Arguments of `carom modes`.
#[derive(clap::Args)]
pub struct Arguments {
    /// The case file
    case: PathBuf,
    /// Replace a value of the case: `--set body.bar.material=steel`
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Number of modes of each part; default: ten, or as many as there are
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    count: Option<u32>,
    /// Results folder; default: the name of the case file with the ending `.modes`, beside it
    #[arg(long, value_name = "FOLDER")]
    results: Option<PathBuf>,
    /// Show no progress bar
    #[arg(long)]
    quiet: bool,
}

/// Computes and prints; returns the exit code.
pub fn modes(arguments: &Arguments) -> u8 {
    let (input, case, built) = match load(&arguments.case, &arguments.set) {
        Ok(loaded) => loaded,
        Err(code) => return code,
    };
    for warning in &built.warnings {
        err!("warning: {}", line(warning));
    }
    let given = arguments.results.clone();
    let folder = given.unwrap_or_else(|| arguments.case.with_extension("modes"));
    let first = input.sources.first();
    let name = || first.map_or_else(String::new, |source| source.name.clone());
    let title = case.title.clone().unwrap_or_else(name);
    let bar = match arguments.quiet || !std::io::stderr().is_terminal() {
        true => ProgressBar::hidden(),
        false => ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(5)),
    };
    let mut told = |done: usize, all: usize| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    };
    let count = arguments.count.map(|count| count as usize);
    let found = carom_case::modes(&built, (&title, &folder), count, &mut told);
    bar.finish_and_clear();
    let modal = match found {
        Ok(modal) => modal,
        Err(error) => {
            err!("error: {}", line(&error.to_string()));
            return match error {
                ModesError::Count { .. } => BAD_INPUT,
                ModesError::Modes(_) | ModesError::Output(_) => FAILED,
            };
        }
    };
    out!("{}", line(&title));
    for (name, table, facts) in &modal.parts {
        out!("\n{}", line(name));
        out!("{}", table.text(WIDTH));
        for fact in facts {
            out!("  {fact}");
        }
    }
    for note in &modal.notes {
        out!("  {}", line(note));
    }
    out!("  report: {}", modal.page.display());
    0
}
