//! `carom study`.

use carom_case::{Axis, Fit, Input, SweepError};
use carom_studies::study::RAW_PEAK;

use crate::exit::FAILED;
use crate::load::refuse;
use crate::sweep;
use crate::terminal::{err, line, out};

/// Arguments of `carom study`.
#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    common: sweep::Arguments,
    /// A key of the case with its values, `time.step.courant=1,0.5,0.25`; keys separated by `;` vary together, `a=1,2;b=3,4`;
    /// several `--vary` options run all combinations
    #[arg(long, required_unless_present = "fit", value_name = "KEY=VALUES")]
    vary: Vec<String>,
    /// A key whose value is to be found, so that the run gives the result of `--to`
    #[arg(
        long,
        requires = "between",
        requires = "to",
        conflicts_with = "vary",
        value_name = "KEY"
    )]
    fit: Option<String>,
    /// The smallest and the largest value to try, in SI units
    #[arg(long, requires = "fit", value_name = "A,B", allow_hyphen_values = true)]
    between: Option<String>,
    /// The result to reach: `restitution=0.98`, any other column of `study.csv`, or `force=FILE.csv`
    #[arg(long, requires = "fit", value_name = "GOAL")]
    to: Option<String>,
}

/// Runs the study; returns the exit code.
pub fn study(arguments: &Arguments) -> u8 {
    let common = &arguments.common;
    let input = match Input::read(&common.case, &common.set) {
        Ok(input) => input,
        Err(problems) => return refuse(&[], &problems),
    };
    if let (Some(key), Some(between), Some(to)) =
        (&arguments.fit, &arguments.between, &arguments.to)
    {
        return fit(
            common,
            &input,
            Fit::read(key, between, to, common.contact.as_deref()),
        );
    }
    let vary = arguments.vary.iter().map(|text| Axis::read(text));
    let vary = match vary.collect::<Result<Vec<Axis>, _>>() {
        Ok(vary) => vary,
        Err(error) => return sweep::refuse(&error),
    };
    let folder = common.folder("study");
    let studied = common.sweep(&folder, |sweep| carom_case::study(&input, &vary, sweep));
    let (study, page) = match studied {
        Ok(studied) => studied,
        Err(error) => return sweep::refuse(&error),
    };
    out!("{}", line(&study.title));
    out!("{}\n", sweep::contact(study.contact()));
    out!("{}", study.table().text(sweep::WIDTH));
    let orders = study.order_table();
    if !orders.rows.is_empty() {
        out!("Orders of convergence against {}\n", study.abscissa_text());
        out!("{}", orders.text(sweep::WIDTH));
    }
    let envelope = study.envelope_table();
    if !envelope.rows.is_empty() {
        out!("Envelope of the runs\n");
        out!("{}", envelope.text(sweep::WIDTH));
    }
    let variants = || study.runs.iter().map(|run| &run.variant);
    sweep::reasons(variants());
    sweep::absent(&study.absent());
    out!("  {RAW_PEAK}");
    out!("  report: {}", page.display());
    sweep::code(variants())
}

fn fit(common: &sweep::Arguments, input: &Input, fit: Result<Fit, SweepError>) -> u8 {
    let fit = match fit {
        Ok(fit) => fit,
        Err(error) => return sweep::refuse(&error),
    };
    let folder = common.folder("study");
    let fitted = common.sweep(&folder, |sweep| carom_case::fit(input, &fit, sweep));
    let (study, page) = match fitted {
        Ok(fitted) => fitted,
        Err(error) => return sweep::refuse(&error),
    };
    out!("{}", line(&study.title));
    out!("{}\n", sweep::contact(study.contact()));
    out!("{}", study.table().text(sweep::WIDTH));
    let variants = || study.runs.iter().map(|run| &run.variant);
    sweep::reasons(variants());
    let code = match study.fitted.as_ref().map(|fitted| &fitted.found) {
        Some(Err(reason)) => {
            err!("error: {reason}");
            FAILED
        }
        _ => {
            out!("  {}", study.fitted_text().unwrap_or_default());
            0
        }
    };
    out!("  report: {}", page.display());
    code.max(sweep::code(variants()))
}
