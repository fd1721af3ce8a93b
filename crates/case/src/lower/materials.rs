//! Materials: the law of each, its parameters in their ranges.

use std::collections::BTreeMap;

use carom_materials::Law;

use super::context::Context;
use super::problems::Problems;
use crate::error::Problem;

/// The laws by name; those out of range are told, and stay, so that bodies find them.
pub(super) fn lower(context: &Context, problems: &mut Problems) -> BTreeMap<String, Law> {
    let mut laws = BTreeMap::new();
    for (name, material) in context.case.material.iter() {
        let (key, law) = (material.0.key(), material.0);
        if let Err(out) = law.check() {
            let parameter = match out.parameter {
                "sum of the ratios" => "branches",
                parameter => parameter,
            };
            let path = format!("material.{name}.{key}.{parameter}");
            let message = format!("out of range: {} must be {}", out.parameter, out.accepted);
            problems.push(Problem::new(path, message).found(out.value));
        }
        laws.insert(name.to_string(), law);
    }
    laws
}
