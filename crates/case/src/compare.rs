//! `carom compare`: the variants of a case under several schemes and contact laws.

use std::collections::BTreeSet;
use std::path::PathBuf;

use carom_studies::compare::{Comparison, Refined, Standard};

use crate::error::Problem;
use crate::input::{Input, Source};
use crate::sweep::{Job, Sweep, SweepError, folder_name, prepare, run_all, sentence, unique_name};

/// What the user wants compared.
#[derive(Clone, Debug, Default)]
pub struct Choices {
    /// Schemes, each `name` (with its defaults), `name={ parameters }`, or `case` for the one of the case; none: that of
    /// the case.
    pub schemes: Vec<String>,
    /// Contact laws, written in the same way; each is given to all contacts of the case.
    pub laws: Vec<String>,
    /// Other cases, as they are, in the same table.
    pub beside: Vec<Input>,
    /// `exact`, `finest`, `none`, or the name of a variant; by default the exact solution, or without one `finest`.
    pub reference: Option<String>,
}

/// Word for the scheme or law of the case as it is.
const AS_IT_IS: &str = "case";
/// Name of the run with smaller elements and steps.
const FINEST: &str = "finest";
/// How often elements and steps of the finest run are halved: twice in models of bars, whose cost grows with the square of
/// the factor, once in others, where it grows with the third or fourth power.
const HALVINGS: [u32; 2] = [2, 1];

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
    let (standard, refined) = standard(&base, input, choices, &mut jobs)?;
    let mut folder = prepare(&jobs, sweep)?;
    let mut ended = run_all(&jobs, sweep);
    let mut comparison = Comparison {
        title: base.title(),
        standard,
        refined,
        exact: ended.iter_mut().find_map(|one| one.exact.take()),
        variants: ended.into_iter().map(|one| one.variant).collect(),
    };
    comparison.judge();
    let page = comparison.write(&mut folder)?;
    Ok((comparison, page))
}

/// A job for every scheme with every law.
fn variants(base: &Job, input: &Input, choices: &Choices) -> Result<Vec<Job>, SweepError> {
    let contacts = base.case.contact.names();
    let contacts = contacts.map(|contact| format!("contact.{contact}.law"));
    let stops = base.case.stop.names();
    let stops = stops.map(|stop| format!("stop.{stop}.law"));
    let laws: Vec<String> = contacts.chain(stops).collect();
    if laws.is_empty() && !choices.laws.is_empty() {
        let problem = Problem::new(
            "",
            "`--law` chooses a contact law, and the case has no contact and no stop",
        );
        return Err(base.refuse(vec![problem]));
    }
    let schemes = parts(&choices.schemes, &["time.scheme".to_owned()]);
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
    for other in &choices.beside {
        let path = other
            .sources
            .first()
            .map(|source| PathBuf::from(&source.name));
        let stem = path.as_deref().and_then(|path| path.file_stem());
        let name = stem.map_or("beside".to_owned(), |stem| {
            stem.to_string_lossy().into_owned()
        });
        let name = unique_name(folder_name(&name), &mut taken);
        jobs.push(Job::new(&name, other, Vec::new())?);
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
) -> Result<(Standard, Option<Refined>), SweepError> {
    let exact = base.case.reference.is_some();
    let default = if exact { "exact" } else { FINEST };
    match choices.reference.as_deref().unwrap_or(default) {
        "none" => Ok((Standard::Nothing, None)),
        "exact" if exact => Ok((Standard::Exact, None)),
        FINEST => {
            let (job, refined) = finest(base, input)?;
            jobs.push(job);
            Ok((Standard::Run(FINEST.to_owned()), Some(refined)))
        }
        name if jobs.iter().any(|job| job.name == name) => {
            Ok((Standard::Run(name.to_owned()), None))
        }
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

/// The case with smaller elements and steps; with smaller steps alone where its mesh cannot be refined.
fn finest(base: &Job, input: &Input) -> Result<(Job, Refined), SweepError> {
    let built = base.build().map_err(|problems| base.refuse(problems))?;
    let bodies = built.system.bodies.iter();
    let dims = bodies.filter_map(|body| match (body.as_solid(), body.as_beam()) {
        (Some(solid), _) => Some(solid.kinematics().dim()),
        (None, beam) => beam.map(|_| 1),
    });
    let bars = dims.max() == Some(1);
    let halvings = HALVINGS[usize::from(!bars)];
    let factor = 2u32.pow(halvings);
    let step = format!("time.step={:?}", built.system.dt / f64::from(factor));
    let mesh = &base.case.mesh;
    let refine = format!("mesh.refine={}", mesh.refine + halvings);
    let finer = Job::new(FINEST, input, vec![refine, step.clone()]);
    let problems = match finer {
        Ok(job) => match job.build() {
            Ok(_) => {
                let refined = Refined {
                    factor,
                    same_mesh: None,
                    from_file: mesh.file.is_some() || !mesh.part.is_empty(),
                };
                return Ok((job, refined));
            }
            Err(problems) => problems,
        },
        Err(SweepError::Input { problems, .. }) => problems,
        Err(other) => return Err(other),
    };
    let refined = Refined {
        factor,
        same_mesh: Some(sentence(&problems)),
        from_file: mesh.file.is_some() || !mesh.part.is_empty(),
    };
    Ok((Job::new(FINEST, input, vec![step])?, refined))
}
