//! Reading a case, or printing why it cannot be read.

use std::io::IsTerminal;
use std::path::Path;

use carom_case::{Built, Input, Locator, Problem, Source};
use carom_ranks::Ranks;

use crate::exit::{BAD_INPUT, FAILED};
use crate::terminal::err;
use crate::{diagnostics, terminal};

/// Reads and builds a case, or prints all its problems.
pub fn load(case: &Path, set: &[String]) -> Result<(Input, carom_case::schema::Case, Built), u8> {
    load_with(
        case,
        set,
        (carom_case::build as Build, |_: &[Problem]| Ok(())),
    )
}

/// [`carom_case::build`], or [`carom_case::build_to_look`].
pub type Build = fn(&carom_case::schema::Case, &Locator, &Input) -> Result<Built, Vec<Problem>>;

/// Warns of what several ranks do not share of what the first one has built.
pub fn warn_of_ranks(ranks: &Ranks, built: Option<&Built>) {
    let whole = built.and_then(carom_case::whole_on_ranks);
    if let Some(whole) = whole.filter(|_| ranks.count() > 1) {
        err!("warning: {whole}");
    }
}

/// A case as read, and on the first rank as built.
pub type Read = (Input, carom_case::schema::Case, Locator, Option<Built>);

/// As [`load`], on one of several ranks: the others than the first read it alone.
pub fn load_on(ranks: &Ranks, case: &Path, set: &[String]) -> Result<Read, u8> {
    // the first rank tells what is wrong
    let refused = |sources: &[Source], problems: &[Problem]| match ranks.is_first() {
        true => refuse(sources, problems),
        false => BAD_INPUT,
    };
    let input = Input::read(case, set).map_err(|problems| refused(&[], &problems))?;
    let wrong = |problems: Vec<Problem>| refused(&input.sources, &problems);
    let (parsed, locator) = carom_case::parse(&input).map_err(wrong)?;
    let built = match ranks.is_first() {
        true => Some(carom_case::build(&parsed, &locator, &input).map_err(wrong)?),
        false => None,
    };
    Ok((input, parsed, locator, built))
}

/// As [`load`], built by `build`; `keep` sees the problems after they are printed.
pub fn load_with(
    case: &Path,
    set: &[String],
    (build, keep): (
        Build,
        impl Fn(&[Problem]) -> Result<(), carom_output::Error>,
    ),
) -> Result<(Input, carom_case::schema::Case, Built), u8> {
    let input = Input::read(case, set).map_err(|problems| refuse(&[], &problems))?;
    let refused = |problems: Vec<Problem>| {
        let code = refuse(&input.sources, &problems);
        if let Err(error) = keep(&problems) {
            err!("error: {error}");
        }
        code
    };
    let (parsed, locator) = carom_case::parse(&input).map_err(refused)?;
    let built = build(&parsed, &locator, &input).map_err(refused)?;
    Ok((input, parsed, built))
}

/// Writes the cells that problems are about beside the case.
pub fn keep_offenders(case: &Path, problems: &[Problem]) -> Result<(), carom_output::Error> {
    let mut offenders = problems.iter().filter_map(|one| one.offenders.as_ref());
    offenders.try_for_each(|cells| cells.write(case))
}

/// Prints problems; returns the exit code.
pub fn refuse(sources: &[Source], problems: &[Problem]) -> u8 {
    let styled = std::io::stderr().is_terminal();
    terminal::write_styled(&diagnostics::render(sources, problems, styled));
    // another machine would take the case
    match problems.iter().all(|problem| problem.lacks_memory) && !problems.is_empty() {
        true => FAILED,
        false => BAD_INPUT,
    }
}
