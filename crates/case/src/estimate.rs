//! How long a run will take, and how much memory: from its first steps, with all that they write.
//!
//! A run that begins before its first impact takes other steps than those after it. First steps are then taken once more with all contacts that may close
//! before the end touching at the start; what they take beyond the others counts once for the start, and for each second of the steps after the first possible impact: how long
//! contacts are closed is not known, and this is wrong by less than a factor of two where they stay closed. With iterations more of it counts: bodies that fly after an impact
//! vibrate, and their steps take three fifths of the products of those with contact.

use std::cell::Cell;
use std::time::{Duration, Instant};

use carom_dynamics::{Error, Observer, Stepper, Work, step_count};

use std::sync::Arc;

use crate::accelerations::accelerations;
use crate::facts::approach;
use crate::input::Input;
use crate::lower::Built;
use crate::run::{Failed, run};
use crate::schema::Case;

/// What the first steps of a run take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Steps that were taken.
    pub tried: u64,
    /// Steps of the run; of steps that adapt themselves as many as if they stayed what they are at first.
    pub steps: u64,
    /// Time of the whole run, s: that of its start and of its figures and report, and of its steps with and without contact.
    pub seconds: f64,
    /// Largest memory of the program so far, bytes; `None` where the system does not tell.
    pub bytes: Option<u64>,
    /// How linear equations were solved; `None` where there were none.
    pub solver: Option<&'static str>,
}

/// Takes first steps of a case for about `patience`, at least two, and says what all will take. What they write is in a temporary folder, which
/// is removed. `built` is the same afterwards.
///
/// # Errors
/// The run cannot begin, one of these steps fails, or there is no temporary folder.
pub fn estimate(
    (input, case, built): (&Input, &Case, &mut Built),
    patience: Duration,
) -> Result<Estimate, Failed> {
    let first = trial((input, case, built), patience)?;
    let steps = steps_of(built);
    let mut seconds = first.whole + first.each * steps.saturating_sub(first.steps) as f64;
    if let Some((impact, gaps)) = close(built) {
        let closed = trial((input, case, built), patience);
        open(built, gaps);
        let closed = closed?;
        let after = (built.end - impact) / built.system.dt;
        let more = [closed.start - first.start, closed.each - first.each];
        let [start, each] = more.map(|more| more.max(0.0));
        let share = if closed.work.products > 0 { 0.8 } else { 0.5 };
        seconds += start + share * each * after;
    }
    Ok(Estimate {
        tried: first.steps,
        steps,
        seconds,
        bytes: largest_memory(),
        solver: solver(&first.work),
    })
}

/// What some first steps took.
struct Trial {
    /// With what the run does at its end, s.
    whole: f64,
    /// Up to the end of the first step, s.
    start: f64,
    /// A step after the first, s.
    each: f64,
    steps: u64,
    work: Work,
}

fn trial(
    (input, case, built): (&Input, &Case, &Built),
    patience: Duration,
) -> Result<Trial, Failed> {
    let refused = |source| carom_output::Error::File {
        action: "create a folder in",
        path: std::env::temp_dir(),
        source,
    };
    let temporary = tempfile::tempdir().map_err(refused)?;
    let begin = Instant::now();
    let mut clock = Clock::default();
    // factors and buffers are made in the first step: at least two are taken
    let asked = Cell::new(0);
    let stop = || {
        asked.set(asked.get() + 1);
        asked.get() > 2 && begin.elapsed() >= patience
    };
    let folder = temporary.path().join("estimate");
    run((input, case, built), folder, &mut clock, &stop)?;
    let whole = begin.elapsed().as_secs_f64();
    let since = |instant: Option<Instant>| instant.map_or(whole, |at| (at - begin).as_secs_f64());
    let (start, last) = (since(clock.first), since(clock.last));
    Ok(Trial {
        whole,
        start,
        each: match clock.steps {
            0 | 1 => start,
            steps => (last - start) / (steps - 1) as f64,
        },
        steps: clock.steps,
        work: clock.work,
    })
}

/// Lets the contacts that may close between the first step and the end touch at the start. When the first of them closes, s, and what was added to gaps before; none where
/// nothing does so, or the zones of a case have the contacts.
fn close(built: &mut Built) -> Option<(f64, Vec<Vec<f64>>)> {
    if built.zoned.is_some() || built.stage.is_some() {
        return None;
    }
    let system = Arc::get_mut(&mut built.system)?;
    let accelerations = accelerations(system);
    let mut first = f64::INFINITY;
    let mut before = Vec::with_capacity(system.contacts.len());
    for number in 0..system.contacts.len() {
        let start = &system.initial.displacement;
        let found = approach(system, &accelerations, (number, start));
        let contact = &mut system.contacts[number].contact;
        before.push(contact.offsets.clone());
        if found.impact > system.dt && found.impact < built.end {
            first = first.min(found.impact);
            contact.offsets.resize(contact.points.len(), 0.0);
            for offset in &mut contact.offsets {
                *offset -= found.gap;
            }
        }
    }
    if first == f64::INFINITY {
        return None;
    }
    Some((first, before))
}

fn open(built: &mut Built, gaps: Vec<Vec<f64>>) {
    if let Some(system) = Arc::get_mut(&mut built.system) {
        for (contact, offsets) in system.contacts.iter_mut().zip(gaps) {
            contact.contact.offsets = offsets;
        }
    }
}

/// Steps of the whole run.
fn steps_of(built: &Built) -> u64 {
    let (start, steps) = built
        .stage
        .map_or((0.0, 0), |(end, steps)| (end, u64::from(steps)));
    match start < built.end {
        true => steps + step_count(built.end - start, built.system.dt),
        false => steps,
    }
}

/// When steps were accepted.
#[derive(Default)]
struct Clock {
    steps: u64,
    first: Option<Instant>,
    last: Option<Instant>,
    work: Work,
}

/// How linear equations were solved; none where there were none.
fn solver(work: &Work) -> Option<&'static str> {
    match (work.factorisations, work.products) {
        (0, 0) => None,
        (_, 0) => Some("a factor"),
        (0, _) => Some("iterations"),
        (_, _) => Some("factors and iterations"),
    }
}

impl Observer for Clock {
    fn accepted(&mut self, run: &dyn Stepper) -> Result<(), Error> {
        if run.state().step > 0 {
            self.steps += 1;
            self.last = Some(Instant::now());
            self.first = self.first.or(self.last);
            self.work = run.costs().work;
        }
        Ok(())
    }

    fn finish(&mut self, _: &dyn Stepper) -> Result<(), Error> {
        Ok(())
    }
}

/// Largest memory of this process so far, bytes.
fn largest_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * kilobytes)
}
