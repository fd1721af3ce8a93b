//! One case run several times with different overrides: the loop behind comparisons and studies.
//!
//! Every run is independent and leaves a results folder of its own inside the common one. What the case does not allow
//! is an outcome, not an error; the common files are written by whoever asked.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use carom_dynamics::{Interrupt, Observer, Stepper};
use carom_output::{Folder, Reference};
use carom_studies::compare::{Done, Outcome, Recorder, Variant};
use thiserror::Error as ThisError;

use crate::error::Problem;
use crate::input::{Input, Source};
use crate::locate::Locator;
use crate::lower::{self, Built};
use crate::run::{reference, run};
use crate::schema::Case;

/// How the runs are made.
#[derive(Clone, Copy)]
pub struct Sweep<'a> {
    /// The common folder; an earlier one is replaced, with the runs in it ([`Folder::create`]).
    pub folder: &'a Path,
    /// Name of the contact that is looked at; by default that of the exact solution, else the first.
    pub contact: Option<&'a str>,
    /// Runs at one time. Times are comparable with 1 only.
    pub jobs: usize,
    /// Makes an observer for the run of this name up to this time, s.
    pub watch: &'a (dyn Fn(&str, f64) -> Box<dyn Observer> + Sync),
    /// Asked before every step.
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

/// Why there is no table at all.
#[derive(Debug, ThisError)]
pub enum SweepError {
    /// The case, or what was asked of it, is wrong. Nothing was written.
    #[error("{} problems", problems.len())]
    Input {
        /// The texts that the problems point into.
        sources: Vec<Source>,
        /// What is wrong.
        problems: Vec<Problem>,
    },
    /// A common file could not be written.
    #[error(transparent)]
    Output(#[from] carom_output::Error),
}

/// A run to make.
#[derive(Debug)]
pub(crate) struct Job {
    pub(crate) name: String,
    pub(crate) overrides: Vec<String>,
    input: Input,
    pub(crate) case: Case,
    locator: Locator,
}

impl Job {
    /// Reads the case with further overrides, `key.path=value` each.
    pub(crate) fn new(name: &str, base: &Input, overrides: Vec<String>) -> Result<Job, SweepError> {
        let mut input = base.clone();
        input.sources.extend(overrides.iter().map(|text| Source {
            name: "--set".to_owned(),
            text: text.clone(),
        }));
        match crate::parse(&input) {
            Ok((case, locator)) => Ok(Job {
                name: name.to_owned(),
                overrides,
                input,
                case,
                locator,
            }),
            Err(problems) => Err(SweepError::Input {
                sources: input.sources,
                problems,
            }),
        }
    }

    /// # Errors
    /// The case has no contact of this name.
    pub(crate) fn has_contact(&self, chosen: Option<&str>) -> Result<(), SweepError> {
        let Some(name) = chosen else { return Ok(()) };
        let names = || self.case.contact.names().chain(self.case.stop.names());
        if names().any(|own| own == name) {
            return Ok(());
        }
        let problem = Problem::new("", "no contact and no stop of this name");
        Err(SweepError::Input {
            sources: vec![Source {
                name: "--contact".to_owned(),
                text: name.to_owned(),
            }],
            problems: vec![problem.unknown(name, names())],
        })
    }

    pub(crate) fn build(&self) -> Result<Built, Vec<Problem>> {
        lower::built(&self.case, &self.locator, (&self.input, true), &[])
    }

    /// The problems as an error.
    pub(crate) fn refuse(&self, problems: Vec<Problem>) -> SweepError {
        SweepError::Input {
            sources: self.input.sources.clone(),
            problems,
        }
    }

    /// Title of the case; without one the name of its file.
    pub(crate) fn title(&self) -> String {
        let file = || self.input.sources.first().map(|source| source.name.clone());
        self.case.title.clone().or_else(file).unwrap_or_default()
    }
}

/// What became of a job.
#[derive(Debug)]
pub(crate) struct Ended {
    pub(crate) variant: Variant,
    /// The exact solution of its case.
    pub(crate) exact: Option<Reference>,
}

/// Refuses a sweep of which no run can be made, with the problems of the first; otherwise makes the folder.
pub(crate) fn prepare(jobs: &[Job], sweep: &Sweep) -> Result<Folder, SweepError> {
    let mut first = None;
    for job in jobs {
        match job.build() {
            Ok(_) => {
                let mut folder = Folder::create(sweep.folder)?;
                for job in jobs {
                    folder.nested(&job.name)?;
                }
                return Ok(folder);
            }
            Err(problems) => first = first.or_else(|| Some(job.refuse(problems))),
        }
    }
    Err(first.unwrap_or_else(|| SweepError::Input {
        sources: Vec::new(),
        problems: vec![Problem::new("", "there is nothing to run")],
    }))
}

/// Makes all runs; the outcomes in the order of the jobs.
pub(crate) fn run_all(jobs: &[Job], sweep: &Sweep) -> Vec<Ended> {
    let next = AtomicUsize::new(0);
    let ended = Mutex::new(Vec::new());
    let work = || {
        while let Some((k, job)) = {
            let k = next.fetch_add(1, Ordering::Relaxed);
            jobs.get(k).map(|job| (k, job))
        } {
            let one = run_one(job, sweep);
            // a thread that panicked ends the program after this loop: what the others found is still whole
            ended
                .lock()
                .unwrap_or_else(|e| e.into_inner())
                .push((k, one));
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..sweep.jobs.min(jobs.len()) {
            scope.spawn(work);
        }
        work();
    });
    let mut ended = ended.into_inner().unwrap_or_else(|e| e.into_inner());
    ended.sort_by_key(|(k, _)| *k);
    ended.into_iter().map(|(_, one)| one).collect()
}

fn run_one(job: &Job, sweep: &Sweep) -> Ended {
    let end = |outcome, exact| Ended {
        variant: Variant {
            name: job.name.clone(),
            overrides: job.overrides.clone(),
            outcome,
        },
        exact,
    };
    if (sweep.stop)() {
        return end(Outcome::Stopped, None);
    }
    let built = match job.build() {
        Ok(built) => built,
        Err(problems) => return end(Outcome::Refused(sentence(&problems)), None),
    };
    let place = |name: &str| {
        let mut contacts = built.system.contacts.iter();
        contacts.position(|contact| contact.name == name)
    };
    let chosen = sweep.contact.and_then(place);
    let exact = reference(&built);
    let mut observer = Watched {
        recorder: Recorder::new(&built.system, exact.as_ref(), chosen),
        watch: (sweep.watch)(&job.name, built.end),
    };
    let folder = sweep.folder.join(&job.name);
    let finished = run(
        (&job.input, &job.case, &built),
        folder,
        &mut observer,
        &|| (sweep.stop)(),
    );
    let outcome = match finished {
        Ok(finished) if finished.interrupted => Outcome::Stopped,
        Ok(finished) => Outcome::Done(Box::new(Done::new(
            finished.summary,
            observer.recorder.into_history(),
        ))),
        Err(error) => Outcome::Failed(causes(&error)),
    };
    end(outcome, exact)
}

/// The recorder of the sweep beside the observer of the user.
struct Watched {
    recorder: Recorder,
    watch: Box<dyn Observer>,
}

impl Observer for Watched {
    fn accepted(&mut self, run: &dyn Stepper) -> Result<(), carom_dynamics::Error> {
        self.recorder.accepted(run)?;
        self.watch.accepted(run)
    }

    fn finish(&mut self, run: &dyn Stepper) -> Result<(), carom_dynamics::Error> {
        self.recorder.finish(run)?;
        self.watch.finish(run)
    }

    fn interrupt(&self) -> Option<&Interrupt> {
        self.watch.interrupt()
    }
}

/// All problems in one line.
pub(crate) fn sentence(problems: &[Problem]) -> String {
    let one = |problem: &Problem| match &problem.found {
        Some(found) => format!("{problem} (found: {found})"),
        None => problem.to_string(),
    };
    problems.iter().map(one).collect::<Vec<_>>().join("; ")
}

/// An error with its causes in one line.
fn causes(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut next = error.source();
    while let Some(cause) = next {
        let words = cause.to_string();
        if !text.ends_with(&words) {
            text = format!("{text}: {words}");
        }
        next = cause.source();
    }
    text
}

/// A name for a folder, from what the user wrote: letters, digits, points and underscores; anything else between two of
/// them becomes one hyphen.
pub(crate) fn folder_name(text: &str) -> String {
    let kept = |c: char| c.is_ascii_alphanumeric() || c == '.' || c == '_';
    let parts = text.split(|c| !kept(c)).map(|part| part.trim_matches('.'));
    let parts: Vec<&str> = parts.filter(|part| !part.is_empty()).collect();
    parts.join("-")
}

/// `name`, or with a number after it the first that is not `taken`; takes it.
pub(crate) fn unique_name(name: String, taken: &mut BTreeSet<String>) -> String {
    let numbered = (2..).map(|k| format!("{name}-{k}"));
    let mut names = std::iter::once(name.clone()).chain(numbered);
    let free = names.find(|name| !taken.contains(name)).unwrap_or(name);
    taken.insert(free.clone());
    free
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_folders_come_from_the_words_of_the_user() {
        assert_eq!(
            folder_name("newmark={beta=0.5, gamma = 0.9}"),
            "newmark-beta-0.5-gamma-0.9"
        );
        assert_eq!(folder_name("damped={}"), "damped");
        assert_eq!(folder_name("../x"), "x");
        let mut taken = BTreeSet::new();
        let mut name = || unique_name("a".to_owned(), &mut taken);
        assert_eq!([name(), name(), name()], ["a", "a-2", "a-3"]);
    }
}
