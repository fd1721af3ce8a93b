//! A built case with the rows of what it must give: these name numbers of a run, which follow from the system.

use std::path::PathBuf;

use crate::error::Problem;
use crate::expect::{Names, changes_the_model, rows};
use crate::input::Input;
use crate::locate::Locator;
use crate::lower::{self, AddedForce, Built};
use crate::origin::Origin;
use crate::run::settings;
use crate::schema::Case;

/// Builds the system of a case.
///
/// # Errors
/// All problems that stage two can tell, with their places.
pub fn build(case: &Case, locator: &Locator, input: &Input) -> Result<Built, Vec<Problem>> {
    build_with(case, locator, input, &[])
}

/// As [`build`], to look at: nothing is written, a reduction that has a file and is made anew is not saved.
///
/// # Errors
/// As [`build`].
pub fn build_to_look(case: &Case, locator: &Locator, input: &Input) -> Result<Built, Vec<Problem>> {
    let built = lower::built(case, locator, (input, false), &[])?;
    with_rows((case, locator, input), built)
}

/// As [`build`], with forces that are in no case file.
///
/// # Errors
/// As [`build`]; those of the forces have no place.
pub fn build_with(
    case: &Case,
    locator: &Locator,
    input: &Input,
    forces: &[AddedForce],
) -> Result<Built, Vec<Problem>> {
    let built = lower::built(case, locator, (input, true), forces)?;
    with_rows((case, locator, input), built)
}

fn with_rows(
    (case, locator, input): (&Case, &Locator, &Input),
    mut built: Built,
) -> Result<Built, Vec<Problem>> {
    if case.expect.is_empty() {
        return Ok(built);
    }
    let settings = settings((input, case, &built), PathBuf::new(), &Origin::of_none());
    let names = Names::of(&built.system, &settings);
    let mut overrides = input.sources.iter().skip(1);
    let changed = overrides.any(|source| changes_the_model(&source.text));
    let rows = rows((case, changed), &names, built.end);
    built.expected = rows.map_err(|problems| locator.locate_all(problems))?;
    Ok(built)
}
