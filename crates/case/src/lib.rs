//! From a case file to a model, and the run.
//!
//! Stage one, [`parse`], reads the file as TOML and checks it against the one description in [`schema`]: what comes out is complete and
//! in SI units, or every error there is. Stage two resolves names and reads meshes; it finds the places of its errors with the
//! [`Locator`].

pub mod schema;
pub mod units;

mod build;
mod compare;
mod describe;
mod error;
mod facts;
mod fit;
mod input;
mod keys;
mod locate;
mod offenders;
mod reference;
mod rules;
mod run;
mod study;
mod sweep;
mod tree;
mod validate;

pub use build::{Built, BuiltOverlap, BuiltProbe, ExactReference, build};
pub use compare::{Choices, compare};
pub use error::{Place, Problem};
pub use facts::{Fact, facts};
pub use fit::{Fit, Fitted, Goal, fit};
pub use input::{Input, Source};
pub use locate::Locator;
pub use offenders::Offenders;
pub use reference::reference_page;
pub use run::{Failed, Finished, run};
pub use study::{Axis, study};
pub use sweep::{Sweep, SweepError};

/// Reads a case: syntax, overrides, schema.
///
/// # Errors
/// Every problem that can be told from the text alone, with its place, in the order of the text.
pub fn parse(input: &Input) -> Result<(schema::Case, Locator), Vec<Problem>> {
    let root = tree::read(input)?;
    let locator = Locator::new(&root);
    let problems = validate::validate(&schema::json_schema(), &root, input);
    if !problems.is_empty() {
        return Err(locator.locate_all(problems));
    }
    let case = serde_json::from_value(root.to_json()).map_err(|cause| {
        vec![Problem::new(
            "",
            format!("the schema let pass what the reader refuses, a defect of Carom: {cause}"),
        )]
    })?;
    let problems = rules::check(&case);
    if problems.is_empty() {
        Ok((case, locator))
    } else {
        Err(locator.locate_all(problems))
    }
}
