//! One model computed in several ways: the figures of merit of each way in one table, their curves in one figure per
//! quantity, and a page with both.
//!
//! The variants are plain data here: how they are made and run is known to the case, their names are the user's. A
//! variant that was refused or failed keeps its row, with the reason.

mod columns;
mod figures;
mod history;
pub(crate) mod page;

use carom_output::results::Reference;
use carom_output::summary::{Contact, Summary};
use carom_output::verdict::{Grade, Line, force_error};
use carom_pages::form::percent;
pub use columns::{COLUMNS, Column};
pub use history::{History, Recorder, StepForce};

/// All variants, in the order of the table.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Title of the case.
    pub title: String,
    /// What force, overshoot and impulse are compared with.
    pub standard: Standard,
    /// How the run that is the standard was refined, if it was made for that.
    pub refined: Option<Refined>,
    /// The exact solution, drawn under the curves; `None` where the case names none.
    pub exact: Option<Reference>,
    /// The variants.
    pub variants: Vec<Variant>,
}

/// What the variants are compared with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Standard {
    /// The exact solution that the case names.
    Exact,
    /// The variant of this name.
    Run(String),
    /// Nothing: the columns that need it stay empty.
    Nothing,
}

/// A run of the case with smaller elements and steps, made to be the standard.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refined {
    /// Its elements and steps are those of the case over this number.
    pub factor: u32,
    /// Why its mesh is that of the case; `None` where the mesh is refined too.
    pub same_mesh: Option<String>,
    /// Whether borders may be curved, which a refined mesh does not follow.
    pub from_file: bool,
}

/// One way to compute the model.
#[derive(Clone, Debug)]
pub struct Variant {
    /// Its name, which is that of its folder too.
    pub name: String,
    /// What it changes in the case: `key.path=value`.
    pub overrides: Vec<String>,
    /// What became of it.
    pub outcome: Outcome,
}

/// What became of a variant.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// It was computed.
    Done(Box<Done>),
    /// The case does not allow it: why.
    Refused(String),
    /// It failed while it ran: why. Its folder holds what was computed before.
    Failed(String),
    /// Somebody stopped the comparison before its end.
    Stopped,
}

/// A variant that was computed.
#[derive(Clone, Debug)]
pub struct Done {
    /// Its summary.
    pub summary: Summary,
    /// Its histories.
    pub history: History,
    /// Its distance from the standard; filled by [`Comparison::judge`].
    pub errors: Errors,
    /// What the distance of the force from a run says, beside the verdict of its own; filled by [`Comparison::judge`].
    pub line: Option<Line>,
}

/// Distance from the standard. Relative; `None` where there is nothing to be relative to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// L² error of the force, step by step against the mean of the standard over the step, on the steps in which the
    /// standard has a force.
    pub force: Option<f64>,
    /// Largest force of a single step over the largest of the standard, less one. The largest of the standard is the
    /// exact one, or the largest mean over the window of a reference run: its raw peak is no standard.
    pub overshoot: Option<f64>,
    /// The same of the largest mean of the force over the window.
    pub mean_overshoot: Option<f64>,
    /// Error of the impulse.
    pub impulse: Option<f64>,
}

impl Variant {
    /// The result, if there is one.
    pub fn done(&self) -> Option<&Done> {
        match &self.outcome {
            Outcome::Done(done) => Some(done),
            Outcome::Refused(_) | Outcome::Failed(_) | Outcome::Stopped => None,
        }
    }

    /// One word and the reason for it: `good`, `look`, `bad`, `refused`, `failed`, `stopped`.
    pub fn verdict(&self) -> (&'static str, String) {
        match &self.outcome {
            Outcome::Done(done) => {
                let (verdict, grade) = (&done.summary.verdict, done.grade());
                let line = done.line.as_ref();
                let line = line
                    .filter(|line| line.grade != Grade::Good)
                    .map(Line::text);
                let reasons = verdict.reasons().into_iter().chain(line);
                (grade.word(), reasons.collect::<Vec<_>>().join("; "))
            }
            Outcome::Refused(reason) => ("refused", reason.clone()),
            Outcome::Failed(reason) => ("failed", reason.clone()),
            Outcome::Stopped => ("stopped", "the comparison was interrupted".to_owned()),
        }
    }
}

impl Done {
    /// A result not yet judged.
    pub fn new(summary: Summary, history: History) -> Done {
        Done {
            summary,
            history,
            errors: Errors::default(),
            line: None,
        }
    }

    /// The worse of the grade of the run and that of its distance from the reference.
    fn grade(&self) -> Grade {
        let own = self.summary.verdict.grade;
        let line = self.line.as_ref();
        line.map_or(own, |line| own.max(line.grade))
    }

    /// Whether the run is graded bad.
    pub(crate) fn is_bad(&self) -> bool {
        self.grade() == Grade::Bad
    }

    /// The contact that is compared.
    pub fn contact(&self) -> Option<&Contact> {
        self.summary.contacts.get(self.history.contact.as_ref()?)
    }

    fn against_exact(&self) -> Errors {
        let exact = self.summary.exact.as_ref();
        Errors {
            force: exact.and_then(|exact| exact.force_error),
            overshoot: exact.and_then(|exact| exact.overshoot),
            mean_overshoot: exact.and_then(|exact| exact.mean_overshoot),
            impulse: exact.map(|exact| exact.impulse_error),
        }
    }

    fn against_run(&self, standard: &Done) -> Errors {
        let over = |value: f64, of: f64| (of > 0.0).then(|| value / of - 1.0);
        let both = self.contact().zip(standard.contact());
        Errors {
            force: self.history.force.distance(&standard.history.force),
            overshoot: both.and_then(|(own, its)| over(own.peak_force, its.peak_mean_force?)),
            mean_overshoot: both
                .and_then(|(own, its)| over(own.peak_mean_force?, its.peak_mean_force?)),
            impulse: both.and_then(|(own, its)| over(own.impulse?, its.impulse?)),
        }
    }
}

impl Comparison {
    /// Fills the errors of all variants against the standard. A standard that was not computed leaves them empty.
    pub fn judge(&mut self) {
        let standard = match &self.standard {
            Standard::Run(name) => {
                let named = self.variants.iter().find(|variant| variant.name == *name);
                named.and_then(Variant::done).cloned()
            }
            Standard::Exact | Standard::Nothing => None,
        };
        for variant in &mut self.variants {
            if let Outcome::Done(done) = &mut variant.outcome {
                done.errors = match (&self.standard, &standard) {
                    (Standard::Exact, _) => done.against_exact(),
                    (Standard::Run(_), Some(standard)) => done.against_run(standard),
                    (Standard::Run(_), None) | (Standard::Nothing, _) => Errors::default(),
                };
                done.line = match (&self.standard, done.errors.force) {
                    (Standard::Run(name), Some(error)) if *name != variant.name => {
                        Some(force_error(&format!("the run `{name}`"), error))
                    }
                    _ => None,
                };
            }
        }
    }

    /// Name of the contact that is looked at; `None` where no variant was computed, or the case has none.
    pub fn contact(&self) -> Option<&str> {
        let mut done = self.variants.iter().filter_map(Variant::done);
        done.find_map(|done| done.history.contact.as_deref())
    }

    /// The standard in words.
    pub fn standard_text(&self) -> String {
        match &self.standard {
            Standard::Exact => {
                let name = self.exact.as_ref().map_or("", |exact| &exact.name);
                format!("the exact solution `{name}`")
            }
            Standard::Run(name) => format!("the run `{name}`"),
            Standard::Nothing => "nothing".to_owned(),
        }
    }

    /// What part of the error the table cannot show; `None` where the standard is exact, or there is none.
    pub fn unseen(&self) -> Option<String> {
        let Standard::Run(name) = &self.standard else {
            return None;
        };
        let Some(Refined {
            factor,
            same_mesh,
            from_file,
        }) = &self.refined
        else {
            return Some(format!(
                "Not shown: the error of `{name}` itself, and errors that the variants share with it, those of mesh and step included."
            ));
        };
        if let Some(why) = same_mesh {
            return Some(format!(
                "Not shown: the error of the mesh. `{name}` has 1/{factor} of the step on the mesh of the case, which cannot be refined: {why}"
            ));
        }
        let own = |p: f64| 1.0 / (f64::from(*factor).powf(p) - 1.0);
        let as_it_is = self.variants.iter().find(|v| v.overrides.is_empty());
        let distance = as_it_is.and_then(|v| v.done()?.errors.force);
        let [smooth, jump] = match distance {
            Some(d) => [1.0, 1.0 / 3.0].map(|p| format!("{} of the force", percent(d * own(p)))),
            None => [1.0, 1.0 / 3.0]
                .map(|p| format!("{} of the distance of the case from it", percent(own(p)))),
        };
        let mut text = format!(
            "Not shown: the error of `{name}` itself, the case with 1/{factor} of the size of its elements and of its step. If the \
             error decreases like the size to the power p, it is {smooth} for p = 1 and {jump} for p = 1/3, about the order where \
             the exact force jumps."
        );
        if *from_file {
            text += " Curved borders have the shape of the coarse mesh in both.";
        }
        Some(text)
    }
}
