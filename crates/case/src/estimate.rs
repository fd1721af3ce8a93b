//! How long a run will take, and how much memory: from its first steps, with all that they write.

use std::cell::Cell;
use std::time::{Duration, Instant};

use carom_dynamics::{Error, Observer, Stepper, step_count};

use crate::build::Built;
use crate::input::Input;
use crate::run::{Failed, run};
use crate::schema::Case;

/// What the first steps of a run take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Steps that were taken.
    pub tried: u64,
    /// Steps of the run; of steps that adapt themselves as many as if they stayed what they are at first.
    pub steps: u64,
    /// Time of the whole run, s: that of its start and of its figures and report, and that of the tried steps times the number of all.
    pub seconds: f64,
    /// Largest memory of the program so far, bytes; `None` where the system does not tell.
    pub bytes: Option<u64>,
    /// How linear equations were solved; `None` where there were none.
    pub solver: Option<&'static str>,
}

/// Takes first steps of a case for about `patience`, at least one, and says what all will take. What they write is in a temporary folder, which
/// is removed.
///
/// # Errors
/// The run cannot begin, one of these steps fails, or there is no temporary folder.
pub fn estimate(
    (input, case, built): (&Input, &Case, &Built),
    patience: Duration,
) -> Result<Estimate, Failed> {
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
    let (first, last) = (since(clock.first), since(clock.last));
    let all = steps_of(built);
    let each = match clock.steps {
        0 | 1 => first,
        steps => (last - first) / (steps - 1) as f64,
    };
    let further = all.saturating_sub(clock.steps) as f64;
    Ok(Estimate {
        tried: clock.steps,
        steps: all,
        seconds: whole + each * further,
        bytes: largest_memory(),
        solver: clock.solver,
    })
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
    solver: Option<&'static str>,
}

impl Observer for Clock {
    fn accepted(&mut self, run: &dyn Stepper) -> Result<(), Error> {
        if run.state().step > 0 {
            self.steps += 1;
            self.last = Some(Instant::now());
            self.first = self.first.or(self.last);
            let work = run.costs().work;
            self.solver = match (work.factorisations, work.products) {
                (0, 0) => None,
                (_, 0) => Some("a factor"),
                (0, _) => Some("iterations"),
                (_, _) => Some("factors and iterations"),
            };
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
