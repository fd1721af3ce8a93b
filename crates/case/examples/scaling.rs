//! Times of explicit steps on several ranks, here threads of one process, of a block that falls:
//!
//! ```text
//! cargo run --release -p carom-case --example scaling -- weak|strong ELEMENTS STEPS RANKS...
//! ```
//!
//! `weak`: a cube of so many elements along a side for each rank, one behind the other; `strong`: one such cube for all. A rank has one processor.
//! Printed are the seconds of a step that a tenth of the steps are faster than, of the median and of the mean, with pictures; and the efficiency of
//! each against as many runs of one rank at the same time that know nothing of each other: what the machine gives to so many
//! processors, whatever else they share.
#![allow(clippy::print_stdout)]

use std::time::Instant;

use carom_case::{Input, build, parse, run_on_ranks};
use carom_dynamics::{Error, Observer, Scope, Stepper};
use carom_ranks::{Ranks, threads};

type Anyhow<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;

/// Instants of the steps.
#[derive(Default)]
struct Clock(Vec<Instant>);

impl Observer for Clock {
    fn accepted(&mut self, _: &dyn Stepper) -> Result<(), Error> {
        self.0.push(Instant::now());
        Ok(())
    }

    fn finish(&mut self, _: &dyn Stepper) -> Result<(), Error> {
        Ok(())
    }

    /// No state is gathered for the clock.
    fn looks(&self, _: &dyn Stepper) -> Scope {
        Scope::Watched
    }
}

impl Clock {
    /// Seconds of a step that a tenth of the steps are faster than, of the median, and of the mean; those at the begin are left out.
    fn seconds(&self) -> [f64; 3] {
        let steps = self.0[self.0.len() / 10..].windows(2);
        let mut steps: Vec<f64> = steps
            .map(|ends| (ends[1] - ends[0]).as_secs_f64())
            .collect();
        steps.sort_by(f64::total_cmp);
        let mean = steps.iter().sum::<f64>() / steps.len() as f64;
        let at = |part: usize| steps.get(steps.len() / part).copied().unwrap_or(0.0);
        [at(10), at(2), mean]
    }
}

fn case(elements: usize, long: usize, steps: usize) -> String {
    let size = 0.01 * elements as f64;
    format!(
        r#"
carom = 1
[mesh]
generate.block.box = {{ origin = [0.0, 0.0, 0.1], size = [{}, {size}, {size}], elements = [{}, {elements}, {elements}] }}
[material.soft]
density = 1000.0
neo-hooke = {{ young = "50 MPa", poisson = 0.3 }}
[body.block]
region = "block"
material = "soft"
initial = {{ velocity = [0.0, 0.0, -5.0] }}
[contact.ground]
secondary = "block.bottom"
obstacle.plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
law.velocity = {{}}
[time]
end = {}
step = "10 us"
scheme.central-difference = {{}}
"#,
        size * long as f64,
        elements * long,
        1e-5 * steps as f64
    )
}

fn timed(ranks: &Ranks, text: &str) -> Anyhow<[f64; 3]> {
    let told = |problems| format!("{problems:?}");
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input).map_err(told)?;
    let built = match ranks.is_first() {
        true => Some(build(&case, &locator, &input).map_err(told)?),
        false => None,
    };
    let folder = tempfile::tempdir()?;
    let mut clock = Clock::default();
    let read = (&input, &case, &locator);
    let folder = folder.path().join("run");
    let done = run_on_ranks(ranks, read, built, folder, &mut clock, &|| false)?;
    if let Some(share) = done
        .and_then(|done| done.ranks)
        .filter(|_| ranks.count() > 1)
    {
        println!("{share:?}");
    }
    Ok(clock.seconds())
}

/// Runs a case on each of these at the same time; seconds of a step as the slowest of them sees them.
fn at_once(ranks: Vec<Ranks>, text: &str) -> Anyhow<[f64; 3]> {
    std::thread::scope(|scope| {
        let started: Vec<_> = ranks
            .into_iter()
            .map(|own| {
                scope.spawn(move || -> Anyhow<[f64; 3]> {
                    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
                    alone.install(|| timed(&own, text))
                })
            })
            .collect();
        let mut slowest = [0.0; 3];
        for one in started {
            let seconds = one.join().map_err(|_| "a rank has panicked")??;
            for (slowest, own) in slowest.iter_mut().zip(seconds) {
                *slowest = f64::max(*slowest, own);
            }
        }
        Ok(slowest)
    })
}

fn main() -> Anyhow<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [kind, elements, steps, counts @ ..] = &words[..] else {
        return Err("weak|strong ELEMENTS STEPS RANKS...".into());
    };
    let (elements, steps) = (elements.parse()?, steps.parse()?);
    let own = case(elements, 1, steps);
    for count in counts {
        let count: usize = count.parse()?;
        let weak = kind == "weak";
        let all = case(elements, if weak { count } else { 1 }, steps);
        let alone = at_once(vec![Ranks::alone(); count], &own)?;
        let together = at_once(threads(count), &all)?;
        println!("{kind} {elements}, {count} ranks, milliseconds a step:");
        for (k, of) in ["fastest tenth", "median", "mean"].iter().enumerate() {
            let work = if weak { 1.0 } else { count as f64 };
            println!(
                "  {of}: {:.3} alone, {:.3} together, efficiency {:.2}",
                1e3 * alone[k],
                1e3 * together[k],
                alone[k] / together[k] / work
            );
        }
    }
    Ok(())
}
