//! The executable: `carom run`, `resume`, `compare`, `study`, `modes`, `check`, `schema`, `new`, `verify`.
//!
//! Exit codes: 0 done and the verdict `good` or `look`, 2 bad input, 3 the run failed with the last good state on disk, 4 done but
//! the verdict bad, 130 interrupted. All that it prints goes through [`terminal`].

mod compare;
mod diagnostics;
mod exit;
mod load;
mod modes;
mod new;
mod progress;
mod resume;
mod run;
mod study;
mod sweep;
mod terminal;

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::exit::{BAD, BAD_INPUT, FAILED};
use crate::load::{keep_offenders, load_with};
use crate::terminal::{err, line, out};

/// Computes the impact of deformable bodies: a case file, a run, a report.
#[derive(Parser)]
#[command(name = "carom", version)]
struct Arguments {
    /// Messages on stderr: `warn`, or `debug` for factorisations with their reasons, halved steps, and points that change their
    /// faces
    #[arg(long, value_name = "LEVEL", default_value = "warn", global = true)]
    log: tracing::Level,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Check a case, run it, and write its results folder
    Run(run::Arguments),
    /// Go on with a run that was cut, from the last checkpoint in its results folder
    Resume(resume::Arguments),
    /// Run a case under several schemes and contact laws: one table, one figure per quantity, one report
    Compare(compare::Arguments),
    /// Run a case over the values of a key, with orders of convergence; or find the value that gives a result
    Study(study::Arguments),
    /// Compute frequencies, shapes and effective masses of the bodies of a case
    Modes(modes::Arguments),
    /// Check a case without running it: errors, warnings, sizes, wave speeds, first possible impact, steps
    Check {
        /// The case file
        case: PathBuf,
        /// Replace a value of the case: `--set time.scheme.theta.theta=0.6`
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
    },
    /// Print the JSON schema of the case file
    Schema {
        /// Print the reference page of the book instead
        #[arg(long)]
        reference: bool,
    },
    /// Write a commented case to start from, with the mesh that it reads
    New {
        /// Name of the template; without a name the command lists the templates
        template: Option<String>,
        /// File to write
        #[arg(default_value = "case.toml")]
        file: PathBuf,
    },
    /// Run the problems with a known answer on this machine
    Verify {
        /// Run only the checks whose name contains this text
        name: Option<String>,
        /// Use the small sizes of the quick tests
        #[arg(long)]
        quick: bool,
    },
}

fn main() -> ExitCode {
    let code = match Arguments::try_parse() {
        Ok(arguments) => obey(arguments),
        Err(answer) => {
            // `--help` and `--version` are answers too; an error goes to standard error
            let printed = answer.print();
            if !answer.use_stderr() {
                terminal::keep(printed);
            }
            u8::try_from(answer.exit_code()).unwrap_or(BAD_INPUT)
        }
    };
    ExitCode::from(terminal::close(code))
}

fn obey(Arguments { log, command }: Arguments) -> u8 {
    tracing_subscriber::fmt()
        .with_max_level(log)
        .with_ansi(std::io::stderr().is_terminal())
        .with_writer(|| terminal::StandardError)
        .init();
    match command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Resume(arguments) => resume::resume(&arguments),
        Command::Compare(arguments) => compare::compare(&arguments),
        Command::Study(arguments) => study::study(&arguments),
        Command::Modes(arguments) => modes::modes(&arguments),
        Command::Check { case, set } => check(&case, &set),
        Command::Schema { reference } => schema(reference),
        Command::New { template, file } => new::new(template.as_deref(), &file),
        Command::Verify { name, quick } => verify(name.as_deref(), quick),
    }
}

fn check(case: &Path, set: &[String]) -> u8 {
    let built = match load_with(case, set, |problems| keep_offenders(case, problems)) {
        Ok((_, _, built)) => built,
        Err(code) => return code,
    };
    for fact in carom_case::facts(&built) {
        out!("{:<18} {}", fact.name, line(&fact.value));
    }
    for warning in &built.warnings {
        out!("{:<18} {}", "warning", line(warning));
    }
    out!("{} can be run.", case.display());
    0
}

fn schema(reference: bool) -> u8 {
    if reference {
        terminal::write_out(format_args!("{}", carom_case::reference_page()));
        return 0;
    }
    match serde_json::to_string_pretty(&carom_case::schema::json_schema()) {
        Ok(text) => {
            out!("{text}");
            0
        }
        Err(error) => {
            err!("error: {error}");
            FAILED
        }
    }
}

fn verify(name: Option<&str>, quick: bool) -> u8 {
    let size = if quick {
        carom_verification::Size::Quick
    } else {
        carom_verification::Size::Full
    };
    match carom_verification::verify(name, size, &mut terminal::StandardOutput) {
        Ok(verdict) if verdict.holds() => 0,
        Ok(verdict) if verdict.checks == 0 => {
            err!("error: no check of this name");
            BAD_INPUT
        }
        Ok(_) => BAD,
        Err(error) => {
            err!("error: {error}");
            FAILED
        }
    }
}
