//! `carom study --fit`: the value of a key with which the case gives a wanted result.
//!
//! Every trial is a run of its own. A quantity is met by the rule of false position (Illinois) between two values on whose
//! sides it lies; a force history is come nearest to by golden section, which needs a distance with one minimum. A range of
//! more than two decades is searched in the logarithm of the value.

use std::io;
use std::path::{Path, PathBuf};

use carom_output::Folder;
use carom_studies::compare::{Outcome, StepForce};
use carom_studies::study::{Abscissa, Fitted, Found, Goal, Quantity, Run, Study};

use crate::error::Problem;
use crate::input::{Input, Source};
use crate::study::run_name;
use crate::sweep::{Job, Sweep, SweepError, run_all};

/// A key to fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// Its key path.
    pub key: String,
    /// The least and the largest value to try.
    pub between: [f64; 2],
    /// What it is fitted to.
    pub goal: Goal,
}

/// Most trials.
const MOST_TRIALS: usize = 40;
/// A quantity is met when it differs from its goal by less than this part of it ...
const MET: f64 = 1e-8;
/// ... or when the value is known to this part of the range.
const NARROW: f64 = 1e-9;
/// A force history is come nearest to within this part of the range.
const NEAREST: f64 = 1e-3;
/// A range is searched in logarithms if its ends are farther apart than this.
const DECADES: f64 = 100.0;

impl Fit {
    /// Reads `KEY`, `A,B` and `restitution=0.98` (any column of `study.csv`) or `force=FILE`: a CSV table with a column
    /// `time_s` and one that ends in `force_n`, of several that of the `contact`, such as the `contact.csv` of a run; the force of a row acts from the time
    /// before to its own.
    ///
    /// # Errors
    /// The range is none; the quantity is unknown; the file cannot be read.
    pub fn read(
        key: &str,
        between: &str,
        to: &str,
        contact: Option<&str>,
    ) -> Result<Fit, SweepError> {
        let ends = between.split_once(',').and_then(|(a, b)| {
            Some([a.trim().parse::<f64>().ok()?, b.trim().parse::<f64>().ok()?])
        });
        let ends = ends.filter(|[a, b]| a < b && (b - a).is_finite());
        let between = ends.ok_or_else(|| {
            let problem = Problem::new("", "no range to look for the value in").found(between);
            wrong(
                "--between",
                between,
                problem.accepted(["A,B with A less than B"]),
            )
        })?;
        let goal = match to.split_once('=') {
            Some(("force", file)) => Goal::Force(history(Path::new(file), contact)?),
            Some((name, value)) => quantity(to, name.trim(), value.trim())?,
            None => quantity(to, to, "")?,
        };
        Ok(Fit {
            key: key.to_owned(),
            between,
            goal,
        })
    }
}

fn wrong(option: &str, text: &str, problem: Problem) -> SweepError {
    SweepError::Input {
        sources: vec![Source {
            name: option.to_owned(),
            text: text.to_owned(),
        }],
        problems: vec![problem],
    }
}

fn quantity(to: &str, name: &str, value: &str) -> Result<Goal, SweepError> {
    let quantity = Quantity::ALL.into_iter().find(|q| q.column() == name);
    let Some(quantity) = quantity else {
        let names = Quantity::ALL.map(Quantity::column);
        let problem = Problem::new("", "nothing of this name can be fitted to");
        let names = names.into_iter().chain(["force"]);
        return Err(wrong("--to", to, problem.unknown(name, names)));
    };
    match value.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(Goal::Quantity(quantity, value)),
        _ => {
            let problem = Problem::new("", "the wanted value is not a number").found(value);
            let accepted = [format!("{name}=NUMBER")];
            Err(wrong("--to", to, problem.accepted(accepted)))
        }
    }
}

/// Most bytes of a force history, 1 GiB.
const LARGEST: u64 = 1 << 30;

fn read_text(path: &Path) -> io::Result<String> {
    let bytes = carom_mesh::read::file::regular(path, LARGEST)?;
    String::from_utf8(bytes).map_err(io::Error::other)
}

/// A force history from a CSV table of numbers; of several forces that of a contact.
fn history(path: &Path, contact: Option<&str>) -> Result<StepForce, SweepError> {
    let name = path.display().to_string();
    let refuse = |problem: Problem| wrong("--to", &name, problem);
    let text = read_text(path).map_err(|cause| {
        refuse(Problem::new(
            "",
            format!("cannot read the force history `{name}`: {cause}"),
        ))
    })?;
    let mut lines = text.lines();
    let heads: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let column = |wanted: &dyn Fn(&str) -> bool| heads.iter().position(|head| wanted(head.trim()));
    let time = column(&|head| head == "time_s");
    let forces = heads.iter().filter(|head| head.trim().ends_with("force_n"));
    let own = contact.map(|name| format!("contact.{}.force_n", name.replace('-', "_")));
    let force = match (forces.clone().count(), own) {
        (0 | 1, _) => column(&|head| head.ends_with("force_n")),
        (_, Some(own)) => column(&|head| head == own),
        _ => None,
    };
    if let (None, true) = (force, forces.clone().count() > 1) {
        let message = format!("`{name}` has the forces of several contacts");
        let accepted = ["`--contact NAME`, one of the contacts of the file"];
        return Err(refuse(Problem::new("", message).accepted(accepted)));
    }
    let Some((time, force)) = time.zip(force) else {
        let message = format!("`{name}` has no force history");
        let accepted = ["a column `time_s` and one that ends in `force_n`"];
        return Err(refuse(Problem::new("", message).accepted(accepted)));
    };
    let mut history = StepForce::default();
    let mut last = f64::NEG_INFINITY;
    for (number, line) in lines
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty())
    {
        let cells: Vec<&str> = line.split(',').collect();
        let cell = |k: usize| {
            cells
                .get(k)?
                .trim()
                .parse::<f64>()
                .ok()
                .filter(|v| v.is_finite())
        };
        match cell(time).zip(cell(force)) {
            Some((time, force)) if time > last => {
                history.push(time, force);
                last = time;
            }
            _ => {
                let message = format!(
                    "line {} of `{name}`: expected a time after the last one, and a force",
                    number + 2
                );
                return Err(refuse(Problem::new("", message).found(line)));
            }
        }
    }
    Ok(history)
}

/// Looks for the value and writes the trials as a study into the folder of `sweep`; returns it with the path of its page.
///
/// # Errors
/// The case or a trial is refused before anything is written; a common file cannot be written. A run that fails, and a
/// goal that does not lie in the range, are told in [`Study::fitted`].
pub fn fit(input: &Input, fit: &Fit, sweep: &Sweep) -> Result<(Study, PathBuf), SweepError> {
    let base = Job::new("", input, Vec::new())?;
    base.has_contact(sweep.contact)?;
    let [a, b] = fit.between;
    let ends = [a, b].map(|value| Job::new("end", input, vec![format!("{}={value:?}", fit.key)]));
    let ends = ends.into_iter().collect::<Result<Vec<Job>, _>>()?;
    for job in &ends {
        job.build().map_err(|problems| job.refuse(problems))?;
    }
    let mut folder = Folder::create(sweep.folder)?;
    let mut study = Study {
        title: base.title(),
        keys: vec![(fit.key.clone(), Vec::new())],
        abscissa: Abscissa::Nothing,
        runs: Vec::new(),
        fitted: None,
    };
    let logarithmic = a > 0.0 && b / a > DECADES;
    let value = |s: f64| if logarithmic { s.exp() } else { s };
    let range = if logarithmic {
        [a.ln(), b.ln()]
    } else {
        [a, b]
    };
    let mut trial = |s: f64| -> Result<Result<f64, String>, SweepError> {
        let (_, values) = &mut study.keys[0];
        values.push(format!("{:?}", value(s)));
        let change = format!("{}={:?}", fit.key, value(s));
        let name = run_name(&fit.key, &format!("{:.6}", value(s)), values.len() - 1);
        let job = Job::new(&name, input, vec![change])?;
        folder.nested(&job.name)?;
        let ended = run_all(&[job], sweep).pop();
        let Some(run) = ended.map(|one| Run {
            variant: one.variant,
            x: None,
            exact_mean_force: None,
            series: String::new(),
        }) else {
            return Ok(Err("nothing was run".to_owned()));
        };
        let result = result(&fit.goal, &run);
        study.runs.push(run);
        Ok(result)
    };
    let found = match &fit.goal {
        Goal::Quantity(_, goal) => meet(range, *goal, &mut trial)?,
        Goal::Force(_) => nearest(range, &mut trial)?,
    };
    let (_, values) = &study.keys[0];
    let found = found.map(|(s, reached)| {
        let taken = format!("{:?}", value(s));
        Found {
            run: values.iter().position(|v| *v == taken).unwrap_or_default(),
            value: value(s),
            reached,
        }
    });
    study.fitted = Some(Fitted {
        key: fit.key.clone(),
        goal: fit.goal.clone(),
        found,
    });
    let page = study.write(&mut folder)?;
    Ok((study, page))
}

/// What a trial gives: the quantity, or the distance from the history.
fn result(goal: &Goal, run: &Run) -> Result<f64, String> {
    if !matches!(run.variant.outcome, Outcome::Done(_)) {
        let (verdict, reason) = run.variant.verdict();
        return Err(format!(
            "the trial {} was {verdict}: {reason}",
            run.variant.name
        ));
    }
    goal.of(run).ok_or_else(|| match goal {
        Goal::Quantity(quantity, _) => {
            format!("the trial {} has no {}", run.variant.name, quantity.name())
        }
        Goal::Force(_) => "the wanted history has no force while the case runs".to_owned(),
    })
}

/// A trial: the outer error ends the program, the inner one the search.
type Trial<'a> = dyn FnMut(f64) -> Result<Result<f64, String>, SweepError> + 'a;
/// Place and result, or why there is none.
type Search = Result<Result<(f64, f64), String>, SweepError>;

/// Where the result is `goal`, by false position: the end that stays twice counts half (Illinois).
fn meet([mut a, mut b]: [f64; 2], goal: f64, trial: &mut Trial) -> Search {
    let narrow = NARROW * (b - a);
    let met = MET * goal.abs();
    let (first, last) = match (trial(a)?, trial(b)?) {
        (Ok(first), Ok(last)) => (first, last),
        (Err(reason), _) | (_, Err(reason)) => return Ok(Err(reason)),
    };
    let (mut fa, mut fb) = (first - goal, last - goal);
    if fa * fb > 0.0 {
        return Ok(Err(format!(
            "{goal} is not between {first:.6} and {last:.6}, the results at the two ends of the range"
        )));
    }
    // the nearer end is the best so far
    let mut best = if fa.abs() < fb.abs() {
        (a, first)
    } else {
        (b, last)
    };
    for _ in 2..MOST_TRIALS {
        if (best.1 - goal).abs() <= met || (b - a).abs() <= narrow {
            break;
        }
        let c = (a * fb - b * fa) / (fb - fa);
        let reached = match trial(c)? {
            Ok(reached) => reached,
            Err(reason) => return Ok(Err(reason)),
        };
        let fc = reached - goal;
        if fc.abs() < (best.1 - goal).abs() {
            best = (c, reached);
        }
        if fc * fb <= 0.0 {
            (a, fa) = (b, fb);
        } else {
            fa *= 0.5;
        }
        (b, fb) = (c, fc);
    }
    Ok(Ok(best))
}

/// Where the result is least, by golden section.
fn nearest([mut a, mut b]: [f64; 2], trial: &mut Trial) -> Search {
    let narrow = NEAREST * (b - a);
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let inner = |a: f64, b: f64| [b - golden * (b - a), a + golden * (b - a)];
    let [mut c, mut d] = inner(a, b);
    let (mut fc, mut fd) = match (trial(c)?, trial(d)?) {
        (Ok(fc), Ok(fd)) => (fc, fd),
        (Err(reason), _) | (_, Err(reason)) => return Ok(Err(reason)),
    };
    for _ in 2..MOST_TRIALS {
        if b - a <= narrow {
            break;
        }
        let next = if fc < fd {
            (b, d, fd) = (d, c, fc);
            c = inner(a, b)[0];
            c
        } else {
            (a, c, fc) = (c, d, fd);
            d = inner(a, b)[1];
            d
        };
        match trial(next)? {
            Ok(reached) if next == c => fc = reached,
            Ok(reached) => fd = reached,
            Err(reason) => return Ok(Err(reason)),
        }
    }
    Ok(Ok(if fc < fd { (c, fc) } else { (d, fd) }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantity_is_met_and_a_goal_out_of_reach_is_told() {
        let mut count = 0;
        let mut cubic = |s: f64| {
            count += 1;
            Ok(Ok(s * s * s))
        };
        let (s, reached) = meet([0.0, 3.0], 2.0, &mut cubic).unwrap().unwrap();
        assert!((s - 2.0_f64.cbrt()).abs() < 1e-8 && (reached - 2.0).abs() < 1e-7);
        assert!(count < 20, "{count} trials");
        assert!(
            meet([2.0, 3.0], 2.0, &mut |s| Ok(Ok(s * s * s)))
                .unwrap()
                .is_err()
        );
        assert!(
            meet([0.0, 3.0], 2.0, &mut |_| Ok(Err("no".to_owned())))
                .unwrap()
                .is_err()
        );
    }

    #[test]
    fn the_least_distance_is_found_wherever_it_lies() {
        for at in [0.0, 0.1, 0.5, 0.77, 1.0] {
            let (s, least) = nearest([0.0, 1.0], &mut |s| Ok(Ok((s - at).abs())))
                .unwrap()
                .unwrap();
            assert!(
                (s - at).abs() < 1e-3 && (least - (s - at).abs()).abs() < 1e-15,
                "{at}: {s}"
            );
        }
    }
}
