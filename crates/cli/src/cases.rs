//! Cases of the project as checks of `carom verify`: each is run from embedded files, and its rows of `[expect]` are judged.

use std::fs;
use std::path::Path;

use carom_case::{Input, Problem, build, parse};
use carom_dynamics::Silent;
use carom_output::expectations::{Expectations, Judged, Kind, Range};
use carom_verification::{Check, Error, Row, Size};

/// A case with the files that it reads.
struct Case {
    name: &'static str,
    files: &'static [(&'static str, &'static [u8])],
}

macro_rules! cases {
    ($($name:literal: $($file:literal)*,)*) => {
        const CASES: &[Case] = &[$(Case {
            name: $name,
            files: &[
                ("case.toml", include_bytes!(concat!("../../../cases/", $name, "/case.toml"))),
                $(($file, include_bytes!(concat!("../../../cases/", $name, "/", $file)))),*
            ],
        }),*];

        /// The checks, one for each case.
        pub const CHECKS: &[Check] = &[$(Check {
            name: concat!("cases/", $name),
            fact: concat!("the case ", $name, " gives what its file expects"),
            run: |size| made($name, size),
        }),*];
    };
}

// Cases with rows that take a few seconds at most. Those that are left out run for longer, or a check runs their model already.
cases! {
    "two-bars":,
    "bar-on-wall":,
    "bars-in-zones":,
    "two-bars-newmark":,
    "arlequin-bars":,
    "mass-on-stop":,
    "hertz-points":,
    "stick-slip":,
    "stiff-soft":,
    "crossed-bars": "bars.msh",
    "sliding-block": "blocks.msh",
    "bolted-plates": "plates.msh",
    "oscillators-in-earthquake":,
    "pounding":,
    "beam-on-stop": "beam.msh",
    "mast-in-zones":,
    "rolling-rod":,
    "flexible-pendulum":,
    "shell-strips": "strips.msh",
    "turning-bar": "bar.msh",
    "rigid-hammer": "hammer-and-bar.msh",
    "block-drop": "block.msh",
    "oblique-bar": "bar-coarse.msh",
    "conveyor": "crate.msh",
    "spinning-bar": "bar-plane.msh",
    "rings": "rings-coarse.msh",
    "ring-sector": "ring.msh",
    "hertz": "spheres.msh",
    "hertz-cylinder": "cylinder.msh",
    "ironing": "ironing-coarse.msh",
    "crushed-tube": "tube.msh",
    "blocks-non-matching": "flat-plane.msh",
}

/// The rows of a case; with the small size of the tests as well, since a row belongs to the file as it is.
fn made(name: &str, _: Size) -> Result<Vec<Row>, Error> {
    let case = CASES.iter().find(|case| case.name == name);
    let case = case.ok_or_else(|| failed(&format!("no case {name} is embedded")))?;
    let folder = tempfile::tempdir().map_err(|cause| failed(&cause))?;
    for (file, bytes) in case.files {
        fs::write(folder.path().join(file), bytes).map_err(|cause| failed(&cause))?;
    }
    let found = expectations(folder.path())?;
    Ok(found
        .rows
        .iter()
        .map(|(name, row)| judged(name, row))
        .collect())
}

/// Runs the case in a folder.
fn expectations(folder: &Path) -> Result<Expectations, Error> {
    let input = Input::read(&folder.join("case.toml"), &[]).map_err(refused)?;
    let (case, locator) = parse(&input).map_err(refused)?;
    let built = build(&case, &locator, &input).map_err(refused)?;
    let results = folder.join("case.carom");
    let finished = carom_case::run((&input, &case, &built), results, &mut Silent, &|| false);
    let finished = finished.map_err(|cause| failed(&cause))?;
    let found = finished.summary.expectations;
    found.ok_or_else(|| failed(&"the case has no rows of `[expect]`"))
}

/// A row as a check has it: bounds on both sides are a value with a tolerance.
fn judged(name: &str, row: &Judged) -> Row {
    let found = row.found.unwrap_or(f64::NAN);
    let unit = match row.row.unit.as_str() {
        "" => String::new(),
        unit => format!(", {unit}"),
    };
    let quantity = format!("{name}: {}{unit}", row.row);
    let new = match row.row.range {
        Range::Near { value, tolerance } => Row::near(quantity, found, value, tolerance),
        Range::Within { at_least, at_most } => match (at_least, at_most) {
            (Some(low), Some(high)) => {
                Row::near(quantity, found, 0.5 * (low + high), 0.5 * (high - low))
            }
            (Some(low), None) => Row::at_least(quantity, found, low),
            (None, Some(high)) => Row::at_most(quantity, found, high),
            (None, None) => Row::shown(quantity, found),
        },
    };
    match row.row.kind {
        Kind::ClosedForm => new,
        Kind::Published => new.published(),
        Kind::AnotherCode => new.other_code(),
        Kind::SecondFormulation => new.second_formulation(),
        Kind::Regression => new.regression(),
    }
}

fn failed(cause: &dyn std::fmt::Display) -> Error {
    Error::Case {
        cause: cause.to_string(),
    }
}

fn refused(problems: Vec<Problem>) -> Error {
    match problems.first() {
        Some(problem) => failed(problem),
        None => failed(&"the case is refused"),
    }
}
