//! Whether a result can be relied on: graded lines, each with its number, its bounds and what would put it right.

use carom_pages::form::Form;
use serde::{Deserialize, Serialize};

/// Part of a bound that rounding may leave of a number that is as large.
const ROUNDING: f64 = 1e-8;

/// How far something can be relied on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Grade {
    /// Within its bounds.
    #[default]
    Good,
    /// Somebody should look at it before the result is used.
    Look,
    /// Not to be relied on.
    Bad,
}

impl Grade {
    /// In one word.
    pub fn word(self) -> &'static str {
        match self {
            Grade::Good => "good",
            Grade::Look => "look",
            Grade::Bad => "bad",
        }
    }
}

/// Bounds of the magnitude of a number, at least one of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bounds {
    /// Bad above it.
    Bad(f64),
    /// To be looked at above it, never bad.
    Look(f64),
    /// To be looked at above the first, bad above the second.
    Both(f64, f64),
}

impl Bounds {
    /// The bound of `look` and that of `bad`.
    fn pair(self) -> [Option<f64>; 2] {
        match self {
            Bounds::Bad(bad) => [None, Some(bad)],
            Bounds::Look(look) => [Some(look), None],
            Bounds::Both(look, bad) => [Some(look), Some(bad)],
        }
    }

    /// The grade of a number; what is not a number is bad. A number that is at a bound but for rounding (1e-8) is within it: it would be graded by
    /// the last bits of a run.
    pub fn grade(self, value: f64) -> Grade {
        let above = |bound: f64| value.abs() > bound * (1.0 + ROUNDING);
        let [look, bad] = self.pair().map(|bound| bound.is_some_and(above));
        match (look, bad || value.is_nan()) {
            (_, true) => Grade::Bad,
            (true, false) => Grade::Look,
            (false, false) => Grade::Good,
        }
    }
}

/// One line of a verdict: a number with its bounds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Name for scripts: `energy-residual`.
    pub name: String,
    /// Its grade.
    pub grade: Grade,
    /// Its number.
    #[serde(with = "crate::summary::float")]
    pub value: f64,
    /// To be looked at above it.
    pub look: Option<f64>,
    /// Bad above it.
    pub bad: Option<f64>,
    /// What the number is, the number and its bounds, in a sentence.
    pub sentence: String,
    /// What would put it right.
    pub remedy: String,
}

impl Line {
    /// The line on `quantity` (a noun phrase) of value `value`, which people read in `form`.
    pub fn new(
        name: &str,
        (quantity, value, form): (&str, f64, Form),
        bounds: Bounds,
        remedy: &str,
    ) -> Line {
        let [look, bad] = bounds.pair();
        let of = |word: &str, bound: Option<f64>| {
            bound.map(|bound| format!("{word} above {}", form.show(bound)))
        };
        let told: Vec<String> = [of("look", look), of("bad", bad)]
            .into_iter()
            .flatten()
            .collect();
        Line {
            name: name.to_owned(),
            grade: bounds.grade(value),
            value,
            look,
            bad,
            sentence: format!("{quantity}: {} ({})", form.show(value), told.join(", ")),
            remedy: remedy.to_owned(),
        }
    }

    /// The sentence, and where something is wrong what would put it right.
    pub fn text(&self) -> String {
        match self.grade {
            Grade::Good => self.sentence.clone(),
            _ if self.remedy.is_empty() => self.sentence.clone(),
            Grade::Look | Grade::Bad => format!("{}; {}", self.sentence, self.remedy),
        }
    }
}

/// The line on the relative L² error of a contact force against `standard` (a noun phrase).
///
/// A force that vanishes, and one that is on and off by turns at twice its mean, have an error of 1: above half of that it is
/// not the force. The front of the exact force of two bars, which no mesh has, costs 5 to 15 % on the meshes of the cases.
pub fn force_error(standard: &str, error: f64) -> Line {
    Line::new(
        "force-error",
        (
            &format!("error of the contact force against {standard} (L²)"),
            error,
            Form::Percent,
        ),
        Bounds::Both(0.15, 0.5),
        "use a finer mesh with a smaller step; if that does not help, another scheme or contact law",
    )
}

/// Whether the result can be relied on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// The worst grade of the lines; bad if the run is not complete.
    pub grade: Grade,
    /// Why the run is not complete; `None` if it is.
    pub unfinished: Option<String>,
    /// What was checked.
    pub lines: Vec<Line>,
    /// What could not be checked, and why, one sentence each.
    pub unchecked: Vec<String>,
}

impl Verdict {
    /// The verdict on a run that came to its end (`unfinished` is `None`) or did not (`unfinished` says why).
    pub fn new(unfinished: Option<String>, lines: Vec<Line>, unchecked: Vec<String>) -> Verdict {
        let worst = lines.iter().map(|line| line.grade).max();
        let grade = match unfinished {
            Some(_) => Grade::Bad,
            None => worst.unwrap_or_default(),
        };
        Verdict {
            grade,
            unfinished,
            lines,
            unchecked,
        }
    }

    /// Adds a line.
    pub fn add(&mut self, line: Line) {
        self.grade = self.grade.max(line.grade);
        self.lines.push(line);
    }

    /// Makes it that of a run that is not complete, for this reason; an earlier reason stays.
    pub fn incomplete(&mut self, why: String) {
        self.grade = Grade::Bad;
        self.unfinished.get_or_insert(why);
    }

    /// Why it is not good, the worst first; empty when good.
    pub fn reasons(&self) -> Vec<String> {
        let of = |grade: Grade| self.lines.iter().filter(move |line| line.grade == grade);
        let lines = of(Grade::Bad).chain(of(Grade::Look)).map(Line::text);
        self.unfinished.iter().cloned().chain(lines).collect()
    }

    /// The line of this name.
    pub fn line(&self, name: &str) -> Option<&Line> {
        self.lines.iter().find(|line| line.name == name)
    }
}
