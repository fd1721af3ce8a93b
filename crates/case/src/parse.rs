//! Stage one: from the text to a complete case.

use crate::{Input, Locator, Problem, repeat, rules, schema, tree, validate};

/// Reads a case: syntax, overrides, repetition, schema.
///
/// # Errors
/// Every problem that can be told from the text alone, with its place, in the order of the text.
pub fn parse(input: &Input) -> Result<(schema::Case, Locator), Vec<Problem>> {
    let mut root = tree::read(input)?;
    if let Err(problems) = repeat::expand(&mut root) {
        return Err(Locator::new(&root).locate_all(problems));
    }
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
