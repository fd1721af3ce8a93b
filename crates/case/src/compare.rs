//! `carom compare`: the variants of a case under several schemes and contact laws.

use std::collections::BTreeSet;
use std::path::PathBuf;

use carom_output::compare::{Comparison, Standard};

use crate::error::Problem;
use crate::input::{Input, Source};
use crate::sweep::{Job, Sweep, SweepError, folder_name, prepare, run_all, unique_name};

/// What the user wants compared.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Choices {
    /// Schemes, each `name` (with its defaults), `name={ parameters }`, or `case` for the one of the case; none: that of
    /// the case.
    pub schemes: Vec<String>,
    /// Contact laws, written in the same way; each is given to all contacts of the case.
    pub laws: Vec<String>,
    /// `exact`, `finest`, `none`, or the name of a variant; by default the exact solution, or without one `finest`.
    pub reference: Option<String>,
}

/// Word for the scheme or law of the case as it is.
const AS_IT_IS: &str = "case";
/// Name of the run with a quarter of the step.
const FINEST: &str = "finest";
/// Steps of the finest run in one step of the case.
const REFINEMENT: f64 = 4.0;

/// Runs every scheme with every law and writes the comparison into the folder of `sweep`; returns it with the path of its
/// page. Pairs that the case does not allow, and runs that fail, keep their rows with the reason.
///
/// # Errors
/// The case or a choice is wrong, or no pair at all can be run: nothing is written then. A common file cannot be written.
pub fn compare(
    input: &Input,
    choices: &Choices,
    sweep: &Sweep,
) -> Result<(Comparison, PathBuf), SweepError> {
    let base = Job::new("", input, Vec::new())?;
    base.has_contact(sweep.contact)?;
    let mut jobs = variants(&base, input, choices)?;
    let standard = standard(&base, input, choices, &mut jobs)?;
    let mut folder = prepare(&jobs, sweep)?;
    let mut ended = run_all(&jobs, sweep);
    let mut comparison = Comparison {
        title: base.title(),
        standard,
        exact: ended.iter_mut().find_map(|one| one.exact.take()),
        variants: ended.into_iter().map(|one| one.variant).collect(),
    };
    comparison.judge();
    let page = comparison.write(&mut folder)?;
    Ok((comparison, page))
}

/// A job for every scheme with every law.
fn variants(base: &Job, input: &Input, choices: &Choices) -> Result<Vec<Job>, SweepError> {
    let contacts: Vec<&str> = base.case.contact.names().collect();
    if contacts.is_empty() && !choices.laws.is_empty() {
        let problem = Problem::new(
            "",
            "`--law` chooses a contact law, and the case has no contact",
        );
        return Err(base.refuse(vec![problem]));
    }
    let schemes = parts(&choices.schemes, &["time.scheme".to_owned()]);
    let laws: Vec<String> = contacts
        .iter()
        .map(|contact| format!("contact.{contact}.law"))
        .collect();
    let laws = parts(&choices.laws, &laws);
    let mut taken = BTreeSet::from([FINEST.to_owned()]);
    let mut jobs: Vec<Job> = Vec::new();
    for (scheme, change) in &schemes {
        for (law, changes) in &laws {
            let names = [scheme, law].into_iter().filter(|name| !name.is_empty());
            let name = names.map(String::as_str).collect::<Vec<_>>().join("_");
            let name = if name.is_empty() { AS_IT_IS } else { &name };
            let overrides = [change.as_slice(), changes].concat();
            if jobs.iter().all(|job| job.overrides != overrides) {
                let name = unique_name(name.to_owned(), &mut taken);
                jobs.push(Job::new(&name, input, overrides)?);
            }
        }
    }
    Ok(jobs)
}

/// The names of the choices and the overrides that make them, at each of `keys`. Without a choice: what is in the case,
/// without a name.
fn parts(choices: &[String], keys: &[String]) -> Vec<(String, Vec<String>)> {
    if choices.is_empty() {
        return vec![(String::new(), Vec::new())];
    }
    let part = |choice: &String| {
        let choice = choice.trim();
        let value = match choice.contains('=') {
            true => format!("{{ {choice} }}"),
            false => format!("{{ {choice} = {{}} }}"),
        };
        let changes = keys.iter().map(|key| format!("{key}={value}"));
        let changes = changes.filter(|_| choice != AS_IT_IS);
        (folder_name(choice), changes.collect())
    };
    choices.iter().map(part).collect()
}

/// What the variants are compared with; adds the finest run where it is needed.
fn standard(
    base: &Job,
    input: &Input,
    choices: &Choices,
    jobs: &mut Vec<Job>,
) -> Result<Standard, SweepError> {
    let exact = base.case.reference.is_some();
    let default = if exact { "exact" } else { FINEST };
    match choices.reference.as_deref().unwrap_or(default) {
        "none" => Ok(Standard::Nothing),
        "exact" if exact => Ok(Standard::Exact),
        FINEST => {
            let built = base.build().map_err(|problems| base.refuse(problems))?;
            let step = format!("time.step={:?}", built.system.dt / REFINEMENT);
            jobs.push(Job::new(FINEST, input, vec![step])?);
            Ok(Standard::Run(FINEST.to_owned()))
        }
        name if jobs.iter().any(|job| job.name == name) => Ok(Standard::Run(name.to_owned())),
        name => {
            let own = jobs.iter().map(|job| job.name.as_str());
            let names = own.chain([FINEST, "none"]).chain(exact.then_some("exact"));
            let message = match name {
                "exact" => "the case names no exact solution to compare with",
                _ => "no variant of this name to compare with",
            };
            Err(SweepError::Input {
                sources: vec![Source {
                    name: "--reference".to_owned(),
                    text: name.to_owned(),
                }],
                problems: vec![Problem::new("", message).unknown(name, names)],
            })
        }
    }
}
