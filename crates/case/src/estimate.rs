//! How long a run will take, and how much memory: from its first steps.

use std::sync::Arc;
use std::time::{Duration, Instant};

use carom_dynamics::{Driver, Stepper, step_count};
use carom_zones::Whole;

use crate::build::Built;
use crate::run::Failed;

/// What the first steps of a run take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Steps that were taken.
    pub tried: u64,
    /// Steps of the run; of steps that adapt themselves as many as if they stayed what they are at first.
    pub steps: u64,
    /// Time of the whole run, s: that of its start, and that of the tried steps times the number of all.
    pub seconds: f64,
    /// Largest memory of the program so far, bytes; `None` where the system does not tell.
    pub bytes: Option<u64>,
}

/// Takes first steps of a case for about `patience`, at least one, and says what all will take. No file is written.
///
/// # Errors
/// The run cannot begin, or one of these steps fails.
pub fn estimate(built: &Built, patience: Duration) -> Result<Estimate, Failed> {
    let begin = Instant::now();
    let system = || Arc::clone(&built.system);
    match &built.zoned {
        Some(zoned) if built.apart => {
            let whole = Whole::new(zoned, system());
            let mut whole = whole.map_err(|error| Failed::Start(error.into()))?;
            try_steps(&mut whole, built, (begin, patience))
        }
        _ => {
            let mut driver = Driver::new(system()).map_err(Failed::Start)?;
            try_steps(&mut driver, built, (begin, patience))
        }
    }
}

fn try_steps(
    run: &mut dyn Stepper,
    built: &Built,
    (begin, patience): (Instant, Duration),
) -> Result<Estimate, Failed> {
    let (start, steps) = built
        .stage
        .map_or((0.0, 0), |(end, steps)| (end, u64::from(steps)));
    let dynamic = match start < built.end {
        true => step_count(built.end - start, built.system.dt),
        false => 0,
    };
    let all = steps + dynamic;
    // factors and buffers are made in the first step
    run.step().map_err(Failed::Step)?;
    let set_up = begin.elapsed();
    let begin = Instant::now();
    let mut tried = 0;
    while tried + 1 < all && begin.elapsed() < patience {
        run.step().map_err(Failed::Step)?;
        tried += 1;
    }
    let each = match tried {
        0 => set_up.as_secs_f64(),
        _ => begin.elapsed().as_secs_f64() / tried as f64,
    };
    Ok(Estimate {
        tried: tried + 1,
        steps: all,
        seconds: set_up.as_secs_f64() + each * (all - 1) as f64,
        bytes: largest_memory(),
    })
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
