//! `carom study`.

use carom_case::{Input, Vary};
use carom_output::study::RAW_PEAK;

use crate::sweep;

/// Arguments of `carom study`.
#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    common: sweep::Arguments,
    /// A key of the case with its values, `time.step.courant=1,0.5,0.25`; several keys vary together
    #[arg(long, required = true, value_name = "KEY=VALUES")]
    vary: Vec<String>,
}

/// Runs the study; returns the exit code.
pub fn study(arguments: &Arguments) -> u8 {
    let common = &arguments.common;
    let input = match Input::read(&common.case, &common.set) {
        Ok(input) => input,
        Err(problems) => return crate::refuse(&[], &problems),
    };
    let vary = arguments.vary.iter().map(|text| Vary::read(text));
    let vary = match vary.collect::<Result<Vec<Vary>, _>>() {
        Ok(vary) => vary,
        Err(error) => return sweep::refuse(&error),
    };
    let folder = common.folder("study");
    let studied = common.sweep(&folder, |sweep| carom_case::study(&input, &vary, sweep));
    let (study, page) = match studied {
        Ok(studied) => studied,
        Err(error) => return sweep::refuse(&error),
    };
    println!("{}\n", study.title);
    println!("{}", study.table().text(sweep::WIDTH));
    let orders = study.order_table();
    if !orders.rows.is_empty() {
        println!("Orders of convergence against {}\n", study.abscissa_text());
        println!("{}", orders.text(sweep::WIDTH));
    }
    let variants = || study.runs.iter().map(|run| &run.variant);
    sweep::reasons(variants());
    println!("  {RAW_PEAK}");
    println!("  report: {}", page.display());
    sweep::code(variants())
}
