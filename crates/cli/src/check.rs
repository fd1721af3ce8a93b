//! `carom check`.

use std::path::{Path, PathBuf};
use std::time::Duration;

use carom_case::{Built, Estimate, Fact, Offenders, Problem};
use carom_output::atomic;
use carom_pages::plot::quantity;

use crate::exit::{BAD_INPUT, FAILED};
use crate::load::{Build, keep_offenders, load_with};
use crate::terminal::{err, line, out, write_json};

/// For so long the estimate takes steps.
const PATIENCE: Duration = Duration::from_secs(3);

/// Arguments of `carom check`.
#[derive(clap::Args)]
pub struct Arguments {
    /// The case file
    case: PathBuf,
    /// Replace a value of the case: `--set time.scheme.theta.theta=0.6`
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Take the first steps, for some seconds, and say how long the run will take and how much memory
    #[arg(long)]
    estimate: bool,
    /// Draw the model into this SVG file
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// Write the cells that are worth a look, or that a problem is about, into the folder `CASE.check` beside the case
    #[arg(long)]
    cells: bool,
    /// Print the facts and warnings as JSON
    #[arg(long)]
    json: bool,
}

/// Checks a case; returns the exit code. Nothing is written but what is asked for.
pub fn check(arguments: &Arguments) -> u8 {
    let case = &arguments.case;
    let keep_cells = |problems: &[Problem]| match arguments.cells {
        true => keep_offenders(case, problems),
        false => Ok(()),
    };
    let how = (carom_case::build_to_look as Build, keep_cells);
    let loaded = load_with(case, &arguments.set, how);
    let (input, parsed, mut built) = match loaded {
        Ok(loaded) => loaded,
        Err(code) => return code,
    };
    let mut facts = carom_case::facts(&built);
    let (of_mesh, offenders) = carom_case::mesh_facts(&built);
    facts.extend(of_mesh);
    if !arguments.cells {
        let told =
            |cells: &Offenders| format!("`--cells` writes them to {}", cells.path(case).display());
        facts.extend(offenders.iter().map(|cells| fact(&cells.name, told(cells))));
    } else if let Err(code) = keep(&offenders, case, &mut facts) {
        return code;
    }
    if arguments.estimate {
        match carom_case::estimate((&input, &parsed, &mut built), PATIENCE) {
            Ok(estimate) => facts.push(told(&estimate)),
            Err(error) => {
                err!("error: {error}");
                return FAILED;
            }
        }
    }
    if let Some(path) = &arguments.picture {
        if let Err(code) = draw(&built, path) {
            return code;
        }
        facts.push(fact("picture", path.display().to_string()));
    }
    match arguments.json {
        true => json(&built, &facts),
        false => print(&built, &facts, case),
    }
}

fn fact(name: &str, value: String) -> Fact {
    Fact {
        name: name.to_owned(),
        value,
    }
}

/// Writes the cells that are worth a look.
fn keep(offenders: &[Offenders], case: &Path, facts: &mut Vec<Fact>) -> Result<(), u8> {
    for cells in offenders {
        cells.write(case).map_err(|error| {
            err!("error: {error}");
            FAILED
        })?;
        facts.push(fact(&cells.name, cells.path(case).display().to_string()));
    }
    Ok(())
}

fn told(estimate: &Estimate) -> Fact {
    let memory = estimate.bytes.map_or(String::new(), |bytes| {
        format!(", {:.0} MB of memory", bytes as f64 / 1e6)
    });
    let solver = estimate
        .solver
        .map_or(String::new(), |solver| format!("; equations by {solver}"));
    let value = format!(
        "about {}{memory}, as its first {} of {} steps{solver}",
        quantity(estimate.seconds, "s"),
        estimate.tried,
        estimate.steps
    );
    fact("the run takes", value)
}

fn draw(built: &Built, path: &Path) -> Result<(), u8> {
    let Some(picture) = carom_output::model_picture(&built.system) else {
        err!("error: a model of points and springs alone has no picture");
        return Err(BAD_INPUT);
    };
    let written = picture
        .map_err(carom_output::Error::from)
        .and_then(|svg| atomic::write_text(path, &svg));
    written.map_err(|error| {
        err!("error: {error}");
        FAILED
    })
}

fn print(built: &Built, facts: &[Fact], case: &Path) -> u8 {
    for fact in facts {
        out!("{:<18} {}", fact.name, line(&fact.value));
    }
    for warning in &built.warnings {
        out!("{:<18} {}", "warning", line(warning));
    }
    out!("{} can be run.", case.display());
    0
}

fn json(built: &Built, facts: &[Fact]) -> u8 {
    let pairs: Vec<[&str; 2]> = facts
        .iter()
        .map(|fact| [&*fact.name, &*fact.value])
        .collect();
    let value = serde_json::json!({ "facts": pairs, "warnings": built.warnings });
    write_json(&format!("{value:#}\n"));
    0
}
