//! The executable: `carom run`, `resume`, `report`, `compare`, `study`, `modes`, `check`, `convert`, `schema`, `new`, `verify`, `completion`, `man`.
//!
//! Exit codes: 0 done and the verdict `good` or `look`, 2 bad input, 3 the run failed with the last good state on disk, 4 done but
//! the verdict bad, 130 interrupted. All that it prints goes through [`terminal`].

mod cases;
mod check;
mod compare;
mod contacts;
mod diagnostics;
mod exit;
mod expectations;
mod load;
mod modes;
mod new;
mod progress;
mod ranks;
mod report;
mod resume;
mod run;
mod signals;
mod study;
mod sweep;
mod terminal;
mod verify;

use std::io::IsTerminal;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use carom_ranks::Ranks;
use clap::{CommandFactory, Parser, Subcommand};

use crate::exit::{BAD_INPUT, FAILED};
use crate::terminal::{err, out};

/// Computes the impact of deformable bodies: a case file, a run, a report
///
/// Carom solves the motion of bars, plane, axisymmetric and solid bodies, beams, shells and rigid bodies that hit each other,
/// themselves or a rigid obstacle, at small or finite strain. A case file names the bodies, a contact law and a time scheme. A run
/// writes histories, fields, figures and a report that says whether its result can be trusted.
///
/// To begin: `carom new two-bars`, then `carom run case.toml`.
#[derive(Parser)]
#[command(name = "carom", version)]
struct Arguments {
    /// Number of threads; default: as many as the machine has, of several ranks their share. Results do not depend on it
    #[arg(long, value_name = "NUMBER", global = true)]
    threads: Option<NonZeroUsize>,
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
    /// Write report, figures and summary of a results folder anew, from its last checkpoint: of a run that was killed too
    Report(report::Arguments),
    /// Run a case under several schemes and contact laws: one table, one figure per quantity, one report
    Compare(compare::Arguments),
    /// Run a case over the values of a key, with orders of convergence; or find the value that gives a result
    Study(study::Arguments),
    /// Compute frequencies, shapes and effective masses of the bodies of a case
    Modes(modes::Arguments),
    /// Check a case without running it: errors, warnings, sizes, wave speeds, first possible impact, steps
    Check(check::Arguments),
    /// Write the mesh of a file in another format: `.vtu`, with a field for each group
    Convert {
        /// A mesh: `.msh`, `.inp`, `.stl` or `.vtu`
        from: PathBuf,
        /// The file to write: `.vtu`
        to: PathBuf,
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
        /// Write a page with the problem, the reference and the errors of each check to this file
        #[arg(long, value_name = "FILE.html")]
        report: Option<PathBuf>,
    },
    /// Print the completion of this command for a shell: `carom completion bash > ~/.local/share/bash-completion/completions/carom`
    Completion {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page of this command and of its subcommands: `carom man | man -l -`
    Man,
}

fn main() -> ExitCode {
    let code = match Arguments::try_parse() {
        Ok(arguments) => obey(arguments),
        // one of several processes tells what is wrong with their words
        Err(answer) if ranks::is_another() => u8::try_from(answer.exit_code()).unwrap_or(BAD_INPUT),
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

fn obey(arguments: Arguments) -> u8 {
    let Arguments {
        threads,
        log,
        command,
    } = arguments;
    tracing_subscriber::fmt()
        .with_max_level(log)
        .with_ansi(std::io::stderr().is_terminal())
        .with_writer(|| terminal::StandardError)
        .init();
    let takes = matches!(command, Command::Run(_) | Command::Resume(_));
    ranks::with_ranks(takes, |ranks| {
        let threads = ranks::threads(ranks, threads);
        if takes || threads.is_some() {
            let mut pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0));
            if takes {
                // one of them is this one, which the loops of a step need not wake then; and MPI is its
                pool = pool.use_current_thread();
            }
            if let Err(error) = pool.build_global() {
                err!("error: {error}");
                return FAILED;
            }
        }
        commanded(command, ranks)
    })
}

fn commanded(command: Command, ranks: &Ranks) -> u8 {
    match command {
        Command::Run(arguments) => run::run(&arguments, ranks),
        Command::Resume(arguments) => resume::resume(&arguments, ranks),
        Command::Report(arguments) => report::report(&arguments),
        Command::Compare(arguments) => compare::compare(&arguments),
        Command::Study(arguments) => study::study(&arguments),
        Command::Modes(arguments) => modes::modes(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Convert { from, to } => convert(&from, &to),
        Command::Schema { reference } => schema(reference),
        Command::New { template, file } => new::new(template.as_deref(), &file),
        Command::Verify {
            name,
            quick,
            report,
        } => verify::verify(name.as_deref(), quick, report.as_deref()),
        Command::Completion { shell } => {
            let command = &mut Arguments::command();
            clap_complete::generate(shell, command, "carom", &mut terminal::StandardOutput);
            0
        }
        Command::Man => man(),
    }
}

/// Prints the manual page of the command, and those of its subcommands after it.
fn man() -> u8 {
    let mut command = Arguments::command();
    // names and global arguments reach the subcommands
    command.build();
    let subcommands = command.get_subcommands().cloned();
    let own = std::iter::once(command.clone()).chain(subcommands);
    for page in own.filter(|page| page.get_name() != "help") {
        if let Err(error) = clap_mangen::Man::new(page).render(&mut terminal::StandardOutput) {
            err!("error: {error}");
            return FAILED;
        }
    }
    0
}

fn convert(from: &Path, to: &Path) -> u8 {
    match carom_case::convert(from, to) {
        Ok([nodes, elements, groups]) => {
            out!(
                "Wrote {}: {nodes} nodes, {elements} elements, {groups} groups.",
                to.display()
            );
            0
        }
        Err(carom_case::NotConverted::Unwritten(error)) => {
            err!("error: {error}");
            FAILED
        }
        Err(error) => {
            err!("error: {error}");
            BAD_INPUT
        }
    }
}

fn schema(reference: bool) -> u8 {
    if reference {
        terminal::write_out(format_args!("{}", carom_case::reference_page()));
        return 0;
    }
    match serde_json::to_string_pretty(&carom_case::schema::json_schema()) {
        Ok(text) => {
            terminal::write_json(&(text + "\n"));
            0
        }
        Err(error) => {
            err!("error: {error}");
            FAILED
        }
    }
}
