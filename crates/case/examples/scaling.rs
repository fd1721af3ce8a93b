//! Times of explicit steps on several ranks, here threads of one process, of a block that falls:
//!
//! ```text
//! cargo run --release -p carom-case --example scaling -- weak|strong ELEMENTS STEPS RANKS...
//! ```
//!
//! `weak`: a cube of so many elements along a side for each rank, one behind the other; `strong`: one such cube for all. A rank has one processor.
//! Printed are the seconds of a step that a tenth of the steps are faster than (other programs do not count there), the mean of all steps (with
//! pictures, contacts and other programs), and the efficiency of both against the first number of ranks.
#![allow(clippy::print_stdout)]

use std::time::Instant;

use carom_case::{Input, build, parse, run_on_ranks};
use carom_dynamics::{Error, Observer, Stepper};
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
    fn looks(&self, _: &dyn Stepper) -> bool {
        false
    }
}

impl Clock {
    /// Seconds of a step that a tenth of the steps are faster than, and the mean of all; those at the begin are left out.
    fn seconds(&self) -> [f64; 2] {
        let steps = self.0[self.0.len() / 10..].windows(2);
        let mut steps: Vec<f64> = steps
            .map(|ends| (ends[1] - ends[0]).as_secs_f64())
            .collect();
        steps.sort_by(f64::total_cmp);
        let mean = steps.iter().sum::<f64>() / steps.len() as f64;
        [steps.get(steps.len() / 10).copied().unwrap_or(0.0), mean]
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

fn timed(ranks: &Ranks, text: &str) -> Anyhow<[f64; 2]> {
    let told = |problems| format!("{problems:?}");
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input).map_err(told)?;
    let built = build(&case, &locator, &input).map_err(told)?;
    let folder = tempfile::tempdir()?;
    let mut clock = Clock::default();
    let parts = (&input, &case, &built);
    let done = run_on_ranks(ranks, parts, folder.path().join("run"), &mut clock, &|| {
        false
    })?;
    if let Some(done) = done {
        println!("{:?}", done.ranks);
    }
    Ok(clock.seconds())
}

/// Seconds of a step as the first rank sees them.
fn on_all(count: usize, text: &str) -> Anyhow<[f64; 2]> {
    std::thread::scope(|scope| {
        let ranks = threads(count).into_iter();
        let started: Vec<_> = ranks
            .map(|own| {
                scope.spawn(move || -> Anyhow<[f64; 2]> {
                    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
                    alone.install(|| timed(&own, text))
                })
            })
            .collect();
        let mut times = Vec::new();
        for one in started {
            times.push(one.join().map_err(|_| "a rank has panicked")??);
        }
        Ok(times[0])
    })
}

fn main() -> Anyhow<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [kind, elements, steps, counts @ ..] = &words[..] else {
        return Err("weak|strong ELEMENTS STEPS RANKS...".into());
    };
    let (elements, steps) = (elements.parse()?, steps.parse()?);
    let mut first = None;
    for count in counts {
        let count: usize = count.parse()?;
        let weak = kind == "weak";
        let seconds = on_all(count, &case(elements, if weak { count } else { 1 }, steps))?;
        let (ranks, begin) = *first.get_or_insert((count, seconds));
        let efficiency = |k: usize| match weak {
            true => begin[k] / seconds[k],
            false => begin[k] / seconds[k] * ranks as f64 / count as f64,
        };
        println!(
            "{kind} {elements}: {count} ranks, {:.3} ms a step, efficiency {:.2}; mean {:.3} ms, {:.2}",
            1e3 * seconds[0],
            efficiency(0),
            1e3 * seconds[1],
            efficiency(1)
        );
    }
    Ok(())
}
