//! `carom compare`.

use std::path::PathBuf;

use carom_case::{Choices, Input};

use crate::load::refuse;
use crate::sweep;
use crate::terminal::{line, out};

/// Arguments of `carom compare`.
#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    common: sweep::Arguments,
    /// Time schemes: `newmark`, `"newmark={beta=0.5,gamma=0.9}"`, or `case` for the scheme of the case
    #[arg(long, num_args = 1.., value_name = "SCHEME")]
    with: Vec<String>,
    /// Contact laws, for all contacts: `displacement`, `"damped={adhesion='clip'}"`, or `case`
    #[arg(long, num_args = 1.., value_name = "LAW")]
    law: Vec<String>,
    /// Other case files of the same problem; they run as they are and get a row in the same table
    #[arg(long, num_args = 1.., value_name = "CASE")]
    beside: Vec<PathBuf>,
    /// Reference for errors: `exact`, `finest` (a run with smaller elements and steps), `none`, or a variant of the table;
    /// default: the exact solution that the case names, otherwise `finest`
    #[arg(long, value_name = "NAME")]
    reference: Option<String>,
}

/// Compares; returns the exit code.
pub fn compare(arguments: &Arguments) -> u8 {
    let common = &arguments.common;
    let input = match Input::read(&common.case, &common.set) {
        Ok(input) => input,
        Err(problems) => return refuse(&[], &problems),
    };
    let mut beside = Vec::new();
    for other in &arguments.beside {
        match Input::read(other, &[]) {
            Ok(input) => beside.push(input),
            Err(problems) => return refuse(&[], &problems),
        }
    }
    let choices = Choices {
        beside,
        schemes: arguments.with.clone(),
        laws: arguments.law.clone(),
        reference: arguments.reference.clone(),
    };
    let folder = common.folder("compare");
    let compared = common.sweep(&folder, |sweep| {
        carom_case::compare(&input, &choices, sweep)
    });
    let (comparison, page) = match compared {
        Ok(compared) => compared,
        Err(error) => return sweep::refuse(&error),
    };
    out!("{}", line(&comparison.title));
    let contact = sweep::contact(comparison.contact());
    out!("{contact}Errors against {}.\n", comparison.standard_text());
    out!("{}", comparison.table().text(sweep::WIDTH));
    if let Some(unseen) = comparison.unseen() {
        out!("  {unseen}");
    }
    let variants = || comparison.variants.iter();
    sweep::reasons(variants());
    sweep::absent(&comparison.absent());
    out!(
        "  the overshoot of a single step does not converge where the force jumps; that of the mean does"
    );
    out!("  report: {}", page.display());
    sweep::code(variants())
}
